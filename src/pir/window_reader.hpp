// Who asks the sensors, once a window, whether they have seen motion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/random.hpp"

namespace pirsim::pir {

/// Latches each sensor's triggers and reads and clears the latch once a window; a reader that isn't in step with the
/// rows reads each sensor some ticks before a row ends, so that what comes later shows in the next row.
/// [Stefansson2021] says no more of its reader than that it "measures movement roughly once per second".
class WindowReader {
 public:
  /// lead_ticks: (n_sensors) ticks before the end of a row at which a sensor is read, each in [0, ticks_per_window).
  WindowReader(std::vector<std::int32_t> lead_ticks, std::int32_t ticks_per_window);

  /// One tick more has ended; triggers: (n_sensors), not 0 where the output was on.
  void advance(std::span<const std::uint8_t> triggers) noexcept;
  /// (n_sensors) what was read last: 1 for motion, at first 0.
  [[nodiscard]] std::span<const std::uint8_t> readings() const noexcept { return readings_; }
  /// Neither latched nor read any motion: whole windows without triggers leave it as it is.
  [[nodiscard]] bool is_at_rest() const noexcept;
  bool operator==(const WindowReader&) const = default;

 private:
  std::int32_t ticks_per_window_;
  std::vector<std::int32_t> ticks_left_;  ///< (n_sensors) until the sensor is read
  std::vector<std::uint8_t> latches_, readings_;
};

/// For each sensor a lead of its own, each equally likely, drawn for this run.
[[nodiscard]] std::vector<std::int32_t> drawn_leads(std::size_t n_sensors, std::int32_t ticks_per_window,
                                                    std::uint64_t seed, std::uint32_t run);

}  // namespace pirsim::pir
