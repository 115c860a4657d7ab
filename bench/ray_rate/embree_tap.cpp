#include "ray_rate/embree_tap.h"

#include <dlfcn.h>

#include <utility>

namespace arris::bench {
namespace {

struct Tap {
  bool recording = false;
  Recording record;
};
Tap tap;

template <class Function>
Function next_symbol(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

const EmbreeCalls& embree_calls() {
  static const EmbreeCalls kCalls{next_symbol<decltype(EmbreeCalls::intersect)>("rtcIntersect1"),
                                  next_symbol<decltype(EmbreeCalls::occluded)>("rtcOccluded1")};
  return kCalls;
}

void start_recording() {
  tap = {true, {}};
}

Recording stop_recording() {
  tap.recording = false;
  return std::exchange(tap.record, {});
}

}  // namespace arris::bench

extern "C" void rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* rayhit) {
  if (auto& tap = arris::bench::tap; tap.recording) {
    tap.record.rays.push_back({rayhit->ray, false});
    tap.record.scene = scene;
  }
  arris::bench::embree_calls().intersect(scene, context, rayhit);
}

extern "C" void rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray) {
  if (auto& tap = arris::bench::tap; tap.recording) {
    tap.record.rays.push_back({*ray, true});
    tap.record.scene = scene;
  }
  arris::bench::embree_calls().occluded(scene, context, ray);
}
