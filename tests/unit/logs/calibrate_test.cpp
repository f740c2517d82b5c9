// Rooms weighed by a log: statistics by hand, the check's level, what moves, hours of days, the recipe that is made.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#include "logs/calibrate.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/log_files.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::calibrate;
using counting::Stretch;

namespace {

/// A room whose sensors report motion with so much probability per person; somebody comes and goes.
PoolRoom room_of(std::mt19937& random, int number, double lively, int days = 2, int readings = 400) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  PoolRoom room{{number, {}}, {{"liveliness", lively}}};
  for (int d = 0; d < days; ++d) {
    Stretch day{2, {}};
    int people = 0;
    for (int i = 0; i < readings; ++i) {
      if (uniform(random) < 0.03) people = static_cast<int>(random() % 3);
      day.people.push_back(people);
      for (int k = 0; k < 2; ++k) day.motion.push_back(uniform(random) < 1.0 - std::exp(-lively * people) ? 1 : 0);
    }
    room.labelled.days.push_back(std::move(day));
  }
  return room;
}

std::vector<PoolRoom> pool_of(std::mt19937& random, int n) {
  std::uniform_real_distribution<double> uniform(0.1, 0.5);
  std::vector<PoolRoom> pool;
  for (int r = 1; r <= n; ++r) pool.push_back(room_of(random, r, uniform(random)));
  return pool;
}

std::vector<Stretch> unlabelled(std::vector<Stretch> days) {
  for (Stretch& day : days) day.people.clear();
  return days;
}

double statistic(const std::vector<double>& values, const std::string& name) {
  const auto infos = statistics_of(2);
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (infos[i].name == name) return values[i];
  }
  throw std::runtime_error("no statistic " + name);
}

}  // namespace

TEST_CASE("Statistics of motion are what one counts by hand") {
  // 30-s readings: 40 quiet ones, then ten times (two with motion at both, two at the first alone, four without).
  Stretch day{2, std::vector<std::uint8_t>(80, 0)};
  for (int i = 0; i < 10; ++i)
    for (const int bit : {1, 1, 1, 1, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0})
      day.motion.push_back(static_cast<std::uint8_t>(bit));
  const auto days = motion_statistics(std::vector{day}, 30.0);
  REQUIRE(days.size() == 1);
  const auto* found = days.data();
  const double active = 76.0;  // from the first to the last with motion: the last four are quiet
  CHECK(statistic(*found, "readings with motion, busiest sensor") == Approx(40 / active));
  CHECK(statistic(*found, "readings with motion, quietest sensor") == Approx(20 / active));
  CHECK(statistic(*found, "readings with motion, any sensor") == Approx(40 / active));
  CHECK(statistic(*found, "mean run with motion") == Approx(std::log(4.0)));
  CHECK(statistic(*found, "mean run without") == Approx(std::log(4.0)));
  CHECK(statistic(*found, "from first to last motion") == Approx(active * 30 / 3600));
  CHECK(statistic(*found, "first motion after the hours begin") == Approx(40 * 30 / 3600.0));
  CHECK(statistic(*found, "pauses longer than 10 min") == 0.0);
  CHECK(statistic(*found, "motion in one reading alone, most of a sensor") == 0.0);
  Stretch fan = day;  // the second sensor reports three times in the quiet beginning: 3 of 23 are alone
  for (const std::size_t i : {5, 10, 20}) fan.motion[2 * i + 1] = 1;
  CHECK(statistic(motion_statistics(std::vector{fan}, 30.0).front(), "motion in one reading alone, most of a sensor") ==
        Approx(3 / 23.0));
  CHECK(statistic(*found, "5 min without motion") == 0.0);
  CHECK(told(statistics_of(2)[2], std::log(4.0), 30.0) == Approx(2.0));  // min
  // phi of (n = 76; a = 40, b = 20, both = 20)
  CHECK(statistic(*found, "likeness of first and last sensor") ==
        Approx((76.0 * 20 - 40.0 * 20) / std::sqrt(40.0 * 36 * 20 * 56)));
  // The second one misses two readings of forty at a time; what is unknown of it is passed over.
  CHECK(statistic(*found, "longest silence of a sensor while another reports") == Approx(2 / 40.0));
  for (std::size_t i = 81; i < day.motion.size(); i += 2) day.motion[i] = i < 200 ? counting::unknown_bit : 0;
  CHECK(statistic(motion_statistics(std::vector{day}, 30.0).front(),
                  "longest silence of a sensor while another reports") == Approx(8 / 40.0));
  Stretch quiet{2, std::vector<std::uint8_t>(200, 0)};
  CHECK(motion_statistics(std::vector{quiet}, 30.0).empty());
}

