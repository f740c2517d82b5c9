// Unit and upward axis of a model, and its named things.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "studies/suggested_parts.hpp"

namespace pirsim::studies {
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

void to_room(io::ModelParts& model, const SuggestedFrame& frame) {
  for (io::ModelPart& part : model.parts) {
    for (Vec3& p : part.mesh.positions) {
      if (frame.up == 'x') p = Vec3(-p.y, p.x, p.z);
      if (frame.up == 'z') p = Vec3(p.x, p.z, -p.y);
      p *= frame.metres;
    }
  }
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

}  // namespace pirsim::studies
