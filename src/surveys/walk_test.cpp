#include "surveys/walk_test.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

#include "engine/body/motion.hpp"
#include "engine/pir/optics.hpp"
#include "model/core/parallel.hpp"
#include "model/core/text.hpp"
#include "model/schema/words.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/response.hpp"
#include "surveys/picture.hpp"
#include "surveys/sight.hpp"
#include "surveys/study_report.hpp"

// A walk test in words.

namespace pirsim::studies {

/// Points that could be tried, and those of them that pass.
struct PassCount {
  std::size_t tried = 0, passed = 0;
};

[[nodiscard]] bool passes(const Tries& tries, const WalkRequirement& requirement);

/// What a walk test calls things, and what it says of them. The test outlives it.
class WalkWords {
 public:
  explicit WalkWords(const WalkTest& test) : test_(test), spec_(test.spec()) {}

  /// "walker noticed within 1.5 s in at least 90 % of 8 directions: 59 of 63 points pass", without a full stop.
  [[nodiscard]] std::string of_major(const PassCount& count) const;
  [[nodiscard]] std::string of_minor(const PassCount& count) const;
  /// "kitchen (PIR1): walker 3 of 4 points pass, arms 2 of 4"
  [[nodiscard]] std::string of_area(const std::string& area, const PassCount& major, const PassCount& minor) const;
  /// Of all tries of minor motion: how many failed, and in how many of those sensors saw what moved.
  [[nodiscard]] std::string of_deafness(const WalkTestResult& result) const;
  /// A line, or no text without seats.
  [[nodiscard]] std::string of_seats(const WalkTestResult& result) const;
  /// Until when motion counts: "within 1.5 s".
  [[nodiscard]] std::string time_of_major() const;
  [[nodiscard]] std::string time_of_minor() const;

  [[nodiscard]] std::string title() const;
  [[nodiscard]] std::string minor_heading() const;
  /// What is done, and what the sensors answer by.
  [[nodiscard]] std::string method() const;

 private:
  [[nodiscard]] std::string required(const WalkRequirement& requirement) const;
  [[nodiscard]] std::string planes() const;

