// Hidden Markov counters against sums over all paths, and against a room that is made of a known one.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "files/disk/file.hpp"
#include "logs/counter.hpp"
#include "pirsim/counting.hpp"
#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::counting;

namespace {

std::vector<double> random_rows(std::mt19937& random, std::size_t rows, std::size_t columns) {
  std::uniform_real_distribution<double> uniform(0.05, 1.0);
  std::vector<double> table(rows * columns);
  for (double& value : table) value = uniform(random);
  divide_rows(table, columns);
  return table;
}

Counter random_counter(std::mt19937& random, int n_rooms, int n_sensors = 2) {
  Counter counter;
  counter.settings.modes = 2;
  counter.n_sensors = n_sensors;
  counter.n_counts = 2;
  for (int r = 0; r < n_rooms; ++r)
    counter.rooms.push_back({r + 1, 1.0 / n_rooms, random_rows(random, 1, 4), random_rows(random, 4, 4),
                             random_rows(random, 4, static_cast<std::size_t>(n_sensors) + 1)});
  return counter;
}

Stretch random_stretch(std::mt19937& random, int readings, int sensors, int most_bit = 1) {
  Stretch stretch{sensors, {}};
  for (int i = 0; i < readings * sensors; ++i)
    stretch.motion.push_back(static_cast<std::uint8_t>(random() % static_cast<unsigned>(most_bit + 1)));
  return stretch;
}

/// Probability in a state of as many known sensors with motion as a reading has, by each way in which the unknown ones
/// could have been.
double seen(const Counter& counter, const RoomModel& room, const Stretch& stretch, std::size_t reading,
            std::size_t state) {
  const auto n = static_cast<std::size_t>(stretch.n_sensors);
  double sum = 0.0, like_it = 1.0;  // choices of known sensors that are as many
  int known = 0, told_active = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint8_t told = stretch.motion[reading * n + k];
    known += told == unknown_bit ? 0 : 1;
    told_active += told == 1 ? 1 : 0;
  }
  for (int i = 1; i <= told_active; ++i) like_it *= static_cast<double>(known - told_active + i) / i;
  for (std::uint32_t all = 0; all < (1U << n); ++all) {  // bits of all sensors; as likely as others with as many set
    int active = 0;
    bool fits = true;
    for (std::size_t k = 0; k < n; ++k) {
      const auto bit = static_cast<std::uint8_t>((all >> k) & 1U);
      active += bit;
      const std::uint8_t told = stretch.motion[reading * n + k];
      fits = fits && (told == unknown_bit || told == bit);
    }
    double ways = 1.0;
    for (int i = 1; i <= active; ++i) ways *= static_cast<double>(stretch.n_sensors - active + i) / i;
    if (fits)
      sum += room.emissions[state * static_cast<std::size_t>(counter.n_symbols()) + static_cast<std::size_t>(active)] /
             ways;
  }
  return like_it * sum;
}

/// (readings x counts), how often the count changes, and the likelihood, by summing over every path of states.
struct AllPaths {
  std::vector<double> counts;
  double changes = 0.0, likelihood = 0.0;
};
AllPaths over_all_paths(const Counter& counter, const RoomModel& room, const Stretch& stretch) {
  const std::size_t n = stretch.n_readings();
  constexpr std::size_t states = 4;
  AllPaths sums{std::vector<double>(n * 2, 0.0)};
  std::vector<std::size_t> path(n, 0);
  while (true) {
    double p = room.first[path[0]];
    for (std::size_t i = 0; i < n; ++i) {
      if (i > 0) p *= room.moves[path[i - 1] * states + path[i]];
      p *= seen(counter, room, stretch, i, path[i]);
    }
    sums.likelihood += p;
    for (std::size_t i = 0; i < n; ++i) sums.counts[i * 2 + path[i] / 2] += p;
    for (std::size_t i = 1; i < n; ++i) sums.changes += path[i] / 2 != path[i - 1] / 2 ? p : 0.0;
    std::size_t i = 0;
    while (i < n && ++path[i] == states) path[i++] = 0;
    if (i == n) break;
  }
  for (double& value : sums.counts) value /= sums.likelihood;
  sums.changes /= sums.likelihood;
  return sums;
}

