#include "calibrate/errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/weighted.hpp"
#include "core/parallel.hpp"
#include "counting/passes.hpp"

namespace pirsim::calibrate {
namespace {

using counting::Counter;
using counting::Estimates;
using counting::LabelledRoom;

/// What each room's model says of a day.
struct DayByRooms {
  std::vector<Estimates> estimates;
  std::vector<double> log_likelihoods;
};

DayByRooms by_each_room(const Counter& counter, counting::Stretch day) {
  day.people.clear();
  const auto readings = counting::readings_of(day);
  const std::size_t modes = counting::size(counter.settings.modes);
  DayByRooms by;
  for (const counting::RoomModel& room : counter.rooms) {
    const counting::ForwardPass pass = counting::forward(counter, room, readings);
    Estimates own{counter.n_counts, std::vector<double>(pass.beliefs.size() / modes, 0.0)};
    for (std::size_t i = 0; i < pass.beliefs.size(); ++i) own.probabilities[i / modes] += pass.beliefs[i];
    by.estimates.push_back(std::move(own));
    by.log_likelihoods.push_back(pass.log_likelihood);
  }
  return by;
}

struct AbsoluteError {
  double sum = 0.0, n = 0.0;
  [[nodiscard]] std::optional<double> mean() const { return n > 0.0 ? std::optional(sum / n) : std::nullopt; }
};

void add_error(const std::vector<Estimates>& each, std::span<const double> weights, const std::vector<int>& people,
               double step_s, AbsoluteError& error) {
  Estimates mixed{each.front().n_counts, std::vector<double>(each.front().probabilities.size(), 0.0)};
  for (std::size_t r = 0; r < each.size(); ++r) {
    for (std::size_t i = 0; i < mixed.probabilities.size(); ++i)
      mixed.probabilities[i] += weights[r] * each[r].probabilities[i];
  }
  const std::vector<bool> counts = in_use(people, step_s);
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (!counts[i] || people[i] == counting::unknown_count) continue;
    error.sum += std::abs(mixed.count(i) - people[i]);
    error.n += 1.0;
  }
}

struct ErrorOfRoom {
  std::optional<double> weighed, alike;
};

ErrorOfRoom error_of_room(const Counter& counter, const LabelledRoom& room, std::size_t own) {
  std::vector<DayByRooms> days;
  std::vector<double> scores(counter.rooms.size(), 0.0);
  for (const counting::Stretch& day : room.days) {
    days.push_back(by_each_room(counter, day));
    for (std::size_t r = 0; r < scores.size(); ++r) scores[r] += days.back().log_likelihoods[r];
  }
  scores[own] = -std::numeric_limits<double>::infinity();
  Counter others = counter;
  counting::weigh(others, scores);
  std::vector<double> weights, alike(scores.size(), 1.0 / static_cast<double>(scores.size() - 1));
  for (const counting::RoomModel& model : others.rooms) weights.push_back(model.weight);
  alike[own] = 0.0;
  AbsoluteError weighed_error, alike_error;
  for (std::size_t d = 0; d < days.size(); ++d) {
    add_error(days[d].estimates, weights, room.days[d].people, counter.settings.step_s, weighed_error);
    add_error(days[d].estimates, alike, room.days[d].people, counter.settings.step_s, alike_error);
  }
  return {weighed_error.mean(), alike_error.mean()};
}

}  // namespace

std::vector<bool> in_use(const std::vector<int>& people, double step_s) {
  constexpr double around_s = 1800.0;
  const auto around = static_cast<std::ptrdiff_t>(std::lround(around_s / step_s));
  const auto is_there = [](int n) { return n > 0; };
  const auto first = std::ranges::find_if(people, is_there);
  std::vector<bool> counts(people.size(), false);
  if (first == people.end()) return counts;
  const auto last = std::find_if(people.rbegin(), people.rend(), is_there).base();  // one beyond
  const std::ptrdiff_t from = std::max<std::ptrdiff_t>(0, first - people.begin() - around);
  const std::ptrdiff_t to = std::min(std::ssize(people), last - people.begin() + around);
  std::fill(counts.begin() + from, counts.begin() + to, true);
  return counts;
}

RoomErrors errors_of_rooms(const Counter& counter, std::span<const LabelledRoom> rooms, unsigned threads) {
  RoomErrors errors;
  ordered_parallel<ErrorOfRoom>(
      rooms.size(), threads, [&](std::size_t r) { return error_of_room(counter, rooms[r], r); },
      [&](ErrorOfRoom& one) {
        errors.weighed.push_back(one.weighed);
        errors.alike.push_back(one.alike);
      });
  return errors;
}

void expect_error(const RoomErrors& errors, std::span<const double> weights, Calibration& made) {
  // Square roots of the weights: with the weights themselves, intervals were too narrow (83 of 100 rooms that were left
  // out in turn; with their roots 90).
  std::vector<double> weighed, alike, own_weights, roots;
  for (std::size_t r = 0; r < weights.size(); ++r) {
    if (!errors.weighed[r] || !errors.alike[r]) continue;
    weighed.push_back(*errors.weighed[r]);
    alike.push_back(*errors.alike[r]);
    own_weights.push_back(weights[r]);
    roots.push_back(std::sqrt(weights[r]));
  }
  if (weighed.empty()) return;
  made.mean_error = weighted_mean(weighed, own_weights);
  made.error_alike = weighted_mean(alike, own_weights);
  made.counter.expected_error = weighted_interval(weighed, roots);
}

}  // namespace pirsim::calibrate
