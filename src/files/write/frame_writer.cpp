#include "files/write/frame_writer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "model/core/text.hpp"

namespace pirsim::io {

std::string frame_file(const std::string& array, const std::string& trial, int replicate) {
  return array + '_' + trial + '_' + std::to_string(replicate) + ".npy";
}

std::string to_npy(const FrameStack& frames) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(frames.times_s.size()) +
                       ", " + std::to_string(frames.rows) + ", " + std::to_string(frames.columns) + "), }";
  constexpr std::size_t preamble = 10, alignment = 64;  // before the header; of the data
  header.append(alignment - 1 - (preamble + header.size()) % alignment, ' ') += '\n';
  std::string bytes = "\x93NUMPY";
  const auto add = [&](std::uint32_t value, int n_bytes) {
    for (int i = 0; i < n_bytes; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
  };
  add(1, 2);
  add(static_cast<std::uint32_t>(header.size()), 2);
  bytes += header;
  bytes.reserve(bytes.size() + 4 * frames.celsius.size());
  for (const float value : frames.celsius) add(std::bit_cast<std::uint32_t>(value), 4);
  return bytes;
}

std::string frame_to_csv(const FrameStack& frames, double time_s) {
  const auto n_read = std::ranges::upper_bound(frames.times_s, time_s) - frames.times_s.begin();
  std::string text;
  if (n_read == 0) return text;
  const auto columns = static_cast<std::size_t>(frames.columns);
  const std::size_t first = static_cast<std::size_t>(n_read - 1) * static_cast<std::size_t>(frames.rows) * columns;
  for (std::size_t i = 0; i < static_cast<std::size_t>(frames.rows) * columns; ++i) {
    const float value = frames.celsius[first + i];
    text += std::isnan(value) ? "" : fixed(static_cast<double>(value), 2);
    text += (i + 1) % columns == 0 ? '\n' : ',';
  }
  return text;
}

}  // namespace pirsim::io