/// A room whose sensor reports motion with these probabilities, by count: two people come and go at random.
LabelledRoom known_room(std::mt19937& random, int number, const std::vector<double>& motion, int days, int readings) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  LabelledRoom room{number, {}};
  for (int d = 0; d < days; ++d) {
    Stretch day{1, {}};
    int people = 0;
    for (int i = 0; i < readings; ++i) {
      if (uniform(random) < 0.02) people = static_cast<int>(random() % motion.size());
      day.people.push_back(people);
      day.motion.push_back(uniform(random) < motion[static_cast<std::size_t>(people)] ? 1 : 0);
    }
    room.days.push_back(std::move(day));
  }
  return room;
}

double error_of(const Counter& counter, const LabelledRoom& room, Pass pass) {
  double sum = 0.0, n = 0.0;
  for (const Stretch& day : room.days) {
    Stretch unlabelled = day;
    unlabelled.people.clear();
    const Estimates estimates = estimate(counter, unlabelled, pass);
    for (std::size_t i = 0; i < day.people.size(); ++i, ++n) sum += std::abs(estimates.count(i) - day.people[i]);
  }
  return sum / n;
}

}  // namespace

TEST_CASE("A counter's two passes give what a sum over every path of states gives, with unknown sensors too") {
  std::mt19937 random(1);
  for (int attempt = 0; attempt < 20; ++attempt) {
    const Counter counter = random_counter(random, 1);
    const Stretch stretch = random_stretch(random, 5, 2, attempt % 2 == 0 ? 1 : 2);
    const AllPaths all = over_all_paths(counter, counter.rooms[0], stretch);
    const Estimates smoothed = estimate(counter, stretch, Pass::smoothed);
    for (std::size_t i = 0; i < all.counts.size(); ++i)
      CHECK(smoothed.probabilities[i] == Approx(all.counts[i]).epsilon(1e-10));
    CHECK(log_likelihoods(counter, std::vector{stretch})[0] == Approx(std::log(all.likelihood)).epsilon(1e-10));
    // A forward estimate of the last reading has nothing after it that it doesn't know.
    const Estimates forward = estimate(counter, stretch, Pass::forward);
    CHECK(forward.probabilities.back() == Approx(all.counts.back()).epsilon(1e-10));
    for (std::size_t n = 1; n <= 5; ++n) {
      Stretch part = stretch;
      part.motion.resize(n * 2);
      if (!forward.is_told(n - 1)) continue;  // nothing has been known yet
      CHECK(forward.probabilities[2 * n - 1] == Approx(over_all_paths(counter, counter.rooms[0], part).counts.back()));
    }
  }
}

TEST_CASE("Courses of people are drawn as often as a sum over every path of states says, changes of the count too") {
  std::mt19937 random(11);
  Counter counter = random_counter(random, 2);
  counter.rooms[0].weight = 0.25, counter.rooms[1].weight = 0.75;
  for (RoomModel& room : counter.rooms) {  // counts that last: readings by themselves would change more often
    for (std::size_t i = 0; i < room.moves.size(); ++i) room.moves[i] *= i / 4 / 2 == i % 4 / 2 ? 9.0 : 1.0;
    divide_rows(room.moves, 4);
  }
  const Stretch stretch = random_stretch(random, 6, 2);
  const AllPaths a = over_all_paths(counter, counter.rooms[0], stretch);
  const AllPaths b = over_all_paths(counter, counter.rooms[1], stretch);
  constexpr int n = 4000;
  std::vector<double> somebody(6, 0.0);
  double changes = 0.0, changes_by_themselves = 0.0;
  for (const std::vector<int>& course : draw_people(counter, stretch, n)) {
    for (std::size_t i = 0; i < 6; ++i) somebody[i] += course[i];
    for (std::size_t i = 1; i < 6; ++i) changes += course[i] != course[i - 1] ? 1.0 : 0.0;
  }
  const auto mixed = [&](auto value_of) { return 0.25 * value_of(a) + 0.75 * value_of(b); };
  for (std::size_t i = 0; i < 6; ++i) {
    const double p = mixed([&](const AllPaths& all) { return all.counts[i * 2 + 1]; });
    CHECK(std::abs(somebody[i] / n - p) < 4.0 * std::sqrt(p * (1.0 - p) / n));
    const double before = i == 0 ? p : mixed([&](const AllPaths& all) { return all.counts[i * 2 - 1]; });
    changes_by_themselves += i == 0 ? 0.0 : p * (1.0 - before) + before * (1.0 - p);
  }
  const double expected = mixed([](const AllPaths& all) { return all.changes; });
  const double error = std::sqrt(5.0 / n);  // of at most five changes a course
  CHECK(std::abs(changes / n - expected) < 4.0 * error);
  CHECK(std::abs(changes_by_themselves - expected) > 8.0 * error);
}

