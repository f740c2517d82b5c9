#include "engine/pir/analog_circuit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;

namespace {

/// One letter a tick: the signal is above (+), below (-) or inside (.); on (#) or off (.).
std::string output(const ComparatorSpec& spec, const std::string& signal, const ReportSpec& report = {}) {
  const pir::Comparator comparator(spec, report, 0.1);
  pir::Comparator::State state;
  std::string on;
  for (const char letter : signal) {
    comparator.advance(state, letter == '+' ? 0.5 : letter == '-' ? -0.5 : 0.0);
    on += state.on ? '#' : '.';
  }
  return on;
}

}  // namespace

TEST_CASE("without hold the output is on just while the signal is outside the window") {
  REQUIRE(output({}, "..++..--.+-+.") ==  //
          "..##..##.###.");
}

TEST_CASE("the thresholds are two and the signal on one of them is inside") {
  const pir::Comparator comparator({.positive_v = 0.2, .negative_v = 0.4}, {}, 0.02);
  const auto on_at = [&](double volts) {
    pir::Comparator::State state;
    comparator.advance(state, volts);
    return state.on;
  };
  REQUIRE(on_at(0.21));
  REQUIRE_FALSE(on_at(0.2));
  REQUIRE_FALSE(on_at(-0.4));
  REQUIRE(on_at(-0.41));
}

TEST_CASE("hold goes on after the signal has come back and begins anew with each tick outside") {
  REQUIRE(output({}, ".+......+..-.......", {.hold_s = 0.3}) ==  //
          ".####...#######....");
}

TEST_CASE("while blind no pulse counts and one that goes on afterwards does not either") {
  REQUIRE(output({}, "+.+...+.++++++.+..", {.blind_s = 0.4}) ==  //
          "#.....#........#..");
}

TEST_CASE("blind time lasts until its last tick and no longer") {
  for (const double blind_s : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}) {  // off at tick 1, then blind for so many
    INFO(blind_s);
    const auto last = static_cast<std::size_t>(std::lround(10.0 * blind_s)) + 1;
    CHECK(output({}, "+" + std::string(last - 1, '.') + "+", {.blind_s = blind_s}) == "#" + std::string(last, '.'));
    CHECK(output({}, "+" + std::string(last, '.') + "+", {.blind_s = blind_s}) == "#" + std::string(last, '.') + "#");
  }
}

TEST_CASE("hold and then blind time follow each other") {
  REQUIRE(output({}, "+....+..+...", {.hold_s = 0.2, .blind_s = 0.3}) ==  //
          "###.....###.");
}

TEST_CASE("with a time after which it reports again a device does what its makers say") {
  // IKEA's: motion soon after a report doesn't prolong it, later motion does, though it has gone on since long.
  CHECK(output({}, "+.+........", {.hold_s = 0.6, .again_s = 0.3}) ==  //
        "#######....");
  CHECK(output({}, "+..++.......", {.hold_s = 0.6, .again_s = 0.3}) ==  //
        "###########.");
  // Aqara's: a report, and then none, however much moves; motion that goes on afterwards is no new one.
  CHECK(output({}, "+.++-+++.+.", {.again_s = 0.5}) ==  //
        "#........#.");
  // A BISS0001 that doesn't re-trigger: on for a time, then blind.
  CHECK(output({}, "++++++++.+++++++++", {.hold_s = 0.3, .again_s = 0.3, .blind_s = 0.2}) ==  //
        "####.....####.....");
}

