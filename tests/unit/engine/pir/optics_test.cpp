#include "engine/pir/optics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/pir/zone_motion.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/plain_motion.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using pir::band_radiance;
using pir::kelvin;
using pirsim::test::wall_lens;

namespace {

Quat tilted_down(double degrees) { return glm::angleAxis(-degrees * M_PI / 180.0, Vec3(1, 0, 0)); }

RayBundle bundle_of(const SensorModelSpec& model, const Frame& frame, RaysPerZone rays) {
  RayBundle bundle;
  pir::append(bundle, {"S", model.id, frame}, model, rays);
  return bundle;
}

/// Three sensors: one cluster of two zones; two clusters of one zone; none.
RayBundle small_bundle() {
  RayBundle bundle;
  bundle.zone_rays_begin = {0, 1, 2, 3, 4};
  bundle.cluster_zones_begin = {0, 2, 3, 4};
  bundle.sensor_clusters_begin = {0, 1, 3, 3};
  return bundle;
}
void mark(ChangePer per, const std::array<std::uint8_t, 4>& before, const std::array<std::uint8_t, 4>& after,
          std::array<std::uint8_t, 3>& bits) {
  const pir::Channels detector(small_bundle(), per);
  const auto channels_of = [&](const std::array<std::uint8_t, 4>& activity) {
    ZoneSet zones(activity.size()), channels(detector.n_channels());
    for (std::size_t zone = 0; zone < activity.size(); ++zone) {
      if (activity[zone] != 0) zones.insert(zone);
    }
    detector.add_channels(zones, channels);
    return channels;
  };
  detector.mark(channels_of(before).words(), channels_of(after).words(), bits);
}

std::array<std::uint8_t, 3> motion(ChangePer per, std::array<std::uint8_t, 4> before,
                                   std::array<std::uint8_t, 4> after) {
  std::array<std::uint8_t, 3> bits{}, plain{};
  mark(per, before, after, bits);
  test::mark_motion(small_bundle(), per, before, after, plain);
  CHECK(bits == plain);
  return bits;
}

double whole_radiance(double temperature_k) {
  constexpr double stefan_boltzmann = 5.670374419e-8;  // W m^-2 K^-4, CODATA 2018
  return stefan_boltzmann * temperature_k * temperature_k * temperature_k * temperature_k / pi;
}

}  // namespace

TEST_CASE("the wall lens gives 340 rays with the rated ranges", "[optics]") {
  const RayBundle bundle = bundle_of(wall_lens(), {}, RaysPerZone::five);
  CHECK(bundle.rays.size() == 340);
  CHECK(bundle.n_zones() == 68);
  CHECK(bundle.n_clusters() == 17);
  CHECK(bundle.n_sensors() == 1);
  CHECK(std::count(bundle.range.begin(), bundle.range.end(), 12.0F) == 28 * 5);
  CHECK(std::count(bundle.range.begin(), bundle.range.end(), 6.0F) == 24 * 5);
  CHECK(std::count(bundle.range.begin(), bundle.range.end(), 3.0F) == 16 * 5);
  for (std::size_t zone = 0; zone < bundle.n_zones(); ++zone) {
    CHECK(bundle.zone_rays_begin[zone + 1] - bundle.zone_rays_begin[zone] == 5);
  }
  for (const Ray& ray : bundle.rays) CHECK(glm::length(ray.direction) == Approx(1.0).margin(1e-6));
}

TEST_CASE("1, 5, 9 and 16 rays a zone are 68, 340, 612 and 1088 a sensor", "[optics]") {
  const SensorModelSpec model = wall_lens();
  CHECK(bundle_of(model, {}, RaysPerZone::one).rays.size() == 68);
  CHECK(bundle_of(model, {}, RaysPerZone::nine).rays.size() == 612);
  CHECK(bundle_of(model, {}, RaysPerZone::sixteen).rays.size() == 1088);
}

TEST_CASE("a zone's points span it evenly from corner to corner", "[optics]") {
  SensorModelSpec model;
  model.plane_m = 2.0;
  ZoneSpec zone;
  zone.corners = {Vec2(1, 1), Vec2(4, 1), Vec2(4, 4), Vec2(1, 4)};
  const auto points = [&](RaysPerZone rays) {
    std::vector<std::pair<double, double>> found;
    for (const Vec3& d : pir::zone_directions(model, zone, rays)) {
      CHECK(glm::length(d) == Approx(1.0));
      found.emplace_back(std::round(1e9 * d.x / -d.z * 2.0) / 1e9, std::round(1e9 * d.y / -d.z * 2.0) / 1e9);
    }
    std::sort(found.begin(), found.end());
    return found;
  };
  using Points = std::vector<std::pair<double, double>>;
  CHECK(points(RaysPerZone::one) == Points{{2.5, 2.5}});
  CHECK(points(RaysPerZone::five) == Points{{1, 1}, {1, 4}, {2.5, 2.5}, {4, 1}, {4, 4}});
  Points grid;
  for (const double x : {1.0, 2.5, 4.0}) {
    for (const double y : {1.0, 2.5, 4.0}) grid.emplace_back(x, y);
  }
  CHECK(points(RaysPerZone::nine) == grid);
  grid.clear();
  for (const double x : {1.0, 2.0, 3.0, 4.0}) {
    for (const double y : {1.0, 2.0, 3.0, 4.0}) grid.emplace_back(x, y);
  }
  CHECK(points(RaysPerZone::sixteen) == grid);
}