TEST_CASE("Courses of people hold to counts that are known, and tell none where nothing is") {
  std::mt19937 random(12);
  const Counter counter = random_counter(random, 1);
  Stretch stretch = random_stretch(random, 60, 2);
  stretch.people.assign(60, unknown_count);
  stretch.people[3] = 0, stretch.people[4] = 1;
  std::fill(stretch.motion.begin() + 2 * 10, stretch.motion.begin() + 2 * 50, unknown_bit);  // longer than told
  for (const std::vector<int>& course : draw_people(counter, stretch, 20)) {
    CHECK(course[3] == 0);
    CHECK(course[4] == 1);
    CHECK(course[9] != unknown_count);
    CHECK(course[30] == unknown_count);
  }
}

TEST_CASE("Counting live gives what counting forward gives, and rooms mix by weight") {
  std::mt19937 random(2);
  Counter counter = random_counter(random, 3);
  counter.rooms[0].weight = 0.7;
  counter.rooms[1].weight = 0.3;
  counter.rooms[2].weight = 0.0;
  const Stretch stretch = random_stretch(random, 40, 2, 2);
  const Estimates forward = estimate(counter, stretch, Pass::forward);
  LiveCount live(counter);
  for (std::size_t i = 0; i < stretch.n_readings(); ++i) {
    const std::vector<double> now = live.next(std::span(stretch.motion).subspan(2 * i, 2));
    double mixed = 0.0;
    for (const int r : {0, 1}) {
      Counter alone = counter;
      alone.rooms = {counter.rooms[static_cast<std::size_t>(r)]};
      alone.rooms[0].weight = 1.0;
      mixed += counter.rooms[static_cast<std::size_t>(r)].weight *
               estimate(alone, stretch, Pass::forward).probabilities[2 * i];
    }
    CHECK(now[0] == Approx(mixed).epsilon(1e-12));
    CHECK(now[1] == Approx(forward.probabilities[2 * i + 1]).epsilon(1e-12));
  }
  CHECK_THROWS_AS(live.next(std::vector<std::uint8_t>{1}), Error);
}

TEST_CASE("A room's numbers are the same bits whatever rooms stand beside it") {
  std::mt19937 random(12);
  const Counter counter = random_counter(random, 7);  // more than go side by side, and not a multiple of them
  const Stretch stretch = random_stretch(random, 50, 2, 2);
  const std::vector<double> all = log_likelihoods(counter, std::vector{stretch});
  for (std::size_t r = 0; r < counter.rooms.size(); ++r) {
    Counter alone = counter;
    alone.rooms = {counter.rooms[r]};
    CHECK(log_likelihoods(alone, std::vector{stretch})[0] == all[r]);
  }
}

TEST_CASE("At a liveliness the odds of another sensor's motion are so many times the room's, while somebody is there") {
  std::mt19937 random(13);
  const Counter counter = random_counter(random, 2), all = at_livelinesses(counter);
  const std::vector<double>& odds = counter.settings.livelinesses;
  REQUIRE(all.rooms.size() == 2 * odds.size());
  double weights = 0.0;
  for (std::size_t i = 0; i < all.rooms.size(); ++i) {
    const RoomModel &version = all.rooms[i], &room = counter.rooms[i / odds.size()];
    weights += version.weight;
    CHECK(version.number == room.number);
    CHECK(version.liveliness == odds[i % odds.size()]);
    CHECK(version.first == room.first);
    for (std::size_t state = 0; state < 4; ++state) {
      const std::size_t at = 3 * state;
      CHECK(version.emissions[at] + version.emissions[at + 1] + version.emissions[at + 2] == Approx(1.0));
      for (std::size_t k = 0; k < 2; ++k) {
        const double times = state < 2 ? 1.0 : version.liveliness;  // of the two modes of nobody: as they are
        CHECK(version.emissions[at + k + 1] / version.emissions[at + k] ==
              Approx(times * room.emissions[at + k + 1] / room.emissions[at + k]));
      }
    }
  }
  CHECK(weights == Approx(1.0));
}

