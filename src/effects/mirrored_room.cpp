// The plan was read from its back.
#include <algorithm>

#include "effects/kit.hpp"
#include "pirsim/geometry.hpp"
#include "schema/action_facts.hpp"

namespace pirsim::effects {
namespace {

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

void alter(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const auto across = effect.choices.find("across");
  const Mirror mirror(scene, across != effect.choices.end() && across->second == "z" ? Across::z : Across::x);
  mirror_meshes(scene.meshes, mirror);
  for (SeatSpec& seat : scene.seats) seat.world_from_seat = mirror.frame(seat.world_from_seat);
  for (EntranceSpec& door : scene.entrances) door.world_from_entrance = mirror.frame(door.world_from_entrance);
  scene.floor = mirrored(scene.floor, mirror);
  for (TrialInForce& trial : study.trials) {
    for (PersonInForce& person : trial.people) mirror_actions(person.actions, mirror);
  }
}

}  // namespace

const Effect& mirrored_room() {
  static const Effect effect{
      .info = {.name = "mirrored_room",
               .family = Family::data,
               .stage = "books",
               .summary =
                   "The room was drawn mirrored, seats, doors and furniture; the sensors hang where they are drawn.",
               .fingerprint = "seats have changed places with those on the other side",
               .confused_with = {"seats_shifted", "labels_swapped"},
               .parameters = {whether("mirrored", "assumed")},
               .choices = {{"across", ChoiceKind::word, {"x", "z"}, "x runs backwards, about the middle of the floor"}},
               .reach = Reach::geometry},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
