#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "dataset/exports.hpp"
#include "dataset/flat_reader.hpp"
#include "dataset/household.hpp"
#include "dataset/recipe.hpp"
#include "dataset/room_reader.hpp"
#include "io/files/compression.hpp"
#include "io/files/input.hpp"
#include "io/read/reader_parts.hpp"
#include "pirsim/dataset.hpp"
#include "pirsim/effects.hpp"
#include "schema/clock.hpp"

namespace pirsim::dataset {
namespace {

constexpr int most_rooms = static_cast<int>(limits::rooms), most_days = 3'660;  // assumed: ten years
constexpr std::int64_t most_room_days = 1'000'000;  // assumed: some months of a cluster of a hundred cores

using io::YamlMap;
using io::YamlNode;

// -- effects ---------------------------------------------------------------------------------------------------------

void read_setting(const io::YamlKey& key, const YamlNode& value, const effects::EffectInfo* info,
                  VariedEffectSpec& effect, Diagnostics& faults) {
  const std::string what = effect.name + "." + key.name;
  const bool is_choice =
      info != nullptr && std::ranges::find(info->choices, key.name, &effects::ChoiceInfo::name) != info->choices.end();
  if (is_choice) {
    effect.choices[key.name] = value.text(faults, what);
  } else if (value.is_list()) {
    const std::vector<double> ends = io::read_numbers(value, faults, what);
    if (ends.size() != 2) return faults.error(value.where(), what + ": expected a number, or [least, most]");
    if (ends[1] < ends[0]) return faults.error(value.where(), what + ": the second number is less than the first");
    effect.parameters[key.name] = {ends[0], ends[1]};
  } else {
    const double one = value.number(faults, what);
    effect.parameters[key.name] = {one, one};
  }
}

/// Names and bounds by the catalogue, of both ends of each range.
void check_by_catalogue(const VariedEffectSpec& effect, Diagnostics& faults) {
  EffectSpec least{effect.name, {}, effect.choices, effect.where}, most = least;
  for (auto* spec : {&least, &most}) {
    if (const auto sensor = spec->choices.find("sensor"); sensor != spec->choices.end() && sensor->second == "each")
      spec->choices.erase(sensor);
  }
  for (const auto& [name, range] : effect.parameters) {
    least.parameters[name] = range.least;
    most.parameters[name] = range.most;
  }
  Diagnostics found;
  effects::check(std::vector<EffectSpec>{least}, found);
  if (!found.has_errors()) effects::check(std::vector<EffectSpec>{most}, found);
  for (const Issue& issue : found.issues()) faults.error(issue.where, issue.message);
}

VariedEffectSpec read_effect(const YamlNode& node, Diagnostics& faults) {
  VariedEffectSpec effect;
  effect.where = node.where();
  if (node.is_scalar()) {
    effect.name = node.text(faults, "effect");
    check_by_catalogue(effect, faults);
    return effect;
  }
  YamlMap map(node, faults, "effect");
  effect.per = map.choice<VariedEffectSpec::Per>(
      "per", effect.per, {{"room", VariedEffectSpec::Per::room}, {"day", VariedEffectSpec::Per::day}});
  effect.chance = map.number("chance", effect.chance, {.min = 0.0, .max = 1.0});
  std::optional<YamlNode> settings;
  for (const io::YamlKey& key : node.keys()) {
    if (key.name == "per" || key.name == "chance") continue;
    if (settings) faults.error(key.where, "a second effect in one entry: '" + key.name + "'");
    effect.name = key.name;
    effect.where = key.where;
    settings = map.child(key.name);
  }
  if (!settings) {
    faults.error(node.where(), "an entry of effects is `name`, or `{name: {parameter: [least, most]}, per: day}`");
    return effect;
  }
  const auto known = effects::list();
  const auto info = std::ranges::find(known, effect.name, &effects::EffectInfo::name);
  if (!settings->is_map() && !settings->is_null())
    faults.error(settings->where(), effect.name + ": expected parameters by name");
  const auto keys = settings->keys();
  const auto values = settings->items();
  for (std::size_t i = 0; i < keys.size(); ++i)
    read_setting(keys[i], values[i], info == known.end() ? nullptr : &*info, effect, faults);
  map.finish();
  check_by_catalogue(effect, faults);
  return effect;
}

// -- rooms and who is in them ----------------------------------------------------------------------------------------

/// Where a recipe says nothing: a desk each, or the usual meetings.
ScheduleSpec usual_schedule(RoomKind kind, int most_seats, const Where& where) {
  ScheduleSpec schedule;
  schedule.where = where;
  if (kind == RoomKind::meeting) {
    schedule.meetings.emplace_back();
  } else {
    schedule.staff.emplace_back().count = most_seats;
  }
  return schedule;
}

std::optional<CountRange> read_people(YamlMap& map, std::optional<CountRange> otherwise) {
  if (!map.has("people")) {
    static_cast<void>(map.child("people"));
    return otherwise;
  }
  return read_count(map, "people", {}, {.min = 0, .max = 200});
}

/// A file's name, or `{scene: flat.glb, marks: flat.yaml}`.
OwnScene read_own_scene(const YamlNode& node, const RecipeSpec& recipe, Diagnostics& faults) {
  const auto file_of = [&](const YamlNode& named, const std::string& what) {
    const auto [file, fault] = io::find_beside(io::folder_of_input(recipe.file), named.text(faults, what),
                                               io::DataKind::rooms, recipe.data_directories);
    std::error_code unreadable;
    if (!fault.empty()) {
      faults.error(named.where(), what + ": " + fault);
    } else if (!std::filesystem::is_regular_file(file, unreadable)) {
      faults.error(named.where(),
                   what + ": '" + file.string() + "' isn't a regular file: it is read again for each part of the work");
    }
    return file;
  };
  if (!node.is_map()) return {file_of(node, "scenes")};
  YamlMap map(node, faults, "scenes");
  OwnScene own{file_of(map.required_child("scene"), map.label("scene"))};
  if (const auto marks = map.child("marks")) own.marks = file_of(*marks, map.label("marks"));
  map.finish();
  return own;
}

bool is_home(const YamlNode& node, Diagnostics& faults) {
  if (!node.is_map()) return false;
  YamlMap map(node, faults, "rooms");
  const auto kind = map.child("kind");
  return kind && kind->is_scalar() && kind->text(faults, "kind") == "home";
}

std::optional<Range> read_ambient(YamlMap& map) {
  const Range given = read_range(map, "ambient_c", {}, accepted::skin_c);
  return map.has("ambient_c") ? std::optional(given) : std::nullopt;
}

/// How warm rooms are whose group doesn't say it, unless the sensing does.
void read_usual_ambient(YamlMap& map, bool sensing_tells, RecipeSpec& recipe) {
  // Ref: [Foldvary2018], means of 121 cooled office buildings in Europe, America and Oceania: 5th to 95th percentile.
  constexpr Range offices{21.0, 25.0};
  constexpr Range homes{19.0, 24.0};  // Ref: [EnBuild2021], a mean of 19; [Slovenia2017], nearly all
  const std::optional<Range> given = read_ambient(map);
  recipe.ambient_sd_k = map.number("ambient_sd_k", recipe.ambient_sd_k, {.min = 0.0, .max = 10.0});
  const auto twice = [&](const Where& where) {
    map.faults().error(where, "ambient_c: sensing.ambient_c says it already: leave out one of them");
  };
  if (sensing_tells && given) twice(map.where("ambient_c"));
  for (RoomGroupSpec& group : recipe.rooms) {
    if (sensing_tells && group.ambient_c) twice(group.where);
    if (!sensing_tells && !group.ambient_c) group.ambient_c = given ? *given : group.home ? homes : offices;
  }
}

/// Flats, and households instead of a schedule; of the recipe's they take the first day.
RoomGroupSpec read_homes(const YamlNode& node, const std::optional<ScheduleSpec>& schedule, Diagnostics& faults) {
  YamlMap map(node, faults, "rooms");
  RoomGroupSpec group;
  group.where = node.where();
  static_cast<void>(map.child("kind"));
  group.count = map.integer("count", group.count, {.min = 1, .max = most_rooms});
  HomeGroupSpec& home = group.home.emplace();
  home.flats = read_flat_keys(map);
  if (const auto household = map.child("household")) home.household = read_household_ranges(*household, faults);
  group.ambient_c = read_ambient(map);
  group.schedule.where = group.where;
  group.schedule.first_day = map.text("first_day", schedule ? schedule->first_day : group.schedule.first_day);
  group.schedule.from_h = home_from_h;
  group.schedule.to_h = home_to_h;
  try {
    static_cast<void>(day_number(group.schedule.first_day, map.where("first_day")));
  } catch (const Error& fault) {
    faults.error(map.where("first_day"), fault.issues().front().message);
  }
  for (const char* key : {"schedule", "people"}) {
    if (map.child(key))
      faults.error(map.where(key), std::string(key) + ": a home has `household` and `residents` instead");
  }
  map.finish();
  return group;
}

RoomGroupSpec read_group(const YamlNode& node, const RecipeSpec& recipe, const std::optional<ScheduleSpec>& schedule,
                         const std::optional<CountRange>& people, Diagnostics& faults) {
  if (is_home(node, faults)) return read_homes(node, schedule, faults);
  YamlMap map(node, faults, "rooms");
  RoomGroupSpec group;
  group.where = node.where();
  if (map.has("scenes")) {
    for (const YamlNode& scene : map.required_list("scenes", limits::rooms))
      group.scenes.push_back(read_own_scene(scene, recipe, faults));
    group.count = map.integer("count", static_cast<int>(group.scenes.size()), {.min = 1, .max = most_rooms});
  } else {
    static_cast<void>(map.list("scenes", limits::rooms));
    group.count = map.integer("count", group.count, {.min = 1, .max = most_rooms});
    group.rooms = read_room_keys(map);
  }
  group.people = read_people(map, people);
  group.ambient_c = read_ambient(map);
  constexpr int many = 200;  // of staff; a room takes as many as it has seats
  const auto own = io::read_schedule(map.child("schedule"), faults);
  group.schedule = own ? *own : schedule ? *schedule : usual_schedule(group.rooms.kind, many, group.where);
  map.finish();
  return group;
}

/// Of rooms as many as the recipe's ranges give.
std::optional<DrawBySpec> read_draw_by(YamlMap& map, int n_rooms) {
  const auto node = map.child("draw_by");
  if (!node) return std::nullopt;
  DrawBySpec draw_by;
  YamlMap own(*node, map.faults(), "draw_by");
  draw_by.where = node->where();
  draw_by.count = own.required_integer("count", {.min = 1, .max = most_rooms});
  for (const YamlNode& weight : own.required_list("weights", limits::rooms))
    draw_by.weights.push_back(weight.number(map.faults(), "draw_by: weights", {.min = 0.0}));
  own.finish();
  const double sum = std::accumulate(draw_by.weights.begin(), draw_by.weights.end(), 0.0);
  if (static_cast<int>(draw_by.weights.size()) != n_rooms) {
    map.faults().error(own.where("weights"), "draw_by: " + std::to_string(draw_by.weights.size()) +
                                                 " weights, but rooms has " + std::to_string(n_rooms) +
                                                 ": give each its own");
  } else if (!(sum > 0.0) || !std::isfinite(sum)) {
    map.faults().error(own.where("weights"), "draw_by: no weight is above 0, or their sum is too large");
  }
  return draw_by;
}

SplitSpec read_split(YamlMap& map, const RecipeSpec& recipe) {
  SplitSpec split;
  const auto node = map.child("split");
  // What is too small to be divided isn't, unless a recipe says how.
  if (recipe.n_rooms() < 3 || recipe.draw_by) split.validation_rooms = split.test_rooms = 0.0;
  if (recipe.days < 2) split.test_days = 0.0;
  if (!node) return split;
  constexpr NumberRange share{.min = 0.0, .max = 1.0};
  YamlMap own(*node, map.faults(), "split");
  split.validation_rooms = own.number("validation_rooms", split.validation_rooms, share);
  split.test_rooms = own.number("test_rooms", split.test_rooms, share);
  split.test_days = own.number("test_days", split.test_days, share);
  own.finish();
  if (recipe.draw_by && (split.validation_rooms > 0.0 || split.test_rooms > 0.0)) {
    map.faults().error(map.where("split"),
                       "split: draw_by draws a room more than once, so that none can be held back: "
                       "leave validation_rooms and test_rooms at 0");
  }
  return split;
}

void read_outputs(YamlMap& map, RecipeSpec& recipe) {
  recipe.occupants = map.flag("occupants", false) ? Occupants::told : Occupants::counted;
  for (const YamlNode& item : map.list("exports")) {
    constexpr std::array all{Export::uci864, Export::casas, Export::energyplus};
    const auto index = item.choice(map.faults(), "exports", {"uci864", "casas", "energyplus"});
    if (!index) continue;
    if (std::ranges::find(recipe.exports, all[*index]) != recipe.exports.end()) {
      map.faults().error(item.where(), "exports: " + item.text(map.faults(), "exports") + " stands here twice");
    } else {
      recipe.exports.push_back(all[*index]);
    }
  }
  std::vector<std::pair<std::string, std::string>> endings;
  for (const std::string& ending : io::table_endings()) endings.emplace_back(ending, ending);
  recipe.ending = map.choice<std::string>("rows", recipe.ending, endings);
  if (std::ranges::find(recipe.exports, Export::uci864) != recipe.exports.end() && !rows_per_reading(recipe.sensing)) {
    map.faults().error(map.where("exports"),
                       "exports: uci864 has a reading every 30 s, which isn't a whole number of "
                       "the rows of sensing.window_s");
  }
}

}  // namespace

int RecipeSpec::original_of(int room) const {
  const bool is_known = room >= 1 && room <= static_cast<int>(originals.size());
  return is_known ? originals[static_cast<std::size_t>(room - 1)] : room;
}

int RecipeSpec::n_rooms() const {
  if (draw_by) return draw_by->count;
  std::int64_t n = 0;
  for (const RoomGroupSpec& group : rooms) n += group.count;
  return static_cast<int>(std::min<std::int64_t>(n, std::numeric_limits<int>::max()));
}

namespace {

RecipeSpec recipe_from(const io::Input& input, const std::filesystem::path& file,
                       std::span<const std::string> overrides,
                       std::span<const std::filesystem::path> data_directories) {
  const YamlNode root = YamlNode::load(input, overrides);
  Diagnostics faults;
  YamlMap map(root, faults, "recipe");
  io::check_version(map, "pirsim_recipe");
  RecipeSpec recipe;
  recipe.file = file;
  recipe.overrides.assign(overrides.begin(), overrides.end());
  recipe.data_directories.assign(data_directories.begin(), data_directories.end());
  recipe.text = recipe.given = input.bytes;
  for (const std::string& change : overrides) {
    // A dataset's own recipe has it already.
    const std::string told = "\n# --set " + change + '\n';
    if (recipe.text.find(told) == std::string::npos) recipe.text += told;
  }
  recipe.name = map.text("name", io::stem_of_input(file));
  recipe.seed = map.unsigned_integer("seed", recipe.seed);
  recipe.days = map.integer("days", recipe.days, {.min = 1, .max = most_days});
  const auto sensing = map.child("sensing");
  const auto sensing_tells = [&](const std::string& key) {
    return sensing && sensing->is_map() && YamlMap(*sensing, faults, "sensing").has(key);
  };
  recipe.sensing = io::read_sensing(sensing, faults);
  if (!sensing_tells("units")) recipe.sensing.units = Units::drawn;
  const auto schedule = io::read_schedule(map.child("schedule"), faults);
  const auto people = read_people(map, std::nullopt);
  for (const YamlNode& node : map.required_list("rooms"))
    recipe.rooms.push_back(read_group(node, recipe, schedule, people, faults));
  read_usual_ambient(map, sensing_tells("ambient_c"), recipe);
  recipe.draw_by = read_draw_by(map, recipe.n_rooms());
  if (recipe.draw_by && !faults.has_errors()) recipe.originals = drawn_by_weight(*recipe.draw_by, recipe.seed);
  for (const YamlNode& node : map.list("effects")) recipe.effects.push_back(read_effect(node, faults));
  recipe.split = read_split(map, recipe);
  read_outputs(map, recipe);
  map.finish();
  if (std::int64_t{recipe.n_rooms()} * recipe.days > most_room_days) {
    faults.error(map.where("rooms"), "rooms: more than " + std::to_string(most_room_days) + " room-days");
  }
  if (!faults.has_errors()) {
    try {
      static_cast<void>(parts_of(recipe));
    } catch (const Error& error) {
      faults.error(map.where("split"), error.issues().front().message);
    }
  }
  faults.throw_if_errors();
  return recipe;
}

}  // namespace

RecipeSpec read_recipe(const std::filesystem::path& file, std::span<const std::string> overrides,
                       std::span<const std::filesystem::path> data_directories) {
  return recipe_from(io::read_input(file), file, overrides, data_directories);
}

RecipeSpec with_overrides(const RecipeSpec& recipe, std::span<const std::string> more) {
  std::vector<std::string> overrides = recipe.overrides;
  overrides.insert(overrides.end(), more.begin(), more.end());
  return recipe_from({recipe.file, recipe.given}, recipe.file, overrides, recipe.data_directories);
}

}  // namespace pirsim::dataset