TEST_CASE("A log of livelier people than in any room is told by the weights, and is counted better") {
  std::mt19937 random(14);
  const std::vector<double> motion{0.01, 0.2, 0.4}, livelier{0.01, 0.5, 0.73};  // at four times the odds
  std::vector<LabelledRoom> rooms;
  for (int r = 0; r < 6; ++r) rooms.push_back(known_room(random, r + 1, motion, 2, 1000));
  Settings settings;
  settings.modes = 1;  // as these rooms are made
  const Counter plain = train(rooms, settings);
  const auto weighed = [](Counter counter, const LabelledRoom& real) {
    std::vector<Stretch> log = real.days;
    for (Stretch& day : log) day.people.clear();
    weigh(counter, log_likelihoods(counter, log));
    return counter;
  };
  const auto mean_liveliness = [](const Counter& counter) {
    double mean = 0.0;
    for (const RoomModel& room : counter.rooms) mean += room.weight * std::log2(room.liveliness);
    return mean;
  };
  const LabelledRoom real = known_room(random, 99, livelier, 2, 1000), twin = known_room(random, 98, motion, 2, 1000);
  const Counter of_real = weighed(at_livelinesses(plain), real), of_twin = weighed(at_livelinesses(plain), twin);
  CHECK(mean_liveliness(of_real) > 1.5);
  CHECK(std::abs(mean_liveliness(of_twin)) < 0.5);
  CHECK(error_of(of_real, real, Pass::smoothed) < error_of(weighed(plain, real), real, Pass::smoothed) - 0.05);
  CHECK(error_of(of_twin, twin, Pass::smoothed) < error_of(weighed(plain, twin), twin, Pass::smoothed) + 0.02);
}

TEST_CASE("Each room learns how fast people come and go there, drawn to all rooms by the settings") {
  std::mt19937 random(15);
  const auto room_with = [&](int number, int stays) {  // so many readings, empty and then with somebody, and so on
    LabelledRoom room{number, {{1, {}}}};
    for (int i = 0; i < 2000; ++i) {
      room.days[0].people.push_back(i / stays % 2);
      room.days[0].motion.push_back(room.days[0].people.back() == 1 && random() % 2 == 0 ? 1 : 0);
    }
    return room;
  };
  Settings settings;
  settings.modes = 1;
  const std::vector<LabelledRoom> rooms{room_with(1, 5), room_with(2, 50)};
  const auto comes = [&](double shrinkage, std::size_t room) {
    settings.shrinkage = shrinkage;
    return train(rooms, settings).rooms[room].moves[1];
  };
  CHECK(comes(1e-3, 0) == Approx(0.2).epsilon(0.02));
  CHECK(comes(1e-3, 1) == Approx(0.02).epsilon(0.05));
  CHECK(comes(1e9, 0) == Approx(0.11).epsilon(0.02));  // of both together
  CHECK(comes(1e9, 1) == Approx(comes(1e9, 0)));
  const double seen = 1000.0, own = (0.2 * seen + 60.0 * comes(1e9, 0)) / (seen + 60.0);
  CHECK(comes(60.0, 0) == Approx(own).epsilon(0.02));
}

TEST_CASE("The band of nine in ten is the shortest run of counts that has so much, the likeliest of several") {
  const Estimates estimates{4, {0.03, 0.45, 0.45, 0.07, 0.92, 0.0, 0.05, 0.03, 0.3, 0.25, 0.25, 0.2}};
  const auto is = [&](std::size_t reading, int least, int most) {
    const auto band = estimates.band(reading, 0.9);
    return band.least == least && band.most == most;
  };
  CHECK(is(0, 1, 2));
  CHECK(is(1, 0, 0));
  CHECK(is(2, 0, 3));
}

