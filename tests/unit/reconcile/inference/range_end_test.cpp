// Strengths beyond the range that was looked for.
#include "reconcile/inference/model_check.hpp"

#include "engine/effects/catalogue.hpp"
#include "reconcile/ensemble/realization.hpp"
#include "reconcile/inference/locate.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/short_study.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

FittedEffect fitted(const std::string& effect, const std::string& parameter, double value) {
  FittedEffect result;
  result.effect = effects::off(effects::find(effect));
  result.effect.parameters[parameter] = value;
  FittedParameter fit;
  fit.name = parameter;
  fit.value = value;
  result.parameters = {fit};
  return result;
}

const effects::ParameterInfo& strength(const std::string& effect) { return effects::info(effect).parameters.front(); }

}  // namespace

TEST_CASE("a strength in the last tenth of its prior is at its end, a weak one and one within are not", "[reconcile]") {
  const auto& [low, high] = std::pair{strength("pulse_stretching").low, strength("pulse_stretching").high};
  const auto end = range_end_of(fitted("pulse_stretching", "hold_s", 0.99 * high));
  REQUIRE(end);
  CHECK(end->parameter == "hold_s");
  CHECK(end->end == high);
  CHECK(end->looked_for.low == low);
  CHECK_FALSE(range_end_of(fitted("pulse_stretching", "hold_s", low)));
  CHECK_FALSE(range_end_of(fitted("pulse_stretching", "hold_s", 0.5 * (low + high))));
}

TEST_CASE("of a range about nothing either end counts", "[reconcile]") {
  const effects::ParameterInfo& yaw = strength("sensor_yaw");
  REQUIRE(yaw.low < yaw.off);
  CHECK(range_end_of(fitted("sensor_yaw", yaw.name, 0.99 * yaw.low))->end == yaw.low);
  CHECK(range_end_of(fitted("sensor_yaw", yaw.name, 0.99 * yaw.high))->end == yaw.high);
  CHECK_FALSE(range_end_of(fitted("warm_object", "heading_deg", 179.0)));  // all directions have no end
}

TEST_CASE("the strong end lies on the fitted side of none", "[reconcile]") {
  const effects::ParameterInfo& yaw = strength("sensor_yaw");
  CHECK(strong_end_of(fitted("sensor_yaw", yaw.name, 0.1 * yaw.low))->end == yaw.low);
  CHECK(strong_end_of(fitted("sensor_yaw", yaw.name, 0.1 * yaw.high))->end == yaw.high);
  const effects::ParameterInfo& hold = strength("pulse_stretching");
  CHECK(strong_end_of(fitted("pulse_stretching", "hold_s", hold.low))->end == hold.high);
  CHECK_FALSE(strong_end_of(FittedEffect{{"mirrored_room", {}, {}, {}}, {}, false}));
}

TEST_CASE("a hold of ten seconds is found beyond those that were looked for, other causes are not",
          "[reconcile][seconds]") {
  Settings settings;
  settings.table = {60, 60, 60, {"pulse_stretching"}};
  const ReferenceStudy reference =
      make_full_study(test::shipped_scene("meeting_room.gltf"), test::short_study({"S1", "S4", "S8"}, 60.0), settings,
                      Measured::Kind::series, 1);
  const auto measured_with = [&](const FittedEffect& made_by) {
    const SimulatedRealization fresh(reference.source, reference.frame, 500000, 1);
    return statistics_of(reference.frame, reference.shape, reference.table.profile,
                         *fresh.with_effects(std::span(&made_by.effect, 1), 0, 1));
  };
  const double most = strength("pulse_stretching").high, truth = 2.5 * most;
  const FittedEffect at_end = fitted("pulse_stretching", "hold_s", most);
  const auto look = [&](const std::vector<float>& measured, RangeEnd& end) {
    return fitted_beyond(at_end, end, reference, reference.map(all_trials(reference.frame)), measured, 0.05, {});
  };
  RangeEnd end = *range_end_of(at_end);
  const auto beyond = look(measured_with(fitted("pulse_stretching", "hold_s", truth)), end);
  REQUIRE(beyond);
  CHECK(end.tried_to > 10.0 * most);
  CHECK(*end.found == beyond->effect.parameters.at("hold_s"));
  CHECK(beyond->parameters.front().interval.contains(truth));
  CHECK(beyond->parameters.front().interval.high < 2.0 * truth);

  RangeEnd of_another = *range_end_of(at_end);
  CHECK_FALSE(look(measured_with(fitted("clock_lag", "lag_s", 12.0)), of_another));
  CHECK_FALSE(of_another.found);
}
