#include "reconcile/inference/residuals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "model/schema/actions.hpp"
#include "reconcile/data/statistics.hpp"
#include "reconcile/inference/locate.hpp"
#include "stats/intervals.hpp"
#include "stats/trees.hpp"

namespace pirsim::reconcile {
namespace {

constexpr const char* all_sensors = "all sensors";
constexpr double n_contrast_kinds = 2.0;  ///< session of all sensors, session of one
constexpr std::size_t fewest_runs = 4;    ///< of three a step can't be told from a trend
constexpr double fewest_awaited = 15.0;   ///< rows of a run (assumed): the share of fewer is chance
constexpr double least_variance = 0.02;   ///< of a run's log odds (assumed): no model is known better
constexpr double much_sds = 2.0;          ///< off (1, 1.5, 2 and none were tried)
constexpr double least_scatter = 0.05;    ///< of a contrast's values (assumed): a row more or less of some tens

/// Indices of the data's runs as they follow each other.
std::vector<std::size_t> in_order(const std::vector<DataShape::Run>& runs) {
  std::vector<std::size_t> order = stats::numbers_to(runs.size());
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

/// Rows of the shortest stretch of motion between two rows without, of any sensor; 0: none.
double shortest_stretch(const Series& run, std::size_t n_sensors) {
  std::size_t shortest = 0;
  for (std::size_t s = 0; s < n_sensors; ++s) {
    std::size_t begin = 0;  // of the stretch; 0: none, or unknown how long
    for (std::size_t row = run.main_begin + 1; row < run.main_end; ++row) {
      const std::uint8_t bit = run.bits[row * n_sensors + s], before = run.bits[(row - 1) * n_sensors + s];
      if (bit == 0 && before == 1 && begin > 0 && (shortest == 0 || row - begin < shortest)) shortest = row - begin;
      if (bit != 1) begin = 0;
      if (bit == 1 && before == 0) begin = row;
    }
  }
  return static_cast<double>(shortest);
}

std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<double> ranks;
  for (const double value : values) {
    const auto below = std::ranges::count_if(values, [&](double other) { return other < value; });
    ranks.push_back(static_cast<double>(below) + 0.5 * static_cast<double>(std::ranges::count(values, value)));
  }
  return ranks;
}

/// What a contrast is called, of either side.
struct ContrastWords {
  std::string who, when;
  std::string more, less;
};

/// A weighted sum of log odds over the runs, with weights that sum up to 0.
struct Contrast {
  ContrastWords words;
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
      const std::string who = column == 0 ? all_sensors : frame.sensors[column - 1];
      add({who, "from trial to trial", "motion has more and more gaps", "motion has fewer and fewer gaps"}, column,
          [](std::size_t place) { return static_cast<double>(place); });
      for (std::size_t first = 1; first < order_.size(); ++first) {
        const DataShape::Run& run = shape.runs[order_[first]];
        const std::string since =
            frame.trials[run.trial] + (shape.n_replicates > 1 ? " of run " + std::to_string(run.replicate) : "");
        add({who, "from about trial " + since + " on", "motion has more gaps than before",
             "motion has fewer gaps than before"},
            column, [first](std::size_t place) { return place >= first ? 1.0 : 0.0; });
      }
      if (n_sensors == 1) break;  // all are the one
    }
  }
  [[nodiscard]] const std::vector<Contrast>& contrasts() const noexcept { return contrasts_; }
  /// Spearman's correlation of the shortest stretches and the order of the runs that have any, as Fisher's z.
  [[nodiscard]] double growth_of_stretches(const ContrastData& data) const {
    std::vector<double> stretches;
    for (const std::size_t run : order_) {
      if (data.shortest[run] > 0.0) stretches.push_back(data.shortest[run]);
    }
    if (stretches.size() < fewest_runs) return 0.0;
    Correlation correlation;
    for (std::size_t place = 0; const double rank : ranks_of(stretches))
      correlation.add(static_cast<double>(place++), rank);
    constexpr double nearly_all = 0.99;
    return std::atanh(std::clamp(correlation.value(), -nearly_all, nearly_all));
  }
  [[nodiscard]] double value(const Contrast& contrast, const ContrastData& data) const {
    double sum = 0.0;
    for (std::size_t run = 0; run < contrast.load.size(); ++run)
      sum += contrast.load[run] * odds_[contrast.column].off(data, run);
    return sum;
  }

