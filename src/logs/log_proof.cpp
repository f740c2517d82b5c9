#include "logs/log_proof.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <unordered_map>
#include <utility>

#include "logs/times.hpp"
#include "model/core/text.hpp"
#include "model/schema/limits.hpp"

namespace pirsim::io {
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

// All shares are `assumed`; 2000 made logs tried them (tests/unit/io/log_grid_test.cpp).
constexpr double nearly_all = 0.9, most = 0.8;
constexpr std::size_t few_rows = 8;

double share(std::size_t n, std::size_t of) { return of == 0 ? 0.0 : static_cast<double>(n) / static_cast<double>(of); }

/// The value that this share of them doesn't exceed; reorders them.
std::int64_t quantile(std::vector<std::int64_t>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// The mean of those that are about the median: of seconds apart by 30 and 31.
std::int64_t usual_step(const std::vector<std::int64_t>& apart, std::int64_t median) {
  std::int64_t sum = 0, n = 0;
  for (const std::int64_t step : apart) {
    if (2 * step < median || step > 3 * median / 2) continue;
    sum += step;
    ++n;
  }
  const std::int64_t mean = n > 0 ? sum / n : median;
  return mean < 10 * us_per_ms ? mean : (mean + us_per_ms / 2) / us_per_ms * us_per_ms;
}

/// How rows follow each other.
class RowSteps {
 public:
  explicit RowSteps(std::span<const StateRow> rows) {
    bool are_seconds = true, are_minutes = true;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      are_seconds = are_seconds && rows[i].us % us_per_s == 0;
      are_minutes = are_minutes && rows[i].us % (60 * us_per_s) == 0;
      if (i > 0 && rows[i].us > rows[i - 1].us) apart_.push_back(rows[i].us - rows[i - 1].us);
    }
    if (apart_.empty()) return;
    std::vector<std::int64_t> sorted = apart_;
    fast_ = quantile(sorted, 0.05);
    slow_ = quantile(sorted, 0.95);
    median_ = quantile(sorted, 0.5);
    tolerance_ = median_ / 10;
    if (are_seconds && median_ >= 5 * us_per_s) tolerance_ = std::max(tolerance_, us_per_s);
    are_coarse_ = are_seconds && median_ <= 3 * us_per_s;
    is_fine_ = median_ > 3 * (are_minutes ? 60 * us_per_s : are_seconds ? us_per_s : 0);
    const auto is_usual = [&](std::int64_t step) { return std::abs(step - median_) <= tolerance_; };
    usual_ = share(static_cast<std::size_t>(std::ranges::count_if(apart_, is_usual)), apart_.size());
    on_grid_ =
        share(static_cast<std::size_t>(std::ranges::count_if(apart_, [&](auto step) { return is_on_grid(step); })),
              apart_.size());
  }
  [[nodiscard]] bool empty() const { return apart_.empty(); }
  [[nodiscard]] std::int64_t median() const { return median_; }
  /// A whole number of usual steps: rows in between were lost.
  [[nodiscard]] bool is_on_grid(std::int64_t step) const {
    const std::int64_t rest = step % median_;
    return step + tolerance_ >= median_ && std::min(rest, median_ - rest) <= tolerance_;
  }
  [[nodiscard]] double usual() const { return usual_; }
  /// Nearly all are one or several usual steps, or none is far from the usual one.
  [[nodiscard]] bool have_cadence() const {
    return usual_ >= most || (on_grid_ >= 0.95 && usual_ >= 0.5 && is_fine_) ||
           (2 * fast_ >= median_ && slow_ <= 2 * median_);
  }
  /// So few steps are hardly ever alike by chance.
  [[nodiscard]] bool has_few_gaps() const { return usual_ >= most || (usual_ >= 0.7 && on_grid_ == 1.0); }
  [[nodiscard]] ReadingTracks::Cadence cadence() const {
    ReadingTracks::Cadence cadence;
    cadence.interval_us = usual_step(apart_, median_);
    // Stamps of whole seconds may be two intervals apart where none is lost.
    cadence.longest_gap_us = 3 * std::clamp(slow_, median_, are_coarse_ ? 5 * median_ / 3 : 5 * median_ / 4) / 2;
    return cadence;
  }

 private:
  std::vector<std::int64_t> apart_;
  std::int64_t median_ = 0, fast_ = 0, slow_ = 0, tolerance_ = 0;
  double usual_ = 0.0, on_grid_ = 0.0;
  bool are_coarse_ = false;  ///< stamps of whole seconds, for such steps
  bool is_fine_ = false;     ///< stamps of whole seconds or minutes don't make such a median by themselves
};

/// A heartbeat, and rows between its beats that change something. Beats come at a clock's steps, or a step after any
/// row.
enum class Beat { none, perhaps, sure };
Beat beat_of(std::span<const StateRow> rows) {
  struct SeenRow {
    bool is_changed;
    std::int64_t after_any, after_beat;
  };
  std::vector<SeenRow> found;
  std::size_t n_changed = 0;
  std::int64_t beat_us = rows.front().us;
  bool are_seconds = true;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const bool is_changed = rows[i].states != rows[i - 1].states;
    found.push_back({is_changed, rows[i].us - rows[i - 1].us, rows[i].us - beat_us});
    if (!is_changed) beat_us = rows[i].us;
    n_changed += is_changed ? 1 : 0;
    are_seconds = are_seconds && rows[i].us % us_per_s == 0;
  }
  constexpr std::size_t fewest = 4;
  if (n_changed == 0 || found.size() - n_changed < fewest) return Beat::none;
  for (const auto after : {&SeenRow::after_any, &SeenRow::after_beat}) {
    std::vector<std::int64_t> steps;
    for (const SeenRow& row : found) {
      if (!row.is_changed) steps.push_back(row.*after);
    }
    const std::int64_t step = quantile(steps, 0.5);
    if (step <= 0) continue;
    const std::int64_t tolerance = std::max(step / 10, are_seconds && step >= 5 * us_per_s ? us_per_s : 0);
    std::size_t n_on = 0, n_between = 0;
    for (const SeenRow& row : found) {
      const std::int64_t rest = row.*after % step;
      const bool is_on = row.*after + tolerance >= step && std::min(rest, step - rest) <= tolerance;
      n_on += is_on && !row.is_changed ? 1 : 0;
      n_between += !is_on && row.is_changed ? 1 : 0;
    }
    if (share(n_on, steps.size()) >= nearly_all && share(n_between, n_changed) >= most)
      return n_changed >= fewest ? Beat::sure : Beat::perhaps;
  }
  return Beat::none;
}

}  // namespace

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
  return &tracks_.emplace_back(in_log);
}

