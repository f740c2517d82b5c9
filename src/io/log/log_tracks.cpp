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
  note(track, us);
  return is_in_order;
}

void EventTracks::note(Track& track, std::int64_t us) {
  if (track.parts.empty() || track.parts.back().file != file_) track.parts.push_back({file_, us, us});
  Track::Part& part = track.parts.back();
  part.first_us = std::min(part.first_us, us);
  part.last_us = std::max(part.last_us, us);
}

namespace {

std::vector<LogChange> with_ends(const std::vector<LogChange>& events, const MotionEnds& ends,
                                 const std::function<void(std::int64_t)>& lost) {
  std::vector<LogChange> result;
  for (std::size_t i = 0; i < events.size(); ++i) {
    result.push_back(events[i]);
    if (events[i].value != log_state::on) continue;
    const bool is_last = i + 1 == events.size(), is_told = !is_last && events[i + 1].value == log_state::off;
    const auto is_over = [&](std::optional<std::int64_t> after_us) {
      return after_us && (is_last || events[i + 1].us > events[i].us + *after_us);
    };
    if (!is_told && is_over(ends.hold_us)) {
      result.push_back({events[i].us + *ends.hold_us, 0, log_state::off});
    } else if (is_over(ends.longest_us)) {
      result.push_back({events[i].us + *ends.longest_us, 0, log_state::unknown});
      lost(events[i].us);
    }
  }
  return result;
}

}  // namespace

std::vector<LogChange> changes_of(EventTracks::Track& track, const MotionEnds& ends,
                                  const std::function<void(std::int64_t)>& lost) {
  std::vector<LogChange> events = std::exchange(track.events, {});
  if (!track.is_sorted) {
    std::size_t n_back = 0, n_on = 0;
    for (std::size_t i = 1; i < events.size(); ++i) {
      n_back += events[i].us < events[i - 1].us ? 1 : 0;
      n_on += events[i].us > events[i - 1].us ? 1 : 0;
    }
    if (n_back > n_on) std::ranges::reverse(events);  // newest first, also what has one stamp
    std::ranges::stable_sort(events, {}, &LogChange::us);
  }
  if (ends.hold_us || ends.longest_us) events = with_ends(events, ends, lost);
  const auto same = [](const LogChange& a, const LogChange& b) { return a.value == b.value; };
  events.erase(std::unique(events.begin(), events.end(), same), events.end());
  events.shrink_to_fit();
  return events;
}

std::vector<LogChange> united(EventTracks::Track& track, std::int64_t begin_us,
                              const std::function<void(std::int64_t)>& overlap) {
  const std::vector<LogChange> events = std::exchange(track.events, {});
  std::vector<std::pair<std::int64_t, std::int64_t>> given, whole;
  for (std::size_t i = 0; i + 1 < events.size(); i += 2) given.emplace_back(events[i].us, events[i + 1].us);
  std::ranges::sort(given);
  for (const auto& [begin, end] : given) {
    if (!whole.empty() && begin < whole.back().second) overlap(begin);
    if (whole.empty() || begin > whole.back().second) whole.emplace_back(begin, end);
    whole.back().second = std::max(whole.back().second, end);
  }
  std::vector<LogChange> changes{{begin_us, 0, log_state::off}};
  for (const auto& [begin, end] : whole) {
    changes.push_back({begin, 0, log_state::on});
    changes.push_back({end, 0, log_state::off});
  }
  return changes;
}

}  // namespace pirsim::io
