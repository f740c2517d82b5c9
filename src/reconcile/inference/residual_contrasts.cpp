#include "reconcile/inference/residual_contrasts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace pirsim::reconcile {
namespace {

using DriverWhen = ResidualDriver::When;

constexpr std::size_t fewest_runs = 4;   ///< of three a step can't be told from a trend
constexpr double fewest_awaited = 15.0;  ///< rows of a run (assumed): the share of fewer is chance
constexpr double least_variance = 0.02;  ///< of a run's log odds (assumed): no model is known better
constexpr double much_sds = 2.0;         ///< off (1, 1.5, 2 and none were tried)
constexpr double least_scatter = 0.05;   ///< of a contrast's values (assumed): a row more or less of some tens

/// Indices of the data's runs as they follow each other.
std::vector<std::size_t> in_order(const std::vector<DataShape::Run>& runs) {
  std::vector<std::size_t> order(runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return std::pair(runs[i].replicate, runs[i].trial); });
  return order;
}

/// Log odds that an awaited row is silent, against the model's datasets. Weights are one over the scatter in these.
class RunOdds {
 public:
  RunOdds(const std::vector<ContrastData>& simulated, std::size_t column) : column_(column) {
    const auto n = static_cast<double>(simulated.size());
    for (std::size_t run = 0; run < simulated.front().gaps.size(); ++run) {
      double awaited = 0.0, sum = 0.0, squares = 0.0;
      for (const ContrastData& one : simulated) {
        const double odds = log_odds(one.gaps[run][column]);
        awaited += one.gaps[run][column].awaited / n;
        sum += odds / n;
        squares += odds * odds / n;
      }
      mean_.push_back(sum);
      const double variance = std::max(0.0, squares - sum * sum) + least_variance;
      sd_.push_back(std::sqrt(variance));
      weight_.push_back(awaited < fewest_awaited ? 0.0 : 1.0 / variance);
    }
  }
  [[nodiscard]] double weight(std::size_t run) const { return weight_[run]; }
  /// 0 where too little is awaited to tell. Drawn in at the ends: a change of the session is in many runs, and a
  /// strange run is no change.
  [[nodiscard]] double off(const ContrastData& data, std::size_t run) const {
    const Gaps& gaps = data.gaps[run][column_];
    if (gaps.awaited < fewest_awaited) return 0.0;
    return std::clamp(log_odds(gaps) - mean_[run], -much_sds * sd_[run], much_sds * sd_[run]);
  }

 private:
  static double log_odds(const Gaps& gaps) {
    return std::log((gaps.silent + 1.0) / (gaps.awaited - gaps.silent + 1.0));
  }

  std::size_t column_;
  std::vector<double> mean_, sd_, weight_;  ///< (n_runs)
};

/// A weighted sum of log odds over the runs, with weights that sum up to 0.
struct Contrast {
  ResidualDriver driver;     ///< who and when
  std::size_t column = 0;    ///< of ContrastData::gaps
  std::vector<double> load;  ///< (n_runs) for log odds
};

/// The least-squares slope of log odds on `along` (n_runs).
std::vector<double> slope_loads(const RunOdds& odds, const std::vector<double>& along) {
  double weight = 0.0, middle = 0.0, squares = 0.0;
  for (std::size_t run = 0; run < along.size(); ++run) {
    weight += odds.weight(run);
    middle += odds.weight(run) * along[run];
  }
  if (weight <= 0.0) return {};
  middle /= weight;
  std::vector<double> loads;
  for (std::size_t run = 0; run < along.size(); ++run) {
    loads.push_back(odds.weight(run) * (along[run] - middle));
    squares += loads.back() * (along[run] - middle);
  }
  if (squares < 1e-9) return {};
  for (double& load : loads) load /= squares;
  return loads;
}

class Session {
 public:
  Session(const StudyFrame& frame, const DataShape& shape, const std::vector<ContrastData>& simulated)
      : order_(in_order(shape.runs)) {
    if (order_.size() < fewest_runs) return;
    const std::size_t n_sensors = frame.sensors.size();
    for (std::size_t column = 0; column < 1 + n_sensors; ++column) {
      odds_.emplace_back(simulated, column);
      ResidualDriver driver;
      driver.how = ResidualDriver::How::with_gaps;
      if (column > 0) {
        driver.who = ResidualDriver::Who::sensor;
        driver.name = frame.sensors[column - 1];
      }
      driver.when = DriverWhen::from_trial_to_trial;
      add(driver, column, [](std::size_t place) { return static_cast<double>(place); });
      driver.when = DriverWhen::from_trial;
      for (std::size_t first = 1; first < order_.size(); ++first) {
        const DataShape::Run& run = shape.runs[order_[first]];
        driver.since = frame.trials[run.trial];
        if (shape.n_replicates > 1) driver.since += " of run " + std::to_string(run.replicate);
        add(driver, column, [first](std::size_t place) { return place >= first ? 1.0 : 0.0; });
      }
      if (n_sensors == 1) break;  // all are the one
    }
  }
  [[nodiscard]] const std::vector<Contrast>& contrasts() const noexcept { return contrasts_; }
  [[nodiscard]] double value(const Contrast& contrast, const ContrastData& data) const {
    double sum = 0.0;
    for (std::size_t run = 0; run < contrast.load.size(); ++run)
      sum += contrast.load[run] * odds_[contrast.column].off(data, run);
    return sum;
  }

 private:
  template <typename Along>
  void add(const ResidualDriver& driver, std::size_t column, const Along& of_place) {
    std::vector<double> along(order_.size());
    for (std::size_t place = 0; place < order_.size(); ++place) along[order_[place]] = of_place(place);
    auto loads = slope_loads(odds_[column], along);
    if (!loads.empty()) contrasts_.push_back({driver, column, std::move(loads)});
  }

