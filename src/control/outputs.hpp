// What lights do, row by row.
#pragma once

#include <ostream>

#include "pirsim/control.hpp"

namespace pirsim::control {

/// A row a row: each light, and the people of its area.
class LitTable {
 public:
  /// out: outlives it.
  LitTable(std::ostream& out, const RuleSpec& rule);
  void add(const Sample& row, const LitRow& lit);

 private:
  std::ostream& out_;
};

}  // namespace pirsim::control
