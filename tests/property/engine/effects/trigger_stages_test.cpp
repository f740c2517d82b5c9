// Trigger stages against closed forms, on triggers made by hand.
#include <algorithm>
#include <cmath>

#include "engine/pir/analog_circuit.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"
#include "support/trigger_bench.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

constexpr int rate_hz = 50;

/// Both sensors' triggers after the pipeline, as they are logged; sensor A is given `before`, and nothing more after
/// its end, sensor B nothing.
std::array<Series, 2> through(effects::Pipeline pipeline, const Series& before) {
  std::array<Series, 2> after;
  std::int64_t heard = 0;
  std::array<std::uint8_t, 2> triggers{};
  for (std::int64_t tick = 1; tick <= std::ssize(before); ++tick) {
    while (heard < pipeline.heard_by(tick)) {
      triggers = {heard < std::ssize(before) ? before[static_cast<std::size_t>(heard)] : std::uint8_t{0}, 0};
      pipeline.hear(++heard, triggers);
    }
    pipeline.log(tick, triggers);
    for (std::size_t s : {0U, 1U}) after[s].push_back(triggers[s]);
  }
  return after;
}

Series with_ones(std::size_t n, const std::vector<std::size_t>& ticks) {
  Series series(n, 0);
  for (const std::size_t tick : ticks) series[tick - 1] = 1;
  return series;
}
std::vector<std::size_t> ones(const Series& series) {
  std::vector<std::size_t> ticks;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (series[i] != 0) ticks.push_back(i + 1);
  }
  return ticks;
}
double count(const Series& series) { return static_cast<double>(std::ranges::count(series, std::uint8_t{1})); }

/// Windows with a trigger.
double windows(const Series& series) {
  double n = 0;
  for (std::size_t begin = 0; begin + rate_hz <= series.size(); begin += rate_hz) {
    const std::span<const std::uint8_t> window(&series[begin], rate_hz);
    n += std::ranges::find(window, std::uint8_t{1}) != window.end() ? 1 : 0;
  }
  return n;
}

}  // namespace

TEST_CASE("false triggers come as often as their rate says with the spread of a Poisson process") {
  const std::size_t n_ticks = 4'000'000;
  const double rate = 0.05, seconds = static_cast<double>(n_ticks) / rate_hz;
  const auto after = through(Bench().pipeline({effect("false_triggers", {{"rate_per_s", rate}})}), Series(n_ticks, 0));
  const double standard_error = std::sqrt(rate * seconds);  // 63 of 4000
  for (const Series& series : after) {
    CHECK(std::abs(count(series) - rate * seconds) < 4.0 * standard_error);
    // Must fail: a rate that is a tenth off.
    CHECK_FALSE(std::abs(count(series) - 1.1 * rate * seconds) < 4.0 * standard_error);
    // Gaps are exponential: the share longer than the mean is 1/e.
    const auto ticks = ones(series);
    double longer = 0;
    for (std::size_t i = 1; i < ticks.size(); ++i)
      longer += static_cast<double>(ticks[i] - ticks[i - 1]) > rate_hz / rate ? 1 : 0;
    const double gaps = static_cast<double>(ticks.size() - 1), p = std::exp(-1.0);
    CHECK(std::abs(longer - p * gaps) < 4.0 * std::sqrt(p * (1 - p) * gaps));
    CHECK_FALSE(std::abs(longer - 0.5 * gaps) < 4.0 * std::sqrt(p * (1 - p) * gaps));
  }
  CHECK(after[0] != after[1]);
}

TEST_CASE("false triggers of one sensor leave the other alone") {
  const auto only_b =
      through(Bench().pipeline({effect("false_triggers", {{"rate_per_s", 1.0}}, {{"sensor", "B"}})}), Series(20000, 0));
  const auto both = through(Bench().pipeline({effect("false_triggers", {{"rate_per_s", 1.0}})}), Series(20000, 0));
  CHECK(count(only_b[0]) == 0);
  CHECK(only_b[1] == both[1]);  // and draw the same numbers, with or without the others
}

