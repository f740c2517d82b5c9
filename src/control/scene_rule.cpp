// Lights of a scene's areas.
#include <algorithm>

#include "pirsim/control.hpp"
#include "pirsim/scene.hpp"
#include "schema/areas.hpp"

namespace pirsim::control {

RuleSpec rule_of(const SceneSpec& scene, const std::string& name, std::vector<Issue>& remarks) {
  RuleSpec rule{name, {}};
  const Areas areas(scene);
  if (areas.empty()) rule.lights.emplace_back();
  for (std::size_t area = 0; area < areas.size(); ++area) {
    LightSpec light;
    light.id = light.area = areas.names()[area];
    for (const std::size_t sensor : areas.sensors_of(area)) light.sensors.push_back(scene.sensors[sensor].id);
    if (!light.sensors.empty()) {
      rule.lights.push_back(std::move(light));
    } else {
      remarks.push_back({Severity::warning,
                         {scene.name},
                         "the area '" + light.id + "' has no sensor that could switch a light: it is left out"});
    }
  }
  if (rule.lights.empty())
    throw Error(ErrorCode::input, {scene.name}, "no area has a sensor that could switch its light");
  return rule;
}

void name_sensors(RuleSpec& rule, const SceneSpec& scene) {
  std::vector<Issue> left_out;  // areas without sensors: told where the light stays without
  const RuleSpec of_scene = rule_of(scene, rule.name, left_out);
  for (LightSpec& light : rule.lights) {
    const auto same = std::ranges::find(of_scene.lights, light.area, &LightSpec::area);
    if (light.sensors.empty() && !light.area.empty() && same != of_scene.lights.end()) light.sensors = same->sensors;
  }
}

}  // namespace pirsim::control
