#include "rooms/recipe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numeric>
#include <set>

#include "engine/effects/catalogue.hpp"
#include "files/disk/compression.hpp"
#include "files/disk/file.hpp"
#include "files/read/reader_parts.hpp"
#include "files/read/yaml.hpp"
#include "model/core/text.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/dataset.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/random.hpp"
#include "rooms/floor_plan.hpp"
#include "rooms/recipe_fields.hpp"
#include "rooms/room_day.hpp"

// Who lives in a home of a recipe: read as ranges, drawn once a home.

namespace pirsim::dataset {

/// Reads `household:` of a home.
[[nodiscard]] HouseholdRangesSpec read_household_ranges(const io::YamlNode& node, Diagnostics& faults);

/// A resident for each place to sleep that the home has.
[[nodiscard]] HouseholdSpec draw_household(const HouseholdRangesSpec& ranges, const SceneSpec& home, Stream& stream);

namespace {

std::uint32_t word(int number) { return static_cast<std::uint32_t>(number); }

template <typename Item>
void shuffle(std::vector<Item>& items, Stream& stream) {
  for (std::size_t i = items.size(); i > 1; --i)
    std::swap(items[i - 1], items[stream.index(static_cast<std::uint32_t>(i))]);
}

/// At least one of what is asked for.
int share_of(double share, int whole) {
  return share <= 0.0 ? 0 : std::max(1, static_cast<int>(std::lround(share * whole)));
}

/// (from 1) the first day that isn't trained on: as many working days as asked for lie behind it.
int first_test_day(const RecipeSpec& recipe, const ScheduleSpec& schedule) {
  const std::int64_t first = day_number(schedule.first_day, schedule.where);
  int working = 0;
  for (int day = 1; day <= recipe.days; ++day) working += is_working_day(first + day - 1) ? 1 : 0;
  int wanted = share_of(recipe.split.test_days, std::max(1, working));
  int day = recipe.days + 1;
  while (wanted > 0 && day > 1) {
    --day;
    if (is_working_day(first + day - 1) || working == 0) --wanted;
  }
  return day;
}

// -- who is there ----------------------------------------------------------------------------------------------------

ScheduleSpec schedule_of(const RecipeSpec& recipe, const SceneSpec& scene, int room) {
  const RoomGroupSpec& group = group_of(recipe, room);
  ScheduleSpec schedule = group.schedule;
  if (group.home) {
    Stream stream({recipe.seed, word(recipe.original_of(room)), 1, Purpose::flat_household});
    schedule.household = draw_household(group.home->household, scene, stream);
    return schedule;
  }
  std::vector<StaffSpec> pool;
  for (const StaffSpec& staff : schedule.staff) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(staff.count); ++i) {
      StaffSpec& one = pool.emplace_back(staff);
      one.count = 1;
      one.seats.clear();
      if (i < staff.seats.size()) one.seats.push_back(staff.seats[i]);
    }
  }
  Stream stream({recipe.seed, word(recipe.original_of(room)), 0, Purpose::room_people});
  const int most = static_cast<int>(std::min(pool.size(), scene.seats.size()));
  int n = most;
  if (group.people) {
    const int up_to = std::min(group.people->most, most);
    n = draw(CountRange{std::min(group.people->least, up_to), up_to}, stream);
  }
  if (n < static_cast<int>(pool.size())) shuffle(pool, stream);
  pool.resize(static_cast<std::size_t>(n));
  schedule.staff = std::move(pool);
  return schedule;
}

std::vector<PetSpec> pets_of(const RecipeSpec& recipe, int room) {
  const RoomGroupSpec& group = group_of(recipe, room);
  std::vector<PetSpec> pets;
  if (!group.home) return pets;
  Stream stream({recipe.seed, word(recipe.original_of(room)), 0, Purpose::home_pets});
  const HouseholdRangesSpec& household = group.home->household;
  for (const auto& [kind, chance] : {std::pair(PetKind::cat, household.cat), {PetKind::dog, household.dog}}) {
    if (stream.uniform() < chance) pets.push_back({word_of(kind), kind, {}, {}, {}, {}});
  }
  return pets;
}

