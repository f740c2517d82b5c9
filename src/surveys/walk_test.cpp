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

// A walk test in words.

/// Where specs and points have a kind of motion.
struct MotionOf {
  WalkRequirement WalkTestSpec::*requirement;
  Tries PointResult::*tries;
};
constexpr MotionOf major_motion{&WalkTestSpec::major, &PointResult::major},
    minor_motion{&WalkTestSpec::minor, &PointResult::minor};
bool is_major(const MotionOf& motion) { return motion.tries == major_motion.tries; }

std::string plain(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

bool passes(const WalkTestSpec& spec, const MotionOf& motion, const PointResult& point) {
  const Tries& tries = point.*motion.tries;
  return tries.made > 0 && *tries.probability() >= (spec.*motion.requirement).probability - 1e-12;
}

/// Points that could be tried, and those of them that pass.
struct PassCount {
  std::size_t tried = 0, passed = 0;

  void add(const WalkTestSpec& spec, const MotionOf& motion, const PointResult& point) {
    tried += (point.*motion.tries).made > 0 ? 1 : 0;
    passed += passes(spec, motion, point) ? 1 : 0;
  }
  /// "3 of 4"
  [[nodiscard]] std::string text() const { return std::to_string(passed) + " of " + std::to_string(tried); }
};

/// Index of the square that holds the point; none beside the grid.
std::optional<std::size_t> square_at(const FloorGrid& grid, const Vec2& point) {
  const Vec2 from_corner = (point - grid.centre(0, 0)) / grid.spacing_m() + 0.5;
  const double column = std::floor(from_corner.x), row = std::floor(from_corner.y);
  if (column < 0.0 || row < 0.0 || column >= static_cast<double>(grid.n_columns()) ||
      row >= static_cast<double>(grid.n_rows()))
    return std::nullopt;
  return static_cast<std::size_t>(row) * grid.n_columns() + static_cast<std::size_t>(column);
}

/// Until when motion counts: "within 1.5 s".
std::string time_of(const WalkTestSpec& spec, const MotionOf& motion) {
  return is_major(motion) && spec.stop_s ? "before a stop of " + plain(*spec.stop_s) + " s ends"
                                         : "within " + plain((spec.*motion.requirement).within_s) + " s";
}

std::string planes(const SwingingArmSpec& arm) {
  std::vector<std::string> words;
  for (const ArmSwing plane : arm.swings)
    words.emplace_back(plane == ArmSwing::horizontal ? "horizontally" : "vertically");
  return joined(words, " and ");
}

/// "walker noticed within 1.5 s in at least 90 % of 8 directions: 59 of 63 points pass", without a full stop.
std::string passes_in_words(const WalkTestSpec& spec, const MotionOf& motion, const WalkTestResult& result) {
  PassCount count;
  for (const PointResult& point : result.points) count.add(spec, motion, point);
  const WalkRequirement& required = spec.*motion.requirement;
  const std::string who = is_major(motion) ? "walker" : spec.arm ? "swinging arm" : "sitter's arms";
  return who + " noticed " + time_of(spec, motion) + " in at least " + percent(required.probability) + " of " +
         std::to_string(required.directions) + " directions" +
         (spec.arm && !is_major(motion) ? ", " + planes(*spec.arm) : "") + ": " + count.text() + " points pass";
}

/// Of all tries of minor motion: how many failed, and in how many of those sensors saw what moved.
std::string deafness_in_words(const WalkTestSpec& spec, const WalkTestResult& result) {
  int missed = 0, deaf = 0;
  for (const PointResult& point : result.points) {
    missed += point.minor.made - point.minor.noticed;
    deaf += point.minor.deaf;
  }
  return "of " + std::to_string(missed) + " tries without notice, sensors saw the " + (spec.arm ? "arm" : "sitter") +
         " in " + std::to_string(deaf);
}

/// A line, or no text without seats.
std::string seats_in_words(const WalkTest& test, const WalkTestResult& result) {
  const auto named = [](const std::string& seats) { return seats.empty() ? " none" : seats; };
  if (test.scene().seats.empty()) return {};
  if (!test.spec().arm) {
    std::string noticed, deaf, unseen;
    for (const SeatResult& seat : result.seats) {
      (seat.noticed ? noticed : seat.deaf ? deaf : unseen) += " " + seat.seat;
    }
    return "seats where a sitter's arms are noticed:" + named(noticed) + "; seen, but not noticed:" + named(deaf) +
           "; unseen:" + named(unseen);
  }
  std::string outside;
  for (const SeatSpec& seat : test.scene().seats) {
    const std::optional<std::size_t> at = square_at(result.grid, floor_point(seat.world_from_seat.origin));
    if (!at || !passes(test.spec(), minor_motion, result.points[*at])) outside += " " + seat.id;
  }
  return "seats in squares that fail:" + named(outside);
}

/// What is done, and what the sensors answer by.
std::string method_in_words(const WalkTest& test) {
  const std::string response =
      ". A try counts as noticed if any sensor reports motion in time; the sensors' response is " +
      responses_in_words(test.scene(), test.spec().sensing) + ".";
  std::string text =
      "At every point of a grid a person of the study's measures walks across in several directions (major motion), "
      "and ";
  if (!test.spec().arm) {
    return text + "sits there facing several ways and moves both forearms (minor motion)" + response +
           " In the manner of NEMA WD 7 and EN 50131-2-2; not a conformity test.";
  }
  const SwingingArmSpec& arm = *test.spec().arm;
  text += "a box of " + plain(arm.width_m) + " x " + plain(arm.width_m) + " x " + plain(arm.length_m) +
          " m, whose axis is " + plain(arm.height_m) + " m above the floor, swings by " + plain(arm.swing_deg) +
          " degrees and back at " + plain(arm.deg_per_s) + " degrees a second, " + planes(arm) + " (minor motion)";
  return text + response;
}

/// "kitchen (PIR1): walker 3 of 4 points pass, arms 2 of 4": a line an area.
std::vector<std::string> passes_by_area(const WalkTest& test, const WalkTestResult& result) {
  const Areas areas(test.scene());
  const FloorGrid& grid = test.grid();
  std::vector<PassCount> walks(areas.size()), arms(areas.size());
  each_square(grid, [&](std::size_t column, std::size_t row) {
    if (areas.empty()) return;
    const PointResult& point = result.points[row * grid.n_columns() + column];
    const std::size_t area = areas.at(grid.centre(column, row));
    walks[area].add(test.spec(), major_motion, point);
    arms[area].add(test.spec(), minor_motion, point);
  });
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    lines.push_back(with_sensors(test.scene(), areas, i) + ": walker " + walks[i].text() + " points pass, " +
                    (test.spec().arm ? "arm " : "arms ") + arms[i].text());
  }
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
  for (const SensorSpec& sensor : test.scene().sensors) chart.markers.push_back(marker_of(sensor));
  return chart;
}

