// One row of output.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pirsim {

/// The reading at the end of one window: bits cover the ticks (time_s - window, time_s], everything else is the
/// state at time_s.
struct Sample {
  int replicate = 0;  ///< counts from 1
  std::string trial;
  double time_s = 0.0;
  std::string phase;
  int people = 0;                  ///< people whose pelvis stands over the floor area
  std::vector<std::uint8_t> bits;  ///< (n_sensors) 1 where the sensor saw motion
  bool operator==(const Sample&) const = default;
};

}  // namespace pirsim
