#include "control/day_sums.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pirsim/random.hpp"

namespace pirsim::control {
namespace {

constexpr std::size_t n_draws = 400, fewest_days = 3;
constexpr double middle = 0.9;

}  // namespace

DrawnDays::DrawnDays(std::size_t n_days) : n_days_(n_days) {
  if (n_days < fewest_days) return;
  times_.resize(n_draws * n_days, 0);
  Stream stream({1, 0, 0, Purpose::drawn_days});
  for (std::size_t draw = 0; draw < n_draws; ++draw) {
    for (std::size_t i = 0; i < n_days; ++i) ++times_[draw * n_days + stream.index(static_cast<std::uint32_t>(n_days))];
  }
}

Figure DrawnDays::ratio(const std::vector<double>& above, const std::vector<double>& below) const {
  const double all = std::accumulate(below.begin(), below.end(), 0.0);
  if (!(all > 0.0)) return {std::nan(""), {}};
  Figure figure{std::accumulate(above.begin(), above.end(), 0.0) / all, {}};
  if (figure.value == 0.0) return figure;
  std::vector<double> ratios;
  for (std::size_t draw = 0; draw < times_.size() / std::max<std::size_t>(1, n_days_); ++draw) {
    double numerator = 0.0, denominator = 0.0;
    for (std::size_t day = 0; day < n_days_; ++day) {
      numerator += times_[draw * n_days_ + day] * above[day];
      denominator += times_[draw * n_days_ + day] * below[day];
    }
    if (denominator > 0.0) ratios.push_back(numerator / denominator);
  }
  if (ratios.empty()) return figure;
  std::ranges::sort(ratios);
  const auto at = [&](double share) {
    return ratios[static_cast<std::size_t>(share * static_cast<double>(ratios.size() - 1) + 0.5)];
  };
  figure.over_days = Interval{at(0.5 - 0.5 * middle), at(0.5 + 0.5 * middle)};
  return figure;
}

Figure DrawnDays::rate(const std::vector<double>& events, const std::vector<double>& hours) const {
  Figure figure = ratio(events, hours);
  const double all = std::accumulate(hours.begin(), hours.end(), 0.0);
  if (figure.value == 0.0 && n_days_ >= fewest_days && all > 0.0)
    figure.over_days = Interval{0.0, -std::log(0.5 - 0.5 * middle) / all};
  return figure;
}

}  // namespace pirsim::control
