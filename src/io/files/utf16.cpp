#include "io/files/utf16.hpp"

namespace pirsim::io {
namespace {

void append_utf8(char32_t code, std::string& text) {
  const auto add = [&](char32_t bits) { text += static_cast<char>(static_cast<unsigned char>(bits)); };
  if (code < 0x80) return add(code);
  if (code < 0x800) return add(0xC0U | code >> 6U), add(0x80U | (code & 0x3FU));
  if (code < 0x10000) {
    add(0xE0U | code >> 12U);
  } else {
    add(0xF0U | code >> 18U);
    add(0x80U | (code >> 12U & 0x3FU));
  }
  add(0x80U | (code >> 6U & 0x3FU));
  add(0x80U | (code & 0x3FU));
}

constexpr const char* half_a_pair = "half of a pair of surrogates";

}  // namespace

std::optional<std::string> Utf16Decoder::add(std::string_view bytes, std::string& text) {
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (!half_) {
      half_ = byte;
      continue;
    }
    const char32_t unit = order_ == ByteOrder::little ? *half_ | byte << 8U : *half_ << 8U | byte;
    half_.reset();
    const bool is_low = unit >= 0xDC00 && unit < 0xE000, is_high = unit >= 0xD800 && unit < 0xDC00;
    if (is_low != (high_ != 0)) return half_a_pair;
    if (is_high) {
      high_ = unit;
    } else {
      append_utf8(is_low ? 0x10000 + ((high_ - 0xD800) << 10U) + (unit - 0xDC00) : unit, text);
      high_ = 0;
    }
  }
  return std::nullopt;
}

std::optional<std::string> Utf16Decoder::finish() const {
  if (half_) return "it ends in half a character";
  if (high_ != 0) return half_a_pair;
  return std::nullopt;
}

}  // namespace pirsim::io
