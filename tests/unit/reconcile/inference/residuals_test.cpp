// Things that no catalogue holds, injected in the bits: the sentence must say who, when and how.
#include <cmath>
#include <numbers>

#include "pirsim/study.hpp"
#include "reconcile/inference/locate.hpp"
#include "reconcile/inference/residuals.hpp"
#include "reconcile/report/sentences.hpp"
#include "support/catch.hpp"
#include "support/short_study.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

constexpr double work_s = 120.0;

/// Without a table: the plain model's profile is all that is needed.
ReferenceStudy make_reference_study(const NuisanceSpec& nuisance,
                                    const ScriptSpec& script = test::short_study({"S2", "S5", "S9"}, work_s)) {
  ReferenceStudy one;
  one.source = {test::shipped_scene("meeting_room.gltf"), script, nuisance, 4};
  one.frame = frame_of(one.source.scene, one.source.script);
  one.knowledge = cell_knowledge(one.source.scene, one.source.script);
  const std::vector<Series> pilot = pilot_runs(one.source, one.frame, 30);
  one.shape = full_shape(one.frame, Measured::Kind::series, 1, pilot);
  one.table.profile = profile_of(one.frame, one.source.script, pilot);
  return one;
}

const ReferenceStudy& residual_study() {
  static const ReferenceStudy reference = make_reference_study({});
  return reference;
}

/// Eight trials, one after the other.
const ReferenceStudy& session() {
  static const ReferenceStudy reference =
      make_reference_study({}, test::short_study({"S1", "S2", "S3", "S4", "S6", "S7", "S8", "S9"}, 60.0));
  return reference;
}

using Change = std::function<void(std::vector<Sample>& rows, Stream& stream)>;

/// A dataset of another realization, changed.
Measured changed_data(std::uint32_t realization, const Change& change) {
  const ReferenceStudy& reference = residual_study();
  const SimulatedRealization one({reference.source.scene, reference.source.script, {}, 77}, reference.frame,
                                 realization, 1);  // one to get about in
  Measured measured;
  run_study(compile(one.drawn().scene, one.drawn().script), {}, [&](const RunResult& result) {
    std::vector<Sample> rows = result.samples;
    Stream stream({5, realization, static_cast<std::uint32_t>(measured.runs.size()), Purpose::test});
    change(rows, stream);
    measured.runs.push_back(*series_of(reference.frame, 1, result.trial, rows));
  });
  return measured;
}

Residuals explained(const Measured& measured) { return explain_residuals(residual_study(), measured, 0.05, {}); }

struct OutOfCatalogueFault {
  std::string name;
  void (*apply)(std::vector<Sample>& rows, std::size_t sensor, Stream& stream);  ///< to the rows of one run
};

/// A sensor says the opposite during the middle third of a run, as one with a loose pull-up does.
void invert_for_a_while(std::vector<Sample>& rows, std::size_t sensor, Stream& /*stream*/) {
  for (std::size_t i = rows.size() / 3; i < 2 * rows.size() / 3; ++i) rows[i].bits[sensor] ^= 1U;
}

/// All sensors grow dull and keen again together, over 90 s (assumed).
void wax_and_wane(std::vector<Sample>& rows, std::size_t /*sensor*/, Stream& stream) {
  constexpr double period_s = 90.0;
  for (Sample& row : rows) {
    const double missed = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * row.time_s / period_s);
    for (std::uint8_t& bit : row.bits) {
      if (stream.uniform() < missed) bit = 0;
    }
  }
}

/// A sensor's wire picks up its neighbour's pulses: what that one says is said by both.
void pick_up_neighbour(std::vector<Sample>& rows, std::size_t sensor, Stream& /*stream*/) {
  for (Sample& row : rows) row.bits[sensor] |= row.bits[(sensor + 1) % row.bits.size()];
}

const std::vector<OutOfCatalogueFault> out_of_catalogue_faults{{"inverted_for_a_while", invert_for_a_while},
                                                               {"waxing_and_waning", wax_and_wane},
                                                               {"picked_up_neighbour", pick_up_neighbour}};

Change fault(const std::string& name, std::size_t sensor) {
  const auto which = std::ranges::find(out_of_catalogue_faults, name, &OutOfCatalogueFault::name);
  return [which, sensor](std::vector<Sample>& rows, Stream& stream) { which->apply(rows, sensor, stream); };
}

}  // namespace

