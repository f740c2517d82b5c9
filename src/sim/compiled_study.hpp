// A study compiled for running: what is behind a Model. Immutable, shared by all threads.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "body/humanoid.hpp"
#include "body/lying.hpp"
#include "body/seating.hpp"
#include "body/walkable_floor.hpp"
#include "effects/pipeline.hpp"
#include "schema/areas.hpp"
#include "schema/study_in_force.hpp"
#include "sim/analog_model.hpp"
#include "sim/sensor_array.hpp"

namespace pirsim::sim {

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

/// One person of one trial.
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
};

using TrialModel = TrialOf<PersonModel>;

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
  effects::Pipeline stages_;
  std::shared_ptr<const std::vector<TrialModel>> trials_;
};

}  // namespace pirsim::sim
