// What a table of simulated datasets was made from decides its name.
#include <set>

#include "reconcile/ensemble/reference_table.hpp"
#include "support/catch.hpp"
#include "support/each_field.hpp"
#include "support/effects.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace pirsim {

template <>
struct Fields<reconcile::DayParts> {
  static constexpr std::tuple all{
      field("trial", &reconcile::DayParts::trial),      field("n_days", &reconcile::DayParts::n_days),
      field("n_rows", &reconcile::DayParts::n_rows),    field("of_row", &reconcile::DayParts::of_row),
      field("people", &reconcile::DayParts::people),    field("names", &reconcile::DayParts::names),
      field("begins_s", &reconcile::DayParts::begins_s)};
};
template <>
struct Fields<StudyFrame> {
  static constexpr std::tuple all{field("trials", &StudyFrame::trials), field("sensors", &StudyFrame::sensors),
                                  field("counted_phases", &StudyFrame::counted_phases),
                                  field("window_s", &StudyFrame::window_s), field("day_parts", &StudyFrame::day_parts)};
};
template <>
struct Fields<TableSettings> {
  static constexpr std::tuple all{
      field("n_realizations", &TableSettings::n_realizations), field("n_remembered", &TableSettings::n_remembered),
      field("n_traced", &TableSettings::n_traced), field("effects", &TableSettings::effects)};
};

}  // namespace pirsim

TEST_CASE("whatever field of a room, a script or the settings is changed, its table is another", "[reconcile]") {
  SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  ScriptSpec script = test::short_study_a();
  script.effects = {{"soft_zone_edges", {{"sigma_deg", 1.0}}, {}, {}}};
  RealizationSource source{scene, script, {}, 1};
  StudyFrame frame = frame_of(scene, script);
  TableSettings settings;
  settings.effects = {"dead_time"};
  int n_replicates = 1;
  const auto key = [&] { return table_key(source, frame, n_replicates, settings); };
  const std::string before = key();
  std::set<std::string> unseen;
  const auto check = [&](const std::string& path) {
    if (path == "settings.effects[0]") return;  // there is no such effect
    if (key() == before) unseen.insert(path);
  };
  test::each_change(source.scene, "source.scene", check);  // `like` is shared work, and changes no dataset
  test::each_change(source.script, "source.script", check);
  test::each_change(source.nuisance, "source.nuisance", check);
  test::each_change(source.seed, "source.seed", check);
  test::each_change(frame, "frame", check);
  test::each_change(settings, "settings", check);
  test::each_change(n_replicates, "n_replicates", check);
  CHECK(key() == before);
  std::set<std::string> told_only;  // by messages
  for (const std::string& path : unseen) {
    const bool is_place = path.find(".where.") != std::string::npos || path.find(".files[0].") != std::string::npos ||
                          path.ends_with(".files") || path.ends_with(".warnings") || path.ends_with(".description") ||
                          path.ends_with("}.names");  // of products
    if (!is_place) told_only.insert(path);
  }
  // Realizations have seeds of their own, and as many runs as the data. Meshes count, wherever they were read from.
  CHECK(told_only == std::set<std::string>{"source.scene.name", "source.script.directory", "source.script.name",
                                           "source.script.replicates", "source.script.seed"});
}
