#include "pirsim/csv.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace pirsim::io {

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string csv_number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

namespace {

template <typename... Kinds>
struct Visitor : Kinds... {
  using Kinds::operator()...;
};
template <typename... Kinds>
Visitor(Kinds...) -> Visitor<Kinds...>;

}  // namespace

void add_csv(std::string& line, const Cell& cell, int decimals) {
  const auto add_number = [&](auto number) {
    std::array<char, 32> text;
    line.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr);
  };
  std::visit(Visitor{[](std::monostate) {}, [&](std::int64_t number) { add_number(number); },
                     [&](double number) {
                       const double scale = decimals < 0 ? 1.0 : std::pow(10.0, decimals);
                       add_number(decimals < 0 ? number : std::round(scale * number) / scale);
                     },
                     [&](std::string_view text) {
                       if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
                         line += text;
                       } else {
                         line += csv_field(text);
                       }
                     },
                     [&](std::span<const std::uint8_t> bits) {
                       for (const std::uint8_t bit : bits) line += bit != 0 ? '1' : '0';
                     }},
             cell);
}

}  // namespace pirsim::io
