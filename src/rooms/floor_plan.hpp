// The plan of a parametric room: walls, what stands on the floor, and what must stay free; and the boxes
// that things are made of. All sides along the axes.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "pirsim/io.hpp"
#include "pirsim/random.hpp"
#include "pirsim/room.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::dataset {

/// Something put down on the floor, turned by a whole number of quarters to the left. Its own axes are those of what
/// faces -Z: x to its right.
struct Spot {
  Vec2 origin{0.0};
  int quarters = 0;
  [[nodiscard]] Vec2 operator*(const Vec2& own) const;
  [[nodiscard]] Rectangle operator*(const Rectangle& own) const;
  [[nodiscard]] Frame frame(double height_m) const;
};

/// A straight wall, seen from inside the room.
struct Wall {
  enum class Kind { outer, of_missing_corner };
  Vec2 from{0.0}, to{0.0};  ///< counter-clockwise round the room seen from above
  Kind kind = Kind::outer;
  /// Whether the room's corner at that end is an outer one, where sensors hang and walls meet outside.
  bool convex_at_from = true, convex_at_to = true;
  [[nodiscard]] double length_m() const;
  [[nodiscard]] Vec2 along() const;   ///< unit
  [[nodiscard]] Vec2 inward() const;  ///< unit
  [[nodiscard]] Vec2 at(double along_m, double inward_m = 0.0) const {
    return from + along_m * along() + inward_m * inward();
  }
  /// What stands with its back to the wall and faces the room there: its origin is on the wall.
  [[nodiscard]] Spot facing_room(double along_m) const;
  [[nodiscard]] Spot facing_wall(double along_m, double inward_m) const;
};

class FloorPlan {
 public:
  FloorPlan(double width_m, double depth_m, std::optional<Rectangle> missing_corner);
  explicit FloorPlan(const Rectangle& bounds);

  [[nodiscard]] const std::vector<Vec2>& outline() const noexcept { return outline_; }
  [[nodiscard]] const std::vector<Wall>& walls() const noexcept { return walls_; }
  [[nodiscard]] bool contains(const Rectangle& rectangle) const noexcept;
  [[nodiscard]] bool is_free(const Rectangle& rectangle) const noexcept;
  void occupy(const Rectangle& rectangle) { occupied_.push_back(rectangle); }
  [[nodiscard]] const Rectangle& bounds() const noexcept { return bounds_; }

 private:
  void build_walls();

  Rectangle bounds_;
  std::optional<Rectangle> missing_;
  std::vector<Vec2> outline_;
  std::vector<Wall> walls_;
  std::vector<Rectangle> occupied_;
};

[[nodiscard]] bool overlap(const Rectangle& a, const Rectangle& b) noexcept;

[[nodiscard]] double draw(const Range& range, Stream& stream);
[[nodiscard]] int draw(const CountRange& range, Stream& stream);
/// Whole centimetres.
[[nodiscard]] double draw_length(const Range& range, Stream& stream);
template <typename Item>
[[nodiscard]] const Item& one_of(const std::vector<Item>& items, Stream& stream) {
  return items[stream.index(static_cast<std::uint32_t>(items.size()))];
}

/// In the axes of what it belongs to.
struct BoxPart {
  Rectangle footprint;
  double from_y_m = 0.0, to_y_m = 0.0;
};

/// One mesh of closed boxes, in world axes, in coordinates that single precision holds exactly.
[[nodiscard]] TriMesh boxes(const std::string& name, const Spot& spot, std::span<const BoxPart> parts);
/// The outline, facing up.
[[nodiscard]] TriMesh floor_mesh(const std::vector<Rectangle>& pieces);

// Drawing until something usable comes out: what rooms and flats have in common.

/// Why an attempt failed, in words that fit behind "n times".
struct NoPlace {
  std::string reason;
  Where where{};  ///< of a plan: what has no place
};
/// Where seats and places of a scene come from, by their ids.
using Origins = std::map<std::string, Where>;

/// What a scene must allow besides: its seats, places and entrances are reached, and its sensors see somebody.
struct Demands {
  std::vector<std::string> shared_beds{};  ///< places to lie that must be got onto from their own side
  std::size_t least_places = 0;            ///< of a grid of 0.25 m, where each sensor must see who stands there
};

/// What the largest person can't reach from the entrances, as who looked for a way says it, at its origin; or nothing.
[[nodiscard]] std::optional<Issue> unreached(const SceneSpec& scene, const Origins& origins);
/// Why nobody could use what was drawn, or nothing: what the largest person can't reach from the entrances, a sensor
/// that sees nobody.
[[nodiscard]] std::string fault_of(const SceneSpec& scene, const Demands& demands = {});

/// Finds each model once, however many attempts there are. Throws Error(input) where it was named.
class ModelFinder {
 public:
  struct Named {
    std::vector<std::string> models;
    Where where;
  };
  ModelFinder(std::vector<Named> named, Where otherwise, const io::SceneOptions& options)
      : named_(std::move(named)), otherwise_(std::move(otherwise)), options_(options) {}
  /// Of all sensors of the scene.
  void add_to(SceneSpec& scene);

 private:
  std::vector<Named> named_;
  Where otherwise_;
  const io::SceneOptions& options_;
  std::map<std::string, SensorModelSpec> known_;
};

/// Why attempts failed, and how often.
class Failures {
 public:
  void add(const std::string& reason) { ++reasons_[reason]; }
  /// "room 3: none of 300 rooms drawn ..."; what: "room".
  [[noreturn]] void give_up(const std::string& what, int number, const Where& where) const;

 private:
  std::map<std::string, int> reasons_;
};

// One attempt at a parametric room: everything is drawn and put where there is space for it, or the attempt fails.

/// Which models a sensor of the group may be: its own, or the usual one for where it hangs.
[[nodiscard]] const std::vector<std::string>& models_of(const SensorGroupSpec& group);
enum class Fit { usual, tight };  ///< tight: meeting tables with as little room as will do
/// A room that isn't checked yet. Sensors have their models' names, but not the models.
[[nodiscard]] std::variant<DrawnRoom, NoPlace> furnish(const RoomSpec& spec, Fit fit, Stream& stream);

}  // namespace pirsim::dataset
