#include "io/log/log_tracks.hpp"

#include <algorithm>
#include <utility>

#include "schema/limits.hpp"

namespace pirsim::io {

ReadingTracks::ReadingTracks(const Cadence& cadence, std::vector<std::int32_t> unknown)
    : cadence_(cadence), unknown_(std::move(unknown)), changes_(unknown_.size()) {}

void ReadingTracks::put(std::size_t track, std::int64_t us, std::int64_t since_last_us, std::int32_t value) {
  std::vector<LogChange>& changes = changes_[track];
  if (!changes.empty() && changes.back().value == value) return;
  changes.push_back({us, since_last_us, value});
  ++n_changes_;
}

ReadingTracks::Order ReadingTracks::add(std::int64_t us, std::span<const std::int32_t> values) {
  const std::int64_t interval = cadence_.interval_us;
  std::int64_t since_last = interval;
  if (n_ > 0) {
    if (us <= last_us_) return us == last_us_ ? Order::same : Order::earlier;
    since_last = us - last_us_;
    if (since_last > cadence_.longest_gap_us) {  // as if readings in between told nothing
      const std::int64_t lost = last_us_ + interval;
      for (std::size_t i = 0; i < values.size(); ++i) put(i, lost, interval, unknown_[i]);
      since_last = std::min(interval, us - lost);
    }
  } else {
    first_us_ = us;
  }
  for (std::size_t i = 0; i < values.size(); ++i) put(i, us, since_last, values[i]);
  last_us_ = us;
  ++n_;
  return Order::later;
}

EventTracks::Track* EventTracks::track(std::string_view in_log) {
  if (const auto found = index_.find(in_log); found != index_.end()) return &tracks_[found->second];
  if (tracks_.size() == limits::log_columns) return nullptr;
  index_.emplace(in_log, tracks_.size());
  return &tracks_.emplace_back(Track{std::string(in_log), {}});
}

bool EventTracks::add(Track& track, std::int64_t us, std::int32_t value) {
  const bool is_in_order = track.events.empty() || track.events.back().us <= us;
  track.is_sorted = track.is_sorted && is_in_order;
  track.events.push_back({us, 0, value});
  ++n_events_;
  return is_in_order;
}

namespace {

/// An `on` ends after `hold_us`, unless another event comes before.
std::vector<LogChange> with_ends(const std::vector<LogChange>& events, std::int64_t hold_us) {
  std::vector<LogChange> result;
  for (std::size_t i = 0; i < events.size(); ++i) {
    result.push_back(events[i]);
    const std::int64_t end = events[i].us + hold_us;
    if (events[i].value == log_state::on && (i + 1 == events.size() || events[i + 1].us > end))
      result.push_back({end, 0, log_state::off});
  }
  return result;
}

}  // namespace

std::vector<LogChange> changes_of(EventTracks::Track& track, std::optional<std::int64_t> hold_us) {
  std::vector<LogChange> events = std::exchange(track.events, {});
  if (!track.is_sorted) std::ranges::stable_sort(events, {}, &LogChange::us);
  if (hold_us) events = with_ends(events, *hold_us);
  const auto same = [](const LogChange& a, const LogChange& b) { return a.value == b.value; };
  events.erase(std::unique(events.begin(), events.end(), same), events.end());
  events.shrink_to_fit();
  return events;
}

}  // namespace pirsim::io
