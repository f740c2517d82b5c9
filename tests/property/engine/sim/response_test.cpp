// Which response is in force, and what hard zones make of a sensor's file: each of its numbers either changes their
// rows or is told as unused.
#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "files/read/reader_parts.hpp"
#include "pirsim/look.hpp"
#include "pirsim/response.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

using Change = std::function<void(SensorModelSpec&)>;

/// One of the meeting room's sensors, with a circuit that counts, or the plain one.
SceneSpec room(const Change& change) {
  SceneSpec scene = shipped_scene("meeting_room.gltf");
  for (auto& [id, model] : scene.sensor_models) change(model);
  return scene;
}

void count_pulses(SensorModelSpec& model) {
  model.detector.comparator.pulse_count = 2;
  model.detector.comparator.pulse_window_s = 1.0;
}

ScriptSpec study(Response response) {
  ScriptSpec script = short_study_a();
  script.sensing.response = response;
  return script;
}

std::vector<RunResult> rows_of(const SceneSpec& scene, const ScriptSpec& script) {
  return results_of(compile(scene, script));
}

/// What each key's number is changed to.
const std::map<std::string, Change>& changes() {
  static const std::map<std::string, Change> all{
      {"blur_deg", [](SensorModelSpec& m) { m.optics.blur_deg = 1.0; }},
      {"aperture_mm2", [](SensorModelSpec& m) { m.optics.aperture_mm2 = 10.0; }},
      {"thermal_s", [](SensorModelSpec& m) { m.detector.element.thermal_s = 0.3; }},
      {"electrical_s", [](SensorModelSpec& m) { m.detector.element.electrical_s = 2.0; }},
      {"low_hz", [](SensorModelSpec& m) { m.detector.amplifier.low_hz = 0.7; }},
      {"high_hz", [](SensorModelSpec& m) { m.detector.amplifier.high_hz = 10.6; }},
      {"order", [](SensorModelSpec& m) { m.detector.amplifier.order = 1; }},
      {"volts_per_watt", [](SensorModelSpec& m) { m.detector.amplifier.volts_per_watt = 1e7; }},
      {"noise_v_pp", [](SensorModelSpec& m) { m.detector.amplifier.noise_v_pp = 0.3; }},
      {"offset_v", [](SensorModelSpec& m) { m.detector.amplifier.offset_v = 1.0; }},
      {"lowest_v", [](SensorModelSpec& m) { m.detector.amplifier.lowest_v = 0.1; }},
      {"highest_v", [](SensorModelSpec& m) { m.detector.amplifier.highest_v = 2.5; }},
      {"positive_v", [](SensorModelSpec& m) { m.detector.comparator.positive_v = 0.3; }},
      {"negative_v", [](SensorModelSpec& m) { m.detector.comparator.negative_v = 0.3; }},
      {"pulse_count", [](SensorModelSpec& m) { m.detector.comparator.pulse_count = 3; }},
      {"pulse_window_s", [](SensorModelSpec& m) { m.detector.comparator.pulse_window_s = 4.0; }},
      {"pulse_signs", [](SensorModelSpec& m) { m.detector.comparator.pulse_signs = PulseSigns::alternating; }},
      {"hold_s", [](SensorModelSpec& m) { m.detector.report.hold_s = 2.3; }},
      {"again_s", [](SensorModelSpec& m) { m.detector.report.again_s = 5.0; }},
      {"blind_s", [](SensorModelSpec& m) { m.detector.report.blind_s = 5.0; }}};
  return all;
}

}  // namespace

TEST_CASE("a study's word on the response goes before a sensor's own, which is analog unless it says zones",
          "[sensor]") {
  SceneSpec scene = shipped_scene("meeting_room.gltf");
  scene.sensors[1].model = "HARD";
  scene.sensor_models["HARD"] = scene.sensor_models.at("EKMC1604111");
  scene.sensor_models["HARD"].response = Response::zones;
  const auto responses = [&](const SensingSpec& sensing) {
    return std::pair(response_of(scene, sensing, scene.sensors[0]), response_of(scene, sensing, scene.sensors[1]));
  };
  CHECK(responses({}) == std::pair(Response::analog, Response::zones));
  CHECK(responses(study(Response::zones).sensing) == std::pair(Response::zones, Response::zones));
  CHECK(responses(study(Response::analog).sensing) == std::pair(Response::analog, Response::analog));
  CHECK(responses_in_words(scene, {}) == "zones (HARD) and analog (EKMC1604111)");
  SensingSpec analog = study(Response::analog).sensing;
  CHECK(responses_in_words(scene, analog) == "analog (EKMC1604111, HARD)");
  analog.units = Units::guaranteed;
  CHECK(responses_in_words(scene, analog) == "analog (EKMC1604111, HARD, guaranteed units)");
  analog.response = Response::zones;
  CHECK(responses_in_words(scene, analog) == "zones (EKMC1604111, HARD)");
}