TEST_CASE("residuals name the sensor that says the opposite for a while", "[reconcile][seconds][residuals]") {
  for (const std::size_t sensor : {std::size_t{0}, std::size_t{3}}) {
    const Residuals found = explained(changed_data(1, fault("inverted_for_a_while", sensor)));
    INFO(sentence(found));
    REQUIRE_FALSE(found.drivers.empty());
    CHECK(found.drivers.front().who == residual_study().frame.sensors[sensor]);
    CHECK_THAT(found.drivers.front().when, contains("middle third"));
  }
}

TEST_CASE("residuals tell the seconds of each minute in which a sensor is triggered",
          "[reconcile][seconds][residuals]") {
  const Residuals found = explained(changed_data(4, [](std::vector<Sample>& rows, Stream& stream) {
    std::size_t begin = 0;
    while (begin < rows.size() && rows[begin].phase != residual_study().frame.counted_phases.front()) ++begin;
    for (std::size_t i = begin; i < rows.size(); ++i) {
      if ((i - begin) % 60 < 6 && stream.uniform() < 0.8) rows[i].bits[2] = 1;
    }
  }));
  INFO(sentence(found));
  REQUIRE_FALSE(found.drivers.empty());
  CHECK(found.drivers.front().who == residual_study().frame.sensors[2]);
  CHECK_THAT(found.drivers.front().when, contains("first 6 s of each minute") && contains("whatever the seat"));
}

TEST_CASE("residuals of the model itself follow nothing", "[reconcile][seconds][residuals]") {
  // At the 5 % level; of 3 datasets 2 or more with a driver have a chance of 0.7 %.
  int with_driver = 0;
  for (std::uint32_t realization = 0; realization < 3; ++realization)
    with_driver += explained(changed_data(100 + realization, [](auto&, auto&) {})).drivers.empty() ? 0 : 1;
  CHECK(with_driver <= 1);
}

TEST_CASE("what is left over tells from which trial on outputs are held longer, and nothing where nothing changes",
          "[reconcile][seconds][residuals]") {
  const SimulatedRealization one(session().source, session().frame, 302, 1);
  const EffectSpec hold{"pulse_stretching", {{"hold_s", 2.0}, {"spread", 0.0}}, {}, {}};
  const std::vector<Series> held = *one.with_effects(std::span(&hold, 1), 0, 1);
  Measured measured;
  measured.runs = one.plain(0, 1);
  const Residuals nothing = explain_rest(session(), {}, measured, 0.1, {});
  INFO(sentence_of_rest(nothing));
  CHECK(nothing.drivers.empty());
  for (std::size_t i = 0; i < measured.runs.size(); ++i) {
    if (measured.runs[i].trial >= 4) measured.runs[i] = held[i];
  }
  const Residuals found = explain_rest(session(), {}, measured, 0.1, {});
  INFO(sentence_of_rest(found));
  REQUIRE_FALSE(found.drivers.empty());
  const ResidualDriver& strongest = found.drivers.front();
  const std::vector<std::string> near{"S4", "S6", "S7"};  // the true one or a neighbour
  CHECK(std::ranges::any_of(
      near, [&](const std::string& trial) { return strongest.when == "from about trial " + trial + " on"; }));
  CHECK(strongest.what == "motion has fewer gaps than before");
  // With that effect applied, motion has more gaps than expected up to there.
  FittedEffect applied;
  applied.effect = hold;
  const Residuals beside = explain_rest(session(), std::span(&applied, 1), measured, 0.1, {});
  INFO(sentence_of_rest(beside));
  CHECK(std::ranges::any_of(beside.drivers,
                            [](const ResidualDriver& driver) { return driver.what.starts_with("motion has fewer"); }));
}

TEST_CASE("sensors that are dead or stuck are explained as well", "[reconcile][seconds][residuals]") {
  const ReferenceStudy known = make_reference_study({0.0, 0.0, 0.0, 0.0, 0.0});
  for (const std::uint8_t bit : {std::uint8_t{0}, std::uint8_t{1}}) {
    const Measured measured = changed_data(2, [bit](std::vector<Sample>& rows, Stream&) {
      for (Sample& row : rows) std::ranges::fill(row.bits, bit);
    });
    const Residuals found = explain_residuals(known, measured, 0.05, {});
    INFO(sentence(found));
    REQUIRE_FALSE(found.drivers.empty());
    CHECK_THAT(found.drivers.front().what, contains(bit == 1 ? "motion where hardly any is expected" : "less motion"));
    for (const ResidualDriver& driver : found.drivers) {
      CHECK(std::isfinite(driver.log_odds));
      CHECK(driver.standard_error > 0.0);
    }
  }
}
