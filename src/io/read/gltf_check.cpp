#include <array>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "core/text.hpp"
#include "io/read/gltf_document.hpp"

namespace pirsim::io::detail {
namespace {

using nlohmann::json;

enum class Kind { text, flag, count, index, indices, numbers, object };
enum class Need { optional, required };

struct Rule {
  const char* key;
  Kind kind;
  Need need = Need::optional;
  const char* refers_to = "";  ///< top-level array that an index counts in
  std::size_t size = 0;        ///< how many numbers
};

constexpr std::array scene_rules{Rule{"nodes", Kind::indices, Need::optional, "nodes"}};
constexpr std::array node_rules{
    Rule{"name", Kind::text},
    Rule{"mesh", Kind::index, Need::optional, "meshes"},
    Rule{"children", Kind::indices, Need::optional, "nodes"},
    Rule{"matrix", Kind::numbers, Need::optional, "", 16},
    Rule{"translation", Kind::numbers, Need::optional, "", 3},
    Rule{"rotation", Kind::numbers, Need::optional, "", 4},
    Rule{"scale", Kind::numbers, Need::optional, "", 3},
    Rule{"extensions", Kind::object},
};
constexpr std::array visibility_rules{Rule{"visible", Kind::flag}};
constexpr std::array mesh_rules{Rule{"name", Kind::text}};
constexpr std::array primitive_rules{
    Rule{"attributes", Kind::object, Need::required},
    Rule{"indices", Kind::index, Need::optional, "accessors"},
    Rule{"material", Kind::count},
    Rule{"mode", Kind::count},
};
constexpr std::array accessor_rules{
    Rule{"bufferView", Kind::index, Need::optional, "bufferViews"},
    Rule{"byteOffset", Kind::count},
    Rule{"componentType", Kind::count, Need::required},
    Rule{"normalized", Kind::flag},
    Rule{"count", Kind::count, Need::required},
    Rule{"type", Kind::text, Need::required},
    Rule{"sparse", Kind::object},
};
constexpr std::array sparse_rules{
    Rule{"count", Kind::count, Need::required},
    Rule{"indices", Kind::object, Need::required},
    Rule{"values", Kind::object, Need::required},
};
constexpr std::array sparse_indices_rules{
    Rule{"bufferView", Kind::index, Need::required, "bufferViews"},
    Rule{"byteOffset", Kind::count},
    Rule{"componentType", Kind::count, Need::required},
};
constexpr std::array sparse_values_rules{
    Rule{"bufferView", Kind::index, Need::required, "bufferViews"},
    Rule{"byteOffset", Kind::count},
};
constexpr std::array view_rules{
    Rule{"buffer", Kind::index, Need::required, "buffers"},
    Rule{"byteOffset", Kind::count},
    Rule{"byteLength", Kind::count, Need::required},
    Rule{"byteStride", Kind::count},
};
constexpr std::array buffer_rules{
    Rule{"byteLength", Kind::count, Need::required},
    Rule{"uri", Kind::text},
};

class StructureCheck {
 public:
  StructureCheck(const JsonText& text, Diagnostics& faults) : text_(text), faults_(faults) {}

  /// Every element of a top-level array is an object that keeps the rules.
  void each(const char* collection, std::span<const Rule> rules) {
    const std::string pointer = std::string("/") + collection;
    if (!text_.root().contains(collection)) return;
    const json& array = text_.root()[collection];
    if (!array.is_array()) return fault(pointer, std::string("'") + collection + "' must be an array");
    for (std::size_t i = 0; i < array.size(); ++i) object(array[i], pointer + '/' + std::to_string(i), rules);
  }

  void primitives() {
    for (const auto& [mesh, pointer] : objects("meshes")) {
      if (!mesh->contains("primitives") || !(*mesh)["primitives"].is_array()) {
        fault(pointer, "a mesh needs an array of 'primitives'");
        continue;
      }
      const json& array = (*mesh)["primitives"];
      for (std::size_t i = 0; i < array.size(); ++i) {
        const std::string place = pointer + "/primitives/" + std::to_string(i);
        object(array[i], place, primitive_rules);
        if (!array[i].is_object() || !array[i].contains("attributes")) continue;
        for (const auto& [name, accessor] : array[i]["attributes"].items()) {
          index(accessor, place + "/attributes/" + name, "accessors");
        }
      }
    }
  }

  void sparse() {
    for (const auto& [accessor, pointer] : objects("accessors")) {
      if (!accessor->contains("sparse") || !(*accessor)["sparse"].is_object()) continue;
      const json& part = (*accessor)["sparse"];
      object(part, pointer + "/sparse", sparse_rules);
      if (part.contains("indices")) object(part["indices"], pointer + "/sparse/indices", sparse_indices_rules);
      if (part.contains("values")) object(part["values"], pointer + "/sparse/values", sparse_values_rules);
    }
  }