TEST_CASE("a second sensor's groups follow the first one's", "[optics]") {
  const SensorModelSpec model = wall_lens();
  RayBundle bundle = bundle_of(model, {}, RaysPerZone::one);
  pir::append(bundle, {"T", model.id, {Quat(1, 0, 0, 0), Vec3(1, 2, 3)}}, model, RaysPerZone::one);
  CHECK(bundle.sensor_clusters_begin == std::vector<std::uint32_t>{0, 17, 34});
  CHECK(bundle.cluster_zones_begin.back() == 136);
  CHECK(bundle.zone_rays_begin.back() == 136);
  CHECK(bundle.rays[68].origin == Vec3f(1, 2, 3));
  CHECK(bundle.rays[68].direction == bundle.rays[0].direction);
}

TEST_CASE("a sensor that is turned and tilted turns its rays about its own axes", "[optics]") {
  SensorModelSpec model;
  model.plane_m = 1.0;
  ClusterSpec cluster;
  cluster.range_m = 2.0;
  ZoneSpec zone;  // all corners straight ahead
  cluster.zones.push_back(zone);
  model.clusters.push_back(cluster);
  const Frame frame{rotation_from_heading(M_PI / 2) * tilted_down(30.0), Vec3(0)};  // facing -X, 30 degrees down
  const Ray ray = bundle_of(model, frame, RaysPerZone::one).rays[0];
  CHECK(ray.direction.x == Approx(-std::cos(M_PI / 6)).margin(1e-6));
  CHECK(ray.direction.y == Approx(-0.5).margin(1e-6));
  CHECK(ray.direction.z == Approx(0.0).margin(1e-6));
}

TEST_CASE("a mirrored sensor has exactly mirrored rays", "[optics]") {
  const SensorModelSpec model = wall_lens();
  SensorModelSpec mirrored = model;
  for (ClusterSpec& cluster : mirrored.clusters) {
    for (ZoneSpec& zone : cluster.zones) {
      for (Vec2& corner : zone.corners) corner.x = -corner.x;
    }
  }
  const Quat q = glm::normalize(rotation_from_heading(0.3) * tilted_down(20.0));
  const Frame frame{q, Vec3(1.25, 2.65, 0.5)};
  const Frame mirrored_frame{Quat(q.w, q.x, -q.y, -q.z), Vec3(-1.25, 2.65, 0.5)};
  for (const RaysPerZone rays : {RaysPerZone::one, RaysPerZone::five, RaysPerZone::nine, RaysPerZone::sixteen}) {
    const RayBundle a = bundle_of(model, frame, rays);
    const RayBundle b = bundle_of(mirrored, mirrored_frame, rays);
    const Vec3f flip(-1, 1, 1);
    bool same = a.range == b.range;
    for (std::size_t i = 0; i < a.rays.size(); ++i) {
      same = same && a.rays[i].direction == flip * b.rays[i].direction && a.rays[i].origin == flip * b.rays[i].origin;
    }
    CHECK(same);
  }
}

// Of the five rays a zone that pass the plane `distance` from the wall within their range and between the heights of
// a seated torso (0.70 to 1.40 m), the one farthest to the side.
TEST_CASE("at the paper's mounting the beams reach as far sideways as the design table says", "[optics]") {
  const Frame frame{tilted_down(20.0), Vec3(0, 2.65, 0)};
  const RayBundle bundle = bundle_of(wall_lens(), frame, RaysPerZone::five);
  const std::array<std::pair<double, double>, 6> table{
      {{1.0, 1.49}, {1.2, 1.87}, {1.5, 2.40}, {2.0, 3.06}, {2.8, 4.46}, {3.6, 5.85}}};
  for (const auto& [distance, expected] : table) {
    double reach = 0.0;
    for (std::size_t i = 0; i < bundle.rays.size(); ++i) {
      const Vec3f& d = bundle.rays[i].direction;
      if (d.z >= 0.0F) continue;
      const double t = distance / -d.z;
      const double height = 2.65 + t * d.y;
      if (t <= bundle.range[i] && height >= 0.70 && height <= 1.40) reach = std::max(reach, std::abs(t * d.x));
    }
    INFO("distance " << distance);
    CHECK(std::abs(reach - expected) < 0.006);  // the table has two decimals
  }
}