namespace {

/// The rule of the class's comment, told by when motion counted and when the output went off.
std::string by_the_rule(const ComparatorSpec& spec, const std::string& signal, const ReportSpec& report) {
  const auto in_ticks = [](double seconds) { return std::lround(seconds / 0.1); };
  const long hold = in_ticks(report.hold_s), again = in_ticks(report.again_s), blind = in_ticks(report.blind_s);
  const auto side = [&](long t) { return t < 0 ? '.' : signal[static_cast<std::size_t>(t)]; };
  std::string on;
  long counted = -1'000'000, off = -1'000'000;
  const auto may_count = [&](long t) { return t > counted + again && t > off + blind; };
  for (long t = 0; t < std::ssize(signal); ++t) {
    const bool was_on = t > 0 && on.back() == '#';
    long pulses = 0;
    for (long begin = std::max(0L, t - in_ticks(spec.pulse_window_s)); begin <= t; ++begin) {
      if (side(begin) != '.' && side(begin) != side(begin - 1) && may_count(begin) && begin > off) ++pulses;
    }
    const bool begins = side(t) != '.' && side(t) != side(t - 1) && pulses >= spec.pulse_count;
    const bool goes_on = side(t) != '.' && (again == 0 || t <= counted + hold);
    const bool counts = may_count(t) && (was_on ? goes_on : begins);
    if (counts) counted = t;
    on += counts || (was_on && t <= counted + hold) ? '#' : '.';
    if (was_on && on.back() == '.') off = t;
  }
  return on;
}

}  // namespace

TEST_CASE("what a device reports follows from when motion counted, for any times and signals") {
  Stream stream(StreamKey{.seed = 5});
  int reports = 0;
  for (int i = 0; i < 400; ++i) {
    const auto time_s = [&] { return stream.index(3) == 0 ? 0.0 : 0.1 * (1 + stream.index(12)); };
    const ReportSpec report{.hold_s = time_s(), .again_s = time_s(), .blind_s = time_s()};
    const ComparatorSpec spec{.pulse_count = 1 + static_cast<int>(stream.index(3)),
                              .pulse_window_s = 0.1 * stream.index(10)};
    std::string signal;
    const std::uint32_t rest = 1 + stream.index(12);
    while (signal.size() < 300)
      signal += std::string(1 + stream.index(4), stream.index(rest) != 0 ? '.' : "+-"[stream.index(2)]);
    INFO(report.hold_s << ' ' << report.again_s << ' ' << report.blind_s << ", " << spec.pulse_count << " pulses in "
                       << spec.pulse_window_s << "\n"
                       << signal);
    const std::string on = output(spec, signal, report);
    REQUIRE(on == by_the_rule(spec, signal, report));
    for (std::size_t t = 1; t < on.size(); ++t) reports += on[t] == '#' && on[t - 1] == '.';
  }
  CHECK(reports > 1000);  // signals that switch it often
}

TEST_CASE("two pulses must begin within the pulse window") {
  const ComparatorSpec two{.pulse_count = 2, .pulse_window_s = 0.4};
  REQUIRE(output(two, "+...+.......") ==  //
          "....#.......");
  REQUIRE(output(two, "+....+......") ==  //
          "............");
  REQUIRE(output(two, "+....+...-..") ==  // the second and third are near enough
          ".........#..");
  REQUIRE(output(two, "++++++++.-..") ==  // a pulse counts where it begins
          "............");
  REQUIRE(output(two, "+-.........+") ==  // and counting starts anew once the output was on
          ".#..........");
}

TEST_CASE("alternating pulses count only on the other side than the last") {
  const ComparatorSpec spec{.pulse_count = 2, .pulse_window_s = 1.0, .pulse_signs = PulseSigns::alternating};
  REQUIRE(output(spec, "+.+.+.-.") ==  //
          "......#.");
  REQUIRE(output(spec, "+-......") ==  //
          ".#......");
}

TEST_CASE("alternating pulses of which the first is forgotten begin anew") {
  const ComparatorSpec spec{.pulse_count = 2, .pulse_window_s = 0.3, .pulse_signs = PulseSigns::alternating};
  REQUIRE(output(spec, "+....+.-") ==  //
          ".......#");
}

TEST_CASE("comparators that make no sense are refused") {
  REQUIRE_THROWS_AS(pir::Comparator({.positive_v = 0.0}, {}, 0.02), Error);
  REQUIRE_THROWS_AS(pir::Comparator({.pulse_count = 0}, {}, 0.02), Error);
  REQUIRE_THROWS_AS(pir::Comparator({.pulse_count = 9}, {}, 0.02), Error);
  REQUIRE_THROWS_AS(pir::Comparator({}, {.blind_s = -1.0}, 0.02), Error);
  REQUIRE_THROWS_AS(pir::Comparator({}, {.again_s = -1.0}, 0.02), Error);
}
