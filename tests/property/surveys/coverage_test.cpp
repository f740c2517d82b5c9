// Coverage maps against the plain tracer, against symmetry and against geometry done another way.
#include "surveys/coverage.hpp"

#include <glm/geometric.hpp>

#include "engine/pir/optics.hpp"
#include "engine/pir/zone_motion.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/plain_motion.hpp"
#include "support/random_scene.hpp"
#include "support/shipped.hpp"
#include "support/zone_bytes.hpp"

using namespace pirsim;
using namespace pirsim::studies;
using pirsim::testing::box_mesh;
using pirsim::testing::Draw;

namespace {

CoverageSpec study_b(const std::vector<std::string>& overrides = {}) {
  return io::read_coverage(test::data("studies/studyB.yaml"), overrides);
}

/// Tick by tick with the reference tracer, as the simulation itself does it.
std::vector<MotionCount> plain_counts(const CoverageStudy& study, const Vec2& point) {
  const RayBundle& rays = study.survey().array().rated();
  const auto tracer = rt::make_tracer(
      TracerKind::reference,
      {&study.survey().array().room(), &study.survey().array().rated(), &study.survey().array().clipped()});
  const Vec3 foot(point.x, study.scene().floor.height_m(), point.y);
  test::ZoneBytes before, after = test::seen_by(*tracer, study.target().solids(foot, 0), rays.n_zones());
  std::vector<MotionCount> counts(rays.n_sensors(), 0);
  std::int64_t tick = 0;
  for (int window = 0; window < study.n_windows(); ++window) {
    std::vector<std::uint8_t> bits(rays.n_sensors(), 0);
    for (int i = 0; i < study.spec().sensing.ticks_per_window; ++i) {
      before = std::exchange(after, test::seen_by(*tracer, study.target().solids(foot, ++tick), rays.n_zones()));
      test::mark_motion(rays, study.spec().sensing.change_per, before, after, bits);
    }
    for (std::size_t s = 0; s < bits.size(); ++s) counts[s] = static_cast<MotionCount>(counts[s] + bits[s]);
  }
  return counts;
}

/// Checks random squares; returns how many counts weren't zero.
int check_against_plain(const CoverageStudy& study, std::uint64_t seed, int n_squares) {
  Draw draw(seed);
  int seen = 0;
  for (int i = 0; i < n_squares; ++i) {
    const auto column = draw.index(static_cast<std::uint32_t>(study.grid().n_columns()));
    const auto row = draw.index(static_cast<std::uint32_t>(study.grid().n_rows()));
    const Vec2 centre = study.grid().centre(column, row);
    const std::vector<MotionCount> counts = study.counts_at(centre);
    INFO("square at " << centre.x << ", " << centre.y);
    CHECK(counts == plain_counts(study, centre));
    for (const auto count : counts) seen += count > 0 ? 1 : 0;
  }
  return seen;
}

/// A hall of 8 x 6 m, symmetric in x, with one sensor on the wall z = 0; things can be put in.
SceneSpec symmetric_hall(std::vector<TriMesh> things = {}) {
  SceneSpec scene;
  scene.name = "hall";
  scene.floor = FloorArea({{{-4, -6}, {4, -6}, {4, 0}, {-4, 0}}}, 0.0);
  scene.meshes = {box_mesh({-4.1, -0.1, -6.1}, {4.1, 0.0, 0.1}), box_mesh({-4.1, 0.0, -6.1}, {-4.0, 3.0, 0.1}),
                  box_mesh({4.0, 0.0, -6.1}, {4.1, 3.0, 0.1}), box_mesh({-4.0, 0.0, -6.1}, {4.0, 3.0, -6.0})};
  for (TriMesh& thing : things) scene.meshes.push_back(std::move(thing));
  scene.sensors = {{"PIR", "EKMC1604111", Frame{glm::angleAxis(radians(-20.0), Vec3(1, 0, 0)), {0.0, 2.65, -0.03}}}};
  scene.sensor_models["EKMC1604111"] = io::read_sensor_model(test::data("sensors/EKMC1604111.yaml"));
  return scene;
}

CoverageSpec coarse(double spacing_m = 0.1) {
  CoverageSpec spec;
  spec.sensing.response = Response::zones;
  spec.spacing_m = spacing_m;
  return spec;
}

std::size_t seen_squares(const CoverageMap& map) {
  return map.counts.size() - static_cast<std::size_t>(std::ranges::count(map.counts, 0));
}

}  // namespace

