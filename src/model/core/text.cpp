#include "model/core/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <iomanip>
#include <sstream>

#include "pirsim/error.hpp"

namespace pirsim {
namespace {

struct Character {
  char32_t code = 0;
  std::size_t size = 0;  ///< in bytes; 0: not UTF-8
};

/// The first one of a text that isn't empty.
Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80U) return {lead, 1};
  const std::size_t size = lead >= 0xF0U ? 4 : lead >= 0xE0U ? 3 : 2;
  if (lead < 0xC2U || lead > 0xF4U || text.size() < size) return {};
  char32_t code = lead & (0xFFU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {};
    code = code << 6U | (byte(i) & 0x3FU);
  }
  const bool is_overlong = code < (size == 4 ? 0x10000U : size == 3 ? 0x800U : 0x80U);
  const bool is_surrogate = code >= 0xD800U && code <= 0xDFFFU;
  if (is_overlong || is_surrogate || code > 0x10FFFFU) return {};
  return {code, size};
}

bool is_control(char32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

bool is_layout(char32_t code) { return code == U'\n' || code == U'\t' || code == U'\r'; }

/// Of the Unicode property Bidi_Control, and the two that end lines.
bool turns_writing(char32_t code) {
  return code == 0x061C || code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

std::string number_of(char32_t code) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "U+%04X", static_cast<unsigned>(code));
  return text.data();
}

constexpr std::size_t longest_name = 300;  ///< bytes; paths stand in quotes, too
constexpr std::size_t shown_of_name = 100;
constexpr std::size_t longest_message = 20'000;

/// At most so many bytes, whole characters.
std::string_view cut(std::string_view text, std::size_t size) {
  if (text.size() <= size) return text;
  while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  return text.substr(0, size);
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

/// Where the quote that opens at `begin` closes: at the next one that no letter follows, as in `isn't`.
std::size_t end_of_quote(std::string_view text, std::size_t begin) {
  std::size_t end = begin;
  do {
    end = text.find('\'', end + 1);
  } while (end != std::string_view::npos && end + 1 < text.size() && is_word(text[end + 1]));
  return end;
}

std::string with_short_quotes(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    std::size_t begin = text.find('\'');
    while (begin != std::string_view::npos && begin > 0 && is_word(text[begin - 1])) begin = text.find('\'', begin + 1);
    const std::size_t end = begin == std::string_view::npos ? begin : end_of_quote(text, begin);
    if (end == std::string_view::npos) return result.append(text);
    result.append(text.substr(0, begin + 1)).append(shortened(text.substr(begin + 1, end - begin - 1))).append("'");
    text.remove_prefix(end + 1);
  }
  return result;
}

}  // namespace

std::optional<std::size_t> first_not_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    if (static_cast<unsigned char>(text[at]) < 0x80U) {
      ++at;  // as nearly all are, of a file of many megabytes
      continue;
    }
    const std::size_t size = first_character(text.substr(at)).size;
    if (size == 0) return at;
    at += size;
  }
  return std::nullopt;
}

std::string invisible_character(std::string_view text, Lines lines) {
  while (!text.empty()) {
    const auto [code, size] = first_character(text);
    if (is_control(code) && !(lines == Lines::many && is_layout(code)))
      return "the control character " + number_of(code);
    if (turns_writing(code)) return number_of(code) + ", which turns the direction of writing or ends a line unseen";
    text.remove_prefix(std::max<std::size_t>(1, size));
  }
  return {};
}

std::string line_fault(std::string_view text) {
  const std::string found = invisible_character(text, Lines::one);
  return found.empty() ? found : "expected a text of one line, but it contains " + found;
}

std::string shortened(std::string_view name) {
  if (name.size() <= longest_name) return std::string(name);
  return std::string(cut(name, shown_of_name)) + "...";
}

std::string tellable(std::string_view message) {
  std::string text = with_short_quotes(message);
  if (text.size() > longest_message) text = std::string(cut(text, longest_message)) + "...";
  std::string told;
  for (std::string_view rest = text; !rest.empty();) {
    const auto [code, size] = first_character(rest);
    const bool is_shown = size > 0 && !turns_writing(code) && (!is_control(code) || code == U'\n' || code == U'\t');
    told.append(is_shown ? rest.substr(0, size) : "?");
    rest.remove_prefix(std::max<std::size_t>(1, size));
  }
  return told;
}

std::string joined(const std::vector<std::string>& texts, std::string_view between) {
  std::string all;
  for (const std::string& text : texts) {
    if (&text != &texts.front()) all += between;
    all += text;
  }
  return all;
}

std::string markdown_text(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    if (std::string_view("|<>&*_`[]\\").find(c) != std::string_view::npos) shown += '\\';
    shown += c == '\n' || c == '\r' ? ' ' : c;
  }
  return shown;
}

std::string markdown_code(std::string_view text) {
  std::string fence = "`";  // longer than any that is inside
  while (text.find(fence) != std::string_view::npos) fence += '`';
  const std::string space = fence.size() > 1 ? " " : "";
  return fence + space + std::string(text) + space + fence;
}

std::string near_or_all(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t most = 20;  // assumed: of more, as of meshes, nobody reads the list (tried 10-50)
  if (known.empty()) return std::string(begin_of_list) + "none";
  std::string text = did_you_mean(name, known);
  if (!text.empty()) return text;
  for (std::size_t i = 0; i < known.size() && i < most; ++i)
    text += std::string(i == 0 ? begin_of_list : ", ") + shortened(known[i]);
  if (known.size() > most) text += " and " + std::to_string(known.size() - most) + " more";
  return text;
}

std::string bare_name(std::string_view name) {
  std::string bare;
  for (const char c : name) {
    if (is_word(c)) bare += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return bare;
}

std::string counted(std::size_t n, const std::string& name, const std::string& plural) {
  return std::to_string(n) + ' ' + (n == 1 ? name : plural.empty() ? name + 's' : plural);
}

std::string fixed(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

std::string percent(double share, int digits) { return fixed(100.0 * share, digits) + " %"; }

std::string short_number(double value) {
  std::ostringstream out;
  out << std::setprecision(3) << value;
  return out.str();
}

std::string shortest_number(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace pirsim