 private:
  template <typename Along>
  void add(const ContrastWords& words, std::size_t column, const Along& of_place) {
    std::vector<double> along(order_.size());
    for (std::size_t place = 0; place < order_.size(); ++place) along[order_[place]] = of_place(place);
    auto loads = slope_loads(odds_[column], along);
    if (!loads.empty()) contrasts_.push_back({words, column, std::move(loads)});
  }

  std::vector<std::size_t> order_;
  std::vector<RunOdds> odds_;  ///< (1 + n_sensors)
  std::vector<Contrast> contrasts_;
};

/// The strongest of some contrasts of data, against the strongest in each simulated dataset.
/// measured: (n_contrasts), simulated: (n_datasets x n_contrasts); words: (n_contrasts).
std::optional<ResidualDriver> strongest(std::span<const ContrastWords> words, const std::vector<double>& measured,
                                        const std::vector<std::vector<double>>& simulated) {
  const auto n = static_cast<double>(simulated.size());
  std::vector<double> mean(words.size(), 0.0), sd(words.size(), 0.0);
  for (const auto& values : simulated) {
    for (std::size_t i = 0; i < values.size(); ++i) mean[i] += values[i] / n;
  }
  for (const auto& values : simulated) {
    for (std::size_t i = 0; i < values.size(); ++i) sd[i] += (values[i] - mean[i]) * (values[i] - mean[i]) / n;
  }
  const auto z = [&](const std::vector<double>& values, std::size_t i) { return (values[i] - mean[i]) / sd[i]; };
  const auto size = [&](const std::vector<double>& values, std::size_t i) { return std::abs(z(values, i)); };
  const auto best_of = [&](const std::vector<double>& values) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < values.size(); ++i) best = size(values, i) > size(values, best) ? i : best;
    return best;
  };
  if (words.empty()) return std::nullopt;
  for (double& s : sd) s = std::sqrt(s + least_scatter * least_scatter);
  const std::size_t best = best_of(measured);
  const auto beyond = std::ranges::count_if(simulated, [&](const std::vector<double>& values) {
    return size(values, best_of(values)) >= size(measured, best);
  });
  const auto& [who, when, more, less] = words[best];
  return ResidualDriver{who,
                        when,
                        z(measured, best) > 0.0 ? more : less,
                        measured[best] - mean[best],
                        sd[best],
                        z(measured, best),
                        std::min(1.0, n_contrast_kinds * (1.0 + static_cast<double>(beyond)) / (1.0 + n)),
                        n_contrast_kinds / (1.0 + n)};
}

// What residuals may depend on: who and when.

/// Cells (trial x sensor).
struct Who {
  std::string words;
  std::vector<std::uint8_t> cells;  ///< (n_cells) 1: looked at
  bool is_trial = false;
};
/// Weight of each row of a trial's main part.
struct When {
  std::string words;                        ///< empty: always
  std::vector<std::vector<double>> weight;  ///< (n_trials x n_main)
  bool is_wave = false;                     ///< it rises and falls; others have two values
};

Who cells_of(const ReferenceStudy& reference, std::string words,
             const std::function<bool(std::size_t trial, std::size_t sensor)>& holds) {
  Who one{std::move(words), {}};
  for (std::size_t trial = 0; trial < reference.frame.trials.size(); ++trial) {
    for (std::size_t sensor = 0; sensor < reference.frame.sensors.size(); ++sensor)
      one.cells.push_back(holds(trial, sensor) ? 1 : 0);
  }
  return one;
}

std::string whole(double value) { return std::to_string(std::lround(value)); }

/// Adds what depends on the time since the main part began and on its length alone. Weights have the mean 0 in each
/// run, so that a seat or a sensor that sees more all the time isn't taken for a matter of time.
class Times {
 public:
  explicit Times(const ReferenceStudy& reference) : reference_(reference) {}

  void add(const std::string& words, const std::function<double(double time_s, double length_s)>& weight) {
    When when{words, {}};
    for (const Profile::Trial& trial : reference_.table.profile.trials) {
      when.weight.emplace_back();
      const double length_s = static_cast<double>(trial.n_main) * reference_.frame.window_s;
      double mean = 0.0;
      for (std::size_t row = 0; row < trial.n_main; ++row) {
        when.weight.back().push_back(weight((static_cast<double>(row) + 0.5) * reference_.frame.window_s, length_s));
        mean += when.weight.back().back() / static_cast<double>(trial.n_main);
      }
      if (words.empty()) continue;
      for (double& w : when.weight.back()) w -= mean;
    }
    all.push_back(std::move(when));
  }
  /// A part of the run, from and to as shares of its length.
  void add_part(const std::string& part, double from, double to) {
    add("in the " + part + " of each run",
        [=](double t, double length) { return t >= from * length && t < to * length ? 1.0 : 0.0; });
  }
  /// n equal parts of every period; words(begin, end) says what they are.
  void add_phases(double period_s, int n, const std::function<std::string(double, double)>& words) {
    for (int i = 0; i < n; ++i) {
      const double begin = period_s * i / n, end = period_s * (i + 1) / n;
      add(words(begin, end), [=](double t, double) {
        const double phase = std::fmod(t, period_s);
        return phase >= begin && phase < end ? 1.0 : 0.0;
      });
    }
  }

