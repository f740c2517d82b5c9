// Soft edges, reflections and signed zones against closed forms and brute force.
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/pir/optics.hpp"
#include "engine/pir/zone_motion.hpp"
#include "engine/sim/compiled_study.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

Vec3 direction_of_corner(const Vec2& corner, double plane_m) {
  return glm::normalize(Vec3(corner.x, corner.y, -plane_m));
}

/// Angles from the zone's middle to the great circles through neighbouring corners.
std::array<double, 4> edge_angles(const ZoneSpec& zone, const Vec3& middle, double plane_m) {
  std::array<double, 4> angles{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 normal = glm::normalize(glm::cross(direction_of_corner(zone.corners[i], plane_m),
                                                  direction_of_corner(zone.corners[(i + 1) % 4], plane_m)));
    angles[i] = std::abs(std::asin(glm::dot(normal, middle)));
  }
  return angles;
}

ZoneSpec square(const Vec2& centre, double half_m) {
  return {{centre + Vec2(half_m, half_m), centre + Vec2(-half_m, half_m), centre + Vec2(-half_m, -half_m),
           centre + Vec2(half_m, -half_m)},
          1};
}

}  // namespace

TEST_CASE("growing a zone moves each of its edges outward by the angle: on the axis and far off it") {
  SensorModelSpec model;
  model.plane_m = 5.0;
  for (const Vec2 centre : {Vec2(0.0), Vec2(3.0, -2.0), Vec2(-6.0, -4.0)}) {
    const ZoneSpec zone = square(centre, 0.3);
    const Vec3 middle = direction_of_corner(centre, model.plane_m);
    const auto before = edge_angles(zone, middle, model.plane_m);
    for (const double growth : {0.01, -0.005}) {
      const auto after = edge_angles(pir::grown(model, zone, growth), middle, model.plane_m);
      for (std::size_t i = 0; i < 4; ++i) CHECK(after[i] == Approx(before[i] + growth).margin(1e-9));
    }
    for (const Vec2& corner : pir::grown(model, zone, -1.0).corners) CHECK(glm::distance(corner, centre) < 1e-9);
  }
}

TEST_CASE("somebody who crosses a soft edge is noticed with the probability of the error function") {
  // One square zone straight ahead; somebody's edge moves from one angle to another beside it.
  SensorModelSpec model;
  const double half = 0.05, sigma_deg = 1.0;
  model.clusters = {{Vec2(0.0), 10.0, 1, {square(Vec2(0.0), half)}}};
  RayBundle bundle;
  const std::vector<double> levels = pir::edge_levels(sigma_deg);
  pir::append(bundle, {"A", "m", {}}, model, RaysPerZone::five, levels);
  const pir::Channels detector(bundle, ChangePer::cluster);
  REQUIRE(detector.n_channels() == levels.size());
  const auto channels_at = [&](double reach) {  // sees everything to the left of this angle
    ZoneSet zones(detector.n_zones()), channels(detector.n_channels());
    for (std::size_t zone = 0; zone < bundle.n_zones(); ++zone) {
      for (auto i = bundle.zone_rays_begin[zone]; i < bundle.zone_rays_begin[zone + 1]; ++i) {
        const Vec3 d(bundle.rays[i].direction);
        if (std::atan2(d.x, -d.z) < reach) zones.insert(zone);
      }
    }
    detector.add_channels(zones, channels);
    return channels;
  };
  const double edge = -std::atan(half), sigma = radians(sigma_deg);
  const auto below = [&](double angle) { return 0.5 * std::erfc(-(angle - edge) / (sigma * std::sqrt(2.0))); };
  const int n_windows = 20000;
  pir::SoftEdges edges(detector, levels.size(), {sigma_deg, EdgeRule::drawn_edge}, 1, 0.02);
  edges.begin_run(1, 0, ZoneSet(detector.n_channels()));
  double largest_error = 0, largest_error_of_hard_edges = 0;
  for (const auto& [from, to] : {std::pair{-2.0, 0.0}, {-0.5, 0.5}, {0.0, 1.0}, {0.5, 2.0}, {-3.0, 3.0}, {1.8, 3.0}}) {
    const ZoneSet before = channels_at(edge + from * sigma), after = channels_at(edge + to * sigma);
    int noticed = 0;
    for (int i = 0; i < n_windows; ++i) {
      std::array<std::uint8_t, 1> bits{};
      edges.tick(before, after, bits);
      noticed += bits[0];
    }
    const double share = static_cast<double>(noticed) / n_windows;
    const double expected = below(edge + to * sigma) - below(edge + from * sigma);
    largest_error = std::max(largest_error, std::abs(share - expected));
    const double hard = from < 0.0 && to > 0.0 ? 1.0 : 0.0;
    largest_error_of_hard_edges = std::max(largest_error_of_hard_edges, std::abs(hard - expected));
  }
  // Seven levels: within half a step at either end, and the spread of 20,000 draws (standard error 0.0035).
  CHECK(largest_error < 1.0 / 7.0 + 4.0 * 0.0035);
  CHECK_FALSE(largest_error_of_hard_edges < 1.0 / 7.0 + 4.0 * 0.0035);  // must fail

  // An edge is drawn for a window: all ticks of one notice the same step, or none does, also after ticks of rest.
  constexpr int ticks = 5, windows = 400;
  pir::SoftEdges by_window(detector, levels.size(), {sigma_deg, EdgeRule::drawn_edge}, ticks, 0.02);
  by_window.begin_run(2, 0, ZoneSet(detector.n_channels()));
  const ZoneSet before = channels_at(edge - 0.7 * sigma), after = channels_at(edge + 0.7 * sigma);
  int windows_noticed = 0;
  for (int window = 0; window < windows; ++window) {
    int noticed = 0;
    for (int tick = 0; tick < ticks; ++tick) {
      std::array<std::uint8_t, 1> bits{};
      tick == 2 ? by_window.tick_unchanged(after, bits) : by_window.tick(before, after, bits);
      noticed += bits[0];
    }
    CHECK((noticed == 0 || noticed == ticks - 1));
    windows_noticed += noticed > 0;
  }
  CHECK(windows_noticed > windows / 4);
  CHECK(windows_noticed < 3 * windows / 4);
}

