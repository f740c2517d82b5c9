#include "io/sensing_reader.hpp"

#include <cmath>

#include "io/yaml_map.hpp"

namespace pirsim::io {

SensingSpec read_sensing(const std::optional<YamlNode>& node, Diagnostics& faults) {
  SensingSpec sensing;
  if (!node) return sensing;
  YamlMap map(*node, faults, "sensing");
  sensing.tick_rate_hz = map.integer("tick_rate_hz", sensing.tick_rate_hz, {.min = 1, .max = 10000});
  const double window_s = map.number("window_s", 1.0, {.above = 0.0, .max = 3600.0});
  const double ticks = window_s * sensing.tick_rate_hz;
  if (std::abs(ticks - std::round(ticks)) > 1e-9 * ticks || ticks < 1.0) {
    faults.error(map.where("window_s"),
                 "window_s: expected a whole number of ticks of 1/" + std::to_string(sensing.tick_rate_hz) + " s");
  }
  sensing.ticks_per_window = static_cast<int>(std::lround(ticks));
  sensing.rays_per_zone = map.choice<RaysPerZone>(
      "rays_per_zone", sensing.rays_per_zone,
      {{"1", RaysPerZone::one}, {"5", RaysPerZone::five}, {"9", RaysPerZone::nine}, {"16", RaysPerZone::sixteen}});
  sensing.change_per = map.choice<ChangePer>("change_per", sensing.change_per,
                                             {{"cluster", ChangePer::cluster}, {"beam", ChangePer::beam}});
  sensing.reader = map.choice<Reader>("reader", sensing.reader,
                                      {{"in_step", Reader::in_step}, {"free_running", Reader::free_running}});
  sensing.response = map.choice<std::optional<Response>>("response", sensing.response,
                                                         {{"zones", Response::zones}, {"analog", Response::analog}});
  sensing.ambient_c = map.number("ambient_c", sensing.ambient_c, {.min = -50.0, .max = 60.0});
  sensing.analog_rays_per_zone =
      map.integer("analog_rays_per_zone", sensing.analog_rays_per_zone, {.min = 1, .max = 10000});
  map.finish();
  return sensing;
}

}  // namespace pirsim::io
