#include "reconcile/report/charts.hpp"

#include <algorithm>
#include <utility>

#include "reconcile/report/sentences.hpp"

namespace pirsim::reconcile {

std::string with_interval(const Rate& rate) {
  if (rate.of == 0) return "no case";
  return percent(rate.value()) + " (" + percent(rate.interval.low) + " to " + percent(rate.interval.high) + ", " +
         std::to_string(rate.hits) + " of " + std::to_string(rate.of) + ")";
}

std::string calibration_error(const SelftestResult& result) {
  return result.reliability.bins.empty() ? "no case" : fixed(result.reliability.expected_calibration_error, 3);
}

io::GridChart::Cell share_cell(const Rate& rate) {
  io::GridChart::Cell cell;
  cell.hint = with_interval(rate);
  if (rate.of == 0) return cell;
  cell.value = rate.value();
  cell.text = fixed(100.0 * rate.value(), 0);
  return cell;
}

io::GridChart confusion_grid(const std::vector<std::string>& hypotheses,
                             const std::vector<std::vector<double>>& shares) {
  constexpr double worth_a_number = 0.05;
  io::GridChart chart;
  chart.label = "share of a row";
  chart.rows = chart.columns = hypotheses;
  for (const std::vector<double>& row : shares) {
    const bool any = std::ranges::any_of(row, [](double share) { return share > 0.0; });
    for (const double share : row) {
      io::GridChart::Cell cell;
      if (any) cell.value = share;
      if (share >= worth_a_number) cell.text = fixed(100.0 * share, 0);
      cell.hint = any ? percent(share) : "no case";
      chart.cells.push_back(std::move(cell));
    }
  }
  return chart;
}

}  // namespace pirsim::reconcile
