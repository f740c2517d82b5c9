// Faults that the catalogue lacks on purpose, to see whether they are called by a wrong name.
#pragma once

#include <string>
#include <vector>

#include "pirsim/random.hpp"
#include "pirsim/sample.hpp"

namespace pirsim::reconcile {

struct OutOfCatalogueFault {
  std::string name;
  void (*apply)(std::vector<Sample>& rows, std::size_t sensor, Stream& stream);  ///< to the rows of one run
};
[[nodiscard]] const std::vector<OutOfCatalogueFault>& out_of_catalogue_faults();

}  // namespace pirsim::reconcile
