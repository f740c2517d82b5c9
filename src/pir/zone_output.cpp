#include "pir/zone_output.hpp"

namespace pirsim::pir {

std::optional<Comparator> zone_output(const DetectorSpec& spec, double tick_s) {
  const auto& [hold_s, again_s, blind_s] = spec.report;
  if (spec.comparator.pulse_count == 1 && hold_s == 0.0 && again_s == 0.0 && blind_s == 0.0) return std::nullopt;
  ComparatorSpec unsigned_pulses = spec.comparator;
  unsigned_pulses.pulse_signs = PulseSigns::any;
  return Comparator(unsigned_pulses, spec.report, tick_s);
}

}  // namespace pirsim::pir