bool EventTracks::add(Track& track, std::int64_t us, std::int32_t value) {
  note(track, us);
  track.events.push_back({us, 0, value});
  ++n_events_;
  return !track.order.add(us);
}

void EventTracks::note(Track& track, std::int64_t us) {
  if (track.parts.empty() || track.parts.back().file != file_) {
    track.parts.push_back({file_, us, us, track.events.size()});
    track.order.restart();
  }
  Track::FilePart& part = track.parts.back();
  part.first_us = std::min(part.first_us, us);
  part.last_us = std::max(part.last_us, us);
}

std::vector<LogChange> changes_of(EventTracks::Track& track, const MotionEnds& ends,
                                  const std::function<void(std::int64_t)>& lost) {
  std::vector<LogChange> events = std::exchange(track.events, {});
  std::ranges::stable_sort(events, {}, &LogChange::us);
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
  std::set<std::int64_t> open;  // begins of those whose end isn't told
  for (std::size_t i = 0; i + 1 < events.size(); i += 2) {
    given.emplace_back(events[i].us, events[i + 1].us);
    if (events[i + 1].value == log_state::unknown) open.insert(events[i].us);
  }
  std::ranges::sort(given);
  for (const auto& [begin, end] : given) {
    if (!whole.empty() && begin < whole.back().second) overlap(begin);
    if (whole.empty() || begin > whole.back().second) whole.emplace_back(begin, end);
    whole.back().second = std::max(whole.back().second, end);
  }
  std::vector<LogChange> changes{{begin_us, 0, log_state::off}};
  for (const auto& [begin, end] : whole) {
    // The last one goes on; the end of another was lost.
    const bool is_open = open.contains(begin) && begin == end, is_last = begin == whole.back().first;
    changes.push_back({begin, 0, is_open && !is_last ? log_state::unknown : log_state::on});
    if (!is_open) changes.push_back({end, 0, log_state::off});
  }
  return changes;
}

std::string settling_map(const std::string& keys) { return "{pirsim_log: 1, " + keys + "}"; }

std::string with_maps(const std::string& why, const std::vector<std::string>& keys) {
  std::vector<std::string> maps;
  for (const std::string& one : keys) maps.push_back(settling_map(one));
  return why + "; a map (--map) settles it: " + joined(maps, ", or ");
}