TEST_CASE("with soft edges somebody who sits still triggers nothing") {
  ScriptSpec script =
      script_of({person("anna", {act(action::Enter{"door"}), act(action::Sit{"S4"}), act(action::Wait{60.0})})});
  script.effects = {bare_effect("soft_zone_edges", {{"sigma_deg", 2.0}})};
  const Model model = compile(shipped_scene("meeting_room.gltf"), script);
  const auto rows = results_of(model)[0].samples;
  int moving = 0, still = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int ones = std::accumulate(rows[i].bits.begin(), rows[i].bits.end(), 0);
    (i + 58 < rows.size() ? moving : still) += ones;
  }
  CHECK(moving > 0);
  CHECK(still == 0);
}

TEST_CASE("soft edges keep the hard zones as their first copies") {
  const auto model_with = [](std::vector<EffectSpec> effects) {
    return compile(shipped_scene("meeting_room.gltf"), with(short_study_a(), std::move(effects)));
  };
  const Model hard = model_with({}), soft = model_with({bare_effect("soft_zone_edges", {{"sigma_deg", 0.5}})});
  const RayBundle &a = hard.compiled().array().rated(), &b = soft.compiled().array().rated();
  CHECK(b.n_zones() == 7 * a.n_zones());
  for (std::size_t sensor = 0; sensor < a.n_sensors(); ++sensor) {
    const std::size_t n = a.first_ray(sensor + 1) - a.first_ray(sensor);
    for (std::size_t i = 0; i < n; ++i) {
      REQUIRE(a.rays[a.first_ray(sensor) + i].direction == b.rays[b.first_ray(sensor) + i].direction);
    }
  }
}

