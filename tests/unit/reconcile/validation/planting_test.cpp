// What a self-test hides.
#include "reconcile/validation/selftest.hpp"

#include <algorithm>
#include <filesystem>

#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/short_study.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

Laboratory laboratory(const Settings& analysis) {
  return make_laboratory(test::shipped_scene("meeting_room.gltf"), test::short_study({"S4"}, 60.0), analysis,
                         [](const StudyFrame& frame, std::span<const Series> pilot) {
                           return full_shape(frame, Measured::Kind::series, 1, pilot);
                         });
}

}  // namespace

TEST_CASE("strengths beyond the prior lie on both sides of it where it has two", "[reconcile][selftest]") {
  SelftestSettings settings;
  settings.analysis.table = {60, 60, 60, 0, {"range_scale", "false_triggers"}};
  settings.n_nulls = 0;
  settings.n_planted = 0;
  settings.n_beyond = 12;  // of one side only: once in 2,000 seeds
  const Laboratory lab = laboratory(settings.analysis);
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

TEST_CASE("datasets that were planted are kept beside those of other numbers", "[reconcile][selftest]") {
  const TemporaryFolder folder;
  SelftestSettings settings;
  settings.analysis.table = {20, 20, 20, 0, {"false_triggers"}};
  settings.n_nulls = 2;
  settings.n_planted = 0;
  settings.planted_folder = folder.path() / "planted";
  const Laboratory lab = laboratory(settings.analysis);
  const auto plant_so_many = [&](std::uint32_t n) {
    settings.n_nulls = n;
    return plant(lab, settings);
  };
  const auto changed_last = [&] {
    std::filesystem::file_time_type last{};
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
      last = std::max(last, entry.last_write_time());
    return last;
  };
  CHECK(plant_so_many(2).size() == 2);
  CHECK(plant_so_many(3).size() == 3);
  const auto before = changed_last();
  CHECK(plant_so_many(2).size() == 2);
  CHECK(changed_last() == before);  // nothing was simulated again
}
