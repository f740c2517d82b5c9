#include "surveys/sight.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <optional>
#include <ranges>
#include <sstream>
#include <utility>

#include "engine/body/motion.hpp"
#include "engine/body/seating.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/natural_motion.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/plan_people.hpp"
#include "engine/sim/run_state.hpp"
#include "engine/sim/schedule.hpp"
#include "engine/sim/thermal_array.hpp"
#include "model/core/error.hpp"
#include "model/core/parallel.hpp"
#include "model/core/text.hpp"
#include "model/geom/floor.hpp"
#include "model/schema/actions.hpp"
#include "model/schema/check_scene.hpp"

// A zone, or a cluster of zones, is on or off. Where legs and trunk fill a cluster for as long as somebody sits, arms
// that move in it change nothing: the sensor sees the sitter and is deaf to the work. So that one rule serves every
// response, nothing is concluded from zones: somebody works in the seat, and the detectors tell.

namespace pirsim::studies {
namespace {

// Acts of natural style come at random, 22 shifts and fidgets in a quarter of an hour. The metronome's work repeats:
// three tilts of the trunk, half a minute each.
constexpr int natural_work_s = 900, choreographed_work_s = 300;
constexpr double reach_s = 5.0;  // assumed: longer than the hands take to the table, which isn't asked about
constexpr std::size_t most_seats = 30, most_pairs = 600;  // of seats and sensors: some ten seconds of one core
constexpr std::size_t most_remembered = 1024;             // the metronome's work has some 600 postures

/// A seat or a place, and what somebody does there.
struct Spot {
  enum class Doing { work, other } doing = Doing::work;
  std::string id;
  body::Motion motion;                 ///< settled there
  std::optional<Activity> activity{};  ///< of natural style, unless it is work
};

/// What residents do there, by the first use of its mark.
std::optional<Activity> activity_for(const std::string& use) {
  for (std::size_t i = 0; i < sim::n_home_activities; ++i) {
    const sim::HomeManner manner = sim::manner_of(static_cast<sim::HomeActivity>(i));
    if (std::ranges::find(manner.uses, use) != manner.uses.end()) return manner.activity;
  }
  return std::nullopt;
}

/// Lying on the back, or on the feet; none if the person can't get onto a bed of its height.
std::optional<body::Motion> settled(const body::Humanoid& humanoid, const PlaceSpec& place, double floor_y,
                                    double tick_s) {
  const double heading = heading_of(place.world_from_place);
  if (place.posture == PlacePosture::stand)
    return body::Motion(humanoid, floor_point(place.world_from_place.origin), heading, floor_y, tick_s);
  body::SeatPlace edge{{rotation_from_heading(heading + 0.5 * pi), place.world_from_place.origin}, floor_y, {}};
  edge.world_from_seat.origin.y += body::edge_height_m(humanoid);
  if (body::unfit_height(humanoid, edge)) return std::nullopt;
  body::Motion motion = seated(humanoid, edge, tick_s);
  motion.lie_down({place.world_from_place, edge});
  while (motion.stage() != body::Stage::lying || !motion.settled()) motion.advance();
  return motion;
}

/// The worker's body, tick by tick, as in a run.
class WatchedBody {
 public:
  WatchedBody(const WatchedRoom& room, const Worker& worker, const Spot& spot)
      : work_(worker.work),
        activity_(spot.doing == Spot::Doing::work ? facts_of(worker.work).activity : spot.activity),
        motion_(spot.motion),
        restlessness_(worker.person.changes, room.seed, 0, 0, room.array.tick_s()),
        tilt_ticks_(std::max<std::int64_t>(1, std::llround(work_.tilt_every_s / room.array.tick_s()))) {
    const bool is_natural = worker.person.style == MotionStyle::natural || spot.doing == Spot::Doing::other;
    if (is_natural) natural_.emplace(room.seed, 0, 0, room.sensing.tick_rate_hz);
    if (spot.doing == Spot::Doing::work) motion_.work({is_natural ? 0.0 : work_.arm_amplitude_m, work_.arm_period_s});
  }

