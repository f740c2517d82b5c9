// Days as they are drawn, against the published parameters. Statistical tests have a size of 0.001 each; the twin of
// each tries a parameter that is a little off and must fail.
#include "engine/sim/day_draw.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "model/schema/clock.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::sim;

namespace {

constexpr std::int64_t monday = 20514;  // 2026-03-02
constexpr std::uint32_t n_days = 200;
constexpr double z_limit = 3.29, ks_limit = 1.95;  // two-sided 0.001; of D sqrt(n) for large n

using People = std::vector<std::optional<DayPerson>>;

People people(SchedulePart part, std::size_t n, Role role = Role::staff) { return {n, DayPerson{part, role}}; }

/// most_at_meeting: of each of the schedule's rooms.
std::vector<DayDraw> draw_days(const ScheduleSpec& schedule, const People& who, std::uint32_t n = n_days,
                               const std::vector<int>& most_at_meeting = {8}) {
  std::vector<DayDraw> days;
  for (std::uint32_t run = 0; run < n; ++run)
    days.push_back(draw_times({schedule, who, most_at_meeting, 27, run, monday}));
  return days;
}

/// Of the time at work but lunch, by day and person: how far the share of a place is from `expected`, in its standard
/// errors (over person-days, which are independent).
double share_z(const std::vector<DayDraw>& days, Place place, double expected) {
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (const DayDraw& day : days) {
    for (const auto& stays : day.stays) {
      double off = 0.0;
      for (const Stay& stay : stays) {
        if (stay.place == Place::lunch) continue;
        off += (stay.to_s - stay.from_s) * ((stay.place == place ? 1.0 : 0.0) - expected);
      }
      sum += off;
      squares += off * off;
      n += 1.0;
    }
  }
  return sum / std::sqrt(squares - sum * sum / n);
}

/// Kolmogorov-Smirnov: D sqrt(n) of values below `end` only; the others are known to lie above.
double ks(std::vector<double> values, const std::function<double(double)>& cumulative, double end = 1e300) {
  std::ranges::sort(values);
  const auto n = static_cast<double>(values.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < values.size() && values[i] < end; ++i) {
    const double expected = cumulative(values[i]);
    worst = std::max(
        {worst, std::abs(expected - static_cast<double>(i) / n), std::abs(expected - static_cast<double>(i + 1) / n)});
  }
  return worst * std::sqrt(n);
}

std::function<double(double)> normal(double mean, double sd) {
  return [=](double x) { return 0.5 * std::erfc((mean - x) / (sd * std::sqrt(2.0))); };
}
/// As stays are: exponential beyond two minutes.
std::function<double(double)> stay_of(double mean_min) {
  return [mean = mean_min * minute_s](double x) {
    return x < shortest_stay_s ? 0.0 : -std::expm1(-(x - shortest_stay_s) / (mean - shortest_stay_s));
  };
}

/// Stays that begin two hours or more before lunch or departure, so that neither cuts what is looked at; not the first
/// ones, which are found going on.
std::vector<double> whole_stays(const std::vector<DayDraw>& days, Place place, double within_s) {
  std::vector<double> lengths;
  for (const DayDraw& day : days) {
    for (const auto& stays : day.stays) {
      std::size_t begin = 0;
      for (std::size_t i = 0; i <= stays.size(); ++i) {
        if (i < stays.size() && stays[i].place != Place::lunch) continue;
        for (std::size_t k = begin + 1; k < i; ++k) {
          if (stays[k].place != place || stays[k].from_s > stays[i - 1].to_s - within_s) continue;
          lengths.push_back(std::min(within_s, stays[k].to_s - stays[k].from_s));
        }
        begin = i + 1;
      }
    }
  }
  return lengths;
}

double chi_square(const std::map<int, double>& counts, const std::map<int, double>& probabilities) {
  double n = 0.0, sum = 0.0;
  for (const auto& [value, count] : counts) n += count;
  for (const auto& [value, p] : probabilities) {
    const double count = counts.contains(value) ? counts.at(value) : 0.0;
    sum += (count - n * p) * (count - n * p) / (n * p);
  }
  return sum;
}

std::map<int, double> uniform(int low, int high) {
  std::map<int, double> probabilities;
  for (int i = low; i <= high; ++i) probabilities[i] = 1.0 / (high - low + 1);
  return probabilities;
}

}  // namespace

