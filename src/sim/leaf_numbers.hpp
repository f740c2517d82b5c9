// Numbers for the ways in which the leaves of doors stand.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "schema/door_leaf.hpp"

namespace pirsim::sim {

/// What was seen is remembered under such a number. Belongs to one thread.
class LeafNumbers {
 public:
  /// Takes note of how leaves stand now; true if that isn't as they stood before.
  bool turn(std::span<const LeafStep> steps) {
    if (std::equal(steps.begin(), steps.end(), now_.begin(), now_.end())) return false;
    now_.assign(steps.begin(), steps.end());
    constexpr std::size_t most = 65536;
    if (numbers_.size() == most) numbers_.clear();  // no number is given twice
    const auto [known, is_new] = numbers_.try_emplace(now_, next_);
    if (is_new) ++next_;
    number_ = known->second;
    return true;
  }
  /// 0 without doors.
  [[nodiscard]] std::uint64_t number() const noexcept { return number_; }

 private:
  std::vector<LeafStep> now_;
  std::map<std::vector<LeafStep>, std::uint64_t> numbers_;
  std::uint64_t number_ = 0, next_ = 1;
};

}  // namespace pirsim::sim
