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
  static const EmbreeCalls calls{next_symbol<decltype(EmbreeCalls::intersect)>("rtcIntersect1"),
                                 next_symbol<decltype(EmbreeCalls::occluded)>("rtcOccluded1")};
  return calls;
}

void start_recording() {
  tap = {true, {}};
}

Recording stop_recording() {
  tap.recording = false;
  return std::exchange(tap.record, {});
}

}  // namespace arris::bench

extern "C" void rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* query) {
  using namespace arris::bench;
  if (tap.recording) {
    tap.record.rays.push_back({query->ray, false});
    tap.record.scene = scene;
  }
  embree_calls().intersect(scene, context, query);
}

extern "C" void rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* query) {
  using namespace arris::bench;
  if (tap.recording) {
    tap.record.rays.push_back({*query, true});
    tap.record.scene = scene;
  }
  embree_calls().occluded(scene, context, query);
}
