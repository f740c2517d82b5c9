#include "files/read/gltf_document.hpp"

#include <tiny_gltf.h>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "files/disk/file.hpp"
#include "model/core/text.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io::detail {
namespace {

using nlohmann::json;

/// Extensions that may be required: they are read, or they change neither the geometry that occludes nor the hierarchy.
bool is_harmless(const std::string& extension) {
  for (const char* prefix : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "EXT_lights_"}) {
    if (extension.starts_with(prefix)) return true;
  }
  return extension == "KHR_mesh_quantization" || extension == visibility_extension;
}

void check_asset(const JsonText& text, Diagnostics& faults) {
  const auto asset = text.root().find("asset");
  const bool has_version =
      asset != text.root().end() && asset->is_object() && asset->contains("version") && (*asset)["version"].is_string();
  if (!has_version) {
    faults.error(text.where(""), "'asset' with a 'version' is missing: this is no glTF 2.0 file");
  } else if (const auto version = (*asset)["version"].get<std::string>(); !version.starts_with("2.")) {
    faults.error(text.where("/asset/version"), "glTF version '" + version + "' is not supported; only 2.x is");
  }
}

void check_extensions(const JsonText& text, Diagnostics& faults) {
  const auto required = text.root().find("extensionsRequired");
  if (required != text.root().end() && required->is_array()) {
    for (std::size_t i = 0; i < required->size(); ++i) {
      const json& name = (*required)[i];
      if (name.is_string() && is_harmless(name.get<std::string>())) continue;
      faults.error(
          text.where("/extensionsRequired/" + std::to_string(i)),
          "the file requires the extension " + shortened(name.dump()) + ", which is not supported; export it without");
    }
  }
  const auto used = text.root().find("extensionsUsed");
  if (used == text.root().end() || !used->is_array()) return;
  for (std::size_t i = 0; i < used->size(); ++i) {
    if ((*used)[i] == "EXT_mesh_gpu_instancing") {
      faults.warning(text.where("/extensionsUsed/" + std::to_string(i)),
                     "the copies that EXT_mesh_gpu_instancing makes are not read; export plain nodes");
    }
  }
}

/// Of a member that was checked, if it is there.
template <typename T>
void take(const json& object, const char* key, T& target) {
  if (const auto member = object.find(key); member != object.end()) target = member->get<T>();
}

tinygltf::Node node_of(const json& given) {
  tinygltf::Node node;
  take(given, "name", node.name);
  take(given, "mesh", node.mesh);
  take(given, "children", node.children);
  take(given, "matrix", node.matrix);
  take(given, "translation", node.translation);
  take(given, "rotation", node.rotation);
  take(given, "scale", node.scale);
  return node;
}

tinygltf::Mesh mesh_of(const json& given) {
  tinygltf::Mesh mesh;
  take(given, "name", mesh.name);
  for (const json& part : given["primitives"]) {
    tinygltf::Primitive& primitive = mesh.primitives.emplace_back();
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    take(part, "attributes", primitive.attributes);
    take(part, "indices", primitive.indices);
    take(part, "material", primitive.material);
    take(part, "mode", primitive.mode);
    if (part.contains("targets")) primitive.targets.resize(part["targets"].size());
  }
  return mesh;
}

/// -1 for what glTF doesn't know.
int accessor_type(const std::string& name) {
  static const std::map<std::string, int> types{{"SCALAR", TINYGLTF_TYPE_SCALAR}, {"VEC2", TINYGLTF_TYPE_VEC2},
                                                {"VEC3", TINYGLTF_TYPE_VEC3},     {"VEC4", TINYGLTF_TYPE_VEC4},
                                                {"MAT2", TINYGLTF_TYPE_MAT2},     {"MAT3", TINYGLTF_TYPE_MAT3},
                                                {"MAT4", TINYGLTF_TYPE_MAT4}};
  const auto known = types.find(name);
  return known == types.end() ? -1 : known->second;
}

