// Wrong counts against counts that were changed by hand.
#include <algorithm>

#include "engine/effects/catalogue.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

ScriptSpec counted() {
  ScriptSpec script = script_of({});
  CountsSpec& counts = script.trials.front().occupancy.emplace().counts.emplace();
  for (int i = 0; i <= 100; ++i) {
    counts.times_s.push_back(60.0 * i);
    counts.people.push_back(i < 30 ? 0 : i < 70 ? 2 : 1);
  }
  return script;
}

int people_at(const CountsSpec& counts, double at_s) {
  const auto after = std::ranges::upper_bound(counts.times_s, at_s);
  return counts.people[static_cast<std::size_t>(after - counts.times_s.begin()) - 1];
}

StudyInForce miscounted(double share, double begin, const std::string& there_was) {
  ScriptSpec script = counted();
  script.effects = {{"people_miscounted", {{"share", share}, {"begin", begin}}, {{"there_was", there_was}}, {}}};
  return effects::in_force(shipped_scene("meeting_room.gltf"), script);
}

}  // namespace

TEST_CASE("One person more, or fewer, for a part of the time", "[effects]") {
  const CountsSpec given = *counted().trials.front().occupancy->counts;
  for (const int by : {1, -1}) {
    // A third of 6000 s, half of what is left before it: from 2000 to 4000 s.
    const StudyInForce study = miscounted(1.0 / 3.0, 0.5, by > 0 ? "one_more_than_told" : "one_fewer_than_told");
    const CountsSpec& counts = study.trials.front().occupancy->counts;
    for (double at_s = 5.0; at_s < 6000.0; at_s += 10.0) {
      const bool within = at_s >= 2000.0 && at_s < 4000.0;
      INFO(at_s);
      CHECK(people_at(counts, at_s) == std::max(0, people_at(given, at_s) + (within ? by : 0)));
    }
    CHECK(study.trials.front().people.size() == (by > 0 ? 3 : 2));
  }
  const StudyInForce none = miscounted(0.0, 0.5, "one_more_than_told");
  CHECK(none.trials.front().occupancy->counts.people == given.people);
}

TEST_CASE("One person more is in the fullest area", "[effects]") {
  ScriptSpec script = counted();
  CountsSpec& given = *script.trials.front().occupancy->counts;
  given.areas = {{"living_room", "", std::vector<int>(given.people.size(), 0)}, {"bedroom", "", given.people}};
  script.effects = {{"people_miscounted", {{"share", 0.5}, {"begin", 0.5}}, {{"there_was", "one_more_than_told"}}, {}}};
  const CountsSpec counts =
      effects::in_force(shipped_scene("two_rooms.gltf"), ScriptSpec(script)).trials.front().occupancy->counts;
  for (std::size_t i = 0; i < counts.people.size(); ++i)
    CHECK(counts.areas[0].people[i] + counts.areas[1].people[i] == counts.people[i]);
  const auto at = std::ranges::find(counts.times_s, 1800.0) - counts.times_s.begin();
  CHECK(counts.areas[1].people[static_cast<std::size_t>(at)] == 3);
}

TEST_CASE("Wrong counts are looked for where there are counts", "[effects]") {
  const auto has = [](const std::vector<const effects::Effect*>& all) {
    return std::ranges::any_of(all, [](const auto* effect) { return effect->info.name == "people_miscounted"; });
  };
  CHECK(has(effects::catalogue_for(counted())));
  CHECK_FALSE(has(effects::catalogue_for(script_of({}))));
  CHECK(effects::catalogue_for(script_of({})).size() + 1 == effects::catalogue().size());
}