  void advance() {
    const std::vector<double>& tilts_deg = work_.tilt_choices_deg;
    if (natural_) {
      natural_->tick(motion_, activity_, {});
    } else if (!tilts_deg.empty() && tick_ % tilt_ticks_ == 0) {
      motion_.tilt_spine(radians(tilts_deg[static_cast<std::size_t>(tick_ / tilt_ticks_) % tilts_deg.size()]));
    }
    if (restlessness_.acts() && motion_.stage() == body::Stage::seated)
      restlessness_.tick(motion_, natural_ ? nullptr : &work_);
    motion_.advance();
    ++tick_;
  }
  [[nodiscard]] body::Outline outline() const noexcept { return motion_.outline(); }

 private:
  action::Work work_;
  std::optional<Activity> activity_;
  body::Motion motion_;
  std::optional<sim::NaturalMotion> natural_;
  sim::Restlessness restlessness_;
  std::int64_t tilt_ticks_, tick_ = 0;
};

/// What the optics show of one body's postures, with those that it was in before.
class PostureView {
 public:
  PostureView(const WatchedRoom& room, const Worker& worker, const body::Humanoid& humanoid)
      : room_(room),
        humanoid_(humanoid),
        radiance_(sim::radiance_of(worker.person.warmth, room.sensing.ambient_c)),
        observer_(room.array, room.tracer, sim::ZonesOf::all_sensors) {
    known_.make_room_for(1);
  }

  /// Valid until the next call.
  const sim::Exposure& of(const body::Outline& outline) {
    if (const auto number = known_.find(0, 0, outline); number != 0) return exposures_[number - 1];
    if (exposures_.size() == most_remembered) {
      known_.forget_all();
      exposures_.clear();
    }
    known_.remember(0);
    exposures_.push_back(room_.array.unexposed());
    observer_.look(mannequin_.pose(humanoid_, outline), radiance_, exposures_.back());
    return exposures_.back();
  }

 private:
  const WatchedRoom& room_;
  const body::Humanoid& humanoid_;
  sim::BodyRadiance radiance_;
  sim::Observer observer_;
  sim::Mannequin mannequin_;
  sim::PostureIndex known_;
  std::vector<sim::Exposure> exposures_;
};

/// Channels that saw the body at some tick, and at every tick.
class SeenChannels {
 public:
  explicit SeenChannels(const ZoneSet& channels) : ever_(channels), always_(channels) {}

  void add(const ZoneSet& channels) noexcept {
    ever_.add(channels.words());
    for (std::size_t i = 0; i < always_.words().size(); ++i) always_.words()[i] &= channels.words()[i];
  }
  /// Of the channels [begin, end).
  void count(std::size_t begin, std::size_t end, WorkNotice& notice) const noexcept {
    for (std::size_t i = begin; i < end; ++i) {
      notice.channels += ever_.test(i) ? 1 : 0;
      notice.for_good += always_.test(i) ? 1 : 0;
    }
  }

