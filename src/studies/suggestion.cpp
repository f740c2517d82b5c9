#include "studies/suggestion.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/text.hpp"
#include "studies/suggested_parts.hpp"

namespace pirsim::studies {
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

Found look_for_floor(io::ModelParts model, std::optional<double> floor_m) {
  Found found{std::move(model), {}, {}, {}, {}, {}};
  found.frame = frame_of(found.model);
  to_room(found.model, found.frame);
  found.doors = doors_of(found.model);
  found.spaces = things_named(found.model, space_words, [](const Extent&) { return true; });
  std::vector<Leaf> leaves;
  for (const Thing& door : found.doors) leaves.push_back(leaf_of(door));
  const std::vector<const TriMesh*> meshes = meshes_without(found.model, found.spaces);
  found.floor = floor_m ? ChosenFloor{*floor_m, {}} : choose_floor(meshes, leaves);
  constexpr double fine_m = 0.05;
  if (found.floor) found.plan = floor_plan_at(meshes, leaves, found.floor->height_m, fine_m);
  return found;
}

/// Is a floor that was found without the surroundings the better one? They may have been the room.
bool is_better(const Found& without, const Found& with) {
  if (without.plan.n_rooms == 0 || with.plan.n_rooms == 0) return without.plan.n_rooms > 0;
  if (without.plan.is_bare != with.plan.is_bare) return with.plan.is_bare;
  const std::size_t own = n_standing(without), other = n_standing(with);
  return own > other || (own == other && !without.plan.is_bare);
}

/// Why there is none, and what may be in the way.
std::string no_floor(const Found& found, std::optional<double> floor_m) {
  const std::string what = floor_m ? "at a height of " + fixed(*floor_m, 2) + " m nothing looks like a floor"
                                   : "nothing in the model looks like a floor";
  const io::ModelPart* largest = nullptr;
  double most_m2 = 0.0;
  for (const io::ModelPart& part : found.model.parts) {
    const TriMesh* mesh = &part.mesh;
    const Vec3 size = extent_of({&mesh, 1}).size();
    if (size.x * size.z <= most_m2) continue;
    most_m2 = size.x * size.z;
    largest = &part;
  }
  const std::string name =
      largest == nullptr ? "" : shortened(found.model.nodes[static_cast<std::size_t>(largest->node)].name);
  return what + ": level, with 2 m2 at least to stand on" +
         (largest == nullptr ? ""
                             : ". The widest thing is '" + name + "', " + fixed(most_m2, 0) +
                                   " m2 seen from above: if it is in the way, leave it out (--ignore '" + name + "')") +
         (floor_m ? "" : ", or tell the floor's height (--floor)");
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
  if (found.plan.n_rooms == 0) throw Error(ErrorCode::input, {name}, no_floor(found, hints.floor_m));
  const FloorPlan& plan = found.plan;
  result.frame = found.frame;
  result.floor_m = found.floor->height_m;
  result.other_floors_m = found.floor->others_m;
  result.floors = floor_outlines(plan);
  result.is_open = plan.is_open;
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

}  // namespace pirsim::studies
