#include "reconcile/validation/out_of_catalogue.hpp"

#include <cmath>
#include <numbers>

namespace pirsim::reconcile {
namespace {

/// A sensor says the opposite during the middle third of a run, as one with a loose pull-up does.
void invert_for_a_while(std::vector<Sample>& rows, std::size_t sensor, Stream& /*stream*/) {
  for (std::size_t i = rows.size() / 3; i < 2 * rows.size() / 3; ++i) rows[i].bits[sensor] ^= 1U;
}

/// All sensors grow dull and keen again together, over 90 s (assumed).
void wax_and_wane(std::vector<Sample>& rows, std::size_t /*sensor*/, Stream& stream) {
  constexpr double period_s = 90.0;
  for (Sample& row : rows) {
    const double missed = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * row.time_s / period_s);
    for (std::uint8_t& bit : row.bits) {
      if (stream.uniform() < missed) bit = 0;
    }
  }
}

/// A sensor's wire picks up its neighbour's pulses: what that one says is said by both.
void pick_up_neighbour(std::vector<Sample>& rows, std::size_t sensor, Stream& /*stream*/) {
  for (Sample& row : rows) row.bits[sensor] |= row.bits[(sensor + 1) % row.bits.size()];
}

}  // namespace

const std::vector<OutOfCatalogueFault>& out_of_catalogue_faults() {
  static const std::vector<OutOfCatalogueFault> all = {{"inverted_for_a_while", invert_for_a_while},
                                                       {"waxing_and_waning", wax_and_wane},
                                                       {"picked_up_neighbour", pick_up_neighbour}};
  return all;
}

}  // namespace pirsim::reconcile
