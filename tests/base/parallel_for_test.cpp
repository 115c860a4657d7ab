#include "base/parallel_for.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "arris/error.h"

namespace arris {
namespace {

TEST(ParallelFor, calls_the_body_once_for_each_index) {
  std::vector<int> calls(10000);
  parallel_for(calls.size(), {.grain = 7}, [&](std::size_t i) { ++calls[i]; });
  EXPECT_EQ(calls, std::vector<int>(10000, 1));
}

TEST(ParallelFor, does_nothing_for_an_empty_range) {
  parallel_for(0, {}, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, stays_in_the_callers_thread_if_asked_for_one) {
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<int> elsewhere = 0;
  parallel_for(1000, {.threads = 1},
               [&](std::size_t) { elsewhere += std::this_thread::get_id() != caller ? 1 : 0; });
  EXPECT_EQ(elsewhere, 0);
}

TEST(ParallelFor, ends_with_an_error_once_it_is_stopped) {
  std::atomic<bool> stop = false;
  std::atomic<int> calls = 0;
  const auto loop = [&] {
    parallel_for(100'000, {.threads = 1, .stop = &stop}, [&](std::size_t) {
      ++calls;
      stop = true;
    });
  };
  EXPECT_THROW(loop(), Error);
  EXPECT_EQ(calls, 1);
}

TEST(ParallelFor, hands_on_an_exception_of_the_body) {
  const auto loop = [] {
    parallel_for(100, {}, [](std::size_t i) {
      if (i == 42) {
        throw std::runtime_error("42");
      }
    });
  };
  EXPECT_THROW(loop(), std::runtime_error);
}

}  // namespace
}  // namespace arris
