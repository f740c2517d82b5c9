// What a file's reader refuses, compile() refuses of a spec that a program made, and the other way round.
#include <cmath>
#include <functional>
#include <iomanip>
#include <limits>
#include <sstream>

#include "gltf_builder.hpp"
#include "model/schema/fields.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The message, or nothing of what is accepted.
std::string refusal_by(const auto& make) {
  const std::string told = fault_of(make);
  return told == "accepted" ? std::string() : told;
}

std::string refusal_to_write(const auto& spec) {
  return refusal_by([&] {
    Diagnostics diagnostics;
    check(spec, diagnostics);
    diagnostics.throw_if_errors();
    return 0;
  });
}

/// Through a file.
std::string refusal_of_file(const ScriptSpec& script) {
  return refusal_by([&] { return io::parse_script(io::to_yaml(script), "script.yaml"); });
}
std::string refusal_of_file(const SceneSpec& scene) {
  const TemporaryFolder folder;
  io::write_scene(folder.path() / "scene.gltf", scene);
  return refusal_by([&] { return io::read_scene(folder.path() / "scene.gltf"); });
}

std::string number(double value) {
  std::ostringstream text;
  text << std::setprecision(17) << value;
  return text.str();
}

/// A sensor's file with these zones.
std::string text_of(const SensorModelSpec& model) {
  std::ostringstream text;
  text << std::setprecision(17) << "id: " << model.id << "\nplane_m: " << model.plane_m << "\n";
  const auto part = [&](const char* name, const auto& spec) {
    text << name << ":\n";
    each_number(spec, [&](const char* key, const auto& value, const auto&) {
      if constexpr (requires { value.has_value(); }) {
        if (value) text << "  " << key << ": " << number(*value) << "\n";
      } else {
        text << "  " << key << ": " << number(value) << "\n";
      }
    });
  };
  const bool is_beam = model.idle_share != SensorModelSpec{}.idle_share;  // which has no electronics
  if (is_beam) {
    text << "kind: beam\nidle_share: " << number(model.idle_share) << "\n";
  } else {
    part("optics", model.optics);
    part("element", model.detector.element);
    part("amplifier", model.detector.amplifier);
    part("comparator", model.detector.comparator);
    part("report", model.detector.report);
  }
  text << "sources:\n";
  const auto source = [&](const std::string& key, const auto&...) { text << "  " << key << ": 'assumed: a test'\n"; };
  for (const char* key : {"plane_m", "range_m", "lens_step", "polarity", "corners_m"}) source(key);
  if (is_beam) {
    source("idle_share");
  } else {
    each_number(model.optics, source);
    each_number(model.detector.element, source);
    each_number(model.detector.amplifier, source);
    each_number(model.detector.comparator, source);
    each_number(model.detector.report, source);
  }
  text << "clusters:\n";
  for (const ClusterSpec& cluster : model.clusters) {
    text << "- range_m: " << cluster.range_m << "\n  lens_step: " << cluster.lens_step << "\n  zones:\n";
    for (const ZoneSpec& zone : cluster.zones) {
      text << "  - polarity: " << zone.polarity << "\n    corners_m: [";
      for (const Vec2& corner : zone.corners) text << '[' << corner.x << ", " << corner.y << "], ";
      text << "]\n";
    }
    if (cluster.zones.empty()) text << "  - {}\n";
  }
  if (model.clusters.empty()) text << "  []\n";
  return text.str();
}
std::string refusal_of_file(const SensorModelSpec& model) {
  const TemporaryFolder folder;
  return refusal_by([&] { return io::read_sensor_model(folder.write("sensor.yaml", text_of(model))); });
}

