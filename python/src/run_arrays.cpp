#include "run_arrays.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <limits>
#include <variant>

#include "arrays.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

constexpr std::int64_t no_time = std::numeric_limits<std::int64_t>::min();  // numpy's NaT

/// Seconds since 1970 of "2026-03-02T08:30:00".
std::int64_t seconds_of(const std::string& clock) {
  const auto number = [&](std::size_t begin, std::size_t length) {
    int value = 0;
    std::from_chars(clock.data() + begin, clock.data() + begin + length, value);
    return value;
  };
  if (clock.size() < 19) return no_time;
  const std::chrono::year_month_day day{std::chrono::year(number(0, 4)),
                                        std::chrono::month(static_cast<unsigned>(number(5, 2))),
                                        std::chrono::day(static_cast<unsigned>(number(8, 2)))};
  const std::int64_t days = std::chrono::sys_days(day).time_since_epoch().count();
  return ((days * 24 + number(11, 2)) * 60 + number(14, 2)) * 60 + number(17, 2);
}

/// (n_runs x n_windows x width) of runs of different length, which are given back on the way.
template <typename T, typename Rows>
std::vector<T> padded(std::vector<Rows>& rows, std::vector<T> Rows::*column, std::size_t n_windows, std::size_t width,
                      T beyond = {}) {
  std::vector<T> all(rows.size() * n_windows * width, beyond);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<T>& part = rows[i].*column;
    std::copy(part.begin(), part.end(), all.begin() + static_cast<std::ptrdiff_t>(i * n_windows * width));
    std::vector<T>().swap(part);
  }
  return all;
}

template <typename As, typename T>
nb::object column_as(std::vector<T>& values) {
  const std::size_t n = values.size();
  return to_numpy_as<As>(std::move(values), {n});
}
template <typename T>
nb::object column(std::vector<T>& values) {
  return column_as<T>(values);
}

}  // namespace

std::uint16_t RunArrays::Words::number(std::string_view text) {
  const auto found = numbers_.find(text);
  if (found != numbers_.end()) return found->second;
  if (texts_.size() > std::numeric_limits<std::uint16_t>::max())
    throw Error(ErrorCode::usage, "more than 65535 different phases or names in one result");
  const auto n = static_cast<std::uint16_t>(texts_.size());
  texts_.emplace_back(text);
  numbers_.emplace(text, n);
  return n;
}

nb::tuple RunArrays::Words::all() const { return nb::tuple(to_python(texts_)); }

RunArrays::RunArrays(std::size_t n_sensors, std::size_t n_areas, std::size_t n_doors)
    : n_sensors_(n_sensors), n_areas_(n_areas), n_doors_(n_doors) {
  for (const Column<OccupantLine>& one : columns_of<OccupantLine>()) {
    const bool told_by_run = one.name == "replicate" || one.name == "trial" || one.holds == Holds::moment;
    if (one.when == When::with_areas && n_areas == 0) continue;
    if (!told_by_run) occupants_.push_back({&one, {}, {}});
  }
}

void RunArrays::add(const RunResult& result) {
  run_.push_back(result.run);
  replicate_.push_back(result.replicate);
  trial_.push_back(result.trial);
  Rows& rows = rows_.emplace_back();
  rows.bits.reserve(result.samples.size() * n_sensors_);
  for (const Sample& sample : result.samples) {
    rows.bits.insert(rows.bits.end(), sample.bits.begin(), sample.bits.end());
    rows.doors.insert(rows.doors.end(), sample.doors.begin(), sample.doors.end());
    rows.people.push_back(static_cast<std::uint16_t>(sample.people));
    for (const int people : sample.people_of_areas) rows.people_of_areas.push_back(static_cast<std::uint16_t>(people));
    rows.phase.push_back(phases_.number(sample.phase));
    if (!sample.clock.empty()) rows.clock.push_back(seconds_of(sample.clock));
  }
  has_clock_ = has_clock_ || !rows.clock.empty();
  for (std::size_t i = n_windows_; i < result.samples.size(); ++i) time_s_.push_back(result.samples[i].time_s);
  n_windows_ = std::max(n_windows_, result.samples.size());
  if (result.fault) faults_.push_back({result.run, *result.fault});
  for (const RunIncident& incident : result.incidents) incidents_.push_back({result.run, incident});
  add_occupants(result);
  add_signals(result);
  add_zones(result);
}

void RunArrays::add_occupants(const RunResult& result) {
  for (const OccupantRow& row : result.occupants) {
    occupant_run_.push_back(result.run);
    for (TableColumn& one : occupants_) {
      const Cell cell = one.column->value({result.replicate, result.trial, row});
      if (const auto* number = std::get_if<double>(&cell)) one.numbers.push_back(*number);
      if (const auto* text = std::get_if<std::string_view>(&cell)) one.texts.push_back(texts_.number(*text));
    }
  }
}