TEST_CASE("Shares of time are the published ones for every role") {
  for (const Role role : {Role::staff, Role::manager, Role::administrator}) {
    const auto days = draw_days({}, people(SchedulePart::staff, 8, role));
    const Habits habits = habits_of(role);
    CHECK(std::accumulate(habits.shares.begin(), habits.shares.end(), 0.0) == Approx(1.0));
    for (std::size_t place = 0; place < n_places; ++place) {
      INFO("role " << static_cast<int>(role) << " place " << place);
      CHECK(std::abs(share_z(days, static_cast<Place>(place), habits.shares[place])) < z_limit);
      CHECK(std::abs(share_z(days, static_cast<Place>(place), habits.shares[place] + 0.03)) > z_limit);
    }
  }
}

TEST_CASE("Stays have the published means") {
  constexpr double within_s = 2.0 * hour_s;
  const auto days = draw_days({}, people(SchedulePart::staff, 8));
  const Habits habits = habits_of(Role::staff);
  for (std::size_t place = 0; place < n_places; ++place) {
    const auto lengths = whole_stays(days, static_cast<Place>(place), within_s);
    INFO("place " << place << ", " << lengths.size() << " stays");
    REQUIRE(lengths.size() > 400);
    CHECK(ks(lengths, stay_of(habits.stays_min[place]), within_s) < ks_limit);
    CHECK(ks(lengths, stay_of(1.4 * habits.stays_min[place]), within_s) > ks_limit);
  }
}

TEST_CASE("Arrival, lunch and departure are the published ones") {
  std::vector<double> arrivals, departures, lunches, lengths;
  for (const DayDraw& day : draw_days({}, people(SchedulePart::staff, 8))) {
    for (const auto& stays : day.stays) {
      arrivals.push_back(stays.front().from_s);
      departures.push_back(stays.back().to_s);
      const auto lunch = std::ranges::find(stays, Place::lunch, &Stay::place);
      REQUIRE(lunch != stays.end());
      lunches.push_back(lunch->from_s);
      lengths.push_back(lunch->to_s - lunch->from_s);
      for (std::size_t i = 1; i < stays.size(); ++i) CHECK(stays[i].from_s == stays[i - 1].to_s);
    }
  }
  const double sd_s = 30.0 * minute_s;
  CHECK(ks(arrivals, normal(8.5 * hour_s, sd_s)) < ks_limit);
  CHECK(ks(departures, normal(17.5 * hour_s, sd_s)) < ks_limit);
  CHECK(ks(lunches, normal(12.0 * hour_s, sd_s)) < ks_limit);
  CHECK(ks(lengths, normal(hour_s, 0.5 * sd_s)) < ks_limit);
  CHECK(ks(arrivals, normal(8.6 * hour_s, sd_s)) > ks_limit);
  CHECK(ks(arrivals, normal(8.5 * hour_s, 1.3 * sd_s)) > ks_limit);
}

TEST_CASE("Visits go to a colleague at their desk, or out of the room") {
  int hosted = 0, elsewhere = 0;
  for (const DayDraw& day : draw_days({}, people(SchedulePart::staff, 4), 20)) {
    for (std::size_t i = 0; i < day.stays.size(); ++i) {
      for (const Stay& visit : day.stays[i]) {
        if (visit.place != Place::others_desk) continue;
        ++(visit.host ? hosted : elsewhere);
        if (!visit.host) continue;
        CHECK(*visit.host != i);
        CHECK(std::ranges::any_of(day.stays[*visit.host], [&](const Stay& stay) {
          return stay.place == Place::desk && stay.from_s <= visit.from_s && visit.from_s < stay.to_s;
        }));
      }
    }
  }
  CHECK(hosted > 100);
  CHECK(elsewhere > 0);
}

