#include "rooms/suggested_marks.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/body/ground.hpp"
#include "files/read/marks_file.hpp"
#include "files/read/scene_parts.hpp"
#include "model/core/text.hpp"
#include "rooms/suggested_floor.hpp"

// The parts that a suggestion is made of. Private to studies.

namespace pirsim::studies {

struct Extent {
  Vec3 least{0.0}, most{0.0};
  [[nodiscard]] Vec3 size() const { return most - least; }
  [[nodiscard]] Vec3 middle() const { return 0.5 * (least + most); }
};
[[nodiscard]] Extent extent_of(std::span<const TriMesh* const> meshes);

/// From sizes alone: metres and +Y up, as glTF says, unless these make no building and others do.
[[nodiscard]] SuggestedFrame frame_of(const io::ModelParts& model);
/// Turns, scales and moves the model; a frame without an origin gets one, if the model is far from its own.
void to_room(io::ModelParts& model, SuggestedFrame& frame);

/// Nodes of the ground that the rooms stand on, of a sky around them, and the like: much larger than all the rest. By
/// sizes alone, so that a room around a few things may be among them.
[[nodiscard]] std::vector<int> surroundings_of(const io::ModelParts& model);
void leave_out(io::ModelParts& model, const std::vector<int>& nodes);
/// Leaves out what patterns of a marks file name, with all below. Throws Error(usage) for one that names nothing.
void ignore(io::ModelParts& model, const std::vector<std::string>& patterns);

/// A node with all parts below it.
struct Thing {
  int node = 0;
  std::vector<const TriMesh*> meshes;
  Extent extent;
};
/// Whether a name has one of the words in it, in any case: "chair" in "Chair.001".
[[nodiscard]] bool has_word(std::string_view name, std::span<const std::string_view> words);
/// Nodes with a word in their name, the topmost of each branch whose size `fits`.
[[nodiscard]] std::vector<Thing> things_named(const io::ModelParts& model, std::span<const std::string_view> words,
                                              const std::function<bool(const Extent&)>& fits);

/// Chairs, sofas, stools and toilets on the floor, by names and by shapes. Beds aren't among them: they go to `beds`.
[[nodiscard]] std::vector<SuggestedSeat> seats_of(const io::ModelParts& model, const FloorPlan& plan);
[[nodiscard]] std::vector<std::string> beds_of(const io::ModelParts& model, const FloorPlan& plan);

// Unit and upward axis of a model, and its named things.

namespace {

struct Unit {
  const char* word;
  double metres;
};
constexpr std::array units{Unit{"m", 1.0}, Unit{"ft", 0.3048}, Unit{"in", 0.0254}, Unit{"cm", 0.01}, Unit{"mm", 0.001}};

// All assumed: what may be a building, and what is a storey.
constexpr double building_lowest_m = 1.7, building_highest_m = 40.0, building_shortest_m = 2.0,
                 building_longest_m = 150.0;  // tried 1.5-2, 30-50, 1-3, 100-300
constexpr double highest_storey_m = 4.5;      // tried 4-6
constexpr double usual_height_m = 2.8, usual_length_m = 10.0;

struct Sizes {
  double height, longest;
};
Sizes along(const Vec3& size, char up) {
  if (up == 'x') return {size.x, std::max(size.y, size.z)};
  return up == 'y' ? Sizes{size.y, std::max(size.x, size.z)} : Sizes{size.z, std::max(size.x, size.y)};
}
bool is_building(const Sizes& sizes, double metres) {
  const double height_m = metres * sizes.height, length_m = metres * sizes.longest;
  return height_m >= building_lowest_m && height_m <= building_highest_m && length_m >= building_shortest_m &&
         length_m <= building_longest_m;
}
/// How many times too large or too small, as a logarithm.
double oddity(const Sizes& sizes, double metres) {
  return std::abs(std::log(metres * sizes.height / usual_height_m)) +
         std::abs(std::log(metres * sizes.longest / usual_length_m));
}

const Unit* unit_for(const Sizes& sizes) {
  if (is_building(sizes, 1.0)) return &units.front();
  const Unit* best = nullptr;
  for (const Unit& unit : units) {
    if (!is_building(sizes, unit.metres)) continue;
    if (best == nullptr || oddity(sizes, unit.metres) < oddity(sizes, best->metres)) best = &unit;
  }
  return best;
}

/// A model that lies on its back is as high as a room along another axis.
bool is_storey(const Vec3& size, char up, double metres) {
  const auto [height, longest] = along(size, up);
  return metres * height >= building_lowest_m && metres * height <= highest_storey_m && longest >= 1.5 * height;
}

/// How many meshes begin at one height: what stands on a floor.
std::size_t most_standing(const std::vector<const TriMesh*>& meshes, const Vec3& size, char up) {
  const int axis = up - 'x';
  const double bin = std::max(0.01 * size[axis], 1e-9);
  std::map<long, std::size_t> by_height;
  std::size_t most = 0;
  for (const TriMesh* mesh : meshes)
    most = std::max(most, ++by_height[std::lround(extent_of({&mesh, 1}).least[axis] / bin)]);
  return most;
}

}  // namespace

Extent extent_of(std::span<const TriMesh* const> meshes) {
  Extent extent{Vec3(std::numeric_limits<double>::max()), Vec3(std::numeric_limits<double>::lowest())};
  for (const TriMesh* mesh : meshes) {
    for (const Vec3& p : mesh->positions)
      extent.least = glm::min(extent.least, p), extent.most = glm::max(extent.most, p);
  }
  return extent;
}

SuggestedFrame frame_of(const io::ModelParts& model) {
  std::vector<const TriMesh*> meshes;
  for (const io::ModelPart& part : model.parts) meshes.push_back(&part.mesh);
  const Vec3 size = extent_of(meshes).size();
  for (const char up : {'y', 'z', 'x'}) {
    const Unit* unit = unit_for(along(size, up));
    if (unit == nullptr || !is_storey(size, up, unit->metres)) continue;
    const std::size_t standing = most_standing(meshes, size, up), as_given = most_standing(meshes, size, 'y');
    const bool is_much_too_high = along(size, 'y').height * unit->metres > 1.5 * highest_storey_m;
    if (up == 'y' || standing > as_given || (standing == as_given && is_much_too_high))
      return {unit->word, unit->metres, up};
  }
  if (const Unit* unit = unit_for(along(size, 'y'))) return {unit->word, unit->metres, 'y'};
  return {"", usual_height_m / size.y, 'y'};
}

void to_room(io::ModelParts& model, SuggestedFrame& frame) {
  constexpr double far_m = 1000.0;  // assumed (300-10,000): coordinates of a map, not of a building
  Vec3 least(std::numeric_limits<double>::max());
  for (io::ModelPart& part : model.parts) {
    for (Vec3& p : part.mesh.positions) {
      if (frame.up == 'x') p = Vec3(-p.y, p.x, p.z);
      if (frame.up == 'z') p = Vec3(p.x, p.z, -p.y);
      p *= frame.metres;
      least = glm::min(least, p);
    }
  }
  if (glm::length(least) < far_m) return;
  frame.origin_m = glm::round(least);
  for (io::ModelPart& part : model.parts)
    for (Vec3& p : part.mesh.positions) p -= frame.origin_m;
}

bool has_word(std::string_view name, std::span<const std::string_view> words) {
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::ranges::any_of(words, [&](std::string_view word) { return lower.find(word) != std::string::npos; });
}

std::vector<Thing> things_named(const io::ModelParts& model, std::span<const std::string_view> words,
                                const std::function<bool(const Extent&)>& fits) {
  std::vector<Thing> named(model.nodes.size());
  for (const io::ModelPart& part : model.parts) {
    for (int node = part.node; node >= 0; node = model.nodes[static_cast<std::size_t>(node)].parent) {
      if (has_word(model.nodes[static_cast<std::size_t>(node)].name, words))
        named[static_cast<std::size_t>(node)].meshes.push_back(&part.mesh);
    }
  }
  std::vector<Thing> things;
  std::set<int> taken;  // nodes, and with them all below
  for (std::size_t i = 0; i < named.size(); ++i) {
    const int node = static_cast<int>(i), parent = model.nodes[i].parent;
    if (taken.contains(parent)) {
      taken.insert(node);
      continue;
    }
    if (named[i].meshes.empty()) continue;
    named[i].extent = extent_of(named[i].meshes);
    if (!fits(named[i].extent)) continue;
    named[i].node = node;
    taken.insert(node);
    things.push_back(std::move(named[i]));
  }
  return things;
}

// What people may sit on in a model without marks.

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

/// What of a triangle lies between two heights: its area as a vector, and the middle of that area.
struct Patch {
  Vec3 area{0.0}, middle{0.0};
};
/// Calls visit(patch) for the parts of a thing's triangles between two heights. Sums over them don't depend on how its
/// surfaces are cut into triangles.
void each_patch(const Thing& thing, double from_y, double to_y, const auto& visit) {
  for (const TriMesh* mesh : thing.meshes) {
    for (const auto& [a, b, c] : mesh->triangles) {
      std::vector<Vec3> part{mesh->positions[a], mesh->positions[b], mesh->positions[c]};
      part = body::clipped(body::clipped(part, from_y, 1.0), to_y, -1.0);
      for (std::size_t i = 2; i < part.size(); ++i) {
        const Vec3 &p = part[0], &q = part[i - 1], &r = part[i];
        visit(Patch{0.5 * glm::cross(q - p, r - p), (p + q + r) / 3.0});
      }
    }
  }
}

/// Level parts that look up or down, by height; the highest with a fair part of the largest is sat on.
std::optional<Surface> surface_of(const Thing& thing, double floor_m) {
  constexpr double bin_m = 0.02, least_part = 0.5, level = 0.8;
  std::map<long, Surface> by_height;
  for (long bin = std::lround(lowest_seat_m / bin_m); bin <= std::lround(highest_seat_m / bin_m); ++bin) {
    const double middle_m = static_cast<double>(bin) * bin_m;
    each_patch(thing, floor_m + middle_m - 0.5 * bin_m, floor_m + middle_m + 0.5 * bin_m, [&](const Patch& patch) {
      const double above_m = patch.middle.y - floor_m, square_metres = std::abs(patch.area.y);
      if (square_metres < level * glm::length(patch.area) || above_m < lowest_seat_m || above_m > highest_seat_m)
        return;
      Surface& surface = by_height[bin];
      surface.height_m += square_metres * above_m;
      surface.middle += square_metres * floor_point(patch.middle);
      surface.square_metres += square_metres;
    });
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
  each_patch(thing, floor_m + surface.height_m + back_above_m, thing.extent.most.y, [&](const Patch& patch) {
    const double square_metres = glm::length(patch.area);
    sum += square_metres * (floor_point(patch.middle) - floor_point(thing.extent.middle()));
    whole += square_metres;
  });
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

// What lies around the rooms of a model: the ground that it stands on, a sky.

namespace {

/// Of a node's own mesh.
struct Body {
  int node = 0;
  Extent extent;
  [[nodiscard]] double longest() const {
    const Vec3 size = extent.size();
    return std::max({size.x, size.y, size.z});
  }
};

void widen(Extent& extent, const Extent& by) {
  extent.least = glm::min(extent.least, by.least), extent.most = glm::max(extent.most, by.most);
}

/// A sheet that is much larger than all the rest along two axes, or a shell along all three, of which a dome may end
/// above the lowest of the rest. No unit and no axis is known yet.
bool lies_around(const Body& body, const Extent& rest) {
  constexpr double times = 1.5, thin = 0.1;  // assumed (1.3-1.8; 0.05-0.2, of its length: hilly ground)
  constexpr double short_of = 0.05;          // assumed (0.02-0.1, of its length)
  const double slack = short_of * body.longest();
  const Vec3 size = body.extent.size(), rest_size = rest.size();
  int n_around = 0;
  bool is_thin = false;
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_around = size[axis] >= times * rest_size[axis] &&
                           body.extent.least[axis] <= rest.least[axis] + slack &&
                           body.extent.most[axis] >= rest.most[axis] - slack;
    n_around += is_around ? 1 : 0;
    is_thin = is_thin || (!is_around && size[axis] <= thin * body.longest());
  }
  return n_around == 3 || (n_around == 2 && is_thin);
}

}  // namespace

std::vector<int> surroundings_of(const io::ModelParts& model) {
  std::map<int, std::vector<const TriMesh*>> meshes;
  for (const io::ModelPart& part : model.parts) meshes[part.node].push_back(&part.mesh);
  std::vector<Body> bodies;
  for (const auto& [node, own] : meshes) bodies.push_back({node, extent_of(own)});
  std::ranges::stable_sort(bodies, std::greater{}, &Body::longest);
  // Of all from the k-th on
  std::vector<Extent> rests(bodies.size());
  for (std::size_t k = bodies.size(); k-- > 0;) {
    rests[k] = bodies[k].extent;
    if (k + 1 < bodies.size()) widen(rests[k], rests[k + 1]);
  }
  constexpr std::size_t most = 10;  // assumed: ground, sky, sun, water
  std::vector<int> nodes;
  for (std::size_t n = 1; n <= most && n < bodies.size(); ++n) {
    if (!std::ranges::all_of(bodies.begin(), bodies.begin() + static_cast<std::ptrdiff_t>(n),
                             [&](const Body& body) { return lies_around(body, rests[n]); }))
      continue;
    nodes.clear();
    for (std::size_t k = 0; k < n; ++k) nodes.push_back(bodies[k].node);
  }
  return nodes;
}

void leave_out(io::ModelParts& model, const std::vector<int>& nodes) {
  std::erase_if(model.parts, [&](const io::ModelPart& part) { return std::ranges::count(nodes, part.node) > 0; });
}

void ignore(io::ModelParts& model, const std::vector<std::string>& patterns) {
  std::vector<int> nodes;
  for (const std::string& text : patterns) {
    const io::detail::NodePattern pattern{text, {}};
    bool is_found = false;
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
      const bool matches = pattern.matches(model.nodes[i].name);
      is_found = is_found || matches;
      if (matches || std::ranges::count(nodes, model.nodes[i].parent) > 0) nodes.push_back(static_cast<int>(i));
    }
    if (is_found) continue;
    std::vector<std::string> names;
    for (const io::ModelNode& node : model.nodes) names.push_back(node.name);
    throw Error(ErrorCode::usage, "--ignore: no node of the scene is called '" + text + "'" + near_or_all(text, names));
  }
  leave_out(model, nodes);
}

namespace {

constexpr std::array<std::string_view, 6> door_words{"door", "tür", "tuer", "puerta", "deur", "porte"};
constexpr std::array<std::string_view, 9> no_door_words{"wall",     "wand",     "indoor", "outdoor", "cabinet",
                                                        "cupboard", "wardrobe", "fridge", "closet"};
constexpr std::array<std::string_view, 2> space_words{"ifcspace", "ifc_space"};
constexpr std::array<std::string_view, 14> room_words{"bedroom",      "kitchen", "bathroom", "living",     "hallway",
                                                      "corridor",     "office",  "dining",   "wohnzimmer", "küche",
                                                      "schlafzimmer", "flur",    "foyer",    "toilet"};

/// Leaves and frames of doors that stand in openings; assumed sizes.
bool is_door_sized(const Extent& extent) {
  const Vec3 size = extent.size();
  const double wide = std::max(size.x, size.z);
  return size.y >= 1.6 && size.y <= 3.2 && wide >= 0.5 && wide <= 2.6;
}

bool is_door_shaped(const Extent& extent) {
  const Vec3 size = extent.size();
  const double wide = std::max(size.x, size.z), thick = std::min(size.x, size.z);
  return size.y >= 1.85 && size.y <= 2.4 && wide >= 0.55 && wide <= 2.0 && thick <= 0.25;
}

/// Of nodes' names, each once.
std::vector<std::string> names_of(const io::ModelParts& model, const std::vector<Thing>& things) {
  std::set<std::string> names;
  for (const Thing& thing : things) names.insert(model.nodes[static_cast<std::size_t>(thing.node)].name);
  return {names.begin(), names.end()};
}

/// What isn't below one of the things.
std::vector<const TriMesh*> meshes_without(const io::ModelParts& model, const std::vector<Thing>& things) {
  std::set<const TriMesh*> left_out;
  for (const Thing& thing : things) left_out.insert(thing.meshes.begin(), thing.meshes.end());
  std::vector<const TriMesh*> meshes;
  for (const io::ModelPart& part : model.parts) {
    if (!left_out.contains(&part.mesh)) meshes.push_back(&part.mesh);
  }
  return meshes;
}

Leaf leaf_of(const Thing& thing) {
  const Vec3 size = thing.extent.size();
  const bool is_along_x = size.x >= size.z;
  return {floor_point(thing.extent.middle()), is_along_x ? Vec2(0, 1) : Vec2(1, 0), std::max(size.x, size.z),
          std::min(size.x, size.z)};
}

/// Doors by their names, or by their shape alone: thin, as high as one, and standing on a floor.
std::vector<Thing> doors_of(const io::ModelParts& model) {
  std::vector<Thing> doors = things_named(model, door_words, is_door_sized);
  constexpr std::array<std::string_view, 1> any{""};
  std::set<const TriMesh*> known;
  for (const Thing& door : doors) known.insert(door.meshes.begin(), door.meshes.end());
  for (Thing& thing : things_named(model, any, is_door_shaped)) {
    if (!known.contains(thing.meshes.front())) doors.push_back(std::move(thing));
  }
  std::erase_if(doors, [&](const Thing& door) {
    return has_word(model.nodes[static_cast<std::size_t>(door.node)].name, no_door_words);
  });
  return doors;
}

/// The lowest height with at least half as much room as the best, under a ceiling if there are any, inside of walls if
/// anything is.
struct ChosenFloor {
  double height_m = 0.0;
  std::vector<double> others_m;
};
std::optional<ChosenFloor> choose_floor(std::span<const TriMesh* const> meshes, std::span<const Leaf> leaves) {
  constexpr double coarse_m = 0.1, least_m2 = 2.0, least_part = 0.5;
  std::vector<FloorPlan> floors;
  for (const double height_m : level_heights_m(meshes)) {
    FloorPlan plan = floor_plan_at(meshes, leaves, height_m, coarse_m);
    if (plan.standing_m2 >= least_m2) floors.push_back(std::move(plan));
  }
  if (std::ranges::any_of(floors, [](const FloorPlan& plan) { return !plan.is_bare; }))
    std::erase_if(floors, [](const FloorPlan& plan) { return plan.is_bare; });
  double most = 0.0, most_covered = 0.0;
  for (const FloorPlan& plan : floors)
    most = std::max(most, plan.standing_m2), most_covered = std::max(most_covered, plan.covered_m2);
  const bool has_ceilings = most_covered >= least_part * most;  // then what has none is a roof, or a garden
  ChosenFloor chosen;
  bool is_chosen = false;
  for (const FloorPlan& plan : floors) {
    if (has_ceilings ? plan.covered_m2 < least_part * most_covered : plan.standing_m2 < least_part * most) continue;
    (is_chosen ? chosen.others_m.emplace_back() : chosen.height_m) = plan.height_m;
    is_chosen = true;
  }
  if (!is_chosen) return std::nullopt;
  return chosen;
}

/// A model in its frame, with its floor if one was found.
struct Found {
  io::ModelParts model;
  SuggestedFrame frame;
  std::vector<Thing> doors, spaces;
  std::optional<ChosenFloor> floor;
  FloorPlan plan{};
  bool is_between_walls = false;  ///< no surface is one: the floor is what walls enclose
};

/// Walls and furniture that stand on the floor.
std::size_t n_standing(const Found& found) {
  constexpr double near_m = 0.05, least_height_m = 0.3;
  return static_cast<std::size_t>(std::ranges::count_if(found.model.parts, [&](const io::ModelPart& part) {
    const TriMesh* mesh = &part.mesh;
    const Extent extent = extent_of({&mesh, 1});
    return std::abs(extent.least.y - found.plan.height_m) <= near_m && extent.size().y >= least_height_m;
  }));
}

/// Where what is as high as a wall begins: at the wanted height, or else the lowest; or nothing.
std::optional<double> foot_of_walls(std::span<const TriMesh* const> meshes, std::optional<double> wanted_m) {
  constexpr double least_height_m = 1.8, near_m = 0.2;  // assumed (1.7-2: higher than furniture; 0.1-0.3)
  std::optional<double> foot_m;
  for (const TriMesh* mesh : meshes) {
    const Extent extent = extent_of({&mesh, 1});
    if (extent.size().y < least_height_m) continue;
    if (wanted_m && std::abs(*wanted_m - extent.least.y) <= near_m) return wanted_m;
    if (!wanted_m) foot_m = std::min(foot_m.value_or(extent.least.y), extent.least.y);
  }
  return foot_m;
}

/// floor_m: before the frame's origin is taken away.
Found look_for_floor(io::ModelParts model, std::optional<double> floor_m) {
  Found found{std::move(model), {}, {}, {}, {}, {}};
  found.frame = frame_of(found.model);
  to_room(found.model, found.frame);
  if (floor_m) *floor_m -= found.frame.origin_m.y;
  found.doors = doors_of(found.model);
  found.spaces = things_named(found.model, space_words, [](const Extent&) { return true; });
  std::vector<Leaf> leaves;
  for (const Thing& door : found.doors) leaves.push_back(leaf_of(door));
  const std::vector<const TriMesh*> meshes = meshes_without(found.model, found.spaces);
  found.floor = floor_m ? ChosenFloor{*floor_m, {}} : choose_floor(meshes, leaves);
  constexpr double fine_m = 0.05;
  if (found.floor) found.plan = floor_plan_at(meshes, leaves, found.floor->height_m, fine_m);
  if (found.plan.n_rooms > 0) return found;
  const std::optional<double> foot_m = foot_of_walls(meshes, floor_m);
  if (!foot_m) return found;
  found.floor = ChosenFloor{*foot_m, {}};
  found.plan = floor_plan_at(meshes, leaves, *foot_m, fine_m, FloorFrom::walls);
  found.is_between_walls = true;
  return found;
}

/// Is a floor that was found without the surroundings the better one? They may have been the room.
bool is_better(const Found& without, const Found& with) {
  if (without.plan.n_rooms == 0 || with.plan.n_rooms == 0) return without.plan.n_rooms > 0;
  if (without.is_between_walls != with.is_between_walls) return with.is_between_walls;
  if (without.plan.is_bare != with.plan.is_bare) return with.plan.is_bare;
  const std::size_t own = n_standing(without), other = n_standing(with);
  return own > other || (own == other && !without.plan.is_bare);
}

/// Why there is none, and what helps: to leave out what is widest, if a floor is found then, or to draw one.
std::string no_floor(const Found& found, const SuggestionHints& hints) {
  const std::string what =
      (hints.floor_m ? "at a height of " + fixed(*hints.floor_m, 2) + " m nothing looks like a floor"
                     : std::string("nothing in the model looks like a floor")) +
      ": level, with 2 m2 at least to stand on, or enclosed by walls. ";
  const io::ModelPart* largest = nullptr;
  double most_m2 = 0.0;
  for (const io::ModelPart& part : found.model.parts) {
    const TriMesh* mesh = &part.mesh;
    const Vec3 size = extent_of({&mesh, 1}).size();
    if (size.x * size.z <= most_m2) continue;
    most_m2 = size.x * size.z;
    largest = &part;
  }
  if (largest != nullptr) {
    io::ModelParts rest = found.model;  // in the room's frame already
    leave_out(rest, {largest->node});
    std::optional<double> floor_m = hints.floor_m;
    if (floor_m) *floor_m -= found.frame.origin_m.y;
    if (!rest.parts.empty() && look_for_floor(std::move(rest), floor_m).plan.n_rooms > 0) {
      const std::string name = shortened(found.model.nodes[static_cast<std::size_t>(largest->node)].name);
      return what + "The widest thing is '" + name + "', " + fixed(most_m2, 0) +
             " m2 seen from above: it is in the way, leave it out (--ignore '" + name + "')";
    }
  }
  return what +
         "Draw the floor yourself, in a file for --marks: `pirsim_marks: 1` and `floors: [{height_m: 0, polygon_xz_m: "
         "[[x, z], [x, z], [x, z]]}]`, with its corners in metres";
}

/// A name that an id can be.
std::string id_from(const std::string& name) {
  std::string id;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 128) {
      id += c;
    } else if (!id.empty() && id.back() != '_') {
      id += '_';
    }
  }
  while (!id.empty() && id.back() == '_') id.pop_back();
  return id.substr(0, 40);
}