TEST_CASE("bursts come back a period apart and hold triggers at their rate") {
  const std::size_t n_ticks = 2'000'000;
  const auto after = through(
      Bench().pipeline({effect("trigger_bursts", {{"length_s", 4.0}, {"period_s", 20.0}, {"rate_per_s", 2.0}})}, 5),
      Series(n_ticks, 0));
  // Folded by the period, everything lies within one stretch of four seconds, which both sensors share.
  Series folded(1000, 0);
  for (const Series& series : after) {
    for (const std::size_t tick : ones(series)) folded[tick % 1000] = 1;
  }
  std::size_t longest_gap = 0, gap = 0;
  for (std::size_t i = 0; i < 2 * folded.size(); ++i) {
    gap = folded[i % 1000] != 0 ? 0 : gap + 1;
    longest_gap = std::max(longest_gap, gap);
  }
  CHECK(longest_gap >= 1000 - 201);
  CHECK(longest_gap <= 1000 - 150);
  const double expected = 2.0 * static_cast<double>(n_ticks) / rate_hz * 4.0 / 20.0;  // 16000
  for (const Series& series : after) {
    // A tick holds one trigger at most: 2 % fewer.
    const double per_tick = 1.0 - std::exp(-2.0 / rate_hz);
    CHECK(std::abs(count(series) - expected * per_tick * rate_hz / 2.0) < 4.0 * std::sqrt(expected));
    CHECK_FALSE(std::abs(count(series) - 1.1 * expected) < 4.0 * std::sqrt(expected));
  }
}

TEST_CASE("missed triggers thin the windows by their probability and nothing within a window") {
  const Series before = random_triggers(2'000'000, 0.02);
  const auto after = through(Bench().pipeline({effect("missed_triggers", {{"probability", 0.3}})}), before)[0];
  const double n = windows(before), kept = windows(after);
  const double standard_error = std::sqrt(0.3 * 0.7 * n);
  CHECK(std::abs(kept - 0.7 * n) < 4.0 * standard_error);
  CHECK_FALSE(std::abs(kept - 0.73 * n) < 4.0 * standard_error);  // must fail
  for (std::size_t begin = 0; begin < before.size(); begin += rate_hz) {
    const bool whole = std::equal(&before[begin], &before[begin] + rate_hz, &after[begin]);
    const bool none = std::all_of(&after[begin], &after[begin] + rate_hz, [](auto t) { return t == 0; });
    REQUIRE((whole || none));
  }
}

TEST_CASE("a trend is drawn for studies of five runs or more, and for no shorter ones") {
  const Bench bench;
  ScriptSpec script;
  script.trials.resize(2);
  int n_effects = 0;
  for (const effects::Effect* effect : effects::catalogue()) {
    if (std::ranges::find(effect->info.choices, "trend", &effects::ChoiceInfo::name) == effect->info.choices.end())
      continue;
    CAPTURE(effect->info.name);
    ++n_effects;
    const auto n_growing = [&](int replicates) {
      script.replicates = replicates;
      Stream stream({1, 0, 0, Purpose::test});
      int n = 0;
      for (int i = 0; i < 200; ++i)
        n += effects::draw_from_prior(*effect, bench.scene, script, stream).choices.at("trend") == "growing" ? 1 : 0;
      return n;
    };
    CHECK(n_growing(2) == 0);
    CHECK(std::abs(n_growing(3) - 100) < 4.0 * std::sqrt(200 * 0.25));
  }
  CHECK(n_effects == 3);
}

