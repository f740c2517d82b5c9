#include "sim/day_draw.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "schema/clock.hpp"
#include "sim/meeting_draw.hpp"

namespace pirsim::sim {
namespace {

constexpr double day_s = 24.0 * hour_s;

double stay_s(Stream& stream, double mean_s) {
  const double least_s = std::min(shortest_stay_s, mean_s);
  return least_s + exponential(stream, mean_s - least_s);
}

/// What is left of a stay that one finds going on.
double rest_of_stay_s(Stream& stream, double mean_s) {
  const double least_s = std::min(shortest_stay_s, mean_s);
  if (stream.uniform() * mean_s < least_s) return least_s * stream.uniform();
  return stay_s(stream, mean_s);
}

/// One person's moves between places, as found going on at any moment: shares of time hold from the first second.
class Moves {
 public:
  explicit Moves(const Habits& habits) : habits_(habits) {
    for (std::size_t i = 0; i < n_places; ++i) stays_s_[i] = habits_.stays_min[i] * minute_s;
    rates_ = markov_rates(habits_.shares, stays_s_);
  }

  void spend(double from_s, double to_s, Stream& stream, std::vector<Stay>& stays) const {
    std::size_t place = pick(stream, habits_.shares);
    double until_s = from_s + rest_of_stay_s(stream, stays_s_[place]);
    for (double now = from_s; now < to_s;) {
      stays.push_back({static_cast<Place>(place), now, std::min(until_s, to_s)});
      now = until_s;
      place = pick(stream, std::span(rates_).subspan(place * n_places, n_places));
      until_s = now + stay_s(stream, stays_s_[place]);
    }
  }

 private:
  Habits habits_;
  std::array<double, n_places> stays_s_{};
  std::vector<double> rates_;
};

/// Who is called to meetings of the schedule goes to no others.
Habits habits_in(const ScheduleSpec& schedule, Role role) {
  Habits habits = habits_of(role);
  if (std::ranges::find(schedule.meetings, Attendees::staff, &MeetingsSpec::attendees) == schedule.meetings.end())
    return habits;
  double& met = habits.shares[static_cast<std::size_t>(Place::meeting)];
  const double others = 1.0 - met;
  met = 0.0;
  for (double& share : habits.shares) share /= others;
  return habits;
}

std::vector<Stay> draw_agent(const ScheduleSpec& schedule, Role role, Stream& stream) {
  const double arrival = std::max(0.0, around(stream, schedule.arrival));
  const double departure = std::clamp(around(stream, schedule.departure), arrival, day_s - minute_s);
  const double lunch = around(stream, schedule.lunch);
  const double lunch_s = minute_s * std::max(0.0, schedule.lunch_min + schedule.lunch_sd_min * cut_normal(stream));
  std::vector<Stay> stays;
  const Moves moves(habits_in(schedule, role));
  if (lunch_s > 0.0 && lunch > arrival && lunch + lunch_s < departure) {
    moves.spend(arrival, lunch, stream, stays);
    stays.push_back({Place::lunch, lunch, lunch + lunch_s});
    moves.spend(lunch + lunch_s, departure, stream, stays);
  } else {
    moves.spend(arrival, departure, stream, stays);
  }
  return stays;
}

const Stay* stay_at(const std::vector<Stay>& stays, double at_s) {
  const auto stay = std::ranges::find_if(stays, [&](const Stay& s) { return s.from_s <= at_s && at_s < s.to_s; });
  return stay == stays.end() ? nullptr : &*stay;
}

/// Visits go to somebody who is at their desk then.
void find_hosts(const DaySource& source, DayDraw& draw) {
  for (std::size_t i = 0; i < draw.stays.size(); ++i) {
    Stream stream({source.seed, source.run, static_cast<std::uint32_t>(i), Purpose::schedule_conduct});
    for (Stay& stay : draw.stays[i]) {
      if (stay.place != Place::others_desk) continue;
      std::vector<std::size_t> hosts;
      for (std::size_t other = 0; other < draw.stays.size(); ++other) {
        const Stay* theirs = other == i ? nullptr : stay_at(draw.stays[other], stay.from_s);
        if (theirs != nullptr && theirs->place == Place::desk) hosts.push_back(other);
      }
      if (!hosts.empty()) stay.host = hosts[stream.index(static_cast<std::uint32_t>(hosts.size()))];
    }
  }
}

}  // namespace

Habits habits_of(Role role) {
  constexpr std::array<double, n_places> stays_min{60.0, 20.0, 60.0, 20.0};
  switch (role) {
    case Role::staff:
      return {{0.60, 0.20, 0.15, 0.05}, stays_min};
    case Role::manager:
      return {{0.50, 0.20, 0.20, 0.10}, stays_min};
    case Role::administrator:
      return {{0.70, 0.15, 0.05, 0.10}, stays_min};
  }
  return {};
}

std::size_t pick(Stream& stream, std::span<const double> weights) {
  double left = stream.uniform() * std::accumulate(weights.begin(), weights.end(), 0.0);
  std::size_t last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    last = i;
    if ((left -= weights[i]) < 0.0) break;
  }
  return last;
}

