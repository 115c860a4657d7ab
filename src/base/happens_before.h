// happens_before.h — tells ThreadSanitizer of an order in time that it can't see
// What       what is before release() in one thread is before what follows a later acquire() of the same
//            object in another. Debian's TBB and Embree make such orders (fork, join, callbacks), but are not
//            instrumented.
// Limits     makes no order by itself: outside the tsan preset both calls are empty
#pragma once

#ifdef ARRIS_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace arris {

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

}  // namespace arris
