#include "studies/walk_test.hpp"

#include <algorithm>
#include <cmath>

#include "body/motion.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "pir/planck.hpp"
#include "pirsim/geometry.hpp"
#include "schema/words.hpp"
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

void add_pose(WalkTest::Movement& movement, const body::Motion& motion) {
  const body::Posture posture = motion.posture();
  movement.poses.emplace_back(posture.begin(), posture.end());
}

/// What an arm might hit, from its underside to the highest that it reaches: it swings over desks.
body::Obstacles around_arm(const SceneSpec& scene, const SwingingArmSpec& arm) {
  const double half_m = arm.width_m / 2, axis_y = scene.floor.height_m() + arm.height_m;
  const bool goes_up = std::ranges::find(arm.swings, ArmSwing::vertical) != arm.swings.end();
  return body::Obstacles(body::footprints(scene.meshes, axis_y - half_m, axis_y + (goes_up ? arm.length_m : half_m)));
}

}  // namespace

WalkTest::WalkTest(SceneSpec scene, WalkTestSpec spec)
    : survey_(std::move(scene), as_script(spec)),
      spec_(in_force(std::move(spec), survey_.trials().front().people.front())),
      grid_(survey_.scene().floor, spec_.spacing_m),
      humanoid_(spec_.person),
      floor_(survey_.scene().floor, {}, survey_.scene().meshes, humanoid_.clearance_radius_m()),
      crossing_(make_crossing()) {
  if (!spec_.arm) {
    minor_motions_ = {make_arm_work()};
    return;
  }
  around_arm_ = around_arm(survey_.scene(), *spec_.arm);
  for (const ArmSwing plane : spec_.arm->swings) minor_motions_.push_back(make_swing(plane));
}

std::uint32_t WalkTest::tries_a_point() const noexcept {
  const auto n_minor = static_cast<std::uint32_t>(minor_motions_.size());
  return static_cast<std::uint32_t>(spec_.major.directions) +
         static_cast<std::uint32_t>(spec_.minor.directions) * n_minor;
}

bool WalkTest::has_room_for_minor(const Vec2& point) const noexcept {
  if (!around_arm_) return floor_.walkable(point);
  return scene().floor.contains(point) && around_arm_->clear(point, point, spec_.arm->width_m / 2);
}

std::vector<Issue> WalkTest::warnings() const {
  return idle_effects(spec_.effects, survey_, effects::Survey::walk_test);
}

WalkTest::Movement WalkTest::of_person() const {
  const body::Solids& solids = humanoid_.solids();
  return {{solids.begin(), solids.end()}, sim::radiance_of(spec_.person.warmth, survey_.sensing().ambient_c), {}};
}

WalkTest::Movement WalkTest::make_crossing() const {
  const Vec2 start(0.0, spec_.path_m / 2), end = -start;  // along -Z
  body::Motion motion(humanoid_, start, 0.0, 0.0, tick_s(spec_));
  Movement crossing = of_person();
  add_pose(crossing, motion);
  motion.walk(body::Route({start, end}));
  const auto go_on = [&](int n_ticks) {
    for (int tick = 0; tick < n_ticks; ++tick) {
      motion.advance();
      add_pose(crossing, motion);
    }
  };
  if (!spec_.stop_s) {
    go_on(ticks(spec_, spec_.major.within_s));
    return crossing;
  }
  while (!motion.settled()) go_on(1);
  go_on(ticks(spec_, *spec_.stop_s));
  return crossing;
}

WalkTest::Movement WalkTest::make_arm_work() const {
  const body::SeatPlace seat{Frame{{1, 0, 0, 0}, {0.0, spec_.seat_height_m, 0.0}}, 0.0, spec_.desk_height_m};
  body::Motion motion = seated(humanoid_, seat, tick_s(spec_));
  motion.work({spec_.arm_amplitude_m, spec_.arm_period_s});
  // Reaching for the desk isn't the motion that is asked about.
  constexpr double reaching_s = 5.0;  // assumed: longer than it takes
  for (int tick = 0; tick < ticks(spec_, reaching_s); ++tick) motion.advance();
  Movement work = of_person();
  add_pose(work, motion);
  for (int tick = 0; tick < ticks(spec_, spec_.minor.within_s); ++tick) {
    motion.advance();
    add_pose(work, motion);
  }
  return work;
}

