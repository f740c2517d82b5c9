#include "engine/pir/optics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include "pirsim/geometry.hpp"

namespace pirsim::pir {
namespace {

constexpr double planck_j_s = 6.62607015e-34, light_m_s = 299792458.0, boltzmann_j_k = 1.380649e-23;

/// Radiance at wavelengths up to the given one, as a share of what 2 k^4 T^4 / (h^3 c^2) multiplies. The integral of
/// x^3 / (e^x - 1) from x to infinity, term by term in powers of e^-x.
double tail(double x) {
  constexpr double negligible = 1e-17;
  double sum = 0.0;
  for (int n = 1; n < 10000; ++n) {
    const double term =
        std::exp(-n * x) * (x * x * x / n + 3.0 * x * x / (n * n) + 6.0 * x / std::pow(n, 3) + 6.0 / std::pow(n, 4));
    sum += term;
    if (term < negligible * sum) break;
  }
  return sum;
}

Vec3 direction_through(const SensorModelSpec& model, const Vec2& point) {
  return glm::normalize(Vec3(point.x, point.y, -model.plane_m));
}

/// (u, v) in [0, 1]^2 to the zone, corners included.
Vec2 bilinear(const std::array<Vec2, 4>& corners, double u, double v) {
  const Vec2 lower = corners[0] * (1.0 - u) + corners[1] * u;
  const Vec2 upper = corners[3] * (1.0 - u) + corners[2] * u;
  return lower * (1.0 - v) + upper * v;
}

Vec2 centre_of(const std::array<Vec2, 4>& corners) {
  return (corners[0] + corners[1] + corners[2] + corners[3]) * 0.25;
}

std::vector<Vec2> zone_points(const ZoneSpec& zone, RaysPerZone rays) {
  std::vector<Vec2> points;
  if (rays == RaysPerZone::one) return {centre_of(zone.corners)};
  if (rays == RaysPerZone::five) {
    points.assign(zone.corners.begin(), zone.corners.end());
    points.push_back(centre_of(zone.corners));
    return points;
  }
  const int side = rays == RaysPerZone::nine ? 3 : 4;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      points.push_back(bilinear(zone.corners, column / (side - 1.0), row / (side - 1.0)));
    }
  }
  return points;
}

/// What the sensor sees of the zone, on the plane that touches the unit sphere in the zone's middle.
class TangentPlane {
 public:
  explicit TangentPlane(const Vec3& middle) : middle_(middle) {
    const Vec3 side = std::abs(middle.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
    right_ = glm::normalize(glm::cross(middle, side));
    up_ = glm::cross(right_, middle);
  }
  [[nodiscard]] Vec2 project(const Vec3& direction) const {
    return Vec2(glm::dot(direction, right_), glm::dot(direction, up_)) / glm::dot(direction, middle_);
  }
  [[nodiscard]] Vec3 direction(const Vec2& p) const { return glm::normalize(middle_ + p.x * right_ + p.y * up_); }

 private:
  Vec3 middle_, right_{0.0}, up_{0.0};
};

/// An edge as the line normal . p = distance, with the middle on its inner side.
struct Edge {
  Vec2 normal{0.0};
  double distance = 0.0;
};

Vec2 meeting_point(const Edge& a, const Edge& b) {
  const double det = a.normal.x * b.normal.y - a.normal.y * b.normal.x;
  return Vec2(a.distance * b.normal.y - b.distance * a.normal.y, b.distance * a.normal.x - a.distance * b.normal.x) /
         det;
}

void append_level(RayBundle& bundle, const Frame& frame, const SensorModelSpec& model, RaysPerZone rays,
                  double growth) {
  for (const ClusterSpec& cluster : model.clusters) {
    for (const ZoneSpec& zone : cluster.zones) {
      for (const Vec3& direction : zone_directions(model, grown(model, zone, growth), rays)) {
        bundle.rays.push_back({Vec3f(frame.origin), Vec3f(glm::normalize(frame.rotation * direction))});
        bundle.range.push_back(static_cast<float>(cluster.range_m));
      }
      bundle.zone_rays_begin.push_back(static_cast<std::uint32_t>(bundle.rays.size()));
    }
    bundle.cluster_zones_begin.push_back(static_cast<std::uint32_t>(bundle.n_zones()));
  }
}

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

/// Quantiles at the same shares of many sides. Zones that look alike are blurred alike, and each blur is worked out
/// once.
class BlurredSides {
 public:
  explicit BlurredSides(std::vector<double> shares) : shares_(std::move(shares)) {}