/// Of the room on this day; to a hundredth of a degree, so that scripts are good to read.
double ambient_of(const RecipeSpec& recipe, int room, int day) {
  const std::optional<Range>& range = group_of(recipe, room).ambient_c;
  if (!range) return recipe.sensing.ambient_c;
  Stream of_room({recipe.seed, word(recipe.original_of(room)), 0, Purpose::room_ambient});
  Stream of_day({recipe.seed, word(room), word(day), Purpose::day_ambient});
  return std::round(100.0 * (draw(*range, of_room) + recipe.ambient_sd_k * of_day.normal())) / 100.0;
}

// -- effects ---------------------------------------------------------------------------------------------------------

double drawn(const Range& range, effects::Scale scale, Stream& stream) {
  if (scale == effects::Scale::whole)
    return draw(CountRange{static_cast<int>(std::lround(range.least)), static_cast<int>(std::lround(range.most))},
                stream);
  if (scale == effects::Scale::logarithmic && range.least > 0.0)
    return range.least * std::pow(range.most / range.least, stream.uniform());
  return draw(range, stream);
}

/// One effect with all parameters: those of the recipe from its ranges, the others from the catalogue's priors.
EffectSpec draw_effect(const VariedEffectSpec& varied, const SceneSpec& scene, const ScriptSpec& script,
                       Stream& stream) {
  const effects::Effect& entry = effects::find(varied.name);
  EffectSpec effect = effects::draw_from_prior(entry, scene, script, stream);
  effect.where = varied.where;
  const auto has_sensor = varied.choices.find("sensor") != varied.choices.end();
  if (!has_sensor) effect.choices.erase("sensor");  // of all, or the effect's own way
  // Numbers are meant of the usual variant, where the recipe doesn't name another.
  for (const effects::ChoiceInfo& choice : entry.info.choices) {
    if (choice.kind == effects::ChoiceKind::variant && !varied.parameters.empty()) effect.choices.erase(choice.name);
  }
  for (const auto& [name, choice] : varied.choices) effect.choices[name] = choice;
  for (const auto& [name, range] : varied.parameters) {
    const auto& known = entry.info.parameters;
    const auto parameter = std::ranges::find(known, name, &effects::ParameterInfo::name);
    effect.parameters[name] = drawn(range, parameter->scale, stream);
  }
  for (const effects::ParameterInfo& parameter : entry.info.parameters) {
    const bool is_asked_for = varied.parameters.contains(parameter.name);
    if (!is_asked_for && !effects::applies(parameter, effect)) effect.parameters.erase(parameter.name);
    if (effects::applies(parameter, effect)) effect.parameters.try_emplace(parameter.name, parameter.typical);
  }
  return effect;
}

void add_effects(const RecipeSpec& recipe, const SceneSpec& scene, int room, int day, ScriptSpec& script) {
  for (std::size_t i = 0; i < recipe.effects.size(); ++i) {
    const VariedEffectSpec& varied = recipe.effects[i];
    constexpr std::uint32_t most_days = 4096;
    const auto which = static_cast<std::uint32_t>(i);
    Stream stream(varied.per == VariedEffectSpec::Per::room
                      ? StreamKey{recipe.seed, word(recipe.original_of(room)), which, Purpose::room_effects}
                      : StreamKey{recipe.seed, word(room), which * most_days + word(day), Purpose::day_effects});
    const auto sensor = varied.choices.find("sensor");
    const bool each = sensor != varied.choices.end() && sensor->second == "each";
    for (std::size_t k = 0; k < (each ? scene.sensors.size() : 1); ++k) {
      VariedEffectSpec one = varied;
      if (each) one.choices["sensor"] = scene.sensors[k].id;
      const bool is_there = stream.uniform() < varied.chance;
      EffectSpec effect = draw_effect(one, scene, script, stream);
      if (is_there) script.effects.push_back(std::move(effect));
    }
  }
}

}  // namespace