/// By the volumes of spaces, then by what stands in them: "Kitchen_bottom" makes a kitchen.
std::map<int, std::string> room_names(const io::ModelParts& model, const std::vector<Thing>& spaces,
                                      const FloorPlan& plan) {
  std::map<int, std::string> names;
  const auto name = [&](const Thing& thing) {
    const int room = plan.room_at(floor_point(thing.extent.middle()));
    if (room >= 0) names.try_emplace(room, model.nodes[static_cast<std::size_t>(thing.node)].name);
  };
  std::ranges::for_each(spaces, name);
  const auto fits = [](const Extent&) { return true; };
  for (const Thing& thing : things_named(model, room_words, fits)) name(thing);
  return names;
}

void add_areas(const io::ModelParts& model, const std::vector<Thing>& spaces, const FloorPlan& plan,
               Suggestion& result) {
  const std::map<int, std::string> names = room_names(model, spaces, plan);
  std::set<std::string> taken;
  std::vector<std::string> ids;
  for (int room = 0; room < plan.n_rooms; ++room) {
    SuggestedArea area;
    if (const auto named = names.find(room); named != names.end() && !id_from(named->second).empty()) {
      area.id = id_from(named->second);
      area.named_by = named->second;
    }
    const std::string base = area.id.empty() ? "area" : area.id;
    for (int n = area.id.empty() ? 1 : 2; area.id.empty() || taken.contains(area.id); ++n)
      area.id = base + '_' + std::to_string(n);
    taken.insert(area.id);
    ids.push_back(area.id);
    area.outline = room_outline(plan, room);
    if (area.outline.empty()) continue;
    area.square_metres = FloorArea({area.outline}, 0.0).area_m2();
    result.areas.push_back(std::move(area));
  }
  for (const FloorGap& gap : plan.gaps) {
    const auto id = [&](int room) { return room < 0 ? std::string() : ids[static_cast<std::size_t>(room)]; };
    (gap.to < 0 ? result.entrances : result.doors)
        .push_back({id(gap.from), id(gap.to), gap.at, gap.inwards, gap.width_m});
  }
}

}  // namespace

