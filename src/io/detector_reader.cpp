#include "io/reader_parts.hpp"

namespace pirsim::io {
namespace {

void read_element(const std::optional<YamlNode>& node, Diagnostics& faults, ElementSpec& element) {
  if (!node) return;
  YamlMap map(*node, faults, "element");
  read_numbers(map, element);
  map.finish();
}

void read_amplifier(const std::optional<YamlNode>& node, Diagnostics& faults, AmplifierSpec& amplifier) {
  if (!node) return;
  YamlMap map(*node, faults, "amplifier");
  read_numbers(map, amplifier);
  check_together(amplifier, faults_of(map, "amplifier"));
  map.finish();
}

void read_comparator(const std::optional<YamlNode>& node, Diagnostics& faults, ComparatorSpec& comparator) {
  if (!node) return;
  YamlMap map(*node, faults, "comparator");
  read_numbers(map, comparator);
  comparator.pulse_signs = map.choice<PulseSigns>("pulse_signs", comparator.pulse_signs,
                                                  {{"any", PulseSigns::any}, {"alternating", PulseSigns::alternating}});
  check_together(comparator, faults_of(map, "comparator"));
  map.finish();
}

}  // namespace

DetectorSpec read_detector(YamlMap& sensor) {
  DetectorSpec detector;
  read_element(sensor.child("element"), sensor.faults(), detector.element);
  read_amplifier(sensor.child("amplifier"), sensor.faults(), detector.amplifier);
  read_comparator(sensor.child("comparator"), sensor.faults(), detector.comparator);
  // A signal that saturates before a threshold would never be noticed.
  check_together(detector, faults_of(sensor, "comparator"));
  return detector;
}

const std::vector<std::string>& sourced_detector_keys() {
  static const std::vector<std::string> keys{
      "thermal_s",   "electrical_s",   "low_hz",      "high_hz",   "order",      "volts_per_watt",
      "noise_v_pp",  "offset_v",       "lowest_v",    "highest_v", "positive_v", "negative_v",
      "pulse_count", "pulse_window_s", "pulse_signs", "hold_s",    "blind_s"};
  return keys;
}

}  // namespace pirsim::io
