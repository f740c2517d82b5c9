#include "files/read/marks_file.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "files/disk/file.hpp"
#include "files/read/gltf_geometry.hpp"
#include "files/read/reader_parts.hpp"
#include "model/core/error.hpp"
#include "model/core/text.hpp"
#include "pirsim/survey.hpp"

namespace pirsim::io::detail {
namespace {

using nlohmann::json;

// Marks in YAML, as glTF has them in JSON.

/// Ids and models are names, even if they look like numbers.
json json_of(const YamlNode& node, std::string_view key = {}) {
  if (node.is_map()) {
    json object = json::object();
    const std::vector<YamlKey> keys = node.keys();
    const std::vector<YamlNode> values = node.items();
    for (std::size_t i = 0; i < keys.size(); ++i) object[keys[i].name] = json_of(values[i], keys[i].name);
    return object;
  }
  if (node.is_list()) {
    json array = json::array();
    for (const YamlNode& item : node.items()) array.push_back(json_of(item));
    return array;
  }
  if (!node.is_scalar()) return {};
  Diagnostics untold;
  const std::string text = node.prose(untold, key);
  if (key == "id" || key == "model") return text;
  if (text == "true" || text == "false") return text == "true";
  if (const auto number = parse_number<double>(text)) return *number;
  return text;
}

enum class PlaceOf { value, key };
/// Of what is at a JSON pointer, or the nearest around it.
Where place_in(YamlNode node, std::string_view pointer, PlaceOf what) {
  Where where = node.where();
  while (pointer.starts_with('/')) {
    pointer.remove_prefix(1);
    const std::string_view step = pointer.substr(0, pointer.find('/'));
    pointer.remove_prefix(step.size());
    const std::vector<YamlNode> values = node.items();
    std::size_t i = 0;
    if (node.is_map()) {
      const std::vector<YamlKey> keys = node.keys();
      i = static_cast<std::size_t>(std::ranges::find(keys, step, &YamlKey::name) - keys.begin());
      if (i < keys.size() && what == PlaceOf::key) where = keys[i].where;
    } else {
      i = parse_number<std::size_t>(std::string(step)).value_or(values.size());
    }
    if (i >= values.size()) return where;
    node = values[i];
    if (what == PlaceOf::value) where = node.where();
  }
  return where;
}

GivenMark given_mark(const YamlNode& node, std::string label) {
  return {json_of(node),
          {std::move(label), [node](const std::string& member) { return place_in(node, member, PlaceOf::value); },
           [node](const std::string& key) { return place_in(node, key, PlaceOf::key); }}};
}

// From the model to the room.

constexpr NumberRange scale_range{.min = 1e-6, .max = 1e6};
constexpr NumberRange origin_range;  // coordinates of a map are millions of metres

double read_scale(YamlMap& map) {
  const double metres =
      map.choice<double>("unit", 1.0, {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}});
  const double scale = map.number("scale", metres, scale_range);
  if (map.has("unit") && map.has("scale"))
    map.faults().error(map.where("scale"), "scale: 'unit' says it already; one of them is enough");
  return scale;
}

/// Turns the axis that points up in the model to +Y, and keeps it right-handed.
glm::dmat4 read_up(YamlMap& map) {
  const glm::dmat4 as_is(1.0);
  const auto turned = [&](double deg, const Vec3& axis) { return glm::rotate(as_is, radians(deg), axis); };
  const char up = map.choice<char>("up", 'y', {{"x", 'x'}, {"y", 'y'}, {"z", 'z'}});
  if (up == 'x') return turned(90.0, Vec3(0, 0, 1));
  return up == 'z' ? turned(-90.0, Vec3(1, 0, 0)) : as_is;
}

glm::dmat4 read_room_from_model(YamlMap& map) {
  const double scale = read_scale(map);
  const glm::dmat4 room_from_model = glm::scale(read_up(map), Vec3(scale));
  if (!map.child("origin_m")) return room_from_model;
  const std::vector<double> origin = map.required_numbers("origin_m", 3, origin_range);
  return glm::translate(glm::dmat4(1.0), -Vec3(origin[0], origin[1], origin[2])) * room_from_model;
}

// What is in the room.

constexpr const char* polygon_key = "polygon_xz_m";

/// The direction of view, in degrees as mounted() takes them.
struct Heading {
  double yaw_deg = 0.0, tilt_deg = 0.0;
};
Heading heading_of(const Vec3& direction) {
  const double aside = glm::length(Vec2(direction.x, direction.z));
  const double yaw = aside > 1e-9 * std::abs(direction.y) ? std::atan2(-direction.x, -direction.z) : 0.0;
  return {degrees(yaw), degrees(std::atan2(-direction.y, aside))};
}

Heading read_heading(YamlMap& map, const std::string& type) {
  Heading heading;
  heading.yaw_deg = map.number("yaw_deg", 0.0, accepted::turned_deg);
  if (type == "sensor") heading.tilt_deg = map.number("tilt_deg", 0.0, accepted::tilted_deg);
  if (!map.child("direction")) return heading;
  const std::vector<double> d = map.required_numbers("direction", 3, {.min = -1e6, .max = 1e6});
  const Vec3 direction(d[0], d[1], d[2]);
  if (glm::length(direction) < 1e-9)
    map.faults().error(map.where("direction"), map.label("direction") + ": expected a direction, not a point");
  if (map.has("yaw_deg") || map.has("tilt_deg"))
    map.faults().error(map.where("direction"), map.label("direction") + ": angles say it already");
  return heading_of(direction);
}

/// Polygons lie in the room's own XZ, all else has a place of its own.
glm::dmat4 read_place(YamlMap& map, const std::string& type) {
  if (map.has(polygon_key)) {
    const double height_m = map.number("height_m", 0.0, accepted::in_world_m);
    return glm::translate(glm::dmat4(1.0), Vec3(0.0, height_m, 0.0));
  }
  const std::vector<double> at = map.required_numbers("position_m", 3, accepted::in_world_m);
  const Heading heading = read_heading(map, type);
  const Frame frame = mounted({at[0], at[1], at[2]}, heading.yaw_deg, heading.tilt_deg);
  return glm::translate(glm::dmat4(1.0), frame.origin) * glm::mat4_cast(frame.rotation);
}

std::optional<MarksFile::Placed> read_placed(const YamlNode& node, const std::string& type, Diagnostics& faults,
                                             GroupedWarnings& warnings) {
  YamlMap map(node, faults, type);
  if (!node.is_map()) return std::nullopt;
  GivenMark given = given_mark(node, type);
  if (map.has("type")) {
    faults.error(map.where("type"), map.label("type") + ": the list says it already");
    return std::nullopt;
  }
  given.value["type"] = type;
  if (const auto id = given.value.find("id"); id != given.value.end() && id->is_string())
    given.place.label += " '" + shortened(id->get<std::string>()) + "'";
  const glm::dmat4 place = read_place(map, type);
  given.other_keys = map.asked();
  std::optional<NodeMark> mark = read_mark(given, faults, warnings);
  if (!mark) return std::nullopt;
  return MarksFile::Placed{*std::move(mark), place};
}

/// "seats", "floors", ...: a list of each type of mark but those that are about a node's mesh.
void read_lists(YamlMap& map, MarksFile& marks, GroupedWarnings& warnings) {
  for (const std::string& type : mark_types()) {
    if (type == "surface" || type == "ignore") continue;
    for (const YamlNode& item : map.list(type + 's', limits::seats)) {
      if (auto placed = read_placed(item, type, map.faults(), warnings)) marks.placed.push_back(*std::move(placed));
    }
  }
}

// What nodes are.

void read_patterns(YamlMap& map, MarksFile& marks) {
  for (const YamlNode& item : map.list("ignore", limits::seats))
    marks.ignored.push_back({item.text(map.faults(), "ignore"), item.where()});
  const std::optional<YamlNode> nodes = map.child("nodes");
  if (!nodes) return;
  if (!nodes->is_map()) {
    if (!nodes->is_null()) map.faults().error(nodes->where(), "nodes: expected a map of nodes' names and their marks");
    return;
  }
  const std::vector<YamlKey> names = nodes->keys();
  const std::vector<YamlNode> values = nodes->items();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string label = "nodes: '" + shortened(names[i].name) + "'";
    if (values[i].is_map()) {
      marks.of_nodes.push_back({{names[i].name, names[i].where}, given_mark(values[i], label)});
    } else {
      map.faults().error(values[i].where(), label + ": expected a mark, as {type: surface, temperature_c: 35}");
    }
  }
}