tinygltf::Accessor accessor_of(const json& given) {
  tinygltf::Accessor accessor;
  accessor.type = accessor_type(given["type"].get<std::string>());
  take(given, "bufferView", accessor.bufferView);
  take(given, "byteOffset", accessor.byteOffset);
  take(given, "componentType", accessor.componentType);
  take(given, "normalized", accessor.normalized);
  take(given, "count", accessor.count);
  const auto part = given.find("sparse");
  accessor.sparse.isSparse = part != given.end();
  if (!accessor.sparse.isSparse) return accessor;
  auto& sparse = accessor.sparse;
  sparse.indices.byteOffset = sparse.values.byteOffset = 0;
  take(*part, "count", sparse.count);
  take((*part)["indices"], "bufferView", sparse.indices.bufferView);
  take((*part)["indices"], "byteOffset", sparse.indices.byteOffset);
  take((*part)["indices"], "componentType", sparse.indices.componentType);
  take((*part)["values"], "bufferView", sparse.values.bufferView);
  take((*part)["values"], "byteOffset", sparse.values.byteOffset);
  return accessor;
}

tinygltf::BufferView view_of(const json& given) {
  tinygltf::BufferView view;
  take(given, "buffer", view.buffer);
  take(given, "byteOffset", view.byteOffset);
  take(given, "byteLength", view.byteLength);
  take(given, "byteStride", view.byteStride);
  return view;
}

template <typename T, typename Make>
void take_each(const json& root, const char* collection, std::vector<T>& target, Make make) {
  const auto array = root.find(collection);
  if (array == root.end()) return;
  target.reserve(array->size());
  for (const json& element : *array) target.push_back(make(element));
}

/// The parts that pirsim reads, of a document whose structure was checked.
tinygltf::Model model_of(const json& root) {
  tinygltf::Model model;
  take(root, "scene", model.defaultScene);
  take_each(root, "scenes", model.scenes, [](const json& given) {
    tinygltf::Scene scene;
    take(given, "nodes", scene.nodes);
    return scene;
  });
  take_each(root, "nodes", model.nodes, node_of);
  take_each(root, "meshes", model.meshes, mesh_of);
  take_each(root, "accessors", model.accessors, accessor_of);
  take_each(root, "bufferViews", model.bufferViews, view_of);
  return model;
}

std::string label(const char* what, const std::string& name, int index) {
  return what + (name.empty() ? ' ' + std::to_string(index) : " '" + shortened(name) + "'");
}

namespace fs = std::filesystem;

constexpr std::uint32_t chunk_json = 0x4E4F534A;    // "JSON", glTF 2.0 section 4.4
constexpr std::uint32_t chunk_binary = 0x004E4942;  // "BIN\0"

constexpr std::size_t largest_file = 1'000'000'000;  // assumed; tinygltf counts bytes in 32 bits

std::uint32_t little_endian(const std::string& bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= std::uint32_t{static_cast<unsigned char>(bytes[offset + i])} << (8 * i);
  }
  return value;
}

GltfContainer split_binary(const std::string& bytes, const std::string& file) {
  const auto refuse = [&](const std::string& why) { throw Error(ErrorCode::input, {file}, "binary glTF " + why); };
  if (bytes.size() < 20) refuse("is cut short: it has only " + std::to_string(bytes.size()) + " bytes");
  if (const auto version = little_endian(bytes, 4); version != 2) {
    refuse("has version " + std::to_string(version) + "; only version 2 is supported");
  }
  const std::size_t length = little_endian(bytes, 8);
  if (length > bytes.size()) {
    refuse("is cut short: its header announces " + std::to_string(length) + " bytes, the file has " +
           std::to_string(bytes.size()));
  }
  GltfContainer result;
  result.kind = GltfContainer::Kind::binary;
  for (std::size_t at = 12; at + 8 <= length;) {
    const std::size_t size = little_endian(bytes, at);
    const std::uint32_t type = little_endian(bytes, at + 4);
    const bool first = at == 12;
    if (first != (type == chunk_json)) {
      if (first) refuse("doesn't start with a JSON chunk");
      refuse("has more than one JSON chunk");
    }
    at += 8;
    if (size > length - at) refuse("is cut short: a chunk of " + std::to_string(size) + " bytes passes its end");
    if (type == chunk_json) result.json = bytes.substr(at, size);
    if (type == chunk_json && first_not_utf8(result.json)) refuse("has a JSON chunk that isn't UTF-8");
    if (type == chunk_binary && result.binary_chunk.empty()) {
      result.binary_chunk.assign(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                                 bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
    }
    at += size;
  }
  return result;
}

/// By its first character, which may be UTF-16.
bool may_be_json(std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) return true;
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && bytes[first] == '{';
}