RowsProof proof_of_rows(std::span<const StateRow> rows) {
  RowsProof proof;
  const RowSteps steps(rows);
  if (steps.empty()) return proof;
  proof.usual = steps.cadence();
  proof.are_in_step = steps.usual() >= most;
  std::size_t n_changed = 0, n_single = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    std::size_t n = 0;
    for (std::size_t k = 0; k < rows[i].states.size(); ++k) n += rows[i].states[k] != rows[i - 1].states[k] ? 1 : 0;
    n_changed += n > 0 ? 1 : 0;
    n_single += n == 1 ? 1 : 0;
  }
  const std::size_t n_after = rows.size() - 1;
  const double changed = share(n_changed, n_after), single = share(n_single, n_changed);
  const bool is_short = rows.size() < few_rows;
  const Beat beat = beat_of(rows);
  using Are = RowsProof::Are;
  if (beat == Beat::sure) {
    proof.are = Are::changes;
  } else if (beat == Beat::perhaps && !is_short) {
    proof.why = "few rows change something, and those come between the others' steps";
  } else if ((is_short ? steps.has_few_gaps() : steps.have_cadence()) && changed < nearly_all) {
    proof.are = Are::readings;
  } else if (proof.are_in_step && !is_short) {  // every row changes something, in step
    proof.are = single >= nearly_all ? Are::either : Are::readings;
    proof.why = "every row changes one sensor, and rows come at equal steps";
  } else if (steps.has_few_gaps()) {
    const bool is_quick = steps.usual() == 1.0 && steps.median() <= 60 * us_per_s;
    proof.are = is_quick && rows.size() > 2 ? Are::readings : Are::either;
    proof.why = "so few rows can be readings or changes";
  } else if (changed >= nearly_all) {
    proof.are = single >= 0.5 ? Are::changes : Are::either;
    proof.why = "rows come at any step, and most change several sensors";
  } else {
    proof.why = "rows come at any step, and many change nothing";
  }
  return proof;
}

NamesProof proof_of_names(std::span<const NamedRow> rows) {
  std::size_t n_own = 0, n_own_turns = 0, n_turns = 0, n_switches = 0, n_turns_at_switch = 0, n_same_time = 0;
  std::unordered_map<std::string_view, std::int32_t> last;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto [before, is_new] = last.try_emplace(rows[i].name, rows[i].state);
    n_own += is_new ? 0 : 1;
    n_own_turns += before->second != rows[i].state ? 1 : 0;
    before->second = rows[i].state;
    if (i == 0) continue;
    const bool is_other = rows[i].name != rows[i - 1].name;
    n_turns += rows[i].state != rows[i - 1].state ? 1 : 0;
    n_switches += is_other ? 1 : 0;
    n_turns_at_switch += is_other && rows[i].state != rows[i - 1].state ? 1 : 0;
    n_same_time += is_other && rows[i].us == rows[i - 1].us ? 1 : 0;
  }
  const std::size_t n = rows.empty() ? 0 : rows.size() - 1;
  return {share(n_own_turns, n_own), share(n_turns, n), share(n_switches, n), share(n_turns_at_switch, n_switches),
          share(n_same_time, n)};
}

bool are_opposites(std::span<const StateRow> rows, std::size_t a, std::size_t b) {
  std::size_t n_known = 0, n_turns = 0;
  std::int32_t before = log_state::unknown;
  for (const StateRow& row : rows) {
    const auto is_known = [](std::int32_t state) { return state == log_state::on || state == log_state::off; };
    if (!is_known(row.states[a]) || !is_known(row.states[b])) continue;
    if (row.states[a] == row.states[b]) return false;
    n_turns += n_known > 0 && row.states[a] != before ? 1 : 0;
    before = row.states[a];
    ++n_known;
  }
  return n_known >= few_rows && n_turns >= 4;
}

Cells cells_of(std::span<const StateRow> rows) {
  const std::size_t n_columns = rows.empty() ? 0 : rows.front().states.size();
  const auto is_known = [](std::int32_t state) { return state != log_state::unknown; };
  std::size_t n_partial = 0, n_single = 0;
  for (const StateRow& row : rows) {
    const auto n_known = static_cast<std::size_t>(std::ranges::count_if(row.states, is_known));
    n_partial += n_known < n_columns ? 1 : 0;
    n_single += n_known == 1 ? 1 : 0;
  }
  const bool tell_one = n_columns > 1 && n_partial > 1 && share(n_single, n_partial) >= most;
  std::size_t n_scattered = 0, n_again = 0, n_turns = 0;
  for (std::size_t k = 0; k < n_columns; ++k) {
    std::size_t known = 0, begins = 0, turns = 0;
    std::int32_t last = log_state::unknown, before = log_state::unknown;
    for (const StateRow& row : rows) {
      const std::int32_t state = row.states[k];
      if (is_known(state)) {
        begins += is_known(before) ? 0 : 1;
        turns += known > 0 && last != state ? 1 : 0;
        last = state;
        ++known;
      }
      before = state;
    }
    // Known in stretches of few rows, between which it isn't; assumed.
    const bool is_scattered = begins >= 2 && 10 * known < 7 * rows.size() && 4 * begins >= known;
    if (known == 0 || (!is_scattered && !tell_one)) continue;
    n_scattered += is_scattered ? 1 : 0;
    n_again += known - 1;
    n_turns += turns;
  }
  if (n_again > 0 && share(n_turns, n_again) >= nearly_all) return Cells::pivot;
  return n_scattered > 0 ? Cells::scattered : Cells::full;
}

}  // namespace pirsim::io
