// What a run of a script with an occupancy covers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/schema/clock.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

struct OccupancyRuns {
  std::optional<RunClock> clock;  ///< of the first run
  double duration_s = 0.0;
  std::vector<double> begins_s;  ///< of each day, or of the only run there is, in the seconds of the data
};
/// Of specs in which check_together() finds no fault. begin: the script's.
[[nodiscard]] OccupancyRuns runs_of(const OccupancySpec& occupancy, const std::string& begin);

/// Are as many people there as at the moment before, in each counted area too? k: from 1.
[[nodiscard]] bool are_as_many(const CountsSpec& counts, std::size_t k);

/// Does it have days, which replicates take in turn?
[[nodiscard]] inline bool has_days(const OccupancySpec& occupancy) noexcept {
  return occupancy.from_h || occupancy.to_h;
}
/// First and last moment of the data, in their seconds; none without data.
struct DataSpan {
  double first_s = 0.0, last_s = 0.0;
};
[[nodiscard]] std::optional<DataSpan> data_span(const OccupancySpec& occupancy);
/// Local date and time of the data's second 0, or "": they are seconds of the run.
[[nodiscard]] const std::string& data_begin(const OccupancySpec& occupancy) noexcept;
/// The file of its data as the script names it, or "".
[[nodiscard]] const std::string& data_file(const OccupancySpec& occupancy) noexcept;
[[nodiscard]] std::string& data_file(OccupancySpec& occupancy) noexcept;

/// The names that are asked for, or all that the scene has.
[[nodiscard]] std::vector<std::string> seats_of(const OccupancySpec& occupancy, const SceneSpec& scene);
[[nodiscard]] std::vector<std::string> entrances_of(const OccupancySpec& occupancy, const SceneSpec& scene);

}  // namespace pirsim