TEST_CASE("Nobody is counted where nothing has been known for five minutes, nor live") {
  std::mt19937 random(10);
  const Counter counter = random_counter(random, 2);
  constexpr std::size_t n = 90;
  Stretch stretch = random_stretch(random, n, 2);
  const auto is_unknown = [](std::size_t i) { return i < 15 || (i >= 30 && i < 61) || (i >= 70 && i < 79); };
  for (std::size_t i = 0; i < n; ++i) {
    if (is_unknown(i)) stretch.motion[2 * i] = stretch.motion[2 * i + 1] = unknown_bit;
  }
  const Estimates forward = estimate(counter, stretch, Pass::forward),
                  smoothed = estimate(counter, stretch, Pass::smoothed);
  LiveCount live(counter);
  for (std::size_t i = 0; i < n; ++i) {
    bool before = false, after = false;  // ten readings of 30 s are five minutes
    for (std::size_t k = 0; k < n; ++k) {
      before = before || (!is_unknown(k) && k <= i && i - k <= 10);
      after = after || (!is_unknown(k) && k >= i && k - i <= 10);
    }
    INFO(i);
    CHECK(forward.is_told(i) == before);
    CHECK(smoothed.is_told(i) == (before || after));
    CHECK((smoothed.count(i) == unknown_count) == !(before || after));
    const std::vector<double> now = live.next(std::span(stretch.motion).subspan(2 * i, 2));
    CHECK(std::isnan(now[0]) == !before);
    if (before) CHECK(now[0] == Approx(forward.probabilities[2 * i]).epsilon(1e-12));
  }
  CHECK(smoothed.count(45) == unknown_count);  // in the middle of the longest, for both to be tried
  CHECK_FALSE(forward.is_told(44));
}

TEST_CASE("A reading that is as good as impossible, again and again, leaves numbers and their sum 1") {
  Counter counter;
  counter.settings.modes = 1;
  counter.n_counts = 2;
  counter.rooms = {{1, 1.0, {0.5, 0.5}, {1, 0, 0, 1}, {1.0 - 1e-100, 1e-100, 0.1, 0.9}}};
  const Stretch busy{1, std::vector<std::uint8_t>(50, 1)};
  const auto believed = [&](std::vector<double> first, std::size_t reading) {
    counter.rooms[0].first = std::move(first);
    return estimate(counter, busy, Pass::smoothed).probabilities[2 * reading + 1];
  };
  CHECK(believed({0.5, 0.5}, 0) == 1.0);
  CHECK(believed({1.0, 0.0}, 0) == 0.0);  // nobody else was ever possible
  CHECK(believed({1.0, 0.0}, 49) == 0.0);
  // Moves that hardly ever happen, to what the motion then proves.
  counter.rooms[0].moves = {1.0, 0.0, 1e-12, 1.0 - 1e-12};
  CHECK(believed({1.0, 1e-300}, 0) == Approx(1.0));
}

TEST_CASE("Counts that a log knows are held to, and say more of a room than motion alone") {
  std::mt19937 random(3);
  const Counter counter = random_counter(random, 1);
  Stretch stretch = random_stretch(random, 4, 2);
  stretch.people = {unknown_count, 1, unknown_count, 0};
  const Estimates estimates = estimate(counter, stretch, Pass::smoothed);
  CHECK(estimates.probabilities[2 * 1 + 1] == Approx(1.0));
  CHECK(estimates.probabilities[2 * 3 + 0] == Approx(1.0));
  // P(motion, counts) is at most P(motion).
  Stretch unlabelled = stretch;
  unlabelled.people.clear();
  CHECK(log_likelihoods(counter, std::vector{stretch})[0] < log_likelihoods(counter, std::vector{unlabelled})[0]);
}

TEST_CASE("Training finds the motion of rooms that are made of a known model, on any number of threads") {
  std::mt19937 random(4);
  const std::vector<double> quiet{0.02, 0.2, 0.4}, lively{0.05, 0.5, 0.85};
  std::vector<LabelledRoom> rooms;
  constexpr int days = 6, readings = 1500;
  for (int r = 0; r < 4; ++r) rooms.push_back(known_room(random, r + 1, r % 2 == 0 ? quiet : lively, days, readings));
  Settings settings;
  settings.modes = 1;
  settings.shrinkage = 1.0;
  const Counter counter = train(rooms, settings, 1);
  REQUIRE(counter.n_counts == 3);
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t n = 0; n < 3; ++n) {
      const double p = (r % 2 == 0 ? quiet : lively)[n];
      // Some 3000 readings a count: the standard error is sqrt(p (1 - p) / 3000), five of them and the shrinkage.
      const double allowed = 5.0 * std::sqrt(p * (1.0 - p) / 2000.0) + 1.0 / 2000.0;
      CHECK(std::abs(counter.rooms[r].emissions[n * 2 + 1] - p) < allowed);
      // The twin that must fail: the other kind of room.
      const double other = (r % 2 == 0 ? lively : quiet)[n];
      if (n > 0) CHECK(std::abs(counter.rooms[r].emissions[n * 2 + 1] - other) > allowed);
    }
  }
  const Counter threads = train(rooms, settings, 3);
  for (std::size_t r = 0; r < 4; ++r) CHECK(threads.rooms[r].moves == counter.rooms[r].moves);
  for (std::size_t r = 0; r < 4; ++r) CHECK(threads.rooms[r].emissions == counter.rooms[r].emissions);
}

