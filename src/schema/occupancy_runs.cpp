#include "schema/occupancy_runs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "schema/areas.hpp"

namespace pirsim {
namespace {

constexpr double seconds_a_day = 86400.0;

/// Moments of the data at which something is known, ascending where days are looked for.
std::vector<double> moments_of(const OccupancySpec& occupancy) {
  if (occupancy.counts) return occupancy.counts->times_s;
  std::vector<double> moments;
  if (occupancy.places) {
    for (const StaySpec& stay : occupancy.places->stays) moments.insert(moments.end(), {stay.from_s, stay.to_s});
  }
  if (occupancy.positions) {
    for (const TrackSpec& track : occupancy.positions->tracks)
      moments.insert(moments.end(), track.times_s.begin(), track.times_s.end());
  }
  std::ranges::sort(moments);
  return moments;
}

}  // namespace

bool are_as_many(const CountsSpec& counts, std::size_t k) {
  return counts.people[k] == counts.people[k - 1] &&
         std::ranges::all_of(counts.areas, [k](const auto& area) { return area.people[k] == area.people[k - 1]; });
}

std::optional<DataSpan> data_span(const OccupancySpec& occupancy) {
  const std::vector<double> moments = moments_of(occupancy);
  if (moments.empty()) return std::nullopt;
  return DataSpan{moments.front(), moments.back()};
}

const std::string& data_begin(const OccupancySpec& occupancy) noexcept {
  static const std::string none;
  return occupancy.counts      ? occupancy.counts->begin
         : occupancy.places    ? occupancy.places->begin
         : occupancy.positions ? occupancy.positions->begin
                               : none;
}

const std::string& data_file(const OccupancySpec& occupancy) noexcept {
  static const std::string none;
  return occupancy.counts      ? occupancy.counts->file
         : occupancy.places    ? occupancy.places->file
         : occupancy.positions ? occupancy.positions->file
                               : none;
}
std::string& data_file(OccupancySpec& occupancy) noexcept {
  return const_cast<std::string&>(data_file(std::as_const(occupancy)));
}

OccupancyRuns runs_of(const OccupancySpec& occupancy, const std::string& begin) {
  const std::optional<RunClock> own = clock_from(data_begin(occupancy)), given = clock_from(begin);
  const std::optional<RunClock> data = own ? own : given;
  const DataSpan span = data_span(occupancy).value_or(DataSpan{});
  if (!has_days(occupancy)) {
    // Seconds of the run begin with it; a clock's moments where the script says, or with the first of them.
    const double from_s = own && given ? static_cast<double>(given->begin_s - own->begin_s) : own ? span.first_s : 0.0;
    std::optional<RunClock> clock = data;
    if (clock) clock->begin_s += std::llround(from_s);
    return {clock, span.last_s - from_s, {from_s}};
  }
  const double from_s = 3600.0 * occupancy.from_h.value_or(0.0), to_s = 3600.0 * occupancy.to_h.value_or(24.0);
  OccupancyRuns runs{data, std::round(to_s - from_s), {}};
  const double midnight_s = data->begin_second();  // before second 0 of the data
  double last_day = -1.0;
  for (const double moment_s : moments_of(occupancy)) {
    const double day = std::floor((moment_s + midnight_s) / seconds_a_day);
    const double in_day_s = moment_s + midnight_s - day * seconds_a_day;
    if (day == last_day || in_day_s < from_s || in_day_s > to_s) continue;
    runs.begins_s.push_back(day * seconds_a_day - midnight_s + from_s);
    last_day = day;
  }
  if (!runs.begins_s.empty()) runs.clock->begin_s += std::llround(runs.begins_s.front());
  return runs;
}

std::vector<std::string> seats_of(const OccupancySpec& occupancy, const SceneSpec& scene) {
  return occupancy.seats.empty() ? ids_of(scene.seats) : occupancy.seats;
}
std::vector<std::string> entrances_of(const OccupancySpec& occupancy, const SceneSpec& scene) {
  return occupancy.entrances.empty() ? ids_of(scene.entrances) : occupancy.entrances;
}

}  // namespace pirsim
