// Rows with their classes, as classifiers take them.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "stats/matrix.hpp"
#include "stats/trees.hpp"

namespace pirsim::test {

struct Labelled {
  stats::Matrix<float> features;
  std::vector<int> labels;
};

/// Two rows of five of each class for calibration.
inline stats::Split split_by_class(std::span<const int> labels) {
  stats::Split split;
  std::map<int, int> n;
  for (std::size_t row = 0; row < labels.size(); ++row)
    (n[labels[row]]++ % 5 < 2 ? split.calibration : split.fitting).push_back(row);
  return split;
}

}  // namespace pirsim::test
