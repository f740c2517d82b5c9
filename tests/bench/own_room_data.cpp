// The tables of docs/counting.md, as CSV: pirsim_own_room_data [--light] POOL TARGETS...
// POOL and TARGETS are datasets (docs/counting.md says of which recipes), with two sensors in each room. Of the targets
// NAME:odd stands for the first sixty rooms of NAME with sensors that died, a cat, and a fan. --light: what light
// costs, as a counter expects it and in truth.
#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "logs/calibrate.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/control.hpp"

namespace {

using namespace pirsim;
using counting::Counter;
using counting::Pass;
using counting::Stretch;

constexpr int n_sensors = 2;
constexpr double step_s = 30.0;
constexpr std::size_t most_rooms = 100, most_odd_rooms = 60;

std::vector<Stretch> unlabelled(std::vector<Stretch> days) {
  for (Stretch& day : days) day.people.clear();
  return days;
}

/// Of the readings in use; nan if there are none.
template <typename CountOf>
double mean_error(std::span<const Stretch> days, const CountOf& count_of) {
  double sum = 0.0, n = 0.0;
  for (const Stretch& day : days) {
    const std::vector<int> counts = count_of(day);
    const std::vector<bool> in_use = calibrate::in_use(day.people, step_s);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (!in_use[i]) continue;
      sum += std::abs(counts[i] - day.people[i]);
      n += 1.0;
    }
  }
  return sum / n;
}

double error_of(const Counter& counter, std::span<const Stretch> days, Pass pass) {
  return mean_error(days, [&](Stretch day) {
    day.people.clear();
    const counting::Estimates estimates = counting::estimate(counter, day, pass);
    std::vector<int> counts;
    for (std::size_t i = 0; i < day.n_readings(); ++i) counts.push_back(estimates.count(i));
    return counts;
  });
}

/// So many people if any sensor reported motion within the last readings, or before and after a shorter pause.
double error_of_any(std::span<const Stretch> days, int people, std::size_t last_readings, std::size_t pause = 0) {
  return mean_error(days, [&](const Stretch& day) {
    std::vector<int> counts(day.n_readings(), 0);
    std::size_t quiet_for = std::max(last_readings, pause);  // before the first motion
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const bool motion = day.motion[n_sensors * i] == 1 || day.motion[n_sensors * i + 1] == 1;
      if (motion && quiet_for < pause)
        std::fill_n(counts.begin() + static_cast<std::ptrdiff_t>(i - quiet_for), quiet_for, people);
      quiet_for = motion ? 0 : quiet_for + 1;
      if (quiet_for < last_readings) counts[i] = people;
    }
    return counts;
  });
}

/// How often what is told of readings holds: "80 % sure" of somebody, and the band of nine in ten while somebody is
/// there.
struct Held {
  int sure = 0, sure_right = 0, occupied = 0, in_band = 0;
};
Held held_of(const Counter& counter, std::span<const Stretch> days) {
  Held held;
  for (const Stretch& day : days) {
    Stretch bare = day;
    bare.people.clear();
    const counting::Estimates told = counting::estimate(counter, bare, Pass::smoothed);
    for (std::size_t i = 0; i < day.n_readings(); ++i) {
      const int count = told.count(i);
      const double odds =
          told.probabilities[i * static_cast<std::size_t>(told.n_counts) + static_cast<std::size_t>(count)];
      if (count > 0 && odds >= calibrate::sure) ++held.sure, held.sure_right += count == day.people[i] ? 1 : 0;
      if (day.people[i] == 0) continue;
      const auto band = told.band(i, calibrate::band_share);
      ++held.occupied;
      held.in_band += band.least <= day.people[i] && day.people[i] <= band.most ? 1 : 0;
    }
  }
  return held;
}