std::string percent_decoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto digit = [&](std::size_t k) {
      return k < uri.size() ? std::string("0123456789abcdef").find(static_cast<char>(std::tolower(uri[k])))
                            : std::string::npos;
    };
    if (uri[i] == '%' && digit(i + 1) != std::string::npos && digit(i + 2) != std::string::npos) {
      text += static_cast<char>(16 * digit(i + 1) + digit(i + 2));
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

/// Why the file must not be opened, or nothing.
std::string reason_to_refuse(const std::string& name, const fs::path& folder) {
  const fs::path path(name);
  if (name.find("://") != std::string::npos) return "is not a file in the scene's folder";
  if (path.is_absolute()) return "is an absolute path; buffers must lie in the scene's folder";
  for (const fs::path& part : path) {
    if (part == "..") return "leads out of the scene's folder";
  }
  std::error_code fault;
  const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, fault);
  const fs::path target = fs::canonical(folder / path, fault);
  if (fault) return "can't be found";
  const auto [in_root, in_target] = std::mismatch(root.begin(), root.end(), target.begin(), target.end());
  if (in_root != root.end()) return "is a link that leads out of the scene's folder";
  if (!fs::is_regular_file(target, fault)) return "is not a regular file";
  return {};
}

std::vector<unsigned char> read_external(const std::string& uri, const fs::path& folder, GltfContainer& container,
                                         std::string& fault) {
  const std::string name = percent_decoded(uri);
  if (const std::string why = reason_to_refuse(name, folder); !why.empty()) {
    fault = "buffer file '" + name + "' " + why;
    return {};
  }
  const Input input = read_input(folder / name, largest_file);
  container.files.push_back(input.file());
  return {input.bytes.begin(), input.bytes.end()};
}

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

GltfDocument load_gltf(const std::filesystem::path& file, Diagnostics& remarks) {
  GltfContainer container = read_container(file);
  const bool is_json = container.kind == GltfContainer::Kind::json;
  GltfDocument document{
      file.string(),
      JsonText(file.string(), std::move(container.json), is_json ? JsonText::Places::known : JsonText::Places::unknown),
      {},
      {}};
  Diagnostics faults;
  if (!document.text.root().is_object()) faults.error(document.text.where(""), "glTF must be a JSON object");
  faults.throw_if_errors();
  check_asset(document.text, faults);
  check_extensions(document.text, faults);
  check_structure(document.text, faults);
  faults.throw_if_errors();
  auto buffers = read_buffers(document.text, container, folder_of_input(file), faults);
  faults.throw_if_errors();
  document.model = model_of(document.text.root());
  document.files = std::move(container.files);
  for (auto& bytes : buffers) document.model.buffers.emplace_back().data = std::move(bytes);
  for (const Issue& warning : faults.warnings()) remarks.warning(warning.where, warning.message);
  return document;
}

std::string node_label(const tinygltf::Model& model, int node) {
  return label("node", model.nodes[static_cast<std::size_t>(node)].name, node);
}
std::string mesh_label(const tinygltf::Model& model, int mesh) {
  return label("mesh", model.meshes[static_cast<std::size_t>(mesh)].name, mesh);
}

