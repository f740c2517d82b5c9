// All sensors of a scene, compiled once: rays, where the room ends them, and which of them form zones and channels.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pir/zone_motion.hpp"
#include "pir/zone_output.hpp"
#include "pirsim/rays.hpp"
#include "rt/room.hpp"
#include "rt/tracer.hpp"
#include "schema/study_in_force.hpp"
#include "sim/analog_model.hpp"

namespace pirsim::sim {

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

}  // namespace pirsim::sim
