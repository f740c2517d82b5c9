#include "sim/count_draw.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <ranges>
#include <utility>

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
  explicit Draw(const CountSource& source) : source_(source), free_(source.part_of_place.size(), 1) {
    for (std::size_t person = 0; person < source.n_people; ++person) absent_.push_back({person, never});
  }

  std::vector<CountedVisit> visits() {
    const auto& times_s = source_.times_s;
    if (times_s.empty()) return {};
    const auto later = std::ranges::upper_bound(times_s, source_.begin_s);
    auto k = static_cast<std::size_t>(later - times_s.begin());
    std::size_t now = k == 0 ? 0 : k - 1;
    Stream first({source_.seed, source_.run, 0, Purpose::occupancy});
    for (std::size_t part = 0; part < n_parts(); ++part) {
      for (int i = 0; i < source_.people[part][now]; ++i) come(part, CountedVisit::from_the_beginning, first);
    }
    double since_s = source_.begin_s;
    for (; k < times_s.size() && since_s < source_.end_s; ++k) {
      change(now, k, since_s);
      now = k;
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
  /// Somebody comes to a part of the floor, goes from one, or both.
  struct Step {
    std::optional<std::size_t> from, to;
  };

  [[nodiscard]] std::size_t n_parts() const { return source_.people.size(); }
  [[nodiscard]] std::size_t part_of(const Present& one) const {
    return source_.part_of_place[visits_[one.visit].place];
  }

  /// From one reading (index) to another.
  void change(std::size_t before, std::size_t reading, double since_s) {
    std::vector<std::size_t> left, reached;
    for (std::size_t part = 0; part < n_parts(); ++part) {
      const int by = source_.people[part][reading] - source_.people[part][before];
      for (int i = 0; i < std::abs(by); ++i) (by < 0 ? left : reached).push_back(part);
    }
    if (left.empty() && reached.empty()) return;
    Stream stream({source_.seed, source_.run, static_cast<std::uint32_t>(reading + 1), Purpose::occupancy});
    const std::vector<Step> steps = steps_between(std::move(left), std::move(reached), stream);
    const std::vector<double> moments_s = moments(steps.size(), since_s, source_.times_s[reading], stream);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (steps[i].from && steps[i].to) {
        move(*steps[i].from, *steps[i].to, moments_s[i], stream);
      } else {
        steps[i].to ? come(*steps[i].to, moments_s[i], stream) : go(*steps[i].from, moments_s[i], stream);
      }
    }
  }

  /// Whoever is missing in a part and may have gone to another has; who went where, and in which order, is drawn.
  [[nodiscard]] std::vector<Step> steps_between(std::vector<std::size_t> left, std::vector<std::size_t> reached,
                                                Stream& stream) const {
    if (n_parts() > 1) shuffle(left, stream), shuffle(reached, stream);
    std::vector<Step> steps(std::max(left.size(), reached.size()));
    for (std::size_t i = 0; i < left.size(); ++i) steps[i].from = left[i];
    for (std::size_t i = 0; i < reached.size(); ++i) steps[i].to = reached[i];
    if (n_parts() > 1) shuffle(steps, stream);
    return steps;
  }
  template <typename T>
  static void shuffle(std::vector<T>& items, Stream& stream) {
    for (std::size_t n = items.size(); n > 1; --n)
      std::swap(items[n - 1], items[stream.index(static_cast<std::uint32_t>(n))]);
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

  void come(std::size_t to, double at_s, Stream& stream) {
    const std::size_t who = pick(absent_, at_s, stream, [](const Waiting&) { return true; });
    visits_.push_back({absent_[who].person, take_place(to, stream), at_s});
    absent_.erase(absent_.begin() + static_cast<std::ptrdiff_t>(who));
    present_.push_back({visits_.size() - 1, at_s});
  }
  /// Ends the visit of somebody there.
  CountedVisit& go_from(std::size_t from, double at_s, Stream& stream) {
    const std::size_t who = pick(present_, at_s, stream, [&](const Present& one) { return part_of(one) == from; });
    CountedVisit& visit = visits_[present_[who].visit];
    visit.goes_s = at_s;
    free_[visit.place] = 1;
    present_.erase(present_.begin() + static_cast<std::ptrdiff_t>(who));
    return visit;
  }
  void go(std::size_t from, double at_s, Stream& stream) {
    absent_.push_back({go_from(from, at_s, stream).person, at_s});
  }
  void move(std::size_t from, std::size_t to, double at_s, Stream& stream) {
    CountedVisit& before = go_from(from, at_s, stream);
    before.goes_to = CountedVisit::Beyond::other_part;
    CountedVisit next{.person = before.person, .place = take_place(to, stream), .comes_s = at_s};
    next.comes_from = CountedVisit::Beyond::other_part;
    visits_.push_back(next);
    present_.push_back({visits_.size() - 1, at_s});
  }

  /// Of those that fit one who has been so for long, or else the one who has been so for longest: the list is in that
  /// order.
  template <typename List, typename Fits>
  [[nodiscard]] static std::size_t pick(const List& list, double at_s, Stream& stream, const Fits& fits) {
    const auto recent = std::ranges::find_if(list, [&](const auto& one) { return one.since_s > at_s - settled_s; });
    const auto n = static_cast<std::uint32_t>(std::count_if(list.begin(), recent, fits));
    std::uint32_t before = stream.index(std::max(1U, n));
    const auto drawn = std::ranges::find_if(list, [&](const auto& one) { return fits(one) && before-- == 0; });
    return static_cast<std::size_t>(drawn - list.begin());
  }

  [[nodiscard]] std::size_t take_place(std::size_t part, Stream& stream) {
    const auto is_free = [&](std::size_t place) { return free_[place] != 0 && source_.part_of_place[place] == part; };
    const auto seats = std::views::iota(std::size_t{0}, source_.n_seats);
    const bool sits = std::ranges::any_of(seats, is_free);
    const auto places = sits ? seats : std::views::iota(source_.n_seats, free_.size());
    const auto n_free = static_cast<std::uint32_t>(std::count_if(places.begin(), places.end(), is_free));
    auto before = stream.index(std::max(1U, n_free));
    for (const std::size_t place : places) {
      if (!is_free(place) || before-- > 0) continue;
      free_[place] = 0;
      return place;
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