SceneSpec plain_scene() {
  SceneSpec scene;
  scene.name = "scene";
  scene.floor = FloorArea({{{0, 0}, {5, 0}, {5, 4}, {0, 4}}}, 0.0);
  scene.meshes = {{"plate", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}};
  scene.seats = {{"S1", {Quat(1, 0, 0, 0), {1, 0.5, 1}}}};
  scene.entrances = {{"door", {Quat(1, 0, 0, 0), {2.5, 0, 4}}}};
  scene.sensor_models = {{"EKMC1604111", io::find_sensor_model("EKMC1604111", {})}};
  scene.sensors = {{"PIR1", "EKMC1604111", {Quat(1, 0, 0, 0), {2.5, 2, 4}}}};
  return scene;
}

/// With every part that a script can have but a schedule.
ScriptSpec plain_script() {
  PersonSpec one = person("a", {act(action::Appear{{1, 1}}), act(action::Wait{1.0}), act(action::Walk{{{1, 2}}}),
                                act(action::Turn{90.0}), act(action::Sit{"S1", 30.0}), act(action::Work{})});
  one.actions[1].at_s = 1.0;
  one.warmth.parts_c["head"] = 34.0;
  ScriptSpec script = script_of({one});
  script.trials.front().duration_s = 60.0;
  return script;
}
ScriptSpec plain_schedule() {
  ScriptSpec script = script_of({});
  ScheduleSpec schedule;
  schedule.staff = {StaffSpec{}};
  schedule.meetings.emplace_back();
  schedule.meetings[0].most_people = 4;
  schedule.meetings[0].held = {HeldMeetingSpec{}};
  schedule.cleaning_h = 19.0;
  script.trials.front().schedule = schedule;
  return script;
}

/// Just outside of a range, on both sides, and what is no number at all.
std::vector<double> outside(const NumberRange& range) {
  std::vector<double> values{std::nan(""), infinity, -infinity};
  if (std::isfinite(range.above)) values.push_back(range.above);
  if (std::isfinite(range.min)) values.push_back(std::nextafter(range.min, -infinity));
  if (std::isfinite(range.max)) values.push_back(std::nextafter(range.max, infinity));
  return values;
}
std::vector<int> outside(const IntegerRange& range) {
  std::vector<int> values;
  if (range.min > IntegerRange{}.min) values.push_back(static_cast<int>(range.min) - 1);
  if (range.max < IntegerRange{}.max) values.push_back(static_cast<int>(range.max) + 1);
  return values;
}

/// Refused both ways for `part` being wrong in a single number, which the refusal of the object names.
template <typename Spec, typename Part, typename File>
int check_numbers(const Spec& whole, const std::function<Part&(Spec&)>& part_of, const File& refusal_by_file) {
  int tried = 0;
  Spec spec = whole;
  each_number(part_of(spec), [&](const std::string& name, auto& value, const auto& range) {
    using Value = std::remove_reference_t<decltype(value)>;
    const auto try_out = [&](const auto& wrong) {
      INFO(name << ", expected " << range.text());
      CHECK(refusal_to_write(spec).find(name) != std::string::npos);
      INFO(wrong);
      CHECK_FALSE(refusal_by_file(spec).empty());
      ++tried;
    };
    const Value right = value;
    if constexpr (std::same_as<Value, std::uint64_t>) {
      value = std::uint64_t{1} << 63U;
      try_out(value);
    } else {
      for (const auto wrong : outside(range)) {
        if constexpr (std::same_as<Value, std::vector<double>>) {
          value.front() = wrong;
        } else {
          value = wrong;
        }
        try_out(wrong);
      }
    }
    value = right;
  });
  return tried;
}

template <typename Part>
int script_numbers(const ScriptSpec& script, const std::function<Part&(ScriptSpec&)>& part_of) {
  return check_numbers<ScriptSpec, Part>(script, part_of, [](const ScriptSpec& s) { return refusal_of_file(s); });
}
template <typename What>
int action_numbers(std::size_t index) {
  return script_numbers<What>(plain_script(), [&](ScriptSpec& s) -> What& {
    return std::get<What>(s.trials.front().people.front().actions[index].what);
  });
}
template <typename Part>
int schedule_numbers(const std::function<Part&(ScheduleSpec&)>& part_of) {
  return script_numbers<Part>(plain_schedule(),
                              [&](ScriptSpec& s) -> Part& { return part_of(*s.trials.front().schedule); });
}
template <typename Part>
int sensor_numbers(const std::function<Part&(SensorModelSpec&)>& part_of) {
  return check_numbers<SceneSpec, Part>(
      plain_scene(), [&](SceneSpec& s) -> Part& { return part_of(s.sensor_models.begin()->second); },
      [](const SceneSpec& s) { return refusal_of_file(s.sensor_models.begin()->second); });
}

}  // namespace