TEST_CASE("A log's counts may jump as no simulated room's did: the log stays possible, and counts go on") {
  std::mt19937 random(9);
  std::vector<LabelledRoom> rooms{{1, {}}};
  Stretch day{1, {}};
  for (int i = 0; i < 400; ++i) {  // 0, 1, 2, 1, 0, ... people: never 0 and 2 next to each other
    day.people.push_back(std::vector{0, 1, 2, 1}[static_cast<std::size_t>(i / 20 % 4)]);
    day.motion.push_back(random() % 3 < static_cast<unsigned>(day.people.back()) ? 1 : 0);
  }
  rooms[0].days.push_back(day);
  const Counter counter = train(rooms, {});
  Stretch log{1, {0, 1, 0, 1}, {0, 2, 0, 2}};
  CHECK(std::isfinite(log_likelihoods(counter, std::vector{log})[0]));
  CHECK(estimate(counter, log, Pass::smoothed).count(3) == 2);
}

TEST_CASE("Modes are found where a count has several: they explain the motion better than one") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  LabelledRoom room{1, {}};
  Stretch day{1, {}};
  bool busy = false;
  for (int i = 0; i < 6000; ++i) {  // one person, quiet or busy by turns of 50 readings on average; nobody at times
    if (uniform(random) < 0.02) busy = !busy;
    const bool there = i % 300 < 200;
    day.people.push_back(there ? 1 : 0);
    day.motion.push_back(there && uniform(random) < (busy ? 0.9 : 0.1) ? 1 : 0);
  }
  room.days.push_back(day);
  Settings two, one;
  two.modes = 2;
  one.modes = 1;
  const std::vector<LabelledRoom> rooms{room};
  const Counter of_two = train(rooms, two), of_one = train(rooms, one);
  const double gain = log_likelihoods(of_two, room.days)[0] - log_likelihoods(of_one, room.days)[0];
  CHECK(gain > 500.0);  // of 4000 readings: knowing the mode is worth some 0.3 a reading (0.69 - 0.33)
  // One person in the quieter and the busier mode.
  CHECK(of_two.rooms[0].emissions[2 * 2 + 1] == Approx(0.1).margin(0.06));
  CHECK(of_two.rooms[0].emissions[3 * 2 + 1] == Approx(0.9).margin(0.06));
  // They last as long as they do, not as training assumes at first: five standard errors of 80 changes in 4000
  // readings.
  for (const std::size_t mode : {2U, 3U}) {
    const std::vector<double>& moves = of_two.rooms[0].moves;
    const double stays = moves[mode * 4 + mode] / (moves[mode * 4 + 2] + moves[mode * 4 + 3]);
    CHECK(stays == Approx(0.98).margin(5.0 * std::sqrt(0.02 * 0.98 / 4000.0)));
  }
}

TEST_CASE("A log weighs the rooms that are like it, and counting there gets better") {
  std::mt19937 random(6);
  const std::vector<double> quiet{0.01, 0.15, 0.3}, lively{0.05, 0.5, 0.9};
  std::vector<LabelledRoom> rooms;
  for (int r = 0; r < 8; ++r) rooms.push_back(known_room(random, r + 1, r % 2 == 0 ? quiet : lively, 2, 1000));
  Counter counter = train(rooms, {});
  const LabelledRoom real = known_room(random, 99, lively, 2, 1000);
  std::vector<Stretch> log = real.days;
  for (Stretch& day : log) day.people.clear();
  const double alike = error_of(counter, real, Pass::forward);
  weigh(counter, log_likelihoods(counter, log));
  double lively_weight = 0.0, sum = 0.0;
  for (const RoomModel& room : counter.rooms) {
    sum += room.weight;
    if (room.number % 2 == 0) lively_weight += room.weight;
  }
  CHECK(sum == Approx(1.0));
  CHECK(lively_weight > 0.75);  // one in two by chance
  CHECK(error_of(counter, real, Pass::forward) < alike);
  CHECK(error_of(counter, real, Pass::smoothed) < error_of(counter, real, Pass::forward));
}