  /// (n_shares)
  const std::vector<double>& quantiles(double sigma) {
    std::vector<double>& known = known_[sigma];
    const BlurredSide side(sigma);
    for (std::size_t i = known.size(); i < shares_.size(); ++i) known.push_back(side.quantile(shares_[i]));
    return known;
  }

 private:
  std::vector<double> shares_;
  std::map<double, std::vector<double>> known_;  ///< by sigma
};

Vec3 on_plane(const SensorModelSpec& model, const Vec2& point) { return {point.x, point.y, -model.plane_m}; }

/// Ref: [VanOosterom1983]; corners as seen from the origin, signed by the sense of going round.
double triangle_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double volume = glm::dot(a, glm::cross(b, c));
  const double rest = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2.0 * std::atan2(volume, rest);
}

/// A zone as its point spread blurs it, over the unit square.
class BlurredZone {
 public:
  BlurredZone(const SensorModelSpec& model, const ZoneSpec& zone) : model_(model), zone_(zone) {}

  [[nodiscard]] double sigma_along() const { return sigma(1); }
  [[nodiscard]] double sigma_across() const { return sigma(3); }
  /// Through points of the square, each worth as much of the zone.
  [[nodiscard]] std::vector<WeightedDirection> through(std::span<const Vec2> points) const {
    std::vector<WeightedDirection> directions;
    double sum = 0.0;
    for (const Vec2& at : points) {
      const Vec3 point = on_plane(model_, bilinear(zone_.corners, at.x, at.y));
      const double distance = glm::length(point);
      directions.push_back({point / distance, 1.0 / (distance * distance * distance)});  // as a plane's area is seen
      sum += directions.back().solid_angle_sr;
    }
    const double scale = solid_angle_sr(model_, zone_) / sum;
    for (WeightedDirection& each : directions) each.solid_angle_sr *= scale;
    return directions;
  }

 private:
  /// Of the side from the first corner to another one. As the zone law has it, an angle covers |(x, y, plane)| times
  /// itself along the drawing's axes.
  [[nodiscard]] double sigma(std::size_t corner) const {
    const double reach_m = glm::length(on_plane(model_, centre_of(zone_.corners)));
    const double blur_m = std::tan(radians(model_.optics.blur_deg)) * reach_m;
    return blur_m / glm::length(zone_.corners[corner] - zone_.corners[0]);
  }

  const SensorModelSpec& model_;
  const ZoneSpec& zone_;
};

constexpr double coldest_c = -80.0, warmest_c = 350.0, thermometer_step_k = 0.25;

}  // namespace

Thermometer::Thermometer(const Band& band) {
  for (int i = 0; i <= (warmest_c - coldest_c) / thermometer_step_k; ++i)
    log_radiances_.push_back(std::log(band_radiance(kelvin(coldest_c + i * thermometer_step_k), band)));
}

double Thermometer::celsius(double radiance) const noexcept {
  if (!(radiance > 0.0)) return coldest_c;
  const double wanted = std::log(radiance);
  const auto above = std::ranges::upper_bound(log_radiances_, wanted);
  if (above == log_radiances_.begin()) return coldest_c;
  if (above == log_radiances_.end()) return warmest_c;
  const double below = *(above - 1);
  return coldest_c + thermometer_step_k * (static_cast<double>(above - 1 - log_radiances_.begin()) +
                                           (wanted - below) / (*above - below));
}

Vec2 lattice_point(int i, int n) {
  double ignored = 0.0;
  return {(i + 0.5) / n, std::modf((i + 0.5) * std::numbers::phi, &ignored)};
}