TEST_CASE("specs that both ways are to accept are accepted", "[both-ways]") {
  CHECK(refusal_to_write(plain_script()).empty());
  CHECK(refusal_of_file(plain_script()).empty());
  CHECK(refusal_to_write(plain_schedule()).empty());
  CHECK(refusal_of_file(plain_schedule()).empty());
  CHECK(refusal_to_write(plain_scene()).empty());
  CHECK(refusal_of_file(plain_scene()).empty());
  CHECK(refusal_of_file(plain_scene().sensor_models.begin()->second) == "");
  SensorModelSpec beam = plain_scene().sensor_models.begin()->second;
  beam.idle_share = 0.5;
  CHECK(refusal_of_file(beam) == "");
  CHECK_FALSE(refusal_by([] {
                return io::parse_script("pirsim_script: 1\npeople:\n  - {id: a, actions: [~]}\n", "s.yaml");
              }).empty());
  for (const char* room : {"meeting_room.gltf", "open_office.gltf", "open_hall.gltf"}) {
    CHECK(refusal_to_write(shipped_scene(room)).empty());
  }
  for (const char* study : {"studyA.yaml", "office.yaml", "density.yaml"})
    CHECK(refusal_to_write(shipped_script(study)).empty());
}

TEST_CASE("a number out of its range is refused by file and by object", "[both-ways]") {
  const auto first = [](ScriptSpec& s) -> PersonSpec& { return s.trials.front().people.front(); };
  int n = 0;
  n += script_numbers<ScriptSpec>(plain_script(), [](ScriptSpec& s) -> ScriptSpec& { return s; });
  n += script_numbers<SensingSpec>(plain_script(), [](ScriptSpec& s) -> SensingSpec& { return s.sensing; });
  n += script_numbers<TrialSpec>(plain_script(), [](ScriptSpec& s) -> TrialSpec& { return s.trials.front(); });
  n += script_numbers<PersonSpec>(plain_script(), first);
  n += script_numbers<WarmthSpec>(plain_script(), [&](ScriptSpec& s) -> WarmthSpec& { return first(s).warmth; });
  n += script_numbers<SeatScatterSpec>(plain_script(),
                                       [&](ScriptSpec& s) -> SeatScatterSpec& { return first(s).seat_scatter; });
  n += action_numbers<action::Appear>(0) + action_numbers<action::Wait>(1) + action_numbers<action::Turn>(3) +
       action_numbers<action::Sit>(4) + action_numbers<action::Work>(5);
  n += schedule_numbers<ScheduleSpec>([](ScheduleSpec& s) -> ScheduleSpec& { return s; });
  n += schedule_numbers<ClockSpec>([](ScheduleSpec& s) -> ClockSpec& { return s.lunch; });
  n += schedule_numbers<StaffSpec>([](ScheduleSpec& s) -> StaffSpec& { return s.staff.front(); });
  n += schedule_numbers<MeetingsSpec>([](ScheduleSpec& s) -> MeetingsSpec& { return s.meetings[0]; });
  n +=
      schedule_numbers<HeldMeetingSpec>([](ScheduleSpec& s) -> HeldMeetingSpec& { return s.meetings[0].held.front(); });
  n += sensor_numbers<SensorModelSpec>([](SensorModelSpec& m) -> SensorModelSpec& { return m; });
  n += sensor_numbers<ClusterSpec>([](SensorModelSpec& m) -> ClusterSpec& { return m.clusters.front(); });
  n += sensor_numbers<OpticsSpec>([](SensorModelSpec& m) -> OpticsSpec& { return m.optics; });
  n += sensor_numbers<ElementSpec>([](SensorModelSpec& m) -> ElementSpec& { return m.detector.element; });
  n += sensor_numbers<AmplifierSpec>([](SensorModelSpec& m) -> AmplifierSpec& { return m.detector.amplifier; });
  n += sensor_numbers<ComparatorSpec>([](SensorModelSpec& m) -> ComparatorSpec& { return m.detector.comparator; });
  n += sensor_numbers<ReportSpec>([](SensorModelSpec& m) -> ReportSpec& { return m.detector.report; });
  CHECK(n > 200);
}

