// Numbers to a stream of bytes and back, little-endian, with a digest: how fitted objects are kept.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/digest.hpp"
#include "stats/matrix.hpp"

namespace pirsim::stats {

template <typename T>
concept Number = std::is_arithmetic_v<T>;

/// Starts with `kind` and a version, ends with the SHA-256 of all bytes between; call finish() last.
class BinaryWriter {
 public:
  BinaryWriter(std::ostream& out, std::string_view kind, std::uint32_t version);
  template <Number T>
  void write(T value) {
    put(&value, sizeof value);
  }
  template <Number T>
  void write(const std::vector<T>& values) {
    write(static_cast<std::uint64_t>(values.size()));
    put(values.data(), values.size() * sizeof(T));
  }
  template <Number T>
  void write(const Matrix<T>& matrix) {
    write(static_cast<std::uint64_t>(matrix.rows()));
    write(static_cast<std::uint64_t>(matrix.columns()));
    put(matrix.values().data(), matrix.values().size() * sizeof(T));
  }
  void write(std::string_view text);
  /// Writes the digest. Throws Error(io) if the stream has failed.
  void finish();

 private:
  void put(const void* bytes, std::size_t count);
  std::ostream& out_;
  Sha256 digest_;
};

/// Reads what BinaryWriter wrote, in the same order. Every fault is Error(input) that names the kind.
class BinaryReader {
 public:
  /// Throws Error(input) if the stream holds something else or another version.
  BinaryReader(std::istream& in, std::string_view kind, std::uint32_t version);
  template <Number T>
  [[nodiscard]] T read() {
    T value{};
    get(&value, sizeof value);
    return value;
  }
  template <Number T>
  [[nodiscard]] std::vector<T> read_vector() {
    std::vector<T> values;
    get_many(values, read<std::uint64_t>());
    return values;
  }
  template <Number T>
  [[nodiscard]] Matrix<T> read_matrix() {
    const auto rows = read<std::uint64_t>(), columns = read<std::uint64_t>();
    if (columns != 0 && rows > largest_count / columns) fail("is damaged: an impossible size");
    std::vector<T> values;
    get_many(values, rows * columns);
    Matrix<T> matrix(rows, columns);
    std::copy(values.begin(), values.end(), matrix.values().begin());
    return matrix;
  }
  [[nodiscard]] std::string read_text();
  /// Compares the digest; throws Error(input) if it differs.
  void finish();

 private:
  static constexpr std::uint64_t largest_count = 1ULL << 36U;
  template <typename T>
  void get_many(std::vector<T>& values, std::uint64_t count) {
    if (count > largest_count) fail("is damaged: an impossible size");
    constexpr std::uint64_t piece = 1ULL << 20U;  // a wrong count is noticed before memory runs out
    while (values.size() < count) {
      const std::uint64_t from = values.size(), more = std::min(piece, count - from);
      values.resize(from + more);
      get(values.data() + from, more * sizeof(T));
    }
  }
  void get(void* bytes, std::size_t count);
  [[noreturn]] void fail(const std::string& what) const;
  std::istream& in_;
  std::string kind_;
  Sha256 digest_;
};

}  // namespace pirsim::stats
