// Logs of real sensors.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <pirsim/log.hpp>
#include <pirsim/log_facts.hpp>

#include "arrays.hpp"
#include "attend.hpp"
#include "bindings.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

nb::tuple lengths(const LogLengths& found) {
  return nb::make_tuple(found.n, found.floor_s, found.floor_share, found.shortest_s, found.q05_s, found.q25_s,
                        found.median_s, found.q75_s, found.q95_s, found.longest_s);
}

nb::tuple sensor(const LogSensorFacts& facts) {
  const bool is_known = facts.false_triggers.has_value();
  return nb::make_tuple(to_python(facts.name), to_python(facts.motion_share()), facts.known_s, facts.unknown_s,
                        lengths(facts.pulses), lengths(facts.pauses), to_python(facts.motion_by_hour),
                        is_known ? nb::object(nb::int_(facts.false_triggers->n)) : nb::none(),
                        is_known ? facts.false_triggers->hours : 0.0, to_python(facts.hold_s));
}

nb::list pairs(const LogFacts& facts) {
  nb::list list;
  for (const LogPair& pair : facts.pairs) {
    list.append(nb::make_tuple(to_python(facts.sensors[pair.a].name), to_python(facts.sensors[pair.b].name),
                               to_python(pair.phi), to_python(pair.b_after_a_s), pair.n_together, pair.has_leader()));
  }
  return list;
}

/// Microseconds of the windows' ends: UTC and local.
nb::dict times(const LogWindows& windows) {
  std::vector<std::int64_t> utc, local;
  for (std::size_t i = 1; i <= windows.size(); ++i) {
    const LogMoment end = windows.begin(i);
    utc.push_back(end.us);
    local.push_back(end.local_us());
  }
  const std::size_t n = utc.size();
  nb::dict result;
  result["utc_us"] = to_numpy(std::move(utc), {n});
  result["local_us"] = to_numpy(std::move(local), {n});
  return result;
}

nb::dict read(const std::vector<std::string>& files, const std::string& map_file, const std::string& map_text,
              double window_s) {
  Log log;
  LogFacts facts;
  LogRows rows;
  attend(nb::none(), [&](Job& job) {
    const LogMap map = !map_file.empty()   ? io::read_log_map(map_file)
                       : !map_text.empty() ? io::parse_log_map(map_text, "map")
                                           : LogMap{};
    const std::vector<std::filesystem::path> paths(files.begin(), files.end());
    log = io::read_log(paths, map, {[&](std::uint64_t) { job.step_or_stop(); }});
    facts = facts_of(log);
    rows = LogWindows(log, window_s).rows();
  });
  const std::size_t n = rows.n_windows(), n_sensors = rows.sensors.size();
  nb::dict result = times(LogWindows(log, window_s));
  result["sensors"] = nb::tuple(to_python(rows.sensors));
  result["motion"] = to_numpy(std::move(rows.motion), {n, n_sensors});
  result["people_means"] = rows.people_mean == LogMap::People::presence ? "presence" : "count";
  result["people"] = log.people ? to_numpy(std::move(rows.people), {n}) : nb::none();
  result["window_s"] = rows.window_s;
  result["clock"] = nb::str(log.clock == LogClock::elapsed ? "elapsed"
                            : log.clock == LogClock::local ? "local"
                                                           : "zoned");
  result["interval_s"] = facts.interval_s;
  result["map"] = to_python(io::to_yaml(log.map));
  result["remarks"] = to_python(log.remarks);
  nb::list sensors;
  for (const LogSensorFacts& one : facts.sensors) sensors.append(sensor(one));
  result["facts"] = sensors;
  result["pairs"] = pairs(facts);
  return result;
}

}  // namespace

void add_log(nb::module_& module) {
  module.def("read_log", &read, nb::arg("files"), nb::arg("map_file"), nb::arg("map_text"), nb::arg("window_s"),
             "Parts of pirsim.Log, by name.");
}

}  // namespace pirsim::python
