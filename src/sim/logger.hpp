// From triggers to rows: what electronics, environment and bookkeeping do to them, and who reads them when.
#pragma once

#include <cstdint>
#include <span>

#include "effects/pipeline.hpp"
#include "pir/window_reader.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/script.hpp"

namespace pirsim::sim {

/// A value: copied with the run that it belongs to.
class Logger {
 public:
  Logger(const effects::Pipeline& stages, const SensingSpec& sensing, std::size_t n_sensors);

  /// Forgets everything. Seed and run fix all randomness.
  void begin_run(std::uint64_t seed, std::uint32_t run);
  /// Somebody left a seat (index into the scene's) in the step to the next tick: effects may leave it warm.
  void seat_left(std::size_t seat) { stages_.seat_left(seat); }
  /// triggers: (n_sensors) the detectors' triggers at this tick (1, 2, ...); the effects change them.
  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept;
  /// True if whole windows without triggers would leave it as it is.
  [[nodiscard]] bool is_at_rest() const noexcept { return !stages_.acts_on_triggers() && reader_.is_at_rest(); }
  /// The row's bits as they were read last, then what the effects do to the row.
  void complete(Sample& row) noexcept;

 private:
  effects::Pipeline stages_;
  Reader kind_;
  std::int32_t ticks_per_window_;
  std::size_t n_sensors_;
  pir::WindowReader reader_;
};

}  // namespace pirsim::sim