 private:
  ZoneSet ever_, always_;
};

/// A sensor's channels; of soft edges the first copy, which is the zone as it is with hard edges.
std::pair<std::size_t, std::size_t> channels_of(const WatchedRoom& room, std::size_t sensor) {
  const RayBundle& rays = room.array.rated();
  std::size_t begin = rays.sensor_clusters_begin[sensor], end = rays.sensor_clusters_begin[sensor + 1];
  if (room.sensing.change_per == ChangePer::beam) {
    begin = rays.cluster_zones_begin[begin];
    end = rays.cluster_zones_begin[end];
  }
  return {begin, begin + (end - begin) / room.array.n_levels()};
}

/// (n_sensors)
std::vector<WorkNotice> watch(const WatchedRoom& room, const Worker& worker, int work_s, const body::Humanoid& humanoid,
                              const Spot& spot) {
  WatchedBody body(room, worker, spot);
  const int rate = room.sensing.tick_rate_hz;
  for (int tick = 0; tick < reach_s * rate; ++tick) body.advance();
  PostureView view(room, worker, humanoid);
  body::Outline outline = body.outline();
  sim::Exposure before = view.of(outline), after = before;
  SeenChannels coverage(before.channels);
  sim::Detector detector(room.array);
  detector.begin_run(room.seed, 0, before);
  std::vector<std::uint8_t> triggers(room.array.n_sensors()), noticed(room.array.n_sensors());
  std::vector<WorkNotice> notices(room.array.n_sensors());
  for (int second = 0; second < work_s; ++second) {
    std::ranges::fill(noticed, std::uint8_t{0});
    for (int tick = 0; tick < rate; ++tick) {
      body.advance();
      if (const body::Outline now = body.outline(); now == outline) {
        detector.tick_unchanged(after, triggers);
      } else {
        outline = now;
        std::swap(before, after);
        after = view.of(outline);
        coverage.add(after.channels);
        detector.tick(before, after, triggers);
      }
      for (std::size_t i = 0; i < triggers.size(); ++i)
        noticed[i] |= static_cast<std::uint8_t>(triggers[i] & pir::output_on);
    }
    for (std::size_t i = 0; i < noticed.size(); ++i) notices[i].seconds += noticed[i];
  }
  for (std::size_t i = 0; i < notices.size(); ++i) {
    const auto [begin, end] = channels_of(room, i);
    coverage.count(begin, end, notices[i]);
  }
  return notices;
}

constexpr double beside_m = 0.5;  // assumed: a sensor on the far side of a wall isn't nearer (tried 0.3-1)
constexpr double buried_m = 0.5;  // assumed: 0.3 to 1 m would do; walls are thinner, and nobody comes so near

/// Traces single postures and tells which sensors have an active zone.
class Onlooker {
 public:
  Onlooker(const Model& model, const body::Humanoid& humanoid)
      : rays_(model.compiled().array().rated()),
        humanoid_(humanoid),
        tracer_(model.compiled().array().make_tracer(model.compiled().tracer(), sim::ZonesOf::all_sensors)) {
    for (const auto& array : model.compiled().arrays()) {
      watches_.emplace_back(*array, model.compiled().tracer());
      radiances_.push_back(sim::radiance_of(WarmthSpec{}, model.compiled().sensing().ambient_c, array->band()));
      contrasts_k_.emplace_back();
    }
  }

  /// (n_sensors + n_arrays) whether the sensor sees the posture.
  std::vector<bool> sensors_that_see(const body::Posture& posture) {
    std::vector<PosedShape> solids;
    for (std::size_t i = 0; i < body::n_parts; ++i) solids.push_back(place(humanoid_.solids()[i], posture[i]));
    ZoneSet zones(rays_.n_zones());
    tracer_->add(0, solids, zones);
    std::vector<bool> seen;
    for (std::size_t sensor = 0; sensor < rays_.n_sensors(); ++sensor) {
      const auto first = rays_.cluster_zones_begin[rays_.sensor_clusters_begin[sensor]];
      const auto last = rays_.cluster_zones_begin[rays_.sensor_clusters_begin[sensor + 1]];
      seen.push_back(std::ranges::any_of(std::views::iota(first, last), [&](auto zone) { return zones.test(zone); }));
    }
    for (std::size_t i = 0; i < watches_.size(); ++i) {
      const sim::ArrayWatch::Contrast contrast = watches_[i].look(solids, radiances_[i]);
      seen.push_back(contrast.is_seen());
      if (contrast.is_seen()) contrasts_k_[i].push_back(contrast.kelvin);
    }
    return seen;
  }
  /// (n_arrays) of the postures that each has seen so far, K.
  [[nodiscard]] const std::vector<std::vector<double>>& contrasts_k() const noexcept { return contrasts_k_; }

