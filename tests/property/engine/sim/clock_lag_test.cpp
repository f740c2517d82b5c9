// Early clocks: rows that tell what happens later, against a longer simulation that was shifted by hand.
#include <algorithm>

#include "engine/sim/recording.hpp"
#include "engine/sim/recording_family.hpp"
#include "pirsim/recording.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

constexpr double run_s = 45.0;

EffectSpec clock_lag(double lag_s, double drift_percent, const std::string& sensor = {}) {
  EffectSpec spec{"clock_lag", {{"lag_s", lag_s}, {"drift_percent", drift_percent}}, {}, {}};
  if (!sensor.empty()) spec.choices["sensor"] = sensor;
  return spec;
}

/// A sitter who is about to rise when the run ends.
ScriptSpec at_work(double duration_s, std::vector<EffectSpec> effects, Reader reader = Reader::in_step) {
  ScriptSpec script = short_study_a();
  script.sensing.reader = reader;
  for (TrialSpec& trial : script.trials) trial.duration_s = duration_s;
  script.effects = std::move(effects);
  return script;
}

Model room_model(const ScriptSpec& script) { return compile(shipped_scene("meeting_room.gltf"), script); }

int n_ones_from(const std::vector<Sample>& samples, std::size_t from) {
  int n = 0;
  for (std::size_t i = from; i < samples.size(); ++i) n += static_cast<int>(std::ranges::count(samples[i].bits, 1));
  return n;
}

}  // namespace

TEST_CASE("a row of a clock that is early has the bits of a later row of a longer simulation", "[clock]") {
  int n_at_end = 0;
  for (const Reader reader : {Reader::in_step, Reader::free_running}) {
    const auto longer = results_of(room_model(at_work(run_s + 20.0, {}, reader)));
    for (const int early_s : {1, 3, 15}) {
      INFO(early_s);
      const auto early = results_of(room_model(at_work(run_s, {clock_lag(-early_s, 0.0)}, reader)));
      REQUIRE(early.size() == longer.size());
      for (std::size_t run = 0; run < early.size(); ++run) {
        REQUIRE(early[run].samples.size() == static_cast<std::size_t>(run_s));
        // The first reading of a reader that isn't in step covers less than a window.
        for (std::size_t row = reader == Reader::in_step ? 0 : 1; row < early[run].samples.size(); ++row) {
          const Sample &here = early[run].samples[row], &now = longer[run].samples[row];
          REQUIRE(here.bits == longer[run].samples[row + static_cast<std::size_t>(early_s)].bits);
          // What is true doesn't depend on anybody's clock.
          REQUIRE(here.time_s == now.time_s);
          REQUIRE(here.phase == now.phase);
          REQUIRE(here.people == now.people);
        }
        n_at_end +=
            n_ones_from(early[run].samples, static_cast<std::size_t>(run_s) - static_cast<std::size_t>(early_s));
      }
    }
  }
  CHECK(n_at_end > 0);  // the end is filled with what happens then, which isn't nothing
}

TEST_CASE("a clock that is late by as much undoes one that is early, but for both ends", "[clock]") {
  const auto plain = results_of(room_model(at_work(run_s, {})));
  const auto late = results_of(room_model(at_work(run_s, {clock_lag(3.0, 0.0)})));
  for (std::size_t row = 3; row < plain[0].samples.size(); ++row) {
    REQUIRE(late[0].samples[row].bits == plain[0].samples[row - 3].bits);
  }
  CHECK(n_ones_from({late[0].samples.begin(), late[0].samples.begin() + 3}, 0) == 0);
}

TEST_CASE("one sensor's clock is early and the others' rows stay as they are", "[clock]") {
  const auto longer = results_of(room_model(at_work(run_s + 5.0, {})));
  const auto early = results_of(room_model(at_work(run_s, {clock_lag(-5.0, 0.0, "PIR2")})));
  const std::size_t second = 1;
  for (std::size_t row = 0; row < early[0].samples.size(); ++row) {
    for (std::size_t s = 0; s < early[0].samples[row].bits.size(); ++s) {
      REQUIRE(early[0].samples[row].bits[s] == longer[0].samples[row + (s == second ? 5 : 0)].bits[s]);
    }
  }
}

TEST_CASE("recordings, copies of a state and single ticks give the rows of a clock that is early", "[clock]") {
  const Model model = room_model(at_work(run_s, {clock_lag(-4.26, -0.5), {"pulse_stretching", {}, {}, {}}}));
  const auto rows = results_of(model);
  const Recording tracks = record(model, all_runs(model), 1);
  std::vector<RunResult> emitted;
  emit(model, tracks, {}, [&](const RunResult& run) { emitted.push_back(run); });
  CHECK(same_rows(emitted, rows));
  sim::RecordingFamily family(model, all_runs(model));
  std::vector<RunResult> of_family;
  emit(model, family.first(), {}, [&](const RunResult& run) { of_family.push_back(run); });
  CHECK(same_rows(of_family, rows));

  State state(model, 1);
  std::vector<Sample> stepped;
  for (int row = 0; row < 40; ++row) {
    step(model, state);
    stepped.push_back(state.sample());
  }
  State copy(state);
  for (int row = 0; row < 10; ++row) step(model, copy);  // a copy goes on by itself
  while (step(model, state)) stepped.push_back(state.sample());
  CHECK(stepped == rows[1].samples);
  while (step(model, copy)) {
  }
  CHECK(copy.sample() == rows[1].samples.back());
}

TEST_CASE("a recording that ends too early for a clock is refused instead of ending in silence", "[clock]") {
  const Model plain = room_model(at_work(run_s, {}));
  const Recording tracks = record(plain, all_runs(plain), 1);
  const auto emit_with = [&](const EffectSpec& effect) {
    emit(plain, tracks, {.effects = std::vector{effect}}, [](const RunResult&) {});
  };
  CHECK_NOTHROW(emit_with(clock_lag(3.0, 0.5)));
  CHECK_THROWS_WITH(emit_with(clock_lag(-3.0, 0.0)), contains("looks further ahead than was recorded"));
  CHECK_THROWS_WITH(emit_with(clock_lag(3.0, -10.0)), contains("looks further ahead than was recorded"));
}
