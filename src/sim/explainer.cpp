#include "sim/explainer.hpp"

#include <algorithm>
#include <cmath>

namespace pirsim::sim {

Explainer::Explainer(const CompiledStudy& study) : study_(study), meter_(study.array(), study.tracer()) {
  for (const auto& sensor : study.array().analog()->sensors()) {
    filters_.push_back(sensor ? std::optional(sensor->silent_filter) : std::nullopt);
  }
  const RayBundle& bundle = study.array().analog()->power().clipped();
  for (std::uint32_t sensor = 0; sensor < bundle.n_sensors(); ++sensor) {
    sensor_of_zone_.resize(bundle.cluster_zones_begin[bundle.sensor_clusters_begin[sensor + 1]], sensor);
  }
  for (std::uint32_t zone = 0; zone < bundle.n_zones(); ++zone) {
    zone_of_ray_.resize(bundle.zone_rays_begin[zone + 1], zone);
  }
}

double Explainer::watts(const PowerShare& share) const {
  const AnalogModel& analog = *study_.array().analog();
  const std::uint32_t sensor = sensor_of_zone_[zone_of_ray_[share.ray]];
  return static_cast<double>(share.power) * analog.watts_per_step(sensor, analog.power().receiver_of(share.ray));
}

void Explainer::settle(const RunState& state) {
  meter_.explain(state.crowd.actors(), state.crowd.doors().steps(), met_);
  for (const PowerShare& each : met_) {
    shares_[{zone_of_ray_[each.ray], each.person, each.part}].before_w += watts(each);
  }
  for (auto& [source, share] : shares_) {
    share.sections = filters_[sensor_of_zone_[std::get<0>(source)]]->at_rest(share.before_w);
  }
}

void Explainer::advance() {
  for (auto& [source, share] : shares_) {
    filters_[sensor_of_zone_[std::get<0>(source)]]->advance(share.sections, share.before_w, share.now_w, 0.0);
    share.before_w = share.now_w;
    share.now_w = 0.0;
  }
}

void Explainer::explain(const RunState& state, std::vector<TraceRow>& rows) {
  meter_.explain(state.crowd.actors(), state.crowd.doors().steps(), met_);
  for (const PowerShare& each : met_) {
    Share& share = shares_[{zone_of_ray_[each.ray], each.person, each.part}];
    share.now_w += watts(each);
  }
  advance();
  const RayBundle& bundle = study_.array().analog()->power().clipped();
  const std::size_t first_row = rows.size();
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    const auto& detector = state.detector.analog()[i];
    if (!detector) continue;
    rows.push_back({.tick = state.tick,
                    .sensor = i,
                    .power_w = detector->power_w,
                    .signal_v = detector->volts,
                    .output = pir::AnalogCircuit::on(*detector) ? std::uint8_t{1} : std::uint8_t{0}});
  }
  for (const auto& [source, share] : shares_) {
    const auto& [zone, person, part] = source;
    const std::size_t sensor = sensor_of_zone_[zone];
    const double volts = filters_[sensor]->output(share.sections);
    TraceRow& row = *std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(first_row), rows.end(),
                                  [&](const TraceRow& candidate) { return candidate.sensor == sensor; });
    if (std::abs(volts) <= std::abs(row.share_v)) continue;
    row.share_v = volts;
    row.zone = zone - bundle.cluster_zones_begin[bundle.sensor_clusters_begin[sensor]];
    row.person = state.crowd.actors()[person].person().spec.id;
    row.part = body::name(part);
  }
}

}  // namespace pirsim::sim
