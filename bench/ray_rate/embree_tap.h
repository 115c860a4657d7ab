// embree_tap.h — sees the rays that the renderer gives to Embree
// What       this program defines rtcIntersect1 and rtcOccluded1 itself and hands every call on to
//            Embree's; while recording, it keeps a copy of each ray. The library under test is the
//            one that ships.
// Limits     recording is for one rendering thread; a call costs the renderer about a nanosecond more
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <vector>

namespace arris::bench {

struct TappedRay {
  RTCRay ray;
  bool shadow = false;
};

// Embree's own functions and the scene that rays were last traced in.
struct EmbreeCalls {
  void (*intersect)(RTCScene, RTCIntersectContext*, RTCRayHit*);
  void (*occluded)(RTCScene, RTCIntersectContext*, RTCRay*);
};
const EmbreeCalls& embree_calls();

void start_recording();
struct Recording {
  std::vector<TappedRay> rays;
  RTCScene scene = nullptr;
};
Recording stop_recording();

}  // namespace arris::bench
