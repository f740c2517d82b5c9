// The times of day that a household has.
#pragma once

#include <array>

#include "pirsim/schedule.hpp"

namespace pirsim {

struct HouseholdClock {
  const char* key;  ///< the field's name, and the key in files
  ClockSpec HouseholdSpec::*clock;
};

inline constexpr std::array household_clocks{HouseholdClock{"wakes", &HouseholdSpec::wakes},
                                             HouseholdClock{"wakes_on_free_days", &HouseholdSpec::wakes_on_free_days},
                                             HouseholdClock{"goes_to_bed", &HouseholdSpec::goes_to_bed},
                                             HouseholdClock{"leaves", &HouseholdSpec::leaves},
                                             HouseholdClock{"comes_home", &HouseholdSpec::comes_home},
                                             HouseholdClock{"lunch", &HouseholdSpec::lunch},
                                             HouseholdClock{"dinner", &HouseholdSpec::dinner}};

}  // namespace pirsim
