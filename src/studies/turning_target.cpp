#include "studies/coverage.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "pirsim/geometry.hpp"

namespace pirsim::studies {
namespace {

/// Degrees, from 0 up to 360: computed so that ticks one turn apart have the same bits.
double angle_deg(const TurnSpec& turn, int tick_rate_hz, std::int64_t tick) {
  return std::fmod(turn.deg_per_s * static_cast<double>(tick), 360.0 * tick_rate_hz) / tick_rate_hz;
}

Quat orientation(const XShapesSpec& spec, int tick_rate_hz, std::int64_t tick) {
  Quat rotation(1.0, 0.0, 0.0, 0.0);
  for (const TurnSpec& turn : spec.turns) {
    rotation = rotation * glm::angleAxis(radians(angle_deg(turn, tick_rate_hz, tick)), glm::normalize(turn.axis));
  }
  return glm::normalize(rotation);
}

bool is_period(const XShapesSpec& spec, int tick_rate_hz, std::int64_t ticks) {
  for (const TurnSpec& turn : spec.turns) {
    if (angle_deg(turn, tick_rate_hz, ticks) != 0.0) return false;
  }
  return true;
}

}  // namespace

TurningTarget::TurningTarget(const XShapesSpec& spec, int tick_rate_hz, std::int64_t n_ticks) {
  std::int64_t period = 1;
  while (period <= n_ticks && !is_period(spec, tick_rate_hz, period)) ++period;
  n_poses_ = static_cast<std::size_t>(period);

  const double radius = spec.bar_width_m / 2, half_length = spec.bar_length_m / 2 - radius;
  for (const double height : spec.heights_m) {
    TurningCross& cross = crosses_.emplace_back();
    cross.middle = {0.0, height, 0.0};
    cross.reach_m = half_length + radius;
    cross.bar = {radius, half_length};
    for (const double lean_deg : {45.0, -45.0}) {
      const Quat leaning = glm::angleAxis(radians(lean_deg), Vec3(0, 0, 1));
      auto& rotations = cross.rotation.emplace_back();
      for (std::int64_t tick = 0; tick < period; ++tick) {
        rotations.push_back(orientation(spec, tick_rate_hz, tick) * leaning);
      }
    }
  }
}

std::vector<PosedShape> TurningTarget::solids(const Vec3& foot, std::int64_t tick) const {
  const std::size_t pose = static_cast<std::size_t>(tick) % n_poses_;
  std::vector<PosedShape> result;
  for (const TurningCross& cross : crosses_) {
    for (const auto& rotations : cross.rotation) {
      result.push_back(place(cross.bar, Frame{rotations[pose], foot + cross.middle}));
    }
  }
  return result;
}

}  // namespace pirsim::studies
