// The sensors of a scene that answer physically: the power that each of their rays brings, and what their circuits make
// of it. The compiled part.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/body/ground.hpp"
#include "engine/body/seating.hpp"
#include "engine/body/skeleton.hpp"
#include "engine/effects/pipeline.hpp"
#include "engine/pir/analog_circuit.hpp"
#include "engine/pir/optics.hpp"
#include "engine/pir/zone_motion.hpp"
#include "engine/rt/room.hpp"
#include "engine/rt/tracer.hpp"
#include "engine/study/study_in_force.hpp"
#include "model/schema/check_scene.hpp"
#include "pirsim/rays.hpp"

namespace pirsim::sim {

/// Power in whole steps of `watts_per_step`, as if every facet had the aperture of its lens' first step: sums don't
/// depend on their order, so that no tracer and no memory changes a bit, what cancels is zero, and swapped polarity is
/// a changed sign. Good for half a watt; one ray on a person is some 1e9 steps.
using PowerSteps = std::int64_t;
inline constexpr double watts_per_step = 0x1p-64;

/// Radiance of each of a person's parts, W m^-2 sr^-1.
using BodyRadiance = std::array<double, body::n_parts>;

struct PersonModel;

/// The rays of analog sensors and what they are worth: optics alone, whatever the electronics. Sensors whose response
/// is `zones` have no rays here. Immutable.
///
/// A *receiver* is one lens step of one sensor. What each receives is kept apart: by how much the steps' apertures
/// differ follows from the electronics, and powers that were measured once serve any of them.
class PowerModel {
 public:
  /// like: a model whose lenses are shared where they are the same, or null.
  PowerModel(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room, const PowerModel* like);
  /// Of rays of which each is a receiver, and of other wavelengths than a PIR sensor's.
  PowerModel(pir::PowerRays rays, const pir::Band& band, const SceneSpec& scene, const SensingInForce& sensing,
             const rt::Room& room);

  [[nodiscard]] const pir::Band& band() const noexcept { return band_; }
  /// Of a person's parts, in this band.
  [[nodiscard]] BodyRadiance radiance_of(const PersonModel& person) const;
  [[nodiscard]] const pir::PowerRays& rays() const noexcept { return *rays_; }
  /// The rays cut at the room.
  [[nodiscard]] const RayBundle& clipped() const noexcept { return *clipped_; }
  [[nodiscard]] std::size_t n_receivers() const noexcept { return receivers_begin_.back(); }
  /// (n_sensors + 1) sensor s has the receivers [begin[s], begin[s + 1]), in ascending order of their lens steps.
  [[nodiscard]] const std::vector<std::uint32_t>& receivers_begin() const noexcept { return receivers_begin_; }
  [[nodiscard]] std::uint32_t receiver_of(std::uint32_t ray) const noexcept { return receivers_[ray]; }
  /// Of the room where the ray hits it, or of the surroundings; W m^-2 sr^-1.
  [[nodiscard]] double background(std::uint32_t ray) const noexcept { return backgrounds_[ray]; }
  /// What the receiver gets more because a ray ends on a surface of this radiance and not in the background.
  [[nodiscard]] PowerSteps power(std::uint32_t ray, double radiance) const noexcept {
    return static_cast<PowerSteps>(rays_->weights[ray] * (radiance - backgrounds_[ray]) / watts_per_step);
  }

 private:
  /// Cuts the rays at the room.
  void look_behind(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room);

  /// One make's rays, and what they follow from.
  struct Lens {
    SensorModelSpec model;  ///< as blurred as effects make it
    int rays_per_zone = 0;
    std::vector<pir::WeightedDirection> quadrature;
  };
  using Lenses = std::map<std::string, std::shared_ptr<const Lens>, std::less<>>;  ///< by the model's id
  [[nodiscard]] const Lens& lens(const SensorModelSpec& model, const SensingInForce& sensing, const PowerModel* like);

  pir::Band band_;
  double ambient_c_;
  Lenses lenses_;
  std::unique_ptr<pir::PowerRays> rays_;
  std::unique_ptr<RayBundle> clipped_;
  std::vector<std::uint32_t> receivers_begin_{0};  ///< (n_sensors + 1)
  std::vector<std::uint32_t> receivers_;           ///< (n_rays)
  std::vector<double> backgrounds_;                ///< (n_rays)
};

[[nodiscard]] BodyRadiance radiance_of(const WarmthSpec& warmth, double ambient_c, const pir::Band& band = {});
[[nodiscard]] BodyRadiance radiance_of(const PersonInForce& body, double ambient_c, const pir::Band& band = {});

/// One make of sensor, calibrated by its rated distances (pir::calibrate) through the lens as it was made: what blurs
/// it later leaves the gain as it is.
struct CalibratedSensor {
  SensorModelSpec model;
  double tick_s, gain;
  pir::AnalogCircuit detector;
  pir::AnalogFilter silent_filter;           ///< the detector's element and amplifier, without noise
  std::vector<double> rated_watts_per_step;  ///< (n_lens_steps) of power through facets with the step's own aperture
  std::vector<double> watts_per_step;        ///< the same times the gain