TEST_CASE("check tells the response, and that it was another one in 0.1 to scripts that don't say", "[sensor]") {
  const auto told = [](std::optional<Response> response) {
    ScriptSpec script = short_study_a();
    script.sensing.response = response;
    return check_study(compile(shipped_scene("meeting_room.gltf"), script)).text;
  };
  const std::string note = "note: sensors answer by the analog response (since 0.2; 0.1 used zones: --response zones)";
  CHECK_THAT(told(std::nullopt), contains("response of the sensors: analog (EKMC1604111)\n") && contains(note));
  CHECK_THAT(told(Response::analog), contains("response of the sensors: analog") && !contains(note));
  CHECK_THAT(told(Response::zones), contains("response of the sensors: zones (EKMC1604111)\n") && !contains(note));
}

TEST_CASE("each number of a sensor's circuit and optics changes hard zones' rows or is told as unused", "[sensor]") {
  const std::vector<std::string> circuit = io::sourced_detector_keys();
  std::set<std::string> keys(circuit.begin(), circuit.end());
  keys.insert({"blur_deg", "aperture_mm2"});
  for (const std::string& key : keys) CHECK(changes().contains(key));
  const ScriptSpec script = study(Response::zones);
  const auto before = rows_of(room(count_pulses), script);
  std::set<std::string> obeyed;
  for (const auto& [key, change] : changes()) {
    INFO(key);
    CHECK(keys.contains(key));
    const SceneSpec scene = room([&, &change = change](SensorModelSpec& model) {
      count_pulses(model);
      change(model);
    });
    const bool changed = !same_rows(rows_of(scene, script), before);
    const std::vector<Issue> told = idle_sensor_keys(scene, script.sensing);
    CHECK(told.size() == (changed ? 0U : scene.sensor_models.size()));  // one a model
    for (const Issue& issue : told) CHECK_THAT(issue.message, contains(" " + key + ";"));
    if (changed) obeyed.insert(key);
    CHECK(idle_sensor_keys(scene, study(Response::analog).sensing).empty());
  }
  CHECK(obeyed == std::set<std::string>{"pulse_count", "pulse_window_s", "hold_s", "again_s", "blind_s"});
}

TEST_CASE("a sensor with the defaults of its family tells nothing, and its zones answer at once", "[sensor]") {
  for (const char* file : {"meeting_room.gltf", "open_office.gltf"}) {
    CHECK(idle_sensor_keys(shipped_scene(file), study(Response::zones).sensing).empty());
  }
}

TEST_CASE("behind zones an output holds, is blind and counts as the comparator does", "[sensor]") {
  const auto one_sensor = [](const Change& change) {
    return rows_of(room(change), study(Response::zones)).front().samples;
  };
  const auto plain = one_sensor([](SensorModelSpec&) {});
  constexpr std::size_t hold = 3;
  const auto held = one_sensor([](SensorModelSpec& m) { m.detector.report.hold_s = double(hold); });
  const auto blind = one_sensor([](SensorModelSpec& m) { m.detector.report.blind_s = 3600.0; });
  for (std::size_t s = 0; s < plain.front().bits.size(); ++s) {
    std::size_t n_blind_runs = 0;
    for (std::size_t row = 0; row < plain.size(); ++row) {
      const auto active = [&](std::size_t at) { return plain[at].bits[s] != 0; };
      bool since = false, well_before = false;
      for (std::size_t back = 0; back <= std::min(row, hold); ++back) since = since || active(row - back);
      for (std::size_t back = 0; back < std::min(row + 1, hold); ++back)
        well_before = well_before || active(row - back);
      if (well_before) REQUIRE(held[row].bits[s] == 1);
      if (!since) REQUIRE(held[row].bits[s] == 0);
      if (blind[row].bits[s] != 0) REQUIRE(active(row));
      n_blind_runs += blind[row].bits[s] != 0 && (row == 0 || blind[row - 1].bits[s] == 0) ? 1 : 0;
    }
    CHECK(n_blind_runs <= 1);  // it never answers again
  }
}