void RunArrays::add_signals(const RunResult& result) {
  for (const TraceRow& row : result.trace) {
    signals_.run.push_back(result.run);
    signals_.tick.push_back(row.tick);
    signals_.sensor.push_back(static_cast<std::uint16_t>(row.sensor));
    signals_.power_w.push_back(row.power_w);
    signals_.signal_v.push_back(row.signal_v);
    signals_.output.push_back(row.output);
    signals_.zone.push_back(static_cast<std::uint16_t>(row.zone));
    signals_.person.push_back(texts_.number(row.person));
    signals_.part.push_back(texts_.number(row.part));
    signals_.share_v.push_back(row.share_v);
  }
}

void RunArrays::add_zones(const RunResult& result) {
  Zones& zones = zones_.emplace_back();
  zones.n_ticks = result.zones.size();
  for (const ZoneSet& tick : result.zones) {
    for (std::size_t zone = 0; zone < tick.size(); ++zone) zones.active.push_back(tick.test(zone) ? 1 : 0);
  }
}

nb::dict RunArrays::occupants() {
  nb::dict table;
  table["run"] = column(occupant_run_);
  for (TableColumn& one : occupants_) {
    const nb::str name(one.column->name.data(), one.column->name.size());
    table[name] = one.column->holds == Holds::text ? column(one.texts) : column(one.numbers);
  }
  return table;
}

nb::dict RunArrays::signals() {
  nb::dict table;
  table["run"] = column(signals_.run);
  table["tick"] = column(signals_.tick);
  table["sensor"] = column(signals_.sensor);
  table["power_w"] = column(signals_.power_w);
  table["signal_v"] = column(signals_.signal_v);
  table["output"] = column_as<bool>(signals_.output);
  table["zone"] = column(signals_.zone);
  table["person"] = column(signals_.person);
  table["part"] = column(signals_.part);
  table["share_v"] = column(signals_.share_v);
  return table;
}

nb::list RunArrays::zones() {
  nb::list all;
  for (Zones& zones : zones_) {
    const std::size_t n_zones = zones.n_ticks == 0 ? 0 : zones.active.size() / zones.n_ticks;
    all.append(to_numpy(std::move(zones.active), {zones.n_ticks, n_zones}));
  }
  return all;
}

void RunArrays::add_rows(nb::dict& arrays) {
  const std::size_t n_runs = rows_.size();
  std::vector<std::uint8_t> valid(n_runs * n_windows_);
  for (std::size_t i = 0; i < n_runs; ++i) {
    const auto begin = valid.begin() + static_cast<std::ptrdiff_t>(i * n_windows_);
    std::fill(begin, begin + static_cast<std::ptrdiff_t>(rows_[i].people.size()), std::uint8_t{1});
  }
  arrays["valid"] = to_numpy_as<bool>(std::move(valid), {n_runs, n_windows_});
  if (has_clock_) arrays["clock"] = to_numpy(padded(rows_, &Rows::clock, n_windows_, 1, no_time), {n_runs, n_windows_});
  arrays["bits"] = to_numpy(padded(rows_, &Rows::bits, n_windows_, n_sensors_), {n_runs, n_windows_, n_sensors_});
  arrays["phase_code"] = to_numpy(padded(rows_, &Rows::phase, n_windows_, 1), {n_runs, n_windows_});
  arrays["people_of_areas"] =
      to_numpy(padded(rows_, &Rows::people_of_areas, n_windows_, n_areas_), {n_runs, n_windows_, n_areas_});
  arrays["door_open"] = to_numpy(padded(rows_, &Rows::doors, n_windows_, n_doors_), {n_runs, n_windows_, n_doors_});
  arrays["people"] = to_numpy(padded(rows_, &Rows::people, n_windows_, 1), {n_runs, n_windows_});
}

nb::dict RunArrays::to_dict() && {
  nb::dict arrays;
  add_rows(arrays);
  arrays["time"] = column(time_s_);
  arrays["run"] = column(run_);
  arrays["replicate"] = column(replicate_);
  arrays["trial"] = to_python(trial_);
  arrays["phases"] = phases_.all();
  arrays["occupants"] = occupants();
  arrays["signals"] = signals();
  arrays["texts"] = texts_.all();
  arrays["zones"] = zones();
  nb::list faults, incidents;
  for (const Fault& f : faults_) faults.append(nb::make_tuple(f.run, f.fault.time_s, to_python(f.fault.message)));
  for (const Incident& i : incidents_) {
    incidents.append(nb::make_tuple(i.run, to_python(i.incident.kind), i.incident.time_s, to_python(i.incident.person),
                                    to_python(i.incident.place_m)));
  }
  arrays["faults"] = faults;
  arrays["incidents"] = incidents;
  return arrays;
}

}  // namespace pirsim::python
