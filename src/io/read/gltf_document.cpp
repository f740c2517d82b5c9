#include "io/read/gltf_document.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/text.hpp"
#include "io/files/input.hpp"

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

}  // namespace pirsim::io::detail
