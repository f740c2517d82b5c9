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
  /// Once a tick, from tick 1 on. triggers: (n_sensors) the detectors' at this tick; the effects change them.
  void hear(std::int64_t tick, std::span<std::uint8_t> triggers) { stages_.hear(tick, triggers); }
  [[nodiscard]] bool looks_ahead() const noexcept { return stages_.looks_ahead(); }
  /// The tick that has to be heard before it can be told what is logged at `tick`.
  [[nodiscard]] std::int64_t heard_by(std::int64_t tick) const noexcept { return stages_.heard_by(tick); }
  /// Once a tick, from tick 1 on, after hear(heard_by(tick)). triggers: (n_sensors) as hear() left them; set to those
  /// that are logged at this tick.
  void log(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept { stages_.log(tick, triggers); }
  /// Once a tick: triggers that were logged, to be read once a window.
  void read(std::span<const std::uint8_t> triggers) noexcept { reader_.advance(triggers); }
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