Suggestion suggest(io::ModelParts model, const SuggestionHints& hints, const std::string& name) {
  ignore(model, hints.ignored);
  if (model.parts.empty()) throw Error(ErrorCode::input, {name}, "the model has no meshes");
  Suggestion result;
  result.ignored = hints.ignored;
  const std::vector<int> around = surroundings_of(model);
  Found found = look_for_floor(model, hints.floor_m);
  if (!around.empty()) {
    io::ModelParts rest = model;
    leave_out(rest, around);
    if (Found without = look_for_floor(std::move(rest), hints.floor_m); is_better(without, found)) {
      found = std::move(without);
      for (const int node : around) result.around.push_back(model.nodes[static_cast<std::size_t>(node)].name);
    }
  }
  if (found.plan.n_rooms == 0) throw Error(ErrorCode::input, {name}, no_floor(found, hints));
  const FloorPlan& plan = found.plan;
  result.frame = found.frame;
  result.floor_m = found.floor->height_m;
  result.other_floors_m = found.floor->others_m;
  result.floors = floor_outlines(plan);
  result.is_open = plan.is_open;
  result.is_between_walls = found.is_between_walls;
  std::vector<Thing> shutting;
  for (const FloorGap& gap : plan.gaps) {
    if (gap.leaf >= 0) shutting.push_back(found.doors[static_cast<std::size_t>(gap.leaf)]);
  }
  result.door_leaves = names_of(found.model, shutting);
  result.spaces = names_of(found.model, found.spaces);
  add_areas(found.model, found.spaces, plan, result);
  result.seats = seats_of(found.model, plan);
  result.beds = beds_of(found.model, plan);
  return result;
}