std::vector<int> drawn_by_weight(const DrawBySpec& draw_by, std::uint64_t seed) {
  Stream stream({seed, 0, 0, Purpose::weighted_rooms});
  const double sum = std::accumulate(draw_by.weights.begin(), draw_by.weights.end(), 0.0);
  const double step = sum / draw_by.count;
  std::vector<int> rooms;
  double reached = 0.0, wanted = stream.uniform() * step;
  for (std::size_t i = 0; i < draw_by.weights.size(); ++i) {
    reached += draw_by.weights[i];
    for (; wanted < reached && static_cast<int>(rooms.size()) < draw_by.count; wanted += step)
      rooms.push_back(static_cast<int>(i) + 1);
  }
  while (static_cast<int>(rooms.size()) < draw_by.count) rooms.push_back(rooms.back());  // rounding took the last step
  return rooms;
}

const RoomGroupSpec& group_of(const RecipeSpec& recipe, int room) {
  const int original = recipe.original_of(room);
  int first = 1;
  for (const RoomGroupSpec& group : recipe.rooms) {
    if (original < first + group.count) return group;
    first += group.count;
  }
  throw Error(ErrorCode::usage, "the recipe has rooms 1 to " + std::to_string(recipe.n_rooms()));
}

std::string kind_of(const RoomGroupSpec& group) {
  if (group.home) return "home";
  return group.rooms.kind == RoomKind::office ? "office" : "meeting";
}

const OwnScene* own_scene(const RecipeSpec& recipe, int room) {
  const int original = recipe.original_of(room);
  int first = 1;
  for (const RoomGroupSpec& group : recipe.rooms) {
    if (original < first + group.count)
      return group.scenes.empty() ? nullptr
                                  : &group.scenes[static_cast<std::size_t>(original - first) % group.scenes.size()];
    first += group.count;
  }
  return nullptr;
}

SceneSpec read_own(const OwnScene& own, io::SceneOptions options) {
  options.marks = own.marks;
  return io::read_scene(own.file, options);
}

SceneSpec room_of(const RecipeSpec& recipe, int number, const io::SceneOptions& options) {
  const RoomGroupSpec& group = group_of(recipe, number);
  if (const OwnScene* own = own_scene(recipe, number)) return read_own(*own, options);
  if (group.home) return draw_flat(group.home->flats, recipe.seed, recipe.original_of(number), options).scene;
  return draw_room(group.rooms, recipe.seed, recipe.original_of(number), options).scene;
}

std::vector<Part> parts_of(const RecipeSpec& recipe) {
  const int n = recipe.n_rooms();
  const int validation = share_of(recipe.split.validation_rooms, n), test = share_of(recipe.split.test_rooms, n);
  if (validation + test >= n) {
    throw Error(ErrorCode::input, "split: no room is left to train on: " + std::to_string(n) + " rooms, " +
                                      std::to_string(validation) + " for validation, " + std::to_string(test) +
                                      " for test");
  }
  std::vector<int> rooms(static_cast<std::size_t>(n));
  std::iota(rooms.begin(), rooms.end(), 1);
  Stream stream({recipe.seed, 0, 0, Purpose::dataset_part});
  shuffle(rooms, stream);
  std::vector<Part> parts(static_cast<std::size_t>(n) * static_cast<std::size_t>(recipe.days), Part::train);
  for (int i = 0; i < n; ++i) {
    const int room = rooms[static_cast<std::size_t>(i)];
    const Part part = i < validation ? Part::validation : i < validation + test ? Part::test_rooms : Part::train;
    const int later = first_test_day(recipe, group_of(recipe, room).schedule);
    if (later <= 1) throw Error(ErrorCode::input, "split: test_days leaves no day to train on");
    for (int day = 1; day <= recipe.days; ++day) {
      parts[static_cast<std::size_t>((room - 1) * recipe.days + day - 1)] =
          part == Part::train && day >= later ? Part::test_days : part;
    }
  }
  return parts;
}

