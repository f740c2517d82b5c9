#include "dataset/exports.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "io/write/casas_writer.hpp"
#include "pirsim/csv.hpp"

namespace pirsim::dataset {
namespace {

std::string rounded(double value) { return io::csv_number(std::round(1000.0 * value) / 1000.0); }

/// "2026-03-02" and "08:30:00" of a clock.
std::string date_of(const std::string& clock) { return clock.substr(0, 10); }
std::string time_of(const std::string& clock) { return clock.size() > 11 ? clock.substr(11) : std::string{}; }

const DayProfile* profile_of(const RoomProfile& room, unsigned weekday, std::size_t week) {
  const auto pick = [&](const std::vector<DayProfile>& days) { return &days[week % days.size()]; };
  if (!room.weekdays[weekday].empty()) return pick(room.weekdays[weekday]);
  constexpr unsigned saturday = 5;
  for (unsigned k = 1; k < 7; ++k) {
    const unsigned other = (weekday + k) % 7;
    if ((other >= saturday) == (weekday >= saturday) && !room.weekdays[other].empty())
      return pick(room.weekdays[other]);
  }
  return nullptr;
}

}  // namespace

bool Reading::any() const {
  return std::ranges::find_if(bits, [](std::uint8_t bit) { return bit != 0; }) != bits.end();
}

std::optional<int> rows_per_reading(const SensingSpec& sensing) {
  constexpr int reading_s = 30;
  const int ticks = reading_s * sensing.tick_rate_hz;
  if (ticks % sensing.ticks_per_window != 0) return std::nullopt;
  return ticks / sensing.ticks_per_window;
}

std::vector<Reading> readings(std::span<const Sample> rows, int rows_per_reading) {
  std::vector<Reading> result;
  const auto step = static_cast<std::size_t>(rows_per_reading);
  for (std::size_t first = 0; first + step <= rows.size(); first += step) {
    const Sample& last = rows[first + step - 1];
    Reading& reading = result.emplace_back(Reading{last.clock, last.people, last.people_of_areas, last.bits});
    for (const Sample& row : rows.subspan(first, step)) {
      for (std::size_t i = 0; i < row.bits.size(); ++i) reading.bits[i] |= row.bits[i];
    }
  }
  return result;
}

std::string to_uci864(std::span<const Reading> readings, const std::vector<std::string>& sensors,
                      const std::vector<std::string>& areas) {
  std::string text = "Date,Time";
  for (const std::string& sensor : sensors) text += ',' + sensor + "_PIR";
  text += ",Room_Occupancy_Count";
  for (const std::string& area : areas) text += ',' + area + "_Occupancy_Count";
  text += '\n';
  for (const Reading& reading : readings) {
    std::string date = date_of(reading.clock);
    std::ranges::replace(date, '-', '/');
    text += date + ',' + time_of(reading.clock);
    for (const std::uint8_t bit : reading.bits) text += bit != 0 ? ",1" : ",0";
    text += ',' + std::to_string(reading.people);
    for (const int people : reading.people_of_areas) text += ',' + std::to_string(people);
    text += '\n';
  }
  return text;
}

std::string to_casas(const RunResult& run, const std::vector<std::string>& sensors,
                     const std::vector<std::string>& doors) {
  std::ostringstream text;
  io::CasasWriter log(text, sensors, doors);
  log.add(run.samples, run.occupants);
  log.finish();
  return std::move(text).str();
}

std::string to_energyplus(std::span<const RoomProfile> rooms, int year) {
  using namespace std::chrono;
  std::string text;
  for (const RoomProfile& room : rooms)
    text += (text.empty() ? "" : ",") + room.room + "_presence," + room.room + "_people";
  text += '\n';
  const sys_days first{year_month_day{std::chrono::year(year), January, day(1)}};
  std::size_t days = 0;
  for (sys_days date = first; days < 365; date += std::chrono::days(1)) {
    const year_month_day calendar{date};
    if (calendar.month() == February && calendar.day() == day(29)) continue;
    const unsigned weekday_index = (weekday(date).iso_encoding() - 1) % 7;
    const std::size_t week = static_cast<std::size_t>((date - first).count()) / 7;
    ++days;
    for (std::size_t hour = 0; hour < 24; ++hour) {
      std::string line;
      for (const RoomProfile& room : rooms) {
        const DayProfile* profile = profile_of(room, weekday_index, week);
        line += (line.empty() ? "" : ",") + rounded(profile ? profile->presence[hour] : 0.0) + ',' +
                rounded(profile ? profile->people[hour] : 0.0);
      }
      text += line + '\n';
    }
  }
  return text;
}

}  // namespace pirsim::dataset
