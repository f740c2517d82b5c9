#include "studies/turning_target.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "geom/lanes.hpp"
#include "geom/ray_tests.hpp"
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

using ray_tests::Lanes;
constexpr std::size_t width = ray_tests::n_lanes;

std::size_t padded(std::size_t n_poses) noexcept { return (n_poses + width - 1) / width * width; }

std::vector<Vec3> half_axes(const Capsule& bar, const std::vector<Quat>& rotation) {
  std::vector<Vec3> result;
  for (const Quat& world_from_bar : rotation) result.push_back(world_from_bar * Vec3(0.0, bar.half_length, 0.0));
  return result;
}

void pose_bar(const std::vector<Vec3>& half_axes, const Vec3& middle, double radius, BarPoses& poses) {
  const std::size_t n = half_axes.size(), n_padded = padded(n);
  for (auto* values : {&poses.ax, &poses.ay, &poses.az, &poses.bx, &poses.by, &poses.bz}) values->resize(n_padded);
  for (std::size_t i = 0; i < n_padded; ++i) {
    const Vec3& half_axis = half_axes[std::min(i, n - 1)];
    poses.ax[i] = static_cast<float>(middle.x - half_axis.x);
    poses.ay[i] = static_cast<float>(middle.y - half_axis.y);
    poses.az[i] = static_cast<float>(middle.z - half_axis.z);
    poses.bx[i] = static_cast<float>(middle.x + half_axis.x);
    poses.by[i] = static_cast<float>(middle.y + half_axis.y);
    poses.bz[i] = static_cast<float>(middle.z + half_axis.z);
  }
  poses.radius = static_cast<float>(radius);
}

void mark_active(const Ray& ray, float range, const BarPoses& poses, std::vector<std::uint8_t>& active) noexcept {
  using Vector = ray_tests::Vector<Lanes>;
  const auto all = [](const Vec3f& v) { return Vector{Lanes(v.x), Lanes(v.y), Lanes(v.z)}; };
  const Vector origin = all(ray.origin), direction = all(ray.direction);
  const Lanes radius(poses.radius), t_max(range);
  for (std::size_t i = 0; i < active.size(); i += width) {
    if (std::all_of(&active[i], &active[i] + width, [](std::uint8_t known) { return known != 0; })) continue;
    const Vector a{Lanes::at(&poses.ax[i]), Lanes::at(&poses.ay[i]), Lanes::at(&poses.az[i])};
    const Vector b{Lanes::at(&poses.bx[i]), Lanes::at(&poses.by[i]), Lanes::at(&poses.bz[i])};
    const auto bar = ray_tests::capsule(origin, direction, ray_tests::capsule_axis(a, b), radius);
    for (unsigned int hits = bits(ray_tests::is_hit(bar, t_max)); hits != 0; hits &= hits - 1) {
      active[i + static_cast<std::size_t>(std::countr_zero(hits))] = 1;
    }
  }
}

bool may_hit(const Ray& ray, float range, const Vec3& middle, double reach_m) noexcept {
  constexpr double safety_m = 1e-3;  // as the tracers' bounding boxes have it
  const Vec3 to_middle = middle - Vec3(ray.origin), direction(ray.direction);
  const double along = std::clamp(glm::dot(to_middle, direction), 0.0, static_cast<double>(range));
  return glm::length(to_middle - along * direction) <= reach_m + safety_m;
}

}  // namespace pirsim::studies
