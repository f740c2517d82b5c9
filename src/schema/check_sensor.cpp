#include <set>

#include "schema/spec_faults.hpp"

namespace pirsim {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

void check(const ClusterSpec& cluster, const SpecPath& path, SpecFaults& faults) {
  faults.fields(cluster, path);
  if (cluster.zones.empty()) faults.error(path.field("zones"), "expected a list that isn't empty");
  for (std::size_t i = 0; i < cluster.zones.size(); ++i) {
    const ZoneSpec& zone = cluster.zones[i];
    const SpecPath here = path.item("zones", i);
    faults.error_if(here.field("corners"), corners_fault(zone));
    if (zone.polarity != 1 && zone.polarity != -1) {
      faults.error(here.field("polarity"), "expected one of 1, -1, got " + std::to_string(zone.polarity));
    }
  }
}

}  // namespace

void check_together(const AmplifierSpec& amplifier, const TellFault& tell) {
  if (amplifier.low_hz >= amplifier.high_hz) tell("high_hz", "expected high_hz above low_hz");
  if (amplifier.lowest_v >= amplifier.offset_v || amplifier.offset_v >= amplifier.highest_v) {
    tell("offset_v", "expected offset_v between lowest_v and highest_v");
  }
}

void check_together(const ComparatorSpec& comparator, const TellFault& tell) {
  if (comparator.pulse_count > 1 && comparator.pulse_window_s <= 0.0) {
    tell("pulse_count", "several pulses need a pulse_window_s");
  }
}

void check_together(const DetectorSpec& detector, const TellFault& tell) {
  const auto& [element, amplifier, comparator, report] = detector;
  const double up = amplifier.highest_v - amplifier.offset_v, down = amplifier.offset_v - amplifier.lowest_v;
  const bool levels_make_sense = up > 0.0 && down > 0.0;
  if (levels_make_sense && (comparator.positive_v >= up || comparator.negative_v >= down)) {
    tell("comparator", "the output saturates before it reaches a threshold");
  }
}

void check_together(const SensorModelSpec& model, const TellFault& tell) {
  std::set<int> known, told;
  for (const ClusterSpec& cluster : model.clusters) known.insert(cluster.lens_step);
  for (const RatedTargetSpec& target : model.targets) {
    const std::string step = "lens step " + std::to_string(target.lens_step);
    if (!known.contains(target.lens_step)) tell("targets", "no facet is of " + step);
    if (!told.insert(target.lens_step).second) tell("targets", step + " has two targets");
  }
}

std::string corners_fault(const ZoneSpec& zone) {
  int left = 0;
  int right = 0;
  for (std::size_t i = 0; i < zone.corners.size(); ++i) {
    const Vec2& corner = zone.corners[i];
    if (!accepted::on_lens_plane_m.holds(corner.x) || !accepted::on_lens_plane_m.holds(corner.y)) {
      return "expected coordinates that are " + accepted::on_lens_plane_m.text();
    }
    // All turns of the outline go the same way.
    const Vec2 in = zone.corners[(i + 1) % 4] - corner;
    const Vec2 out = zone.corners[(i + 2) % 4] - zone.corners[(i + 1) % 4];
    (cross(in, out) > 0.0 ? left : right) += cross(in, out) != 0.0 ? 1 : 0;
  }
  return left == 4 || right == 4 ? "" : "expected the corners of a convex area in order round it";
}

void check(const SensorModelSpec& model, const SpecPath& path, SpecFaults& faults) {
  if (model.id.empty()) faults.error(path.field("id"), "expected a text that isn't empty");
  faults.fields(model, path);
  if (model.clusters.empty()) faults.error(path.field("clusters"), "expected a list that isn't empty");
  for (std::size_t i = 0; i < model.clusters.size(); ++i) check(model.clusters[i], path.item("clusters", i), faults);
  for (std::size_t i = 0; i < model.targets.size(); ++i) faults.fields(model.targets[i], path.item("targets", i));
  faults.together(model, path);
  faults.fields(model.sensitivity, path.field("sensitivity"));
  faults.fields(model.optics, path.field("optics"));
  const SpecPath detector = path.field("detector");
  faults.fields(model.detector.element, detector.field("element"));
  faults.fields(model.detector.amplifier, detector.field("amplifier"));
  faults.together(model.detector.amplifier, detector.field("amplifier"));
  faults.fields(model.detector.comparator, detector.field("comparator"));
  faults.together(model.detector.comparator, detector.field("comparator"));
  faults.fields(model.detector.report, detector.field("report"));
  faults.together(model.detector, detector);
}

}  // namespace pirsim