  std::vector<When> all;

 private:
  const ReferenceStudy& reference_;
};

std::vector<Who> all_who(const ReferenceStudy& reference) {
  std::vector<Who> all{cells_of(reference, all_sensors, [](auto, auto) { return true; })};
  const StudyFrame& frame = reference.frame;
  for (std::size_t s = 0; s < frame.sensors.size(); ++s)
    all.push_back(cells_of(reference, frame.sensors[s], [s](auto, std::size_t number) { return number == s; }));
  for (std::size_t t = 0; t < frame.trials.size(); ++t) {
    all.push_back(cells_of(reference, frame.trials[t], [t](std::size_t number, auto) { return number == t; }));
    all.back().is_trial = true;
  }
  std::vector<double> distances;
  for (const CellKnowledge& cell : reference.knowledge) distances.push_back(cell.distance_m);
  const double near = stats::quantile(distances, 1.0 / 3.0), far = stats::quantile(distances, 2.0 / 3.0);
  const auto add = [&](const char* words, const std::function<bool(const CellKnowledge&)>& holds) {
    all.push_back(cells_of(reference, words,
                           [&](std::size_t t, std::size_t s) { return holds(reference.knowledge[frame.cell(t, s)]); }));
  };
  add("sensors near the seat", [&](const CellKnowledge& cell) { return cell.distance_m < near; });
  add("sensors far from the seat", [&](const CellKnowledge& cell) { return cell.distance_m > far; });
  add("sensors that the sitter faces", [](const CellKnowledge& cell) { return cell.facing > 0.5; });
  add("sensors behind the sitter", [](const CellKnowledge& cell) { return cell.facing < -0.5; });
  return all;
}

std::vector<When> all_when(const ReferenceStudy& reference) {
  Times times(reference);
  double longest_s = 0.0;
  for (const Profile::Trial& trial : reference.table.profile.trials)
    longest_s = std::max(longest_s, static_cast<double>(trial.n_main) * reference.frame.window_s);
  times.add("", [](double, double) { return 1.0; });
  times.add_part("first half", 0.0, 0.5);
  times.add_part("second half", 0.5, 1.0);
  times.add_part("first third", 0.0, 1.0 / 3.0);
  times.add_part("middle third", 1.0 / 3.0, 2.0 / 3.0);
  times.add_part("last third", 2.0 / 3.0, 1.0);
  constexpr double minute_s = 60.0;
  if (longest_s >= 2.0 * minute_s) {
    times.add_phases(minute_s, 10, [](double begin, double end) {
      return begin == 0.0 ? "in the first " + whole(end) + " s of each minute"
                          : "from second " + whole(begin) + " to " + whole(end) + " of each minute";
    });
  }
  const action::Work* work = nullptr;
  for (const TrialSpec& trial : reference.source.script.trials) {
    if (work == nullptr) work = first<action::Work>(trial);
  }
  if (work != nullptr) {
    if (longest_s >= 2.0 * work->tilt_every_s && work->tilt_choices_deg.size() > 1) {
      times.add_phases(work->tilt_every_s, 6, [&](double begin, double end) {
        if (end > work->tilt_every_s - 1e-9)
          return "in the last " + whole(end - begin) + " s before each change of posture";
        return (begin == 0.0 ? "in the first " + whole(end) : "from " + whole(begin) + " to " + whole(end)) +
               " s after each change of posture";
      });
    }
    times.add_phases(work->arm_period_s, 3, [&](double begin, double end) {
      return "from " + whole(100.0 * begin / work->arm_period_s) + " to " + whole(100.0 * end / work->arm_period_s) +
             " % of the arm's cycle";
    });
  }
  constexpr std::array<double, 11> wave_periods_s{40, 45, 50, 56, 63, 71, 80, 90, 101, 113, 127};
  constexpr int phases = 8;
  for (const double period_s : wave_periods_s) {
    for (int i = 0; i < phases && 1.5 * period_s <= longest_s; ++i) {
      const double top_s = period_s * i / phases;
      times.add("rising and falling every " + whole(period_s) + " s, most around second " + whole(top_s),
                [=](double t, double) { return std::cos(2.0 * std::numbers::pi * (t - top_s) / period_s); });
      times.all.back().is_wave = true;
    }
  }
  return std::move(times.all);
}

