// Finds rows that stand in a dataset twice: windows of rows by their hash, then as far as they go on alike.
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <unordered_map>

#include "reconcile/data/data_checks.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::size_t window_rows = 12;     ///< shorter repeats aren't looked at
constexpr std::size_t fewest_changes = 4;   ///< in such a window
constexpr std::size_t most_places = 16;     ///< of the same window are compared: steady beats have thousands
constexpr std::size_t most_parsed = 400;    ///< rows whose information is counted
constexpr std::size_t aligned_within = 30;  ///< rows by which one run may begin earlier than another (assumed)
constexpr double least_information = 8.0;   ///< bits; less isn't kept
constexpr double whole_run = 0.95;          ///< of the shorter run's rows

using Symbol = std::uint64_t;

/// (n_rows) A number for the bits of each row; a row that isn't known all over is like no other.
std::vector<Symbol> symbols_of(const Series& run, std::size_t n_sensors, Symbol& next_unknown) {
  std::vector<Symbol> symbols;
  for (std::size_t row = 0; row < run.n_rows(n_sensors); ++row) {
    Symbol symbol = 1469598103934665603U;
    bool known = true;
    for (std::size_t sensor = 0; sensor < n_sensors; ++sensor) {
      const std::uint8_t bit = bit_of(run, row, sensor, n_sensors);
      known = known && bit != unknown_bit;
      symbol = (symbol ^ bit) * 1099511628211U;
    }
    symbols.push_back(known ? symbol : next_unknown++);
  }
  return symbols;
}

/// Phrases that Lempel's and Ziv's parsing of 1977 needs: each is what stood there before, and one symbol.
double information_of(std::span<const Symbol> symbols) {
  symbols = symbols.first(std::min(symbols.size(), most_parsed));
  double n_phrases = 0.0;
  for (std::size_t at = 0; at < symbols.size();) {
    std::size_t longest = 0;
    for (std::size_t from = 0; from < at; ++from) {
      std::size_t length = 0;
      while (at + length < symbols.size() && symbols[from + length] == symbols[at + length]) ++length;
      longest = std::max(longest, length);
    }
    at += longest + 1;
    n_phrases += 1.0;
  }
  return n_phrases * std::log2(std::max(n_phrases, 1.0));
}

/// Of those of a pair of runs and a shift, the first.
void keep_greatest(std::vector<Repeat>& repeats) {
  std::ranges::stable_sort(repeats, std::ranges::greater{}, &Repeat::information);
  std::set<std::tuple<std::size_t, std::size_t, std::size_t>> seen;
  std::vector<Repeat> kept;
  for (const Repeat& repeat : repeats) {
    if (kept.size() == Repeats::most) break;
    if (seen.insert({repeat.run, repeat.other_run, repeat.row - repeat.other_row}).second) kept.push_back(repeat);
  }
  repeats = std::move(kept);
}

struct Place {
  std::size_t run = 0, row = 0;
};

class RepeatFinder {
 public:
  explicit RepeatFinder(const DatasetRows& data) : data_(data) {
    Symbol next_unknown = 1;
    for (const Series& run : data.runs) symbols_.push_back(symbols_of(run, data.n_sensors, next_unknown));
  }

  Repeats find() {
    for (std::size_t run = 0; run < symbols_.size(); ++run) {
      reached_.clear();
      for (std::size_t row = 0; row + window_rows <= symbols_[run].size(); ++row) look_at({run, row});
    }
    keep_greatest(found_.between_runs);
    keep_greatest(found_.in_a_run);
    return std::move(found_);
  }

 private:
  void look_at(const Place& here) {
    const std::span<const Symbol> window = std::span(symbols_[here.run]).subspan(here.row, window_rows);
    std::size_t n_changes = 0;
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < window_rows; ++i) {
      n_changes += i > 0 && window[i] != window[i - 1] ? 1 : 0;
      hash = (hash ^ window[i]) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 29U;
    }
    if (n_changes < fewest_changes) return;
    std::vector<Place>& places = places_[hash];
    for (const Place& there : places) compare(there, here);
    if (places.size() < most_places) places.push_back(here);
  }

  /// Runs of one trial repeat their choreography, and what goes by the clock is the same in all runs that begin alike.
  [[nodiscard]] bool may_repeat(const Place& there, const Place& here, std::size_t n) const {
    if (there.run == here.run) return there.row + n < here.row;  // or it goes on as its own repeat: a beat
    if (data_.runs[there.run].trial == data_.runs[here.run].trial) return false;
    const std::size_t apart = std::max(there.row, here.row) - std::min(there.row, here.row);
    const std::size_t shorter = std::min(symbols_[there.run].size(), symbols_[here.run].size());
    return apart > aligned_within || static_cast<double>(n) >= whole_run * static_cast<double>(shorter);
  }

  void compare(const Place& there, const Place& here) {
    // What began earlier has been looked at as far as it goes.
    const auto line =
        std::pair(there.run, static_cast<std::ptrdiff_t>(here.row) - static_cast<std::ptrdiff_t>(there.row));
    std::size_t& reached = reached_[line.first * 1000003U + static_cast<std::size_t>(line.second)];
    if (here.row < reached) return;
    const std::vector<Symbol>&one = symbols_[there.run], &other = symbols_[here.run];
    const std::size_t most = std::min(one.size() - there.row, other.size() - here.row);
    std::size_t n = 0;
    while (n < most && one[there.row + n] == other[here.row + n]) ++n;
    reached = here.row + n;
    if (n < window_rows || !may_repeat(there, here, n)) return;
    const double information = information_of(std::span(other).subspan(here.row, n));
    if (information < least_information) return;
    (there.run == here.run ? found_.in_a_run : found_.between_runs)
        .push_back({there.run, there.row, here.run, here.row, n, information});
  }

  const DatasetRows& data_;
  std::vector<std::vector<Symbol>> symbols_;                      ///< of each run
  std::unordered_map<std::uint64_t, std::vector<Place>> places_;  ///< of each window's hash, up to here
  std::unordered_map<std::size_t, std::size_t> reached_;  ///< row of this run, by the other run and how far apart
  Repeats found_;
};

}  // namespace

Repeats greatest_repeats(const DatasetRows& data) { return RepeatFinder(data).find(); }

}  // namespace pirsim::reconcile