/// As did_you_mean(), of a pattern: the name that has the longest part of it.
std::string meant_by(const std::string& pattern, const std::vector<std::string>& names) {
  constexpr std::size_t least = 3, longest = 100;
  std::size_t most = least - 1;
  const std::string* best = nullptr;
  for (const std::string& name : names) {
    if (name.size() > longest || pattern.size() > longest) continue;
    for (std::size_t from = 0; from + most < pattern.size(); ++from) {
      while (from + most < pattern.size() && name.find(pattern.substr(from, most + 1)) != std::string::npos)
        ++most, best = &name;
    }
  }
  return best == nullptr ? near_or_all(pattern, names) : " (did you mean '" + *best + "'?)";
}

class NodeMatcher {
 public:
  NodeMatcher(const tinygltf::Model& model, const PlacedNodes& nodes) {
    for (const PlacedNode& placed : nodes.shown) names_.emplace(placed.node, node_name(model, placed.node));
    for (const HiddenNode& hidden : nodes.hidden) {
      names_.emplace(hidden.node, node_name(model, hidden.node));
      for (const int below : hidden.below) names_.emplace(below, node_name(model, below));
    }
  }
  /// Adds a fault if there are none.
  [[nodiscard]] std::vector<int> matched(const NodePattern& pattern, const std::string& key,
                                         Diagnostics& faults) const {
    std::vector<int> nodes;
    for (const auto& [node, name] : names_) {
      if (pattern.matches(name)) nodes.push_back(node);
    }
    if (nodes.empty()) {
      const bool is_glob = pattern.text.find_first_of("*?") != std::string::npos;
      const std::vector<std::string> names = sorted_names();
      faults.error(pattern.where, key + ": no node of the scene is called '" + shortened(pattern.text) + "'" +
                                      (is_glob ? meant_by(pattern.text, names) : near_or_all(pattern.text, names)));
    }
    return nodes;
  }

