#include "pir/zone_output.hpp"

namespace pirsim::pir {

std::optional<Comparator> zone_output(const ComparatorSpec& spec, double tick_s) {
  if (spec.pulse_count == 1 && spec.hold_s == 0.0 && spec.blind_s == 0.0) return std::nullopt;
  ComparatorSpec unsigned_pulses = spec;
  unsigned_pulses.pulse_signs = PulseSigns::any;
  return Comparator(unsigned_pulses, tick_s);
}

}  // namespace pirsim::pir
