#include "base/parallel_for.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

// Set by CMake for the tsan preset, where this one file is compiled without instrumentation, as TBB
// itself is: the halves of its templates that live here would be reported against the other halves.
#ifdef ARRIS_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace arris {
namespace {

// An edge of the order in time: what is before release() in one thread is before what follows a later
// acquire() of the same object in another.
class HappensBefore {
 public:
#ifdef ARRIS_THREAD_SANITIZER
  void release() {
    __tsan_release(this);
  }
  void acquire() {
    __tsan_acquire(this);
  }
#else
  void release() const {}
  void acquire() const {}
#endif
};

}  // namespace

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
    tbb::task_arena arena(options.threads);
    arena.execute([&] { tbb::parallel_for(all, run_range); });
  } else {
    tbb::parallel_for(all, run_range);
  }
  join.acquire();
}

}  // namespace arris
