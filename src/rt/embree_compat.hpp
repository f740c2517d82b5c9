// Embree 3 and 4 under one name. The only place that asks which of them it is.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace pirsim::rt {

#if RTC_VERSION_MAJOR >= 4

using QueryContext = RTCRayQueryContext;
inline void initialise(QueryContext& context) noexcept { rtcInitRayQueryContext(&context); }

inline void closest_hit(RTCScene scene, QueryContext& context, RTCRayHit& ray) noexcept {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}
inline void any_hit(RTCScene scene, QueryContext& context, RTCRay& ray) noexcept {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}

#else

using QueryContext = RTCIntersectContext;
inline void initialise(QueryContext& context) noexcept { rtcInitIntersectContext(&context); }

inline void closest_hit(RTCScene scene, QueryContext& context, RTCRayHit& ray) noexcept {
  rtcIntersect1(scene, &context, &ray);
}
inline void any_hit(RTCScene scene, QueryContext& context, RTCRay& ray) noexcept {
  rtcOccluded1(scene, &context, &ray);
}

#endif

}  // namespace pirsim::rt
