// Small glTF files for tests, built accessor by accessor.
#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

namespace pirsim::test {

using nlohmann::json;

using ::TemporaryFolder;

inline std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[word >> (18U - 6U * k) & 63U] : '=';
  }
  return text;
}

template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

enum Component { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

struct GltfBuilder {
  json root = {{"asset", {{"version", "2.0"}}},
               {"scene", 0},
               {"scenes", {{{"nodes", json::array()}}}},
               {"nodes", json::array()}};
  std::string buffer;

  int add(const char* collection, json element) {
    root[collection].push_back(std::move(element));
    return static_cast<int>(root[collection].size()) - 1;
  }
  int view(const std::string& bytes, int stride = 0) {
    buffer.resize((buffer.size() + 3) / 4 * 4);
    json element = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) element["byteStride"] = stride;
    buffer += bytes;
    return add("bufferViews", element);
  }
  int accessor(int buffer_view, const char* type, Component component, std::size_t count,
               const json& more = json::object()) {
    json element = {{"bufferView", buffer_view}, {"type", type}, {"componentType", component}, {"count", count}};
    element.update(more);
    return add("accessors", element);
  }
  int positions(const std::vector<float>& xyz) { return accessor(view(bytes_of(xyz)), "VEC3", f32, xyz.size() / 3); }
  template <typename T>
  int indices(const std::vector<T>& values) {
    const Component component = sizeof(T) == 1 ? u8 : sizeof(T) == 2 ? u16 : u32;
    return accessor(view(bytes_of(values)), "SCALAR", component, values.size());
  }
  int mesh(int position_accessor, int index_accessor = -1, int mode = 4) {
    json primitive = {{"attributes", {{"POSITION", position_accessor}}}, {"mode", mode}};
    if (index_accessor >= 0) primitive["indices"] = index_accessor;
    return add("meshes", {{"name", "shape"}, {"primitives", {primitive}}});
  }
  /// A node of the scene; `more` holds translation and so on.
  int node(const std::string& name, const json& more = json::object()) {
    const int index = child(name, more);
    root["scenes"][0]["nodes"].push_back(index);
    return index;
  }
  int child(const std::string& name, const json& more = json::object()) {
    json element = {{"name", name}};
    element.update(more);
    return add("nodes", element);
  }
  static json marked(const json& mark, json more = json::object()) {
    more["extras"] = {{"pirsim", mark}};
    return more;
  }
  void floor() { node("floor", marked({{"type", "floor"}, {"polygon_xz_m", {{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}}})); }

  [[nodiscard]] std::string text() const {
    json whole = root;
    if (!buffer.empty()) {
      whole["buffers"] = {
          {{"byteLength", buffer.size()}, {"uri", "data:application/octet-stream;base64," + base64(buffer)}}};
    }
    return whole.dump(1);
  }
  [[nodiscard]] std::string text_with_file(const std::string& uri) const {
    json whole = root;
    whole["buffers"] = {{{"byteLength", buffer.size()}, {"uri", uri}}};
    return whole.dump(1);
  }
  [[nodiscard]] std::string binary() const {
    json whole = root;
    whole["buffers"] = {{{"byteLength", buffer.size()}}};
    std::string text = whole.dump(), data = buffer;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4, '\0');
    const auto words = [](std::vector<std::uint32_t> values) { return bytes_of(values); };
    return "glTF" + words({2, static_cast<std::uint32_t>(28 + text.size() + data.size())}) +
           words({static_cast<std::uint32_t>(text.size()), 0x4E4F534A}) + text +
           words({static_cast<std::uint32_t>(data.size()), 0x004E4942}) + data;
  }
  [[nodiscard]] SceneSpec read() const {
    const TemporaryFolder folder;
    return io::read_scene(folder.write("room.gltf", text()), {{pirsim::test::data_dir() / "sensors"}});
  }
};

/// Message of the Error that reading throws, or "accepted".
template <std::invocable Read>
std::string fault_of(Read read) {
  try {
    static_cast<void>(read());
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

inline void check_vector(const Vec3& given, const Vec3& expected) {
  INFO(given.x << ' ' << given.y << ' ' << given.z);
  CHECK(glm::distance(given, expected) < 1e-9);
}

}  // namespace pirsim::test