double band_radiance(double temperature_k, const Band& band) {
  if (temperature_k <= 0.0) return 0.0;
  const double thermal_j = boltzmann_j_k * temperature_k;
  const auto x_of = [&](double wavelength_um) { return planck_j_s * light_m_s / (wavelength_um * 1e-6 * thermal_j); };
  const double scale = 2.0 * std::pow(thermal_j, 4) / (std::pow(planck_j_s, 3) * light_m_s * light_m_s);
  return scale * (tail(x_of(band.to_um)) - tail(x_of(band.from_um)));
}

ZoneSpec grown(const SensorModelSpec& model, const ZoneSpec& zone, double angle) {
  if (angle == 0.0) return zone;
  const TangentPlane plane(direction_through(model, centre_of(zone.corners)));
  std::array<Vec2, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) corners[i] = plane.project(direction_through(model, zone.corners[i]));
  std::array<Edge, 4> edges{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 along = glm::normalize(corners[(i + 1) % 4] - corners[i]);
    Vec2 normal(along.y, -along.x);
    double distance = glm::dot(normal, corners[i]);
    if (distance < 0.0) {
      normal = -normal;
      distance = -distance;
    }
    edges[i] = {normal, std::tan(std::max(0.0, std::atan(distance) + angle))};
  }
  ZoneSpec result = zone;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 d = plane.direction(meeting_point(edges[(i + 3) % 4], edges[i]));
    // What has grown beyond the lens's plane ends close before it.
    constexpr double least_ahead = 1e-3;
    result.corners[i] = Vec2(d.x, d.y) * (model.plane_m / std::max(least_ahead, -d.z));
  }
  return result;
}

std::vector<double> edge_levels(double sigma_deg) {
  if (sigma_deg <= 0.0) return {0.0};
  // Of the standard normal distribution at 1/14, 3/14, ..., 13/14.
  constexpr std::array quantiles{0.0, -0.366106357, 0.366106357, -0.791638608, 0.791638608, -1.465233793, 1.465233793};
  std::vector<double> levels;
  for (const double quantile : quantiles) levels.push_back(quantile * radians(sigma_deg));
  return levels;
}

std::vector<Vec3> zone_directions(const SensorModelSpec& model, const ZoneSpec& zone, RaysPerZone rays) {
  std::vector<Vec3> directions;
  for (const Vec2& point : zone_points(zone, rays)) directions.push_back(direction_through(model, point));
  return directions;
}

void append(RayBundle& bundle, const SensorSpec& sensor, const SensorModelSpec& model, RaysPerZone rays,
            std::span<const double> levels) {
  constexpr std::array hard{0.0};
  for (const double growth : levels.empty() ? std::span<const double>(hard) : levels) {
    append_level(bundle, sensor.world_from_sensor, model, rays, growth);
  }
  bundle.sensor_clusters_begin.push_back(static_cast<std::uint32_t>(bundle.n_clusters()));
}

double solid_angle_sr(const SensorModelSpec& model, const ZoneSpec& zone) {
  const auto corner = [&](std::size_t i) { return on_plane(model, zone.corners[i]); };
  return std::abs(triangle_solid_angle(corner(0), corner(1), corner(2)) +
                  triangle_solid_angle(corner(0), corner(2), corner(3)));
}

std::vector<WeightedDirection> zone_quadrature(const SensorModelSpec& model, std::span<const ZoneSpec> zones, int n) {
  std::vector<double> xs, ys;
  for (int i = 0; i < n; ++i) {
    const Vec2 at = lattice_point(i, n);
    xs.push_back(at.x);
    ys.push_back(at.y);
  }
  BlurredSides along(std::move(xs)), across(std::move(ys));
  std::vector<WeightedDirection> directions;
  for (const ZoneSpec& zone : zones) {
    const BlurredZone blurred(model, zone);
    const std::vector<double>&us = along.quantiles(blurred.sigma_along()),
          &vs = across.quantiles(blurred.sigma_across());
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < us.size(); ++i) points.emplace_back(us[i], vs[i]);
    std::ranges::copy(blurred.through(points), std::back_inserter(directions));
  }
  return directions;
}