 private:
  const RayBundle& rays_;
  const body::Humanoid& humanoid_;
  std::unique_ptr<rt::Tracer> tracer_;
  std::vector<sim::ArrayWatch> watches_;  ///< (n_arrays), as the others
  std::vector<sim::BodyRadiance> radiances_;
  std::vector<std::vector<double>> contrasts_k_;
};

/// "8 x 8 pixels, 0.16 K a reading in the middle; a person at rest changes the pixel that shows it best by 0.5 to 5.1
/// K"
std::string about(const sim::ThermalArray& array, std::vector<double> contrasts_k) {
  const ArraySpec& spec = array.spec();
  const auto middle = static_cast<std::size_t>((spec.rows / 2) * spec.columns + spec.columns / 2);
  std::string text = std::to_string(spec.columns) + " x " + std::to_string(spec.rows) + " pixels, noise " +
                     fixed(array.noise_k(middle), 2) + " K in the middle";
  if (contrasts_k.empty()) return text;
  const auto [least, most] = std::ranges::minmax(contrasts_k);
  return text + "; a person at rest changes the pixel that shows it best by " + fixed(least, 2) + " to " +
         fixed(most, 2) + " K where it sees one (3 times the noise)";
}

body::Posture seated_posture(const Model& model, const body::Humanoid& humanoid, const SeatSpec& seat) {
  try {
    return seated(humanoid, {seat.world_from_seat, model.scene().floor.height_m(), std::nullopt}, model.tick_s())
        .posture();
  } catch (const Error& fault) {  // the body knows no names
    throw Error(fault.code(), Where{model.scene().name}, "seat '" + seat.id + "': " + fault.issues().front().message);
  }
}

void count_rays(const Model& model, std::size_t sensor, SensorSight& sight) {
  const RayBundle& rated = model.compiled().array().rated();
  const RayBundle& clipped = model.rays();
  const auto ray_of_cluster = [&](std::uint32_t cluster) {
    return rated.zone_rays_begin[rated.cluster_zones_begin[cluster]];
  };
  const auto first = ray_of_cluster(rated.sensor_clusters_begin[sensor]);
  const auto last = ray_of_cluster(rated.sensor_clusters_begin[sensor + 1]);
  sight.rays = last - first;
  for (auto ray = first; ray < last; ++ray) {
    if (clipped.range[ray] < rated.range[ray]) ++sight.rays_cut;
    sight.longest_m = std::max(sight.longest_m, static_cast<double>(clipped.range[ray]));
  }
}

/// Was the scene told to be in another unit than metres? Then that is why.
bool is_told_of_unit(const SceneSpec& scene) {
  const auto doubt = doubt_of_unit(scene);
  return doubt &&
         std::ranges::any_of(scene.warnings, [&](const Issue& told) { return told.message.ends_with(*doubt); });
}

void note_blind(const SensorSight& sight, const std::string& scene, GroupedWarnings& warnings) {
  const std::string name = "sensor '" + sight.sensor + "'", blind = name + " can see NOBODY: ";
  if (!sight.outside.empty()) return warnings.add("outside", {scene, 0, 0}, name, blind + sight.outside);
  if (sight.rays > 0 && sight.longest_m < buried_m) {
    return warnings.add("buried", {scene, 0, 0}, name,
                        blind + "all of its rays end within " +
                            std::to_string(std::lround(std::ceil(100.0 * sight.longest_m))) +
                            " cm (is it inside a wall, or right before one?)");
  }
  warnings.add("astray", {scene, 0, 0}, name,
               blind +
                   "no zone reaches a standing or seated person anywhere on the floor area (does it look at a "
                   "wall, along -Z of its node?)");
}

}  // namespace

WatchedRoom room_of(const sim::CompiledStudy& study) {
  return {study.scene(), study.sensing(), study.array(), study.tracer()};
}

Worker usual_worker() {
  Worker worker;
  worker.person.style = MotionStyle::natural;
  return worker;
}

Worker worker_of(std::span<const sim::TrialModel> trials) {
  for (const sim::TrialModel& trial : trials) {
    for (const sim::PersonModel& person : trial.people) {
      for (const ScriptedAction& action : person.spec.actions) {
        const auto* work = std::get_if<action::Work>(&action.what);
        if (work == nullptr) continue;
        Worker worker{person.spec, *work};
        worker.person.body_meshes.clear();
        return worker;
      }
    }
  }
  return usual_worker();
}

WorkReport watch_sitters(const WatchedRoom& room, const Worker& worker, unsigned threads, SeatsTried tried) {
  const Worker usual = usual_worker();  // who rests there, and so the same in every survey
  const body::Humanoid humanoid(worker.person), usual_humanoid(usual.person);
  const double floor_y = room.scene.floor.height_m(), tick_s = room.array.tick_s();
  const std::size_t n_seats = room.scene.seats.size(), n_all = n_seats + room.scene.places.size();
  WorkReport report;
  report.seconds = worker.person.style == MotionStyle::natural ? natural_work_s : choreographed_work_s;
  std::vector<Spot> spots;
  const std::size_t most =
      tried == SeatsTried::all
          ? n_all
          : std::clamp<std::size_t>(most_pairs / std::max<std::size_t>(1, room.scene.sensors.size()), 1, most_seats);
  for (std::size_t i = 0, n = std::min(n_all, most); i < n; ++i) {
    const std::size_t which = i * n_all / n;
    if (which >= n_seats) {
      const PlaceSpec& place = room.scene.places[which - n_seats];
      std::optional<body::Motion> motion = settled(usual_humanoid, place, floor_y, tick_s);
      if (!motion) continue;
      const auto activity = place.uses.empty() ? std::nullopt : activity_for(place.uses.front());
      spots.push_back({Spot::Doing::other, place.id, std::move(*motion), activity});
      continue;
    }
    const SeatSpec& seat = room.scene.seats[which];
    const body::SeatPlace place{seat.world_from_seat, floor_y, sim::table_height(seat, floor_y, room.array.room())};
    const bool is_for_work = seat.uses.empty() || std::ranges::find(seat.uses, "work") != seat.uses.end();
    const body::Humanoid& who = is_for_work ? humanoid : usual_humanoid;
    if (body::unfit_height(who, place)) continue;
    spots.push_back({is_for_work ? Spot::Doing::work : Spot::Doing::other, seat.id, seated(who, place, tick_s),
                     is_for_work ? std::nullopt : activity_for(seat.uses.front())});
  }
  for (const Spot& spot : spots) report.seats.push_back(spot.id);
  ordered_parallel<std::vector<WorkNotice>>(
      spots.size(), threads,
      [&](std::size_t i) {
        return spots[i].doing == Spot::Doing::work ? watch(room, worker, report.seconds, humanoid, spots[i])
                                                   : watch(room, usual, natural_work_s, usual_humanoid, spots[i]);
      },
      [&](std::vector<WorkNotice>& of_seat) {
        report.notices.insert(report.notices.end(), of_seat.begin(), of_seat.end());
      });
  return report;
}

body::Motion seated(const body::Humanoid& humanoid, const body::SeatPlace& place, double tick_s) {
  const double heading = heading_of(place.world_from_seat);
  const Vec2 stand =
      floor_point(place.world_from_seat.origin) + body::fall_back_m(humanoid, place) * direction_of(heading);
  body::Motion motion(humanoid, stand, heading, place.floor_height_m, tick_s);
  motion.sit_down(place);
  while (!(motion.stage() == body::Stage::seated && motion.settled())) motion.advance();
  return motion;
}

SightReport look_around(const Model& model) {
  const SceneSpec& scene = model.compiled().scene();
  const auto& people = model.compiled().trials().front().people;
  const body::Humanoid humanoid(people.empty() ? PersonInForce{} : people.front().spec);
  const body::WalkableFloor floor(scene.floor, {}, scene.meshes, humanoid.clearance_radius_m());
  Onlooker onlooker(model, humanoid);

  const Areas areas(scene);
  SightReport report;
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    SensorSight& sight = report.sensors.emplace_back();
    sight.sensor = scene.sensors[i].id;
    if (areas.of_sensors()[i]) sight.area = areas.name_of_sensor(i);
    sight.outside = hangs_outside(scene.floor, scene.sensors[i].world_from_sensor.origin);
    sight.is_beam = model.compiled().array().is_beam(i);
    count_rays(model, i, sight);
  }
  for (std::size_t i = 0; i < scene.arrays.size(); ++i) {
    SensorSight& sight = report.sensors.emplace_back();
    sight.sensor = scene.arrays[i].id;
    sight.outside = hangs_outside(scene.floor, scene.arrays[i].world_from_sensor.origin);
    const RayBundle& rays = model.compiled().arrays()[i]->power().clipped();
    sight.rays = rays.rays.size();
    for (const float range : rays.range) {
      sight.rays_cut += range < pir::out_of_sight_m ? 1 : 0;
      sight.longest_m = std::max(sight.longest_m, static_cast<double>(range));
    }
  }
  const Vec2 lower = scene.floor.lower(), upper = scene.floor.upper();
  for (double z = lower.y + report.spacing_m / 2; z < upper.y; z += report.spacing_m) {
    for (double x = lower.x + report.spacing_m / 2; x < upper.x; x += report.spacing_m) {
      if (!scene.floor.contains({x, z}) || !floor.walkable({x, z})) continue;
      const body::Motion standing(humanoid, {x, z}, 0.0, scene.floor.height_m(), model.tick_s());
      const std::vector<bool> seen = onlooker.sensors_that_see(standing.posture());
      ++report.places;
      if (std::ranges::find(seen, true) != seen.end()) ++report.places_seen_by_any;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        SensorSight& sight = report.sensors[i];
        const std::size_t one = seen[i] ? 1 : 0;
        sight.places += one;
        if (sight.area.empty() || areas.name_at({x, z}) != sight.area) continue;
        ++sight.area_places;
        sight.area_seen += one;
      }
    }
  }
  for (const SeatSpec& seat : scene.seats) {
    const std::vector<bool> seen = onlooker.sensors_that_see(seated_posture(model, humanoid, seat));
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i]) report.sensors[i].seats.push_back(seat.id);
    }
  }
  for (std::size_t i = 0; i < scene.arrays.size(); ++i)
    report.sensors[scene.sensors.size() + i].about = about(*model.compiled().arrays()[i], onlooker.contrasts_k()[i]);
  return report;
}