GltfContainer read_container(const fs::path& file) {
  const Input input = read_input(file, largest_file);
  const std::string& bytes = input.bytes;
  if (bytes.empty()) throw Error(ErrorCode::input, {file.string()}, "the file is empty");
  if (bytes.starts_with("glTF")) {
    GltfContainer container = split_binary(bytes, file.string());
    container.files = {input.file()};
    return container;
  }
  if (!may_be_json(bytes)) {
    const std::string kind = kind_of_text(bytes);
    throw Error(ErrorCode::input, {file.string(), 1, 1},
                "is neither glTF (.gltf, JSON) nor binary glTF (.glb)" + (kind.empty() ? kind : ", but " + kind));
  }
  return {GltfContainer::Kind::json, input.text(), {}, {input.file()}};
}

std::vector<std::vector<unsigned char>> read_buffers(const JsonText& text, GltfContainer& container,
                                                     const fs::path& folder, Diagnostics& faults) {
  std::vector<std::vector<unsigned char>> result;
  const nlohmann::json none = nlohmann::json::array();
  const auto found = text.root().find("buffers");
  const nlohmann::json& buffers = found == text.root().end() ? none : *found;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string pointer = "/buffers/" + std::to_string(i);
    std::vector<unsigned char>& bytes = result.emplace_back();
    std::string fault;
    if (!buffers[i].contains("uri")) {
      if (i == 0 && container.kind == GltfContainer::Kind::binary) {
        bytes = std::move(container.binary_chunk);
      } else {
        fault = "buffer " + std::to_string(i) + " has no 'uri'";
      }
    } else if (const auto uri = buffers[i]["uri"].get<std::string>(); uri.starts_with("data:")) {
      std::string media_type;
      if (!tinygltf::DecodeDataURI(&bytes, media_type, uri, 0, false)) fault = "data: URI can't be decoded";
    } else {
      bytes = read_external(uri, folder, container, fault);
    }
    const auto wanted = buffers[i]["byteLength"].get<std::size_t>();
    if (fault.empty() && bytes.size() < wanted) {
      fault = "buffer " + std::to_string(i) + " is cut short: it has " + std::to_string(bytes.size()) + " of " +
              std::to_string(wanted) + " bytes";
    }
    if (!fault.empty()) faults.error(text.where(pointer + (buffers[i].contains("uri") ? "/uri" : "")), fault);
    if (bytes.size() > wanted) bytes.resize(wanted);
  }
  return result;
}

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

namespace pirsim::io {
namespace {

struct FileKind {
  std::string_view version_key, told;
};
constexpr std::array<FileKind, 9> file_kinds{
    {{"pirsim_script", "a script: `--script` of run, check, preview and others takes it"},
     {"pirsim_walk_test", "a walk test: `pirsim walktest --script` takes it"},
     {"pirsim_coverage", "a coverage study: `pirsim coverage --script` takes it"},
     {"pirsim_placements", "a placement study: `pirsim placements --script` takes it"},
     {"pirsim_nuisance", "a nuisance file: `pirsim reconcile --nuisance` takes it"},
     {"pirsim_recipe", "a recipe: `pirsim dataset` and `pirsim room` take it"},
     {"pirsim_marks", "marks for a scene: `--marks` takes them beside `--scene`"},
     {"pirsim_log", "a map of a log: `pirsim log --map` takes it"},
     {"asset", "a glTF scene: `--scene` takes it"}}};

}  // namespace

std::string kind_of_text(std::string_view text) {
  for (const FileKind& kind : file_kinds) {
    const std::string key = std::string(kind.version_key) + ':';
    if (text.starts_with(key) || text.find('\n' + key) != std::string_view::npos) return std::string(kind.told);
  }
  return {};
}

void refuse_other_kinds(const YamlMap& map, const std::string& version_key) {
  if (map.has(version_key)) return;
  for (const FileKind& kind : file_kinds) {
    const std::string key(kind.version_key);
    if (map.has(key)) throw Error(ErrorCode::input, map.where(key), "this is " + std::string(kind.told));
  }
}

}  // namespace pirsim::io
