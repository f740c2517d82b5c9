#include "files/read/scene_parts.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "model/core/text.hpp"
#include "model/schema/checks.hpp"
#include "model/schema/fields.hpp"

namespace pirsim::io::detail {
namespace {

using nlohmann::json;

std::optional<double> temperature_of(const json& mark, const GltfDocument& document, const std::string& pointer,
                                     Diagnostics& remarks) {
  if (!mark.is_object()) {
    remarks.error(document.text.where(pointer), "'pirsim' must be an object with a 'temperature_c'");
    return std::nullopt;
  }
  for (const auto& [key, unused] : mark.items()) {
    if (key == "temperature_c") continue;
    remarks.error(document.text.where_key(pointer + '/' + key),
                  "unknown key '" + key + "' of a material" + did_you_mean(key, {"temperature_c"}));
    return std::nullopt;
  }
  const auto value = mark.find("temperature_c");
  if (value != mark.end() && value->is_number() && accepted::surface_c.holds(value->get<double>())) {
    return value->get<double>();
  }
  remarks.error(document.text.where(pointer), "a material needs 'temperature_c' from -50 to 200");
  return std::nullopt;
}

}  // namespace

std::vector<std::optional<double>> material_temperatures_c(const GltfDocument& document, Diagnostics& remarks) {
  const json& root = document.text.root();
  const auto materials = root.find("materials");  // of the text: the model is read without them
  if (materials == root.end() || !materials->is_array()) return {};
  std::vector<std::optional<double>> temperatures(materials->size());
  for (std::size_t i = 0; i < temperatures.size(); ++i) {
    if (!(*materials)[i].is_object()) continue;
    const auto extras = (*materials)[i].find("extras");
    if (extras == (*materials)[i].end() || !extras->is_object() || !extras->contains("pirsim")) continue;
    const json& given = (*extras)["pirsim"];
    json mark = given;
    if (given.is_string()) {  // as with nodes
      auto parsed = parse_json(given.get<std::string>());
      mark = std::holds_alternative<json>(parsed) ? std::get<json>(std::move(parsed)) : json();
    }
    const std::string pointer = "/materials/" + std::to_string(i) + "/extras/pirsim";
    temperatures[i] = temperature_of(mark, document, pointer, remarks);
  }
  return temperatures;
}

namespace {

using nlohmann::json;

class MarkupReader {
 public:
  MarkupReader(const GivenMark& given, Diagnostics& faults, GroupedWarnings& warnings)
      : given_(given), value_(given.value), faults_(faults), warnings_(warnings) {}

  std::optional<NodeMark> read() {
    if (!value_.is_object()) return error("", "'pirsim' must be an object with a 'type'"), std::nullopt;
    if (!value_.contains("type")) return error("", "'type' is missing; " + types_told()), std::nullopt;
    if (!value_["type"].is_string()) return error("/type", "'type' must be a text; " + types_told()), std::nullopt;
    const auto type = value_["type"].get<std::string>();
    std::optional<Markup> result;
    if (type == "sensor") result = placed<SensorSpec>();
    if (type == "seat") result = seat();
    if (type == "place") result = place();
    if (type == "entrance") result = placed<EntranceSpec>();
    if (type == "door") result = placed<DoorSpec>();
    if (type == "floor") result = floor();
    if (type == "area") result = area();
    if (type == "surface") result = surface();
    if (type == "ignore") result = ignore();
    if (value_.contains("as_meant") && !value_["as_meant"].is_boolean())
      error("/as_meant", "'as_meant' must be true or false");
    if (!result) error("/type", "unknown type '" + type + "'" + did_you_mean(type, mark_types()) + "; " + types_told());
    if (faulty_) return std::nullopt;
    return NodeMark{*std::move(result), given_.place,
                    value_.value("as_meant", false) ? Doubts::not_told : Doubts::told};
  }

 private:
  static std::string types_told() {
    return "known are sensor, seat, place, entrance, door, floor, area, surface and ignore";
  }

