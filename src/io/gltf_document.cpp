#include "io/gltf_document.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include "io/gltf_check.hpp"
#include "io/gltf_container.hpp"

namespace pirsim::io::detail {
namespace {

using nlohmann::json;

/// Extensions that may be required because they change neither the geometry that occludes nor the hierarchy.
bool is_harmless(const std::string& extension) {
  for (const char* prefix : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "EXT_lights_"}) {
    if (extension.starts_with(prefix)) return true;
  }
  return extension == "KHR_mesh_quantization";  // integer positions are read
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
      faults.error(text.where("/extensionsRequired/" + std::to_string(i)),
                   "the file requires the extension " + name.dump() + ", which is not supported; export it without");
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

/// Only what is read goes to tinygltf: no images are opened, no buffer is loaded behind our back.
tinygltf::Model parse_structure(const JsonText& text) {
  json reduced = json::object();
  for (const char* key : {"asset", "scene", "scenes", "nodes", "meshes", "accessors", "bufferViews"}) {
    if (text.root().contains(key)) reduced[key] = text.root()[key];
  }
  const std::string dumped = reduced.dump();
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  std::string fault, warning;
  if (!loader.LoadASCIIFromString(&model, &fault, &warning, dumped.data(), static_cast<unsigned>(dumped.size()), "",
                                  tinygltf::NO_REQUIRE)) {
    while (!fault.empty() && fault.back() == '\n') fault.pop_back();
    throw Error(ErrorCode::input, text.where(""), "not a valid glTF: " + fault);
  }
  return model;
}

std::string label(const char* what, std::string name, int index) {
  const auto is_control = [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; };
  std::replace_if(name.begin(), name.end(), is_control, '?');  // messages go to terminals
  return what + (name.empty() ? ' ' + std::to_string(index) : " '" + name + "'");
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
  auto buffers = read_buffers(document.text, container, file.parent_path(), faults);
  faults.throw_if_errors();
  document.model = parse_structure(document.text);
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