// A suggestion as a marks file.

namespace {

/// As YAML takes it back; readers have refused names with line breaks.
std::string quoted(const std::string& name) {
  std::string text = "'";
  for (const char c : name) text += c == '\'' ? "''" : std::string(1, c);
  return text + "'";
}

/// To a centimetre, without a minus before a zero.
std::string centimetres(double value) {
  const std::string text = fixed(value, 2);
  return text == "-0.00" ? "0.00" : text;
}
std::string flat_point(const Vec2& p) { return "[" + centimetres(p.x) + ", " + centimetres(p.y) + "]"; }
std::string room_point(const Vec3& p) {
  return "[" + centimetres(p.x) + ", " + centimetres(p.y) + ", " + centimetres(p.z) + "]";
}
std::string polygon(const std::vector<Vec2>& corners) {
  std::vector<std::string> points;
  for (const Vec2& p : corners) points.push_back(flat_point(p));
  return "[" + joined(points, ", ") + "]";
}

class SuggestionWriter {
 public:
  SuggestionWriter(const Suggestion& suggestion, const std::string& model) : given_(suggestion), model_(model) {}

  std::string run() {
    out_ << "# A proposal for " << model_
         << ", made of its shapes and names by `pirsim check --suggest`: look at it, and\n"
         << "# edit it. Positions are in the room: metres, +Y up.\npirsim_marks: 1\n";
    frame();
    floors();
    areas();
    entrances();
    seats();
    ignored();
    sensor();
    return out_.str();
  }

