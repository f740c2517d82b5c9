// What hard zones keep of a sensor's circuit: the comparator's counting, holding and blind time.
#pragma once

#include <optional>

#include "pir/analog_circuit.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::pir {

/// Behind zones, the signal is outside the window at the ticks at which a zone changes; which side it would be on isn't
/// known, so that pulses of any sign count. None if the output is on at just those ticks.
[[nodiscard]] std::optional<Comparator> zone_output(const DetectorSpec& spec, double tick_s);

}  // namespace pirsim::pir
