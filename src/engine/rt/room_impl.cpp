#include "engine/rt/room_impl.hpp"

#include <string>

#include "engine/rt/room.hpp"
#include "pirsim/error.hpp"

namespace pirsim::rt {
namespace {

std::string_view describe(RTCError error) noexcept {
  switch (error) {
    case RTC_ERROR_NONE:
      return "no error";
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "unsupported processor";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    default:
      return "unknown error";
  }
}

[[noreturn]] void refuse(std::string_view doing, RTCError error) {
  throw Error(ErrorCode::internal, "Embree refused to " + std::string(doing) + ": " + std::string(describe(error)));
}

}  // namespace

Device make_device() {
  // No `threads`: with oneTBB that would limit the whole process, not Embree.
  const std::string config = "max_isa=" + std::string(pinned_instruction_set) + ",start_threads=0,set_affinity=0";
  Device device(rtcNewDevice(config.c_str()));
  if (!device) refuse("make a device", rtcGetDeviceError(nullptr));
  check(device.get(), "make a device");
  return device;
}

SceneHandle make_scene(RTCDevice device, RTCSceneFlags flags) {
  SceneHandle scene(rtcNewScene(device));
  if (scene) {
    rtcSetSceneFlags(scene.get(), flags);
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  }
  check(device, "make a scene");
  return scene;
}

GeometryHandle make_geometry(RTCDevice device, RTCGeometryType type) {
  GeometryHandle geometry(rtcNewGeometry(device, type));
  if (geometry) rtcSetGeometryMask(geometry.get(), everything_mask);
  check(device, "make a geometry");
  return geometry;
}

void commit(RTCDevice device, RTCScene scene) {
  rtcCommitScene(scene);
  check(device, "build a scene");
}

void check(RTCDevice device, std::string_view doing) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) refuse(doing, error);
}

std::string embree_version() {
  const Device device = make_device();
  const auto part = [&](RTCDeviceProperty property) {
    return std::to_string(rtcGetDeviceProperty(device.get(), property));
  };
  return part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + '.' + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) + '.' +
         part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

std::string instruction_set() { return std::string(pinned_instruction_set); }

}  // namespace pirsim::rt
