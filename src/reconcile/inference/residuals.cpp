#include "reconcile/inference/residuals.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.hpp"
#include "reconcile/inference/residual_contrasts.hpp"
#include "reconcile/inference/residual_drivers.hpp"
#include "stats/intervals.hpp"
#include "stats/logistic.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t first_residual_realization = 1U
                                                     << 22U;  ///< realizations that neither profile nor table has seen
constexpr double least_chance = 0.01;       ///< of motion in a window (assumed): profiles are means of few runs
constexpr std::uint32_t n_simulated = 100;  ///< datasets that scores are compared with; more if alpha needs them
constexpr std::size_t most_drivers = 3;
constexpr double little = 0.05, much = 0.3;
constexpr double least_information = 1.0;  ///< bits' worth of variance (assumed): one bit alone proves nothing

/// One bit of a dataset.
struct Place {
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
      const auto run = std::ranges::find_if(
          runs, [&](const Series& s) { return s.trial == wanted.trial && s.replicate == wanted.replicate; });
      for (std::size_t i = 0; i < size; ++i) {
        const bool there = run != runs.end() && run->main_begin * n + i < run->main_end * n;
        const bool moved = there && run->bits[run->main_begin * n + i] == 1;
        bits.push_back(moved && known[bits.size()] != 0 ? 1 : 0);
      }
    }
    return bits;
  }

  std::vector<Place> places;
  std::vector<double> chance, odds;  ///< that the plain model gives motion
  std::vector<std::uint8_t> known;

 private:
  const ReferenceStudy& reference_;
};

using How = ResidualDriver::How;

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
            how == How::beside ? when_[when].is_always() : how == How::more || !when_[when].is_wave();
        for (std::size_t who = 0; who < who_.size(); ++who) drivers_.push_back({who, when, how, other, makes_sense});
      }
    }
  }
  [[nodiscard]] const std::vector<Driver>& drivers() const noexcept { return drivers_; }
  [[nodiscard]] const Who& who(const Driver& driver) const { return who_[driver.who]; }
  [[nodiscard]] const When& when(const Driver& driver) const { return when_[driver.when]; }

  /// What the driver multiplies its coefficient with, at one place of a dataset.
  [[nodiscard]] double value(const Driver& driver, std::span<const std::uint8_t> bits, std::size_t place) const {
    const Place& at = bits_.places[place];
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
      case How::with_gaps:  // no drivers of single bits
      case How::silent_together:
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
      const Place& at = bits_.places[place];
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
enum Kind : std::size_t { level, time_of_run, neighbour, n_kinds };

/// How the scores of simulated datasets scatter.
class Usual {
 public:
  /// simulated: (n_datasets x n_drivers); independent: (n_drivers) variances if all bits were independent.
  Usual(std::vector<std::vector<double>> simulated, std::vector<double> independent, std::vector<Kind> kinds)
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
  std::vector<Kind> kinds_;                              ///< (n_drivers)
  std::array<std::vector<double>, n_kinds> greatest_{};  ///< (n_kinds x n_datasets)
  double dispersion_ = 1.0;                              ///< scatter over that of independent bits, of most drivers
};

std::vector<double> residuals_of(const std::vector<std::uint8_t>& bits, const std::vector<double>& chance) {
  std::vector<double> residuals(bits.size());
  for (std::size_t i = 0; i < bits.size(); ++i) residuals[i] = static_cast<double>(bits[i]) - chance[i];
  return residuals;
}

Usual simulate_usual(const ReferenceStudy& reference, const Bits& bits, const Scores& scores,
                     const std::vector<std::uint8_t>& measured, double alpha, const Context& context) {
  std::vector<std::vector<double>> simulated;
  const Profile& profile = reference.table.profile;
  ordered_parallel<std::vector<double>>(
      std::max(n_simulated, static_cast<std::uint32_t>(std::ceil(static_cast<double>(n_kinds) / alpha))),
      context.threads,
      [&](std::size_t i) {
        const SimulatedRealization realization(reference.source, reference.frame,
                                               first_residual_realization + static_cast<std::uint32_t>(i),
                                               reference.shape.n_replicates);
        const std::vector<std::uint8_t> own = bits.of(realization.plain(0, reference.shape.n_replicates), profile);
        return scores.sums(own, residuals_of(own, bits.chance));
      },
      [&](std::vector<double>& one) { simulated.push_back(std::move(one)); });
  std::vector<double> independent;
  for (const double p : bits.chance) independent.push_back(p * (1.0 - p));
  std::vector<Kind> kinds;
  for (const Driver& driver : scores.drivers())
    kinds.push_back(driver.how == How::beside ? neighbour : scores.when(driver).is_always() ? level : time_of_run);
  return {std::move(simulated), scores.sums(measured, independent, Scores::Power::two), std::move(kinds)};
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
      columns.append_row(std::span<const double>(values(place)));
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
    const When& when = scores.when(driver);
    result.drivers.push_back({who.who,
                              who.name,
                              when.when,
                              when.from,
                              when.to,
                              driver.how,
                              z > 0.0,
                              reference.frame.sensors[driver.other],
                              regression.log_odds(),
                              regression.standard_error(),
                              z,
                              p,
                              {},
                              usual.least_p(best)});
  }
  return result;
}

Residuals explain_rest(const ReferenceStudy& plain, std::span<const FittedEffect> applied, const Measured& measured,
                       double alpha, const Context& context) {
  RealizationSource source = plain.source;
  for (const FittedEffect& effect : applied) source.script.effects.push_back(effect.effect);
  const int n_replicates = plain.shape.n_replicates;
  constexpr double as_strong = 3.0;  // datasets that may be as strong, the data among them: fewer datasets see less
  const auto n = static_cast<std::uint32_t>(std::ceil(as_strong * n_contrast_kinds / alpha));
  std::vector<ContrastData> simulated;
  ordered_parallel<ContrastData>(
      n, context.threads,
      [&](std::size_t i) {
        const SimulatedRealization one(source, plain.frame, first_residual_realization + static_cast<std::uint32_t>(i),
                                       n_replicates);
        return contrast_data(plain.frame, plain.shape, one.plain(0, n_replicates));
      },
      [&](ContrastData& one) { simulated.push_back(std::move(one)); });
  return {telling_contrasts(plain.frame, plain.shape, contrast_data(plain.frame, plain.shape, measured.runs), simulated,
                            alpha)};
}

}  // namespace pirsim::reconcile