  /// powers: (n_lens_steps)
  [[nodiscard]] double watts(std::span<const PowerSteps> powers) const noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < powers.size(); ++i) sum += static_cast<double>(powers[i]) * watts_per_step[i];
    return sum;
  }
};

class AnalogModel {
 public:
  /// like: a model whose lenses and calibrated sensors are shared where they are the same, or null.
  AnalogModel(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room,
              const AnalogModel* like = nullptr);

  /// Is there any analog sensor?
  [[nodiscard]] static bool is_needed(const SceneSpec& scene, const SensingSpec& sensing);

  [[nodiscard]] const PowerModel& power() const noexcept { return *power_; }
  /// What one step of a receiver's power is worth with its own aperture.
  [[nodiscard]] double watts_per_step(std::size_t sensor, std::size_t receiver) const noexcept {
    return sensors_[sensor]->watts_per_step[receiver - power_->receivers_begin()[sensor]];
  }
  /// All that an analog sensor receives. powers: (n_receivers)
  [[nodiscard]] double watts(std::size_t sensor, std::span<const PowerSteps> powers) const noexcept {
    const std::vector<std::uint32_t>& begin = power_->receivers_begin();
    return sensors_[sensor]->watts(powers.subspan(begin[sensor], begin[sensor + 1] - begin[sensor]));
  }
  /// (n_sensors) null for a sensor that answers by its zones; of one make the same, of models made alike too.
  [[nodiscard]] const std::vector<std::shared_ptr<const CalibratedSensor>>& sensors() const noexcept {
    return sensors_;
  }

 private:
  std::vector<std::shared_ptr<const CalibratedSensor>> sensors_;
  std::unique_ptr<PowerModel> power_;
};

// All sensors of a scene, compiled once: rays, where the room ends them, and which of them form zones and channels.

/// What the optics show the detectors at one tick: the only thing that a detector knows of the room.
struct Exposure {
  ZoneSet zones;             ///< active
  ZoneSet channels;          ///< of zones, as SensorArray::channels() joins them
  std::vector<double> sums;  ///< (n_sensors) of the active zones' polarities; empty unless the array has polarity()
  std::vector<PowerSteps> powers;  ///< (PowerModel::n_receivers()); empty unless the array has analog()
};

/// Whose zones are looked at: of all sensors, for whoever wants to see them, or only of those that answer by them.
enum class ZonesOf { all_sensors, zone_sensors };

/// Immutable, shared by threads. Runs, recordings, coverage studies and walk tests trace these rays.
class SensorArray {
 public:
  /// like: an array of which what is the same in analog sensors is shared, or null.
  SensorArray(const SceneSpec& scene, const SensingInForce& sensing, std::shared_ptr<const rt::Room> room,
              const SensorArray* like = nullptr);
  SensorArray(const SensorArray&) = delete;
  SensorArray& operator=(const SensorArray&) = delete;

  [[nodiscard]] const rt::Room& room() const noexcept { return *room_; }
  [[nodiscard]] const std::shared_ptr<const rt::Room>& shared_room() const noexcept { return room_; }
  [[nodiscard]] const RayBundle& rated() const noexcept { return rated_; }  ///< rays at their rated ranges
  [[nodiscard]] const RayBundle& clipped() const noexcept {
    return clipped_;
  }  ///< the same, cut at the room, not at doors
  [[nodiscard]] std::size_t n_sensors() const noexcept { return clipped_.n_sensors(); }
  /// Zones joined as `change_per` says.
  [[nodiscard]] const pir::Channels& channels() const noexcept { return channels_; }
  /// Nested copies of every zone that stand for soft edges; 1: hard edges.
  [[nodiscard]] std::size_t n_levels() const noexcept { return n_levels_; }
  [[nodiscard]] const SoftEdgesSpec& soft_edges() const noexcept { return soft_edges_; }
  [[nodiscard]] int ticks_per_window() const noexcept { return ticks_per_window_; }
  [[nodiscard]] double tick_s() const noexcept { return tick_s_; }
  /// Replaces the detection of changes if an effect asks for it.
  [[nodiscard]] const std::optional<pir::PolarityFilter>& polarity() const noexcept { return polarity_; }
  /// (n_sensors) what comes behind the zones of a sensor that answers by them: its counting of pulses, hold and blind
  /// time. None if its output is on just while they change.
  [[nodiscard]] const std::vector<std::optional<pir::Comparator>>& zone_outputs() const noexcept {
    return zone_outputs_;
  }
  /// The sensors that answer physically, or null if none does.
  [[nodiscard]] const AnalogModel* analog() const noexcept { return analog_ ? &*analog_ : nullptr; }
  [[nodiscard]] bool is_analog(std::size_t sensor) const noexcept {
    return analog_ && analog_->sensors()[sensor] != nullptr;
  }

