#include "pir/analog_circuit.hpp"

#include <string>

#include "pirsim/error.hpp"
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

TEST_CASE("hold and then blind time follow each other") {
  REQUIRE(output({}, "+....+..+...", {.hold_s = 0.2, .blind_s = 0.3}) ==  //
          "###.....###.");
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
}
