// The first table of docs/counting.md, as CSV: pirsim_own_room_data POOL TARGETS...
// POOL and TARGETS are datasets (docs/counting.md says of which recipes), with two sensors in each room. Of the targets
// NAME:odd stands for the first sixty rooms of NAME with sensors that died, a cat, and a fan.
#include <cmath>
#include <exception>
#include <iostream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "logs/calibrate.hpp"
#include "pirsim/calibrate.hpp"

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

/// One person if any sensor reported motion in the last five minutes.
double error_of_yardstick(std::span<const Stretch> days) {
  return mean_error(days, [](const Stretch& day) {
    constexpr std::size_t readings = 10;
    std::vector<int> counts;
    std::size_t quiet_for = readings;
    for (std::size_t i = 0; i < day.n_readings(); ++i) {
      const bool motion = day.motion[n_sensors * i] == 1 || day.motion[n_sensors * i + 1] == 1;
      quiet_for = motion ? 0 : quiet_for + 1;
      counts.push_back(quiet_for < readings ? 1 : 0);
    }
    return counts;
  });
}

void tell(const std::string& name, int room, const calibrate::Pool& pool, const std::vector<Stretch>& days) {
  if (days.size() < 2) return;
  for (const std::size_t n_log : {std::size_t{1}, days.size()}) {
    const std::vector<Stretch> log = unlabelled({days.begin(), days.begin() + static_cast<std::ptrdiff_t>(n_log)});
    const calibrate::Calibration made = pool.calibrate(log, log);
    Counter alike = made.counter;
    for (counting::RoomModel& model : alike.rooms) model.weight = 1.0 / static_cast<double>(alike.rooms.size());
    const std::span<const Stretch> later = std::span(days).subspan(1);
    const double truth = error_of(made.counter, n_log == 1 ? later : std::span(days), Pass::forward);
    std::cout << name << ',' << room << ',' << n_log << ',' << error_of_yardstick(later) << ','
              << error_of(alike, later, Pass::forward) << ',' << error_of(made.counter, later, Pass::forward) << ','
              << error_of(made.counter, later, Pass::smoothed) << ',' << made.p << ','
              << (made.counter.expected_error && made.counter.expected_error->contains(truth) ? 1 : 0) << '\n';
  }
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
  const calibrate::Pool pool(calibrate::read_pool(arguments[0], n_sensors, step_s));
  std::cout << "set,room,log_days,yardstick,alike,weighed,smoothed,p,interval_holds\n";
  constexpr const char* odd = ":odd";
  for (const std::string name : arguments.subspan(1)) {
    const bool is_odd = name.ends_with(odd);
    auto targets = calibrate::read_pool(is_odd ? name.substr(0, name.size() - 4) : name, n_sensors, step_s);
    targets.resize(std::min(targets.size(), is_odd ? most_odd_rooms : most_rooms));
    std::mt19937 random(7);
    for (const calibrate::PoolRoom& room : targets) {
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
