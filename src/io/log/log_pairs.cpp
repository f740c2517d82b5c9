#include "io/log/log_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "io/log/log_units.hpp"

namespace pirsim::io {
namespace {

/// Windows of one sensor, a bit each.
struct Bits {
  std::vector<std::uint64_t> known, on;
};

/// How often two sensors were on, of the windows in which both are known.
struct Counts {
  std::uint64_t both = 0, a = 0, b = 0, known = 0;
};

std::uint64_t n_common(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) n += static_cast<std::uint64_t>(std::popcount(a[i] & b[i]));
  return n;
}

std::vector<Bits> bits_of(const LogRows& rows) {
  constexpr std::size_t bits = 64;
  const std::size_t n_words = (rows.n_windows() + bits - 1) / bits;
  std::vector<Bits> result(rows.sensors.size(),
                           {std::vector<std::uint64_t>(n_words), std::vector<std::uint64_t>(n_words)});
  for (std::size_t window = 0; window < rows.n_windows(); ++window) {
    const std::uint64_t bit = std::uint64_t{1} << window % bits;
    for (std::size_t sensor = 0; sensor < result.size(); ++sensor) {
      const std::uint8_t state = rows.at(window, sensor);
      if (state != log_state::unknown) result[sensor].known[window / bits] |= bit;
      if (state == log_state::on) result[sensor].on[window / bits] |= bit;
    }
  }
  return result;
}

std::optional<double> phi_of(const Counts& counts) {
  const auto n = static_cast<double>(counts.known), a = static_cast<double>(counts.a),
             b = static_cast<double>(counts.b);
  const double spread = a * (n - a) * b * (n - b);
  if (!(spread > 0.0)) return std::nullopt;
  return (n * static_cast<double>(counts.both) - a * b) / std::sqrt(spread);
}

std::vector<std::int64_t> onsets_of(const LogTrack& track) {
  std::vector<std::int64_t> onsets;
  for (std::size_t i = 1; i < track.changes.size(); ++i) {
    if (track.changes[i].value == log_state::on && track.changes[i - 1].value == log_state::off)
      onsets.push_back(track.changes[i].us);
  }
  return onsets;
}

/// From each onset of a to the nearest of b, if that is at most ten seconds away.
void set_lead(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b, LogPair& pair) {
  constexpr std::int64_t farthest_us = 10 * us_per_s;  // assumed: a walk through a room
  constexpr std::size_t fewest = 10;
  std::vector<std::int64_t> after;
  auto next = b.begin();
  for (const std::int64_t onset : a) {
    while (next != b.end() && *next < onset) ++next;
    std::int64_t nearest = farthest_us + 1;
    if (next != b.end()) nearest = *next - onset;
    if (next != b.begin() && onset - *(next - 1) < nearest) nearest = *(next - 1) - onset;
    if (std::abs(nearest) <= farthest_us) after.push_back(nearest);
  }
  pair.n_together = after.size();
  if (after.size() < fewest) return;
  const auto n_first = std::ranges::count_if(after, [](std::int64_t us) { return us > 0; });
  const auto n_same = std::ranges::count(after, 0);
  pair.a_first_share =
      (static_cast<double>(n_first) + 0.5 * static_cast<double>(n_same)) / static_cast<double>(after.size());
  const auto middle = after.begin() + static_cast<std::ptrdiff_t>(after.size() / 2);
  std::nth_element(after.begin(), middle, after.end());
  pair.b_after_a_s = static_cast<double>(*middle) / us_per_s;
}

}  // namespace

}  // namespace pirsim::io

bool pirsim::LogPair::has_leader() const noexcept {
  constexpr double two_sided_99 = 2.576;
  return b_after_a_s && std::abs(a_first_share - 0.5) > 0.5 * two_sided_99 / std::sqrt(static_cast<double>(n_together));
}

namespace pirsim::io {

void add_pairs(const Log& log, LogFacts& facts) {
  constexpr std::size_t most_sensors = 100;
  constexpr double usual_window_s = 10.0;  // assumed: holds of seconds fall into one window, two visits don't
  const std::size_t n = log.sensors.size();
  if (n > most_sensors) return;
  facts.pair_window_s = std::max(usual_window_s, std::ceil(facts.interval_s));
  const LogWindows windows(log, std::min(facts.pair_window_s, 86'400.0));
  std::vector<Counts> counts(n * n);
  constexpr std::size_t at_once = 1U << 14U;
  for (std::size_t first = 0; first < windows.size(); first += at_once) {
    const std::vector<Bits> bits = bits_of(windows.rows(first, at_once));
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = a + 1; b < n; ++b) {
        Counts& pair = counts[a * n + b];
        pair.both += n_common(bits[a].on, bits[b].on);
        pair.a += n_common(bits[a].on, bits[b].known);
        pair.b += n_common(bits[a].known, bits[b].on);
        pair.known += n_common(bits[a].known, bits[b].known);
      }
    }
  }
  std::vector<std::vector<std::int64_t>> onsets;
  for (const LogTrack& track : log.sensors) onsets.push_back(onsets_of(track));
  constexpr double most_interval_s = 2.0;
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      LogPair& pair = facts.pairs.emplace_back(LogPair{a, b, phi_of(counts[a * n + b]), {}, 0});
      if (facts.interval_s <= most_interval_s) set_lead(onsets[a], onsets[b], pair);
    }
  }
  std::ranges::stable_sort(facts.pairs, std::greater{}, [](const LogPair& pair) { return pair.phi.value_or(-2.0); });
}

}  // namespace pirsim::io