 private:
  [[nodiscard]] std::vector<std::string> sorted_names() const {
    std::set<std::string> names;
    for (const auto& [node, name] : names_) names.insert(name);
    return {names.begin(), names.end()};
  }
  std::map<int, std::string> names_;  ///< of all nodes of the scene
};

/// A node with all that is below it, once each: the file may be a tangle, which place_nodes() tells.
void ignore_below(const tinygltf::Model& model, int top, const NodePattern& pattern,
                  std::map<int, NodePattern>& ignored) {
  std::vector<int> pending{top};
  while (!pending.empty()) {
    const int node = pending.back();
    pending.pop_back();
    if (!ignored.try_emplace(node, pattern).second) continue;
    const std::vector<int>& children = model.nodes[static_cast<std::size_t>(node)].children;
    pending.insert(pending.end(), children.begin(), children.end());
  }
}

}  // namespace

bool NodePattern::matches(std::string_view name) const {
  if (name == text) return true;
  constexpr auto none = std::string_view::npos;
  std::size_t at = 0, in_name = 0, star = none, after_star = 0;
  while (in_name < name.size()) {
    if (at < text.size() && text[at] == '*') {
      star = at++;
      after_star = in_name;
    } else if (at < text.size() && (text[at] == '?' || text[at] == name[in_name])) {
      ++at, ++in_name;
    } else if (star != none) {
      at = star + 1;
      in_name = ++after_star;
    } else {
      return false;
    }
  }
  return text.find_first_not_of('*', at) == none;
}

std::string in_place(const Where& where) {
  const std::string line = where.line > 0 ? ':' + std::to_string(where.line) + ':' + std::to_string(where.column) : "";
  return " in " + where.file + line;
}

