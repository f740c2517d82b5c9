#include "dataset/household.hpp"

#include <algorithm>
#include <cmath>

#include "core/text.hpp"
#include "dataset/floor_plan.hpp"
#include "dataset/room_reader.hpp"
#include "io/read/reader_parts.hpp"
#include "schema/household_clocks.hpp"

namespace pirsim::dataset {
namespace {

std::size_t beds_of(const SceneSpec& home) {
  return static_cast<std::size_t>(std::ranges::count_if(home.places, [](const PlaceSpec& place) {
    return place.posture == PlacePosture::lie && std::ranges::find(place.uses, "sleep") != place.uses.end();
  }));
}

}  // namespace

HouseholdRangesSpec read_household_ranges(const io::YamlNode& node, Diagnostics& faults) {
  io::YamlMap map(node, faults, "household");
  HouseholdRangesSpec ranges;
  ranges.works = map.number("works", ranges.works, {.min = 0.0, .max = 1.0});
  ranges.works_at_home = map.number("works_at_home", ranges.works_at_home, {.min = 0.0, .max = 1.0});
  constexpr double rounding = 1e-9;
  if (ranges.works + ranges.works_at_home > 1.0 + rounding)
    faults.error(
        map.where("works_at_home"),
        "household: works_at_home: is more than 1 together with `works`, which is " + shortest_number(ranges.works));
  ranges.age_years =
      read_range(map, "age_years", ranges.age_years, range_of(field_of<&ResidentSpec::age_years>(), ResidentSpec{}));
  ranges.visits_a_week = read_range(map, "visits_a_week", ranges.visits_a_week,
                                    range_of(field_of<&HouseholdSpec::visits_a_week>(), ranges.usual));
  ranges.shift_min = read_range(map, "shift_min", ranges.shift_min, {.min = -120.0, .max = 120.0});
  for (const HouseholdClock& named : household_clocks) io::read_part(map, named.key, ranges.usual.*named.clock);
  HouseholdSpec somebody = ranges.usual;
  somebody.residents.emplace_back().id = "resident";
  check_together(somebody, [&](std::string_view field, const std::string& message) {
    const std::string key(field);
    faults.error(map.where(key), "household: " + key + ": " + message);
  });
  map.finish();
  return ranges;
}

HouseholdSpec draw_household(const HouseholdRangesSpec& ranges, const SceneSpec& home, Stream& stream) {
  constexpr double minutes = 60.0, last_h = 24.0;
  HouseholdSpec household = ranges.usual;
  household.visits_a_week = std::round(10.0 * draw(ranges.visits_a_week, stream)) / 10.0;
  const double shift_h = std::round(draw(ranges.shift_min, stream)) / minutes;
  for (const HouseholdClock& named : household_clocks) {
    double& mean_h = (household.*named.clock).mean_h;
    mean_h = std::clamp(std::round(minutes * (mean_h + shift_h)) / minutes, 0.0, last_h);
  }
  for (std::size_t i = 1; i <= beds_of(home); ++i) {
    ResidentSpec& resident = household.residents.emplace_back();
    resident.id = "resident_" + std::to_string(i);
    const double u = stream.uniform();
    resident.occupation = u < ranges.works                          ? Occupation::works
                          : u < ranges.works + ranges.works_at_home ? Occupation::works_at_home
                                                                    : Occupation::at_home;
    resident.age_years = std::round(draw(ranges.age_years, stream));
  }
  return household;
}

}  // namespace pirsim::dataset
