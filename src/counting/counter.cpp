#include <algorithm>
#include <cmath>
#include <limits>

#include "counting/passes.hpp"
#include "pirsim/error.hpp"

namespace pirsim::counting {
namespace {

/// Adds the probabilities of each count, whatever the mode.
void add_counts(std::span<const double> beliefs, double weight, std::size_t modes, std::span<double> counts) {
  for (std::size_t state = 0; state < beliefs.size(); ++state) counts[state / modes] += weight * beliefs[state];
}

constexpr double nobody_knows = std::numeric_limits<double>::quiet_NaN();
constexpr double never_s = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<double> log_likelihoods(const Counter& counter, std::span<const Stretch> stretches) {
  std::vector<double> sums(counter.rooms.size(), 0.0);
  for (const Stretch& stretch : stretches) {
    const std::vector<Reading> readings = readings_of(stretch);
    for (std::size_t r = 0; r < sums.size(); ++r)
      sums[r] += forward(counter, counter.rooms[r], readings).log_likelihood;
  }
  return sums;
}

void weigh(Counter& counter, std::span<const double> log_likelihoods) {
  const double most = *std::ranges::max_element(log_likelihoods);
  double sum = 0.0;
  for (std::size_t r = 0; r < counter.rooms.size(); ++r) {
    RoomModel& room = counter.rooms[r];
    room.weight = std::exp(counter.settings.weight_power * (log_likelihoods[r] - most));
    sum += room.weight;
  }
  for (RoomModel& room : counter.rooms) room.weight /= sum;
}

std::vector<char> told_readings(const Stretch& stretch, double step_s, Pass pass) {
  const std::vector<Reading> readings = readings_of(stretch);
  std::vector<char> told(readings.size(), 0);
  double unknown_s = never_s;
  const auto look = [&](std::size_t i) {
    unknown_s = readings[i].known > 0 ? 0.0 : unknown_s + step_s;
    if (unknown_s <= longest_guess_s) told[i] = 1;
  };
  for (std::size_t i = 0; i < readings.size(); ++i) look(i);
  unknown_s = never_s;
  for (std::size_t i = readings.size(); pass == Pass::smoothed && i-- > 0;) look(i);
  return told;
}

bool Estimates::is_told(std::size_t reading) const { return !std::isnan(probabilities[reading * size(n_counts)]); }

int Estimates::quantile(std::size_t reading, double share) const {
  double reached = 0.0;
  for (int n = 0; n < n_counts - 1; ++n) {
    reached += probabilities[reading * size(n_counts) + size(n)];
    if (reached >= share - 1e-9) return n;
  }
  return n_counts - 1;
}

Estimates estimate(const Counter& counter, const Stretch& stretch, Pass pass) {
  const std::vector<Reading> readings = readings_of(stretch);
  const std::size_t modes = size(counter.settings.modes);
  Estimates mixed{counter.n_counts, std::vector<double>(readings.size() * size(counter.n_counts), 0.0)};
  for (const RoomModel& room : counter.rooms) {
    if (!(room.weight > 0.0)) continue;
    std::vector<double> own = forward(counter, room, readings).beliefs;
    if (pass == Pass::smoothed) smooth(counter, readings, own);
    add_counts(own, room.weight, modes, mixed.probabilities);
  }
  const std::vector<char> told = told_readings(stretch, counter.settings.step_s, pass);
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (told[i] == 0)
      std::ranges::fill(std::span(mixed.probabilities).subspan(i * size(mixed.n_counts), size(mixed.n_counts)),
                        nobody_knows);
  }
  return mixed;
}

LiveCount::LiveCount(const Counter& counter) : counter_(&counter), unknown_s_(never_s) {}

std::vector<double> LiveCount::next(std::span<const std::uint8_t> bits) {
  const Counter& counter = *counter_;
  if (bits.size() != size(counter.n_sensors)) {
    throw Error(ErrorCode::usage, "expected " + std::to_string(counter.n_sensors) + " bits, one a sensor, got " +
                                      std::to_string(bits.size()));
  }
  const std::size_t n = size(counter.n_states());
  const Reading reading = readings_of({counter.n_sensors, {bits.begin(), bits.end()}}).front();
  std::vector<double> counts(size(counter.n_counts), 0.0), next(counter.rooms.size() * n);
  for (std::size_t r = 0; r < counter.rooms.size(); ++r) {
    const std::span<const double> before = belief_.empty() ? std::span<double>() : std::span(belief_).subspan(r * n, n);
    const std::span<double> now = std::span(next).subspan(r * n, n);
    static_cast<void>(step(counter, counter.rooms[r], before, {0, n}, reading, now));
    add_counts(now, counter.rooms[r].weight, size(counter.settings.modes), counts);
  }
  belief_ = std::move(next);
  unknown_s_ = reading.known > 0 ? 0.0 : unknown_s_ + counter.settings.step_s;
  if (unknown_s_ > longest_guess_s) std::ranges::fill(counts, nobody_knows);
  return counts;
}

}  // namespace pirsim::counting