TEST_CASE("Rooms weigh as their likelihoods of a log to the power of the settings, a fifth as they come") {
  std::mt19937 random(11);
  for (const double power : {Settings{}.weight_power, 1.0, 0.5}) {
    Counter counter = random_counter(random, 4);
    counter.settings.weight_power = power;
    const std::vector<Stretch> log{random_stretch(random, 5, 2), random_stretch(random, 4, 2, 2)};
    std::vector<double> expected;  // power 1: what Bayes says of rooms that are as likely before
    for (const RoomModel& room : counter.rooms) {
      double likelihood = 1.0;
      for (const Stretch& stretch : log) likelihood *= over_all_paths(counter, room, stretch).likelihood;
      expected.push_back(std::pow(likelihood, power));
    }
    const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
    weigh(counter, log_likelihoods(counter, log));
    for (std::size_t r = 0; r < expected.size(); ++r)
      CHECK(counter.rooms[r].weight == Approx(expected[r] / sum).epsilon(1e-10));
  }
  CHECK(Settings{}.weight_power == 0.2);
  // Of logs so long that no likelihood can be told from 0, and of one that a room can't have made.
  Counter counter = random_counter(random, 3);
  weigh(counter, std::vector{-100000.0, -100010.0, -std::numeric_limits<double>::infinity()});
  CHECK(counter.rooms[0].weight == Approx(1.0 / (1.0 + std::exp(-2.0))).epsilon(1e-12));
  CHECK(counter.rooms[1].weight == Approx(1.0 / (1.0 + std::exp(2.0))).epsilon(1e-12));
  CHECK(counter.rooms[2].weight == 0.0);
}

TEST_CASE("A counter is written and read back as it is, and what isn't one is refused in a line") {
  std::mt19937 random(7);
  const TemporaryFolder folder;
  Counter counter = random_counter(random, 2);
  counter.expected_error = Interval{0.25, 0.75};
  write_counter(folder.path() / "counter.json", counter);
  const Counter read = read_counter(folder.path() / "counter.json");
  CHECK(read.rooms[1].moves == counter.rooms[1].moves);
  CHECK(read.n_sensors == counter.n_sensors);
  CHECK(read.n_counts == counter.n_counts);
  CHECK(read.settings.modes == counter.settings.modes);
  CHECK(read.rooms[1].emissions == counter.rooms[1].emissions);
  CHECK(read.rooms[1].first == counter.rooms[1].first);
  CHECK(read.expected_error == counter.expected_error);
  CHECK(read.sensors.empty());                // as of older files
  counter.rooms.push_back(counter.rooms[1]);  // at another liveliness
  counter.rooms[2].liveliness = 2.0;
  counter.rooms[1].weight = counter.rooms[2].weight = 0.25;
  write_counter(folder.path() / "versions.json", counter);
  const Counter versions = read_counter(folder.path() / "versions.json");
  REQUIRE(versions.rooms.size() == 3);
  CHECK(versions.rooms[2].liveliness == 2.0);
  CHECK(versions.rooms[2].weight == 0.25);
  CHECK(versions.rooms[2].moves == counter.rooms[1].moves);
  // A file of version 1 has its moves in common.
  const Counter old = parse_counter(
      R"({"pirsim_counter": 1, "step_s": 30, "modes": 1, "sensors": 1, "counts": 2, "moves": [0.9, 0.1, 0.2, 0.8],
          "rooms": [{"room": 1, "weight": 1, "first": [0.5, 0.5], "emissions": [0.9, 0.1, 0.4, 0.6]}]})",
      "old.json");
  CHECK(old.rooms[0].moves == std::vector{0.9, 0.1, 0.2, 0.8});
  CHECK(old.rooms[0].liveliness == 1.0);
  counter.sensors = {"hall", "desk"};
  counter.holds_s = {12.5, std::nullopt};
  write_counter(folder.path() / "named.json", counter);
  const Counter named = read_counter(folder.path() / "named.json");
  CHECK(named.sensors == counter.sensors);
  CHECK(named.holds_s == counter.holds_s);
  const auto refused = [&](Counter spoilt) {
    write_counter(folder.path() / "spoilt.json", spoilt);
    CHECK_THROWS_AS(read_counter(folder.path() / "spoilt.json"), Error);
  };
  Counter spoilt = counter;
  spoilt.settings.step_s = 1e300;
  refused(spoilt);
  spoilt = counter;
  spoilt.rooms[1].moves[0] += 0.1;
  refused(spoilt);
  spoilt = counter;
  spoilt.rooms[0].emissions.pop_back();
  refused(spoilt);
  spoilt = counter;
  spoilt.rooms[0].weight = 2.0;
  refused(spoilt);
  spoilt = counter;
  spoilt.rooms[0].emissions = {5e-324, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0};
  refused(spoilt);
  spoilt = counter;
  spoilt.sensors = {"hall", "hall"};
  refused(spoilt);
  spoilt.sensors = {"hall"};
  refused(spoilt);
  spoilt = counter;
  spoilt.holds_s = {-1.0, 2.0};
  refused(spoilt);
}