constexpr double least_chance = 0.01;       ///< of motion in a window (assumed): profiles are means of few runs
constexpr std::uint32_t n_simulated = 100;  ///< datasets that scores are compared with; more if alpha needs them
constexpr std::size_t most_drivers = 3;
constexpr double little = 0.05, much = 0.3;
constexpr double least_information = 1.0;  ///< bits' worth of variance (assumed): one bit alone proves nothing

/// One bit of a dataset.
struct BitPlace {
  std::size_t trial = 0, row = 0, sensor = 0;
};

/// The main parts of all measured runs as one list of bits: the same places in every dataset.
class Bits {
 public:
  Bits(const ReferenceStudy& reference, const Profile& profile) : reference_(reference) {
    const std::size_t n = reference.frame.sensors.size();
    for (const DataShape::Run& run : reference.shape.runs) {
      const Profile::Trial& trial = profile.trials[run.trial];
      for (std::size_t i = 0; i < std::min(run.n_main, trial.n_main) * n; ++i) {
        places.push_back({run.trial, i / n, i % n});
        const double p = std::clamp(static_cast<double>(trial.expected[i]), least_chance, 1.0 - least_chance);
        chance.push_back(p);
        odds.push_back(std::log(p / (1.0 - p)));
        known.push_back(run.unknown.empty() || run.unknown[i] == 0 ? 1 : 0);
      }
    }
  }
  /// (n_places) 0 or 1; 0 where nothing was measured.
  [[nodiscard]] std::vector<std::uint8_t> of(std::span<const Series> runs, const Profile& profile) const {
    const std::size_t n = reference_.frame.sensors.size();
    std::vector<std::uint8_t> bits;
    for (const DataShape::Run& wanted : reference_.shape.runs) {
      const std::size_t size = std::min(wanted.n_main, profile.trials[wanted.trial].n_main) * n;
      const Series* run = run_of(runs, wanted);
      for (std::size_t i = 0; i < size; ++i) {
        const bool there = run != nullptr && run->main_begin * n + i < run->main_end * n;
        const bool moved = there && run->bits[run->main_begin * n + i] == 1;
        bits.push_back(moved && known[bits.size()] != 0 ? 1 : 0);
      }
    }
    return bits;
  }

  std::vector<BitPlace> places;
  std::vector<double> chance, odds;  ///< that the plain model gives motion
  std::vector<std::uint8_t> known;

 private:
  const ReferenceStudy& reference_;
};

enum class How { more, more_where_little, more_where_much, opposite, beside };

struct Driver {
  std::size_t who = 0, when = 0;
  How how = How::more;
  std::size_t other = 0;    ///< sensor, of How::beside
  bool makes_sense = true;  ///< or is only here to keep the order
};

/// Every driver's score in a dataset: the derivative of the log likelihood for its coefficient.
class Scores {
 public:
  Scores(const ReferenceStudy& reference, const Bits& bits)
      : reference_(reference), bits_(bits), who_(all_who(reference)), when_(all_when(reference)) {
    const std::size_t n_sensors = reference.frame.sensors.size();
    std::vector<std::pair<How, std::size_t>> hows{
        {How::more, 0}, {How::more_where_little, 0}, {How::more_where_much, 0}, {How::opposite, 0}};
    for (std::size_t s = 0; n_sensors > 1 && s < n_sensors; ++s) hows.emplace_back(How::beside, s);
    for (const auto& [how, other] : hows) {
      for (std::size_t when = 0; when < when_.size(); ++when) {
        const bool makes_sense =
            how == How::beside ? when_[when].words.empty() : how == How::more || !when_[when].is_wave;
        for (std::size_t who = 0; who < who_.size(); ++who) drivers_.push_back({who, when, how, other, makes_sense});
      }
    }
  }
  [[nodiscard]] const std::vector<Driver>& drivers() const noexcept { return drivers_; }
  [[nodiscard]] const Who& who(const Driver& driver) const { return who_[driver.who]; }
  [[nodiscard]] const When& when(const Driver& driver) const { return when_[driver.when]; }

  /// What the driver multiplies its coefficient with, at one place of a dataset.
  [[nodiscard]] double value(const Driver& driver, std::span<const std::uint8_t> bits, std::size_t place) const {
    const BitPlace& at = bits_.places[place];
    const std::size_t cell = reference_.frame.cell(at.trial, at.sensor);
    if (who_[driver.who].cells[cell] == 0) return 0.0;
    return when_[driver.when].weight[at.trial][at.row] * factor(driver.how, driver.other, bits, place);
  }

