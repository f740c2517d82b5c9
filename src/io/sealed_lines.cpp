#include "io/sealed_lines.hpp"

#include <string_view>

#include "core/digest.hpp"

namespace pirsim::io {
namespace {

constexpr std::string_view mark = " #";

}  // namespace

std::string SealedLines::digest_after(const std::string& text) const {
  constexpr std::size_t digits = 16;  // damage is to be told, not forgery
  return sha256(last_ + text).substr(0, digits);
}

std::string SealedLines::sealed(const std::string& text) {
  last_ = digest_after(text);
  return text + std::string(mark) + last_ + '\n';
}

std::optional<std::string> SealedLines::opened(const std::string& line) {
  const std::size_t at = line.rfind(mark);
  if (at == std::string::npos) return std::nullopt;
  std::string text = line.substr(0, at);
  std::string digest = digest_after(text);
  if (line.compare(at + mark.size(), std::string::npos, digest) != 0) return std::nullopt;
  last_ = std::move(digest);
  return text;
}

}  // namespace pirsim::io
