#include "io/read/gltf_document.hpp"

#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <utility>

#include "core/text.hpp"
#include "io/files/input.hpp"
#include "io/read/file_kinds.hpp"

namespace pirsim::io::detail {
namespace {

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
  if (!fs::is_regular_file(target)) return "is not a regular file";
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

}  // namespace

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

}  // namespace pirsim::io::detail
