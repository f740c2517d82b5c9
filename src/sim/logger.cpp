#include "sim/logger.hpp"

namespace pirsim::sim {
namespace {

pir::WindowReader in_step(std::size_t n_sensors, std::int32_t ticks_per_window) {
  return {std::vector<std::int32_t>(n_sensors, 0), ticks_per_window};
}

}  // namespace

Logger::Logger(const effects::Pipeline& stages, const SensingSpec& sensing, std::size_t n_sensors)
    : stages_(stages),
      kind_(sensing.reader),
      ticks_per_window_(sensing.ticks_per_window),
      n_sensors_(n_sensors),
      reader_(in_step(n_sensors, ticks_per_window_)) {}

void Logger::begin_run(std::uint64_t seed, std::uint32_t run) {
  stages_.begin_run(seed, run);
  reader_ = kind_ == Reader::in_step
                ? in_step(n_sensors_, ticks_per_window_)
                : pir::WindowReader(pir::drawn_leads(n_sensors_, ticks_per_window_, seed, run), ticks_per_window_);
}

void Logger::complete(Sample& row) noexcept {
  row.bits.assign(reader_.readings().begin(), reader_.readings().end());
  stages_.apply(row);
}

}  // namespace pirsim::sim
