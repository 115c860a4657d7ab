#include "base/parallel_for.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "arris/error.h"
#include "base/happens_before.h"

namespace arris {

int usable_threads(int wanted) {
  return std::min(wanted, tbb::info::default_concurrency());
}

void end_if_stopped(const std::atomic<bool>* stop) {
  if (stop != nullptr && *stop) {
    throw Error(Error::Kind::failed, "", "stopped before the first sample");
  }
}

void run_isolated(const std::function<void()>& body) {
  tbb::this_task_arena::isolate([&] { body(); });
}

void run_parallel(std::size_t count, const ParallelOptions& options, ParallelCall call,
                  const void* body) {
  HappensBefore fork;
  HappensBefore join;
  const tbb::blocked_range<std::size_t> all(0, count, options.grain);
  const auto run_range = [&](const tbb::blocked_range<std::size_t>& range) {
    fork.acquire();
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      if (options.stop != nullptr && options.stop->load(std::memory_order_relaxed)) break;
      call(body, i);
    }
    join.release();
  };
  fork.release();
  if (options.threads > 0) {
    tbb::task_arena arena(usable_threads(options.threads));
    arena.execute([&] { tbb::parallel_for(all, run_range); });
  } else {
    tbb::parallel_for(all, run_range);
  }
  join.acquire();
  end_if_stopped(options.stop);
}

}  // namespace arris
