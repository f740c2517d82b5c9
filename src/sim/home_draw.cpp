#include "sim/home_draw.hpp"

#include <algorithm>
#include <cmath>

#include "pirsim/random.hpp"
#include "schema/clock.hpp"
#include "sim/day_draw.hpp"

namespace pirsim::sim {
namespace {

constexpr double home_day_ends_s = home_to_h * hour_s;

// Assumed, with the range tried; the sums of a day are compared with the survey's in home_draw_test.
constexpr double toilet_s = 4.0 * minute_s;                                              // 2 to 6 min
constexpr double morning_wash_s = 20.0 * minute_s, evening_wash_s = 10.0 * minute_s;     // 10 to 30, 5 to 15
constexpr double breakfast_s = 25.0 * minute_s, breakfast_cooking_s = 10.0 * minute_s;   // 10 to 30, 5 to 15
constexpr double lunch_s = 55.0 * minute_s, dinner_s = 60.0 * minute_s;                  // 30 to 75
constexpr double lunch_cooking_s = 45.0 * minute_s, dinner_cooking_s = 50.0 * minute_s;  // 20 to 60
constexpr double shortest_pastime_s = 5.0 * minute_s;
constexpr double work_between_breaks_s = 90.0 * minute_s, break_s = 10.0 * minute_s;  // 60 to 120, 5 to 15

/// Of this mean, a third or three times as long in one of a hundred cases.
double about(Stream& stream, double mean) {
  constexpr double sigma = 0.45;  // assumed (0.3-0.6)
  return mean * std::exp(sigma * cut_normal(stream) - 0.5 * sigma * sigma);
}

/// What somebody does at each moment of a day. What is put in later takes the place of what was there.
class StayLine {
 public:
  explicit StayLine(HomeActivity all_day) : stays_{{all_day, home_day_begins_s, home_day_ends_s}} {}

  void put(HomeActivity activity, double from_s, double to_s) {
    from_s = std::max(from_s, home_day_begins_s);
    to_s = std::min(to_s, home_day_ends_s);
    if (!(to_s > from_s)) return;
    std::vector<HomeStay> stays;
    for (const HomeStay& stay : stays_) {
      if (stay.from_s < from_s) stays.push_back({stay.activity, stay.from_s, std::min(stay.to_s, from_s)});
      if (stay.to_s > to_s) stays.push_back({stay.activity, std::max(stay.from_s, to_s), stay.to_s});
    }
    stays.push_back({activity, from_s, to_s});
    std::ranges::sort(stays, {}, &HomeStay::from_s);
    stays_ = std::move(stays);
  }

  [[nodiscard]] HomeActivity at(double time_s) const {
    const auto stay = std::ranges::find_if(stays_, [&](const HomeStay& s) { return time_s < s.to_s; });
    return stay == stays_.end() ? stays_.back().activity : stay->activity;
  }
  [[nodiscard]] bool is_up_at_home(double time_s) const {
    return at(time_s) != HomeActivity::away && at(time_s) != HomeActivity::sleep;
  }
  [[nodiscard]] const std::vector<HomeStay>& stays() const noexcept { return stays_; }
  /// Neighbours that are alike as one.
  [[nodiscard]] std::vector<HomeStay> joined() const {
    std::vector<HomeStay> stays;
    for (const HomeStay& stay : stays_) {
      if (!stays.empty() && stays.back().activity == stay.activity) {
        stays.back().to_s = stay.to_s;
      } else {
        stays.push_back(stay);
      }
    }
    return stays;
  }