TEST_CASE("The check calls one in twenty of its own rooms unlike, and finds one that isn't one of them") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  constexpr int attempts = 400;
  constexpr std::size_t rooms = 59;  // and the one that is asked for: p comes in steps of 1/60
  int called = 0, found = 0;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    stats::Matrix<double> rows(rooms, 3);
    std::vector<double> one(3);
    const auto fill = [&](std::span<double> row) {
      row[0] = normal(random);
      row[1] = row[0] + 0.5 * normal(random);
      row[2] = std::exp(normal(random));
    };
    for (std::size_t r = 0; r < rooms; ++r) fill(rows.row(r));
    fill(one);
    if (unlike_share(rows, one) <= 0.05) ++called;
    one[1] = one[0] + 3.0;  // each entry alone is nothing unusual
    if (unlike_share(rows, one) <= 0.05) ++found;
  }
  // Exactly 3 of 60 on average: 20 of 400, with a standard error of 4.4.
  CHECK(std::abs(called - 20) < 4 * 4.4);
  CHECK(found > attempts / 2);  // the twin
}

TEST_CASE("Statistics that nearly follow from each other are unlike where they don't, and not by a trifle") {
  // Two of 60 rooms, alike but for .07 times their spread. Ridges of .02 to .2 of a variance give these answers; .005
  // and .5 don't (computed with NumPy): then a trifle counts, or nothing does.
  constexpr std::size_t rooms = 60;
  stats::Matrix<double> rows(rooms, 2);
  for (std::size_t r = 0; r < rooms; ++r) {
    const double both = -1.7 + 3.4 * static_cast<double>(r) / (rooms - 1), apart = r % 2 == 0 ? 0.07 : -0.07;
    rows.row(r)[0] = both + apart;
    rows.row(r)[1] = both - apart;
  }
  CHECK(unlike_share(rows, std::vector{0.6, -0.6}) == Approx(1.0 / (rooms + 1)));
  CHECK(unlike_share(rows, std::vector{0.2, -0.2}) > 0.1);
}

TEST_CASE("Weighted means, quantiles and ranks") {
  const std::vector<double> values{3, 1, 2, 5}, weights{1, 1, 2, 0};
  CHECK(weighted_mean(values, weights) == Approx(2.0));
  CHECK(weighted_sd(values, weights) == Approx(std::sqrt(0.5)));
  CHECK(weighted_interval(values, weights) == Interval{1, 3});
  CHECK(rank_correlation(std::vector<double>{1, 2, 3, 4}, std::vector<double>{1, 8, 27, 64}) == Approx(1.0));
  CHECK(rank_correlation(std::vector<double>{1, 2, 3, 4}, std::vector<double>{4, 3, 2, 1}) == Approx(-1.0));
  CHECK(rank_correlation(std::vector<double>{1, 1, 2, 2}, std::vector<double>{1, 2, 1, 2}) == Approx(0.0));
}

TEST_CASE(
    "Readings that a score counts reach from half an hour before the first person to half an hour after the last") {
  std::vector<int> people(300, 0);
  people[100] = 1;
  people[150] = 2;
  const std::vector<bool> counts = in_use(people, 30.0);
  CHECK_FALSE(counts[39]);
  CHECK(counts[40]);
  CHECK(counts[210]);
  CHECK_FALSE(counts[211]);
  CHECK(std::ranges::none_of(in_use(std::vector<int>(10, 0), 30.0), [](bool b) { return b; }));
}

TEST_CASE("A calibration finds the parameter that the log comes from, and its error holds for rooms of the recipe") {
  std::mt19937 random(2);
  const std::vector<PoolRoom> pool = pool_of(random, 40);
  const PoolRoom real = room_of(random, 99, 0.45);
  counting::Settings settings;
  settings.modes = 1;  // as these rooms are made
  settings.shrinkage = 10.0;
  settings.livelinesses = {1.0};  // else every room may be as lively as the log
  const Calibration made =
      Pool(pool, settings).calibrate(unlabelled(real.labelled.days), unlabelled(real.labelled.days));
  CHECK(made.verdict == Verdict::like_these);
  REQUIRE(made.parameters.size() == 1);
  CHECK(made.parameters[0].mean_after > made.parameters[0].mean_before + 0.05);
  CHECK(made.parameters[0].narrowed > 0.2);
  CHECK(made.effective_rooms < 40.0);
  REQUIRE(made.counter.expected_error);
  CHECK(made.counter.expected_error->low < made.mean_error);
  CHECK(made.mean_error < made.counter.expected_error->high);
  // A quiet log moves the other way: the twin.
  const PoolRoom other = room_of(random, 98, 0.12);
  const Calibration quiet =
      Pool(pool, settings).calibrate(unlabelled(other.labelled.days), unlabelled(other.labelled.days));
  CHECK(quiet.parameters[0].mean_after < quiet.parameters[0].mean_before - 0.05);
}

