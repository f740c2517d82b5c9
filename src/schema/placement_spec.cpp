#include "pirsim/survey.hpp"

#include "pirsim/geometry.hpp"

namespace pirsim {

Frame mounted(const Vec3& position, double yaw_deg, double tilt_deg) {
  return {rotation_from_heading(radians(yaw_deg)) * glm::angleAxis(radians(-tilt_deg), Vec3(1, 0, 0)), position};
}

}  // namespace pirsim
