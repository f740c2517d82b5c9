// What people may sit on in a model without marks.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "core/text.hpp"
#include "studies/suggested_parts.hpp"

namespace pirsim::studies {
namespace {

// All assumed, of furniture as it is sold.
constexpr double lowest_seat_m = 0.33, highest_seat_m = 0.62;  // of its surface (stools at counters aren't sat on)
constexpr double pelvis_above_m = 0.08;                        // above a surface that gives way a little (0.05-0.1)
constexpr double least_seat_side_m = 0.28, most_depth_m = 1.3, longest_sofa_m = 3.6;
constexpr double per_sitter_m = 0.6;   // along a sofa (0.55-0.7)
constexpr double back_above_m = 0.15;  // above the surface begins what is a back
constexpr std::array<std::string_view, 11> seat_words{"chair",  "stool", "sofa",   "couch",  "bench", "armchair",
                                                      "toilet", "stuhl", "sessel", "hocker", "silla"};
constexpr std::array<std::string_view, 4> bed_words{"bed", "bett", "cama", "mattress"};
constexpr std::array<std::string_view, 4> no_bed_words{"bedroom", "bedside", "bedding", "bedlamp"};

/// The level part of a thing that one can sit on: its height and middle.
struct Surface {
  double height_m = 0.0;  ///< above the floor
  Vec2 middle{0.0};
  double square_metres = 0.0;
};

/// Level triangles that look up or down, by height; the highest with a fair part of the largest is sat on.
std::optional<Surface> surface_of(const Thing& thing, double floor_m) {
  constexpr double bin_m = 0.02, least_part = 0.5, level = 0.8;
  std::map<long, Surface> by_height;
  for (const TriMesh* mesh : thing.meshes) {
    for (const auto& [a, b, c] : mesh->triangles) {
      const Vec3 &p = mesh->positions[a], &q = mesh->positions[b], &r = mesh->positions[c];
      const Vec3 area = 0.5 * glm::cross(q - p, r - p), middle = (p + q + r) / 3.0;
      const double above_m = middle.y - floor_m;
      if (std::abs(area.y) < level * glm::length(area) || above_m < lowest_seat_m || above_m > highest_seat_m) continue;
      Surface& surface = by_height[std::lround(above_m / bin_m)];
      surface.height_m += std::abs(area.y) * above_m;
      surface.middle += std::abs(area.y) * floor_point(middle);
      surface.square_metres += std::abs(area.y);
    }
  }
  double most = 0.0;
  for (const auto& [height, surface] : by_height) most = std::max(most, surface.square_metres);
  for (auto level_of = by_height.rbegin(); level_of != by_height.rend(); ++level_of) {
    Surface surface = level_of->second;
    if (surface.square_metres < std::max(0.03, least_part * most)) continue;
    surface.height_m /= surface.square_metres;
    surface.middle /= surface.square_metres;
    return surface;
  }
  return std::nullopt;
}

/// Away from what stands above the surface; none for a stool.
std::optional<Vec2> facing_of(const Thing& thing, const Surface& surface, double floor_m) {
  Vec2 sum(0.0);
  double whole = 0.0;
  for (const TriMesh* mesh : thing.meshes) {
    for (const auto& [a, b, c] : mesh->triangles) {
      const Vec3 &p = mesh->positions[a], &q = mesh->positions[b], &r = mesh->positions[c];
      const Vec3 middle = (p + q + r) / 3.0;
      const double area = 0.5 * glm::length(glm::cross(q - p, r - p));
      if (middle.y - floor_m < surface.height_m + back_above_m) continue;
      sum += area * (floor_point(middle) - floor_point(thing.extent.middle()));
      whole += area;
    }
  }
  const double aside_m = whole > 0.0 ? glm::length(sum) / whole : 0.0;
  constexpr double least_aside_m = 0.06;
  if (aside_m < least_aside_m) return std::nullopt;
  return -glm::normalize(sum);
}

/// Along the nearest of the thing's own sides, if these run along the axes, as most do.
Vec2 squared_up(const Vec2& direction) {
  constexpr double nearly = 0.92;  // cosine of 23 degrees
  for (const Vec2& axis : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)}) {
    if (glm::dot(axis, direction) > nearly) return axis;
  }
  return direction;
}

bool is_seat_sized(const Extent& extent, double floor_m) {
  const Vec3 size = extent.size();
  const double shorter = std::min(size.x, size.z), longer = std::max(size.x, size.z);
  return shorter >= least_seat_side_m && shorter <= most_depth_m && longer <= longest_sofa_m && size.y <= 1.6 &&
         std::abs(extent.least.y - floor_m) <= 0.3 && extent.most.y - floor_m >= lowest_seat_m;
}

