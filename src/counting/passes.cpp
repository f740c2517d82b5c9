#include "counting/passes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pirsim::counting {
namespace {

double choose(int n, int k) {
  double ways = 1.0;
  for (int i = 1; i <= k; ++i) ways *= static_cast<double>(n - k + i) / i;
  return k < 0 || k > n ? 0.0 : ways;
}

double normalize(std::span<double> values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  for (double& value : values) value /= sum;
  return sum;
}

}  // namespace

void divide_rows(std::span<double> table, std::size_t n_columns) {
  for (std::size_t row = 0; row < table.size(); row += n_columns) normalize(table.subspan(row, n_columns));
}

std::vector<Reading> readings_of(const Stretch& stretch) {
  std::vector<Reading> readings(stretch.n_readings());
  for (std::size_t i = 0; i < readings.size(); ++i) {
    for (std::size_t k = 0; k < size(stretch.n_sensors); ++k) {
      const std::uint8_t bit = stretch.motion[i * size(stretch.n_sensors) + k];
      readings[i].known += bit == unknown_bit ? 0 : 1;
      readings[i].active += bit == 1 ? 1 : 0;
    }
    if (!stretch.people.empty()) readings[i].people = stretch.people[i];
  }
  return readings;
}

StateRange states_of(const Counter& counter, const Reading& reading) {
  if (reading.people == unknown_count) return {0, size(counter.n_states())};
  const std::size_t count = size(std::min(reading.people, counter.n_counts - 1)), modes = size(counter.settings.modes);
  return {count * modes, (count + 1) * modes};
}

void likelihood(const Counter& counter, std::span<const double> emissions, const Reading& reading,
                std::vector<double>& out) {
  const std::size_t n_symbols = size(counter.n_symbols());
  const StateRange range = states_of(counter, reading);
  out.assign(size(counter.n_states()), 0.0);
  for (std::size_t state = range.begin; state < range.end; ++state) {
    const std::span<const double> own = emissions.subspan(state * n_symbols, n_symbols);
    if (reading.known == counter.n_sensors) {
      out[state] = own[size(reading.active)];
      continue;
    }
    const int unknown = counter.n_sensors - reading.known;
    for (int all = reading.active; all <= reading.active + unknown; ++all) {
      out[state] += own[size(all)] * choose(all, reading.active) *
                    choose(counter.n_sensors - all, reading.known - reading.active) /
                    choose(counter.n_sensors, reading.known);
    }
  }
}

double step(const Counter& counter, const RoomModel& room, std::span<const double> before, StateRange range_before,
            const Reading& reading, std::span<double> after) {
  const std::size_t n = size(counter.n_states());
  const StateRange range = states_of(counter, reading);
  std::vector<double> seen;
  likelihood(counter, room.emissions, reading, seen);
  std::ranges::fill(after, 0.0);
  if (before.empty()) std::ranges::copy(room.first, after.begin());
  for (std::size_t from = range_before.begin; from < range_before.end && !before.empty(); ++from) {
    for (std::size_t to = range.begin; to < range.end; ++to) after[to] += before[from] * counter.moves[from * n + to];
  }
  for (std::size_t state = 0; state < n; ++state) after[state] *= seen[state];
  return normalize(after);
}

ForwardPass forward(const Counter& counter, const RoomModel& room, std::span<const Reading> readings) {
  const std::size_t n = size(counter.n_states());
  ForwardPass pass{std::vector<double>(readings.size() * n), 0.0};
  std::span<const double> before;
  StateRange range;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const std::span<double> now(pass.beliefs.data() + i * n, n);
    pass.log_likelihood += std::log(step(counter, room, before, range, readings[i], now));
    before = now;
    range = states_of(counter, readings[i]);
  }
  return pass;
}

void smooth(const Counter& counter, std::span<const Reading> readings, std::vector<double>& beliefs,
            std::span<double> moved) {
  const std::size_t n = size(counter.n_states());
  constexpr double most_ratio = 1e290;  // finite, however sure the past was of what the future refutes
  std::vector<double> ratio(n);         // of what is believed of the next reading to what was expected of it
  for (std::size_t i = readings.size() < 2 ? 0 : readings.size() - 1; i-- > 0;) {
    const std::span<double> now(beliefs.data() + i * n, n), next(beliefs.data() + (i + 1) * n, n);
    const StateRange range = states_of(counter, readings[i]), after = states_of(counter, readings[i + 1]);
    std::ranges::fill(ratio, 0.0);
    for (std::size_t from = range.begin; from < range.end; ++from) {
      for (std::size_t to = after.begin; to < after.end; ++to) ratio[to] += now[from] * counter.moves[from * n + to];
    }
    for (std::size_t to = after.begin; to < after.end; ++to)
      ratio[to] = next[to] > 0.0 ? std::min(next[to] / ratio[to], most_ratio) : 0.0;
    for (std::size_t from = range.begin; from < range.end; ++from) {
      double later = 0.0;
      for (std::size_t to = after.begin; to < after.end; ++to) {
        const double factor = counter.moves[from * n + to] * ratio[to];
        later += factor;
        if (!moved.empty()) moved[from * n + to] += now[from] * factor;
      }
      now[from] *= later;
    }
    normalize(now);
  }
}

}  // namespace pirsim::counting