TEST_CASE("motion per beam is any zone that changes", "[optics]") {
  using Bits = std::array<std::uint8_t, 3>;
  const auto per = ChangePer::beam;
  CHECK(motion(per, {0, 0, 0, 0}, {0, 0, 0, 0}) == Bits{0, 0, 0});
  CHECK(motion(per, {1, 1, 1, 1}, {1, 1, 1, 1}) == Bits{0, 0, 0});
  CHECK(motion(per, {0, 0, 0, 0}, {1, 0, 0, 0}) == Bits{1, 0, 0});
  CHECK(motion(per, {1, 0, 0, 0}, {0, 1, 0, 0}) == Bits{1, 0, 0});
  CHECK(motion(per, {1, 1, 0, 0}, {1, 0, 0, 0}) == Bits{1, 0, 0});
  CHECK(motion(per, {0, 0, 1, 0}, {0, 0, 0, 1}) == Bits{0, 1, 0});
}

TEST_CASE("motion per cluster is a cluster that falls silent or wakes", "[optics]") {
  using Bits = std::array<std::uint8_t, 3>;
  const auto per = ChangePer::cluster;
  for (unsigned before = 0; before < 4; ++before) {  // both zones of the first cluster, every way
    for (unsigned after = 0; after < 4; ++after) {
      const auto bit = [](unsigned value, unsigned index) { return static_cast<std::uint8_t>((value >> index) & 1U); };
      const Bits bits = motion(per, {bit(before, 0), bit(before, 1), 1, 0}, {bit(after, 0), bit(after, 1), 1, 0});
      CHECK(bits == Bits{static_cast<std::uint8_t>((before == 0) != (after == 0)), 0, 0});
    }
  }
  CHECK(motion(per, {0, 0, 1, 0}, {0, 0, 0, 1}) == Bits{0, 1, 0});  // two clusters of one sensor
}

TEST_CASE("a bit once set stays set", "[optics]") {
  std::array<std::uint8_t, 3> bits{1, 0, 1};
  const std::array<std::uint8_t, 4> still{};
  mark(ChangePer::beam, still, still, bits);
  CHECK(bits == std::array<std::uint8_t, 3>{1, 0, 1});
}

TEST_CASE("a zone that grows beyond the lens's plane stays on its side", "[optics]") {
  SensorModelSpec model = wall_lens();
  ZoneSpec zone;
  const double near_plane = std::tan(84.0 * M_PI / 180.0) * model.plane_m;
  zone.corners = {Vec2(near_plane, -0.1), Vec2(near_plane + 0.2, -0.1), Vec2(near_plane + 0.2, 0.1),
                  Vec2(near_plane, 0.1)};
  for (const double degrees_grown : {1.0, 5.0, 10.0}) {
    const ZoneSpec grown = pir::grown(model, zone, degrees_grown * M_PI / 180.0);
    for (const Vec3& direction : pir::zone_directions(model, grown, RaysPerZone::five)) {
      CHECK(direction.x > 0.0);
      CHECK(direction.z < 0.0);
    }
  }
}

TEST_CASE("the radiance in a band is the share that published tables give", "[pir][planck]") {
  // Howell, Menguc, Daun, Siegel, Thermal Radiation Heat Transfer, appendix: F(0 to lambda T), lambda T in um K.
  struct Row {
    double lambda_t, fraction;
  };
  const Row rows[] = {{1000, 0.00032}, {2000, 0.06673}, {3000, 0.27323}, {6000, 0.73779}, {10000, 0.91416}};
  for (const double temperature_k : {250.0, 293.15, 310.0}) {
    for (const Row& row : rows) {
      const double share =
          band_radiance(temperature_k, {0.1, row.lambda_t / temperature_k}) / whole_radiance(temperature_k);
      CHECK(share == Approx(row.fraction).margin(1e-5));
    }
  }
}

TEST_CASE("the radiance in a band is the integral of Planck's law over it", "[pir][planck]") {
  const auto spectral = [](double wavelength_um, double temperature_k) {  // W m^-2 sr^-1 um^-1
    constexpr double c1 = 2.0 * 6.62607015e-34 * 299792458.0 * 299792458.0,
                     c2 = 6.62607015e-34 * 299792458.0 / 1.380649e-23;
    const double metres = wavelength_um * 1e-6;
    return c1 / std::pow(metres, 5) / std::expm1(c2 / (metres * temperature_k)) * 1e-6;
  };
  for (const double temperature_k : {263.15, 293.15, 309.0, 473.15}) {
    constexpr int n = 900;  // Simpson's rule
    constexpr double step = 9.0 / n;
    double sum = spectral(5.0, temperature_k) + spectral(14.0, temperature_k);
    for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * spectral(5.0 + i * step, temperature_k);
    CHECK(band_radiance(temperature_k) == Approx(sum * step / 3.0).epsilon(1e-9));
  }
}

TEST_CASE("the radiance in the sensor's band rises with temperature and is nothing at absolute zero", "[pir][planck]") {
  CHECK(band_radiance(0.0) == 0.0);
  double before = 0.0;
  for (double temperature_k = 200.0; temperature_k < 400.0; temperature_k += 0.5) {
    CHECK(band_radiance(temperature_k) > before);
    before = band_radiance(temperature_k);
  }
  CHECK(kelvin(20.0) == 293.15);
}