TEST_CASE("the fast map of Study B equals the plain tracer's in random squares, bit for bit", "[coverage][seconds]") {
  const CoverageStudy study(test::shipped_scene("meeting_room.gltf"), study_b({"duration_s=18"}));
  REQUIRE(study.target().n_poses() == 180);  // 2 deg a tick
  CHECK(check_against_plain(study, 1, 8) > 8);
}

TEST_CASE("so it does for beams, and for turns that never repeat", "[coverage]") {
  const auto spec = study_b({"duration_s=4", "sensing.change_per=beam", "target.x_shapes.turns.0.deg_per_s=73.13"});
  const CoverageStudy study(test::shipped_scene("meeting_room.gltf"), spec);
  REQUIRE(study.target().n_poses() == 201);
  CHECK(check_against_plain(study, 2, 12) > 12);
}

TEST_CASE("a cone that misses a sphere has no ray that may hit it, and a cone of a zone misses most spheres",
          "[coverage]") {
  Draw draw(17);
  std::size_t passed_over = 0, rays_near = 0;
  for (int round = 0; round < 4000; ++round) {
    // From a beam's five rays to a spray from origins half a metre apart, shorter and longer than the way to the
    // sphere.
    const double turn = draw.between(0.0, 0.2), apart_m = round % 4 != 0 ? 0.0 : draw.between(0.0, 0.5);
    const Vec3 axis = draw.direction();
    RayBundle bundle;
    for (int i = 0; i < 5; ++i) {
      bundle.rays.push_back({Vec3f(apart_m * draw.direction()), Vec3f(glm::normalize(axis + turn * draw.direction()))});
      bundle.range.push_back(static_cast<float>(draw.between(0.5, 8.0)));
    }
    const Vec3 middle = draw.between(0.1, 8.0) * glm::normalize(axis + draw.between(0.0, 0.6) * draw.direction());
    const double reach_m = draw.between(0.05, 0.5);
    bool near = false;
    for (std::size_t i = 0; i < bundle.rays.size(); ++i) {
      near = near || may_hit(bundle.rays[i], bundle.range[i], middle, reach_m);
    }
    rays_near += near ? 1 : 0;
    const rt::ViewCone cone = rt::cone_around(bundle.rays, bundle.range);
    if (rt::may_touch(cone, {Vec3f(middle), static_cast<float>(reach_m)})) continue;
    ++passed_over;
    REQUIRE_FALSE(near);
  }
  CHECK(rays_near > 500);
  CHECK(passed_over > 1000);
}

TEST_CASE("poses that repeat have the same bits as poses of the whole minute", "[coverage]") {
  const XShapesSpec spec;
  const TurningTarget turning(spec, 50, 3000);
  REQUIRE(turning.n_poses() == 180);
  XShapesSpec other = spec;
  other.turns.push_back({{1, 0, 0}, 0.0});  // turning by nothing changes nothing
  const TurningTarget same(other, 50, 3000);
  for (const std::int64_t tick : {0, 7, 180, 1234, 3000}) {
    const auto a = turning.solids({1, 0, 2}, tick), b = same.solids({1, 0, 2}, tick);
    REQUIRE(a.size() == 4);
    for (std::size_t i = 0; i < a.size(); ++i) {
      CHECK(std::get<PosedCapsule>(a[i]).a == std::get<PosedCapsule>(b[i]).a);
    }
  }
  // A bar is 40 cm from tip to tip and 7 cm thick, and leans by 45 degrees at the start.
  const auto bar = std::get<PosedCapsule>(turning.solids({0, 0, 0}, 0)[0]);
  CHECK(bar.radius == Approx(0.035));
  CHECK(glm::distance(bar.a, bar.b) == Approx(0.33));
  CHECK(bar.b.y - bar.a.y == Approx(0.33 / std::sqrt(2.0)));
  CHECK(0.5F * (bar.a.y + bar.b.y) == Approx(1.0));
}