/// By shape alone: as wide as deep, with a surface at a seat's height, and a back on one side.
bool is_chair_shaped(const Thing& thing, double floor_m) {
  const Vec3 size = thing.extent.size();
  const double top_m = thing.extent.most.y - floor_m;
  const bool is_sized = std::min(size.x, size.z) >= 0.35 && std::max(size.x, size.z) <= 0.8 && top_m >= 0.65 &&
                        top_m <= 1.25 && std::abs(thing.extent.least.y - floor_m) <= 0.06;
  if (!is_sized) return false;
  const std::optional<Surface> surface = surface_of(thing, floor_m);
  return surface && surface->square_metres >= 0.3 * size.x * size.z && facing_of(thing, *surface, floor_m);
}

class SeatFinder {
 public:
  SeatFinder(const io::ModelParts& model, const FloorPlan& plan) : model_(model), plan_(plan) {}

  std::vector<SuggestedSeat> run() {
    const double floor_m = plan_.height_m;
    const auto fits = [&](const Extent& extent) { return is_seat_sized(extent, floor_m); };
    for (const Thing& thing : things_named(model_, seat_words, fits)) add(thing, "by its name");
    std::map<int, Thing> nodes;
    for (const io::ModelPart& part : model_.parts) nodes[part.node].meshes.push_back(&part.mesh);
    for (auto& [node, thing] : nodes) {
      thing.node = node;
      thing.extent = extent_of(thing.meshes);
      if (!is_taken(thing) && is_chair_shaped(thing, floor_m)) add(thing, "by its shape alone");
    }
    return std::move(seats_);
  }

 private:
  [[nodiscard]] bool is_taken(const Thing& thing) const {
    return std::ranges::any_of(
        things_, [&](const Extent& known) { return glm::distance(known.middle(), thing.extent.middle()) < 0.4; });
  }

  void add(const Thing& thing, const std::string& why) {
    if (is_taken(thing) || plan_.room_at(floor_point(thing.extent.middle())) < 0) return;
    const std::optional<Surface> surface = surface_of(thing, plan_.height_m);
    if (!surface) return;
    things_.push_back(thing.extent);
    const std::optional<Vec2> back = facing_of(thing, *surface, plan_.height_m);
    const Vec2 facing = back ? squared_up(*back) : Vec2(0.0, -1.0);
    const Vec2 along(-facing.y, facing.x);
    const Vec3 size = thing.extent.size();
    const double length_m = std::abs(along.x) * size.x + std::abs(along.y) * size.z;
    const int sitters = std::max(1, static_cast<int>((length_m - 0.2) / per_sitter_m));
    for (int i = 0; i < sitters; ++i) {
      const double aside_m = per_sitter_m * (i - 0.5 * (sitters - 1));
      const Vec2 at = surface->middle + aside_m * along;
      SuggestedSeat seat;
      seat.id = "S" + std::to_string(seats_.size() + 1);
      seat.node = model_.nodes[static_cast<std::size_t>(thing.node)].name;
      seat.pelvis = {at.x, plan_.height_m + surface->height_m + pelvis_above_m, at.y};
      seat.facing = facing;
      seat.reason = why + (back ? "" : "; it has no back, so its direction is a guess");
      seats_.push_back(std::move(seat));
    }
  }

  const io::ModelParts& model_;
  const FloorPlan& plan_;
  std::vector<Extent> things_;  ///< seats so far
  std::vector<SuggestedSeat> seats_;
};

}  // namespace

std::vector<SuggestedSeat> seats_of(const io::ModelParts& model, const FloorPlan& plan) {
  return SeatFinder(model, plan).run();
}

std::vector<std::string> beds_of(const io::ModelParts& model, const FloorPlan& plan) {
  const auto fits = [&](const Extent& extent) {
    const Vec3 size = extent.size();
    return std::max(size.x, size.z) >= 1.6 && std::max(size.x, size.z) <= 2.8 && std::min(size.x, size.z) >= 0.6 &&
           std::abs(extent.least.y - plan.height_m) <= 0.3 && extent.most.y - plan.height_m <= 1.6;
  };
  std::vector<std::string> names;
  for (const Thing& thing : things_named(model, bed_words, fits)) {
    const std::string& name = model.nodes[static_cast<std::size_t>(thing.node)].name;
    if (!has_word(name, no_bed_words)) names.push_back(name);
  }
  return names;
}

}  // namespace pirsim::studies