std::string node_name(const tinygltf::Model& model, int node) {
  const tinygltf::Node& given = model.nodes[static_cast<std::size_t>(node)];
  if (!given.name.empty()) return given.name;
  if (given.mesh < 0) return "node " + std::to_string(node);
  const std::string& mesh = model.meshes[static_cast<std::size_t>(given.mesh)].name;
  return mesh.empty() ? "mesh " + std::to_string(given.mesh) : mesh;
}

MarksFile read_marks_file(const std::filesystem::path& file, GroupedWarnings& warnings) {
  const Input input = read_input(file);
  Diagnostics faults;
  YamlMap map(YamlNode::load(input), faults, "marks");
  check_version(map, "pirsim_marks");
  MarksFile marks;
  marks.file = input.file();
  marks.room_from_model = read_room_from_model(map);
  read_patterns(map, marks);
  read_lists(map, marks, warnings);
  map.finish();
  faults.throw_if_errors();
  return marks;
}

MarksOfNodes marks_of_nodes(const MarksFile& marks, const GltfDocument& document, const PlacedNodes& nodes,
                            Diagnostics& faults, GroupedWarnings& warnings) {
  const tinygltf::Model& model = document.model;
  const NodeMatcher matcher(model, nodes);
  MarksOfNodes result;
  for (const NodePattern& pattern : marks.ignored) {
    for (const int node : matcher.matched(pattern, "ignore", faults))
      ignore_below(model, node, pattern, result.ignored);
  }
  for (const auto& [pattern, given] : marks.of_nodes) {
    const std::vector<int> matched = matcher.matched(pattern, "nodes", faults);
    const auto has_mesh = [&](int node) { return model.nodes[static_cast<std::size_t>(node)].mesh >= 0; };
    GivenMark borne = given;
    if (std::ranges::any_of(matched, has_mesh)) borne.bearer = GivenMark::Bearer::with_mesh;
    const std::optional<NodeMark> mark = matched.empty() ? std::nullopt : read_mark(borne, faults, warnings);
    for (const int node : matched) {
      if (!mark) break;
      const auto [first, is_new] = result.marks.try_emplace(node, *mark);
      if (is_new) continue;
      faults.error(pattern.where, given.place.label + ": " + node_label(model, node) + " is marked already" +
                                      in_place(first->second.place.where("")));
    }
  }
  return result;
}

}  // namespace pirsim::io::detail

namespace pirsim::io {

ModelParts read_model_parts(const std::filesystem::path& file) {
  Diagnostics remarks;
  GroupedWarnings warnings;
  const detail::GltfDocument document = detail::load_gltf(file, remarks);
  const detail::PlacedNodes placed = detail::place_nodes(document, remarks, glm::dmat4(1.0), detail::Reach::anywhere);
  remarks.throw_if_errors();
  detail::GeometryBudget budget;
  ModelParts model;
  std::map<int, int> parents;     // by node of the file
  std::map<int, TriMesh> meshes;  // by mesh of the file
  for (const detail::PlacedNode& shown : placed.shown) {
    const tinygltf::Node& node = document.model.nodes[static_cast<std::size_t>(shown.node)];
    const auto above = parents.find(shown.node);
    const int place = static_cast<int>(model.nodes.size());
    for (const int child : node.children) parents.emplace(child, place);
    model.nodes.push_back({detail::node_name(document.model, shown.node), above == parents.end() ? -1 : above->second});
    if (node.mesh < 0) continue;
    const auto [known, is_first] = meshes.try_emplace(node.mesh);
    if (is_first) known->second = detail::read_mesh(document, node.mesh, budget, remarks, warnings);
    if (known->second.triangles.empty()) continue;
    if (!is_first && !budget.take(known->second.positions.size() + known->second.triangles.size()))
      remarks.error({file.string()}, "the copies of its meshes make the scene too large");
    remarks.throw_if_errors();
    model.parts.push_back({place, detail::transformed(known->second, shown.world_from_node, model.nodes.back().name)});
  }
  remarks.throw_if_errors();
  warnings.tell(remarks);
  model.warnings = remarks.warnings();
  return model;
}

}  // namespace pirsim::io