WalkTest::Movement WalkTest::make_swing(ArmSwing plane) const {
  const SwingingArmSpec& arm = *spec_.arm;
  Movement swing{{Box{{arm.width_m / 2, arm.width_m / 2, arm.length_m / 2}}}, {}, {}};
  swing.radiance.fill(pir::band_radiance(pir::kelvin(arm.temperature_c)));
  for (int tick = 0; tick <= ticks(spec_, spec_.minor.within_s); ++tick) {
    const double turned_deg = std::min(arm.deg_per_s * tick * tick_s(spec_), 2.0 * arm.swing_deg);
    const double there_deg = std::min(turned_deg, 2.0 * arm.swing_deg - turned_deg);
    const Quat turn = plane == ArmSwing::horizontal
                          ? glm::angleAxis(radians(there_deg - arm.swing_deg / 2), Vec3(0, 1, 0))
                          : glm::angleAxis(radians(there_deg), Vec3(1, 0, 0));
    swing.poses.push_back({{turn, Vec3(0.0, arm.height_m, 0.0) + turn * Vec3(0.0, 0.0, -arm.length_m / 2)}});
  }
  return swing;
}

WalkTester::WalkTester(const WalkTest& test)
    : test_(test),
      array_(test.survey().array()),
      observer_(array_, fastest_tracer, sim::ZonesOf::all_sensors),
      detector_(test.survey().make_detector()),
      logger_(test.survey().make_logger()),
      before_(array_.unexposed()),
      after_(before_),
      triggers_(array_.n_sensors()) {}

void WalkTester::look(const WalkTest::Movement& movement, std::size_t tick, const Frame& world_from_movement,
                      sim::Exposure& exposure) {
  solids_.clear();
  for (std::size_t i = 0; i < movement.solids.size(); ++i) {
    solids_.push_back(place(movement.solids[i], world_from_movement * movement.poses[tick][i]));
  }
  observer_.look(solids_, movement.radiance, exposure);
}

void WalkTester::attempt(const WalkTest::Movement& movement, const Frame& world_from_movement, std::uint32_t try_number,
                         Tries& tries) {
  ++tries.made;
  look(movement, 0, world_from_movement, after_);
  detector_.begin_run(test_.survey().seed(), try_number, after_);
  logger_.begin_run(test_.survey().seed(), try_number);
  const ZoneSet nobody(after_.zones.size());
  bool seen = after_.zones != nobody;
  for (std::size_t tick = 1; tick < movement.poses.size(); ++tick) {
    logger_.hear_tick(triggers_, [&](std::int64_t) {
      std::swap(before_, after_);
      look(movement, tick, world_from_movement, after_);
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
  std::uint32_t try_number = number * test_.tries_a_point();
  PointResult result;
  const Vec3 foot(point.x, test_.scene().floor.height_m(), point.y);
  for (int i = 0; i < spec.major.directions; ++i, ++try_number) {
    const double heading = 2.0 * pi * i / spec.major.directions;
    const Vec2 half_path = spec.path_m / 2 * direction_of(heading);
    if (!test_.floor().walkable(point - half_path, point + half_path)) continue;
    attempt(test_.crossing(), {rotation_from_heading(heading), foot}, try_number, result.major);
  }
  if (!test_.has_room_for_minor(point)) return result;
  for (const WalkTest::Movement& movement : test_.minor_motions()) {
    for (int i = 0; i < spec.minor.directions; ++i, ++try_number) {
      const double heading = 2.0 * pi * i / spec.minor.directions;
      attempt(movement, {rotation_from_heading(heading), foot}, try_number, result.minor);
    }
  }
  return result;
}

SeatResult WalkTester::try_seat(const SeatSpec& seat, std::uint32_t number) {
  const Vec3 pelvis = seat.world_from_seat.origin;
  const Vec3 foot(pelvis.x, test_.scene().floor.height_m(), pelvis.z);
  Tries tries;
  const Frame world_from_work{rotation_from_heading(heading_of(seat.world_from_seat)), foot};
  attempt(test_.minor_motions().front(), world_from_work, number * test_.tries_a_point(), tries);
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
  if (test.spec().arm) return result;  // it sits nowhere
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