TEST_CASE("what else a script can't be is refused by file and by object", "[both-ways]") {
  const auto wrong = [](ScriptSpec script, const std::string& field, const auto& change) {
    INFO(field);
    change(script);
    CHECK(refusal_to_write(script).find(field) != std::string::npos);
    CHECK_FALSE(refusal_of_file(script).empty());
  };
  const ScriptSpec plain = plain_script();
  const auto first = [](ScriptSpec& s) -> PersonSpec& { return s.trials.front().people.front(); };
  const auto doing = [&](ScriptSpec& s, std::size_t i) -> Action& { return first(s).actions[i].what; };
  const std::string person = "script.trials[0].people[0]";
  wrong(plain, "script.trials[0].id", [](ScriptSpec& s) { s.trials.front().id.clear(); });
  wrong(plain, "script.trials[1].id: a second trial", [](ScriptSpec& s) { s.trials.push_back(s.trials.front()); });
  wrong(plain, person + ".id", [&](ScriptSpec& s) { first(s).id.clear(); });
  wrong(plain, "people[1].id: a second person", [&](ScriptSpec& s) { s.trials.front().people.push_back(first(s)); });
  wrong(plain, person + ".warmth.bare", [&](ScriptSpec& s) { first(s).warmth.bare.emplace_back("heed"); });
  wrong(plain, person + ".warmth.bare: 'head' is named twice", [&](ScriptSpec& s) {
    first(s).warmth.bare = {"head", "head"};
  });
  wrong(plain, person + ".warmth.parts_c", [&](ScriptSpec& s) { first(s).warmth.parts_c["heed"] = 30.0; });
  wrong(plain, person + ".warmth.parts_c", [&](ScriptSpec& s) { first(s).warmth.parts_c["head"] = 1e3; });
  wrong(plain, person + ".body_mesh_file", [&](ScriptSpec& s) { first(s).body_mesh_file = "nobody.gltf"; });
  wrong(plain, person + ".actions[1].at_s", [&](ScriptSpec& s) { first(s).actions[1].at_s = -1.0; });
  wrong(plain, person + ".actions[0].point", [&](ScriptSpec& s) { doing(s, 0) = action::Appear{{1e9, 0}}; });
  wrong(plain, person + ".actions[2].points[0]", [&](ScriptSpec& s) { doing(s, 2) = action::Walk{{{0, -1e9}}}; });
  wrong(plain, person + ".actions[2].points", [&](ScriptSpec& s) { doing(s, 2) = action::Walk{}; });
  wrong(plain, person + ".actions[1].activity", [&](ScriptSpec& s) {
    doing(s, 1) = action::Wait{1.0, Activity::phone};
  });
  wrong(plain, person + ".actions[1].activity", [&](ScriptSpec& s) {
    first(s).style = MotionStyle::natural;
    doing(s, 1) = action::Wait{1.0, Activity::typing};
  });
  wrong(plain, "script.sensing.ticks_per_window", [](ScriptSpec& s) { s.sensing.ticks_per_window = 0; });
  wrong(plain, "script.sensing.ticks_per_window", [](ScriptSpec& s) { s.sensing.ticks_per_window = 3601 * 50; });
  wrong(plain, "script.summary.phases[0]", [](ScriptSpec& s) { s.summary.phases = {"wroking"}; });
  wrong(plain, "script.replicates", [](ScriptSpec& s) {
    s.replicates = 10'000'000;
    for (int i = 0; i < 500; ++i) {
      s.trials.push_back(s.trials.front());
      s.trials.back().id += std::to_string(i);
    }
  });

  const auto schedule = [&](const std::string& field, const std::function<void(ScheduleSpec&)>& change) {
    wrong(plain_schedule(), "script.trials[0].schedule." + field,
          [&](ScriptSpec& s) { change(*s.trials.front().schedule); });
  };
  schedule("first_day", [](ScheduleSpec& s) { s.first_day = "2026-02-30"; });
  schedule("from_h", [](ScheduleSpec& s) { s.from_h = -1.0; });
  schedule("to_h", [](ScheduleSpec& s) { s.to_h = 25.0; });
  schedule("to_h", [](ScheduleSpec& s) { s.from_h = s.to_h; });
  schedule("departure", [](ScheduleSpec& s) { s.departure.mean_h = s.arrival.mean_h; });
  schedule("lunch.mean_h", [](ScheduleSpec& s) { s.lunch.mean_h = 24.5; });
  schedule("cleaning_h", [](ScheduleSpec& s) { s.cleaning_h = 24.5; });
  schedule("staff", [](ScheduleSpec& s) { s = ScheduleSpec{}; });
  schedule("meetings[0].probabilities", [](ScheduleSpec& s) { s.meetings[0].probabilities.pop_back(); });
  schedule("meetings[0].probabilities", [](ScheduleSpec& s) { s.meetings[0].probabilities.assign(4, 0.0); });
  schedule("meetings[0].to_h", [](ScheduleSpec& s) { s.meetings[0].to_h = s.meetings[0].from_h; });
  schedule("meetings[0].held[0].at_h", [](ScheduleSpec& s) { s.meetings[0].held.front().at_h = -1.0; });
  schedule("meetings[0].held[0].duration_min", [](ScheduleSpec& s) { s.meetings[0].held.front().at_h = 23.5; });
  schedule("meetings[0].held[1]", [](ScheduleSpec& s) { s.meetings[0].held.push_back(s.meetings[0].held.front()); });
  wrong(plain_schedule(), "script.trials[0].duration_s", [](ScriptSpec& s) { s.trials.front().duration_s = 60.0; });
}