TEST_CASE("what is missed grows from run to run in equal steps about its mean") {
  constexpr std::uint32_t n_runs = 4;
  Bench bench;
  bench.n_runs = n_runs;
  const Series before = random_triggers(500'000, 0.02);
  const double n = windows(before);
  const auto lost = [&](double mean, const std::string& trend, std::uint32_t run) {
    const EffectSpec missed = effect("missed_triggers", {{"probability", mean}}, {{"trend", trend}});
    return 1.0 - windows(through(bench.pipeline({missed}, run), before)[0]) / n;
  };
  for (std::uint32_t run = 0; run < n_runs; ++run) {
    CAPTURE(run);
    const double chance = 0.1 * (run + 1.0);  // mean 0.25
    const double standard_error = std::sqrt(chance * (1.0 - chance) / n);
    CHECK(std::abs(lost(0.25, "growing", run) - chance) < 4.0 * standard_error);
    CHECK_FALSE(std::abs(lost(0.25, "steady", run) - chance) < 4.0 * standard_error);  // must fail
  }
  CHECK(lost(0.9, "growing", 2) == 1.0);  // 1.08 would be more than all
  bench.n_runs = 1;                       // of one run the mean is its own
  CHECK(std::abs(lost(0.25, "growing", 0) - 0.25) < 4.0 * std::sqrt(0.25 * 0.75 / n));
}

TEST_CASE("a hold and a rate of false triggers grow from run to run in equal steps about their mean") {
  Bench bench;
  bench.n_runs = 4;
  const std::size_t n_ticks = 1'000'000;
  for (std::uint32_t run = 0; run < bench.n_runs; ++run) {
    CAPTURE(run);
    const auto ones_of = [&](const std::string& trend, const std::string& name,
                             std::map<std::string, double, std::less<>> by, const Series& before) {
      return count(through(bench.pipeline({effect(name, std::move(by), {{"trend", trend}})}, run), before)[0]);
    };
    const Series one = with_ones(400, {10});
    CHECK(ones_of("growing", "pulse_stretching", {{"hold_s", 1.0}}, one) == 1.0 + 20.0 * (run + 1.0));
    CHECK(ones_of("steady", "pulse_stretching", {{"hold_s", 1.0}}, one) == 51.0);
    const double expected = 0.02 * (run + 1.0) * static_cast<double>(n_ticks) / rate_hz;  // mean 0.05 a second
    const Series nothing(n_ticks, 0);
    CHECK(std::abs(ones_of("growing", "false_triggers", {{"rate_per_s", 0.05}}, nothing) - expected) <
          4.0 * std::sqrt(expected));
    CHECK_FALSE(std::abs(ones_of("steady", "false_triggers", {{"rate_per_s", 0.05}}, nothing) - expected) <
                4.0 * std::sqrt(expected));
  }
}

TEST_CASE("after a trigger a dead time lets nothing through and the next trigger after it at once") {
  const Series before = with_ones(500, {10, 11, 109, 110, 111, 300});
  const auto after = through(Bench().pipeline({effect("dead_time", {{"dead_s", 2.0}})}), before)[0];
  CHECK(ones(after) == std::vector<std::size_t>{10, 110, 300});
  const auto busy =
      ones(through(Bench().pipeline({effect("dead_time", {{"dead_s", 2.0}})}), random_triggers(200'000, 0.05))[0]);
  std::size_t shortest = 1000;
  for (std::size_t i = 1; i < busy.size(); ++i) shortest = std::min(shortest, busy[i] - busy[i - 1]);
  CHECK(shortest == 100);
  // The rate of a non-paralysable counter: r / (1 + r tau), one tick more for the mean wait.
  const double expected = 200'000 / (1 / 0.05 + 100 - 1);
  CHECK(std::abs(static_cast<double>(busy.size()) - expected) < 0.02 * expected);
}

TEST_CASE("a pulse holds for its length and begins anew with every trigger") {
  const Series before = with_ones(400, {10, 40, 300});
  const auto after = ones(through(Bench().pipeline({effect("pulse_stretching", {{"hold_s", 1.0}})}), before)[0]);
  std::vector<std::size_t> expected;
  for (std::size_t tick = 10; tick <= 90; ++tick) expected.push_back(tick);
  for (std::size_t tick = 300; tick <= 350; ++tick) expected.push_back(tick);
  CHECK(after == expected);
}

TEST_CASE("pulses of random length spread evenly round their mean") {
  std::vector<std::size_t> every_four_seconds;
  for (std::size_t tick = 1; tick < 1'000'000; tick += 200) every_four_seconds.push_back(tick);
  const auto after = through(Bench().pipeline({effect("pulse_stretching", {{"hold_s", 2.0}, {"spread", 0.5}})}),
                             with_ones(1'000'000, every_four_seconds))[0];
  double sum = 0, squares = 0;
  const auto n = static_cast<double>(every_four_seconds.size());
  for (const std::size_t tick : every_four_seconds) {
    double length = 0;
    while (after[tick + static_cast<std::size_t>(length)] != 0) ++length;
    CHECK(length >= 50);
    CHECK(length <= 150);
    sum += length;
    squares += length * length;
  }
  const double mean = sum / n, variance = squares / n - mean * mean, uniform = 100.0 * 100.0 / 12.0;
  CHECK(std::abs(mean - 100.0) < 4.0 * std::sqrt(uniform / n));
  CHECK_FALSE(std::abs(mean - 105.0) < 4.0 * std::sqrt(uniform / n));
  CHECK(std::abs(variance - uniform) < 0.1 * uniform);
}

TEST_CASE("telegrams collide in as many windows as their probability says, and a sensor alone gets through") {
  const double n = 20'000, chance = 0.3, standard_error = std::sqrt(chance * (1.0 - chance) * n);
  for (const std::string survivor : {"none", "one"}) {
    effects::Pipeline pipeline =
        Bench().pipeline({effect("telegram_collisions", {{"probability", chance}}, {{"survivor", survivor}})});
    double both = 0, first = 0, second = 0;
    for (int i = 0; i < static_cast<int>(n); ++i) {
      Sample together, alone;
      together.bits = {1, 1};
      alone.bits = {0, 1};
      pipeline.apply(together);
      pipeline.apply(alone);
      REQUIRE(alone.bits == std::vector<std::uint8_t>{0, 1});
      both += together.bits[0] * together.bits[1];
      first += together.bits[0] * (1 - together.bits[1]);
      second += together.bits[1] * (1 - together.bits[0]);
    }
    CHECK(std::abs(both - (1.0 - chance) * n) < 4.0 * standard_error);
    CHECK_FALSE(std::abs(both - (0.95 - chance) * n) < 4.0 * standard_error);  // must fail
    CHECK(first + second == (survivor == "one" ? n - both : 0.0));
    CHECK(std::abs(first - second) < 4.0 * std::sqrt(chance * n));
  }
}

namespace {

constexpr double hold_s = 10.0;
constexpr std::size_t hold_ticks = 500;

/// Both sensors hold motion for ten seconds after zones have changed.
Bench holding_bench() {
  Bench bench;
  SensorModelSpec& model = bench.scene.sensor_models["holds"];
  model.response = Response::zones;
  model.detector.report.hold_s = hold_s;
  for (SensorSpec& sensor : bench.scene.sensors) sensor.model = "holds";
  return bench;
}

/// What a detector says whose output follows from these changes of zones.
Series signals(Series changes) {
  for (std::uint8_t& change : changes) change = change != 0 ? pir::signal_above : std::uint8_t{0};
  return changes;
}

/// On from each trigger until so long after it.
Series held(const Series& triggers) {
  Series output(triggers.size(), 0);
  std::size_t until = 0;
  for (std::size_t i = 0; i < triggers.size(); ++i) {
    if (triggers[i] != 0) until = i + hold_ticks + 1;
    output[i] = i < until ? 1 : 0;
  }
  return output;
}

/// The shortest stretch of ones that has ended; 0 if there is none.
std::size_t shortest_pulse(const Series& output) {
  std::size_t shortest = 0, length = 0;
  for (const std::uint8_t on : output) {
    if (on == 0 && length > 0) shortest = shortest == 0 ? length : std::min(shortest, length);
    length = on != 0 ? length + 1 : 0;
  }
  return shortest;
}

}  // namespace

TEST_CASE("whatever a sensor misses or sees too much comes before its hold, and no pulse is shorter") {
  const Bench plain, holding = holding_bench();
  const Series changes = random_triggers(400'000, 0.002);
  REQUIRE(shortest_pulse(held(changes)) == hold_ticks + 1);
  std::vector<EffectSpec> all;
  for (const double probability : {0.1, 0.5, 0.95}) {
    all.push_back(effect("missed_triggers", {{"probability", probability}}));
    all.push_back(effect("missed_triggers", {{"trigger_probability", probability}}, {{"unit", "trigger"}}));
  }
  all.push_back(effect("dead_time", {{"dead_s", 4.0}}));
  all.push_back(effect("dead_time", {{"dead_s", 4.0}}, {{"kind", "paralysable"}}));
  all.push_back(effect("false_triggers", {{"rate_per_s", 0.02}}));
  all.push_back(effect("trigger_bursts", {{"length_s", 3.0}}));
  for (const EffectSpec& one : all) {
    CAPTURE(one.name, one.parameters, one.choices);
    const Series output = through(holding.pipeline({one}), signals(changes))[0];
    // The triggers that the same effect leaves a sensor without a hold, held by the rule.
    const Series left = through(plain.pipeline({one}), changes)[0];
    REQUIRE((left != changes));
    CHECK((output == held(left)));  // whole series are no help in a message
    CHECK(shortest_pulse(output) > hold_ticks);
    // Must fail: the hold before the effect, as a sensor can't have it.
    const Series late = through(plain.pipeline({one}), held(changes))[0];
    CHECK_FALSE((late == held(left)));
    CHECK_FALSE((shortest_pulse(late) > hold_ticks));
  }
}

TEST_CASE("a sensor that holds motion misses as many triggers as the probability says") {
  const Bench holding = holding_bench();
  const std::size_t apart = 1000 + 37, n = 4000;  // longer than a hold and a window, at any moment of a window
  std::vector<std::size_t> ticks;
  for (std::size_t i = 1; i <= n; ++i) ticks.push_back(i * apart);
  const Series changes = with_ones((n + 1) * apart, ticks);
  for (const auto& [unit, parameter] :
       {std::pair{"window", "probability"}, std::pair{"trigger", "trigger_probability"}})
    for (const double probability : {0.1, 0.4}) {
      CAPTURE(unit, probability);
      const Series output =
          through(holding.pipeline({effect("missed_triggers", {{parameter, probability}}, {{"unit", unit}})}),
                  signals(changes))[0];
      const double missed = static_cast<double>(n) - count(output) / static_cast<double>(hold_ticks + 1);
      const double standard_error = std::sqrt(probability * (1.0 - probability) * static_cast<double>(n));
      CHECK(std::abs(missed - probability * static_cast<double>(n)) < 4.0 * standard_error);
      CHECK_FALSE(std::abs(missed - 1.4 * probability * static_cast<double>(n)) < 4.0 * standard_error);  // must fail
    }
}

TEST_CASE("what prolongs a sensor's output comes behind its hold") {
  const Series changes = with_ones(3000, {100, 300, 2000});
  const Series output = through(holding_bench().pipeline({effect("pulse_stretching", {{"hold_s", 1.0}}),
                                                          effect("missed_triggers", {{"probability", 1e-9}})}),
                                signals(changes))[0];
  CHECK(ones(output).size() == (300 - 100 + hold_ticks + 1 + 50) + (hold_ticks + 1 + 50));
}

TEST_CASE("a lost telegram of a sensor that holds motion leaves its column as it was until the next") {
  constexpr int on_rows = 10, off_rows = 20, n = 8'000;
  for (const double loss : {0.3, 0.5}) {
    for (const bool holds : {true, false}) {
      CAPTURE(loss, holds);
      effects::Pipeline pipeline =
          (holds ? holding_bench() : Bench()).pipeline({effect("dead_sensor", {{"loss", loss}})});
      Series shown;
      double on_after_on = 0.0, on_after_off = 0.0;
      for (int i = 0; i < n * (on_rows + off_rows); ++i) {
        Sample row;
        row.time_s = i + 1.0;
        const int place = i % (on_rows + off_rows);
        row.bits.assign(2, place < on_rows ? 1 : 0);
        pipeline.apply(row);
        shown.push_back(row.bits[0]);
        on_after_on += place == on_rows - 1 ? row.bits[0] : 0;
        on_after_off += place == on_rows + off_rows - 1 ? row.bits[0] : 0;
      }
      // On after an `on` if it came through, or the `off` before it didn't and the column was still on: 1 / (1 + loss).
      const double on = 1.0 / (1.0 + loss), stays = loss / (1.0 + loss);
      const double standard_error = std::sqrt(on * stays / n * (1.0 + loss * loss) / (1.0 - loss * loss));
      CHECK((std::abs(on_after_on / n - on) < 4.0 * standard_error) == holds);
      CHECK((std::abs(on_after_off / n - stays) < 4.0 * standard_error) == holds);
      CHECK((shortest_pulse(shown) >= on_rows) ==
            holds);  // must fail: telegrams of a sensor that is asked every window
    }
  }
}

TEST_CASE("telegrams of sensors that hold motion collide where both go on or off, not while they are on") {
  const auto rows = [](const std::string& survivor, const std::vector<std::array<std::uint8_t, 2>>& bits) {
    effects::Pipeline pipeline =
        holding_bench().pipeline({effect("telegram_collisions", {{"probability", 1.0}}, {{"survivor", survivor}})});
    std::vector<std::array<std::uint8_t, 2>> after;
    for (const auto& [a, b] : bits) {
      Sample row;
      row.bits = {a, b};
      pipeline.apply(row);
      after.push_back({row.bits[0], row.bits[1]});
    }
    return after;
  };
  using Rows = std::vector<std::array<std::uint8_t, 2>>;
  // One after the other: nothing is lost.
  CHECK(rows("none", {{1, 0}, {1, 1}, {0, 1}, {0, 0}}) == Rows{{1, 0}, {1, 1}, {0, 1}, {0, 0}});
  // Both go on together: neither shows, and an `off` that comes through alone changes nothing.
  CHECK(rows("none", {{1, 1}, {1, 1}, {0, 1}, {0, 0}}) == Rows{{0, 0}, {0, 0}, {0, 0}, {0, 0}});
  // Both go off together: both stay on until A's next `off`; B's is still lost.
  CHECK(rows("none", {{1, 0}, {1, 1}, {0, 0}, {1, 0}, {0, 0}}) == Rows{{1, 0}, {1, 1}, {1, 1}, {1, 1}, {0, 1}});
  const Rows one = rows("one", {{1, 1}, {1, 1}});
  CHECK(one[0][0] + one[0][1] == 1);
  CHECK(one[1] == one[0]);
}

TEST_CASE("a late clock stamps every trigger later by its lag and its drift") {
  const Series before = with_ones(5000, {1, 2, 50, 1000, 1001, 3000, 4999});
  const auto lag = through(Bench().pipeline({effect("clock_lag", {{"lag_s", 1.0}, {"drift_percent", 0.0}})}), before);
  CHECK(ones(lag[0]) == std::vector<std::size_t>{51, 52, 100, 1050, 1051, 3050});
  const auto drift = through(Bench().pipeline({effect("clock_lag", {{"lag_s", 0.0}, {"drift_percent", 1.0}})}), before);
  CHECK(ones(drift[0]) == std::vector<std::size_t>{1, 2, 51, 1010, 1011, 3030});
}

TEST_CASE("an early clock stamps every trigger earlier, and loses what it would stamp before the beginning") {
  const Series before = with_ones(5000, {1, 50, 51, 1000, 1001, 3000, 4999});
  const auto clock = [&](double lag_s, double drift_percent, std::map<std::string, std::string, std::less<>> of = {}) {
    return through(
        Bench().pipeline({effect("clock_lag", {{"lag_s", lag_s}, {"drift_percent", drift_percent}}, std::move(of))}),
        before);
  };
  CHECK(ones(clock(-1.0, 0.0)[0]) == std::vector<std::size_t>{1, 950, 951, 2950, 4949});
  CHECK(ones(clock(0.0, -1.0)[0]) == std::vector<std::size_t>{1, 49, 50, 990, 991, 2970, 4949});
  CHECK(ones(clock(-1.0, 1.0)[0]) == std::vector<std::size_t>{2, 960, 961, 2980, 4999});
  CHECK(ones(clock(1.0, -50.0)[0]) == std::vector<std::size_t>{51, 75, 76, 550, 1550, 2549});
  // The other sensor's clock is right: its triggers are logged as they happen.
  CHECK(clock(-1.0, 0.0, {{"sensor", "B"}})[0] == before);
}

TEST_CASE("whatever is logged by a tick has been heard by then, and the tick after that isn't needed") {
  for (const auto& [lag, drift] : {std::pair{-3.0, 0.0}, std::pair{-0.31, -0.005}, std::pair{2.0, -0.5},
                                   std::pair{-7.0, 0.3}, std::pair{4.0, 0.1}}) {
    INFO(lag << ' ' << drift);
    effects::Clocks clocks;
    clocks.set(1, 0, lag, drift);
    for (std::int64_t tick = 1; tick < 3000; ++tick) {
      const auto logged_at = [&, lag = lag, drift = drift](std::int64_t t) {
        return t + std::llround(lag + drift * static_cast<double>(t));
      };
      std::int64_t last = tick;
      for (std::int64_t t = tick; t < 3 * tick + 20; ++t) last = logged_at(t) <= tick ? t : last;
      REQUIRE(clocks.heard_by(tick) == last);
    }
  }
}

TEST_CASE("stages act in the catalogue's order whatever the script's") {
  const Bench bench;
  const Series before = random_triggers(50'000, 0.01);
  const std::vector<EffectSpec> effects{effect("pulse_stretching", {{"hold_s", 0.5}}),
                                        effect("dead_time", {{"dead_s", 1.0}}),
                                        effect("false_triggers", {{"rate_per_s", 0.1}})};
  const std::vector<EffectSpec> reversed(effects.rbegin(), effects.rend());
  CHECK(through(bench.pipeline(effects), before) == through(bench.pipeline(reversed), before));
}

TEST_CASE("one effect's chances are the same whatever other effects there are") {
  const Bench bench;
  const Series silent(200'000, 0);
  const EffectSpec falses = effect("false_triggers", {{"rate_per_s", 0.1}}, {{"sensor", "A"}});
  const EffectSpec bursts = effect("trigger_bursts", {{"period_s", 30.0}}, {{"sensor", "B"}});
  const auto both = through(bench.pipeline({falses, bursts}), silent);
  CHECK(both[0] == through(bench.pipeline({falses}), silent)[0]);
  CHECK(both[1] == through(bench.pipeline({bursts}), silent)[1]);
}
