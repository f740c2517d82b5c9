// Data files as they are, as gzip (.gz) or as Zstandard (.zst).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "files/disk/file.hpp"

namespace pirsim::io {

enum class Compression { none, gzip, zstd };

/// How the names of table files may end: ".csv" and its compressed forms.
[[nodiscard]] const std::vector<std::string>& table_endings();
/// By the ending of the name: .gz, .zst, anything else is plain.
[[nodiscard]] Compression compression_of(const std::filesystem::path& file);
/// The name without .gz or .zst.
[[nodiscard]] std::filesystem::path without_compression(const std::filesystem::path& file);

/// What an input holds without gzip or Zstandard, which are told by its first bytes; as it is if they are others'.
/// Throws Error(input) for what is damaged, cut short, or holds more than that.
[[nodiscard]] std::string decompressed(Input input, std::size_t max_bytes);

/// Compresses into a stream. The same bytes give the same file: no time and no name is stored.
class DataWriter {
 public:
  /// The stream outlives the writer; its state tells about write errors.
  DataWriter(std::ostream& out, Compression compression);
  ~DataWriter();
  void write(std::string_view bytes);
  void finish();  ///< once, after the last write

  struct Encoder;

 private:
  std::unique_ptr<Encoder> encoder_;
};

/// Reads what DataWriter, or gzip and zstd themselves, wrote. Memory is bounded whatever the file says.
class DataReader {
 public:
  /// Fills a buffer; 0 at the end.
  using ByteSource = std::function<std::size_t(char* to, std::size_t size)>;

  explicit DataReader(const std::filesystem::path& file);
  /// What comes from elsewhere; path: its name in messages.
  DataReader(const std::filesystem::path& path, Compression compression, ByteSource source);
  ~DataReader();
  /// Up to `size` bytes; 0 at the end. Throws Error: io, or input for a file that is damaged or cut short.
  [[nodiscard]] std::size_t read(char* to, std::size_t size);

  struct Decoder;

 private:
  std::unique_ptr<Decoder> decoder_;
};

}  // namespace pirsim::io