TEST_CASE("what a scene can't be is refused by file and by object", "[both-ways]") {
  const auto wrong = [](const std::string& field, const auto& change) {
    INFO(field);
    SceneSpec scene = plain_scene();
    change(scene);
    CHECK(refusal_to_write(scene).find(field) != std::string::npos);
    CHECK_FALSE(refusal_of_file(scene).empty());
  };
  const std::string with_nul("a\0b", 3);
  for (const std::string& name :
       {std::string("../x,=cmd()"), std::string("a\nb"), with_nul, std::string(".a"), std::string()}) {
    wrong("scene.sensors[0].id", [&](SceneSpec& s) { s.sensors[0].id = name; });
    wrong("scene.seats[0].id", [&](SceneSpec& s) { s.seats[0].id = name; });
    wrong("scene.entrances[0].id", [&](SceneSpec& s) { s.entrances[0].id = name; });
    wrong("scene.sensor_models", [&](SceneSpec& s) {
      s.sensor_models[name] = s.sensor_models["EKMC1604111"];
      s.sensors[0].model = name;
    });
  }
  wrong("scene.sensors[0].id", [](SceneSpec& s) { s.sensors[0].id = "people"; });
  wrong("scene.sensors[1].id", [](SceneSpec& s) { s.sensors.push_back(s.sensors[0]); });
  wrong("scene.seats[1].id", [](SceneSpec& s) { s.seats.push_back(s.seats[0]); });
  wrong("scene.entrances[1].id", [](SceneSpec& s) { s.entrances.push_back(s.entrances[0]); });
  wrong("scene.sensors[0].model", [](SceneSpec& s) { s.sensors[0].model = "EKMC1604112"; });
  wrong("scene.sensors[0].world_from_sensor.origin",
        [](SceneSpec& s) { s.sensors[0].world_from_sensor.origin.x = 1e9; });
  wrong("scene.seats[0].world_from_seat.rotation",
        [](SceneSpec& s) { s.seats[0].world_from_seat.rotation = Quat(2, 0, 0, 0); });
  const Quat lying = glm::angleAxis(radians(90.0), Vec3(1, 0, 0));
  wrong("scene.seats[0].world_from_seat", [&](SceneSpec& s) { s.seats[0].world_from_seat.rotation = lying; });
  wrong("scene.entrances[0].world_from_entrance",
        [&](SceneSpec& s) { s.entrances[0].world_from_entrance.rotation = lying; });
  for (const double width_m : {0.29, 20.1, -1.0}) {
    wrong("scene.entrances[0].width_m", [&](SceneSpec& s) { s.entrances[0].width_m = width_m; });
  }
  wrong("scene.entrances[0].outside_m", [](SceneSpec& s) { s.entrances[0].outside_m = 51.0; });
  wrong("scene.meshes[0].positions[1]", [](SceneSpec& s) { s.meshes[0].positions[1].x = 1e9; });
  wrong("scene.meshes[0].positions[1]", [](SceneSpec& s) { s.meshes[0].positions[1].x = std::nan(""); });
  wrong("scene.meshes[0].triangles[0]", [](SceneSpec& s) { s.meshes[0].triangles[0][2] = 3; });
  wrong("scene.meshes[0].temperature_c", [](SceneSpec& s) { s.meshes[0].temperature_c = 201.0; });
  const auto floor = [&](std::vector<Vec2> loop) {
    wrong("scene.floor", [&](SceneSpec& s) { s.floor = FloorArea({std::move(loop)}, 0.0); });
  };
  floor({{0, 0}, {5, 0}});
  floor({{0, 0}, {1e9, 0}, {5, 4}});
  floor({{0, 0}, {5, 0}, {0, 4}, {5, 4}});
  floor({{0, 0}, {5, 0}, {2.5, 0}});
  floor(std::vector<Vec2>(10'001, Vec2(1.0)));
}

TEST_CASE("what a sensor can't be is refused by file and by object", "[both-ways]") {
  const auto wrong = [](const std::string& field, const std::function<void(SensorModelSpec&)>& change) {
    INFO(field);
    SceneSpec scene = plain_scene();
    change(scene.sensor_models.begin()->second);
    CHECK(refusal_to_write(scene).find("scene.sensor_models['EKMC1604111']." + field) != std::string::npos);
    CHECK_FALSE(refusal_of_file(scene.sensor_models.begin()->second).empty());
  };
  wrong("id", [](SensorModelSpec& m) { m.id.clear(); });
  wrong("clusters", [](SensorModelSpec& m) { m.clusters.clear(); });
  wrong("clusters[0].zones", [](SensorModelSpec& m) { m.clusters[0].zones.clear(); });
  wrong("clusters[1].zones[0].polarity", [](SensorModelSpec& m) { m.clusters[1].zones[0].polarity = 0; });
  wrong("clusters[1].zones[0].corners", [](SensorModelSpec& m) { m.clusters[1].zones[0].corners[0].x = 1e9; });
  wrong("clusters[1].zones[0].corners", [](SensorModelSpec& m) { m.clusters[1].zones[0].corners = {}; });
  wrong("detector.amplifier.high_hz", [](SensorModelSpec& m) { m.detector.amplifier.high_hz = 0.1; });
  wrong("detector.amplifier.offset_v", [](SensorModelSpec& m) { m.detector.amplifier.offset_v = 5.0; });
  wrong("detector.comparator.pulse_count", [](SensorModelSpec& m) { m.detector.comparator.pulse_count = 2; });
  wrong("detector.comparator", [](SensorModelSpec& m) { m.detector.comparator.positive_v = 0.9; });
}
