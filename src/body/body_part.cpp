#include "body/body_part.hpp"

#include <algorithm>

#include "schema/body_part_names.hpp"

namespace pirsim::body {

static_assert(body_part_names.size() == n_parts);

std::string_view name(Part part) noexcept { return body_part_names[at(part)]; }

std::array<double, n_parts> surface_temperatures_c(const WarmthSpec& warmth, double ambient_c) {
  constexpr double insulation_per_clo = 0.155;  // m^2 K/W
  constexpr double to_air = 8.0;                // W/(m^2 K)
  const double share = 1.0 / (1.0 + to_air * insulation_per_clo * warmth.clothing_clo);
  const double skin_c = warmth.skin_c.value_or(33.5);
  const double clothing_c = ambient_c + share * (skin_c - ambient_c);
  std::array<double, n_parts> temperatures{};
  for (std::size_t i = 0; i < n_parts; ++i) {
    const std::string part(name(static_cast<Part>(i)));
    const bool is_bare = std::ranges::find(warmth.bare, part) != warmth.bare.end();
    const auto known = warmth.parts_c.find(part);
    temperatures[i] = known != warmth.parts_c.end() ? known->second : is_bare ? skin_c : clothing_c;
  }
  return temperatures;
}

}  // namespace pirsim::body