  const WalkTest& test_;
  const WalkTestSpec& spec_;
};

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

namespace pirsim::studies {
namespace {

std::string plain(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}
std::string seconds(double value) { return plain(value) + " s"; }

/// "3 of 4"
std::string told(const PassCount& count) { return std::to_string(count.passed) + " of " + std::to_string(count.tried); }

/// Index of the square that holds the point; none beside the grid.
std::optional<std::size_t> square_at(const FloorGrid& grid, const Vec2& point) {
  const Vec2 from_corner = (point - grid.centre(0, 0)) / grid.spacing_m() + 0.5;
  const double column = std::floor(from_corner.x), row = std::floor(from_corner.y);
  if (column < 0.0 || row < 0.0 || column >= static_cast<double>(grid.n_columns()) ||
      row >= static_cast<double>(grid.n_rows()))
    return std::nullopt;
  return static_cast<std::size_t>(row) * grid.n_columns() + static_cast<std::size_t>(column);
}

}  // namespace

bool passes(const Tries& tries, const WalkRequirement& requirement) {
  return tries.made > 0 && *tries.probability() >= requirement.probability - 1e-12;
}

std::string WalkWords::time_of_major() const {
  return spec_.stop_s ? "before a stop of " + seconds(*spec_.stop_s) + " ends"
                      : "within " + seconds(spec_.major.within_s);
}

std::string WalkWords::time_of_minor() const { return "within " + seconds(spec_.minor.within_s); }

std::string WalkWords::required(const WalkRequirement& requirement) const {
  return "in at least " + percent(requirement.probability) + " of " + std::to_string(requirement.directions) +
         " directions";
}

std::string WalkWords::planes() const {
  std::vector<std::string> words;
  for (const ArmSwing plane : spec_.arm->swings)
    words.emplace_back(plane == ArmSwing::horizontal ? "horizontally" : "vertically");
  return joined(words, " and ");
}

std::string WalkWords::of_major(const PassCount& count) const {
  return "walker noticed " + time_of_major() + " " + required(spec_.major) + ": " + told(count) + " points pass";
}

std::string WalkWords::of_minor(const PassCount& count) const {
  const std::string arm = spec_.arm ? required(spec_.minor) + ", " + planes() : "";
  return (spec_.arm ? "swinging arm noticed " + time_of_minor() + " " + arm
                    : "sitter's arms noticed " + time_of_minor() + " " + required(spec_.minor)) +
         ": " + told(count) + " points pass";
}

std::string WalkWords::of_area(const std::string& area, const PassCount& major, const PassCount& minor) const {
  return area + ": walker " + told(major) + " points pass, " + (spec_.arm ? "arm " : "arms ") + told(minor);
}

std::string WalkWords::of_deafness(const WalkTestResult& result) const {
  int missed = 0, deaf = 0;
  for (const PointResult& point : result.points) {
    missed += point.minor.made - point.minor.noticed;
    deaf += point.minor.deaf;
  }
  return "of " + std::to_string(missed) + " tries without notice, sensors saw the " + (spec_.arm ? "arm" : "sitter") +
         " in " + std::to_string(deaf);
}

std::string WalkWords::of_seats(const WalkTestResult& result) const {
  const auto named = [](const std::string& seats) { return seats.empty() ? " none" : seats; };
  if (!spec_.arm) {
    std::string noticed, deaf, unseen;
    for (const SeatResult& seat : result.seats) {
      (seat.noticed ? noticed : seat.deaf ? deaf : unseen) += " " + seat.seat;
    }
    if (result.seats.empty()) return {};
    return "seats where a sitter's arms are noticed:" + named(noticed) + "; seen, but not noticed:" + named(deaf) +
           "; unseen:" + named(unseen);
  }
  std::string outside;
  for (const SeatSpec& seat : test_.scene().seats) {
    const std::optional<std::size_t> at = square_at(result.grid, floor_point(seat.world_from_seat.origin));
    if (!at || !passes(result.points[*at].minor, spec_.minor)) outside += " " + seat.id;
  }
  if (test_.scene().seats.empty()) return {};
  return "seats in squares that fail:" + named(outside);
}

std::string WalkWords::title() const { return spec_.name + ": walk test of " + test_.scene().name; }

std::string WalkWords::minor_heading() const {
  return spec_.arm ? "Minor motion: a swinging arm" : "Minor motion: arms of a sitter";
}

std::string WalkWords::method() const {
  const std::string response =
      ". A try counts as noticed if any sensor reports motion in time; the sensors' response is " +
      responses_in_words(test_.scene(), spec_.sensing) + ".";
  std::string text =
      "At every point of a grid a person of the study's measures walks across in several directions (major motion), "
      "and ";
  if (!spec_.arm) {
    return text + "sits there facing several ways and moves both forearms (minor motion)" + response +
           " In the manner of NEMA WD 7 and EN 50131-2-2; not a conformity test.";
  }
  const SwingingArmSpec& arm = *spec_.arm;
  text += "a box of " + plain(arm.width_m) + " x " + plain(arm.width_m) + " x " + plain(arm.length_m) +
          " m, whose axis is " + plain(arm.height_m) + " m above the floor, swings by " + plain(arm.swing_deg) +
          " degrees and back at " + plain(arm.deg_per_s) + " degrees a second, " + planes() + " (minor motion)";
  return text + response;
}

namespace {

PassCount count_passes(const WalkTestResult& result, Tries PointResult::*motion, const WalkRequirement& requirement) {
  PassCount count;
  for (const PointResult& point : result.points) {
    if ((point.*motion).made == 0) continue;
    ++count.tried;
    count.passed += passes(point.*motion, requirement) ? 1 : 0;
  }
  return count;
}

/// Of the points of each area. A line each; none without areas.
std::vector<std::string> passes_by_area(const WalkTest& test, const WalkTestResult& result) {
  const Areas areas(test.scene());
  const FloorGrid& grid = test.grid();
  std::vector<PassCount> major(areas.size()), minor(areas.size());
  const auto note = [](const Tries& tries, const WalkRequirement& requirement, PassCount& count) {
    if (tries.made == 0) return;
    ++count.tried;
    count.passed += passes(tries, requirement) ? 1 : 0;
  };
  for (std::size_t i = 0; i < result.points.size() && !areas.empty(); ++i) {
    const std::size_t column = i % grid.n_columns(), row = i / grid.n_columns();
    if (!grid.on_floor(column, row)) continue;
    const std::size_t area = areas.at(grid.centre(column, row));
    note(result.points[i].major, test.spec().major, major[area]);
    note(result.points[i].minor, test.spec().minor, minor[area]);
  }
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < areas.size(); ++i)
    lines.push_back(WalkWords(test).of_area(with_sensors(test.scene(), areas, i), major[i], minor[i]));
  return lines;
}

io::MapChart map_of(const WalkTest& test, const std::string& title, const std::string& label) {
  const FloorGrid& grid = test.grid();
  io::MapChart chart;
  chart.title = title;
  chart.label = label;
  chart.lower = grid.centre(0, 0) - 0.5 * Vec2(grid.spacing_m());
  chart.spacing_m = grid.spacing_m();
  chart.columns = static_cast<int>(grid.n_columns());
  chart.rows = static_cast<int>(grid.n_rows());
  chart.plan = plan_of(test.scene());
  for (const SensorSpec& sensor : test.scene().sensors) {
    chart.markers.push_back(
        {sensor.id, floor_point(sensor.world_from_sensor.origin), heading_of(sensor.world_from_sensor)});
  }
  return chart;
}

void add_maps(io::ReportSection& section, const WalkTest& test, const WalkTestResult& result,
              Tries PointResult::*motion, const WalkRequirement& requirement, const std::string& time) {
  io::MapChart probability = map_of(test, "Probability of being noticed", "probability");
  io::MapChart pass = map_of(test, "Pass or fail", "verdict");
  pass.colours = io::MapChart::Colours::pass_or_fail;
  probability.note = time + "; no colour: nothing could be tried there";
  pass.note = "required: " + percent(requirement.probability);
  probability.unit = "of the tries noticed";
  for (const PointResult& point : result.points) {
    const Tries& tries = point.*motion;
    probability.values.push_back(tries.probability());
    pass.values.push_back(tries.made == 0 ? std::nullopt : std::optional(passes(tries, requirement) ? 1.0 : 0.0));
  }
  section.charts.emplace_back(std::move(probability));
  section.charts.emplace_back(std::move(pass));
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

}  // namespace

namespace {

struct PointLine {
  std::string x_m, z_m;  ///< with all decimals
  const PointResult& point;
  std::string_view major, minor;
};

constexpr Column<PointLine> point_lines[]{
    {{"x_m", Holds::number, "of the point", "m"}, [](const PointLine& line) -> Cell { return line.x_m; }},
    {{"z_m", Holds::number, "of the point", "m"}, [](const PointLine& line) -> Cell { return line.z_m; }},
    {{"major_tries", Holds::count, "walks across it that are possible"},
     [](const PointLine& line) -> Cell { return line.point.major.made; }},
    {{"major_noticed", Holds::count, "of them, in which a sensor reported motion in time"},
     [](const PointLine& line) -> Cell { return line.point.major.noticed; }},
    {{"major", Holds::text, "`pass`, `fail`, or `untried` where nobody can walk"},
     [](const PointLine& line) -> Cell { return line.major; }},
    {{"minor_tries", Holds::count, "movements of arms over it"},
     [](const PointLine& line) -> Cell { return line.point.minor.made; }},
    {{"minor_noticed", Holds::count, "of them, in which a sensor reported motion in time"},
     [](const PointLine& line) -> Cell { return line.point.minor.noticed; }},
    {{"minor", Holds::text, "`pass`, `fail`, or `untried` where nobody can sit"},
     [](const PointLine& line) -> Cell { return line.minor; }},
    {{"minor_deaf", Holds::count, "of those without notice, in which a sensor saw what moved"},
     [](const PointLine& line) -> Cell { return line.point.minor.deaf; }},
};

}  // namespace

std::string to_csv(const WalkTest& test, const WalkTestResult& result) {
  constexpr int decimals = 4;
  std::ostringstream out;
  io::TableWriter<PointLine> csv(out, std::span<const Column<PointLine>>(point_lines));
  const FloorGrid& grid = test.grid();
  const auto verdict = [](const Tries& tries, const WalkRequirement& requirement) -> std::string_view {
    return tries.made == 0 ? "untried" : passes(tries, requirement) ? "pass" : "fail";
  };
  for (std::size_t row = 0; row < grid.n_rows(); ++row) {
    for (std::size_t column = 0; column < grid.n_columns(); ++column) {
      if (!grid.on_floor(column, row)) continue;
      const Vec2 centre = grid.centre(column, row);
      const PointResult& point = result.points[row * grid.n_columns() + column];
      csv.write({fixed(centre.x, decimals), fixed(centre.y, decimals), point, verdict(point.major, test.spec().major),
                 verdict(point.minor, test.spec().minor)});
    }
  }
  return out.str();
}

std::string to_text(const WalkTest& test, const WalkTestResult& result) {
  const WalkWords words(test);
  const std::string seats = words.of_seats(result);
  std::string text = words.of_major(count_passes(result, &PointResult::major, test.spec().major)) + "\n" +
                     words.of_minor(count_passes(result, &PointResult::minor, test.spec().minor)) + "; " +
                     words.of_deafness(result) + "\n" + (seats.empty() ? "" : seats + "\n");
  for (const std::string& line : passes_by_area(test, result)) text += "  " + line + "\n";
  return text;
}

io::Report walk_test_report(const WalkTest& test, const WalkTestResult& result) {
  const WalkTestSpec& spec = test.spec();
  const WalkWords words(test);
  io::Report report;
  report.title = words.title();
  report.paragraphs = {words.method(), signs_of_maps(test.scene())};
  const std::vector<std::string> by_area = passes_by_area(test, result);
  if (!by_area.empty())
    report.paragraphs.push_back("By area (its sensors in brackets): " + joined(by_area, "; ") + ".");
  io::ReportSection major{"Major motion: walking", {}, {}, {}}, minor{words.minor_heading(), {}, {}, {}};
  major.paragraphs = {capitalised(words.of_major(count_passes(result, &PointResult::major, spec.major))) + "."};
  minor.paragraphs = {capitalised(words.of_minor(count_passes(result, &PointResult::minor, spec.minor))) + "; " +
                      words.of_deafness(result) + "."};
  const std::string seats = words.of_seats(result);
  if (!seats.empty()) minor.paragraphs.push_back((spec.arm ? "In all, " : "Facing as the seats do, ") + seats + ".");
  add_maps(major, test, result, &PointResult::major, spec.major, words.time_of_major());
  add_maps(minor, test, result, &PointResult::minor, spec.minor, words.time_of_minor());
  report.sections = {std::move(major), std::move(minor)};
  return report;
}

}  // namespace pirsim::studies