/// By a log of all days but the last, which is scored, and by one of all days, which all are.
void tell(const std::string& name, int room, const calibrate::Pool& pool, const std::vector<Stretch>& days) {
  if (days.size() < 2) return;
  constexpr std::size_t five_min = 10, fifteen_min = 30;
  for (const std::size_t n_log : {days.size() - 1, days.size()}) {
    const std::vector<Stretch> log = unlabelled({days.begin(), days.begin() + static_cast<std::ptrdiff_t>(n_log)});
    const calibrate::Calibration made = pool.calibrate(log, log);
    const auto scored = std::span<const Stretch>(days).subspan(n_log == days.size() ? 0 : n_log);
    Counter alike = made.counter;
    for (counting::RoomModel& model : alike.rooms) model.weight = model.liveliness == 1.0 ? 1.0 : 0.0;
    for (counting::RoomModel& model : alike.rooms) model.weight /= static_cast<double>(pool.rooms().size());
    const double smoothed = error_of(made.counter, scored, Pass::smoothed);
    std::vector<counting::Estimates> told;
    for (Stretch day : scored) {
      day.people.clear();
      told.push_back(counting::estimate(made.counter, day, Pass::smoothed));
    }
    const calibrate::FigureErrors figures = calibrate::figure_errors(told, scored, step_s);
    const Held held = held_of(made.counter, scored);
    std::cout << name << ',' << room << ',' << n_log;
    for (const int people : {1, 2, 3}) std::cout << ',' << error_of_any(scored, people, five_min);
    std::cout << ',' << error_of_any(scored, 2, five_min, fifteen_min) << ',' << error_of(alike, scored, Pass::smoothed)
              << ',' << error_of(made.counter, scored, Pass::forward) << ',' << smoothed << ',' << held.sure << ','
              << held.sure_right << ',' << held.occupied << ',' << held.in_band << ',' << made.p << ','
              << (made.counter.expected_error && made.counter.expected_error->contains(smoothed) ? 1 : 0);
    for (std::size_t f = 0; f < figures.size(); ++f) {
      const counting::Off off =
          made.counter.figures_off.value_or(counting::FiguresOff{}).*counting::figure_names[f].off;
      std::cout << ',' << std::accumulate(figures[f].begin(), figures[f].end(), 0.0) << ',' << figures[f].size() << ','
                << std::ranges::count_if(figures[f], [&](double error) { return error <= off.most + 1e-9; });
    }
    std::cout << '\n';
  }
}

/// Light of any sensor's motion by (days)(readings) of people; nobody: as Control has it.
control::Costs light_of(std::span<const Stretch> days, const std::vector<std::vector<int>>& people,
                        const std::vector<std::vector<double>>& nobody) {
  control::Control light(control::RuleSpec{"light", {{}}}, {{"PIR1", "PIR2"}, {}, {}}, step_s,
                         control::People::expected);
  Sample row;
  for (std::size_t d = 0; d < days.size(); ++d) {
    row.replicate = static_cast<int>(d) + 1;
    for (std::size_t i = 0; i < days[d].n_readings(); ++i) {
      row.time_s = step_s * static_cast<double>(i + 1);
      row.bits = {days[d].motion[n_sensors * i], days[d].motion[n_sensors * i + 1]};
      row.people = people[d][i];
      light.add(row, {}, nobody[d][i]);
    }
  }
  return light.finish();
}

void tell_light(const std::string& name, int room, const calibrate::Pool& pool, const std::vector<Stretch>& days) {
  const std::vector<Stretch> log = unlabelled(days);
  const Counter counter = pool.calibrate(log, log).counter;
  constexpr int n_draws = 100;
  std::vector<std::vector<int>> truth;
  std::vector<std::vector<double>> nobody;
  std::vector<std::vector<std::vector<int>>> courses(n_draws);
  for (std::size_t d = 0; d < log.size(); ++d) {
    truth.push_back(days[d].people);
    const counting::Estimates forward = counting::estimate(counter, log[d], Pass::forward);
    std::vector<double>& of_day = nobody.emplace_back();
    for (std::size_t i = 0; i < log[d].n_readings(); ++i)
      of_day.push_back(forward.probabilities[i * static_cast<std::size_t>(forward.n_counts)]);
    const auto drawn = counting::draw_people(counter, log[d], n_draws);
    for (int draw = 0; draw < n_draws; ++draw)
      courses[static_cast<std::size_t>(draw)].push_back(drawn[static_cast<std::size_t>(draw)]);
  }
  std::vector<control::Costs> costs;
  for (const auto& course : courses) costs.push_back(light_of(log, course, nobody));
  const control::LightCosts expected = control::expected_of(costs).lights.front();
  const control::LightCosts real = light_of(log, truth, nobody).lights.front();
  const auto tell = [&](const std::string& when, const control::DelayCosts& told,
                        const control::DelayCosts& true_costs) {
    std::cout << name << ',' << room << ',' << when;
    for (const auto figure : {&control::DelayCosts::false_offs_an_hour, &control::DelayCosts::dark_share,
                              &control::DelayCosts::empty_share}) {
      const Interval interval = (told.*figure).over_days.value_or(Interval{});
      std::cout << ',' << (true_costs.*figure).value << ',' << (told.*figure).value << ',' << interval.low << ','
                << interval.high;
    }
    std::cout << '\n';
  };
  for (std::size_t i = 0; i < expected.by_delay.size(); ++i)
    tell(std::to_string(static_cast<int>(expected.by_delay[i].delay_min)), expected.by_delay[i], real.by_delay[i]);
  for (std::size_t i = 0; i < expected.by_nobody.size(); ++i)
    tell("nobody " + std::to_string(*expected.by_nobody[i].nobody), expected.by_nobody[i], real.by_nobody[i]);
}