std::string lack_of_people(const RecipeSpec& recipe, const SceneSpec& scene, int room) {
  const RoomGroupSpec& group = group_of(recipe, room);
  if (!group.people) return {};
  int staff = 0;
  for (const StaffSpec& some : group.schedule.staff) staff += some.count;
  const int seats = static_cast<int>(scene.seats.size()), least = group.people->least;
  if (least <= std::min(staff, seats)) return {};
  return "people: room " + std::to_string(room) + " should have " + std::to_string(least) + " at least, but has only " +
         (seats < staff ? std::to_string(seats) + " seats" : std::to_string(staff) + " in its schedule's staff") +
         ": so many come";
}

ScriptSpec script_of(const RecipeSpec& recipe, const SceneSpec& scene, int room, int day) {
  ScriptSpec script;
  script.name = recipe.name + ", room " + std::to_string(room);
  // Days of rooms that are drawn by weight are others than those that the weights came from.
  Stream seeds({recipe.seed, word(room), recipe.draw_by ? 1U : 0U, Purpose::dataset_seed});
  script.seed = seeds.next_u32();  // 32 bits: any reader of YAML or JSON holds them
  script.replicates = recipe.days;
  script.sensing = recipe.sensing;
  script.sensing.ambient_c = ambient_of(recipe, room, day);
  TrialSpec& trial = script.trials.emplace_back();
  trial.id = "day";
  trial.schedule = schedule_of(recipe, scene, room);
  trial.pets = pets_of(recipe, room);
  add_effects(recipe, scene, room, day, script);
  return script;
}

std::string name_of(Part part) {
  switch (part) {
    case Part::train:
      return "train";
    case Part::validation:
      return "validation";
    case Part::test_days:
      return "test_days";
    case Part::test_rooms:
      return "test_rooms";
  }
  return {};
}

std::uint32_t index_of(const RecipeSpec& recipe, int room, int day) {
  return static_cast<std::uint32_t>((room - 1) * recipe.days + day - 1);
}

std::string room_name(int room) {
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "room_%04d", room);
  return text.data();
}

std::string room_path(int room) { return "rooms/" + room_name(room) + ".gltf"; }

std::string day_path(const std::string& folder, int room, int day, const std::string& ending) {
  std::array<char, 24> name{};
  std::snprintf(name.data(), name.size(), "day_%02d", day);
  return folder + '/' + room_name(room) + '/' + name.data() + ending;
}

namespace {

std::size_t beds_of(const SceneSpec& home) {
  return static_cast<std::size_t>(std::ranges::count_if(home.places, [](const PlaceSpec& place) {
    return place.posture == PlacePosture::lie && std::ranges::find(place.uses, "sleep") != place.uses.end();
  }));
}

}  // namespace

HouseholdRangesSpec read_household_ranges(const io::YamlNode& node, Diagnostics& faults) {
  io::YamlMap map(node, faults, "household");
  HouseholdRangesSpec ranges;
  io::read_fields(map, ranges);
  constexpr double rounding = 1e-9;
  if (ranges.works + ranges.works_at_home > 1.0 + rounding)
    faults.error(
        map.where("works_at_home"),
        "household: works_at_home: is more than 1 together with `works`, which is " + shortest_number(ranges.works));
  for (const HouseholdClock& named : household_clocks) io::read_part(map, named.key, ranges.usual.*named.clock);
  HouseholdSpec somebody = ranges.usual;
  somebody.residents.emplace_back().id = "resident";
  check_together(somebody, [&](std::string_view field, const std::string& message) {
    const std::string key(field);
    faults.error(map.where(key), "household: " + key + ": " + message);
  });
  map.finish();
  return ranges;
}