 private:
  /// In the corner from which one looks farthest along the middle between its walls.
  void sensor() {
    constexpr double off_walls_m = 0.1, high_m = 2.3;
    Vec2 best(0.0), towards(0.0, -1.0);
    double farthest_m = 0.0;
    for (const SuggestedArea& area : given_.areas) {
      const std::vector<Vec2>& corners = area.outline;
      const FloorArea inside({corners}, 0.0);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2& at = corners[i];
        const Vec2 before = glm::normalize(corners[(i + corners.size() - 1) % corners.size()] - at);
        const Vec2 after = glm::normalize(corners[(i + 1) % corners.size()] - at);
        if (glm::length(before + after) < 0.5) continue;  // nearly straight
        const Vec2 middle = glm::normalize(before + after);
        double seen_m = 0.0;
        while (inside.contains(at + (seen_m + off_walls_m) * middle)) seen_m += off_walls_m;
        if (seen_m > farthest_m) farthest_m = seen_m, best = at + off_walls_m * middle, towards = middle;
      }
    }
    out_ << "\n# Sensors aren't proposed. One in a corner, " << fixed(high_m, 1)
         << " m up, that looks into the room and 20 degrees down:\n"
            "# sensors:\n# - {id: PIR1, model: EKMC1604111, position_m: "
         << room_point({best.x, given_.floor_m + high_m, best.y})
         << ", yaw_deg: " << fixed(degrees(heading_of(towards)), 0) << ", tilt_deg: 20}\n";
  }

