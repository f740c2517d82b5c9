#include "io/read/gltf_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace pirsim::io::detail {
namespace {

/// 0 for anything that glTF doesn't know.
std::size_t component_size(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

template <typename T>
double load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);  // glTF is little-endian, as are all machines that Embree runs on
  return static_cast<double>(value);
}

double load_component(const unsigned char* bytes, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return load<std::int8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return load<std::int16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<std::uint32_t>(bytes);
    default:
      return load<float>(bytes);
  }
}

/// glTF 2.0 section 3.6.2.2: f = c / largest, for signed types no less than -1.
double normalised(double c, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return std::max(c / 127.0, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return c / 255.0;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return std::max(c / 32767.0, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return c / 65535.0;
    default:
      return c;
  }
}

std::string accessor_pointer(int accessor) { return "/accessors/" + std::to_string(accessor); }

}  // namespace

std::size_t AccessorReader::count(int accessor) const {
  return document_.model.accessors[static_cast<std::size_t>(accessor)].count;
}

std::vector<Vec3> AccessorReader::positions(int accessor) {
  std::vector<double> values;
  if (!check_type(accessor, TINYGLTF_TYPE_VEC3, "positions must be VEC3")) return {};
  if (!read_components(accessor, 3, values)) return {};
  std::vector<Vec3> result(values.size() / 3);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = Vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    if (std::isfinite(result[i].x) && std::isfinite(result[i].y) && std::isfinite(result[i].z)) continue;
    fault(accessor_pointer(accessor), "position " + std::to_string(i) + " is not a finite number");
    return {};
  }
  return result;
}

std::vector<std::uint32_t> AccessorReader::indices(int accessor) {
  const tinygltf::Accessor& given = document_.model.accessors[static_cast<std::size_t>(accessor)];
  const bool whole = given.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                     given.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                     given.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (!check_type(accessor, TINYGLTF_TYPE_SCALAR, "indices must be SCALAR")) return {};
  if (!whole || given.normalized) {
    fault(accessor_pointer(accessor), "indices must be unsigned integers of 8, 16 or 32 bit");
    return {};
  }
  std::vector<double> values;
  if (!read_components(accessor, 1, values)) return {};
  std::vector<std::uint32_t> result(values.size());
  std::transform(values.begin(), values.end(), result.begin(), [](double v) { return static_cast<std::uint32_t>(v); });
  return result;
}

bool AccessorReader::check_type(int accessor, int type, const char* what) {
  const tinygltf::Accessor& given = document_.model.accessors[static_cast<std::size_t>(accessor)];
  if (given.type != type) return fault(accessor_pointer(accessor) + "/type", what);
  if (component_size(given.componentType) == 0) {
    return fault(accessor_pointer(accessor) + "/componentType",
                 "component type " + std::to_string(given.componentType) + " is not one of glTF's");
  }
  return true;
}

bool AccessorReader::locate(int view_index, std::size_t byte_offset, std::size_t element_size, std::size_t count,
                            const std::string& pointer, Range& range) {
  const tinygltf::BufferView& view = document_.model.bufferViews[static_cast<std::size_t>(view_index)];
  const std::vector<unsigned char>& buffer = document_.model.buffers[static_cast<std::size_t>(view.buffer)].data;
  const std::string view_name = "buffer view " + std::to_string(view_index);
  // All numbers are below 2^31 (check_structure), so that no sum or product passes 64 bits.
  if (view.byteOffset + view.byteLength > buffer.size()) {
    return fault("/bufferViews/" + std::to_string(view_index), view_name + " ends at byte " +
                                                                   std::to_string(view.byteOffset + view.byteLength) +
                                                                   ", its buffer has " + std::to_string(buffer.size()));
  }
  if (view.byteStride % 4 != 0 || view.byteStride > 252) {  // glTF 2.0 section 5.11.4
    return fault("/bufferViews/" + std::to_string(view_index) + "/byteStride",
                 view_name + ": stride " + std::to_string(view.byteStride) + " is not a multiple of 4 up to 252");
  }
  range.stride = view.byteStride == 0 ? element_size : view.byteStride;
  if (range.stride < element_size) {
    return fault("/bufferViews/" + std::to_string(view_index) + "/byteStride",
                 view_name + ": stride " + std::to_string(range.stride) + " is shorter than an element of " +
                     std::to_string(element_size) + " bytes");
  }
  const std::size_t end = byte_offset + (count - 1) * range.stride + element_size;
  if (end > view.byteLength) {
    return fault(pointer, std::to_string(count) + " elements need " + std::to_string(end) + " bytes, " + view_name +
                              " has " + std::to_string(view.byteLength));
  }
  range.data = buffer.data() + view.byteOffset + byte_offset;
  return true;
}