HouseholdSpec draw_household(const HouseholdRangesSpec& ranges, const SceneSpec& home, Stream& stream) {
  constexpr double minutes = 60.0, last_h = 24.0;
  HouseholdSpec household = ranges.usual;
  household.visits_a_week = std::round(10.0 * draw(ranges.visits_a_week, stream)) / 10.0;
  const double shift_h = std::round(draw(ranges.shift_min, stream)) / minutes;
  for (const HouseholdClock& named : household_clocks) {
    double& mean_h = (household.*named.clock).mean_h;
    mean_h = std::clamp(std::round(minutes * (mean_h + shift_h)) / minutes, 0.0, last_h);
  }
  for (std::size_t i = 1; i <= beds_of(home); ++i) {
    ResidentSpec& resident = household.residents.emplace_back();
    resident.id = "resident_" + std::to_string(i);
    const double u = stream.uniform();
    resident.occupation = u < ranges.works                          ? Occupation::works
                          : u < ranges.works + ranges.works_at_home ? Occupation::works_at_home
                                                                    : Occupation::at_home;
    resident.age_years = std::round(draw(ranges.age_years, stream));
  }
  return household;
}

namespace {

void refuse(const io::YamlMap& map, const std::string& key, const std::string& why) {
  if (map.has(key)) map.faults().error(map.where(key), map.label(key) + ": " + why);
}

SensorGroupSpec read_sensors(const io::YamlNode& node, Diagnostics& faults) {
  io::YamlMap map(node, faults, "sensors");
  SensorGroupSpec group;
  map.require("mount");
  io::read_fields(map, group);
  group.where = map.where("model");
  if (group.mount == Mount::ceiling) {
    for (const char* key : {"height_m", "tilt_deg"})
      refuse(map, key, "is of sensors on walls, and these hang on ceilings");
  }
  map.finish();
  return group;
}

}  // namespace

RoomSpec read_room_keys(io::YamlMap& map) {
  RoomSpec spec;
  spec.where = map.where();
  io::read_fields(map, spec);
  if (spec.kind == RoomKind::meeting) {
    for (const char* key : {"desks", "desk_width_m", "desk_screens"}) refuse(map, key, "a meeting room has no desks");
  }
  // What is given and no room of these ranges can have.
  if (!map.has("l_shaped")) refuse(map, "cut_share", "is of rooms that lack a corner: give `l_shaped`, too");
  if (spec.desk_screens > 0.0 && std::ranges::find(spec.orders, DeskOrder::islands) == spec.orders.end())
    refuse(map, "desk_screens", "is of desks in islands, and `desks` has none");
  if (!map.has("sensors")) {
    static_cast<void>(map.list("sensors"));
    return spec;
  }
  spec.sensors.clear();
  for (const io::YamlNode& node : map.list("sensors")) spec.sensors.push_back(read_sensors(node, map.faults()));
  int most = 0;
  for (const SensorGroupSpec& group : spec.sensors) most += group.count.most;
  if (most == 0) map.faults().error(map.where("sensors"), "sensors: a room needs one");
  return spec;
}

