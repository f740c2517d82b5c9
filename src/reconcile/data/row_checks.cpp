// Rows of all sensors together that no logger hears.
#include <algorithm>
#include <cmath>
#include <optional>

#include "reconcile/data/data_checks.hpp"

namespace pirsim::reconcile {
namespace {

using What = DataFinding::What;

constexpr double beyond_model = 1.5;          ///< times as much as any of the model's runs has (assumed)
constexpr std::size_t shortest_silence = 20;  ///< rows: what is shorter isn't told
constexpr std::size_t fewest_gaps = 5;        ///< in a run, by which its longest one is judged

// All columns together.

struct Polls {
  double n = 0.0, n_off = 0.0, chance = 0.0;  ///< changes, those off the grid, logarithm
  [[nodiscard]] double share() const noexcept { return n > 0.0 ? 1.0 - n_off / n : 1.0; }
};

/// Changes of any sensor on a grid of so many rows that begins anywhere in a run.
Polls polls_of(const DatasetRows& data, std::size_t period) {
  Polls polls;
  for (const Series& run : data.runs) {
    std::vector<double> n_at(period, 0.0);
    double n = 0.0;
    for (std::size_t i = data.n_sensors; i < run.bits.size(); ++i) {
      const std::uint8_t bit = run.bits[i], before = run.bits[i - data.n_sensors];
      if (bit == before || std::max(bit, before) == unknown_bit) continue;
      n_at[i / data.n_sensors % period] += 1.0;
      n += 1.0;
    }
    const double most = *std::ranges::max_element(n_at), log_period = std::log(static_cast<double>(period));
    polls.n += n;
    polls.n_off += n - most;
    polls.chance += std::min(0.0, log_period - most * log_period);
  }
  return polls;
}

}  // namespace

void find_polls(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                std::vector<DataFinding>& findings) {
  for (std::size_t period = longest_period; period >= 2; --period) {
    const Polls polls = polls_of(data, period);
    if (polls.n < static_cast<double>(fewest_edges) || polls.n_off > may_differ / 2.0 * polls.n) continue;
    if (polls.chance > log_level) continue;
    if (greatest_of(pilot, [&](const DatasetRows& d) { return polls_of(d, period).share(); }) > model_has_it) continue;
    findings.push_back({.what = What::polled,
                        .n_rows = data.n_rows(),
                        .every_s = static_cast<double>(period) * frame.window_s,
                        .chance = std::exp(polls.chance)});
    return;  // its divisors do as well
  }
}

namespace {

DataFinding::Place place(const StudyFrame& frame, const Series& run, std::size_t row, std::size_t n_rows) {
  return {frame.trials[run.trial], run.replicate, row + 1, row + n_rows};
}

}  // namespace

/// Two beats together repeat rows in many places, so that one repeat must be beyond the third of the data as well; in a
/// single run, it is merely odd.
void find_repeat(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                 std::vector<DataFinding>& findings) {
  const Repeats repeats = greatest_repeats(data);
  for (const auto which : {&Repeats::between_runs, &Repeats::in_a_run}) {
    const std::vector<Repeat>& own = repeats.*which;
    if (own.empty()) continue;
    const Repeat& repeat = own.front();
    const double n_pairs = 2.0 * std::log(static_cast<double>(data.n_rows()));
    const double chance = n_pairs - repeat.information * std::log(2.0);
    if (chance > log_level) continue;
    const double third = own.size() == Repeats::most ? own.back().information : 0.0;
    const double usual = greatest_of(pilot, [&](const DatasetRows& d) {
      const Repeats simulated = greatest_repeats(d);
      return (simulated.*which).empty() ? 0.0 : (simulated.*which).front().information;
    });
    if (repeat.information < beyond_model * std::max(usual, third)) continue;
    findings.push_back({.what = What::repeated_rows,
                        .places = {place(frame, data.runs[repeat.run], repeat.row, repeat.n_rows),
                                   place(frame, data.runs[repeat.other_run], repeat.other_row, repeat.n_rows)},
                        .n_rows = repeat.n_rows,
                        .chance = std::exp(chance),
                        .is_impossible = which == &Repeats::between_runs});
    return;
  }
}

namespace {

/// Rows without any motion between two with some.
struct Gap {
  std::size_t run = 0, row = 0, n_rows = 0;
};

std::vector<Gap> gaps_of(const DatasetRows& data, std::size_t number) {
  const Series& run = data.runs[number];
  std::vector<Gap> gaps;
  std::optional<std::size_t> last;  // row with motion
  for (std::size_t row = 0; row < run.n_rows(data.n_sensors); ++row) {
    const auto bits = std::span(run.bits).subspan(row * data.n_sensors, data.n_sensors);
    if (std::ranges::find(bits, unknown_bit) != bits.end()) last.reset();
    if (std::ranges::find(bits, 1) == bits.end()) continue;
    if (last && row > *last + 1) gaps.push_back({number, *last + 1, row - *last - 1});
    last = row;
  }
  return gaps;
}

/// Of the run in which it is longest, measured by the mean of the other gaps.
struct Silence {
  Gap gap;
  double times_usual = 0.0;
  std::size_t n_gaps = 0;  ///< in the dataset
};

Silence greatest_silence(const DatasetRows& data) {
  Silence greatest;
  std::size_t n_gaps = 0;
  for (std::size_t number = 0; number < data.runs.size(); ++number) {
    const std::vector<Gap> gaps = gaps_of(data, number);
    n_gaps += gaps.size();
    if (gaps.size() <= fewest_gaps) continue;
    const Gap& longest = *std::ranges::max_element(gaps, {}, &Gap::n_rows);
    double sum = 0.0;
    for (const Gap& gap : gaps) sum += static_cast<double>(gap.n_rows);
    const auto length = static_cast<double>(longest.n_rows);
    const double times = length / std::max(1.0, (sum - length) / static_cast<double>(gaps.size() - 1));
    if (times > greatest.times_usual) greatest = {longest, times, 0};
  }
  greatest.n_gaps = n_gaps;
  return greatest;
}

/// If gaps end by chance, none is so long among so many.
std::optional<DataFinding> impossible_silence(const StudyFrame& frame, const DatasetRows& data,
                                              std::span<const DatasetRows> pilot) {
  const Silence silence = greatest_silence(data);
  if (silence.n_gaps == 0) return std::nullopt;
  const double chance = std::log(static_cast<double>(silence.n_gaps)) - silence.times_usual;
  if (chance > log_level) return std::nullopt;
  const double usual = greatest_of(pilot, [](const DatasetRows& d) { return greatest_silence(d).times_usual; });
  if (silence.times_usual < beyond_model * usual) return std::nullopt;
  const Gap& gap = silence.gap;
  return DataFinding{.what = What::all_silent,
                     .places = {place(frame, data.runs[gap.run], gap.row, gap.n_rows)},
                     .n_rows = gap.n_rows,
                     .chance = std::exp(chance)};
}

/// Longer than in any of the model's runs of that trial: where sensors see less than in the model, that is no fault of
/// the file.
std::optional<DataFinding> odd_silence(const StudyFrame& frame, const DatasetRows& data,
                                       std::span<const DatasetRows> pilot) {
  Gap greatest;
  double most = 1.0;
  for (std::size_t number = 0; number < data.runs.size(); ++number) {
    const std::vector<Gap> gaps = gaps_of(data, number);
    if (gaps.empty()) continue;
    const Gap& longest = *std::ranges::max_element(gaps, {}, &Gap::n_rows);
    const double usual = greatest_of(pilot, [&](const DatasetRows& d) {
      std::size_t longest_there = 0;
      for (std::size_t i = 0; i < d.runs.size(); ++i) {
        if (d.runs[i].trial != data.runs[number].trial) continue;
        for (const Gap& gap : gaps_of(d, i)) longest_there = std::max(longest_there, gap.n_rows);
      }
      return static_cast<double>(longest_there);
    });
    if (pilot.empty() || longest.n_rows < shortest_silence) continue;
    const double times = static_cast<double>(longest.n_rows) / (beyond_model * std::max(1.0, usual));
    if (times > most) {
      most = times;
      greatest = longest;
    }
  }
  if (greatest.n_rows == 0) return std::nullopt;
  return DataFinding{.what = What::all_silent,
                     .places = {place(frame, data.runs[greatest.run], greatest.row, greatest.n_rows)},
                     .n_rows = greatest.n_rows,
                     .is_impossible = false};
}

}  // namespace

void find_silence(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                  std::vector<DataFinding>& findings) {
  std::optional<DataFinding> found = impossible_silence(frame, data, pilot);
  if (!found) found = odd_silence(frame, data, pilot);
  if (found) findings.push_back(std::move(*found));
}

}  // namespace pirsim::reconcile
