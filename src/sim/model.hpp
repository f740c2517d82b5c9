// A study compiled for running: everything immutable, shared by all threads.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "body/humanoid.hpp"
#include "body/motion.hpp"
#include "body/walkable_floor.hpp"
#include "pir/edge_draw.hpp"
#include "pir/motion_detector.hpp"
#include "pir/polarity_detector.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "rt/room.hpp"
#include "rt/tracer.hpp"
#include "sim/analog_model.hpp"

namespace pirsim {
namespace sim {
class Lookout;
}

/// A seat as one person uses it.
struct SeatPlan {
  body::SeatPlace place;
  double stand_back_m =
      0.0;  ///< where to stand before sitting down: so far behind the pelvis point, along the seat's axis
  double half_depth_m = 0.0;  ///< what one who stands there keeps clear of, before and behind
};

/// One person of one trial.
struct PersonModel {
  PersonSpec spec;
  body::Humanoid humanoid;
  std::shared_ptr<const body::WalkableFloor> floor;  ///< shared by all who need the same clearance
  /// Is there room to stand, facing so, with the clearance radius to the sides and half_depth_m before and behind?
  [[nodiscard]] bool can_stand(const Vec2& place, const Vec2& facing, double half_depth_m) const noexcept;
  std::vector<SeatPlan> seats;  ///< (n_actions) of the sit actions; empty plans for the others
  sim::BodyRadiance radiance{};
};

struct TrialModel {
  std::string id;
  std::vector<PersonModel> people;
};

class Model;

struct CompileOptions {
  rt::TracerKind tracer = rt::fastest_tracer;
  /// What is the same in this Model (the room, where people can go and what they do) is shared with the new one instead
  /// of made anew, which changes nothing but the time it takes.
  const Model* like = nullptr;
};

class Model {
 public:
  /// As the script's effects made it.
  [[nodiscard]] const SceneSpec& scene() const noexcept { return scene_; }
  /// As it was given, effects listed but not applied: what people do is in trials().
  [[nodiscard]] const ScriptSpec& script() const noexcept { return script_; }
  [[nodiscard]] const std::vector<TrialModel>& trials() const noexcept { return *trials_; }
  /// Do people do the same in every run that both have? True only if one was compiled like the other.
  [[nodiscard]] bool moves_people_as(const Model& other) const noexcept { return trials_ == other.trials_; }
  [[nodiscard]] const rt::Room& room() const noexcept { return *room_; }
  [[nodiscard]] const RayBundle& rated_rays() const noexcept { return *rated_; }
  [[nodiscard]] const RayBundle& clipped_rays() const noexcept { return *clipped_; }
  [[nodiscard]] rt::TracerKind tracer() const noexcept { return tracer_; }
  [[nodiscard]] double tick_s() const noexcept { return 1.0 / script_.sensing.tick_rate_hz; }

  /// Runs are numbered replicate by replicate, trials in order within each.
  [[nodiscard]] std::uint32_t n_runs() const noexcept;
  [[nodiscard]] const TrialModel& trial_of(std::uint32_t run) const noexcept { return trials()[run % trials().size()]; }
  [[nodiscard]] int replicate_of(std::uint32_t run) const noexcept {
    return static_cast<int>(run / trials().size()) + 1;
  }

  /// replicate, trial, time_s, phase, people, then one column a sensor.
  [[nodiscard]] std::vector<std::string> columns() const;
  /// Which channels of which sensors are watched for changes.
  [[nodiscard]] const pir::MotionDetector& detector() const noexcept { return *detector_; }
  /// Which of a channel's nested copies decide, before any run.
  [[nodiscard]] const pir::EdgeDraw& edge_draw() const noexcept { return edge_draw_; }
  /// Takes the place of the detector of changes, if the script's effects say so.
  [[nodiscard]] const std::optional<pir::PolarityDetector>& polarity() const noexcept { return polarity_; }
  /// What the script's effects do to triggers and rows, before any run.
  [[nodiscard]] const effects::Pipeline& pipeline() const noexcept { return pipeline_; }
  [[nodiscard]] std::unique_ptr<rt::Tracer> make_tracer() const;
  /// The sensors that answer physically, or null if none does.
  [[nodiscard]] const sim::AnalogModel* analog() const noexcept { return analog_.get(); }
  /// Of the analog sensors' rays; only if there are any.
  [[nodiscard]] std::unique_ptr<rt::Tracer> make_power_tracer() const;
  /// Of one's own for as long as one holds it; goes back, with what it remembers, for others to use. Safe to call from
  /// any thread.
  [[nodiscard]] std::shared_ptr<sim::Lookout> borrow_lookout() const;

 private:
  friend Model compile(SceneSpec scene, ScriptSpec script, const CompileOptions& options);
  SceneSpec scene_;
  ScriptSpec script_;
  std::shared_ptr<const std::vector<TrialModel>> trials_;
  std::shared_ptr<const rt::Room> room_;
  std::unique_ptr<RayBundle> rated_;
  std::unique_ptr<RayBundle> clipped_;
  rt::TracerKind tracer_ = rt::fastest_tracer;
  std::unique_ptr<pir::MotionDetector> detector_;
  pir::EdgeDraw edge_draw_;
  std::optional<pir::PolarityDetector> polarity_;
  effects::Pipeline pipeline_;
  std::unique_ptr<sim::AnalogModel> analog_;
  struct Pool;
  std::shared_ptr<Pool> idle_lookouts_;  ///< not part of what a Model is: memory that runs hand on
};

/// The only door from Spec to Model; script.effects are applied here, so that whoever uses a Model has them. Throws
/// Error(input) for names that the scene or the catalogue lacks or actions in an impossible order, Error(infeasible)
/// for a seat or point that can't be reached.
[[nodiscard]] Model compile(SceneSpec scene, ScriptSpec script, const CompileOptions& options = {});

}  // namespace pirsim