std::vector<std::vector<WeightedDirection>> symmetric_quadrature(const SensorModelSpec& model,
                                                                 std::span<const ZoneSpec> zones, int n) {
  const auto n_points = static_cast<std::size_t>(n / 8);
  std::vector<double> shares(2 * n_points);  // all x, then all y
  for (std::size_t i = 0; i < n_points; ++i) {
    const Vec2 at = lattice_point(static_cast<int>(i), n / 8);
    shares[i] = at.x;
    shares[n_points + i] = at.y;
  }
  BlurredSides sides(std::move(shares));
  std::vector<std::vector<WeightedDirection>> directions;
  for (const ZoneSpec& zone : zones) {
    const BlurredZone blurred(model, zone);
    const std::vector<double>&us = sides.quantiles(blurred.sigma_along()),
          &vs = sides.quantiles(blurred.sigma_across());
    std::vector<Vec2> points;
    const auto add_mirrored = [&](double along, double across) {
      for (const double u : {along, 1.0 - along}) {
        for (const double v : {across, 1.0 - across}) points.emplace_back(u, v);
      }
    };
    for (std::size_t i = 0; i < n_points; ++i) {
      add_mirrored(us[i], vs[n_points + i]);
      add_mirrored(us[n_points + i], vs[i]);
    }
    directions.push_back(blurred.through(points));
  }
  return directions;
}

double aperture_m2(const OpticsSpec& optics) noexcept {
  constexpr double m2_per_mm2 = 1e-6;
  return optics.aperture_mm2 * m2_per_mm2;
}

std::vector<WeightedDirection> lens_quadrature(const SensorModelSpec& model, int rays_per_zone) {
  std::vector<ZoneSpec> zones;
  for (const ClusterSpec& cluster : model.clusters)
    zones.insert(zones.end(), cluster.zones.begin(), cluster.zones.end());
  return zone_quadrature(model, zones, rays_per_zone);
}

void append(PowerRays& rays, const SensorSpec& sensor, const SensorModelSpec& model,
            std::span<const WeightedDirection> quadrature) {
  const Frame& frame = sensor.world_from_sensor;
  RayBundle& bundle = rays.bundle;
  std::size_t n_zones = 0;
  for (const ClusterSpec& cluster : model.clusters) n_zones += cluster.zones.size();
  const std::size_t rays_per_zone = n_zones == 0 ? 0 : quadrature.size() / n_zones;
  for (const ClusterSpec& cluster : model.clusters) {
    for (const ZoneSpec& zone : cluster.zones) {
      for (const WeightedDirection& each : quadrature.first(rays_per_zone)) {
        bundle.rays.push_back({Vec3f(frame.origin), Vec3f(glm::normalize(frame.rotation * each.direction))});
        bundle.range.push_back(out_of_sight_m);
        rays.weights.push_back(zone.polarity * aperture_m2(model.optics) * each.solid_angle_sr);
      }
      quadrature = quadrature.subspan(rays_per_zone);
      bundle.zone_rays_begin.push_back(static_cast<std::uint32_t>(bundle.rays.size()));
    }
    bundle.cluster_zones_begin.push_back(static_cast<std::uint32_t>(bundle.n_zones()));
  }
  append_blind(rays);
}

void append_blind(PowerRays& rays) {
  rays.bundle.sensor_clusters_begin.push_back(static_cast<std::uint32_t>(rays.bundle.n_clusters()));
}

void blind(RayBundle& bundle, const SceneSpec& scene, const BlindFieldSpec& field) {
  constexpr float blind_m = 0.01F;  // range of a ray that sees nothing
  const double side = radians(field.side_deg);
  for (const std::uint32_t sensor : field.sensors) {
    const Quat sensor_from_world = glm::conjugate(scene.sensors[sensor].world_from_sensor.rotation);
    std::vector<std::pair<double, std::size_t>> towards_side;  // (n_rays) how far, and which
    for (std::size_t i = bundle.first_ray(sensor); i < bundle.first_ray(sensor + 1); ++i) {
      const Vec3 d = sensor_from_world * Vec3(bundle.rays[i].direction);
      towards_side.emplace_back(std::cos(side) * d.x + std::sin(side) * d.y, i);
    }
    const auto n = static_cast<std::size_t>(std::llround(field.share * static_cast<double>(towards_side.size())));
    std::ranges::sort(towards_side, std::greater{});
    for (std::size_t i = 0; i < n; ++i) bundle.range[towards_side[i].second] = blind_m;
  }
}

}  // namespace pirsim::pir
