#include "dataset/recipe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <set>

#include "dataset/floor_plan.hpp"
#include "dataset/household.hpp"
#include "effects/catalogue.hpp"
#include "pirsim/random.hpp"
#include "schema/clock.hpp"

namespace pirsim::dataset {
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

}  // namespace pirsim::dataset