  /// (n_drivers) sums over places of value x residual, or of value^2 x residual for variances.
  enum class Power { one, two };
  [[nodiscard]] std::vector<double> sums(std::span<const std::uint8_t> bits, std::span<const double> residuals,
                                         Power power = Power::one) const {
    std::vector<double> all(drivers_.size(), 0.0);
    const std::size_t n_cells = reference_.frame.n_cells();
    for (std::size_t first = 0; first < drivers_.size(); first += who_.size() * when_.size()) {
      const std::vector<std::vector<double>> by_row = rows_of_cells(drivers_[first], bits, residuals, power);
      for (std::size_t when = 0; when < when_.size(); ++when) {
        std::vector<double> of_cells(n_cells, 0.0);
        for (std::size_t cell = 0; cell < n_cells; ++cell) {
          const std::vector<double>& weight = when_[when].weight[cell / reference_.frame.sensors.size()];
          for (std::size_t row = 0; row < by_row[cell].size(); ++row)
            of_cells[cell] += by_row[cell][row] * (power == Power::one ? weight[row] : weight[row] * weight[row]);
        }
        for (std::size_t who = 0; who < who_.size(); ++who) {
          double& sum = all[first + when * who_.size() + who];
          if (!drivers_[first + when * who_.size() + who].makes_sense) continue;
          for (std::size_t cell = 0; cell < n_cells; ++cell) sum += who_[who].cells[cell] != 0 ? of_cells[cell] : 0.0;
        }
      }
    }
    return all;
  }

 private:
  [[nodiscard]] double factor(How how, std::size_t other, std::span<const std::uint8_t> bits, std::size_t place) const {
    switch (how) {
      case How::more:
        return 1.0;
      case How::more_where_little:
        return bits_.chance[place] < little ? 1.0 : 0.0;
      case How::more_where_much:
        return bits_.chance[place] >= much ? 1.0 : 0.0;
      case How::opposite:
        return -bits_.odds[place];
      case How::beside:
        break;
    }
    const std::size_t sensor = bits_.places[place].sensor;
    return sensor == other ? 0.0 : static_cast<double>(bits[place - sensor + other]);
  }
  [[nodiscard]] std::vector<std::vector<double>> rows_of_cells(const Driver& driver, std::span<const std::uint8_t> bits,
                                                               std::span<const double> residuals, Power power) const {
    std::vector<std::vector<double>> by_row(reference_.frame.n_cells());
    const std::size_t n_sensors = reference_.frame.sensors.size();
    for (std::size_t cell = 0; cell < by_row.size(); ++cell)
      by_row[cell].assign(when_.front().weight[cell / n_sensors].size(), 0.0);
    for (std::size_t place = 0; place < bits_.places.size(); ++place) {
      if (bits_.known[place] == 0) continue;
      const BitPlace& at = bits_.places[place];
      const double f = factor(driver.how, driver.other, bits, place);
      by_row[at.trial * n_sensors + at.sensor][at.row] += residuals[place] * (power == Power::one ? f : f * f);
    }
    return by_row;
  }

  const ReferenceStudy& reference_;
  const Bits& bits_;
  std::vector<Who> who_;
  std::vector<When> when_;
  std::vector<Driver> drivers_;
};

/// What uncertain seats, sensors and bodies change most are levels; each kind of driver is compared with its own.
enum DriverKind : std::size_t { level, time_of_run, neighbour, n_kinds };

