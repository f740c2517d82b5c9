// The lines of a text of any length, one after the other.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "files/disk/compression.hpp"
#include "files/disk/file.hpp"
#include "model/core/random.hpp"
#include "pirsim/error.hpp"
#include "pirsim/input_file.hpp"

namespace pirsim::io {

/// UTF-8 or UTF-16, with or without a byte order mark; as it is, or compressed by gzip or Zstandard, which is
/// told by the first bytes. Memory is bounded whatever the file holds.
class LineReader {
 public:
  /// Throws Error(io) for what can't be read.
  explicit LineReader(std::filesystem::path path);
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  static constexpr std::size_t longest_line = 1'000'000;  ///< assumed: thousands of sensors
  /// The next line without its end, LF or CRLF; none after the last one. It is valid until the next call. Throws
  /// Error: io; input, with line and column, for what is no text and for longer lines.
  [[nodiscard]] std::optional<std::string_view> next(std::size_t longest = longest_line);
  /// All that follows.
  [[nodiscard]] std::string rest(std::size_t longest);
  /// The next character.
  [[nodiscard]] char front() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  [[nodiscard]] Where where(int column = 1) const { return {path_.string(), line_, column}; }
  /// With the hash of all bytes, once there are no more lines.
  [[nodiscard]] InputFile file() const { return {path_.string(), hash_.hex()}; }

 private:
  [[nodiscard]] std::size_t read_raw(char* to, std::size_t size);
  void begin();
  [[nodiscard]] bool fill();  ///< false at the end
  [[nodiscard]] std::string_view checked(std::string_view line);
  [[noreturn]] void refuse(const std::string& why, int column = 1) const;

  std::filesystem::path path_;
  PosixFile opened_;
  Sha256 hash_;
  std::string head_;  ///< first bytes of the file, read to see what it is
  std::optional<DataReader> data_;
  std::optional<Utf16Decoder> utf16_;
  std::string text_;  ///< UTF-8 that came
  std::size_t at_ = 0;
  int line_ = 0;
  bool ended_ = false;
};

}  // namespace pirsim::io
