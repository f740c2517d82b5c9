#include "pir/zone_output.hpp"

namespace pirsim::pir {

std::optional<Comparator> zone_output(const DetectorSpec& spec, double tick_s) {
  if (spec.comparator.pulse_count == 1 && spec.report.hold_s == 0.0 && spec.report.blind_s == 0.0) return std::nullopt;
  ComparatorSpec unsigned_pulses = spec.comparator;
  unsigned_pulses.pulse_signs = PulseSigns::any;
  return Comparator(unsigned_pulses, spec.report, tick_s);
}

}  // namespace pirsim::pir
