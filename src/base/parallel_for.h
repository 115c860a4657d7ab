// parallel_for.h — a loop over all cores
// What       parallel_for(count, options, body) calls body(i) once for each i < count, on TBB's threads
// Guarantee  the calls see what was written before the loop; what follows the loop sees what they
//            wrote. ThreadSanitizer is told so, as Debian's TBB is not instrumented: start threads by
//            this loop only, and the sanitizer finds the races between the calls and nothing else.
// Limits     the calls come in no order; results must not depend on it
// Errors     an exception of a call ends the loop and comes out of it
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace arris {

struct ParallelOptions {
  std::size_t grain = 1;  // consecutive calls that one thread makes at a time, at least
  int threads = 0;        // 0: all
  // Set from any thread: no further call begins, and the loop ends with an Error of kind failed.
  const std::atomic<bool>* stop = nullptr;
};
// Throws that error, if it is set.
void end_if_stopped(const std::atomic<bool>* stop);

// Of the threads that are asked for, those there are processors for: TBB would warn of the rest, and run them
// as little.
int usable_threads(int wanted);

// Loops within it wait for their own calls alone, and don't begin calls of loops around: what it holds locked stays so.
void run_isolated(const std::function<void()>& body);

using ParallelCall = void (*)(const void* body, std::size_t index);
void run_parallel(std::size_t count, const ParallelOptions& options, ParallelCall call,
                  const void* body);

template <class Body>
void parallel_for(std::size_t count, const ParallelOptions& options, const Body& body) {
  run_parallel(
      count, options,
      [](const void* erased, std::size_t index) { (*static_cast<const Body*>(erased))(index); },
      &body);
}

}  // namespace arris
