#include "pir/window_reader.hpp"

#include <algorithm>
#include <utility>

namespace pirsim::pir {

WindowReader::WindowReader(std::vector<std::int32_t> lead_ticks, std::int32_t ticks_per_window)
    : ticks_per_window_(ticks_per_window),
      ticks_left_(std::move(lead_ticks)),
      latches_(ticks_left_.size(), 0),
      readings_(ticks_left_.size(), 0) {
  for (std::int32_t& ticks : ticks_left_) ticks = ticks_per_window - ticks;
}

void WindowReader::advance(std::span<const std::uint8_t> triggers) noexcept {
  for (std::size_t sensor = 0; sensor < latches_.size(); ++sensor) {
    if (triggers[sensor] != 0) latches_[sensor] = 1;
    if (--ticks_left_[sensor] == 0) {
      ticks_left_[sensor] = ticks_per_window_;
      readings_[sensor] = std::exchange(latches_[sensor], std::uint8_t{0});
    }
  }
}

bool WindowReader::is_at_rest() const noexcept {
  const auto none = [](std::uint8_t bit) { return bit == 0; };
  return std::ranges::all_of(latches_, none) && std::ranges::all_of(readings_, none);
}

std::vector<std::int32_t> drawn_leads(std::size_t n_sensors, std::int32_t ticks_per_window, std::uint64_t seed,
                                      std::uint32_t run) {
  std::vector<std::int32_t> leads;
  for (std::uint32_t sensor = 0; sensor < n_sensors; ++sensor) {
    Stream stream({.seed = seed, .run = run, .entity = sensor, .purpose = Purpose::reader_phase});
    leads.push_back(static_cast<std::int32_t>(stream.index(static_cast<std::uint32_t>(ticks_per_window))));
  }
  return leads;
}

}  // namespace pirsim::pir