TEST_CASE("the map doesn't depend on the number of threads", "[coverage]") {
  const CoverageStudy study(symmetric_hall(), coarse());
  CHECK(run_coverage(study, 1).counts == run_coverage(study, 4).counts);
}

TEST_CASE("a symmetric hall and a target that mirrors itself give a map symmetric to the last count", "[coverage]") {
  CoverageSpec spec = coarse(0.05);
  spec.target.turns = {{{1, 0, 0}, 100.0}};  // about the axis across the mirror plane
  const CoverageMap map = run_coverage(CoverageStudy(symmetric_hall(), spec));
  std::size_t unequal = 0;
  for (std::size_t row = 0; row < map.grid.n_rows(); ++row) {
    for (std::size_t column = 0; column < map.grid.n_columns(); ++column) {
      unequal += map.count(column, row, 0) != map.count(map.grid.n_columns() - 1 - column, row, 0) ? 1 : 0;
    }
  }
  CHECK(unequal == 0);
  CHECK(seen_squares(map) > map.grid.n_squares() / 10);
}

TEST_CASE("the crosses of Study B turned the other way give the mirrored map", "[coverage]") {
  CoverageSpec spec = coarse();
  const CoverageMap map = run_coverage(CoverageStudy(symmetric_hall(), spec));
  for (TurnSpec& turn : spec.target.turns) turn.deg_per_s = -turn.deg_per_s;
  const CoverageMap other = run_coverage(CoverageStudy(symmetric_hall(), spec));
  std::size_t unequal = 0;
  for (std::size_t row = 0; row < map.grid.n_rows(); ++row) {
    for (std::size_t column = 0; column < map.grid.n_columns(); ++column) {
      unequal += map.count(column, row, 0) != other.count(map.grid.n_columns() - 1 - column, row, 0) ? 1 : 0;
    }
  }
  CHECK(unequal == 0);
}

namespace {

/// Distance from a point to the nearest of the lens's rays through the zones' centres, and through their corners if
/// there are five rays a zone; from the lens data by plane trigonometry, without the ray bundle.
double distance_to_rays(const SceneSpec& scene, RaysPerZone rays, double shortened_m, const Vec3& point) {
  const double tilt = radians(20.0);
  const Vec3 eye = scene.sensors.front().world_from_sensor.origin;
  double nearest = 1e9;
  for (const ClusterSpec& cluster : scene.sensor_models.begin()->second.clusters) {
    for (const ZoneSpec& zone : cluster.zones) {
      std::vector<Vec2> points(zone.corners.begin(), zone.corners.end());
      points.push_back((points[0] + points[1] + points[2] + points[3]) * 0.25);
      if (rays == RaysPerZone::one) points.erase(points.begin(), points.end() - 1);
      for (const Vec2& p : points) {
        const double plane = scene.sensor_models.begin()->second.plane_m;
        const Vec3 aim(p.x, p.y * std::cos(tilt) - plane * std::sin(tilt),
                       -p.y * std::sin(tilt) - plane * std::cos(tilt));
        const Vec3 along = aim / std::sqrt(aim.x * aim.x + aim.y * aim.y + aim.z * aim.z);
        const double reach = std::clamp(glm::dot(point - eye, along), 0.0, cluster.range_m - shortened_m);
        nearest = std::min(nearest, glm::distance(point, eye + reach * along));
      }
    }
  }
  return nearest;
}

struct Agreement {
  std::size_t motion_far_from_rays = 0, rays_without_motion = 0, rays = 0;
};

/// The map, moved by some columns, against where the rays run at the crosses' heights.
Agreement compare(const CoverageMap& map, const SceneSpec& scene, RaysPerZone rays, std::size_t moved_columns) {
  Agreement result;
  for (std::size_t row = 0; row < map.grid.n_rows(); ++row) {
    for (std::size_t column = 0; column + moved_columns < map.grid.n_columns(); ++column) {
      const Vec2 at = map.grid.centre(column, row);
      const auto distance = [&](double shortened_m) {
        return std::min(distance_to_rays(scene, rays, shortened_m, {at.x, 1.0, at.y}),
                        distance_to_rays(scene, rays, shortened_m, {at.x, 0.25, at.y}));
      };
      const bool motion = map.count(column + moved_columns, row, 0) > 0;
      if (motion && distance(0.0) > 0.2 + 1e-6) ++result.motion_far_from_rays;
      const double nearest = distance(0.2);    // of rays that go all the way through
      if (nearest > 0.07 && nearest < 0.15) {  // nearer than a bar is wide, a ray may be hit all the time
        ++result.rays;
        result.rays_without_motion += motion ? 0 : 1;
      }
    }
  }
  return result;
}

}  // namespace

