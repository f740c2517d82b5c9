// Rows with their classes, as classifiers take them.
#pragma once

#include <vector>

#include "pirsim/stats/matrix.hpp"

namespace pirsim::test {

struct Labelled {
  stats::Matrix<float> features;
  std::vector<int> labels;
};

}  // namespace pirsim::test
