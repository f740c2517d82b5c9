#include "body/body_part.hpp"

#include <algorithm>

#include "schema/body_part_names.hpp"

namespace pirsim::body {
namespace {

static_assert(body_part_names.size() == n_parts);

constexpr double skin_at_0_c = 30.2, skin_per_k = 0.125;
constexpr double clo = 0.155;        // m^2 K/W
constexpr double to_air = 8.0;       // W/(m^2 K) by convection and radiation, assumed (6-10)
constexpr double hair_clo = 1.0;     // 0.6 to 1 [Nomoto2020]; wigs on a manikin up to 2 [Lasisi2023]
constexpr double hand_share = 0.32;  // of the forearm's surface: a loosely closed hand's of its length (humanoid.cpp)

/// Insulation of what covers a part over that of the whole outfit: medians of 21 outfits with trousers, 0.5 to 1 clo,
/// on a manikin [LeeZhangArens2013, Nomoto2020]. Of a hat: assumed.
constexpr std::array<double, n_parts> local_share{2.0, 2.2, 1.0, 1.4, 1.4, 1.2, 1.2, 0.8, 0.8, 0.7, 0.7, 1.0, 1.0};

/// What covers the skin and the air around it divide the step between the two as their resistances do.
double outside_of(double insulation_clo, double skin_c, double ambient_c) {
  return ambient_c + (skin_c - ambient_c) / (1.0 + to_air * clo * insulation_clo);
}

double mixed(double a, double b, double share_of_b) { return a + share_of_b * (b - a); }

}  // namespace

std::string_view name(Part part) noexcept { return body_part_names[at(part)]; }

std::array<double, n_parts> surface_temperatures_c(const WarmthSpec& warmth, double ambient_c) {
  const double skin_c = warmth.skin_c.value_or(skin_at_0_c + skin_per_k * ambient_c + warmth.skin_above_k);
  std::array<double, n_parts> temperatures{};
  for (std::size_t i = 0; i < n_parts; ++i) {
    const auto part = static_cast<Part>(i);
    const std::string key(name(part));
    const double covered_c = outside_of(local_share[i] * warmth.clothing_clo, skin_c, ambient_c);
    const bool is_bare = std::ranges::find(warmth.bare, key) != warmth.bare.end();
    if (const auto known = warmth.parts_c.find(key); known != warmth.parts_c.end()) {
      temperatures[i] = known->second;
    } else if (part == Part::head && is_bare) {
      temperatures[i] = mixed(skin_c, outside_of(hair_clo, skin_c, ambient_c), warmth.hair_share);
    } else if ((part == Part::left_forearm || part == Part::right_forearm) && !is_bare) {
      temperatures[i] = mixed(covered_c, skin_c, hand_share);
    } else {
      temperatures[i] = is_bare ? skin_c : covered_c;
    }
  }
  return temperatures;
}

}  // namespace pirsim::body