TEST_CASE("Meetings have the published number, lengths and people") {
  ScheduleSpec schedule;
  schedule.meetings.emplace_back();
  std::map<int, double> numbers, lengths, sizes;
  double late = 0.0, squares = 0.0, n = 0.0, early = 0.0, presented = 0.0;
  for (const DayDraw& day : draw_days(schedule, people(SchedulePart::guest, 8))) {
    ++numbers[static_cast<int>(day.meetings.size())];
    double free_s = 9.0 * hour_s;
    for (const Meeting& meeting : day.meetings) {
      ++lengths[static_cast<int>(std::lround((meeting.end_s - meeting.begin_s) / minute_s))];
      ++sizes[static_cast<int>(meeting.people.size())];
      CHECK(meeting.begin_s >= free_s);
      free_s = meeting.end_s;
      for (const Attendance& who : meeting.people) {
        const double late_s = who.comes_s - meeting.begin_s;
        late += late_s;
        squares += late_s * late_s;
        n += 1.0;
        early += who.goes_s < meeting.end_s ? 1.0 : 0.0;
        presented += who.presents_until_s ? 1.0 : 0.0;
        CHECK(who.comes_s < who.goes_s);
      }
    }
    CHECK(free_s <= 18.0 * hour_s);
  }
  CHECK(chi_square(numbers, uniform(2, 6)) < 18.47);  // 4 degrees of freedom
  CHECK(chi_square(numbers, uniform(2, 7)) > 20.52);
  CHECK(chi_square(lengths, {{30, 0.13}, {60, 0.70}, {90, 0.12}, {120, 0.05}}) < 16.27);
  CHECK(chi_square(lengths, {{30, 0.20}, {60, 0.63}, {90, 0.12}, {120, 0.05}}) > 16.27);
  CHECK(chi_square(sizes, uniform(2, 8)) < 22.46);
  CHECK(chi_square(sizes, uniform(2, 9)) > 24.32);
  const double mean = late / n, error = std::sqrt((squares / n - mean * mean) / n);
  CHECK(std::abs(mean - 2.0 * minute_s) < z_limit * error);
  CHECK(std::abs(mean - 3.0 * minute_s) > z_limit * error);
  CHECK(early / n == Approx(0.1).margin(0.03));
  CHECK(presented > 0.0);
}

TEST_CASE("Staff are called to meetings in several rooms, as many as published, nobody to two at once") {
  constexpr std::size_t n_staff = 24;
  ScheduleSpec schedule;
  schedule.meetings.resize(2);
  for (MeetingsSpec& room : schedule.meetings) room.attendees = Attendees::staff;
  const std::vector<DayDraw> days = draw_days(schedule, people(SchedulePart::staff, n_staff), 1000, {8, 6});
  std::map<int, double> sizes, called;
  int at_once = 0;
  for (const DayDraw& day : days) {
    for (const auto& stays : day.stays) {
      for (std::size_t k = 0; k < stays.size(); ++k) {
        CHECK(stays[k].from_s < stays[k].to_s);
        if (k > 0) CHECK(stays[k].from_s == stays[k - 1].to_s);         // nobody is nowhere, or in two places
        if (stays[k].place == Place::meeting) CHECK(stays[k].meeting);  // none is elsewhere
      }
    }
    for (std::size_t m = 0; m < day.meetings.size(); ++m) {
      const Meeting& meeting = day.meetings[m];
      if (meeting.room == 0 && meeting.begin_s > 10.0 * hour_s && meeting.end_s < 12.0 * hour_s)
        ++sizes[static_cast<int>(meeting.people.size())];
      CHECK(meeting.people.size() <= (meeting.room == 0 ? 8 : 6));
      at_once += std::ranges::any_of(day.meetings, [&](const Meeting& other) {
        return other.room > meeting.room && other.begin_s < meeting.end_s && meeting.begin_s < other.end_s;
      });
      for (const Attendance& who : meeting.people) {
        ++called[static_cast<int>(who.person)];
        const auto& stays = day.stays[who.person];
        const auto stay = std::ranges::find_if(stays, [&](const Stay& s) { return s.meeting == m; });
        REQUIRE(stay != stays.end());
        CHECK(stay->from_s == who.comes_s);
        CHECK(stay->to_s == Approx(who.goes_s).margin(minute_s + 1e-6));  // cut where the next one begins at once
      }
    }
  }
  CHECK(at_once > 500);
  CHECK(chi_square(sizes, uniform(2, 8)) < 22.46);
  CHECK(chi_square(sizes, uniform(2, 9)) > 24.32);
  // All of them as often: the variance of a hypergeometric draw is smaller than a chi-square's; 23 degrees of freedom.
  std::map<int, double> alike, older;
  for (int i = 0; i < static_cast<int>(n_staff); ++i)
    alike[i] = 1.0 / n_staff, older[i] = i < 12 ? 1.15 / n_staff : 0.85 / n_staff;
  CHECK(chi_square(called, alike) < 49.73);
  CHECK(chi_square(called, older) > 49.73);
}

