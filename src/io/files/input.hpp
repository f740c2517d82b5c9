// What comes in. Each input is opened once, and what is recorded of it is taken from the bytes that are parsed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "pirsim/input_file.hpp"

namespace pirsim::io {

/// A regular file, a pipe, or standard input ("/dev/stdin"), whole.
struct Input {
  std::filesystem::path path;
  std::string bytes;

  [[nodiscard]] InputFile file() const;  ///< with its hash
  /// The bytes as UTF-8 without a byte order mark; UTF-16 is converted by its own. Throws Error(input) with line and
  /// column for what is neither.
  [[nodiscard]] std::string text() const;
};

constexpr std::size_t max_text_file_bytes = 16'000'000;

/// Throws Error: io if it can't be read, input if it is larger, stopped if a signal is handled while it is waited for.
[[nodiscard]] Input read_input(const std::filesystem::path& path, std::size_t max_bytes = max_text_file_bytes);

/// As records name it: the file's name, "stdin", or "pipe" for one that has none, whose number changes from call to
/// call.
[[nodiscard]] std::string name_of_input(const std::filesystem::path& path);
/// An input's name without its ending: what a study is called that doesn't say.
[[nodiscard]] std::string stem_of_input(const std::filesystem::path& path);
/// Where the files that it names are looked for: beside it, or in the working folder if it has no folder of its own.
[[nodiscard]] std::filesystem::path folder_of_input(const std::filesystem::path& path);

/// By its first 16 bytes, what holds no text but is often given for one, and what to do; empty for anything else.
[[nodiscard]] std::string_view name_of_binary(std::string_view bytes);

/// As Input::text(), of bytes; `name` stands in messages.
[[nodiscard]] std::string text_from(std::string bytes, const std::string& name);

}  // namespace pirsim::io
