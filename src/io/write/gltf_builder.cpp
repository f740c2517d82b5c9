#include "io/write/gltf_builder.hpp"

#include <algorithm>
#include <exception>
#include <glm/vec3.hpp>
#include <sstream>
#include <utility>

#include "io/files/atomic_file.hpp"

namespace pirsim::io {
namespace {

constexpr int no_target = 0;          ///< of arrays that aren't a mesh's
constexpr std::size_t alignment = 4;  ///< bytes; of every component type that is used

std::vector<float> flattened(const std::vector<Vec3>& values) {
  std::vector<float> flat;
  flat.reserve(3 * values.size());
  for (const Vec3& v : values) {
    for (int axis = 0; axis < 3; ++axis) flat.push_back(static_cast<float>(v[axis]));
  }
  return flat;
}

int index_of_last(std::size_t size) { return static_cast<int>(size) - 1; }

}  // namespace

GltfBuilder::GltfBuilder(const std::string& title) {
  model_.asset.version = "2.0";
  model_.asset.generator = "pirsim";
  model_.defaultScene = 0;
  model_.scenes.emplace_back().name = title;
}

int GltfBuilder::add_positions(const std::vector<Vec3>& positions) {
  return add_floats(flattened(positions), TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
}

int GltfBuilder::add_normals(const std::vector<Vec3>& normals) { return add_positions(normals); }

int GltfBuilder::add_indices(const std::vector<std::uint32_t>& indices) {
  tinygltf::Accessor accessor{};
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  accessor.type = TINYGLTF_TYPE_SCALAR;
  accessor.count = indices.size();
  return add_accessor(indices.data(), indices.size() * sizeof(std::uint32_t), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                      std::move(accessor));
}

int GltfBuilder::add_key_times(const std::vector<double>& seconds) {
  return add_floats({seconds.begin(), seconds.end()}, TINYGLTF_TYPE_SCALAR, no_target);
}

int GltfBuilder::add_track(const std::vector<Vec3>& values) {
  return add_floats(flattened(values), TINYGLTF_TYPE_VEC3, no_target);
}

int GltfBuilder::add_track(const std::vector<Quat>& values) {
  std::vector<float> flat;
  flat.reserve(4 * values.size());
  for (const Quat& q : values) {
    for (const double component : {q.x, q.y, q.z, q.w}) flat.push_back(static_cast<float>(component));
  }
  return add_floats(flat, TINYGLTF_TYPE_VEC4, no_target);
}

int GltfBuilder::add_floats(const std::vector<float>& values, int type, int target) {
  const auto width = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
  tinygltf::Accessor accessor{};
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
  accessor.type = type;
  accessor.count = values.size() / width;
  for (std::size_t component = 0; component < width; ++component) {
    float least = values[component];
    float most = least;
    for (std::size_t i = component; i < values.size(); i += width) {
      least = std::min(least, values[i]);
      most = std::max(most, values[i]);
    }
    accessor.minValues.push_back(static_cast<double>(least));
    accessor.maxValues.push_back(static_cast<double>(most));
  }
  return add_accessor(values.data(), values.size() * sizeof(float), target, std::move(accessor));
}

int GltfBuilder::add_accessor(const void* data, std::size_t bytes, int target, tinygltf::Accessor accessor) {
  if (model_.buffers.empty()) model_.buffers.emplace_back();
  std::vector<unsigned char>& buffer = model_.buffers.front().data;
  static_assert(sizeof(float) == alignment && sizeof(std::uint32_t) == alignment);
  tinygltf::BufferView& view = model_.bufferViews.emplace_back();
  view.buffer = 0;
  view.byteOffset = buffer.size();
  view.byteLength = bytes;
  view.target = target;
  const auto* begin = static_cast<const unsigned char*>(data);
  buffer.insert(buffer.end(), begin, begin + bytes);
  accessor.bufferView = index_of_last(model_.bufferViews.size());
  model_.accessors.push_back(std::move(accessor));
  return index_of_last(model_.accessors.size());
}

int GltfBuilder::add_material(const std::string& name, const Vec3& colour, double opacity) {
  tinygltf::Material& material = model_.materials.emplace_back();
  material.name = name;
  material.pbrMetallicRoughness.baseColorFactor = {colour.x, colour.y, colour.z, opacity};
  material.pbrMetallicRoughness.metallicFactor = 0.0;
  material.pbrMetallicRoughness.roughnessFactor = 0.9;
  material.alphaMode = opacity < 1.0 ? "BLEND" : "OPAQUE";
  material.doubleSided = true;
  return index_of_last(model_.materials.size());
}

int GltfBuilder::add_mesh(const std::string& name, const tinygltf::Primitive& primitive) {
  tinygltf::Mesh& mesh = model_.meshes.emplace_back();
  mesh.name = name;
  mesh.primitives.push_back(primitive);
  return index_of_last(model_.meshes.size());
}

int GltfBuilder::add_mesh(const TriMesh& mesh, int material) {
  std::vector<std::uint32_t> indices;
  for (const auto& triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] = add_positions(mesh.positions);
  primitive.indices = add_indices(indices);
  primitive.material = material;
  return add_mesh(mesh.name, primitive);
}

int GltfBuilder::add_node(tinygltf::Node node, int parent) {
  model_.nodes.push_back(std::move(node));
  const int index = index_of_last(model_.nodes.size());
  auto& siblings = parent < 0 ? model_.scenes.front().nodes : model_.nodes[static_cast<std::size_t>(parent)].children;
  siblings.push_back(index);
  return index;
}

void GltfBuilder::animate(int node, const std::string& path, int key_times, int track,
                          const std::string& interpolation) {
  if (model_.animations.empty()) model_.animations.emplace_back().name = model_.scenes.front().name;
  tinygltf::Animation& animation = model_.animations.front();
  tinygltf::AnimationSampler& sampler = animation.samplers.emplace_back();
  sampler.input = key_times;
  sampler.output = track;
  sampler.interpolation = interpolation;
  tinygltf::AnimationChannel& channel = animation.channels.emplace_back();
  channel.sampler = index_of_last(animation.samplers.size());
  channel.target_node = node;
  channel.target_path = path;
}

std::string GltfBuilder::bytes(Container container, const Where& where, const std::string& what) const {
  std::ostringstream out;
  const bool binary = container == Container::binary;
  try {
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, out, !binary, binary);
  } catch (const std::exception& fault) {  // the JSON writer refuses names that aren't UTF-8
    throw Error(ErrorCode::usage, where, "the " + what + " can't be written as glTF: " + fault.what());
  }
  return std::move(out).str();
}

void GltfBuilder::write(const std::filesystem::path& file, const std::string& what) const {
  const Container container = file.extension() == ".glb" ? Container::binary : Container::text;
  write_text_file(file, bytes(container, Where{file.string()}, what));
}

tinygltf::Value pirsim_extras(const std::string& type, tinygltf::Value::Object members) {
  members["type"] = tinygltf::Value(type);
  return tinygltf::Value(tinygltf::Value::Object{{"pirsim", tinygltf::Value(std::move(members))}});
}

}  // namespace pirsim::io