/// How the scores of simulated datasets scatter.
class Usual {
 public:
  /// simulated: (n_datasets x n_drivers); independent: (n_drivers) variances if all bits were independent.
  Usual(std::vector<std::vector<double>> simulated, std::vector<double> independent, std::vector<DriverKind> kinds)
      : simulated_(std::move(simulated)), independent_(std::move(independent)), kinds_(std::move(kinds)) {
    const std::size_t n = independent_.size();
    sum_.assign(n, 0.0);
    squares_.assign(n, 0.0);
    for (const auto& scores : simulated_) {
      for (std::size_t i = 0; i < n; ++i) {
        sum_[i] += scores[i];
        squares_[i] += scores[i] * scores[i];
      }
    }
    std::vector<double> ratios;
    const auto n_datasets = static_cast<double>(simulated_.size());
    for (std::size_t i = 0; i < n; ++i) {
      if (independent_[i] < least_information) continue;
      ratios.push_back((squares_[i] / n_datasets - std::pow(sum_[i] / n_datasets, 2)) / independent_[i]);
    }
    if (!ratios.empty()) dispersion_ = std::max(1.0, stats::quantile(ratios, 0.75));
    for (const auto& scores : simulated_) {
      std::array<double, n_kinds> greatest{};
      for (std::size_t i = 0; i < n; ++i)
        greatest[kinds_[i]] = std::max(greatest[kinds_[i]], std::abs(without(i, scores[i])));
      for (std::size_t kind = 0; kind < n_kinds; ++kind) greatest_[kind].push_back(greatest[kind]);
    }
  }
  /// In standard deviations. To the scatter of few datasets is added what dependent bits scatter elsewhere: where
  /// hardly any simulated dataset sees motion, a first bit is no wonder.
  [[nodiscard]] double z(std::size_t driver, double score) const {
    return standardised(driver, score, sum_[driver], squares_[driver], static_cast<double>(simulated_.size()));
  }
  /// z as a share of what the strongest driver of its kind usually has.
  [[nodiscard]] double strength(std::size_t driver, double score) const {
    return std::abs(z(driver, score)) / std::max(1.0, stats::quantile(greatest_[kinds_[driver]], 0.5));
  }
  /// That any kind's strongest driver is so strong by chance (Bonferroni over the kinds).
  [[nodiscard]] double p(std::size_t driver, double score) const {
    const std::vector<double>& greatest = greatest_[kinds_[driver]];
    const auto beyond = std::ranges::count_if(greatest, [&](double g) { return g >= std::abs(z(driver, score)); });
    const double own = (1.0 + static_cast<double>(beyond)) / (1.0 + static_cast<double>(greatest.size()));
    return std::min(1.0, own * static_cast<double>(n_kinds));
  }
  /// No data give a smaller p.
  [[nodiscard]] double least_p(std::size_t driver) const {
    return static_cast<double>(n_kinds) / (1.0 + static_cast<double>(greatest_[kinds_[driver]].size()));
  }

 private:
  /// z of a simulated dataset among the others.
  [[nodiscard]] double without(std::size_t driver, double score) const {
    return standardised(driver, score, sum_[driver] - score, squares_[driver] - score * score,
                        static_cast<double>(simulated_.size()) - 1.0);
  }
  [[nodiscard]] double standardised(std::size_t driver, double score, double sum, double squares, double n) const {
    const double mean = sum / n, scatter = std::max(0.0, squares / n - mean * mean);
    return (score - mean) / std::sqrt(scatter + dispersion_ * (independent_[driver] + least_information));
  }

  std::vector<std::vector<double>> simulated_;
  std::vector<double> independent_, sum_, squares_;
  std::vector<DriverKind> kinds_;                        ///< (n_drivers)
  std::array<std::vector<double>, n_kinds> greatest_{};  ///< (n_kinds x n_datasets)
  double dispersion_ = 1.0;                              ///< scatter over that of independent bits, of most drivers
};

std::vector<double> residuals_of(const std::vector<std::uint8_t>& bits, const std::vector<double>& chance) {
  std::vector<double> residuals(bits.size());
  for (std::size_t i = 0; i < bits.size(); ++i) residuals[i] = static_cast<double>(bits[i]) - chance[i];
  return residuals;
}

/// What `of` says of n datasets with the shape of the study's, of realizations that neither profile nor table has seen.
template <typename Of>
auto of_fresh_datasets(const RealizationSource& source, const ReferenceStudy& study, std::uint32_t n,
                       const Context& context, const Of& of) {
  constexpr std::uint32_t first_realization = 1U << 22U;
  const int n_replicates = study.shape.n_replicates;
  const auto simulate = [&](std::size_t i) {
    const SimulatedRealization one(source, study.frame, first_realization + static_cast<std::uint32_t>(i),
                                   n_replicates);
    return of(one.plain(0, n_replicates));
  };
  return in_parallel<decltype(simulate(0))>(n, context.threads, simulate);
}