  [[nodiscard]] bool is_beam(std::size_t sensor) const noexcept { return beams_[sensor] != 0; }
  [[nodiscard]] bool has_beams() const noexcept { return std::ranges::find(beams_, std::uint8_t{1}) != beams_.end(); }
  /// Zones of beams that leaves break.
  [[nodiscard]] std::vector<std::uint32_t> broken_by(std::span<const LeafStep> steps) const;

  /// (n_doors) whose leaves hide what is behind them.
  [[nodiscard]] const std::vector<DoorLeaf>& leaves() const noexcept { return leaves_; }
  /// How far the rays go, of all sensors, while leaves stand so. steps: (n_doors).
  [[nodiscard]] std::vector<float> range(std::span<const LeafStep> steps) const;
  /// The same with leaves as before a run, and of the analog sensors' rays, if there are any.
  [[nodiscard]] const std::vector<float>& range() const noexcept { return rest_range_; }
  [[nodiscard]] const std::vector<float>& power_range() const noexcept { return rest_power_range_; }

  /// Sees no zones at all, and is null, if none are to be looked at.
  [[nodiscard]] std::unique_ptr<rt::Tracer> make_tracer(TracerKind kind, ZonesOf whose) const;
  /// Of the analog sensors' rays; only if there are any.
  [[nodiscard]] std::unique_ptr<rt::Tracer> make_power_tracer(TracerKind kind) const;

  /// Of an empty room.
  [[nodiscard]] Exposure unexposed() const;
  /// Fills in what follows from `zones`: channels and sums.
  void expose(Exposure& exposure) const noexcept;

 private:
  std::shared_ptr<const rt::Room> room_;
  SoftEdgesSpec soft_edges_;
  double tick_s_;
  std::size_t n_levels_;
  int ticks_per_window_;
  RayBundle rated_, clipped_;
  std::vector<std::uint8_t> beams_;  ///< (n_sensors) 1: answers as a beam does
  std::vector<DoorLeaf> leaves_;
  std::optional<rt::LeafCuts> cuts_;  ///< of clipped_; none without doors, as below
  /// Without the rays of analog sensors; only if there are analog sensors and others.
  std::optional<std::pair<RayBundle, RayBundle>> of_zone_sensors_;
  std::optional<rt::LeafCuts> zone_cuts_;  ///< of its second
  pir::Channels channels_;
  std::optional<pir::PolarityFilter> polarity_;
  std::vector<std::optional<pir::Comparator>> zone_outputs_;
  std::optional<AnalogModel> analog_;
  std::optional<rt::LeafCuts> power_cuts_;  ///< of its rays
  std::vector<float> rest_range_, rest_power_range_;
};

/// Without the rays of these zones, which stay in number.
[[nodiscard]] RayBundle without(const RayBundle& bundle, const ZoneSet& zones);

// A study compiled for running: what is behind a Model. Immutable, shared by all threads.

/// A seat as one person uses it.
struct SeatPlan {
  body::SeatPlace place;
  // Where to stand before sitting down: so far behind the pelvis point, along the seat's axis, and to its right.
  double stand_back_m = 0.0;
  double stand_aside_m = 0.0;
  double half_depth_m = 0.0;  ///< what one who stands there keeps clear of, before and behind

  /// world_from_seat: where the seat is now.
  [[nodiscard]] Vec2 stand(const Frame& world_from_seat, double more_back_m = 0.0) const {
    const Vec2 facing = direction_of(heading_of(world_from_seat) + place.approach_turn);
    const Vec2 stand = floor_point(world_from_seat.origin) - (stand_back_m + more_back_m) * facing;
    return stand_aside_m == 0.0 ? stand : stand + stand_aside_m * Vec2(-facing.y, facing.x);
  }
};

/// A place to lie as one person uses it.
struct LyingPlan {
  body::LyingPlace bed;
  SeatPlan edge;  ///< its place is that of the bed
};

/// Where people wait and come into being who come in by it.
[[nodiscard]] inline Vec2 outside_of(const EntranceSpec& door) {
  return floor_point(door.world_from_entrance * Vec3(0, 0, door.outside_m));
}