  std::vector<std::size_t> order_;
  std::vector<RunOdds> odds_;  ///< (1 + n_sensors)
  std::vector<Contrast> contrasts_;
};

/// The strongest of some contrasts of data, against the strongest in each simulated dataset.
/// measured: (n_contrasts), simulated: (n_datasets x n_contrasts); drivers: (n_contrasts). Gaps at the same moments
/// less often than by chance have no known cause: of these one side is looked at.
std::optional<ResidualDriver> strongest(std::span<const ResidualDriver> drivers, const std::vector<double>& measured,
                                        const std::vector<std::vector<double>>& simulated) {
  const auto n = static_cast<double>(simulated.size());
  std::vector<double> mean(drivers.size(), 0.0), sd(drivers.size(), 0.0);
  for (const auto& values : simulated) {
    for (std::size_t i = 0; i < values.size(); ++i) mean[i] += values[i] / n;
  }
  for (const auto& values : simulated) {
    for (std::size_t i = 0; i < values.size(); ++i) sd[i] += (values[i] - mean[i]) * (values[i] - mean[i]) / n;
  }
  const auto z = [&](const std::vector<double>& values, std::size_t i) { return (values[i] - mean[i]) / sd[i]; };
  const auto size = [&](const std::vector<double>& values, std::size_t i) {
    const bool one_sided = drivers[i].how == ResidualDriver::How::silent_together;
    return one_sided ? z(values, i) : std::abs(z(values, i));
  };
  const auto best_of = [&](const std::vector<double>& values) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < values.size(); ++i) best = size(values, i) > size(values, best) ? i : best;
    return best;
  };
  if (drivers.empty()) return std::nullopt;
  for (double& s : sd) s = std::sqrt(s + least_scatter * least_scatter);
  const std::size_t best = best_of(measured);
  const auto beyond = std::ranges::count_if(simulated, [&](const std::vector<double>& values) {
    return size(values, best_of(values)) >= size(measured, best);
  });
  ResidualDriver driver = drivers[best];
  driver.log_odds = measured[best] - mean[best];
  driver.standard_error = sd[best];
  driver.z = z(measured, best);
  driver.up = driver.z > 0.0;
  driver.p = std::min(1.0, n_contrast_kinds * (1.0 + static_cast<double>(beyond)) / (1.0 + n));
  driver.least_p = n_contrast_kinds / (1.0 + n);
  return driver;
}

}  // namespace

ContrastData contrast_data(const StudyFrame& frame, const DataShape& shape, std::span<const Series> runs) {
  const std::size_t n = frame.sensors.size();
  ContrastData data;
  std::vector<Series> seen;
  for (const DataShape::Run& wanted : shape.runs) {
    std::vector<Gaps>& gaps = data.gaps.emplace_back(1 + n);
    const auto run = std::ranges::find_if(
        runs, [&](const Series& s) { return s.trial == wanted.trial && s.replicate == wanted.replicate; });
    if (run == runs.end()) continue;
    Series& main = seen.emplace_back(*run);
    main.main_end = std::min(main.main_end, main.main_begin + wanted.n_main);
    const std::size_t first = main.main_begin * n;
    for (std::size_t i = 0; i < std::min(wanted.unknown.size(), main.main_end * n - first); ++i) {
      if (wanted.unknown[i] != 0) main.bits[first + i] = unknown_bit;
    }
    const std::vector<Gaps> own = gaps_of(main, n);
    for (std::size_t s = 0; s < n; ++s) {
      gaps[0].awaited += own[s].awaited;
      gaps[0].silent += own[s].silent;
      gaps[1 + s] = own[s];
    }
  }
  data.joint_silence = joint_silence(seen, n).log_ratio();
  return data;
}

std::vector<ResidualDriver> telling_contrasts(const StudyFrame& frame, const DataShape& shape,
                                              const ContrastData& measured, const std::vector<ContrastData>& simulated,
                                              double alpha) {
  std::vector<ResidualDriver> telling;
  const auto look = [&](std::span<const ResidualDriver> drivers, const auto& values_of) {
    std::vector<std::vector<double>> usual;
    for (const ContrastData& one : simulated) usual.push_back(values_of(one));
    const auto found = strongest(drivers, values_of(measured), usual);
    if (found && found->p <= alpha) telling.push_back(*found);
  };
  const Session session(frame, shape, simulated);
  const auto look_at_session = [&](const auto& wanted) {
    std::vector<const Contrast*> contrasts;
    std::vector<ResidualDriver> drivers;
    for (const Contrast& contrast : session.contrasts()) {
      if (!wanted(contrast)) continue;
      contrasts.push_back(&contrast);
      drivers.push_back(contrast.driver);
    }
    look(drivers, [&](const ContrastData& data) {
      std::vector<double> values;
      for (const Contrast* contrast : contrasts) values.push_back(session.value(*contrast, data));
      return values;
    });
  };
  look_at_session([](const Contrast& contrast) { return contrast.column == 0; });
  look_at_session([](const Contrast& contrast) { return contrast.column > 0; });
  ResidualDriver together;
  together.how = ResidualDriver::How::silent_together;
  look(std::span(&together, 1), [](const ContrastData& data) { return std::vector<double>{data.joint_silence}; });
  std::ranges::stable_sort(telling, std::ranges::greater{}, [](const ResidualDriver& d) { return std::abs(d.z); });
  return telling;
}

}  // namespace pirsim::reconcile
