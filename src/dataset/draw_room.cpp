#include <algorithm>
#include <map>

#include "dataset/furnish.hpp"
#include "pirsim/model.hpp"
#include "studies/sight.hpp"

namespace pirsim::dataset {
namespace {

/// As large as the people of a schedule get: where this body gets to, all of them do.
PersonSpec largest_person() {
  constexpr double stature_m = 1.92, bmi = 32.0;
  PersonSpec person;
  person.id = "visitor";
  person.stature_m = stature_m;
  person.mass_kg = bmi * stature_m * stature_m;
  return person;
}

/// Goes to every seat, in and out through each door by turns.
ScriptSpec tour_of(const SceneSpec& scene) {
  PersonSpec visitor = largest_person();
  const std::size_t n_doors = scene.entrances.size();
  for (std::size_t i = 0; i < std::max(scene.seats.size(), n_doors); ++i) {
    const std::string& door = scene.entrances[i % n_doors].id;
    visitor.actions.push_back({action::Enter{door}, {}, {}, {}});
    visitor.actions.push_back({action::Sit{scene.seats[i % scene.seats.size()].id}, {}, {}, {}});
    visitor.actions.push_back({action::Leave{door}, {}, {}, {}});
  }
  ScriptSpec script;
  script.name = "tour of " + scene.name;
  script.trials.push_back({"1", {std::move(visitor)}});
  return script;
}

/// Why nobody could use the room, or nothing.
std::string fault_of(const SceneSpec& scene) {
  try {
    const Model model = compile(scene, tour_of(scene));
    const SightReport report = studies::look_around(model);
    if (std::ranges::any_of(report.sensors, &SensorSight::sees_nothing)) return "a sensor saw nobody";
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    return "a seat or door couldn't be reached";
  }
  return {};
}

void find_models(const RoomSpec& spec, SceneSpec& scene, std::map<std::string, SensorModelSpec>& known,
                 const io::SceneOptions& options) {
  for (const SensorSpec& sensor : scene.sensors) {
    if (!known.contains(sensor.model)) {
      const auto group = std::ranges::find_if(spec.sensors, [&](const SensorGroupSpec& g) {
        return std::ranges::find(g.models, sensor.model) != g.models.end();
      });
      const Where& named_at = group == spec.sensors.end() ? spec.where : group->where;
      known.emplace(sensor.model, io::find_sensor_model(sensor.model, {}, options, named_at));
    }
    scene.sensor_models.emplace(sensor.model, known.at(sensor.model));
  }
}

[[noreturn]] void give_up(const RoomSpec& spec, int number, const std::map<std::string, int>& reasons) {
  std::string told;
  for (const auto& [reason, times] : reasons) {
    told += (told.empty() ? "" : "; ") + std::to_string(times) + (times == 1 ? " time " : " times ") + reason;
  }
  throw Error(ErrorCode::infeasible, spec.where,
              "room " + std::to_string(number) + ": none of " + std::to_string(most_tries) +
                  " rooms drawn from these ranges could be used (" + told + "): allow more space or less furniture");
}

}  // namespace

DrawnRoom draw_room(const RoomSpec& spec, std::uint64_t seed, int number, const io::SceneOptions& options) {
  std::map<std::string, int> reasons;
  std::map<std::string, SensorModelSpec> models;
  for (int tries = 1; tries <= most_tries; ++tries) {
    Stream stream({seed, static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(tries), Purpose::room});
    auto drawn = furnish(spec, stream);
    if (const auto* lacking = std::get_if<NoPlace>(&drawn)) {
      ++reasons[lacking->reason];
      continue;
    }
    auto& room = std::get<DrawnRoom>(drawn);
    room.number = number;
    room.tries = tries;
    room.scene.name = "room " + std::to_string(number);
    find_models(spec, room.scene, models, options);
    const std::string fault = fault_of(room.scene);
    if (fault.empty()) return std::move(room);
    ++reasons[fault];
  }
  give_up(spec, number, reasons);
}

}  // namespace pirsim::dataset
