// A small study for tests of locating and naming: bits of 10 trials x 5 sensors, unknowns that are always there, six
// known effects and two that no catalogue has.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pirsim/random.hpp"
#include "stats/matrix.hpp"

namespace toy {

enum Effect {
  nothing,
  missed,          ///< each bit is lost with one probability
  false_triggers,  ///< each silent second is set with one probability
  shifted,         ///< the pattern over the cells is moved
  stretched,       ///< a bit is followed by another with one probability
  dead_sensor,     ///< one sensor is silent from some second on
  soft,            ///< the cells' log-odds are drawn together
  n_known,
  unknown_bursts = n_known,  ///< all sensors fire together now and then
  unknown_fading,            ///< sensors tire over each trial
};

constexpr std::size_t n_trials = 10, n_sensors = 5;

/// What is true in one dataset besides chance.
struct Realization {
  std::array<double, n_trials * n_sensors> log_odds{};
  double loss = 0.0, extra = 0.0, follow = 0.0, burst = 0.0, fading = 0.0;
  std::size_t dead = n_sensors;
  int dead_from = 0;
};

inline double pattern(double trial, double sensor) {
  return -1.2 + 1.5 * std::sin(1.3 * trial + 2.1 * sensor) + 0.9 * std::cos(0.7 * trial - 1.1 * sensor);
}

inline Realization draw_realization(Effect effect, int seconds, pirsim::Stream& stream) {
  Realization realization;
  // Nuisance: a small shift, a gain per sensor and an offset per trial, never known exactly.
  double shift = 0.06 * stream.normal(), flat = 0.0;
  std::array<double, n_sensors> gain{};
  for (double& value : gain) value = 0.15 * stream.normal();
  std::array<double, n_trials> offset{};
  for (double& value : offset) value = 0.1 * stream.normal();
  const double strength = stream.uniform();
  const double sign = stream.uniform() < 0.5 ? -1.0 : 1.0;
  switch (effect) {
    case missed:
      realization.loss = 0.15 + 0.45 * strength;
      break;
    case false_triggers:
      realization.extra = 0.01 * std::pow(10.0, strength);
      break;
    case shifted:
      shift += sign * (0.25 + 0.5 * strength);
      break;
    case stretched:
      realization.follow = 0.2 + 0.6 * strength;
      break;
    case dead_sensor:
      realization.dead = stream.index(n_sensors);
      realization.dead_from = static_cast<int>(0.6 * strength * seconds);
      break;
    case soft:
      flat = 0.25 + 0.6 * strength;
      break;
    case unknown_bursts:
      realization.burst = 0.05 + 0.1 * strength;
      break;
    case unknown_fading:
      realization.fading = 1.5 + 2.0 * strength;
      break;
    default:
      break;
  }
  for (std::size_t t = 0; t < n_trials; ++t) {
    for (std::size_t s = 0; s < n_sensors; ++s) {
      const double exact = pattern(static_cast<double>(t) + shift, static_cast<double>(s) + 0.5 * shift);
      realization.log_odds[t * n_sensors + s] = exact + flat * (-0.5 - exact) + gain[s] + offset[t];
    }
  }
  return realization;
}

constexpr std::size_t n_per_cell = 4;
constexpr std::size_t n_statistics = n_per_cell * (n_trials * n_sensors + n_trials + n_sensors) + n_trials + 1;

/// Adds the cells' sums over sensors, then over trials: a small change that all cells share is seen there.
inline void add_sums(std::vector<float>& statistics, const std::vector<float>& together) {
  std::array<float, n_per_cell * n_trials> per_trial{};
  std::array<float, n_per_cell * n_sensors> per_sensor{};
  for (std::size_t t = 0; t < n_trials; ++t) {
    for (std::size_t s = 0; s < n_sensors; ++s) {
      for (std::size_t k = 0; k < n_per_cell; ++k) {
        const float value = statistics[(t * n_sensors + s) * n_per_cell + k];
        per_trial[t * n_per_cell + k] += value;
        per_sensor[s * n_per_cell + k] += value;
      }
    }
  }
  statistics.insert(statistics.end(), per_trial.begin(), per_trial.end());
  statistics.insert(statistics.end(), together.begin(), together.end());
  statistics.insert(statistics.end(), per_sensor.begin(), per_sensor.end());
  float total = 0.0F;
  for (const float value : together) total += value;
  statistics.push_back(total);
}

/// Columns of the cells, of the trials and of the sensors.
inline std::vector<std::vector<std::size_t>> blocks() {
  constexpr std::size_t cells = n_per_cell * n_trials * n_sensors, trials = cells + (n_per_cell + 1) * n_trials;
  std::vector<std::vector<std::size_t>> columns(3);
  for (std::size_t c = 0; c < n_statistics; ++c) columns[c < cells ? 0 : (c < trials ? 1 : 2)].push_back(c);
  return columns;
}

/// Per cell: sum, number of runs, second half less first half, pairs of bits two seconds apart; per trial: seconds in
/// which three sensors or more are on; and sums, see add_sums().
inline std::vector<float> draw_statistics(const Realization& realization, int seconds, pirsim::Stream& stream) {
  std::vector<float> statistics, in_company;
  for (std::size_t t = 0; t < n_trials; ++t) {
    std::array<std::array<int, 3>, n_sensors> last{};
    std::array<std::array<int, 4>, n_sensors> found{};
    int together = 0;
    for (int second = 0; second < seconds; ++second) {
      const bool burst = stream.uniform() < realization.burst;
      const double tired = realization.fading * second / seconds;
      int on = 0;
      for (std::size_t s = 0; s < n_sensors; ++s) {
        const double odds = realization.log_odds[t * n_sensors + s] - tired + 0.5 * realization.fading;
        bool bit = stream.uniform() < 1.0 / (1.0 + std::exp(-odds));
        bit = bit && stream.uniform() >= realization.loss;
        bit = bit || stream.uniform() < realization.extra;
        bit = bit || burst;
        bit = bit || (last[s][0] == 1 && stream.uniform() < realization.follow);
        bit = bit && !(s == realization.dead && second >= realization.dead_from);
        const int value = bit ? 1 : 0;
        found[s][0] += value;
        found[s][1] += value == 1 && last[s][0] == 0 ? 1 : 0;
        found[s][2] += second >= seconds / 2 ? value : -value;
        found[s][3] += value * last[s][1];
        last[s] = {value, last[s][0], last[s][1]};
        on += value;
      }
      together += on >= 3 ? 1 : 0;
    }
    for (const auto& cell : found)
      for (const int value : cell) statistics.push_back(static_cast<float>(value));
    in_company.push_back(static_cast<float>(together));
  }
  add_sums(statistics, in_company);
  return statistics;
}

/// (rows x n_statistics) datasets of one effect, each in a realization of its own.
inline pirsim::stats::Matrix<float> draw_datasets(Effect effect, std::size_t rows, int seconds, std::uint64_t seed) {
  pirsim::stats::Matrix<float> drawn;
  for (std::size_t row = 0; row < rows; ++row) {
    pirsim::Stream stream(
        {seed, static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(effect), pirsim::Purpose::test});
    const Realization realization = draw_realization(effect, seconds, stream);
    drawn.append_row(draw_statistics(realization, seconds, stream));
  }
  return drawn;
}

}  // namespace toy
