// What every reader of text files needs.
#pragma once

#include <charconv>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace pirsim::io {

constexpr std::size_t max_text_file_bytes = 16'000'000;

/// The whole file. Throws Error: io if it can't be read, input if it is larger than 16 MB.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path);

/// The whole of `text` as a number, independent of the locale; a leading plus is allowed.
template <typename Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number value{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace pirsim::io
