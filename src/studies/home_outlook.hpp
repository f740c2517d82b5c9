// What a household's days hold, told without running them.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "sim/compiled_study.hpp"
#include "sim/home_draw.hpp"

namespace pirsim::studies {

/// Times are seconds of the day.
struct ExpectedResident {
  std::string id, bed;
  double mean_up_s = 0.0, mean_to_bed_s = 0.0;          ///< ends of the night's sleep
  std::array<double, sim::n_home_activities> mean_s{};  ///< of a day
};

/// Of one trial's days, or its first ones.
struct HomeOutlook {
  std::int64_t first_day = 0;
  int days = 0, working_days = 0, visits = 0;
  std::vector<ExpectedResident> residents;
};

/// trial: index of one with a household. Draws at most so many days, without walking.
[[nodiscard]] HomeOutlook home_outlook(const sim::CompiledStudy& study, std::size_t trial, int most_days = 1000);
void print(std::ostream& out, const HomeOutlook& outlook);

/// What residents do where they are, since the scene has no place for it. Empty without a household.
[[nodiscard]] std::vector<Issue> warnings_of_home(const sim::CompiledStudy& study);

}  // namespace pirsim::studies