io::ReportSection motion_section(const std::string& heading, const WalkTest& test, const WalkTestResult& result,
                                 const MotionOf& motion) {
  const WalkTestSpec& spec = test.spec();
  std::string finding = passes_in_words(spec, motion, result);
  finding[0] = static_cast<char>(finding[0] - 'a' + 'A');
  if (!is_major(motion)) finding += "; " + deafness_in_words(spec, result);
  io::ReportSection section{heading, {finding + "."}, {}, {}};
  io::MapChart probability = map_of(test, "Probability of being noticed", "probability");
  io::MapChart pass = map_of(test, "Pass or fail", "verdict");
  pass.colours = io::MapChart::Colours::pass_or_fail;
  probability.note = time_of(spec, motion) + "; no colour: nothing could be tried there";
  pass.note = "required: " + percent((spec.*motion.requirement).probability);
  probability.unit = "of the tries noticed";
  for (const PointResult& point : result.points) {
    const Tries& tries = point.*motion.tries;
    probability.values.push_back(tries.probability());
    pass.values.push_back(tries.made == 0 ? std::nullopt : std::optional(passes(spec, motion, point) ? 1.0 : 0.0));
  }
  section.charts = {std::move(probability), std::move(pass)};
  return section;
}

struct PointLine {
  std::string x_m, z_m;  ///< with all decimals
  const PointResult& point;
  std::string_view major, minor;
};

template <Tries PointResult::*motion, int Tries::*number>
Cell of_tries(const PointLine& line) {
  return (line.point.*motion).*number;
}