  void visibility() {
    for (const auto& [node, pointer] : objects("nodes")) {
      const auto extensions = node->find("extensions");
      if (extensions == node->end() || !extensions->is_object() || !extensions->contains(visibility_extension))
        continue;
      object((*extensions)[visibility_extension], pointer + "/extensions/" + visibility_extension, visibility_rules);
    }
  }

  void default_scene() {
    if (text_.root().contains("scene")) index(text_.root()["scene"], "/scene", "scenes");
  }

 private:
  struct Element {
    const json* value;
    std::string pointer;
  };

  std::vector<Element> objects(const char* collection) const {
    std::vector<Element> found;
    const auto array = text_.root().find(collection);
    if (array == text_.root().end() || !array->is_array()) return found;
    for (std::size_t i = 0; i < array->size(); ++i) {
      if ((*array)[i].is_object()) {
        found.push_back({&(*array)[i], std::string("/") + collection + '/' + std::to_string(i)});
      }
    }
    return found;
  }

  void object(const json& value, const std::string& pointer, std::span<const Rule> rules) {
    if (!value.is_object()) return fault(pointer, "must be an object");
    for (const Rule& rule : rules) {
      const auto member = value.find(rule.key);
      if (member != value.end()) {
        member_of_kind(*member, pointer + '/' + rule.key, rule);
      } else if (rule.need == Need::required) {
        fault(pointer, std::string("'") + rule.key + "' is missing");
      }
    }
  }

  void member_of_kind(const json& value, const std::string& pointer, const Rule& rule) {
    const std::string key = std::string("'") + rule.key + "' ";
    switch (rule.kind) {
      case Kind::text:
        return text(value, pointer, key);
      case Kind::flag:
        if (!value.is_boolean()) fault(pointer, key + "must be true or false");
        return;
      case Kind::object:
        if (!value.is_object()) fault(pointer, key + "must be an object");
        return;
      case Kind::count:
        return count(value, pointer, key);
      case Kind::index:
        return index(value, pointer, rule.refers_to);
      case Kind::indices:
        return indices(value, pointer, rule);
      case Kind::numbers:
        return numbers(value, pointer, rule);
    }
  }

  void text(const json& value, const std::string& pointer, const std::string& key) {
    if (!value.is_string()) return fault(pointer, key + "must be a text");
    const std::string found = invisible_character(value.get_ref<const std::string&>(), Lines::one);
    if (!found.empty()) fault(pointer, key + "contains " + found);
  }

  void count(const json& value, const std::string& pointer, const std::string& key) {
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    const bool whole = value.is_number_integer() || value.is_number_unsigned();
    if (!whole || value < 0) return fault(pointer, key + "must be a whole number, 0 or more");
    if (value > most) fault(pointer, key + "is too large: " + value.dump() + " (at most " + std::to_string(most) + ")");
  }

  void index(const json& value, const std::string& pointer, const char* refers_to) {
    const auto array = text_.root().find(refers_to);
    const std::size_t size = array == text_.root().end() ? 0 : array->size();
    const bool whole = value.is_number_integer() || value.is_number_unsigned();
    if (!whole || value < 0) return fault(pointer, std::string("must be an index into '") + refers_to + "'");
    if (value >= size) {
      fault(pointer,
            "index " + value.dump() + " is out of range: the file has " + std::to_string(size) + ' ' + refers_to);
    }
  }

  void indices(const json& value, const std::string& pointer, const Rule& rule) {
    if (!value.is_array()) return fault(pointer, std::string("'") + rule.key + "' must be an array of indices");
    for (std::size_t i = 0; i < value.size(); ++i) index(value[i], pointer + '/' + std::to_string(i), rule.refers_to);
  }

  void numbers(const json& value, const std::string& pointer, const Rule& rule) {
    const std::string wanted = std::string("'") + rule.key + "' must be " + std::to_string(rule.size) + " numbers";
    if (!value.is_array() || value.size() != rule.size) return fault(pointer, wanted);
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (!value[i].is_number()) return fault(pointer + '/' + std::to_string(i), wanted);
    }
  }

  void fault(const std::string& pointer, std::string message) {
    if (++n_faults_ > max_faults) return;
    faults_.error(text_.where(pointer), shortened(pointer) + ": " + std::move(message));
  }

  const JsonText& text_;
  Diagnostics& faults_;
  std::size_t n_faults_ = 0;
};

}  // namespace

void check_structure(const JsonText& text, Diagnostics& faults) {
  StructureCheck check(text, faults);
  check.each("scenes", scene_rules);
  check.each("nodes", node_rules);
  check.each("meshes", mesh_rules);
  check.each("accessors", accessor_rules);
  check.each("bufferViews", view_rules);
  check.each("buffers", buffer_rules);
  check.primitives();
  check.sparse();
  check.visibility();
  check.default_scene();
}

}  // namespace pirsim::io::detail