  /// Names and numbers of what has a place in the room.
  template <typename Spec>
  Spec placed() {
    Spec spec;
    std::vector<std::string> keys{"type"};
    each_field<Spec>([&](const auto& field) {
      auto& value = spec.*field.member;
      using Value = std::remove_reference_t<decltype(value)>;
      if constexpr (!std::same_as<Value, Frame>) keys.emplace_back(field.name);
    });
    only(keys);
    each_field<Spec>([&](const auto& field) {
      auto& value = spec.*field.member;
      using Value = std::remove_reference_t<decltype(value)>;
      if constexpr (std::same_as<Value, std::string>) value = name(field.name);
      if constexpr (std::same_as<Value, std::optional<std::string>>) {
        if (value_.contains(field.name)) value = name(field.name);
      }
      if constexpr (std::same_as<Value, double>) value = number(field.name, value, field.range);
      if constexpr (Worded<Value>) value = word(field.name, value);
    });
    return spec;
  }
  SeatSpec seat() {
    only({"type", "id", "for"});
    return {name("id"), {}, uses()};
  }
  /// One to sit is a seat.
  Markup place() {
    only({"type", "id", "posture", "for"});
    const std::string id = name("id"), posture = value_.contains("posture") ? name("posture") : "";
    const std::vector<std::string> postures{"sit", "lie", "stand"};
    if (posture == "sit") return SeatSpec{id, {}, uses()};
    for (const auto& [word, meaning] : Words<PlacePosture>::all) {
      if (posture == word) return PlaceSpec{id, meaning, {}, uses()};
    }
    if (posture.empty()) {
      error("", "place without 'posture'; known are sit, lie and stand");
    } else {
      error("/posture", "'posture' can't be '" + posture + "'" + near_or_all(posture, postures));
    }
    return PlaceSpec{};
  }
  /// A word, or a list of them.
  std::vector<std::string> uses() {
    std::vector<std::string> found;
    if (!value_.contains("for")) return found;
    const json& given = value_["for"];
    const json list = given.is_array() ? given : json::array({given});
    for (const json& word : list) {
      if (!word.is_string()) return error("/for", "'for' must be a word or a list of words"), found;
      found.push_back(word.get<std::string>());
      const std::string fault = use_fault(found.back());
      if (!fault.empty()) error("/for", "'for': " + fault);
    }
    return found;
  }
  mark::Floor floor() {
    only({"type", "polygon_xz_m", "occludes"});
    return {outline("a floor", mark::Occludes::yes)};
  }
  mark::Area area() {
    only({"type", "id", "polygon_xz_m", "occludes"});
    return {outline("an area", mark::Occludes::no), name("id")};
  }
  mark::Outlined outline(const std::string& what, mark::Occludes otherwise) {
    mark::Outlined result{std::nullopt, otherwise};
    if (value_.contains("occludes")) {
      if (!value_["occludes"].is_boolean()) error("/occludes", "'occludes' must be true or false");
      result.occludes = value_["occludes"] == false ? mark::Occludes::no : mark::Occludes::yes;
    }
    if (value_.contains("polygon_xz_m")) result.polygon = polygon();
    if (!result.polygon && !has_mesh()) error("", what + " needs a mesh at its node, or 'polygon_xz_m'");
    if (value_.contains("occludes") && !has_mesh()) {
      const std::string& name = given_.place.label;
      warnings_.add("occludes", given_.place.where("/occludes"), name,
                    name + ": 'occludes' has no effect without a mesh at the node: no ray ends at a polygon");
    }
    return result;
  }
  mark::Surface surface() {
    only({"type", "temperature_c"});
    if (!value_.contains("temperature_c") && !value_.contains("as_meant"))
      error("", "surface without 'temperature_c' or 'as_meant'");
    if (!has_mesh()) error("", "a surface needs a mesh at its node");
    if (!value_.contains("temperature_c")) return {};
    return {number("temperature_c", 0.0, accepted::surface_c)};
  }
  mark::Ignore ignore() {
    only({"type"});
    return {};
  }

  void only(std::vector<std::string> keys) {
    keys.emplace_back("as_meant");
    keys.insert(keys.end(), given_.other_keys.begin(), given_.other_keys.end());
    for (const auto& [key, unused] : value_.items()) {
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      error_at(given_.place.where_key('/' + key), "unknown key '" + key + "'" + did_you_mean(key, keys));
    }
  }

  /// Ids become names of columns, models names of files.
  std::string name(const char* key) {
    if (!value_.contains(key)) return error("", value_["type"].get<std::string>() + " without '" + key + "'"), "";
    const std::string pointer = std::string("/") + key;
    if (!value_[key].is_string()) return error(pointer, std::string("'") + key + "' must be a text"), "";
    const auto text = value_[key].get<std::string>();
    const std::string fault = name_fault(text);
    if (!fault.empty()) error(pointer, std::string("'") + key + "' is " + shortened(value_[key].dump()) + "; " + fault);
    return text;
  }

  /// Of what the key ends in.
  static std::string unit_of(std::string_view key) {
    return key.ends_with("_deg")     ? " of degrees"
           : key.ends_with("_s")     ? " of seconds"
           : key.ends_with("_share") ? " of parts of 1"
           : key.ends_with("_c")     ? " of degrees Celsius"
           : key.ends_with("_m")     ? " of metres"
                                     : "";
  }

  template <Worded Enum>
  Enum word(const char* key, Enum otherwise) {
    if (!value_.contains(key)) return otherwise;
    std::vector<std::string> known;
    for (const auto& [text, meaning] : Words<Enum>::all) {
      if (value_[key] == text) return meaning;
      known.emplace_back(text);
    }
    const std::string given = value_[key].is_string() ? value_[key].template get<std::string>() : "";
    error(std::string("/") + key, std::string("'") + key + "' is " + shortened(value_[key].dump()) + ", not one of " +
                                      pirsim::joined(known, ", ") + did_you_mean(given, known));
    return otherwise;
  }