TEST_CASE("Rates of moves give back shares and mean stays by brute force") {
  for (const Role role : {Role::staff, Role::manager, Role::administrator}) {
    const Habits habits = habits_of(role);
    const auto rates = markov_rates(habits.shares, habits.stays_min);
    const auto stationary = [&](const std::vector<double>& q) {
      std::array<double, n_places> p{1.0, 0.0, 0.0, 0.0};
      constexpr double step_min = 0.5;
      for (int k = 0; k < 200000; ++k) {
        auto next = p;
        for (std::size_t i = 0; i < n_places; ++i) {
          for (std::size_t j = 0; j < n_places; ++j) {
            const double moved = p[i] * q[i * n_places + j] * step_min;
            next[i] -= moved;
            next[j] += moved;
          }
        }
        p = next;
      }
      return p;
    };
    const auto shares = stationary(rates);
    for (std::size_t i = 0; i < n_places; ++i) {
      const auto row = std::span(rates).subspan(i * n_places, n_places);
      CHECK(shares[i] == Approx(habits.shares[i]).epsilon(1e-6));
      CHECK(1.0 / std::accumulate(row.begin(), row.end(), 0.0) == Approx(habits.stays_min[i]).epsilon(1e-6));
    }
    auto wrong = rates;
    for (std::size_t j = 0; j < n_places; ++j) wrong[j] *= 1.1;
    CHECK(std::abs(stationary(wrong)[0] - habits.shares[0]) > 0.01);
  }
}

TEST_CASE("Nobody comes on Saturdays and Sundays") {
  ScheduleSpec schedule;
  schedule.meetings.emplace_back();
  schedule.cleaning_h = 19.0;
  People who = people(SchedulePart::staff, 2);
  who.push_back(DayPerson{SchedulePart::guest});
  who.push_back(DayPerson{SchedulePart::cleaner});
  const std::vector<int> most{8};
  for (std::int64_t day = 0; day < 14; ++day) {
    const DayDraw draw = draw_times({schedule, who, most, 1, static_cast<std::uint32_t>(day), monday + day});
    const bool works = day % 7 < 5;
    CHECK(draw.stays[0].empty() != works);
    CHECK(draw.meetings.empty() != works);
    CHECK(draw.cleaning_s.has_value() == works);
    CHECK(is_working_day(monday + day) == works);
  }
}

TEST_CASE("Clock times go on across midnight, months and the hour that summer time leaves out") {
  CHECK(day_number("2026-03-02", {}) == monday);
  CHECK(clock_text(monday, 0.0) == "2026-03-02T00:00:00");
  CHECK(clock_text(monday, 86399.0) == "2026-03-02T23:59:59");
  CHECK(clock_text(monday, 86400.0) == "2026-03-03T00:00:00");
  CHECK(clock_text(monday, -30.0) == "2026-03-01T23:59:30");
  CHECK(clock_text(monday, -86400.0) == "2026-03-01T00:00:00");
  CHECK(clock_text(day_number("2026-03-29", {}), 2.5 * hour_s) == "2026-03-29T02:30:00");
  CHECK(clock_text(day_number("2028-02-28", {}), 25.0 * hour_s) == "2028-02-29T01:00:00");
  CHECK(clock_text(day_number("2026-12-31", {}), 86400.0) == "2027-01-01T00:00:00");
  CHECK_THROWS_WITH(day_number("2026-02-30", {}), contains("is no date"));
  CHECK_THROWS_WITH(day_number("2026-3-2", {}), contains("is no date"));
}
