// Texts that come from outside: whether they are UTF-8, whether they can be names, and how they are told.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pirsim {

/// Offset of the first byte that isn't part of a UTF-8 character; none if all are.
[[nodiscard]] std::optional<std::size_t> first_not_utf8(std::string_view text);

enum class Lines { one, many };  ///< many: line breaks and tabs may be in it

/// A character that nobody sees for what it is, in words: "the control character U+0007", "U+202E, which turns the
/// direction of writing". Empty if there is none. The text is UTF-8.
[[nodiscard]] std::string invisible_character(std::string_view text, Lines lines);

/// Why a text can't be a name, or nothing.
[[nodiscard]] std::string line_fault(std::string_view text);

/// A name as messages quote it: what is longer than 300 bytes is cut after 100, never inside a character.
[[nodiscard]] std::string shortened(std::string_view name);

/// A message as it is told: what stands in quotes is shortened, and what a terminal would obey, or a reader of C
/// strings would stop at, becomes a question mark. Line breaks stay.
[[nodiscard]] std::string tellable(std::string_view message);

/// The texts, one after the other, with `between` between them.
[[nodiscard]] std::string joined(const std::vector<std::string>& texts, std::string_view between);

/// Markdown that shows the text as it is, in one line: no HTML, no markup, no end of a table's column.
[[nodiscard]] std::string markdown_text(std::string_view text);

/// Markdown that shows the text as code, in backticks.
[[nodiscard]] std::string markdown_code(std::string_view text);

/// How a list of what there is begins.
inline constexpr std::string_view begin_of_list = "; there are ";
/// ` (did you mean 'X'?)`, or `; there are A, B` if none is near; of very many only the first; `; there are none`.
[[nodiscard]] std::string near_or_all(std::string_view name, const std::vector<std::string>& known);

/// Lower-case letters and digits of a name alone: what people mean who spell it otherwise, "HC SR501" or "hc-sr501".
[[nodiscard]] std::string bare_name(std::string_view name);

/// "1 seat", "5 seats"; plural: where it isn't the name and an s.
[[nodiscard]] std::string counted(std::size_t n, const std::string& name, const std::string& plural = {});

/// With so many digits after the point.
[[nodiscard]] std::string fixed(double value, int digits);
/// Of a share, with so many digits after the point: "12 %".
[[nodiscard]] std::string percent(double share, int digits = 0);
/// With three significant digits.
[[nodiscard]] std::string short_number(double value);
/// With as many digits as tell it from every other number.
[[nodiscard]] std::string shortest_number(double value);

}  // namespace pirsim
