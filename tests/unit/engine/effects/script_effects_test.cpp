#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

ScriptSpec script_with(const std::string& effects, const std::vector<std::string>& overrides = {}) {
  const TemporaryFolder folder;
  return io::read_script(folder.write("script.yaml",
                                      "pirsim_script: 1\npeople:\n- id: anna\n  actions:\n"
                                      "  - appear: {at_xz_m: [2, -2]}\n" +
                                          effects),
                         overrides);
}
std::string faults_of(const std::string& effects) {
  try {
    (void)compile(shipped_scene("meeting_room.gltf"), script_with(effects));
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::input);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("effects are read in order with numbers and names and can be overridden") {
  const std::string text = "effects:\n- dead_time\n- missed_triggers: {probability: 0.3, sensor: PIR3}\n";
  const ScriptSpec script = script_with(text, {"effects.1.missed_triggers.probability=0.4"});
  REQUIRE(script.effects.size() == 2);
  CHECK(script.effects[0].name == "dead_time");
  CHECK(script.effects[1].parameters.at("probability") == 0.4);
  CHECK(script.effects[1].choices.at("sensor") == "PIR3");
  CHECK(script_with("", {"effects=[{dead_time: {dead_s: 1}}]"}).effects.at(0).parameters.at("dead_s") == 1.0);
}

TEST_CASE("a sensor's name may look like a number, also in the script that is written") {
  const ScriptSpec script = script_with("effects: [{missed_triggers: {probability: 0.3, sensor: 1.0}}]");
  CHECK(script.effects.at(0).choices.at("sensor") == "1.0");
  const TemporaryFolder folder;
  const ScriptSpec again = io::read_script(folder.write("again.yaml", io::to_yaml(script)));
  CHECK(again.effects.at(0).choices.at("sensor") == "1.0");
}

TEST_CASE("what is wrong with an effect is said with its place and the nearest name") {
  CHECK_THAT(faults_of("effects:\n- dead_tyme\n"),
             contains("'dead_tyme' is not an effect (did you mean 'dead_time'?)"));
  CHECK_THAT(faults_of("effects:\n- dead_tyme\n"), contains("script.yaml:7:3: error"));
  CHECK_THAT(faults_of("effects: [{dead_time: {dead: 2}}]"), contains("no parameter 'dead' (did you mean 'dead_s'?)"));
  CHECK_THAT(faults_of("effects: [{dead_time: {dead_s: long}}]"), contains("expected a number, not 'long'"));
  CHECK_THAT(faults_of("effects: [{dead_time: {dead_s: -1}}]"), contains("expected a number from 0 to 600, not -1"));
  CHECK_THAT(faults_of("effects: [{dead_time: {sensor: 3}}]"), contains("'3' is not in meeting_room.gltf"));
  CHECK_THAT(faults_of("effects: [{dead_time: {sensor: PIR9}}]"), contains("'PIR9' is not in meeting_room.gltf"));
  CHECK_THAT(faults_of("effects: [dead_time, dead_time: {sensor: PIR1}]"), contains("a second time"));
  CHECK_THAT(faults_of("effects: [dead_time: 3]"), contains("expected parameters by name"));
  CHECK_THAT(faults_of("effects: [{dead_time: {}, clock_lag: {}}]"), contains("one effect per entry"));
  CHECK(faults_of("effects: [dead_time: {sensor: PIR1}, dead_time: {sensor: PIR2}]").empty());
}

TEST_CASE("an effect stands twice only where both entries act") {
  for (const std::string twice :
       {"soft_zone_edges, soft_zone_edges: {sigma_deg: 2}", "dual_polarity, dual_polarity", "fidgeting, fidgeting",
        "body_size: {scale: 0.9}, body_size: {scale: 1.1}", "second_person, second_person",
        "mirrored_room, mirrored_room: {across: x}", "missing_occluder, missing_occluder: {height_m: 1}",
        "sensor_yaw, sensor_yaw: {sensor: PIR1}", "wall_reflection: {wall: room}, wall_reflection: {wall: room}",
        "missing_occluder: {what: box, box_height_m: 1}, missing_occluder: {what: box}"}) {
    INFO(twice);
    CHECK_THAT(faults_of("effects: [" + twice + "]"), contains("a second time"));
  }
  for (const std::string apart :
       {"sensor_yaw: {sensor: PIR2}, sensor_yaw: {sensor: PIR1}", "mirrored_room, mirrored_room: {across: z}",
        "missing_occluder, missing_occluder: {what: box, x_m: 1}",
        "missing_occluder: {what: box, x_m: 1}, missing_occluder: {what: box}",
        "second_person, second_person: {place: given, x_m: 1.2, z_m: -2}"}) {
    INFO(apart);
    CHECK(faults_of("effects: [" + apart + "]").empty());
  }
}

TEST_CASE("a column that would be swapped with itself is refused, named or by default") {
  const auto twice = [](const std::string& id) {
    return contains("script.yaml:7:3: error: labels_swapped: sensor and other are both '" + id +
                    "': nothing would be swapped");
  };
  CHECK_THAT(faults_of("effects:\n- labels_swapped: {sensor: PIR2}\n"), twice("PIR2"));
  CHECK_THAT(faults_of("effects:\n- labels_swapped: {other: PIR1}\n"), twice("PIR1"));
  CHECK_THAT(faults_of("effects:\n- labels_swapped: {sensor: PIR4, other: PIR4}\n"), twice("PIR4"));
  CHECK_THAT(faults_of("effects: [labels_swapped: {sensor: PIR9, other: PIR9}]"),
             !contains("nothing would be swapped"));
  CHECK(faults_of("effects: [labels_swapped, sensor_yaw: {sensor: PIR2}]").empty());
  CHECK(faults_of("effects: [labels_swapped: {sensor: PIR3}]").empty());
}
