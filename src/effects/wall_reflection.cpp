// A window, a screen or a steel cupboard mirrors far infrared: sensors see people in it.
#include <algorithm>
#include <glm/geometric.hpp>

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

/// Of upright faces, square metres, both sides of a box counted.
double upright_area_m2(const TriMesh& mesh) {
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 normal = glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    constexpr double upright = 0.1;  // of the normal's vertical part
    if (std::abs(normal.y) <= upright * glm::length(normal)) area += 0.5 * glm::length(normal);
  }
  return area;
}

std::vector<std::string> upright_meshes(const SceneSpec& scene) {
  constexpr double worth_mentioning_m2 = 1.0;  // assumed
  std::vector<std::string> names;
  for (const TriMesh& mesh : scene.meshes) {
    if (upright_area_m2(mesh) >= worth_mentioning_m2) names.push_back(mesh.name);
  }
  return names;
}

std::string largest(const SceneSpec& scene) {
  if (scene.meshes.empty()) return "";
  return std::ranges::max_element(scene.meshes, {}, upright_area_m2)->name;
}

void alter(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const auto wall = effect.choices.find("wall");
  study.sensing.reflections.push_back({wall == effect.choices.end() ? largest(scene) : wall->second,
                                       effect.parameters.at("coefficient"),
                                       word(effect, "finish") == "rough" ? effect.parameters.at("scatter_deg") : 0.0});
}

void draw(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  const std::vector<std::string> names = upright_meshes(scene);
  if (!names.empty()) effect.choices["wall"] = names[stream.index(static_cast<std::uint32_t>(names.size()))];
}

}  // namespace

const Effect& wall_reflection() {
  static const Effect effect{
      .info = {.name = "wall_reflection",
               .family = Family::environment,
               .stage = "optics",
               .summary =
                   "Rays go on mirrored at a glossy wall, with the range that the weakened signal allows; a rough one "
                   "scatters them.",
               .fingerprint = "ghost zones: sensors see seats that they don't face",
               .confused_with = {"second_person", "false_triggers", "range_scale"},
               .parameters = {{.name = "coefficient",
                               .unit = "",
                               .off = 0.0,
                               .typical = 0.5,
                               .low = 0.1,
                               .high = 0.95,
                               .least = 0.0,
                               .most = 1.0,
                               .source = "assumed: of power at 10 um; glass mirrors a tenth, bare metal nearly all"},
                              {.name = "scatter_deg",
                               .unit = "deg",
                               .role = Role::detail,
                               .off = 8.0,
                               .typical = 8.0,
                               .low = 3.0,
                               .high = 15.0,
                               .least = 0.0,
                               .most = 45.0,
                               .source = "assumed: standard deviation of a mirrored ray's direction; brushed metal, "
                                         "lacquer",
                               .only_if = {"finish", "rough"}}},
               .choices = {{"finish", ChoiceKind::variant, {"smooth", "rough"}, "smooth"},
                           {"wall", ChoiceKind::mesh, {}, "the mesh with the largest upright faces"}},
               .reach = Reach::geometry,
               .acts_on = ActsOn::zone_sensors},
      .alter = alter,
      .draw = draw};
  return effect;
}

}  // namespace pirsim::effects