TEST_CASE("motion is seen where rays pass within a cross's reach, and nowhere else", "[coverage]") {
  SceneSpec scene = symmetric_hall();
  scene.meshes.clear();
  const CoverageMap map = run_coverage(CoverageStudy(scene, coarse()));
  CHECK(compare(map, scene, RaysPerZone::five, 0).motion_far_from_rays == 0);
  CHECK(compare(map, scene, RaysPerZone::five, 5).motion_far_from_rays > 100);  // must fail: half a metre aside

  // A cluster whose rays take turns at being hit shows no change, so the converse needs beams of a single ray.
  CoverageSpec thin = coarse();
  thin.sensing.rays_per_zone = RaysPerZone::one;
  thin.sensing.change_per = ChangePer::beam;
  const CoverageMap thin_map = run_coverage(CoverageStudy(scene, thin));
  const Agreement here = compare(thin_map, scene, RaysPerZone::one, 0);
  CHECK(here.motion_far_from_rays == 0);
  CHECK(here.rays > 300);
  CHECK(here.rays_without_motion == 0);
  CHECK(compare(thin_map, scene, RaysPerZone::one, 5).rays_without_motion > 50);  // must fail
}

TEST_CASE("a corner behind an occluder is blind", "[coverage]") {
  const TriMesh screen = box_mesh({1.5, 0.0, -2.6}, {4.0, 3.0, -2.5});
  const CoverageMap open = run_coverage(CoverageStudy(symmetric_hall(), coarse()));
  const CoverageMap shaded = run_coverage(CoverageStudy(symmetric_hall({screen}), coarse()));
  const auto seen_behind = [](const CoverageMap& map) {
    std::size_t seen = 0;
    for (std::size_t row = 0; row < map.grid.n_rows(); ++row) {
      for (std::size_t column = 0; column < map.grid.n_columns(); ++column) {
        const Vec2 at = map.grid.centre(column, row);
        // In the screen's shadow with all of the cross: beyond the line from the sensor past the screen's edge.
        const bool behind = at.y < -2.85 && at.x > 1.5 / 2.5 * -at.y + 0.3;
        seen += behind && map.count(column, row, 0) > 0 ? 1 : 0;
      }
    }
    return seen;
  };
  CHECK(seen_behind(open) > 50);
  CHECK(seen_behind(shaded) == 0);
}

TEST_CASE("what is taken out of the room no longer hides anything, and a wrong name is refused", "[coverage]") {
  TriMesh screen = box_mesh({-4.0, 0.0, -1.6}, {4.0, 3.0, -1.5});
  screen.name = "screen left";
  CoverageSpec spec = coarse();
  const CoverageMap open = run_coverage(CoverageStudy(symmetric_hall(), spec));
  CHECK(seen_squares(run_coverage(CoverageStudy(symmetric_hall({screen}), spec))) < seen_squares(open) / 2);
  spec.without = {"screen"};
  const CoverageStudy study(symmetric_hall({screen}), spec);
  CHECK(study.taken_out().size() == 1);
  CHECK(run_coverage(study).counts == open.counts);
  spec.without = {"scren"};
  CHECK_THROWS_AS(CoverageStudy(symmetric_hall({screen}), spec), Error);
}