TEST_CASE("The error to expect of a room is that of smoothed counts by the others, weighed by its own log") {
  std::mt19937 random(5);
  const std::vector<PoolRoom> pool = pool_of(random, 12);
  std::vector<counting::LabelledRoom> rooms;
  for (const PoolRoom& room : pool) rooms.push_back(room.labelled);
  const counting::Counter counter = counting::at_livelinesses(counting::train(rooms, {}));
  const RoomErrors errors = errors_of_rooms(counter, rooms, 2);
  for (std::size_t own = 0; own < rooms.size(); ++own) {
    counting::Counter others = counter;
    std::erase_if(others.rooms, [&](const counting::RoomModel& room) { return room.number == rooms[own].number; });
    const std::vector<Stretch> log = unlabelled(rooms[own].days);
    const auto error = [&] {
      double sum = 0.0, n = 0.0;
      for (std::size_t d = 0; d < log.size(); ++d) {
        const counting::Estimates estimates = counting::estimate(others, log[d], counting::Pass::smoothed);
        const std::vector<int>& people = rooms[own].days[d].people;
        const std::vector<bool> counts = in_use(people, 30.0);
        for (std::size_t i = 0; i < people.size(); ++i) {
          if (!counts[i]) continue;
          sum += std::abs(estimates.count(i) - people[i]);
          n += 1.0;
        }
      }
      return sum / n;
    };
    for (counting::RoomModel& room : others.rooms)
      room.weight = room.liveliness == 1.0 ? 1.0 / static_cast<double>(rooms.size() - 1) : 0.0;
    CHECK(errors.alike[own].value() == Approx(error()).epsilon(1e-9));
    counting::weigh(others, counting::log_likelihoods(others, log));
    CHECK(errors.weighed[own].value() == Approx(error()).epsilon(1e-9));
  }
}

TEST_CASE(
    "The error to expect holds nine tenths of all rooms, and grows with what the counter itself expects of the log") {
  RoomErrors errors;
  std::vector<double> weights;
  for (int r = 1; r <= 20; ++r) {
    errors.weighed.emplace_back(0.05 * r);
    errors.alike.emplace_back(0.1 * r);
    errors.stated.emplace_back(r % 2 == 0 ? 0.3 : 0.5);
    weights.push_back(r == 4 ? 1.0 : 0.0);  // whatever they weigh
  }
  errors.figures[3] = {0.5, 0.5};
  const auto expected = [&](double stated) {
    Calibration made;
    expect_error(errors, weights, stated, made);
    return made;
  };
  for (const double stated : {0.1, 0.4}) {  // no more than on average
    const Calibration made = expected(stated);
    CHECK(made.counter.expected_error->low == Approx(0.05));
    CHECK(made.counter.expected_error->high == Approx(0.95));
    CHECK(made.mean_error == Approx(0.2));
    CHECK(made.error_alike == Approx(0.4));
  }
  const Calibration twice = expected(0.8);
  CHECK(twice.counter.expected_error->high == Approx(1.9));
  CHECK(twice.counter.figures_off->most.mean == Approx(1.0));
  CHECK(twice.mean_error == Approx(0.4));
  CHECK(twice.error_alike == Approx(0.8));
  errors.weighed[3].reset();  // nobody was in the one room that has any weight
  CHECK_FALSE(expected(0.4).counter.expected_error);
  CHECK_FALSE(expected(0.4).counter.figures_off);
}

TEST_CASE("More days than the rooms have weigh the rooms no further, and other settings than the rooms' are refused") {
  std::mt19937 random(8);
  const std::vector<PoolRoom> rooms = pool_of(random, 12);  // of two days
  const Pool pool(rooms);
  const std::vector<Stretch> two = unlabelled(room_of(random, 99, 0.3).labelled.days);
  std::vector<Stretch> six;
  for (int i = 0; i < 3; ++i) six.insert(six.end(), two.begin(), two.end());
  const Calibration of_two = pool.calibrate(two, two), of_six = pool.calibrate(six, two);
  const Calibration of_one = pool.calibrate(std::span(two).first(1), two);
  CHECK(of_one.effective_rooms > of_two.effective_rooms);  // two days do say more than one
  for (std::size_t r = 0; r < rooms.size(); ++r)
    CHECK(of_six.rooms[r].weight == Approx(of_two.rooms[r].weight).epsilon(1e-9));
  for (const std::vector<double>& odds : {std::vector<double>{}, {0.5, 2.0}, {1.0, 1.0}}) {
    counting::Settings settings;
    settings.livelinesses = odds;
    CHECK_THROWS_AS(Pool(rooms, settings), Error);
  }
}

TEST_CASE("A log of one day is compared with one day of each room, not with the mean of more") {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(0.1, 0.5);
  std::vector<PoolRoom> pool;
  for (int r = 1; r <= 15; ++r) pool.push_back(room_of(random, r, uniform(random), 4));
  const std::vector<Stretch> log = unlabelled(room_of(random, 99, 0.3, 4).labelled.days);
  const std::size_t n_statistics = statistics_of(2).size();
  for (const std::size_t n_days : {std::size_t{1}, std::size_t{2}}) {
    const auto mean = [&](const std::vector<Stretch>& days) {
      const auto each = motion_statistics(std::span(days).first(n_days), 30.0);
      REQUIRE(each.size() == n_days);
      std::vector<double> sum(n_statistics, 0.0);
      for (const auto& day : each) {
        for (std::size_t s = 0; s < n_statistics; ++s) sum[s] += day[s] / static_cast<double>(n_days);
      }
      return sum;
    };
    const auto of_motion = [&](const std::vector<double>& all) {
      std::vector<double> some;
      for (std::size_t s = 0; s < n_statistics; ++s) {
        if (statistics_of(2)[s].about == Statistic::About::motion) some.push_back(all[s]);
      }
      return some;
    };
    stats::Matrix<double> rows(pool.size(), n_statistics - 2);  // hours aren't among them
    for (std::size_t r = 0; r < pool.size(); ++r)
      std::ranges::copy(of_motion(mean(pool[r].labelled.days)), rows.row(r).begin());
    const auto part = std::span(log).first(n_days);
    CHECK(Pool(pool).calibrate(part, part).p == Approx(unlike_share(rows, of_motion(mean(log)))).epsilon(1e-12));
  }
}