TEST_CASE("A value of a counter that can't be is refused by its place in the file, whichever it is") {
  std::mt19937 random(7);
  const TemporaryFolder folder;
  Counter counter = random_counter(random, 2);
  counter.expected_error = Interval{0.25, 0.75};
  counter.sensors = {"hall", "desk"};
  counter.holds_s = {12.5, 30.0};
  counter.figures_off.emplace();
  write_counter(folder.path() / "counter.json", counter);
  using Json = nlohmann::ordered_json;
  const Json written = Json::parse(io::read_text_file(folder.path() / "counter.json"));
  std::size_t n_texts = 0;
  const Json flat = written.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    std::string place = pointer.substr(1);  // "rooms/0/first/1" is rooms[0].first[1]
    for (std::size_t at = place.find('/'); at != std::string::npos; at = place.find('/', at)) {
      const std::size_t end = std::min(place.find('/', at + 1), place.size());
      const std::string part = place.substr(at + 1, end - at - 1);
      place.replace(at, end - at,
                    std::isdigit(static_cast<unsigned char>(part[0])) != 0 ? '[' + part + ']' : '.' + part);
    }
    n_texts += value.is_string() ? 1 : 0;
    for (const Json& wrong : {Json("x"), Json(nullptr), Json::array(), Json::object(), Json(-1e300), Json(true)}) {
      const bool may_be =
          (value.is_string() && wrong.is_string()) || (place.starts_with("holds_s") && wrong.is_null()) ||
          ((place.starts_with("expected_error") || place.starts_with("figures_off")) && wrong.is_number());
      if (may_be) continue;
      Json spoilt = written;
      spoilt[Json::json_pointer(pointer)] = wrong;
      CHECK_THROWS_WITH(parse_counter(spoilt.dump(), "c.json"), contains(place + ": "));
    }
  }
  CHECK(n_texts == 2);  // the sensors' names
}

TEST_CASE("How far off figures are is written and read back, and a counter without tells none") {
  std::mt19937 random(15);
  Counter counter = random_counter(random, 1);
  const TemporaryFolder folder;
  write_counter(folder.path() / "counter.json", counter);
  CHECK_FALSE(read_counter(folder.path() / "counter.json").figures_off);
  counter.figures_off.emplace();
  double value = 0.0;
  for (const auto& [name, off] : figure_names) {
    (*counter.figures_off).*off = {value + 1.0, value + 2.0};
    value += 2.0;
  }
  write_counter(folder.path() / "counter.json", counter);
  const std::optional<FiguresOff> read = read_counter(folder.path() / "counter.json").figures_off;
  REQUIRE(read);
  CHECK(read->occupied_h.mean == 1.0);
  CHECK(read->hour_most.most == 2.0 * std::size(figure_names));
}

TEST_CASE("Rooms that a counter can't learn from are refused") {
  std::mt19937 random(8);
  const LabelledRoom good = known_room(random, 1, {0.1, 0.5}, 1, 100);
  LabelledRoom other = good, empty = good, without = good;
  other.days[0].n_sensors = 2;
  other.days[0].people.resize(50);
  std::ranges::fill(empty.days[0].people, 0);
  without.days.clear();
  CHECK_THROWS_AS(train(std::vector<LabelledRoom>{}, {}), Error);
  CHECK_THROWS_AS(train(std::vector{good, other}, {}), Error);
  CHECK_THROWS_AS(train(std::vector{empty}, {}), Error);
  CHECK_THROWS_AS(train(std::vector{good, without}, {}), Error);
}