  void frame() {
    const SuggestedFrame& frame = given_.frame;
    if (frame.unit.empty()) {
      out_ << "scale: " << shortest_number(frame.metres)
           << "  # a guess: no unit makes a building of the model; so it is one storey high\n";
    } else {
      out_ << "unit: " << frame.unit << (frame.unit == "m" ? "\n" : "  # by the model's size\n");
    }
    out_ << "up: " << frame.up << (frame.up == 'y' ? "\n" : "  # by the model's size: along +Y it is no storey\n");
    if (frame.origin_m != Vec3(0.0))
      out_ << "origin_m: [" << fixed(frame.origin_m.x, 0) << ", " << fixed(frame.origin_m.y, 0) << ", "
           << fixed(frame.origin_m.z, 0) << "]  # the model has the coordinates of a map\n";
  }

  void floors() {
    out_ << (given_.is_between_walls ? "\n# No surface is a floor: this is what the walls enclose, at their feet.\n"
                                     : "\n")
         << "floors:\n";
    for (const auto& outline : given_.floors) {
      out_ << "- {height_m: " << centimetres(given_.floor_m) << ", polygon_xz_m: " << polygon(outline) << "}\n";
    }
    if (given_.other_floors_m.empty()) return;
    std::vector<std::string> heights;
    for (const double height_m : given_.other_floors_m)
      heights.push_back(centimetres(height_m + given_.frame.origin_m.y));
    out_ << "# Other floors were found at " << joined(heights, ", ") << " m; `--floor " << heights.front()
         << "` proposes marks for that one.\n";
  }