constexpr Column<PointLine> point_lines[]{
    {{"x_m", Holds::number, "of the point", "m"}, [](const PointLine& line) -> Cell { return line.x_m; }},
    {{"z_m", Holds::number, "of the point", "m"}, [](const PointLine& line) -> Cell { return line.z_m; }},
    {{"major_tries", Holds::count, "walks across it that are possible"}, of_tries<&PointResult::major, &Tries::made>},
    {{"major_noticed", Holds::count, "of them, in which a sensor reported motion in time"},
     of_tries<&PointResult::major, &Tries::noticed>},
    {{"major", Holds::text, "`pass`, `fail`, or `untried` where nobody can walk"},
     [](const PointLine& line) -> Cell { return line.major; }},
    {{"minor_tries", Holds::count, "movements of arms over it"}, of_tries<&PointResult::minor, &Tries::made>},
    {{"minor_noticed", Holds::count, "of them, in which a sensor reported motion in time"},
     of_tries<&PointResult::minor, &Tries::noticed>},
    {{"minor", Holds::text, "`pass`, `fail`, or `untried` where nobody can sit"},
     [](const PointLine& line) -> Cell { return line.minor; }},
    {{"minor_deaf", Holds::count, "of those without notice, in which a sensor saw what moved"},
     of_tries<&PointResult::minor, &Tries::deaf>},
};

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

WalkTestResult run_walk_test(const WalkTest& test, unsigned threads, const RowDone& row_done) {
  const FloorGrid& grid = test.grid();
  WalkTestResult result{grid, {}, {}};
  result.points = row_by_row<PointResult>(grid, threads, row_done, [&](std::size_t row) {
    WalkTester tester(test);
    std::vector<PointResult> points(grid.n_columns());
    for (std::size_t column = 0; column < grid.n_columns(); ++column) {
      const auto number = static_cast<std::uint32_t>(row * grid.n_columns() + column);
      if (grid.on_floor(column, row)) points[column] = tester.try_point(grid.centre(column, row), number);
    }
    return points;
  });
  if (test.spec().arm) return result;  // it sits nowhere
  WalkTester tester(test);
  auto number = static_cast<std::uint32_t>(grid.n_rows() * grid.n_columns());
  for (const SeatSpec& seat : test.scene().seats) result.seats.push_back(tester.try_seat(seat, number++));
  return result;
}

std::string to_csv(const WalkTest& test, const WalkTestResult& result) {
  constexpr int decimals = 4;
  std::ostringstream out;
  io::TableWriter<PointLine> csv(out, std::span<const Column<PointLine>>(point_lines));
  const auto verdict = [&](const PointResult& point, const MotionOf& motion) -> std::string_view {
    return (point.*motion.tries).made == 0 ? "untried" : passes(test.spec(), motion, point) ? "pass" : "fail";
  };
  each_square(test.grid(), [&](std::size_t column, std::size_t row) {
    const Vec2 centre = test.grid().centre(column, row);
    const PointResult& point = result.points[row * test.grid().n_columns() + column];
    csv.write({fixed(centre.x, decimals), fixed(centre.y, decimals), point, verdict(point, major_motion),
               verdict(point, minor_motion)});
  });
  return out.str();
}

std::string to_text(const WalkTest& test, const WalkTestResult& result) {
  const std::string seats = seats_in_words(test, result);
  std::string text = passes_in_words(test.spec(), major_motion, result) + "\n" +
                     passes_in_words(test.spec(), minor_motion, result) + "; " +
                     deafness_in_words(test.spec(), result) + "\n" + (seats.empty() ? "" : seats + "\n");
  for (const std::string& line : passes_by_area(test, result)) text += "  " + line + "\n";
  return text;
}

io::Report walk_test_report(const WalkTest& test, const WalkTestResult& result) {
  const bool has_arm = test.spec().arm.has_value();
  io::Report report;
  report.title = test.spec().name + ": walk test of " + test.scene().name;
  report.paragraphs = {method_in_words(test), signs_of_maps(test.scene())};
  const std::vector<std::string> by_area = passes_by_area(test, result);
  if (!by_area.empty())
    report.paragraphs.push_back("By area (its sensors in brackets): " + joined(by_area, "; ") + ".");
  report.sections = {motion_section("Major motion: walking", test, result, major_motion),
                     motion_section(has_arm ? "Minor motion: a swinging arm" : "Minor motion: arms of a sitter", test,
                                    result, minor_motion)};
  const std::string seats = seats_in_words(test, result);
  if (!seats.empty())
    report.sections.back().paragraphs.push_back((has_arm ? "In all, " : "Facing as the seats do, ") + seats + ".");
  return report;
}

}  // namespace pirsim::studies

namespace pirsim {

WalkTestResult run_walk_test(SceneSpec scene, WalkTestSpec spec, unsigned threads, const RowDone& row_done) {
  return studies::run_walk_test(studies::WalkTest(std::move(scene), std::move(spec)), threads, row_done);
}

}  // namespace pirsim
