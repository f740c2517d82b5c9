// One number of a measured study, with what others simulated for it.
#pragma once

#include <optional>
#include <string>

namespace pirsim {

/// How often one sensor reported motion in one trial.
struct MeasuredCell {
  std::string trial;
  std::string sensor;
  int real = 0;                    ///< measured count
  std::optional<int> min_sim;      ///< least published simulated count
  std::optional<int> max_sim;      ///< greatest published simulated count
  std::optional<double> mean_sim;  ///< mean of the published simulated counts
};

}  // namespace pirsim