bool AccessorReader::read_components(int accessor, std::size_t n_components, std::vector<double>& values) {
  const tinygltf::Accessor& given = document_.model.accessors[static_cast<std::size_t>(accessor)];
  const std::string pointer = accessor_pointer(accessor);
  const std::size_t size = component_size(given.componentType);
  if (given.count == 0) return fault(pointer + "/count", "an accessor without elements");
  Range range;
  if (given.bufferView >= 0) {
    if (!locate(given.bufferView, given.byteOffset, size * n_components, given.count, pointer, range)) return false;
  }
  values.assign(given.count * n_components, 0.0);  // without a buffer view all are zero
  for (std::size_t i = 0; range.data != nullptr && i < given.count; ++i) {
    for (std::size_t c = 0; c < n_components; ++c) {
      const double value = load_component(range.data + i * range.stride + c * size, given.componentType);
      values[i * n_components + c] = given.normalized ? normalised(value, given.componentType) : value;
    }
  }
  return !given.sparse.isSparse || apply_sparse(accessor, n_components, values);
}

bool AccessorReader::apply_sparse(int accessor, std::size_t n_components, std::vector<double>& values) {
  const tinygltf::Accessor& given = document_.model.accessors[static_cast<std::size_t>(accessor)];
  const std::string pointer = accessor_pointer(accessor) + "/sparse";
  const auto count = static_cast<std::size_t>(given.sparse.count);
  const int index_type = given.sparse.indices.componentType;
  const std::size_t size = component_size(given.componentType);
  if (count == 0 || count > given.count) {
    return fault(pointer + "/count", "must be between 1 and the accessor's count, " + std::to_string(given.count));
  }
  if (component_size(index_type) == 0 || index_type == TINYGLTF_COMPONENT_TYPE_FLOAT) {
    return fault(pointer + "/indices/componentType", "sparse indices must be unsigned integers");
  }
  Range indices, replacements;
  if (!locate(given.sparse.indices.bufferView, static_cast<std::size_t>(given.sparse.indices.byteOffset),
              component_size(index_type), count, pointer + "/indices", indices) ||
      !locate(given.sparse.values.bufferView, static_cast<std::size_t>(given.sparse.values.byteOffset),
              size * n_components, count, pointer + "/values", replacements)) {
    return false;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const double index = load_component(indices.data + k * indices.stride, index_type);
    if (index < 0.0 || index >= static_cast<double>(given.count)) {
      return fault(pointer + "/indices", "sparse index " + std::to_string(static_cast<long long>(index)) +
                                             " is out of range: the accessor has " + std::to_string(given.count) +
                                             " elements");
    }
    for (std::size_t c = 0; c < n_components; ++c) {
      const double value = load_component(replacements.data + k * replacements.stride + c * size, given.componentType);
      values[static_cast<std::size_t>(index) * n_components + c] =
          given.normalized ? normalised(value, given.componentType) : value;
    }
  }
  return true;
}

bool AccessorReader::fault(const std::string& pointer, const std::string& message) {
  faults_.error(document_.text.where(pointer), pointer + ": " + message);
  return false;
}

}  // namespace pirsim::io::detail
