// Light by a log whose people a counter estimates.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "logs/log_rows.hpp"
#include "pirsim/control.hpp"
#include "pirsim/counting.hpp"
#include "pirsim/error.hpp"
#include "pirsim/log.hpp"

namespace pirsim::control {

/// A log of which nobody knows how many were there, in windows of a counter's step; people are as it counts them. The
/// log outlives it. Throws as calibrate::count_log().
class CountedSamples {
 public:
  CountedSamples(const Log& log, const counting::Counter& counter);
  [[nodiscard]] const RowsAbout& about() const noexcept { return about_; }
  [[nodiscard]] const std::vector<Issue>& remarks() const noexcept { return remarks_; }
  /// As RowFiles; returns 0.
  std::int64_t each(const TakeRow& take, const std::function<void()>& begin) const;
  /// Over courses of who may have been there.
  [[nodiscard]] Costs expected_costs(const RuleSpec& rule) const;

 private:
  using TakeCounted = std::function<void(Sample& row, std::string_view day, std::size_t reading)>;
  void each_counted(const TakeCounted& take) const;

  LogSamples samples_;
  RowsAbout about_;
  std::vector<Issue> remarks_;
  std::vector<int> people_;                ///< (readings)
  std::vector<double> nobody_;             ///< (readings) the probability that nobody is there, as it is known then
  std::vector<std::vector<int>> courses_;  ///< (draws)(readings)
};

}  // namespace pirsim::control