 private:
  std::vector<HomeStay> stays_;
};

struct Nights {
  double wakes_s, goes_to_bed_s;
};

void sleep_and_wash(StayLine& day, const Nights& nights, Stream& stream) {
  day.put(HomeActivity::sleep, home_day_begins_s, nights.wakes_s);
  double now = nights.wakes_s;
  const auto next = [&](HomeActivity activity, double mean_s) {
    const double until = now + about(stream, mean_s);
    day.put(activity, now, until);
    now = until;
  };
  next(HomeActivity::toilet, toilet_s);
  next(HomeActivity::wash, morning_wash_s);
  next(HomeActivity::cook, breakfast_cooking_s);
  next(HomeActivity::eat, breakfast_s);
  day.put(HomeActivity::wash, nights.goes_to_bed_s - about(stream, evening_wash_s), nights.goes_to_bed_s);
  day.put(HomeActivity::sleep, nights.goes_to_bed_s, home_day_ends_s);
}

/// Work, or what takes somebody out who has none today: errands, sport, friends.
void spend_the_day(StayLine& day, const HouseholdSpec& household, Occupation today, Stream& stream) {
  if (today != Occupation::at_home) {
    const double leaves_s = around(stream, household.leaves);
    const double until_s = std::max(leaves_s, around(stream, household.comes_home));
    return day.put(today == Occupation::works ? HomeActivity::away : HomeActivity::work, leaves_s, until_s);
  }
  constexpr double goes_out = 0.85;               // assumed (0.7-0.95): share of days
  constexpr double first_h = 9.5, last_h = 17.5;  // assumed: when
  constexpr double mean_s = 2.5 * hour_s;         // shopping, exercise, company and ways. Ref: [Idescat2011]
  const double share = stream.uniform(), when = stream.uniform(), length_s = about(stream, mean_s);
  const double from_s = (first_h + (last_h - first_h) * when) * hour_s;
  if (share < goes_out) day.put(HomeActivity::away, from_s, from_s + length_s);
}

/// Rest between stretches of work, unless hardly any work is left after it.
void take_breaks(StayLine& day, Stream& stream) {
  for (const HomeStay& stretch : day.joined()) {
    if (stretch.activity != HomeActivity::work) continue;
    for (double now = stretch.from_s;;) {
      const double from_s = now + about(stream, work_between_breaks_s);
      now = from_s + about(stream, break_s);
      if (now + break_s > stretch.to_s) break;
      day.put(HomeActivity::rest, from_s, now);
    }
  }
}

/// One of those at home cooks, and all at home eat.
void have_meal(std::vector<StayLine>& days, double at_s, double cooking_s, double length_s, Stream& stream) {
  const double cooking = about(stream, cooking_s), eating = about(stream, length_s), u = stream.uniform();
  std::vector<StayLine*> cooks, eaters;
  for (StayLine& day : days) {
    if (!day.is_up_at_home(at_s)) continue;
    eaters.push_back(&day);
    if (day.is_up_at_home(at_s - cooking)) cooks.push_back(&day);
  }
  if (cooks.empty()) return;
  const auto cook = static_cast<std::size_t>(u * static_cast<double>(cooks.size()));
  cooks[cook]->put(HomeActivity::cook, at_s - cooking, at_s);
  for (StayLine* day : eaters) day->put(HomeActivity::eat, at_s, at_s + eating);
}

/// How readily somebody does it at this hour, beside the other pastimes. Assumed: television in the evening, no
/// housework at night.
double appeal(HomeActivity activity, double time_s) {
  const double hour = time_s / hour_s;
  if (activity == HomeActivity::tv) return hour >= 18.0 ? 3.0 : 1.0;
  if (activity == HomeActivity::chores) return hour >= 20.0 ? 0.1 : 1.0;
  return 1.0;
}

/// Fills what is left of the day: each pastime in sessions, those with much left to do first; then rest.
void pass_the_time(StayLine& day, Stream& stream) {
  std::array<double, pastimes.size()> left_s{};
  for (std::size_t i = 0; i < pastimes.size(); ++i) {
    const double share = stream.uniform(), length_s = about(stream, pastimes[i].mean_min * minute_s);
    if (share < pastimes[i].participation) left_s[i] = length_s;
  }
  const std::vector<HomeStay> stays = day.joined();
  for (const HomeStay& gap : stays) {
    if (gap.activity != HomeActivity::rest) continue;
    for (double now = gap.from_s; gap.to_s - now >= shortest_pastime_s;) {
      double all = 0.0;
      for (std::size_t i = 0; i < pastimes.size(); ++i) all += left_s[i] * appeal(pastimes[i].activity, now);
      if (!(all > 0.0)) break;
      double u = all * stream.uniform();
      std::size_t chosen = 0;
      for (std::size_t i = 0; i < pastimes.size(); ++i) {
        if (left_s[i] <= 0.0) continue;
        chosen = i;
        if ((u -= left_s[i] * appeal(pastimes[i].activity, now)) < 0.0) break;
      }
      const double session_s = std::max(shortest_pastime_s, about(stream, pastimes[chosen].session_min * minute_s));
      const double until = std::min(now + std::min(session_s, std::max(left_s[chosen], shortest_pastime_s)), gap.to_s);
      day.put(pastimes[chosen].activity, now, until);
      left_s[chosen] = std::max(0.0, left_s[chosen] - (until - now));
      now = until;
    }
  }
}

/// Every three to four hours by day [Lukacz2009], and at night as somebody's age has it.
void go_to_the_toilet(StayLine& day, const Nights& nights, double age_years, Stream& stream) {
  constexpr double shortest_s = hour_s, further_s = 2.5 * hour_s;
  const auto next_s = [&] { return shortest_s + exponential(stream, further_s); };
  for (double now = nights.wakes_s + next_s(); now < nights.goes_to_bed_s; now += next_s()) {
    if (day.is_up_at_home(now)) day.put(HomeActivity::toilet, now, now + about(stream, toilet_s));
  }
  const double asleep_s = nights.wakes_s - home_day_begins_s + home_day_ends_s - nights.goes_to_bed_s;
  const double mean_s = asleep_s / night_visits(age_years);
  const auto visit_between = [&](double from_s, double to_s) {
    for (double now = from_s + exponential(stream, mean_s); now < to_s; now += exponential(stream, mean_s))
      day.put(HomeActivity::toilet, now, std::min(now + about(stream, toilet_s), to_s));
  };
  visit_between(home_day_begins_s, nights.wakes_s);
  visit_between(nights.goes_to_bed_s, home_day_ends_s);
}

}  // namespace

double night_visits(double age_years) {
  // Share of men and women who get up at all, averaged: 20-39, 40-59, 60 and older. Ref: [Soysal2023].
  const double share = age_years < 40.0   ? 0.5 * (0.568 + 0.689)
                       : age_years < 60.0 ? 0.5 * (0.702 + 0.743)
                                          : 0.5 * (0.827 + 0.847);
  return -std::log(1.0 - share);
}

HomeDay draw_home_day(const HouseholdSpec& household, std::uint64_t seed, std::uint32_t run, std::int64_t day) {
  const bool works = is_working_day(day);
  const auto today = [&](std::size_t i) { return works ? household.residents[i].occupation : Occupation::at_home; };
  std::vector<StayLine> days(household.residents.size(), StayLine(HomeActivity::rest));
  std::vector<Stream> streams;
  std::vector<Nights> nights;
  for (std::size_t i = 0; i < days.size(); ++i) {
    Stream& stream = streams.emplace_back(StreamKey{seed, run, static_cast<std::uint32_t>(i), Purpose::home_day});
    const double wakes_s = around(stream, works ? household.wakes : household.wakes_on_free_days);
    const double goes_to_bed_s = around(stream, household.goes_to_bed);
    nights.push_back({std::clamp(wakes_s, home_day_begins_s, home_day_ends_s),
                      std::clamp(goes_to_bed_s, std::max(wakes_s, home_day_begins_s), home_day_ends_s)});
    sleep_and_wash(days[i], nights[i], stream);
    spend_the_day(days[i], household, today(i), stream);
  }
  Stream together({seed, run, 0, Purpose::home_meals});
  const double lunch_at_s = around(together, household.lunch), dinner_at_s = around(together, household.dinner);
  have_meal(days, lunch_at_s, lunch_cooking_s, lunch_s, together);
  have_meal(days, dinner_at_s, dinner_cooking_s, dinner_s, together);
  HomeDay drawn;
  constexpr double visit_h = 19.5, visit_sd_h = 1.0, visit_mean_s = 2.0 * hour_s;  // assumed (18-21 h, 1-3 h)
  const double visited = together.uniform(), comes_s = (visit_h + visit_sd_h * cut_normal(together)) * hour_s;
  const double goes_s = comes_s + about(together, visit_mean_s);
  if (visited < household.visits_a_week / 7.0) drawn.visits.push_back({comes_s, goes_s});
  for (std::size_t i = 0; i < days.size(); ++i) {
    pass_the_time(days[i], streams[i]);
    if (today(i) == Occupation::works_at_home) take_breaks(days[i], streams[i]);
    go_to_the_toilet(days[i], nights[i], household.residents[i].age_years, streams[i]);
    drawn.residents.push_back(days[i].joined());
  }
  return drawn;
}

}  // namespace pirsim::sim
