#include "sim/count_draw.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "pirsim/random.hpp"

namespace pirsim::sim {
namespace {

// assumed: how long after the reading before and how long before its own a change happens, if the interval is long
// enough (0-5 s tried); two people who wait for each other in a doorway are late by less.
constexpr double after_s = 1.0, before_s = 5.0;
constexpr double after_share = 0.1, before_share = 0.4;  // of a shorter interval
constexpr double apart_s = 1.5;                          // assumed: between two people in a doorway (1-3)
constexpr double settled_s = 60.0;  // assumed: who has come or gone for less stays so, if another can do it

class Draw {
 public:
  explicit Draw(const CountSource& source) : source_(source), free_(source.n_seats + source.n_standing, 1) {
    for (std::size_t person = 0; person < source.n_people; ++person) absent_.push_back({person, never});
  }

  std::vector<CountedVisit> visits() {
    const auto& times_s = source_.times_s;
    if (times_s.empty()) return {};
    const auto later = std::ranges::upper_bound(times_s, source_.begin_s);
    auto k = static_cast<std::size_t>(later - times_s.begin());
    int now = source_.people[k == 0 ? 0 : k - 1];
    Stream first({source_.seed, source_.run, 0, Purpose::occupancy});
    for (int i = 0; i < now; ++i) come(CountedVisit::from_the_beginning, first);
    double since_s = source_.begin_s;
    for (; k < times_s.size() && since_s < source_.end_s; ++k) {
      change(source_.people[k] - now, since_s, times_s[k], static_cast<std::uint32_t>(k + 1));
      now = source_.people[k];
      since_s = times_s[k];
    }
    return std::move(visits_);
  }

 private:
  static constexpr double never = -std::numeric_limits<double>::infinity();
  struct Waiting {
    std::size_t person;
    double since_s;  ///< of the run
  };
  struct Present {
    std::size_t visit;  ///< index
    double since_s;
  };

  /// reading: which of the data, from 1.
  void change(int by, double since_s, double at_s, std::uint32_t reading) {
    if (by == 0) return;
    Stream stream({source_.seed, source_.run, reading, Purpose::occupancy});
    for (const double moment_s : moments(static_cast<std::size_t>(std::abs(by)), since_s, at_s, stream))
      by > 0 ? come(moment_s, stream) : go(moment_s, stream);
  }

  /// n of them, ascending, in seconds of the run.
  [[nodiscard]] std::vector<double> moments(std::size_t n, double since_s, double at_s, Stream& stream) const {
    const double from_s = std::max(since_s, at_s - source_.changes_within_s), length_s = at_s - from_s;
    const double low_s = from_s + std::min(after_s, after_share * length_s);
    const double high_s = at_s - std::min(before_s, before_share * length_s);
    std::vector<double> result;
    for (std::size_t i = 0; i < n; ++i) result.push_back(low_s + (high_s - low_s) * stream.uniform());
    std::ranges::sort(result);
    const double apart = std::min(apart_s, (high_s - low_s) / static_cast<double>(n));
    for (std::size_t i = n - 1; i > 0; --i) result[i - 1] = std::min(result[i - 1], result[i] - apart);
    for (double& moment_s : result) moment_s -= source_.begin_s;
    for (std::size_t i = 0; i < n; ++i)
      result[i] = std::max(result[i], low_s - source_.begin_s + static_cast<double>(i) * apart);
    return result;
  }

  void come(double at_s, Stream& stream) {
    const std::size_t who = pick(absent_, at_s, stream);
    visits_.push_back({absent_[who].person, take_place(stream), at_s});
    absent_.erase(absent_.begin() + static_cast<std::ptrdiff_t>(who));
    present_.push_back({visits_.size() - 1, at_s});
  }
  void go(double at_s, Stream& stream) {
    const std::size_t who = pick(present_, at_s, stream);
    CountedVisit& visit = visits_[present_[who].visit];
    visit.goes_s = at_s;
    free_[visit.place] = 1;
    absent_.push_back({visit.person, at_s});
    present_.erase(present_.begin() + static_cast<std::ptrdiff_t>(who));
  }

  /// One who has been so for long, or else the one who has been so for longest: the list is in that order.
  template <typename List>
  [[nodiscard]] static std::size_t pick(const List& list, double at_s, Stream& stream) {
    const auto recent = std::ranges::find_if(list, [&](const auto& one) { return one.since_s > at_s - settled_s; });
    const auto n = static_cast<std::uint32_t>(recent - list.begin());
    const std::uint32_t drawn = stream.index(std::max(1U, n));
    return drawn;
  }

  [[nodiscard]] std::size_t take_place(Stream& stream) {
    const auto seats = free_.begin() + static_cast<std::ptrdiff_t>(source_.n_seats);
    const bool sits = std::find(free_.begin(), seats, 1) != seats;
    const auto first = sits ? free_.begin() : seats, last = sits ? seats : free_.end();
    auto left = stream.index(static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(1, std::count(first, last, 1))));
    for (auto place = first; place != last; ++place) {
      if (*place == 0 || left-- > 0) continue;
      *place = 0;
      return static_cast<std::size_t>(place - free_.begin());
    }
    return 0;  // never: there is a place for everybody
  }

  const CountSource& source_;
  std::vector<std::uint8_t> free_;  ///< (n_places) 1: nobody has it
  std::vector<Waiting> absent_;     ///< in the order of having gone
  std::vector<Present> present_;    ///< in the order of having come
  std::vector<CountedVisit> visits_;
};

}  // namespace

std::vector<CountedVisit> draw_visits(const CountSource& source) { return Draw(source).visits(); }

}  // namespace pirsim::sim