TEST_CASE("A calibration doesn't depend on threads, nor on counts that the log hasn't got") {
  std::mt19937 random(3);
  const std::vector<PoolRoom> pool = pool_of(random, 12);
  const std::vector<Stretch> log = unlabelled(room_of(random, 99, 0.3).labelled.days);
  std::vector<Stretch> unknown = log;
  for (Stretch& day : unknown) day.people.assign(day.n_readings(), counting::unknown_count);
  const Calibration one = Pool(pool, {}, 1).calibrate(log, log), more = Pool(pool, {}, 3).calibrate(log, log),
                    told = Pool(pool).calibrate(unknown, unknown);
  for (std::size_t r = 0; r < pool.size(); ++r) {
    CHECK(one.rooms[r].weight == more.rooms[r].weight);
    CHECK(one.rooms[r].error == more.rooms[r].error);
    CHECK(one.rooms[r].weight == told.rooms[r].weight);
  }
}

TEST_CASE("A log that no room makes is told, with what is outside, and a log without motion tells too little") {
  std::mt19937 random(4);
  const std::vector<PoolRoom> pool = pool_of(random, 40);
  std::vector<Stretch> log = unlabelled(room_of(random, 99, 0.3).labelled.days);
  for (Stretch& day : log) {
    for (std::size_t i = 1; i < day.motion.size(); i += 2) day.motion[i] = 0;  // the second sensor died
  }
  const Calibration died = Pool(pool).calibrate(log, log);
  CHECK(died.verdict == Verdict::none_like_it);
  CHECK_THAT(finding(died), contains("quietest sensor") && contains("a sensor that died"));
  for (const Statistic& one : died.statistics) CHECK((one.sign.empty() || one.p <= verdict_level || one.share > 0.0));
  for (Stretch& day : log) std::ranges::fill(day.motion, std::uint8_t{0});
  CHECK(Pool(pool).calibrate(log, log).verdict == Verdict::too_little_told);
  CHECK_THROWS_AS(Pool({pool.begin(), pool.begin() + 9}), Error);
}

TEST_CASE("A day that begins hours late is told apart and makes no verdict") {
  std::mt19937 random(4);
  const std::vector<PoolRoom> pool = pool_of(random, 40);
  const std::vector<Stretch> log = unlabelled(room_of(random, 99, 0.3).labelled.days);
  std::vector<Stretch> late = log;
  for (Stretch& day : late) day.motion.insert(day.motion.begin(), std::size_t{300} * 2, 0);
  const Calibration before = Pool(pool).calibrate(log, log), after = Pool(pool).calibrate(log, late);
  CHECK(before.verdict == Verdict::like_these);
  CHECK(after.verdict == Verdict::like_these);
  CHECK_THAT(finding(before), !contains("hours differ"));
  CHECK_THAT(finding(after), contains("hours differ") && contains("`arrival` be later"));
}

TEST_CASE("Of a log that is unlike only by its numbers together, the two that weigh most are named") {
  std::mt19937 random(4);
  const std::vector<PoolRoom> pool = pool_of(random, 40);
  std::vector<Stretch> log = unlabelled(room_of(random, 99, 0.3).labelled.days);
  for (Stretch& day : log) {  // the second sensor sees what the first saw a reading before
    for (std::size_t i = day.motion.size(); i-- > 3;) {
      if (i % 2 == 1) day.motion[i] = day.motion[i - 3];
    }
  }
  const Calibration made = Pool(pool).calibrate(log, log);
  CHECK(made.verdict == Verdict::none_like_it);
  std::vector<double> named, others;
  for (const Statistic& one : made.statistics) {
    CHECK(one.p > verdict_level);
    (one.sign.empty() ? others : named).push_back(one.share);
  }
  REQUIRE(named.size() == 2);
  CHECK(std::ranges::min(named) >= std::ranges::max(others));
  CHECK_THAT(finding(made), contains("Most unlike: ") && contains(", rooms "));
}