Usual simulate_usual(const ReferenceStudy& reference, const Bits& bits, const Scores& scores,
                     const std::vector<std::uint8_t>& measured, double alpha, const Context& context) {
  const auto n = std::max(n_simulated, static_cast<std::uint32_t>(std::ceil(static_cast<double>(n_kinds) / alpha)));
  const auto scores_of = [&](const std::vector<Series>& runs) {
    const std::vector<std::uint8_t> own = bits.of(runs, reference.table.profile);
    return scores.sums(own, residuals_of(own, bits.chance));
  };
  auto simulated = of_fresh_datasets(reference.source, reference, n, context, scores_of);
  std::vector<double> independent;
  for (const double p : bits.chance) independent.push_back(p * (1.0 - p));
  std::vector<DriverKind> kinds;
  for (const Driver& driver : scores.drivers())
    kinds.push_back(driver.how == How::beside ? neighbour : scores.when(driver).words.empty() ? level : time_of_run);
  return {std::move(simulated), scores.sums(measured, independent, Scores::Power::two), std::move(kinds)};
}

std::string what_of(How how, double z, const std::string& other) {
  const bool up = z > 0.0;
  if (how == How::beside)
    return (up ? "motion whenever " : "silence whenever ") + other + (up ? " sees some" : " sees motion");
  using UpAndDown = std::pair<const char*, const char*>;
  static constexpr std::array<UpAndDown, 4> all{
      {{"more motion than expected", "less motion than expected"},
       {"motion where hardly any is expected", "still less motion where hardly any is expected"},
       {"still more motion where much is expected", "less motion where much is expected"},
       {"the opposite of what is expected",
        "what is expected, with less chance in it: likely motion comes nearly always, unlikely motion nearly never"}}};
  const auto& [more, less] = all[static_cast<std::size_t>(how)];
  return up ? more : less;
}

/// The measured bits regressed on the drivers found so far.
class Regression {
 public:
  Regression(const Bits& bits, const Scores& scores, std::vector<std::uint8_t> measured)
      : bits_(bits), scores_(scores), measured_(std::move(measured)), chance_(bits.chance) {}

  [[nodiscard]] std::vector<double> scores() const { return scores_.sums(measured_, residuals_of(measured_, chance_)); }
  void add(const Driver& driver) {
    drivers_.push_back(driver);
    stats::Matrix<double> columns;
    std::vector<std::uint8_t> outcomes;
    std::vector<double> offset;
    std::vector<int> cluster;
    for (std::size_t place = 0; place < measured_.size(); ++place) {
      if (bits_.known[place] == 0) continue;
      columns.append_row(values(place));
      outcomes.push_back(measured_[place]);
      offset.push_back(bits_.odds[place]);
      cluster.push_back(static_cast<int>(bits_.places[place].trial));
    }
    const bool one_trial = std::ranges::count(cluster, cluster.front()) == std::ssize(cluster);
    constexpr double weak = 1.0, hardly_any = 0.1;  // assumed: as an observation or so among thousands
    fit_ = stats::fit_logistic(
        columns, outcomes,
        {weak, hardly_any, offset, one_trial ? std::span<const int>() : std::span<const int>(cluster)});
    for (std::size_t place = 0; place < chance_.size(); ++place) {
      const std::vector<double> x = values(place);
      double odds = bits_.odds[place] + fit_.coefficients[0];
      for (std::size_t i = 0; i < x.size(); ++i) odds += fit_.coefficients[1 + i] * x[i];
      chance_[place] = 1.0 / (1.0 + std::exp(-odds));
    }
  }
  [[nodiscard]] double log_odds() const { return fit_.coefficients.back(); }
  [[nodiscard]] double standard_error() const { return fit_.standard_errors.back(); }

 private:
  [[nodiscard]] std::vector<double> values(std::size_t place) const {
    std::vector<double> all;
    for (const Driver& driver : drivers_) all.push_back(scores_.value(driver, measured_, place));
    return all;
  }
  const Bits& bits_;
  const Scores& scores_;
  std::vector<std::uint8_t> measured_;
  std::vector<double> chance_;
  std::vector<Driver> drivers_;
  stats::LogisticFit fit_;
};

/// Of the drivers that are about as strong as the strongest, the first: all sensors, then one, then a seat, then
/// groups.
std::size_t strongest(const Usual& usual, const Scores& scores, const std::vector<double>& now) {
  constexpr double about = 0.95;
  std::vector<double> strength(now.size());
  for (std::size_t i = 0; i < now.size(); ++i) strength[i] = usual.strength(i, now[i]);
  const double greatest = *std::ranges::max_element(strength);
  std::size_t best = now.size();
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (strength[i] < about * greatest) continue;
    if (best == now.size() || scores.drivers()[i].who < scores.drivers()[best].who) best = i;
  }
  return best;
}

}  // namespace

