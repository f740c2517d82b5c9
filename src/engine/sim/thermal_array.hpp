// Thermopile arrays: what each pixel sees of room and people, as a temperature, and the frames that a part makes of it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/pir/optics.hpp"
#include "engine/rt/room.hpp"
#include "engine/rt/tracer.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::sim {

struct RunState;

/// One array of a scene: optics and electronics. Immutable, shared by threads. Its rays lie on one lattice over the
/// whole field; each counts for all pixels in whose response it is. Derivation: docs/physics/arrays.md.
class ThermalArray {
 public:
  /// index: into scene.arrays; it keys all that is drawn. leaves: of doors; they outlive this. Throws Error(input) for
  /// more frames a second than ticks, and for too many rays.
  ThermalArray(const SceneSpec& scene, std::size_t index, const SensingInForce& sensing, std::uint64_t seed,
               const rt::Room& room, const std::vector<DoorLeaf>& leaves);

  [[nodiscard]] const ArraySpec& spec() const noexcept { return spec_; }
  [[nodiscard]] std::size_t n_pixels() const noexcept { return backgrounds_.size(); }
  [[nodiscard]] const PowerModel& power() const noexcept { return power_; }
  [[nodiscard]] const pir::Band& band() const noexcept { return power_.band(); }
  [[nodiscard]] std::unique_ptr<rt::Tracer> make_tracer(TracerKind kind) const;
  /// Frames are numbered from 1 on.
  [[nodiscard]] std::int64_t tick_of(std::int64_t frame) const noexcept;
  [[nodiscard]] double time_s(std::int64_t frame) const noexcept;
  /// Standard deviation of one reading of a pixel, K, without what a frame's pixels share.
  [[nodiscard]] double noise_k(std::size_t pixel) const noexcept { return noise_k_[pixel]; }

  /// celsius: (n_pixels) overwritten: the optics alone. powers: (n_rays).
  void see(std::span<const PowerSteps> powers, std::span<double> celsius) const noexcept;
  /// What the part reads there: all pixels, or those of this frame's sub-page. A pure function of run and frame.
  enum class Pages { all, due };
  void read(std::span<const double> celsius, std::uint32_t run, std::int64_t frame, Pages pages,
            std::span<float> values) const noexcept;

 private:
  struct Share {
    std::uint32_t pixel;
    double of_pixel;  ///< of its response
  };

  void draw_unit();

  ArraySpec spec_;
  std::uint64_t seed_;
  double rate_hz_;
  int tick_rate_hz_;
  const rt::Room* room_;
  std::vector<Share> shares_;                ///< ray by ray
  std::vector<std::uint32_t> shares_begin_;  ///< (n_rays + 1)
  PowerModel power_;
  std::optional<rt::LeafCuts> cuts_;
  pir::Thermometer thermometer_;
  std::vector<double> backgrounds_;  ///< (n_pixels) radiance of the empty room, W m^-2 sr^-1
  std::vector<double> empty_c_;      ///< (n_pixels) the same as temperatures
  std::vector<double> noise_k_;      ///< (n_pixels)
  std::vector<double> pattern_k_;    ///< (n_pixels) what this unit always adds; NaN: dead
};

/// Takes the frames of one array in one run. Belongs to one thread; the array outlives it.
class Camera {
 public:
  Camera(const ThermalArray& array, TracerKind kind, std::uint32_t run);
  /// Takes all frames that are due up to the state's tick, people as they stand there. The first call begins: what was
  /// due before has been missed.
  void look(const RunState& state);
  /// (n_pixels) the latest frame.
  [[nodiscard]] std::span<const float> last() const noexcept { return last_; }
  [[nodiscard]] FrameStack& frames() noexcept { return frames_; }

 private:
  const ThermalArray& array_;
  std::uint32_t run_;
  PowerMeter meter_;
  std::int64_t next_ = 0;  ///< frame; 0: none was looked for yet
  std::vector<double> celsius_;
  std::vector<float> last_;
  FrameStack frames_;
};

/// What an array makes of one body alone, as surveys ask. Belongs to one thread; the array outlives it.
class ArrayWatch {
 public:
  ArrayWatch(const ThermalArray& array, TracerKind kind);

  /// The pixel that the body changes most, in its noise.
  struct Contrast {
    double kelvin = 0.0;
    double times_noise = 0.0;
    /// In one frame; three times the noise: `assumed` (2 to 5).
    [[nodiscard]] bool is_seen() const noexcept { return times_noise >= 3.0; }
  };
  /// solids: at most body::n_parts count; radiance: in the array's band, of the parts in their order.
  [[nodiscard]] Contrast look(std::span<const PosedShape> solids, const BodyRadiance& radiance);
  [[nodiscard]] const ThermalArray& array() const noexcept { return array_; }

 private:
  const ThermalArray& array_;
  PowerMeter meter_;
  std::vector<PowerSteps> powers_;
  std::vector<double> empty_, celsius_;
};

}  // namespace pirsim::sim