TEST_CASE("Of a log the hours that the recipe simulates are compared, each day of its own") {
  LogRows rows;
  rows.sensors = {"a"};
  rows.window_s = 3600.0;
  rows.clock = LogClock::zoned;
  for (int hour = 0; hour < 48; ++hour) {  // from 22:00 UTC on, two hours ahead: local midnight
    rows.begin.push_back({(std::int64_t{22} + hour) * 3'600'000'000, 7200});
    rows.motion.push_back(static_cast<std::uint8_t>(hour % 24 >= 7 && hour % 24 < 9 ? 1 : 0));
  }
  const LogDays days = days_of(rows, {7.0, 10.0});
  CHECK(days.each.size() == 2);  // which weigh the rooms, and nothing else does
  const std::vector<Stretch>& parts = days.whole;
  REQUIRE(parts.size() == 2);
  CHECK(parts[0].motion == std::vector<std::uint8_t>{1, 1, 0});
  CHECK(parts[1].motion == std::vector<std::uint8_t>{1, 1, 0});
  CHECK(whole_log(rows).n_readings() == 48);
  // Of a day that has only some of the hours nothing is compared.
  const LogDays nights = days_of(rows, {-4.0, 10.0});
  CHECK(nights.whole.empty());
  CHECK(nights.each.size() == 2);  // but they weigh
  CHECK(nights.partial == std::vector<std::string>{"1970-01-02", "1970-01-03"});
  CHECK(days.partial.empty());
  const LogDays at_home = days_of(rows, {4.0, 28.0});  // the small hours are the day before's
  CHECK(at_home.partial == std::vector<std::string>{"1970-01-01", "1970-01-03"});
  REQUIRE(at_home.whole.size() == 1);
  CHECK(at_home.whole[0].motion ==
        std::vector<std::uint8_t>{0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  CHECK_THAT(days_compared({"", "", "", {7.0, 10.0}, 0, {"2026-03-02"}}), contains("no verdict"));
  CHECK(days_compared({"", "", "", {7.0, 10.0}, 2, {}}) == "2 days, from 7:00 to 10:00");
  CHECK(days_compared({"", "", "", {7.0, 10.0}, 1, {"2026-03-02"}}) ==
        "1 of 2 days, from 7:00 to 10:00: on 2026-03-02 a sensor is known for less than nine tenths of these hours");
}

TEST_CASE("A day of which a sensor is known for less than nine tenths isn't compared") {
  LogRows rows;
  rows.sensors = {"a", "b"};
  rows.window_s = 360.0;  // ten an hour
  for (int i = 0; i < 3 * 240; ++i) {
    rows.begin.push_back({i * std::int64_t{360'000'000}, 0});
    const int day = i / 240, reading = i % 240 - 80;                 // after 8:00
    rows.motion.push_back(reading < 0 ? counting::unknown_bit : 0);  // other hours don't count
    rows.motion.push_back(reading >= 0 && reading < (day == 1 ? 3 : 2) ? counting::unknown_bit : 0);
  }
  const LogDays days = days_of(rows, {8.0, 10.0});  // twenty readings, of which two or three are unknown
  CHECK(days.whole.size() == 2);
  CHECK(days.partial == std::vector<std::string>{"1970-01-02"});
  rows.clock = LogClock::elapsed;  // then all of it counts, and a third is unknown
  CHECK(days_of(rows, {8.0, 10.0}).whole.empty());
}

TEST_CASE("A counter refuses a log that it isn't for, and tells of sensors that hold motion for another time") {
  std::mt19937 random(8);
  const PoolRoom room = room_of(random, 1, 0.3);
  counting::Counter counter = counting::train(std::vector{room.labelled}, {});
  LogRows rows;
  rows.sensors = {"desk", "hall"};
  rows.window_s = 30.0;
  const Stretch& day = room.labelled.days[0];
  rows.motion = day.motion;
  for (std::size_t i = 0; i < day.n_readings(); ++i)
    rows.begin.push_back({static_cast<std::int64_t>(i) * 30'000'000, 0});
  LogTraits log{0.0, rows.sensors, {10.0, std::nullopt}};
  const auto counts = [&] { return count_log(counter, rows, log, counting::Pass::forward); };
  REQUIRE(counts().remarks.size() == 1);  // a counter of an older file takes any two
  CHECK_THAT(counts().remarks[0], contains("it doesn't tell which sensors it is for"));
  remember({0.0, {"hall", "desk"}, {10.0, 9.5}}, counter);
  CHECK(counts().remarks.empty());
  log.interval_s = 30.0;
  CHECK(counts().remarks.empty());
  log.interval_s = 300.0;
  CHECK_THROWS_WITH(counts(), contains("a reading every 300 s") && contains("--step 300"));
  log.interval_s = 0.0;
  log.holds_s[0] = 90.0;
  REQUIRE(counts().remarks.size() == 1);
  CHECK_THAT(counts().remarks[0], contains("'desk' holds motion for 90.0 s in this log, and for 9.5 s"));
  counter.sensors = {"hall", "door"};
  CHECK_THROWS_WITH(counts(), contains("2 sensors (hall, door), and the log has 2: desk, hall") && contains("--map"));
  log.sensors.clear();  // arrays have no names
  log.holds_s.clear();
  CHECK_NOTHROW(counts());
  counter.n_sensors = 3;
  CHECK_THROWS_AS(counts(), Error);
}

TEST_CASE("A log is counted without a look at the people that it tells: whatever it says, counts stay") {
  std::mt19937 random(9);
  const PoolRoom room = room_of(random, 1, 0.3);
  const counting::Counter counter = counting::train(std::vector{room.labelled}, {});
  const Stretch& day = room.labelled.days[0];
  LogRows rows{{"a", "b"}, 30.0, LogClock::local, {}, day.motion, {}};
  for (std::size_t i = 0; i < day.n_readings(); ++i)
    rows.begin.push_back({static_cast<std::int64_t>(i) * 30'000'000, 0});
  const LogTraits log{0.0, rows.sensors, {}};
  for (const counting::Pass pass : {counting::Pass::forward, counting::Pass::smoothed}) {
    const LogCounts untold = count_log(counter, rows, log, pass);
    CHECK_FALSE(error_of(untold));
    for (const int told : {0, 1}) {
      LogRows labelled = rows;
      labelled.people.assign(day.n_readings(), told);
      const LogCounts counts = count_log(counter, labelled, log, pass);
      CHECK(counts.estimates.probabilities == untold.estimates.probabilities);
      REQUIRE(error_of(counts));
      CHECK(error_of(counts)->mean > 0.0);
    }
  }
}

TEST_CASE("A reading of a dataset's rows has motion if any row has, and the people of its last one") {
  std::mt19937 random(10);
  dataset::RoomDayRows rows{1, 1, 10.0, {"a", "b"}, {}, {}};
  constexpr std::size_t n = 20, per = 3;
  for (std::size_t i = 0; i < n * per + 2; ++i) {  // two rows more than whole readings
    rows.people.push_back(static_cast<int>(random() % 5));
    for (int k = 0; k < 2; ++k) rows.motion.push_back(random() % 4 == 0 ? 1 : 0);
  }
  const Stretch stretch = readings_of(rows, 30.0);
  REQUIRE(stretch.n_readings() == n);
  REQUIRE(stretch.people.size() == n);
  for (std::size_t i = 0; i < n; ++i) {
    CHECK(stretch.people[i] == rows.people[per * i + 2]);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto bit = [&](std::size_t row) { return rows.motion[2 * (per * i + row) + k] == 1; };
      CHECK((stretch.motion[2 * i + k] == 1) == (bit(0) || bit(1) || bit(2)));
    }
  }
}

TEST_CASE("Where nobody knows, cells of counts are empty and no hour counts") {
  LogCounts counts;
  counts.rows.sensors = {"a"};
  counts.rows.window_s = 1800.0;
  counts.rows.clock = LogClock::elapsed;
  counts.rows.people = {1, 1, 1};
  counts.rows.motion = {1, counting::unknown_bit, 0};
  for (int i = 0; i < 3; ++i) counts.rows.begin.push_back({i * std::int64_t{1'800'000'000}, 0});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  counts.estimates = {2, {0.1, 0.9, nan, nan, 1.0, 0.0}};
  std::ostringstream text;
  write_counts(text, counts);
  CHECK(text.str() ==
        "time_s,people,mean,least,most,p0,p1\n1800,1,0.90,1,1,0.100,0.900\n3600,,,,,,\n5400,0,0.00,0,0,1.000,0.000\n");
  CHECK(how_sure(counts) ==
        "Somebody is there for 0.5 h; the number is told with 80 % or more for 0.5 h of them. For 0.5 h nothing is "
        "known, and no number is told.");
  REQUIRE(error_of(counts));
  CHECK(error_of(counts)->readings == 2);
  CHECK(error_of(counts)->mean == Approx(0.5));
  const TemporaryFolder folder;
  write_counts_page(folder.path() / "page.html", counts, "log", "made by a test");
  std::stringstream page;
  page << std::ifstream(folder.path() / "page.html").rdbuf();
  CHECK_THAT(page.str(), contains("\"n\":null") && contains("unknown, h"));
}

TEST_CASE("Days and hours of a counted log are what one sums up by hand, with how far off they may be") {
  LogCounts counts;
  counts.rows.sensors = {"a"};
  counts.rows.window_s = 1800.0;
  counts.rows.clock = LogClock::local;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::int64_t first = 1'772'496'000LL * 1'000'000 - 1'800'000'000;  // 2026-03-02, 23:30
  counts.estimates.n_counts = 3;
  const auto add = [&](int half_hours, std::vector<double> odds) {
    counts.rows.begin.push_back({first + half_hours * std::int64_t{1'800'000'000}, 0});
    counts.rows.motion.push_back(0), counts.rows.people.push_back(-1);
    counts.estimates.probabilities.insert(counts.estimates.probabilities.end(), odds.begin(), odds.end());
  };
  add(0, {0.2, 0.8, 0.0});                           // the first date
  add(1, {1.0, 0.0, 0.0}), add(2, {0.0, 0.5, 0.5});  // 0:00 of the second
  add(3, {0.4, 0.1, 0.5}), add(4, {nan, nan, nan});  // 1:00
  add(5, {1.0, 0.0, 0.0}), add(6, {1.0, 0.0, 0.0});
  for (int i = 7; i < 48; ++i) add(i, {0.9, 0.1, 0.0});
  add(48, {0.1, 0.0, 0.9});
  counts.figures_off.emplace();
  counts.figures_off->arrival_min = {3.0, 14.0};
  const std::vector<CountedDay> days = counted_days(counts);
  REQUIRE(days.size() == 2);
  CHECK(days[0].date == "2026-03-02");
  CHECK(days[0].arrival == "23:30:00");
  CHECK(days[0].departure == "24:00:00");  // the end of its day
  CHECK(days[0].figures.occupied_h == Approx(0.4));
  CHECK(days[1].figures.told_h == Approx(23.5));
  CHECK(days[1].figures.occupied_h == Approx(0.5 * (1.0 + 0.6 + 41 * 0.1 + 0.9)));
  CHECK(days[1].arrival == "00:30:00");
  CHECK(days[1].departure == "24:00:00");
  CHECK(days[1].figures.most == 2);
  CHECK_THAT(to_csv(days), contains(",23:30:00,14,24:00:00,0,1,0\n"));
  const std::vector<CountedHour> hours = counted_hours(counts);
  REQUIRE(hours.size() == 24);
  CHECK(hours[0].mean == Approx(0.75));
  CHECK(hours[0].nobody == Approx(0.5));
  CHECK(hours[1].mean == Approx(1.1));  // of what is told
  CHECK(hours[1].off);
  CHECK_FALSE(hours[2].off);  // nobody comes: errors of hours with people say nothing of it
  CHECK(hours[23].days == 2);
  CHECK(hours[23].nobody == Approx(0.5 * (0.2 + 0.5)));
  CHECK(hours[23].most == Approx(0.5 * (1.0 + 2.0)));
  counts.figures_off.reset();
  CHECK_THAT(to_csv(counted_days(counts)), contains(",23:30:00,,24:00:00,,1,\n"));
}

TEST_CASE("A reading of half a minute at the edge of a counted log is no day of its own") {
  const auto dates_of = [](double window_s, int first_reading, int n) {
    LogCounts counts;
    counts.rows.sensors = {"a"};
    counts.rows.window_s = window_s;
    counts.rows.clock = LogClock::local;
    counts.estimates.n_counts = 2;
    for (int i = first_reading; i < first_reading + n; ++i) {
      const std::int64_t midnight = 1'772'496'000LL * 1'000'000;  // 2026-03-03
      counts.rows.begin.push_back({midnight + i * std::llround(window_s * 1e6), 0});
      counts.rows.motion.push_back(0), counts.rows.people.push_back(-1);
      counts.estimates.probabilities.insert(counts.estimates.probabilities.end(), {0.0, 1.0});
    }
    std::vector<std::string> dates;
    for (const CountedDay& day : counted_days(counts)) dates.push_back(day.date);
    return dates;
  };
  using Dates = std::vector<std::string>;
  CHECK(dates_of(30.0, -1, 2881) == Dates{"2026-03-03"});
  CHECK(dates_of(30.0, -1, 2882) == Dates{"2026-03-03"});                // and one behind the next midnight
  CHECK(dates_of(30.0, -2, 2882) == Dates{"2026-03-02", "2026-03-03"});  // a minute is told
  CHECK(dates_of(1800.0, -1, 49) == Dates{"2026-03-02", "2026-03-03"});  // half an hour is a reading's worth
  CHECK(dates_of(30.0, -1, 1) == Dates{"2026-03-02"});                   // all that there is
}

TEST_CASE("Errors of figures are those between what is told and what is so, larger where more is expected") {
  const Stretch day{1, {0, 1, 1, 0, 0, 1}, {0, 1, 2, 0, 0, 0}};
  counting::Estimates told{3, {1, 0, 0, /**/ 0.6, 0.4, 0, /**/ 0, 1, 0, /**/ 0, 1, 0, /**/ 1, 0, 0, /**/ 1, 0, 0}};
  const FigureErrors errors = figure_errors(std::span(&told, 1), std::span(&day, 1), 1800.0);
  const auto of = [&](const std::string& name) {
    const auto* at =
        std::ranges::find(counting::figure_names, name, [](const auto& one) { return std::string(one.name); });
    return errors[static_cast<std::size_t>(at - std::begin(counting::figure_names))];
  };
  CHECK(of("occupied_h")[0] == Approx(0.5 * std::abs(2.4 - 2.0)));
  CHECK(of("arrival_min")[0] == Approx(30.0));
  CHECK(of("departure_min")[0] == Approx(30.0));
  CHECK(of("most")[0] == Approx(1.0));
  REQUIRE(of("hour_mean").size() == 3);
  CHECK(of("hour_mean")[0] == Approx(0.5 * std::abs(0.4 - 1.0)));
  CHECK(of("hour_nobody")[1] == Approx(0.5));
  CHECK(of("hour_most")[1] == Approx(1.0));
  FigureErrors many;
  for (int i = 0; i <= 100; ++i) many[0].push_back(i);
  const counting::FiguresOff off = figures_off(many, 2.0, 30.0);
  CHECK(off.occupied_h.mean == Approx(100.0));
  CHECK(off.occupied_h.most == Approx(180.0));
  CHECK(off.arrival_min.most == 0.5);  // a reading
}

TEST_CASE("Counts say how far off they are, and for how long they are sure") {
  LogCounts counts;
  counts.rows.sensors = {"a"};
  counts.rows.window_s = 1800.0;
  counts.rows.people = {0, 2, log_state::unknown_count, 1};
  for (int i = 0; i < 4; ++i) counts.rows.begin.push_back({i * std::int64_t{1'800'000'000}, 0});
  counts.estimates = {3,
                      {0.9, 0.1, 0.0,  //
                       0.1, 0.8, 0.1,  //
                       0.0, 0.5, 0.5,  //
                       0.1, 0.3, 0.6}};
  const auto error = error_of(counts);  // of 0, 1, (1), 2
  REQUIRE(error);
  CHECK(error->mean == Approx(2.0 / 3.0));
  CHECK(error->while_occupied == Approx(1.0));
  CHECK(in_words(*error) == "wrong by 0.67 people on average, over 3 readings; by 1.00 over the 2 with somebody");
  CHECK(how_sure(counts) == "Somebody is there for 1.5 h; the number is told with 80 % or more for 0.5 h of them.");
  CHECK(counts.estimates.quantile(1, 0.05) == 0);
  CHECK(counts.estimates.quantile(1, 0.95) == 2);
  counts.estimates = {2, {1, 0, 1, 0, 1, 0, 1, 0}};
  CHECK(how_sure(counts).empty());
}

namespace {

/// Two sensors, each of which holds motion for a while and often sees more: every other pulse is longer.
LogFacts facts_of_holds(double a_s, double b_s, double b_varies_s = 0.0) {
  std::string text = "time,sensor,state\n";
  const auto add = [&](int i, const std::string& sensor, double length_s) {
    const double begin = 1000.0 * i, end = begin + length_s * (i % 2 == 0 ? 1.0 : 1.7);
    text += std::to_string(begin) + ',' + sensor + ",on\n" + std::to_string(end) + ',' + sensor + ",off\n";
  };
  for (int i = 0; i < 40; ++i) {
    add(i, "A", a_s);
    add(i, "B", b_s + b_varies_s * i);
  }
  return facts_of(read_log_text(text));
}

}  // namespace

TEST_CASE("Rooms have the hold that all of a log's sensors have, never a mean of two") {
  const LogFacts mixed = facts_of_holds(10.0, 90.0);
  CHECK(mixed.sensors[0].hold_s == 10.0);
  CHECK(mixed.sensors[1].hold_s == 90.0);
  try {
    static_cast<void>(common_hold(mixed));
    FAIL("a hold for both");
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::input);
    CHECK_THAT(error.what(), contains("A holds motion for 10 s; B holds motion for 90 s"));
  }
  CHECK(common_hold(facts_of_holds(10.0, 10.8)) == 10.0);
  const LogFacts untold = facts_of_holds(90.0, 12.0, 3.0);  // of B's pulses none are alike
  CHECK_FALSE(untold.sensors[1].hold_s);
  CHECK_THROWS_AS(common_hold(untold), Error);
  CHECK(common_hold(facts_of_holds(10.0, 12.0, 3.0)) == 10.0);
  CHECK_FALSE(common_hold(facts_of(read_log_text("time,A,B\n1,0,1\n2,1,0\n3,0,0\n"))));
}

TEST_CASE("A pool's rows are readings, and hold motion as long as the log's sensors do") {
  const TemporaryFolder folder;
  const auto file =
      folder.write("recipe.yaml",
                   "pirsim_recipe: 1\nrooms: [{count: 2}]\neffects:\n  - range_scale: {scale: [0.8, 1.2]}\n"
                   "  - {pulse_stretching: {hold_s: [0.5, 3]}, chance: 0.5}\n");
  const dataset::RecipeSpec recipe = dataset::read_recipe(file);
  const dataset::RecipeSpec pool = dataset::with_overrides(recipe, pool_overrides(recipe, 30.0, 12.5));
  CHECK(pool.sensing.ticks_per_window == 30 * pool.sensing.tick_rate_hz);
  REQUIRE(pool.effects.size() == 2);
  CHECK(pool.effects[1].parameters.at("hold_s").least == 12.5);
  CHECK(pool.effects[1].chance == 1.0);
  const auto plain = folder.write("plain.yaml", "pirsim_recipe: 1\nrooms: [{count: 2}]\neffects: [range_scale]\n");
  const dataset::RecipeSpec added = dataset::read_recipe(plain, pool_overrides(dataset::read_recipe(plain), 30.0, 2.0));
  REQUIRE(added.effects.size() == 2);
  CHECK(added.effects[1].name == "pulse_stretching");

  // The recipe that draws by weight reads back, with the hold and without what only the pool needs.
  Calibration calibration;
  calibration.rooms = {{1, 0.0, 0.25, {}}, {2, 0.0, 0.75, {}}};
  const auto weighted = folder.write("weighted.yaml", weighted_recipe(pool, calibration, folder.path()));
  const dataset::RecipeSpec read = dataset::read_recipe(weighted);
  REQUIRE(read.draw_by);
  CHECK(read.draw_by->weights == std::vector<double>{0.25, 0.75});
  CHECK(read.effects[1].parameters.at("hold_s").least == 12.5);
  CHECK(read.sensing.ticks_per_window == read.sensing.tick_rate_hz);
}