TEST_CASE("a glossy wall shows what a mirrored person behind it would show without the wall") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  const double coefficient = 0.8;
  const Model plain = compile(scene, with(short_study_a(), {}));
  const Model glossy = compile(
      scene,
      with(short_study_a(), {bare_effect("wall_reflection", {{"coefficient", coefficient}}, {{"wall", "wall far"}})}));
  const auto wall = std::ranges::find(scene.meshes, std::string("wall far"), &TriMesh::name);
  REQUIRE(wall != scene.meshes.end());
  double front = -1e9;  // the face that looks into the room
  for (const Vec3& p : wall->positions) front = std::max(front, p.z);
  const auto active = [](const RayBundle& rays, std::size_t zone, const auto& sees) {
    for (auto i = rays.zone_rays_begin[zone]; i < rays.zone_rays_begin[zone + 1]; ++i) {
      if (sees(i)) return true;
    }
    return false;
  };
  Stream stream({5, 0, 0, Purpose::test});
  int by_reflection = 0, grazed = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Vec3f centre(0.5F + 6.0F * static_cast<float>(stream.uniform()),
                       0.4F + 1.4F * static_cast<float>(stream.uniform()),
                       -0.5F - 3.4F * static_cast<float>(stream.uniform()));
    const PosedSphere sphere{centre, 0.25F};
    const Vec3f mirrored(centre.x, centre.y, 2.0F * static_cast<float>(front) - centre.z);
    for (std::size_t zone = 0; zone < plain.compiled().array().rated().n_zones(); ++zone) {
      const RayBundle& seen = glossy.rays();
      const bool with_wall = active(
          seen, zone, [&](std::size_t i) { return entry_distance(seen.rays[i], sphere, seen.range[i]).has_value(); });
      const RayBundle& rated = plain.compiled().array().rated();
      const bool direct = active(rated, zone, [&](std::size_t i) {
        return entry_distance(rated.rays[i], sphere, plain.rays().range[i]).has_value();
      });
      const auto shows_ghost = [&](float radius) {
        return active(rated, zone, [&](std::size_t i) {
          const auto hit = plain.compiled().array().room().first_hit(rated.rays[i], rated.range[i]);
          if (!hit || scene.meshes[hit->mesh].name != "wall far") return false;
          const float reach = rated.range[i] * static_cast<float>(std::sqrt(coefficient));
          const auto behind = entry_distance(rated.rays[i], PosedSphere{mirrored, radius}, reach);
          if (!behind || *behind <= hit->distance) return false;
          // On its way back the ray must not be stopped by the table before it is there.
          const Vec3f at = rated.rays[i].origin + hit->distance * rated.rays[i].direction + 1e-3F * hit->normal;
          const Vec3f back = glm::reflect(rated.rays[i].direction, hit->normal);
          return !plain.compiled().array().room().first_hit({at, back}, *behind - hit->distance);
        });
      };
      // The mirrored ray sets out a millimetre before the wall: what a ray only grazes may go either way.
      const bool behind_the_wall = shows_ghost(0.247F);
      if (behind_the_wall != shows_ghost(0.253F)) {
        ++grazed;
        continue;
      }
      INFO("trial " << trial << ", zone " << zone);
      CHECK(with_wall == (direct || behind_the_wall));
      by_reflection += behind_the_wall && !direct ? 1 : 0;
    }
  }
  CHECK(by_reflection > 20);
  CHECK(grazed < by_reflection / 5);
}

TEST_CASE("a zone that becomes active triggers for as long as the high pass lets its step stand") {
  SceneSpec scene;
  SensorModelSpec model;
  model.clusters = {{Vec2(0.0), 10.0, 1, {square(Vec2(0.0), 0.1), square(Vec2(0.2, 0.0), 0.1)}}};
  model.clusters[0].zones[1].polarity = -1;
  scene.sensor_models["m"] = model;
  scene.sensors = {{"A", "m", {}}};
  const double tick_s = 0.001, corner_hz = 0.5, threshold = 0.3;
  pir::PolarityFilter detector(scene, {threshold, corner_hz, 100.0}, 1, tick_s);
  const auto ticks_on = [&](std::size_t n_zones_active) {
    std::array<double, 1> sums{};
    detector.begin_run(sums);
    ZoneSet zones(2);
    for (std::size_t zone = 0; zone < n_zones_active; ++zone) zones.insert(zone);
    int on = 0;
    for (int tick = 0; tick < 5000; ++tick) {
      std::array<std::uint8_t, 1> triggers{};
      detector.add_up(zones, sums);
      detector.tick(sums, triggers);
      on += triggers[0];
    }
    return on;
  };
  // exp(-2 pi f t) falls to the threshold after ln(1 / threshold) / (2 pi f).
  const double expected_s = std::log(1.0 / threshold) / (2.0 * pi * corner_hz);
  CHECK(ticks_on(1) * tick_s == Approx(expected_s).epsilon(0.02));
  CHECK(ticks_on(2) == 0);  // both signs cancel
  CHECK(ticks_on(0) == 0);
}

TEST_CASE("signed zones lose motion that is slower than the high pass") {
  SceneSpec scene;
  SensorModelSpec model;
  for (int i = 0; i < 10; ++i) model.clusters.push_back({Vec2(0.0), 10.0, 1, {square(Vec2(0.1 * i, 0.0), 0.04)}});
  scene.sensor_models["m"] = model;
  scene.sensors = {{"A", "m", {}}};
  pir::PolarityFilter detector(scene, {1.2, 0.3, 7.0}, 1, 0.02);
  const auto triggers_when_zones_come_every = [&](int ticks) {
    std::array<double, 1> sums{};
    detector.begin_run(sums);
    ZoneSet zones(10);
    int on = 0;
    for (int tick = 0; tick < 10 * ticks; ++tick) {
      if (tick % ticks == 0) zones.insert(static_cast<std::size_t>(tick / ticks));
      std::array<std::uint8_t, 1> triggers{};
      detector.add_up(zones, sums);
      detector.tick(sums, triggers);
      on += triggers[0];
    }
    return on;
  };
  CHECK(triggers_when_zones_come_every(5) > 0);
  CHECK(triggers_when_zones_come_every(150) == 0);
}
