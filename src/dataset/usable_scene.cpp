#include "dataset/usable_scene.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "pirsim/model.hpp"
#include "pirsim/room.hpp"
#include "schema/schedule_people.hpp"
#include "sim/compiled_study.hpp"
#include "studies/sight.hpp"

namespace pirsim::dataset {
namespace {

/// What takes somebody to each seat, place and point.
std::vector<ScriptedAction> stops_of(const SceneSpec& scene) {
  std::vector<ScriptedAction> stops;
  for (const SeatSpec& seat : scene.seats) stops.push_back({action::Sit{seat.id}, {}, {}, {}});
  for (const PlaceSpec& place : scene.places) {
    if (place.posture == PlacePosture::lie) {
      stops.push_back({action::Lie{place.id}, {}, {}, {}});
    } else {
      stops.push_back({action::Stand{place.id}, {}, {}, {}});
    }
  }
  return stops;
}

/// To every seat and place, in and out through each door by turns.
std::vector<ScriptedAction> ways_through(const SceneSpec& scene) {
  std::vector<ScriptedAction> actions;
  const std::vector<ScriptedAction> stops = stops_of(scene);
  const std::size_t n_doors = scene.entrances.size();
  for (std::size_t i = 0; i < std::max(stops.size(), n_doors); ++i) {
    const std::string& door = scene.entrances[i % n_doors].id;
    actions.push_back({action::Enter{door}, {}, {}, {}});
    actions.push_back(stops[i % stops.size()]);
    actions.push_back({action::Leave{door}, {}, {}, {}});
  }
  return actions;
}

/// The first is the largest; where sides of beds matter somebody of usual size comes as well.
ScriptSpec tour_of(const SceneSpec& scene, const Demands& demands) {
  ScriptSpec script;
  script.name = "tour of " + scene.name;
  std::vector<PersonSpec> visitors{largest_body("visitor")};
  if (!demands.shared_beds.empty()) visitors.emplace_back().id = "other";
  for (PersonSpec& visitor : visitors) visitor.actions = ways_through(scene);
  script.trials.push_back({"1", std::move(visitors)});
  return script;
}

/// Nobody climbs over whom they share a bed with.
bool gets_in_at_own_side(const sim::PersonModel& person, const SceneSpec& scene, const std::string& bed) {
  constexpr double half_bed_m = 0.9, calves_m = 0.15;
  const sim::LyingPlan& plan = person.beds.at(bed);
  const Vec2 stand = plan.edge.stand(plan.edge.place.world_from_seat);
  const Vec3& place = std::ranges::find(scene.places, bed, &PlaceSpec::id)->world_from_place.origin;
  return glm::distance(stand, floor_point(place)) < half_bed_m + calves_m;
}

}  // namespace

std::string fault_of(const SceneSpec& scene, const Demands& demands) {
  try {
    const Model model = compile(scene, tour_of(scene, demands));
    for (const sim::PersonModel& person : model.compiled().trials().front().people) {
      for (const std::string& bed : demands.shared_beds) {
        if (!gets_in_at_own_side(person, scene, bed)) return "one side of a shared bed couldn't be reached";
      }
    }
    const SightReport report = studies::look_around(model);
    if (std::ranges::any_of(report.sensors, &SensorSight::sees_nothing)) return "a sensor saw nobody";
    const auto sees_little = [&](const SensorSight& sensor) { return sensor.places < demands.least_places; };
    if (std::ranges::any_of(report.sensors, sees_little)) return "a sensor saw hardly any of the floor";
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    return scene.places.empty() ? "a seat or door couldn't be reached" : "a seat, place or door couldn't be reached";
  }
  return {};
}

void ModelFinder::add_to(SceneSpec& scene) {
  for (const SensorSpec& sensor : scene.sensors) {
    if (!known_.contains(sensor.model)) {
      const auto by = std::ranges::find_if(
          named_, [&](const Named& one) { return std::ranges::find(one.models, sensor.model) != one.models.end(); });
      const Where& named_at = by == named_.end() ? otherwise_ : by->where;
      known_.emplace(sensor.model, io::find_sensor_model(sensor.model, {}, options_, named_at));
    }
    scene.sensor_models.emplace(sensor.model, known_.at(sensor.model));
  }
}

void Failures::give_up(const std::string& what, int number, const Where& where) const {
  std::string told;
  for (const auto& [reason, times] : reasons_) {
    told += (told.empty() ? "" : "; ") + std::to_string(times) + (times == 1 ? " time " : " times ") + reason;
  }
  throw Error(ErrorCode::infeasible, where,
              what + ' ' + std::to_string(number) + ": none of " + std::to_string(most_tries) + ' ' + what +
                  "s drawn from these ranges could be used (" + told + "): allow more space or less furniture");
}

}  // namespace pirsim::dataset
