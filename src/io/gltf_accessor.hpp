// Elements of one accessor: plain, interleaved, sparse, quantised. Private to io.
#pragma once

#include <cstdint>
#include <vector>

#include "io/gltf_document.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::io::detail {

/// Reads accessors after checking type, component type, count and every byte range. A fault is added to the
/// diagnostics and gives an empty result; nothing is allocated before the bytes are known to be there.
class AccessorReader {
 public:
  AccessorReader(const GltfDocument& document, Diagnostics& faults) : document_(document), faults_(faults) {}

  /// VEC3 of floats, or of integers (KHR_mesh_quantization), finite.
  [[nodiscard]] std::vector<Vec3> positions(int accessor);
  /// SCALAR of unsigned integers.
  [[nodiscard]] std::vector<std::uint32_t> indices(int accessor);
  [[nodiscard]] std::size_t count(int accessor) const;

 private:
  /// Bytes of `count` elements, `stride` apart.
  struct Range {
    const unsigned char* data = nullptr;
    std::size_t stride = 0;
  };
  [[nodiscard]] bool locate(int view, std::size_t byte_offset, std::size_t element_size, std::size_t count,
                            const std::string& pointer, Range& range);
  [[nodiscard]] bool check_type(int accessor, int type, const char* what);
  [[nodiscard]] bool read_components(int accessor, std::size_t n_components, std::vector<double>& values);
  [[nodiscard]] bool apply_sparse(int accessor, std::size_t n_components, std::vector<double>& values);
  bool fault(const std::string& pointer, const std::string& message);

  const GltfDocument& document_;
  Diagnostics& faults_;
};

}  // namespace pirsim::io::detail
