// What `pirsim check` tells, for a reader.
#include <algorithm>
#include <cstdlib>
#include <iomanip>
#include <sstream>

#include "core/text.hpp"
#include "pirsim/columns.hpp"
#include "pirsim/look.hpp"
#include "pirsim/response.hpp"
#include "schema/areas.hpp"
#include "schema/occupancy_runs.hpp"
#include "schema/words.hpp"
#include "sim/compiled_study.hpp"
#include "studies/home_outlook.hpp"
#include "studies/room_plan.hpp"
#include "studies/schedule_outlook.hpp"
#include "studies/sight.hpp"
#include "studies/sitters.hpp"

namespace pirsim {
namespace studies {
namespace {

/// "S1 S2", "all 10", or the first of very many.
std::string named(const std::vector<std::string>& seats, std::size_t n_all) {
  constexpr std::size_t most_named = 12;
  if (seats.empty()) return "none";
  if (seats.size() == n_all && n_all > 1) return "all " + std::to_string(n_all);
  const auto last = seats.begin() + static_cast<std::ptrdiff_t>(std::min(seats.size(), most_named));
  const std::string first = joined(std::vector(seats.begin(), last), " ");
  return seats.size() <= most_named ? first : std::to_string(seats.size()) + ": " + first + " ...";
}

void print(std::ostream& out, const SightReport& report, const SceneSpec& scene) {
  const auto percent = [&](std::size_t places) {
    return report.places == 0 ? 0.0 : 100.0 * static_cast<double>(places) / static_cast<double>(report.places);
  };
  std::size_t width = std::string_view("any sensor").size();
  for (const SensorSight& sight : report.sensors) width = std::max(width, sight.sensor.size());
  const auto line = [&](const auto& sensor, const auto& rays, const auto& cut, const auto& longest, const auto& floor) {
    out << "  " << std::left << std::setw(static_cast<int>(width)) << sensor << std::right << std::setw(6) << rays
        << std::setw(14) << cut << std::setw(13) << longest << std::setw(10) << floor;
  };
  out << "at rest: what each sensor sees of a person who stands on one of " << counted(report.places, "place")
      << " (every " << fixed(report.spacing_m, 2) << " m), or sits still (to be motion, the person has to move):\n";
  line("sensor", "rays", "end at room", "longest, m", "floor, %");
  out << "  seats at rest\n";
  for (const SensorSight& sight : report.sensors) {
    line(sight.sensor, sight.rays, sight.rays_cut, fixed(sight.longest_m, 2), fixed(percent(sight.places), 1));
    out << "  " << (sight.sees_nothing() ? "sees NOBODY" : named(sight.seats, scene.seats.size())) << '\n';
  }
  line("any sensor", "", "", "", fixed(percent(report.places_seen_by_any), 1));
  out << '\n';
  const auto is_floor = [&](const TriMesh& mesh) {
    return studies::role_of(mesh, scene.floor.height_m()) == studies::MeshRole::floor;
  };
  if (std::ranges::none_of(scene.meshes, is_floor)) {
    out << "  no ray ends at the floor: it has no mesh that occludes, only an outline\n";
  }
}

/// A line for each sensor that is deaf to any seat.
void print_deaf_sensors(std::ostream& out, const WorkReport& work, const Model& model) {
  const SceneSpec& scene = model.compiled().scene();
  const SensingSpec& sensing = model.compiled().sensing();
  const std::string channel = sensing.change_per == ChangePer::beam ? "beam" : "cluster";
  bool by_zones = false;
  for (std::size_t sensor = 0; sensor < scene.sensors.size(); ++sensor) {
    const std::vector<std::string> deaf = work.deaf_seats(sensor);
    if (deaf.empty()) continue;
    std::size_t n_seen = 0, n_channels = 0, n_for_good = 0;
    for (std::size_t seat = 0; seat < work.seats.size(); ++seat) {
      const WorkNotice& notice = work.notice(seat, sensor);
      n_seen += notice.channels > 0 ? 1 : 0;
      if (!notice.is_deaf()) continue;
      n_channels += notice.channels;
      n_for_good += notice.for_good;
    }
    out << "  " << scene.sensors[sensor].id << " is deaf to work in " << named(deaf, work.seats.size())
        << " (it sees somebody at work in " << counted(n_seen, "seat") << "): ";
    if (response_of(scene, sensing, scene.sensors[sensor]) == Response::analog) {
      out << "its signal stays within the threshold\n";
    } else {
      by_zones = true;
      out << counted(n_channels, channel) << " touched there, " << n_for_good << " of them covered for good\n";
    }
  }
  if (!by_zones) return;
  out << "  (response: zones, change_per: " << channel << "; what helps may be --response analog"
      << (sensing.change_per == ChangePer::beam ? "" : ", or change_per: beam") << ")\n";
}

void print(std::ostream& out, const WorkReport& work, const std::string& who, const Model& model) {
  const std::size_t n_tried = work.seats.size(), n_seats = model.scene().seats.size();
  if (n_tried == 0) return;
  const SeatsAtWork seats = work.by_any();
  out << "at work: " << who << ", for " << work.seconds << " s in each of "
      << (n_tried < n_seats ? std::to_string(n_tried) + " of the " : "") << counted(n_seats, "seat") << ": noticed in "
      << named(seats.noticed, n_tried) << "; deaf (seen, but never noticed) in " << named(seats.deaf, n_tried)
      << "; unseen in " << named(seats.unseen, n_tried) << '\n';
  print_deaf_sensors(out, work, model);
  out << '\n';
}

/// When the first trial's people begin what they are to do at a given time.
void print_times(std::ostream& out, const sim::TrialModel& trial) {
  constexpr int most_told = 12;
  out << "clock: every run begins at " << trial.clock->text(0.0) << '\n';
  for (const sim::PersonModel& person : trial.people) {
    int n = 0;
    for (const ScriptedAction& action : person.spec.actions) {
      if (!action.at_s || ++n > most_told) continue;
      out << (n == 1 ? "  " + person.spec.id + " begins an action at " : ", ");
      out << trial.clock->shortest_text(*action.at_s);
    }
    if (n > 0) out << (n > most_told ? " and so on\n" : "\n");
  }
  out << '\n';
}

/// What the data behind a script say, and how much of it a run is.
void print_occupancy(std::ostream& out, const OccupancySpec& occupancy, const sim::TrialModel& trial) {
  const std::string& file = data_file(occupancy);
  out << "occupancy: ";
  if (occupancy.counts) {
    const CountsSpec& counts = *occupancy.counts;
    const auto [fewest, most] = std::ranges::minmax(counts.people);
    int changes = counts.people.front();
    for (std::size_t i = 1; i < counts.people.size(); ++i) changes += std::abs(counts.people[i] - counts.people[i - 1]);
    out << counted(counts.people.size(), "reading") << (file.empty() ? "" : " of " + file) << ", " << fewest << " to "
        << counted(static_cast<std::size_t>(most), "person", "people") << ", "
        << counted(static_cast<std::size_t>(changes), "coming or going", "comings and goings");
    for (const AreaCountsSpec& area : counts.areas)
      out << "; " << area.area << " up to " << *std::ranges::max_element(area.people);
  } else {
    out << counted(trial.people.size(), "person", "people") << (file.empty() ? "" : " of " + file);
  }
  const auto last = trial.begins_s.size() - 1;
  if (has_days(occupancy)) out << "; " << counted(last + 1, "day") << " of data, which replicates take in turn";
  out << "; a run lasts from " << span_text(trial.clock, 0.0, trial.duration_s.value_or(0.0)) << "\n\n";
}

/// Whose people are counted by themselves, which sensors watch each, and what of the floor is in none.
void print_areas(std::ostream& out, const SceneSpec& scene) {
  const Areas areas(scene);
  for (std::size_t i = 0; i < scene.areas.size(); ++i) {
    out << (i == 0 ? "areas: " : "       ") << areas.names()[i] << ' ' << fixed(areas.areas_m2()[i], 2) << " m2, ";
    std::vector<std::string> sensors;
    for (const std::size_t sensor : areas.sensors_of(i)) sensors.push_back(scene.sensors[sensor].id);
    out << (sensors.empty() ? "no sensor" : (sensors.size() == 1 ? "sensor " : "sensors ") + named(sensors, 0)) << '\n';
  }
  if (areas.empty()) return;
  if (areas.size() > scene.areas.size()) {
    out << "       " << fixed(areas.areas_m2().back(), 2) << " m2 of the floor ("
        << fixed(100.0 * areas.areas_m2().back() / scene.floor.area_m2(), 1) << " %) in no area: people there are in "
        << column_of_area(elsewhere) << '\n';
  }
  std::vector<std::string> astray;
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    if (!areas.of_sensors()[i]) astray.push_back(scene.sensors[i].id);
  }
  if (!astray.empty())
    out << "       of no area: " << (astray.size() == 1 ? "sensor " : "sensors ") << named(astray, 0) << '\n';
}

std::string habit_in_words(const DoorSpec& door) {
  if (door.state == DoorState::open) return "always open";
  if (door.state == DoorState::shut) return "shut behind whoever goes through";
  return "shut after " + percent(door.shut_share) + " of passes, else open for " + fixed(door.stands_open_s, 0) + " s";
}

/// What a leaf hides and to where it turns depends on all of this; where it leads is known by areas.
void print_doors(std::ostream& out, const SceneSpec& scene) {
  constexpr double away_m = 0.4;  // assumed: beyond a thick wall (0.3-0.6)
  const Areas areas(scene);
  const auto beside = [&](const DoorSpec& door, double ahead_m) {
    const Vec2 at = floor_point(door.world_from_door * Vec3(0, 0, -ahead_m));
    return scene.floor.contains(at) ? std::string(areas.name_at(at)) : "outside";
  };
  for (std::size_t i = 0; i < scene.doors.size(); ++i) {
    const DoorSpec& door = scene.doors[i];
    out << (i == 0 ? "doors: " : "       ") << door.id << ' ' << fixed(door.width_m, 2) << " x "
        << fixed(door.height_m, 2) << " m, ";
    if (!areas.empty()) out << "from " << beside(door, -away_m) << " to " << beside(door, away_m) << ", ";
    out << "hinge " << word_of(door.hinge) << ", opens " << word_of(door.opens) << ", " << habit_in_words(door) << '\n';
  }
}

/// Rows of 0.1 were those of zones: who runs an older script should know that its rows are others now.
void print_response(std::ostream& out, const Model& model) {
  const SceneSpec& scene = model.scene();
  const SensingSpec& sensing = model.script().sensing;
  if (scene.sensors.empty()) return;
  out << "response of the sensors: " << responses_in_words(scene, sensing) << '\n';
  const bool is_any_analog = std::ranges::any_of(
      scene.sensors, [&](const SensorSpec& sensor) { return response_of(scene, sensing, sensor) == Response::analog; });
  if (!sensing.response && is_any_analog)
    out << "  note: sensors answer by the analog response (since 0.2; 0.1 used zones: --response zones)\n";
}

/// "'reader'", or who is watched where the script has nobody work.
std::string in_words(const Worker& worker) {
  return worker.person.id.empty() ? "somebody of natural style" : "'" + worker.person.id + "'";
}

void print_study(std::ostream& out, const Model& model, const CheckReport& report, const Worker& worker) {
  const SceneSpec& scene = model.compiled().scene();
  const ScriptSpec& script = model.script();
  out << scene.name << ": " << counted(scene.meshes.size(), "mesh", "meshes") << ", "
      << counted(scene.sensors.size(), "sensor") << ", " << counted(scene.seats.size(), "seat") << ", "
      << (scene.places.empty() ? "" : counted(scene.places.size(), "place") + ", ")
      << counted(scene.entrances.size(), "entrance")
      << (scene.doors.empty() ? "" : ", " + counted(scene.doors.size(), "door")) << ", floor "
      << fixed(scene.floor.area_m2(), 2) << " m2\n";
  out << script.name << ": " << counted(script.trials.size(), "trial") << " x "
      << counted(static_cast<std::size_t>(script.replicates), "replicate") << " = " << counted(model.n_runs(), "run")
      << '\n';
  print_areas(out, model.scene());
  print_doors(out, model.scene());
  print_response(out, model);
  out << '\n';
  if (!script.trials.empty() && script.trials.front().schedule) {
    if (script.trials.front().schedule->household) {
      print(out, home_outlook(model.compiled(), 0));
    } else {
      print(out, outlook(model.compiled(), 0), model.compiled());
    }
  }
  if (!script.trials.empty() && script.trials.front().occupancy)
    print_occupancy(out, *script.trials.front().occupancy, model.compiled().trials().front());
  if (!script.begin.empty() && !script.trials.empty()) print_times(out, model.compiled().trials().front());
  print(out, report.sight, scene);
  print(out, report.work, in_words(worker), model);
}

}  // namespace
}  // namespace studies

CheckReport check_study(const Model& model) {
  CheckReport report;
  report.sight = studies::look_around(model);
  const sim::CompiledStudy& study = model.compiled();
  const studies::Worker worker = studies::worker_of(study.trials());
  report.work =
      studies::watch_sitters({study.scene(), study.sensing(), study.array(), study.tracer(), study.seed()}, worker);
  std::ostringstream text;
  studies::print_study(text, model, report, worker);
  report.text = std::move(text).str();
  report.warnings = studies::warnings(report.sight, model.scene());
  for (Issue& warning : studies::warnings_of_home(study)) report.warnings.push_back(std::move(warning));
  return report;
}

}  // namespace pirsim