/// What a recipe hasn't got, in readings of a room that it has.
std::vector<std::pair<std::string, std::vector<Stretch>>> odd_days(const std::vector<Stretch>& days,
                                                                   std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  constexpr double visits = 2.0 / 120.0;  // of a cat, a reading: twice an hour
  constexpr std::size_t stay = 10;
  std::vector<Stretch> died = days, at_noon = days, cat = days, fan = days;
  for (std::size_t d = 0; d < days.size(); ++d) {
    const std::size_t n = days[d].n_readings();
    for (std::size_t i = 0; i < n; ++i) {
      died[d].motion[n_sensors * i + 1] = 0;
      if (i > n / 2) at_noon[d].motion[n_sensors * i + 1] = 0;
      if (uniform(random) < 0.2) fan[d].motion[n_sensors * i] = 1;
      if (uniform(random) >= visits) continue;
      for (std::size_t bit = n_sensors * i; bit < n_sensors * std::min(i + stay, n); ++bit) {
        if (uniform(random) < 0.5) cat[d].motion[bit] = 1;
      }
    }
  }
  return {{"died", died}, {"died at noon", at_noon}, {"cat", cat}, {"fan", fan}};
}

void run(std::span<char*> arguments) {
  const bool is_light = std::string(arguments[0]) == "--light";
  if (is_light) arguments = arguments.subspan(1);
  const calibrate::Pool pool(calibrate::read_pool(arguments[0], n_sensors, step_s));
  if (is_light)
    std::cout
        << "set,room,goes_off,offs,offs_told,offs_low,offs_high,dark,dark_told,dark_low,dark_high,empty,empty_told,"
           "empty_low,empty_high\n";
  else
    std::cout
        << "set,room,log_days,any_1,any_2,any_3,any_2_closed,alike,forward,smoothed,sure,sure_right,occupied,in_band,p,"
           "stated_holds";
  for (const auto& [figure, off] : counting::figure_names)
    if (!is_light) std::cout << ',' << figure << "_sum," << figure << "_n," << figure << "_held";
  if (!is_light) std::cout << '\n';
  constexpr const char* odd = ":odd";
  for (const std::string name : arguments.subspan(1)) {
    const bool is_odd = name.ends_with(odd);
    auto targets = calibrate::read_pool(is_odd ? name.substr(0, name.size() - 4) : name, n_sensors, step_s);
    targets.resize(std::min(targets.size(), is_odd ? most_odd_rooms : most_rooms));
    std::mt19937 random(7);
    for (const calibrate::PoolRoom& room : targets) {
      if (is_light) tell_light(name, room.labelled.number, pool, room.labelled.days);
      if (is_light) continue;
      if (!is_odd) tell(name, room.labelled.number, pool, room.labelled.days);
      if (!is_odd) continue;
      for (const auto& [what, days] : odd_days(room.labelled.days, random))
        tell(what, room.labelled.number, pool, days);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 3) throw std::runtime_error("usage: pirsim_own_room_data POOL TARGETS...");
    run(std::span(argv + 1, static_cast<std::size_t>(argc - 1)));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