double cut_normal(Stream& stream) { return std::clamp(stream.normal(), -3.0, 3.0); }

double around(Stream& stream, const ClockSpec& clock) {
  return clock.mean_h * hour_s + clock.sd_min * minute_s * cut_normal(stream);
}

double exponential(Stream& stream, double mean) { return -mean * std::log(1.0 - stream.uniform()); }

action::Work draw_desk_work(Stream& stream) {
  constexpr double shortest_s = 2.0 * minute_s, further_s = 8.0 * minute_s;  // assumed: an activity (means of 5-20 min)
  action::Work work;
  work.duration_s = shortest_s + exponential(stream, further_s);
  const double u = stream.uniform();  // assumed shares: typing 0.65 (0.5-0.8), reading 0.25, phone 0.1
  work.activity = u < 0.65 ? Activity::typing : u < 0.90 ? Activity::reading : Activity::phone;
  return work;
}

DayDraw draw_times(const DaySource& source) {
  DayDraw draw;
  draw.stays.resize(source.people.size());
  if (!is_working_day(source.day)) return draw;
  for (std::size_t i = 0; i < source.people.size(); ++i) {
    const auto& person = source.people[i];
    if (!person) continue;
    Stream stream({source.seed, source.run, static_cast<std::uint32_t>(i), Purpose::schedule});
    if (person->part == SchedulePart::cleaner)
      draw.cleaning_s = source.schedule.cleaning_h.value_or(0.0) * hour_s + 10.0 * minute_s * cut_normal(stream);
    if (person->part != SchedulePart::staff) continue;
    draw.stays[i] = draw_agent(source.schedule, person->role, stream);
  }
  draw_meetings(source, draw);
  find_hosts(source, draw);
  return draw;
}

std::vector<double> markov_rates(std::span<const double> shares, std::span<const double> stays) {
  const std::size_t n = shares.size();
  std::vector<double> flow(n);
  for (std::size_t i = 0; i < n; ++i) flow[i] = shares[i] / stays[i];
  // x_i = (S - sqrt(S^2 - 4 f_i)) / 2 for all but the largest flow, whose x may be beyond S / 2; S by bisection.
  const std::size_t largest = static_cast<std::size_t>(std::ranges::max_element(flow) - flow.begin());
  const auto share_of = [&](double sum, std::size_t i, double sign) {
    return 0.5 * (sum + sign * std::sqrt(std::max(0.0, sum * sum - 4.0 * flow[i])));
  };
  const double least = 2.0 * std::sqrt(flow[largest]);
  const auto excess = [&](double sum, double sign) {
    double total = -sum;
    for (std::size_t i = 0; i < n; ++i) total += share_of(sum, i, i == largest ? sign : -1.0);
    return total;
  };
  // At the least S both branches of the largest meet: with too much there it stays on the lower one, else on the upper.
  const double sign = excess(least, -1.0) >= 0.0 ? -1.0 : 1.0;
  double low = least, high = least;
  while ((excess(high, sign) > 0.0) == (excess(least, sign) > 0.0) && high < 1e6 * least) high *= 2.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    ((excess(middle, sign) > 0.0) == (excess(least, sign) > 0.0) ? low : high) = middle;
  }
  std::vector<double> rates(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      rates[i * n + j] =
          share_of(low, i, i == largest ? sign : -1.0) * share_of(low, j, j == largest ? sign : -1.0) / shares[i];
    }
  }
  return rates;
}

}  // namespace pirsim::sim
