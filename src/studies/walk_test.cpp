#include "studies/walk_test.hpp"

#include <algorithm>
#include <cmath>

#include "body/motion.hpp"
#include "core/parallel.hpp"
#include "pir/motion_detector.hpp"
#include "pir/optics.hpp"
#include "pirsim/geometry.hpp"
#include "sim/analog_model.hpp"

namespace pirsim::studies {
namespace {

double tick_s(const WalkTestSpec& spec) { return 1.0 / spec.sensing.tick_rate_hz; }

int ticks(const WalkTestSpec& spec, double seconds) {
  return std::max(1, static_cast<int>(std::lround(seconds * spec.sensing.tick_rate_hz)));
}

}  // namespace

WalkTest::WalkTest(SceneSpec scene, WalkTestSpec spec)
    : scene_(std::move(scene)),
      spec_(std::move(spec)),
      grid_(scene_.floor, spec_.spacing_m),
      humanoid_(spec_.person),
      floor_(scene_.floor, {}, scene_.meshes, humanoid_.clearance_radius_m()),
      room_(scene_.meshes) {
  if (sim::AnalogModel::is_needed(scene_, spec_.sensing)) {
    throw Error(ErrorCode::input, "a walk test knows hard zones only; ask for them by sensing.response: zones");
  }
  for (const SensorSpec& sensor : scene_.sensors) {
    pir::append(rated_, sensor, scene_.sensor_models.at(sensor.model), spec_.sensing.rays_per_zone);
  }
  clipped_ = rated_;
  room_.clip(clipped_);
  crossing_ = crossing();
  arm_work_ = arm_work();
}

WalkTest::Movement WalkTest::crossing() const {
  const Vec2 start(0.0, spec_.path_m / 2), end = -start;  // along -Z
  body::Motion motion(humanoid_, start, 0.0, 0.0, tick_s(spec_));
  Movement postures{motion.posture()};
  motion.walk(body::Route({start, end}));
  for (int tick = 0; tick < ticks(spec_, spec_.major.within_s); ++tick) {
    motion.advance();
    postures.push_back(motion.posture());
  }
  return postures;
}

WalkTest::Movement WalkTest::arm_work() const {
  const body::SeatPlace seat{Frame{{1, 0, 0, 0}, {0.0, spec_.seat_height_m, 0.0}}, 0.0, spec_.desk_height_m};
  const Vec2 stand = body::fall_back_m(humanoid_, seat) * direction_of(0.0);
  body::Motion motion(humanoid_, stand, 0.0, 0.0, tick_s(spec_));
  motion.sit_down(seat);
  while (!(motion.stage() == body::Stage::seated && motion.settled())) motion.advance();
  motion.work({spec_.arm_amplitude_m, spec_.arm_period_s});
  // Reaching for the desk isn't the motion that is asked about.
  constexpr double reaching_s = 5.0;  // assumed: longer than it takes
  for (int tick = 0; tick < ticks(spec_, reaching_s); ++tick) motion.advance();
  Movement postures{motion.posture()};
  for (int tick = 0; tick < ticks(spec_, spec_.minor.within_s); ++tick) {
    motion.advance();
    postures.push_back(motion.posture());
  }
  return postures;
}

bool WalkTest::is_noticed(const Movement& movement, const Frame& world_from_movement, rt::Tracer& tracer) const {
  ZoneActivity before(rated_.n_zones()), after(rated_.n_zones());
  std::vector<std::uint8_t> bits(rated_.n_sensors(), 0);
  std::vector<PosedShape> solids(body::n_parts);
  for (std::size_t tick = 0; tick < movement.size(); ++tick) {
    for (std::size_t i = 0; i < body::n_parts; ++i) {
      solids[i] = place(humanoid_.solids()[i], world_from_movement * movement[tick][i]);
    }
    std::swap(before, after);
    tracer.trace(solids, after);
    if (tick == 0) continue;
    pir::mark_motion(rated_, spec_.sensing.change_per, before, after, bits);
    if (std::ranges::find(bits, 1) != bits.end()) return true;
  }
  return false;
}

PointResult WalkTest::try_point(const Vec2& point, rt::Tracer& tracer) const {
  PointResult result;
  const Vec3 foot(point.x, scene_.floor.height_m(), point.y);
  for (int i = 0; i < spec_.major.directions; ++i) {
    const double heading = 2.0 * pi * i / spec_.major.directions;
    const Vec2 half_path = spec_.path_m / 2 * direction_of(heading);
    if (!floor_.walkable(point - half_path, point + half_path)) continue;
    ++result.major.made;
    if (is_noticed(crossing_, {rotation_from_heading(heading), foot}, tracer)) ++result.major.noticed;
  }
  for (int i = 0; i < spec_.minor.directions && floor_.walkable(point); ++i) {
    const double heading = 2.0 * pi * i / spec_.minor.directions;
    ++result.minor.made;
    if (is_noticed(arm_work_, {rotation_from_heading(heading), foot}, tracer)) ++result.minor.noticed;
  }
  return result;
}

bool WalkTest::notices_sitter(const SeatSpec& seat, rt::Tracer& tracer) const {
  const Vec3 pelvis = seat.world_from_seat.origin;
  const Vec3 foot(pelvis.x, scene_.floor.height_m(), pelvis.z);
  return is_noticed(arm_work_, {rotation_from_heading(heading_of(seat.world_from_seat)), foot}, tracer);
}

std::unique_ptr<rt::Tracer> WalkTest::make_tracer() const {
  return rt::make_tracer(rt::fastest_tracer, {&room_, &rated_, &clipped_});
}

WalkTestResult run_walk_test(const WalkTest& test, unsigned threads, const std::function<void()>& row_done) {
  const FloorGrid& grid = test.grid();
  WalkTestResult result;
  ordered_parallel<std::vector<PointResult>>(
      grid.n_rows(), threads,
      [&](std::size_t row) {
        const std::unique_ptr<rt::Tracer> tracer = test.make_tracer();
        std::vector<PointResult> points(grid.n_columns());
        for (std::size_t column = 0; column < grid.n_columns(); ++column) {
          if (grid.on_floor(column, row)) points[column] = test.try_point(grid.centre(column, row), *tracer);
        }
        return points;
      },
      [&](std::vector<PointResult>& points) {
        result.points.insert(result.points.end(), points.begin(), points.end());
        row_done();
      });
  const std::unique_ptr<rt::Tracer> tracer = test.make_tracer();
  for (const SeatSpec& seat : test.scene().seats) result.seats.push_back({seat.id, test.notices_sitter(seat, *tracer)});
  return result;
}

}  // namespace pirsim::studies