/// Where a pet may get onto, from the floor before it.
struct Perch {
  std::string id;  ///< of the seat or the place
  Vec2 before{0.0};
  Vec3 top{0.0};
};
/// Where a pet gets to.
struct Haunts {
  Vec2 home{0.0};  ///< on the part of the floor that it never leaves
  std::vector<Perch> perches;
};

/// One person of one trial, or a pet.
struct PersonModel {
  PersonInForce spec;
  body::Humanoid humanoid;
  std::shared_ptr<const body::WalkableFloor> floor;  ///< shared by all who need the same clearance
  /// For squeezing past others with the arms drawn in; null for who is alone.
  std::shared_ptr<const body::WalkableFloor> narrow_floor{};
  /// Is there room to stand, facing so, with the clearance radius to the sides and half_depth_m before and behind?
  [[nodiscard]] bool can_stand(const Vec2& place, const Vec2& facing, double half_depth_m) const noexcept;
  /// By seat, of those that the script asks for; of all that can be reached if any seat may do.
  std::map<std::string, SeatPlan, std::less<>> seats{};
  std::map<std::string, LyingPlan, std::less<>> beds{};  ///< by place, of those that the script asks for
  [[nodiscard]] bool can_use(std::string_view seat) const { return seats.contains(seat); }
  [[nodiscard]] const SeatPlan& seat_plan(std::string_view seat) const { return seats.find(seat)->second; }
  BodyRadiance radiance{};
  Haunts haunts{};  ///< of a pet
};

using TrialModel = TrialOf<PersonModel>;

class ThermalArray;

class CompiledStudy {
 public:
  /// What is the same in `like` is shared instead of made anew, which changes nothing but the time it takes. Throws as
  /// compile() does.
  CompiledStudy(SceneSpec scene, ScriptSpec script, TracerKind tracer, const CompiledStudy* like);

  /// As a user gave them.
  [[nodiscard]] const SceneSpec& scene_given() const noexcept { return scene_given_; }
  [[nodiscard]] const ScriptSpec& script_given() const noexcept { return script_given_; }

  // As the effects left it: in force for everything that runs.
  [[nodiscard]] const SceneSpec& scene() const noexcept { return scene_; }
  [[nodiscard]] const Areas& areas() const noexcept { return areas_; }
  [[nodiscard]] const SensingInForce& sensing() const noexcept { return sensing_; }
  [[nodiscard]] std::uint64_t seed() const noexcept { return seed_; }
  [[nodiscard]] double tick_s() const noexcept { return 1.0 / sensing_.tick_rate_hz; }
  [[nodiscard]] const std::vector<TrialModel>& trials() const noexcept { return *trials_; }
  /// Do people do the same in every run that both have? True only if one was compiled like the other.
  [[nodiscard]] bool moves_people_as(const CompiledStudy& other) const noexcept { return trials_ == other.trials_; }
  [[nodiscard]] const SensorArray& array() const noexcept { return *array_; }
  /// (n_arrays) the scene's thermopile arrays.
  [[nodiscard]] const std::vector<std::shared_ptr<const ThermalArray>>& arrays() const noexcept { return arrays_; }
  [[nodiscard]] TracerKind tracer() const noexcept { return tracer_; }
  /// What the effects do to triggers and rows, before any run.
  [[nodiscard]] const effects::Pipeline& stages() const noexcept { return stages_; }

  /// Runs are numbered replicate by replicate, trials in order within each.
  [[nodiscard]] std::uint32_t n_runs() const noexcept;
  [[nodiscard]] const TrialModel& trial_of(std::uint32_t run) const noexcept { return trials()[run % trials().size()]; }
  [[nodiscard]] int replicate_of(std::uint32_t run) const noexcept {
    return static_cast<int>(run / trials().size()) + 1;
  }
  /// Where a run of a trial with an occupancy begins, in the seconds of its data: replicates take the days in turn.
  [[nodiscard]] double data_second_of(std::uint32_t run) const noexcept;
  /// Replicates of a schedule are days that follow each other, those of an occupancy the days of its data; all others
  /// begin at the same time.
  [[nodiscard]] std::optional<RunClock> clock_of(std::uint32_t run) const noexcept;

 private:
  CompiledStudy(SceneSpec scene, ScriptSpec script, StudyInForce study, TracerKind tracer, const CompiledStudy* like);

  SceneSpec scene_given_;
  ScriptSpec script_given_;
  SceneSpec scene_;
  Areas areas_;
  SensingInForce sensing_;
  std::uint64_t seed_;
  TracerKind tracer_;
  std::unique_ptr<const SensorArray> array_;
  std::vector<std::shared_ptr<const ThermalArray>> arrays_;
  effects::Pipeline stages_;
  std::shared_ptr<const std::vector<TrialModel>> trials_;
};

}  // namespace pirsim::sim