namespace {

/// A sensor's hold would last into the next pass; noise isn't the pet.
SceneSpec to_watch_pets(SceneSpec scene) {
  for (auto& [id, model] : scene.sensor_models) {
    model.detector.report = {};
    model.detector.amplifier.noise_v_pp = 0.0;
  }
  for (DoorSpec& door : scene.doors) door.state = DoorState::open;
  return scene;
}

PetSight watch_pet(const Model& model, const SceneSpec& scene, const PetSpec& pet) {
  constexpr double watched_s = 86400.0, shortest_m = 1.0, pause_s = 0.5;  // assumed
  ScriptSpec script = model.script();
  script.begin.clear();
  script.summary = {};
  script.effects.clear();
  script.replicates = 1;
  script.trials = {{.id = pet.id, .people = {}, .duration_s = watched_s, .pets = {pet}}};
  const Model alone = compile(scene, std::move(script), {.like = &model});
  const sim::CompiledStudy& study = alone.compiled();
  const sim::SensorArray& array = study.array();
  sim::RunState state(study, 0);
  sim::Observer observer(array, study.tracer(), sim::ZonesOf::zone_sensors);
  sim::Detector detector(array);
  sim::Exposure before = array.unexposed(), after = before;
  std::vector<std::uint8_t> triggers(array.n_sensors()), seen;
  PetSight sight{pet.id, 0, std::vector<std::size_t>(array.n_sensors(), 0)};
  const auto pause_ticks = static_cast<int>(pause_s / alone.tick_s());
  double way_m = 0.0;
  int still = pause_ticks;
  std::optional<Vec2> at;
  while (!state.finished) {
    sim::move_tick(study, state);
    const Vec2 now = state.crowd.actors().front().motion().position();
    const double step_m = at ? glm::length(now - *at) : 0.0;
    at = now;
    if (still >= pause_ticks) {
      if (step_m == 0.0) continue;
      observer.look(state.crowd.actors(), state.crowd.doors().steps(), before);
      detector.begin_run(study.seed(), static_cast<std::uint32_t>(sight.passes), before);
      seen.assign(array.n_sensors(), 0);
      way_m = 0.0;
    }
    way_m += step_m;
    still = step_m > 0.0 ? 0 : still + 1;
    observer.look(state.crowd.actors(), state.crowd.doors().steps(), after);
    detector.tick(before, after, triggers);
    std::swap(before, after);
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] |= static_cast<std::uint8_t>(triggers[i] & pir::output_on);
    if (still < pause_ticks || way_m < shortest_m) continue;
    ++sight.passes;
    for (std::size_t i = 0; i < seen.size(); ++i) sight.seen[i] += seen[i];
  }
  return sight;
}

}  // namespace

