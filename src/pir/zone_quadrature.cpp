#include "pir/zone_quadrature.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "pirsim/geometry.hpp"

namespace pirsim::pir {
namespace {

/// One side of a zone, 0 to 1, blurred by a Gaussian: the sum of a uniform and a normal variable.
class BlurredSide {
 public:
  explicit BlurredSide(double sigma) : sigma_(sigma) {}

  /// Where the share `p` of the side's sensitivity lies below.
  [[nodiscard]] double quantile(double p) const {
    if (sigma_ <= 0.0) return p;
    double low = -10.0 * sigma_, high = 1.0 + 10.0 * sigma_, x = 0.5;
    constexpr int most_steps = 60;
    for (int i = 0; i < most_steps; ++i) {  // Newton's, kept within what is known
      const double excess = share_below(x) - p;
      (excess < 0.0 ? low : high) = x;
      const double step = excess / density(x);
      const bool inside = x - step > low && x - step < high;
      x = inside ? x - step : 0.5 * (low + high);
      if (inside && std::abs(step) < 1e-13) break;
    }
    return x;
  }

 private:
  [[nodiscard]] double share_below(double x) const {
    return sigma_ * (integral_of_normal(x / sigma_) - integral_of_normal((x - 1.0) / sigma_));
  }
  [[nodiscard]] double density(double x) const { return normal_below(x / sigma_) - normal_below((x - 1.0) / sigma_); }
  static double normal_below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }
  /// Of the standard normal distribution function, from -infinity to z.
  static double integral_of_normal(double z) {
    return z * normal_below(z) + std::exp(-0.5 * z * z) / std::sqrt(2.0 * pi);
  }

  double sigma_;
};

Vec3 on_plane(const SensorModelSpec& model, const Vec2& point) { return {point.x, point.y, -model.plane_m}; }

/// Ref: [VanOosterom1983]; corners as seen from the origin, signed by the sense of going round.
double triangle_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double volume = glm::dot(a, glm::cross(b, c));
  const double rest = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2.0 * std::atan2(volume, rest);
}

}  // namespace

double solid_angle_sr(const SensorModelSpec& model, const ZoneSpec& zone) {
  const auto corner = [&](std::size_t i) { return on_plane(model, zone.corners[i]); };
  return std::abs(triangle_solid_angle(corner(0), corner(1), corner(2)) +
                  triangle_solid_angle(corner(0), corner(2), corner(3)));
}

std::vector<WeightedDirection> zone_quadrature(const SensorModelSpec& model, const ZoneSpec& zone, int n) {
  const auto& [c0, c1, c2, c3] = zone.corners;
  // As the zone law has it, an angle covers |(x, y, plane)| times itself along the drawing's axes.
  const double reach_m = glm::length(on_plane(model, (c0 + c1 + c2 + c3) * 0.25));
  const double blur_m = std::tan(radians(model.optics.blur_deg)) * reach_m;
  const BlurredSide along(blur_m / glm::length(c1 - c0)), across(blur_m / glm::length(c3 - c0));
  std::vector<WeightedDirection> directions;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    double ignored = 0.0;
    const double u = along.quantile((i + 0.5) / n);
    const double v = across.quantile(std::modf((i + 0.5) * std::numbers::phi, &ignored));
    const Vec2 lower = c0 * (1.0 - u) + c1 * u, upper = c3 * (1.0 - u) + c2 * u;
    const Vec3 point = on_plane(model, lower * (1.0 - v) + upper * v);
    const double distance = glm::length(point);
    directions.push_back({point / distance, 1.0 / (distance * distance * distance)});  // as a plane's area is seen
    sum += directions.back().solid_angle_sr;
  }
  const double scale = solid_angle_sr(model, zone) / sum;
  for (WeightedDirection& each : directions) each.solid_angle_sr *= scale;
  return directions;
}

}  // namespace pirsim::pir