namespace {

/// Refuses what is given and no flat of these ranges can have.
void refuse_vain_wishes(io::YamlMap& map, const FlatSpec& spec) {
  // Beside the living room and the study, a bedroom for every two.
  const int rooms_with_study = std::max(3, 2 + (spec.residents.least + 1) / 2);
  if (spec.study > 0.0 && spec.rooms.most < rooms_with_study)
    refuse(map, "study",
           "a flat for " + counted(static_cast<std::size_t>(spec.residents.least), "resident") +
               " has one from `rooms: " + std::to_string(rooms_with_study) + "` on, and `rooms` is " +
               std::to_string(spec.rooms.most) + " at most");
  const auto hangs = [](const auto& places, auto place) { return std::ranges::find(places, place) != places.end(); };
  const bool in_rooms = hangs(spec.sensors_at, SensorsAt::rooms);
  if (!in_rooms) refuse(map, "mount", "is of sensors in rooms, and all hang above doorways (`sensors_at: doorway`)");
  for (const char* key : {"sensor_height_m", "sensor_tilt_deg"}) {
    if (in_rooms && hangs(spec.mounts, Mount::corner)) continue;
    refuse(map, key,
           std::string("is of sensors in corners, and all hang ") +
               (in_rooms ? "on ceilings (`mount: ceiling`)" : "above doorways (`sensors_at: doorway`)"));
  }
}

}  // namespace

FlatSpec read_flat_keys(io::YamlMap& map) {
  FlatSpec spec;
  spec.where = map.where();
  io::read_fields(map, spec);
  if (map.has("model")) spec.models_where = map.where("model");
  refuse_vain_wishes(map, spec);
  return spec;
}

namespace {

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
  io::read_fields(map, effect);
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

/// How warm rooms are whose group doesn't say it, unless the sensing does.
void read_usual_ambient(YamlMap& map, bool sensing_tells, RecipeSpec& recipe) {
  // Ref: [Foldvary2018], means of 121 cooled office buildings in Europe, America and Oceania: 5th to 95th percentile.
  constexpr Range offices{21.0, 25.0};
  constexpr Range homes{19.0, 24.0};  // Ref: [EnBuild2021], a mean of 19; [Slovenia2017], nearly all
  std::optional<Range> given;
  io::read_optional_ends(map, "ambient_c", given, accepted::skin_c);
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
  io::read_fields(map, group);
  HomeGroupSpec& home = group.home.emplace();
  home.flats = read_flat_keys(map);
  if (const auto household = map.child("household")) home.household = read_household_ranges(*household, faults);
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
    static_cast<void>(map.child(key));
    refuse(map, key, "a home has `household` and `residents` instead");
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
    group.count = static_cast<int>(group.scenes.size());
  } else {
    static_cast<void>(map.list("scenes", limits::rooms));
    group.rooms = read_room_keys(map);
  }
  group.people = people;
  io::read_fields(map, group);
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
  draw_by.count = own.required_integer("count", accepted::rooms_alike);
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
  // What is too small to be divided isn't, unless a recipe says how.
  if (recipe.n_rooms() < 3 || recipe.draw_by) split.validation_rooms = split.test_rooms = 0.0;
  if (recipe.days < 2) split.test_days = 0.0;
  io::read_part(map, "split", split);
  if (recipe.draw_by && (split.validation_rooms > 0.0 || split.test_rooms > 0.0)) {
    map.faults().error(map.where("split"),
                       "split: draw_by draws a room more than once, so that none can be held back: "
                       "leave validation_rooms and test_rooms at 0");
  }
  return split;
}

void read_outputs(YamlMap& map, RecipeSpec& recipe) {
  recipe.occupants = map.flag("occupants", false) ? Occupants::told : Occupants::counted;
  recipe.frames = map.flag("frames", false) ? Frames::taken : Frames::none;
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
  io::read_fields(map, recipe);
  const auto sensing = map.child("sensing");
  const auto sensing_tells = [&](const std::string& key) {
    return sensing && sensing->is_map() && YamlMap(*sensing, faults, "sensing").has(key);
  };
  recipe.sensing = io::read_sensing(sensing, faults);
  if (!sensing_tells("units")) recipe.sensing.units = Units::drawn;
  const auto schedule = io::read_schedule(map.child("schedule"), faults);
  std::optional<CountRange> people;
  io::read_optional_ends(map, "people", people, range_of(field_of<&RoomGroupSpec::people>(), RoomGroupSpec{}));
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
