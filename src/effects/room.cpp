// What the plan of a room has wrong, or leaves out.
// Assumed: sensors hang where they are drawn; what is missing hides people, but nobody walks round it.
// Method: seats, meshes and actions of the study in force are edited before it is compiled.
// Sources: no measurement; sizes of furniture, each with its parameter.
#include <algorithm>

#include "effects/kit.hpp"
#include "pirsim/geometry.hpp"
#include "schema/action_facts.hpp"

namespace pirsim::effects {
namespace {

// seats_shifted: the plan's seat numbers are off by one.

/// Who is said to sit on a seat sits on the one so many further in the scene's order, round its end.
void alter_seats_shifted(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const auto n = static_cast<std::int64_t>(scene.seats.size());
  const std::vector<SeatSpec> drawn = scene.seats;
  const std::int64_t places = std::llround(effect.parameters.at("places"));
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int64_t from = ((i + places) % n + n) % n;
    scene.seats[static_cast<std::size_t>(i)].world_from_seat = drawn[static_cast<std::size_t>(from)].world_from_seat;
  }
}

void draw_seats_shifted(EffectSpec& effect, const SceneSpec&, const ScriptSpec&, Stream& stream) {
  if (stream.index(2) == 1) effect.parameters["places"] *= -1.0;
}

Effect seats_shifted() {
  return {.info = {.name = "seats_shifted",
                   .family = Family::data,
                   .stage = "books",
                   .summary = "Seat names are shifted: each names the seat so many places further.",
                   .fingerprint = "rows of the table of sums are permuted",
                   .as_if = "trials were noted under the names of other seats",
                   .confused_with = {"mirrored_room"},
                   .parameters = {{.name = "places",
                                   .unit = "",
                                   .off = 0.0,
                                   .typical = 1.0,
                                   .low = 1.0,
                                   .high = 1.0,
                                   .least = -1000.0,
                                   .most = 1000.0,
                                   .scale = Scale::whole,
                                   .source = "assumed: one, either way"}},
                   .reach = Reach::geometry,
                   .idle_in = {Survey::coverage}},
          .alter = alter_seats_shifted,
          .draw = draw_seats_shifted};
}

// mirrored_room: the plan was read from its back.

enum class Across { x, z };

/// Reflection in the vertical plane through the middle of the floor.
class Mirror {
 public:
  Mirror(const SceneSpec& scene, Across across)
      : axis_(across == Across::z ? 2 : 0),
        twice_middle_(across == Across::z ? scene.floor.lower().y + scene.floor.upper().y
                                          : scene.floor.lower().x + scene.floor.upper().x) {}

  [[nodiscard]] Vec3 point(Vec3 p) const {
    p[axis_] = twice_middle_ - p[axis_];
    return p;
  }
  [[nodiscard]] Vec2 point(const Vec2& p) const { return floor_point(point(Vec3(p.x, 0, p.y))); }
  /// The frame at the mirrored place that faces the mirrored way; right stays right, since frames can't be mirrored.
  [[nodiscard]] Frame frame(const Frame& frame) const {
    return {rotation_from_heading(heading(heading_of(frame))), point(frame.origin)};
  }
  [[nodiscard]] double heading(double heading) const { return axis_ == 2 ? pi - heading : -heading; }
  [[nodiscard]] double heading_deg(double heading_deg) const {
    return std::remainder(degrees(heading(radians(heading_deg))), 360.0);
  }

 private:
  int axis_;
  double twice_middle_;
};

FloorArea mirrored(const FloorArea& floor, const Mirror& mirror) {
  std::vector<std::vector<Vec2>> loops = floor.loops();
  for (auto& loop : loops) {
    for (Vec2& p : loop) p = mirror.point(p);
    std::ranges::reverse(loop);
  }
  return {loops, floor.height_m()};
}

void mirror_meshes(std::vector<TriMesh>& meshes, const Mirror& mirror) {
  for (TriMesh& mesh : meshes) {
    for (Vec3& p : mesh.positions) p = mirror.point(p);
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
}

void mirror_actions(std::vector<ScriptedAction>& actions, const Mirror& mirror) {
  for (ScriptedAction& action : actions) {
    for_each_place(
        action.what, [&](Vec2& point) { point = mirror.point(point); },
        [&](double& heading_deg) { heading_deg = mirror.heading_deg(heading_deg); });
  }
}

void alter_mirrored_room(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const auto across = effect.choices.find("across");
  const Mirror mirror(scene, across != effect.choices.end() && across->second == "z" ? Across::z : Across::x);
  mirror_meshes(scene.meshes, mirror);
  for (SeatSpec& seat : scene.seats) seat.world_from_seat = mirror.frame(seat.world_from_seat);
  for (PlaceSpec& place : scene.places) place.world_from_place = mirror.frame(place.world_from_place);
  for (EntranceSpec& door : scene.entrances) door.world_from_entrance = mirror.frame(door.world_from_entrance);
  for (DoorSpec& door : scene.doors) {
    door.world_from_door = mirror.frame(door.world_from_door);
    door.hinge = door.hinge == DoorHinge::left ? DoorHinge::right : DoorHinge::left;
  }
  scene.floor = mirrored(scene.floor, mirror);
  for (AreaSpec& area : scene.areas) area.outline = mirrored(area.outline, mirror);
  for (TrialInForce& trial : study.trials) {
    for (PersonInForce& person : trial.people) mirror_actions(person.actions, mirror);
  }
}

Effect mirrored_room() {
  return {
      .info = {.name = "mirrored_room",
               .family = Family::data,
               .stage = "books",
               .summary =
                   "The room was drawn mirrored, seats, doors and furniture; the sensors hang where they are drawn.",
               .fingerprint = "seats have changed places with those on the other side",
               .as_if = "left and right of the room were mixed up",
               .confused_with = {"seats_shifted", "labels_swapped"},
               .parameters = {whether("mirrored", "assumed")},
               .choices = {{"across", ChoiceKind::word, {"x", "z"}, "x runs backwards, about the middle of the floor"}},
               .reach = Reach::geometry},
      .alter = alter_mirrored_room};
}

// missing_occluder: something hides people that the plan leaves out.

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

void alter_missing_occluder(StudyInForce& study, const EffectSpec& effect) {
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

void draw_missing_occluder(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  const double clear_m = 0.5 * effect.parameters.at("width_m");
  if (!is_box(effect) || !draw_free_place(effect, scene, clear_m, stream)) effect.choices["what"] = "chair_backs";
}

void settle_missing_occluder(EffectSpec& effect, const SceneSpec& scene) {
  if (is_box(effect)) settle_free_place(effect, scene, 0.5 * effect.parameters.at("width_m"));
}

Effect missing_occluder() {
  return {
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
      .alter = alter_missing_occluder,
      .draw = draw_missing_occluder,
      .settle = settle_missing_occluder};
}

}  // namespace

std::vector<Effect> room_effects() { return {seats_shifted(), mirrored_room(), missing_occluder()}; }

}  // namespace pirsim::effects
