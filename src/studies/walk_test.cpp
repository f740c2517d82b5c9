#include "studies/walk_test.hpp"

#include <algorithm>
#include <cmath>

#include "body/motion.hpp"
#include "core/parallel.hpp"
#include "pirsim/geometry.hpp"
#include "studies/sitters.hpp"

namespace pirsim::studies {
namespace {

double tick_s(const WalkTestSpec& spec) { return 1.0 / spec.sensing.tick_rate_hz; }

int ticks(const WalkTestSpec& spec, double seconds) {
  return std::max(1, static_cast<int>(std::lround(seconds * spec.sensing.tick_rate_hz)));
}

/// The walk test's person in a trial of their own, so that effects find them.
ScriptSpec as_script(const WalkTestSpec& spec) {
  action::Work work;
  work.arm_amplitude_m = spec.arm_amplitude_m;
  work.arm_period_s = spec.arm_period_s;
  PersonSpec person = spec.person;
  person.id = "walker";
  person.actions = {{work, {}, {}, {}}};
  ScriptSpec script;
  script.sensing = spec.sensing;
  script.seed = spec.seed;
  script.effects = spec.effects;
  script.trials = {{"walk test", {person}}};
  return script;
}

/// The spec with the person as effects made them.
WalkTestSpec in_force(WalkTestSpec spec, const PersonInForce& person) {
  spec.person = person;
  const auto& work = std::get<action::Work>(person.actions.front().what);
  spec.arm_amplitude_m = work.arm_amplitude_m;
  spec.arm_period_s = work.arm_period_s;
  return spec;
}

}  // namespace

WalkTest::WalkTest(SceneSpec scene, WalkTestSpec spec)
    : survey_(std::move(scene), as_script(spec)),
      spec_(in_force(std::move(spec), survey_.trials().front().people.front())),
      grid_(survey_.scene().floor, spec_.spacing_m),
      humanoid_(spec_.person),
      floor_(survey_.scene().floor, {}, survey_.scene().meshes, humanoid_.clearance_radius_m()) {
  crossing_ = make_crossing();
  arm_work_ = make_arm_work();
}

std::vector<Issue> WalkTest::warnings() const {
  return idle_effects(spec_.effects, survey_, effects::Survey::walk_test);
}

WalkTest::Movement WalkTest::make_crossing() const {
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

WalkTest::Movement WalkTest::make_arm_work() const {
  const body::SeatPlace seat{Frame{{1, 0, 0, 0}, {0.0, spec_.seat_height_m, 0.0}}, 0.0, spec_.desk_height_m};
  body::Motion motion = seated(humanoid_, seat, tick_s(spec_));
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

WalkTester::WalkTester(const WalkTest& test)
    : test_(test),
      array_(test.survey().array()),
      observer_(array_, fastest_tracer, sim::ZonesOf::all_sensors),
      detector_(test.survey().make_detector()),
      logger_(test.survey().make_logger()),
      before_(array_.unexposed()),
      after_(before_),
      radiance_(sim::radiance_of(test.spec().person.warmth, test.survey().sensing().ambient_c)),
      solids_(body::n_parts),
      triggers_(array_.n_sensors()) {}

void WalkTester::look(const body::Posture& posture, const Frame& world_from_movement, sim::Exposure& exposure) {
  for (std::size_t i = 0; i < body::n_parts; ++i) {
    solids_[i] = place(test_.humanoid().solids()[i], world_from_movement * posture[i]);
  }
  observer_.look(solids_, radiance_, exposure);
}

void WalkTester::attempt(const WalkTest::Movement& movement, const Frame& world_from_movement, std::uint32_t try_number,
                         Tries& tries) {
  ++tries.made;
  look(movement.front(), world_from_movement, after_);
  detector_.begin_run(test_.survey().seed(), try_number, after_);
  logger_.begin_run(test_.survey().seed(), try_number);
  const ZoneSet nobody(after_.zones.size());
  bool seen = after_.zones != nobody;
  for (std::size_t tick = 1; tick < movement.size(); ++tick) {
    logger_.hear_tick(triggers_, [&](std::int64_t) {
      std::swap(before_, after_);
      look(movement[tick], world_from_movement, after_);
      detector_.tick(before_, after_, triggers_);
    });
    if (std::ranges::find(triggers_, 1) != triggers_.end()) {
      ++tries.noticed;
      return;
    }
    seen = seen || after_.zones != nobody;
  }
  tries.deaf += seen ? 1 : 0;
}

PointResult WalkTester::try_point(const Vec2& point, std::uint32_t number) {
  const WalkTestSpec& spec = test_.spec();
  const auto n_tries = static_cast<std::uint32_t>(spec.major.directions + spec.minor.directions);
  std::uint32_t try_number = number * n_tries;
  PointResult result;
  const Vec3 foot(point.x, test_.scene().floor.height_m(), point.y);
  for (int i = 0; i < spec.major.directions; ++i, ++try_number) {
    const double heading = 2.0 * pi * i / spec.major.directions;
    const Vec2 half_path = spec.path_m / 2 * direction_of(heading);
    if (!test_.floor().walkable(point - half_path, point + half_path)) continue;
    attempt(test_.crossing(), {rotation_from_heading(heading), foot}, try_number, result.major);
  }
  for (int i = 0; i < spec.minor.directions && test_.floor().walkable(point); ++i, ++try_number) {
    const double heading = 2.0 * pi * i / spec.minor.directions;
    attempt(test_.arm_work(), {rotation_from_heading(heading), foot}, try_number, result.minor);
  }
  return result;
}

SeatResult WalkTester::try_seat(const SeatSpec& seat, std::uint32_t number) {
  const Vec3 pelvis = seat.world_from_seat.origin;
  const Vec3 foot(pelvis.x, test_.scene().floor.height_m(), pelvis.z);
  const auto n_tries = static_cast<std::uint32_t>(test_.spec().major.directions + test_.spec().minor.directions);
  Tries tries;
  attempt(test_.arm_work(), {rotation_from_heading(heading_of(seat.world_from_seat)), foot}, number * n_tries, tries);
  return {seat.id, tries.noticed > 0, tries.deaf > 0};
}

WalkTestResult run_walk_test(const WalkTest& test, unsigned threads, const std::function<void()>& row_done) {
  const FloorGrid& grid = test.grid();
  WalkTestResult result{grid, {}, {}};
  ordered_parallel<std::vector<PointResult>>(
      grid.n_rows(), threads,
      [&](std::size_t row) {
        WalkTester tester(test);
        std::vector<PointResult> points(grid.n_columns());
        for (std::size_t column = 0; column < grid.n_columns(); ++column) {
          if (grid.on_floor(column, row)) {
            points[column] =
                tester.try_point(grid.centre(column, row), static_cast<std::uint32_t>(row * grid.n_columns() + column));
          }
        }
        return points;
      },
      [&](std::vector<PointResult>& points) {
        result.points.insert(result.points.end(), points.begin(), points.end());
        row_done();
      });
  WalkTester tester(test);
  auto number = static_cast<std::uint32_t>(grid.n_rows() * grid.n_columns());
  for (const SeatSpec& seat : test.scene().seats) result.seats.push_back(tester.try_seat(seat, number++));
  return result;
}

}  // namespace pirsim::studies

namespace pirsim {

WalkTestResult run_walk_test(SceneSpec scene, WalkTestSpec spec, unsigned threads, const RowDone& row_done) {
  const studies::WalkTest test(std::move(scene), std::move(spec));
  std::size_t n_done = 0;
  return studies::run_walk_test(test, threads, [&] {
    ++n_done;
    if (row_done) row_done(n_done, test.grid().n_rows());
  });
}

}  // namespace pirsim