  double number(const char* key, double otherwise, const NumberRange& range) {
    if (!value_.contains(key)) return otherwise;
    if (value_[key].is_number() && range.holds(value_[key].get<double>())) return value_[key].get<double>();
    const auto end = [](const char* word, double v) { return std::isfinite(v) ? word + json(v).dump() : ""; };
    error(std::string("/") + key, std::string("'") + key + "' must be a number" + unit_of(key) +
                                      end(" above ", range.above) + end(" from ", range.min) + end(" to ", range.max));
    return otherwise;
  }

  std::vector<Vec2> polygon() {
    const json& points = value_["polygon_xz_m"];
    std::vector<Vec2> result;
    if (!points.is_array() || points.size() < 3) {
      return error("/polygon_xz_m", "'polygon_xz_m' must be an array of at least three points [x, z]"), result;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const json& p = points[i];
      if (p.is_array() && p.size() == 2 && p[0].is_number() && p[1].is_number()) {
        result.emplace_back(p[0].get<double>(), p[1].get<double>());
      } else {
        error("/polygon_xz_m/" + std::to_string(i), "a point of 'polygon_xz_m' must be two numbers [x, z]");
      }
    }
    return result;
  }

  [[nodiscard]] bool has_mesh() const { return given_.bearer == GivenMark::Bearer::with_mesh; }
  void error(const std::string& member, const std::string& message) { error_at(given_.place.where(member), message); }
  void error_at(Where where, const std::string& message) {
    faulty_ = true;
    faults_.error(std::move(where), given_.place.label + ": " + message);
  }

  const GivenMark& given_;
  const json& value_;
  Diagnostics& faults_;
  GroupedWarnings& warnings_;
  bool faulty_ = false;
};

}  // namespace

std::vector<std::string> mark_types() {
  return {"sensor", "seat", "place", "entrance", "door", "floor", "area", "surface", "ignore"};
}

std::optional<NodeMark> read_mark(const GivenMark& given, Diagnostics& faults, GroupedWarnings& warnings) {
  return MarkupReader(given, faults, warnings).read();
}

const mark::Outlined* outlined(const Markup* markup) {
  if (const auto* floor = std::get_if<mark::Floor>(markup)) return floor;
  return std::get_if<mark::Area>(markup);
}

std::optional<NodeMark> read_markup(const GltfDocument& document, int node, Diagnostics& faults,
                                    GroupedWarnings& warnings) {
  const auto index = static_cast<std::size_t>(node);
  const json& bearer = document.text.root()["nodes"][index];
  const auto extras = bearer.find("extras");
  if (extras == bearer.end() || !extras->is_object() || !extras->contains("pirsim")) return std::nullopt;
  const std::string pointer = "/nodes/" + std::to_string(node) + "/extras/pirsim";
  GivenMark given{(*extras)["pirsim"],
                  {node_label(document.model, node),
                   [&document, pointer](const std::string& member) { return document.text.where(pointer + member); },
                   [&document, pointer](const std::string& key) { return document.text.where_key(pointer + key); }},
                  document.model.nodes[index].mesh < 0 ? GivenMark::Bearer::plain : GivenMark::Bearer::with_mesh};
  if (!given.value.is_string()) return read_mark(given, faults, warnings);
  // Editors such as Blender offer texts as custom properties, so the object may come as one.
  const auto text = given.value.get<std::string>();
  auto parsed = parse_json(text);
  if (const auto* fault = std::get_if<JsonFault>(&parsed)) {
    const bool single = text.find('\'') != std::string::npos;
    faults.error(given.place.where(""),
                 given.place.label + ": the text at 'pirsim' is " + fault->message +
                     (single ? "; JSON's quotes are double: {\"type\": \"seat\", \"id\": \"S1\"}" : ""));
    return std::nullopt;
  }
  given.value = std::get<json>(std::move(parsed));
  return read_mark(given, faults, warnings);
}

void warn_of_near_marks(const GltfDocument& document, int node, GroupedWarnings& warnings) {
  const json& given = document.text.root()["nodes"][static_cast<std::size_t>(node)];
  const std::string pointer = "/nodes/" + std::to_string(node);
  const auto warn = [&](const std::string& key, const std::string& message) {
    const std::string name = node_label(document.model, node);
    warnings.add("near mark", document.text.where_key(pointer + key), name, name + ": " + message);
  };
  if (given.contains("pirsim")) warn("/pirsim", "'pirsim' is not read here: it must be in the node's 'extras'");
  const auto extras = given.find("extras");
  if (extras == given.end() || !extras->is_object() || extras->contains("pirsim")) return;
  for (const auto& [key, unused] : extras->items()) {
    if (!did_you_mean(key, {"pirsim"}).empty()) {
      return warn("/extras/" + key, "'" + key + "' is not read as a mark: its name is 'pirsim'");
    }
  }
  const auto type = extras->find("type");
  if (type == extras->end() || !type->is_string()) return;
  const auto types = mark_types();
  if (std::ranges::find(types, type->get<std::string>()) == types.end()) return;
  warn("/extras/type", "'type' is not read here: a mark's keys must be in extras.pirsim, {\"pirsim\": {\"type\": " +
                           shortened(type->dump()) + ", ...}}");
}

}  // namespace pirsim::io::detail
