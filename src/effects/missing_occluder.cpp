// Something hides people that the plan leaves out.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

constexpr double behind_m = 0.17;  // assumed (0.15-0.25): a chair's back behind the middle of the pelvis
constexpr double thick_m = 0.03;   // assumed

/// A closed box; people walk through it, rays don't.
TriMesh screen(const std::string& name, const Frame& world_from_box, const Vec3& half_extents) {
  TriMesh mesh;
  mesh.name = name;
  mesh.solidity = Solidity::screen;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const Vec3 sign((corner & 1U) != 0 ? 1 : -1, (corner & 2U) != 0 ? 1 : -1, (corner & 4U) != 0 ? 1 : -1);
    mesh.positions.push_back(world_from_box * (sign * half_extents));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

bool is_box(const EffectSpec& effect) { return word(effect, "what") == "box"; }

void alter(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const double half_height = 0.5 * effect.parameters.at(is_box(effect) ? "box_height_m" : "height_m");
  const double half_width = 0.5 * effect.parameters.at("width_m");
  if (is_box(effect)) {
    const Frame middle{Quat(1, 0, 0, 0), Vec3(effect.parameters.at("x_m"), scene.floor.height_m() + half_height,
                                              effect.parameters.at("z_m"))};
    scene.meshes.push_back(screen("missing box", middle, {half_width, half_height, half_width}));
    return;
  }
  for (const SeatSpec& seat : scene.seats) {
    const Frame middle = seat.world_from_seat * Frame{Quat(1, 0, 0, 0), Vec3(0, half_height, behind_m)};
    scene.meshes.push_back(screen("back of " + seat.id, middle, {half_width, half_height, 0.5 * thick_m}));
  }
}

void draw(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  const double clear_m = 0.5 * effect.parameters.at("width_m");
  if (!is_box(effect) || !draw_free_place(effect, scene, clear_m, stream)) effect.choices["what"] = "chair_backs";
}

void settle(EffectSpec& effect, const SceneSpec& scene) {
  if (is_box(effect)) settle_free_place(effect, scene, 0.5 * effect.parameters.at("width_m"));
}

}  // namespace

const Effect& missing_occluder() {
  static const Effect effect{
      .info = {.name = "missing_occluder",
               .family = Family::occlusion,
               .stage = "placement",
               .summary = "Chair backs at all seats, or a box somewhere, hide people; nobody has to walk round them.",
               .fingerprint = "some pairs of seat and sensor fall silent, the others stay as they are",
               .confused_with = {"thermal_contrast", "range_scale"},
               .parameters = {{.name = "height_m",
                               .unit = "m",
                               .off = 0.0,
                               .typical = 0.45,
                               .low = 0.2,
                               .high = 0.7,
                               .least = 0.0,
                               .most = 5.0,
                               .source = "assumed: of a chair's back above the seat",
                               .only_if = {"what", "chair_backs"}},
                              {.name = "box_height_m",
                               .unit = "m",
                               .off = 0.0,
                               .typical = 1.5,
                               .low = 1.0,
                               .high = 2.0,
                               .least = 0.0,
                               .most = 5.0,
                               .source =
                                   "assumed: above the floor; a plant, a screen on a stand, a pillar's lower part",
                               .only_if = {"what", "box"}},
                              {.name = "width_m",
                               .unit = "m",
                               .role = Role::detail,
                               .off = 0.45,
                               .typical = 0.45,
                               .low = 0.35,
                               .high = 0.6,
                               .least = 0.01,
                               .most = 20.0,
                               .source = "assumed: a box is as deep as wide"},
                              floor_coordinate("x_m", {"what", "box"}),
                              floor_coordinate("z_m", {"what", "box"})},
               .choices = {{"what", ChoiceKind::word, {"chair_backs", "box"}, "chair backs"}},
               .reach = Reach::geometry},
      .alter = alter,
      .draw = draw,
      .settle = settle};
  return effect;
}

}  // namespace pirsim::effects