  void areas() {
    const std::vector<std::string> types = io::detail::mark_types();
    const bool are_marks = std::ranges::find(types, "area") != types.end();
    const char* begin = are_marks ? "" : "# ";
    out_ << '\n' << begin << "areas:\n";
    for (const SuggestedArea& area : given_.areas) {
      out_ << begin << "- {id: " << area.id << ", height_m: " << centimetres(given_.floor_m)
           << ", polygon_xz_m: " << polygon(area.outline) << "}  # " << fixed(area.square_metres, 1) << " m2"
           << (area.named_by.empty() ? "" : ", named after " + quoted(area.named_by)) << '\n';
    }
    for (const SuggestedGap& gap : given_.doors) {
      out_ << "# An opening between " << gap.from << " and " << gap.to << ", " << fixed(gap.width_m, 2)
           << " m wide, at " << flat_point(gap.at) << ".\n";
    }
  }

  void entrances() {
    if (given_.entrances.empty()) {
      out_ << "\n# No way in was found. People can `appear` in a script, or:\n# entrances:\n"
              "# - {id: entrance_1, position_m: [0, "
           << centimetres(given_.floor_m) << ", 0], direction: [0, 0, -1]}\n";
      return;
    }
    out_ << "\nentrances:\n";
    int n = 0;
    for (const SuggestedGap& gap : given_.entrances) {
      out_ << "- {id: entrance_" << ++n << ", position_m: " << room_point({gap.at.x, given_.floor_m, gap.at.y})
           << ", direction: " << room_point({gap.inwards.x, 0.0, gap.inwards.y})
           << ", width_m: " << fixed(gap.width_m, 2) << "}  # into " << gap.from
           << (given_.is_open ? ": a side without walls, since no door leads in" : "") << '\n';
    }
  }