namespace {

/// Power by a tracer at every tick, then filter and comparator.
std::vector<MotionCount> plain_analog_counts(const CoverageStudy& study, const Vec2& point) {
  const sim::PowerModel& power = study.survey().array().analog()->power();
  const std::size_t n_sensors = study.survey().array().n_sensors();
  const auto tracer =
      rt::make_tracer(TracerKind::embree, {&study.survey().array().room(), &power.rays().bundle, &power.clipped()});
  const double tick_s = 1.0 / study.spec().sensing.tick_rate_hz;
  const double radiance = pir::band_radiance(pir::kelvin(study.spec().target.temperature_c));
  const Vec3 foot(point.x, study.scene().floor.height_m(), point.y);
  std::vector<rt::FirstHitChange> changes;
  const auto watts_at = [&](std::int64_t tick) {
    const auto solids = study.target().solids(foot, tick);
    const std::vector<std::uint8_t> surfaces(solids.size(), 0);
    const rt::Moved moved{0, solids, surfaces};
    tracer->follow({&moved, 1}, changes);
    std::vector<sim::PowerSteps> steps(power.n_receivers(), 0);
    const std::vector<rt::SolidId> hits = tracer->first_hits();
    for (std::uint32_t ray = 0; ray < hits.size(); ++ray) {
      if (hits[ray] != rt::no_solid) steps[power.receiver_of(ray)] += power.power(ray, radiance);
    }
    std::vector<double> watts;
    for (std::size_t s = 0; s < n_sensors; ++s) watts.push_back(study.survey().array().analog()->watts(s, steps));
    return watts;
  };
  DetectorSpec silent = study.scene().sensor_models.begin()->second.detector;
  silent.amplifier.noise_v_pp = 0.0;
  std::vector<pir::AnalogFilter::Sections> sections;
  std::vector<pir::Comparator::State> states(n_sensors);
  const pir::Comparator comparator(silent.comparator, silent.report, tick_s);
  std::vector<double> before = watts_at(0);
  for (std::size_t s = 0; s < before.size(); ++s) {
    sections.push_back(study.survey().array().analog()->sensors()[s]->silent_filter.at_rest(before[s]));
  }
  std::vector<MotionCount> counts(before.size(), 0);
  std::int64_t tick = 0;
  for (int window = 0; window < study.n_windows(); ++window) {
    std::vector<MotionCount> motion(before.size(), 0);
    for (int i = 0; i < study.spec().sensing.ticks_per_window; ++i) {
      const std::vector<double> now = watts_at(++tick);
      for (std::size_t s = 0; s < now.size(); ++s) {
        const pir::AnalogFilter& filter = study.survey().array().analog()->sensors()[s]->silent_filter;
        filter.advance(sections[s], before[s], now[s], 0.0);
        comparator.advance(states[s], filter.output(sections[s]));
        if (states[s].on) motion[s] = 1;
      }
      before = now;
    }
    for (std::size_t s = 0; s < motion.size(); ++s) counts[s] = static_cast<MotionCount>(counts[s] + motion[s]);
  }
  return counts;
}

}  // namespace

TEST_CASE("random squares count the same outputs of analog sensors as a tracer does tick by tick", "[coverage]") {
  const CoverageStudy study(test::shipped_scene("meeting_room.gltf"),
                            study_b({"duration_s=6", "sensing.response=analog", "sensing.analog_rays_per_zone=5"}));
  Draw draw(717);
  int seen = 0;
  for (int i = 0; i < 12; ++i) {
    const auto column = draw.index(static_cast<std::uint32_t>(study.grid().n_columns()));
    const auto row = draw.index(static_cast<std::uint32_t>(study.grid().n_rows()));
    const Vec2 centre = study.grid().centre(column, row);
    const std::vector<MotionCount> counts = study.counts_at(centre);
    INFO("square at " << centre.x << ", " << centre.y);
    CHECK(counts == plain_analog_counts(study, centre));
    for (const auto count : counts) seen += count > 0 ? 1 : 0;
  }
  CHECK(seen > 5);
}
