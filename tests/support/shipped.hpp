// The shipped rooms and studies, and small scenes made of numbers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pirsim/io.hpp"
#include "pirsim/model.hpp"
#include "pirsim/study.hpp"
#include "support/paths.hpp"

namespace pirsim::test {

inline std::filesystem::path data(const std::string& file) { return data_dir() / file; }
inline SceneSpec shipped_scene(const std::string& file) { return io::read_scene(data("rooms/" + file)); }
inline io::SceneOptions shipped_sensors() { return {{data("sensors")}, {}}; }
/// That of a wall.
inline SensorModelSpec wall_lens() { return io::read_sensor_model(data("sensors/EKMC1604111.yaml")); }
inline ScriptSpec shipped_script(const std::string& file, const std::vector<std::string>& overrides = {}) {
  return io::read_script(data("studies/" + file), overrides);
}

/// A script with one trial and these people. Sensors answer by hard zones, which cost least.
inline ScriptSpec script_of(std::vector<PersonSpec> people) {
  ScriptSpec script;
  script.name = "test";
  script.sensing.response = Response::zones;
  script.trials = {{"1", std::move(people)}};
  return script;
}

inline PersonSpec person(std::string id, std::vector<ScriptedAction> actions) {
  PersonSpec spec;
  spec.id = std::move(id);
  spec.actions = std::move(actions);
  return spec;
}
inline ScriptedAction act(Action what) { return {std::move(what), {}, {}, {}}; }
inline ScriptedAction act_at(double seconds, Action what) { return {std::move(what), seconds, {}, {}}; }

}  // namespace pirsim::test