  void seats() {
    if (!given_.seats.empty()) out_ << "\nseats:\n";
    for (const SuggestedSeat& seat : given_.seats) {
      out_ << "- {id: " << seat.id << ", position_m: " << room_point(seat.pelvis)
           << ", direction: " << room_point({seat.facing.x, 0.0, seat.facing.y}) << "}  # " << quoted(seat.node) << ", "
           << seat.reason << '\n';
    }
    for (const std::string& bed : given_.beds) out_ << "# A bed: " << quoted(bed) << ".\n";
  }

  void ignored() {
    if (given_.door_leaves.empty() && given_.spaces.empty() && given_.around.empty() && given_.ignored.empty()) return;
    out_ << "\nignore:\n";
    for (const std::string& pattern : given_.ignored) out_ << "- " << quoted(pattern) << "\n";
    for (const std::string& name : given_.around)
      out_ << "- " << quoted(name) << "  # lies around all else: no floor was looked for on it\n";
    for (const std::string& name : given_.door_leaves) out_ << "- " << quoted(name) << "  # shuts an opening\n";
    for (const std::string& name : given_.spaces) out_ << "- " << quoted(name) << "  # a room's volume\n";
  }

  const Suggestion& given_;
  const std::string& model_;
  std::ostringstream out_;
};

}  // namespace

std::string to_yaml(const Suggestion& suggestion, const std::string& model_name) {
  return SuggestionWriter(suggestion, model_name).run();
}

}  // namespace pirsim::studies