ContrastData contrast_data(const StudyFrame& frame, const DataShape& shape, std::span<const Series> runs) {
  const std::size_t n = frame.sensors.size();
  ContrastData data;
  for (const DataShape::Run& wanted : shape.runs) {
    std::vector<Gaps>& gaps = data.gaps.emplace_back(1 + n);
    data.shortest.push_back(0.0);
    const Series* run = run_of(runs, wanted);
    if (run == nullptr) continue;
    Series main = *run;
    main.main_end = std::min(main.main_end, main.main_begin + wanted.n_main);
    const std::size_t first = main.main_begin * n;
    for (std::size_t i = 0; i < std::min(wanted.unknown.size(), main.main_end * n - first); ++i) {
      if (wanted.unknown[i] != 0) main.bits[first + i] = unknown_bit;
    }
    data.shortest.back() = shortest_stretch(main, n);
    const std::vector<Gaps> own = gaps_of(main, n);
    for (std::size_t s = 0; s < n; ++s) {
      gaps[0].awaited += own[s].awaited;
      gaps[0].silent += own[s].silent;
      gaps[1 + s] = own[s];
    }
  }
  return data;
}

std::vector<ResidualDriver> telling_contrasts(const StudyFrame& frame, const DataShape& shape,
                                              const ContrastData& measured, const std::vector<ContrastData>& simulated,
                                              double alpha) {
  std::vector<ResidualDriver> telling;
  const auto look = [&](std::span<const ContrastWords> words, const auto& values_of) {
    std::vector<std::vector<double>> usual;
    for (const ContrastData& one : simulated) usual.push_back(values_of(one));
    const auto found = strongest(words, values_of(measured), usual);
    if (found && found->p <= alpha) telling.push_back(*found);
  };
  const Session session(frame, shape, simulated);
  for (const bool of_all : {true, false}) {
    std::vector<const Contrast*> contrasts;
    std::vector<ContrastWords> words;
    for (const Contrast& contrast : session.contrasts()) {
      if ((contrast.column == 0) != of_all) continue;
      contrasts.push_back(&contrast);
      words.push_back(contrast.words);
    }
    if (of_all && !words.empty())
      words.push_back({all_sensors, "from trial to trial", "motion, once begun, lasts longer and longer",
                       "motion, once begun, lasts less and less"});
    look(words, [&](const ContrastData& data) {
      std::vector<double> values;
      for (const Contrast* contrast : contrasts) values.push_back(session.value(*contrast, data));
      if (values.size() < words.size()) values.push_back(session.growth_of_stretches(data));
      return values;
    });
  }
  std::ranges::stable_sort(telling, std::ranges::greater{}, [](const ResidualDriver& d) { return std::abs(d.z); });
  return telling;
}

Residuals explain_residuals(const ReferenceStudy& reference, const Measured& measured, double alpha,
                            const Context& context) {
  const Profile& profile = reference.table.profile;
  const Bits bits(reference, profile);
  const Scores scores(reference, bits);
  const std::vector<std::uint8_t> measured_bits = bits.of(measured.runs, profile);
  const Usual usual = simulate_usual(reference, bits, scores, measured_bits, alpha, context);
  Regression regression(bits, scores, measured_bits);
  Residuals result;
  while (result.drivers.size() < most_drivers) {
    const std::vector<double> now = regression.scores();
    const std::size_t best = strongest(usual, scores, now);
    const double z = usual.z(best, now[best]), p = usual.p(best, now[best]);
    if (p > alpha) break;
    const Driver& driver = scores.drivers()[best];
    regression.add(driver);
    const Who& who = scores.who(driver);
    std::string when = scores.when(driver).words;
    if (!who.is_trial) when += (when.empty() ? "" : ", ") + std::string("whatever the seat");
    result.drivers.push_back({who.words, std::move(when), what_of(driver.how, z, reference.frame.sensors[driver.other]),
                              regression.log_odds(), regression.standard_error(), z, p, usual.least_p(best)});
  }
  return result;
}

Residuals explain_rest(const ReferenceStudy& plain, std::span<const FittedEffect> applied, const Measured& measured,
                       double alpha, const Context& context) {
  RealizationSource source = plain.source;
  for (const FittedEffect& effect : applied) source.script.effects.push_back(effect.effect);
  constexpr double as_strong = 3.0;  // datasets that may be as strong, the data among them: fewer datasets see less
  const auto n = static_cast<std::uint32_t>(std::ceil(as_strong * n_contrast_kinds / alpha));
  const auto data_of = [&](std::span<const Series> runs) { return contrast_data(plain.frame, plain.shape, runs); };
  return {telling_contrasts(plain.frame, plain.shape, data_of(measured.runs),
                            of_fresh_datasets(source, plain, n, context, data_of), alpha)};
}

}  // namespace pirsim::reconcile
