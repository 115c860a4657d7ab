// flush_denormals.h — treat float numbers below 1e-38 as zero while in scope
// What       sets the processor's flush-to-zero and denormals-are-zero modes of this thread, and puts
//            back what was there. Results must not depend on which thread computes, so every task that
//            computes pixels has one.
#pragma once

#include <xmmintrin.h>

namespace arris {

class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) {
    constexpr unsigned kFlushToZero = 1U << 15U;
    constexpr unsigned kDenormalsAreZero = 1U << 6U;
    _mm_setcsr(saved_ | kFlushToZero | kDenormalsAreZero);
  }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
  ~FlushDenormals() { _mm_setcsr(saved_); }

 private:
  unsigned saved_;
};

}  // namespace arris
