#include "engine/pir/optics.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "pirsim/geometry.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using pir::solid_angle_sr;
using pir::WeightedDirection;
using pir::zone_quadrature;
using test::wall_lens;

namespace {

/// A rectangular zone straight ahead.
struct AheadZone {
  SensorModelSpec model;
  ZoneSpec zone;
};
AheadZone ahead(double width_m, double height_m, double plane_m, double blur_deg) {
  AheadZone result;
  result.model.plane_m = plane_m;
  result.model.optics.blur_deg = blur_deg;
  const double x = 0.5 * width_m, y = 0.5 * height_m;
  result.zone.corners = {Vec2(-x, -y), Vec2(x, -y), Vec2(x, y), Vec2(-x, y)};
  return result;
}

}  // namespace

TEST_CASE("a rectangle straight ahead has the solid angle of a pyramid", "[pir][quadrature]") {
  for (const auto& [a, b, d] : {std::array{0.3, 0.3, 5.0}, {2.0, 7.0, 3.0}, {40.0, 40.0, 0.1}}) {
    const AheadZone given = ahead(a, b, d, 0.0);
    const double expected = 4.0 * std::asin(a * b / std::sqrt((4 * d * d + a * a) * (4 * d * d + b * b)));
    CHECK(solid_angle_sr(given.model, given.zone) == Approx(expected).epsilon(1e-12));
  }
}

TEST_CASE("the weights of a zone's rays sum to its solid angle whatever their number and the blur",
          "[pir][quadrature]") {
  SensorModelSpec model = wall_lens();
  for (const double blur_deg : {0.0, 0.5, 1.1}) {
    model.optics.blur_deg = blur_deg;
    for (const ClusterSpec& cluster : model.clusters) {
      for (const ZoneSpec& zone : cluster.zones) {
        for (const int n : {1, 5, 34, 100}) {
          double sum = 0.0;
          for (const WeightedDirection& ray : zone_quadrature(model, {&zone, 1}, n)) sum += ray.solid_angle_sr;
          CHECK(sum == Approx(solid_angle_sr(model, zone)).epsilon(1e-12));
        }
      }
    }
  }
}

TEST_CASE("the rays spread as far as a zone convolved with its blur does", "[pir][quadrature]") {
  constexpr double side_m = 0.3, plane_m = 5.0;
  for (const double blur_deg : {0.0, 0.3, 0.8}) {
    const AheadZone given = ahead(side_m, side_m, plane_m, blur_deg);
    double sum = 0.0, squares = 0.0, mean = 0.0;
    for (const WeightedDirection& ray : zone_quadrature(given.model, {&given.zone, 1}, 5000)) {
      const double x = ray.direction.x / -ray.direction.z * plane_m;
      sum += ray.solid_angle_sr;
      mean += ray.solid_angle_sr * x;
      squares += ray.solid_angle_sr * x * x;
    }
    const double blur_m = plane_m * std::tan(radians(blur_deg));
    CHECK(mean / sum == Approx(0.0).margin(1e-4 * side_m));
    CHECK(squares / sum == Approx(side_m * side_m / 12.0 + blur_m * blur_m).epsilon(0.004));
  }
}

TEST_CASE("a sharp zone's rays all lie inside it and cover half of it with half of the weight", "[pir][quadrature]") {
  const AheadZone given = ahead(0.3, 0.2, 5.0, 0.0);
  for (const int n : {34, 233}) {
    double left = 0.0, sum = 0.0;
    for (const WeightedDirection& ray : zone_quadrature(given.model, {&given.zone, 1}, n)) {
      const Vec3 point = ray.direction * (5.0 / -ray.direction.z);
      CHECK(std::abs(point.x) <= 0.15);
      CHECK(std::abs(point.y) <= 0.10);
      sum += ray.solid_angle_sr;
      if (point.y + 0.4 * point.x < 0.0) left += ray.solid_angle_sr;
    }
    CHECK(left / sum == Approx(0.5).margin(1.5 / n));
  }
}
