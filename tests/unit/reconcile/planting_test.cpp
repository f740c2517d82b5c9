// What a self-test hides.
#include "pirsim/reconcile/selftest.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/short_study.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

TEST_CASE("strengths beyond the prior lie on both sides of it where it has two", "[reconcile][selftest]") {
  SelftestSettings settings;
  settings.analysis.table = {60, 60, 60, 0, {"range_scale", "false_triggers"}};
  settings.n_nulls = 0;
  settings.n_planted = 0;
  settings.n_beyond = 12;  // of one side only: once in 2,000 seeds
  const Laboratory lab = make_laboratory(test::shipped_scene("meeting_room.gltf"), test::short_study({"S4"}, 60.0),
                                         settings.analysis, [](const StudyFrame& frame, std::span<const Series> pilot) {
                                           return full_shape(frame, Measured::Kind::series, 1, pilot);
                                         });
  std::size_t n_weaker = 0, n_stronger = 0, n_rates = 0;
  for (const Planted& planted : plant(lab, settings)) {
    const EffectSpec& effect = planted.effects.front();
    const effects::ParameterInfo& first = effects::strength_parameter(effect);
    const double value = effect.parameters.at(first.name);
    INFO(effect.name << ' ' << value);
    CHECK((value < first.low || value > first.high));
    if (effect.name == "range_scale") ++(value < 1.0 ? n_weaker : n_stronger);
    if (effect.name == "false_triggers") ++n_rates;
  }
  CHECK(n_weaker > 0);
  CHECK(n_stronger > 0);
  CHECK(n_weaker + n_stronger == settings.n_beyond);
  CHECK(n_rates == settings.n_beyond);
}