std::vector<PetSight> watch_pets(const Model& model) {
  std::vector<PetSight> all;
  const std::vector<TrialSpec>& trials = model.script().trials;
  if (trials.empty() || trials.front().pets.empty()) return all;
  const SceneSpec scene = to_watch_pets(model.scene());
  for (const PetSpec& pet : trials.front().pets) all.push_back(watch_pet(model, scene, pet));
  return all;
}

std::string hangs_outside(const FloorArea& floor, const Vec3& place) {
  const Vec2 below = floor_point(place);
  const double away_m = distance_to_edge_m(floor, below);
  if (floor.contains(below) || away_m <= beside_m) return {};
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << away_m;
  return "it hangs outside of the room, " + text.str() + " m from the floor's edge";
}

std::vector<Issue> warnings(const SightReport& report, const SceneSpec& scene) {
  constexpr double least_of_area = 0.1;  // assumed (0.05-0.2): a sensor in a corner sees more, one in a doorway too
  if (is_told_of_unit(scene)) return {};
  GroupedWarnings blind;
  bool is_any = false, ends_at_room = false;
  for (const SensorSight& sight : report.sensors) {
    if (sight.is_beam) continue;
    is_any = true;
    ends_at_room = ends_at_room || sight.rays_cut > 0;
    if (sight.sees_nothing()) {
      note_blind(sight, scene.name, blind);
    } else if (static_cast<double>(sight.area_seen) < least_of_area * static_cast<double>(sight.area_places)) {
      const std::string name = "sensor '" + sight.sensor + "'";
      blind.add("hidden", {scene.name, 0, 0}, name,
                name + " sees a standing person in " + std::to_string(sight.area_seen) + " of " +
                    counted(sight.area_places, "place") + " of its area '" + sight.area +
                    "' (is something before it?)");
    }
  }
  Diagnostics remarks;
  blind.tell(remarks);
  if (is_any && !ends_at_room) {
    remarks.warning({scene.name, 0, 0},
                    "no ray of any sensor ends at the room: without walls sensors see people outside, too");
  }
  return remarks.issues();
}

}  // namespace pirsim::studies

namespace pirsim {

SeatsAtWork WorkReport::by_any() const {
  SeatsAtWork result;
  const std::size_t n_sensors = seats.empty() ? 0 : notices.size() / seats.size();
  for (std::size_t i = 0; i < seats.size(); ++i) {
    const std::span of_seat = std::span(notices).subspan(i * n_sensors, n_sensors);
    const bool noticed = std::ranges::any_of(of_seat, [](const WorkNotice& notice) { return notice.seconds > 0; });
    const bool deaf = !noticed && std::ranges::any_of(of_seat, &WorkNotice::is_deaf);
    (noticed ? result.noticed : deaf ? result.deaf : result.unseen).push_back(seats[i]);
    if (std::ranges::any_of(of_seat, &WorkNotice::is_sure)) result.surely.push_back(seats[i]);
  }
  return result;
}

std::vector<std::string> WorkReport::deaf_seats(std::size_t sensor) const {
  std::vector<std::string> deaf;
  for (std::size_t i = 0; i < seats.size(); ++i) {
    if (notice(i, sensor).is_deaf()) deaf.push_back(seats[i]);
  }
  return deaf;
}

}  // namespace pirsim
