#include "base/parallel_for.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "base/happens_before.h"

namespace arris {

int usable_threads(int wanted) {
  return std::min(wanted, tbb::info::default_concurrency());
}

void run_parallel(std::size_t count, const ParallelOptions& options, ParallelCall call,
                  const void* body) {
  HappensBefore fork;
  HappensBefore join;
  const tbb::blocked_range<std::size_t> all(0, count, options.grain);
  const auto run_range = [&](const tbb::blocked_range<std::size_t>& range) {
    fork.acquire();
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
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
}

}  // namespace arris
