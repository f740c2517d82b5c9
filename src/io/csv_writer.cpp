#include "pirsim/csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace pirsim::io {
namespace {

std::string when(const Sample& sample) {
  return std::to_string(sample.replicate) + ',' + csv_field(sample.trial) + ',' + csv_number(sample.time_s) + ',';
}

void add_bits(std::string& line, const Sample& sample) {
  for (const std::uint8_t bit : sample.bits) line += bit != 0 ? ",1" : ",0";
}

}  // namespace

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string csv_number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

CsvWriter::CsvWriter(std::ostream& out, const std::vector<std::string>& columns)
    : out_(out), clock_(std::ranges::find(columns, "time") == columns.end() ? Clock::none : Clock::told) {
  std::string line;
  for (const std::string& column : columns) line += (line.empty() ? "" : ",") + csv_field(column);
  out_ << line << '\n';
}

void CsvWriter::write(const Sample& sample) {
  std::string line = when(sample) + (clock_ == Clock::told ? sample.clock + ',' : "") + csv_field(sample.phase) + ',' +
                     std::to_string(sample.people);
  add_bits(line, sample);
  out_ << line << '\n';
}

MeasuredCsvWriter::MeasuredCsvWriter(std::ostream& out, const std::vector<std::string>& sensors) : out_(out) {
  std::string line = "replicate,trial,time_s,phase";
  for (const std::string& sensor : sensors) line += ',' + csv_field(sensor);
  out_ << line << '\n';
}

void MeasuredCsvWriter::write(const Sample& sample) {
  std::string line = when(sample) + csv_field(sample.phase);
  add_bits(line, sample);
  out_ << line << '\n';
}

ZoneCsvWriter::ZoneCsvWriter(std::ostream& out, std::vector<std::string> sensors, std::vector<std::size_t> zones_begin)
    : out_(out), sensors_(std::move(sensors)), zones_begin_(std::move(zones_begin)) {
  out_ << "replicate,trial,tick,sensor,zones\n";
}

void ZoneCsvWriter::write(int replicate, std::string_view trial, std::int64_t tick,
                          std::span<const std::uint8_t> zones) {
  const std::string run = std::to_string(replicate) + ',' + csv_field(trial) + ',' + std::to_string(tick) + ',';
  for (std::size_t sensor = 0; sensor < sensors_.size(); ++sensor) {
    std::string line = run + csv_field(sensors_[sensor]) + ',';
    for (std::size_t z = zones_begin_[sensor]; z < zones_begin_[sensor + 1]; ++z) line += zones[z] != 0 ? '1' : '0';
    out_ << line << '\n';
  }
}

OccupantCsvWriter::OccupantCsvWriter(std::ostream& out) : out_(out) {
  out_ << "replicate,trial,time_s,time,person,where,activity,seat,x_m,z_m\n";
}

void OccupantCsvWriter::write(int replicate, std::string_view trial, const OccupantRow& row) {
  const auto millimetres = [](double metres) { return csv_number(std::round(1000.0 * metres) / 1000.0); };
  out_ << replicate << ',' << csv_field(trial) << ',' << csv_number(row.time_s) << ',' << row.clock << ','
       << csv_field(row.person) << ',' << (row.where == OccupantRow::Where::inside ? "inside" : "outside") << ','
       << csv_field(row.activity) << ',' << csv_field(row.seat) << ',' << millimetres(row.place_m.x) << ','
       << millimetres(row.place_m.y) << '\n';
}

TraceCsvWriter::TraceCsvWriter(std::ostream& out, std::vector<std::string> sensors, int tick_rate_hz)
    : out_(out), sensors_(std::move(sensors)), tick_rate_hz_(tick_rate_hz) {
  out_ << "replicate,trial,time_s,sensor,power_w,signal_v,output,zone,person,part,share_v\n";
}

void TraceCsvWriter::write(int replicate, std::string_view trial, const TraceRow& row) {
  std::string line = std::to_string(replicate) + ',' + csv_field(trial) + ',';
  line += csv_number(static_cast<double>(row.tick) / tick_rate_hz_) + ',' + csv_field(sensors_[row.sensor]) + ',';
  line += csv_number(row.power_w) + ',' + csv_number(row.signal_v) + ',' + std::to_string(row.output) + ',';
  if (!row.part.empty()) line += std::to_string(row.zone + 1);
  out_ << line << ',' << csv_field(row.person) << ',' << row.part << ',' << csv_number(row.share_v) << '\n';
}

}  // namespace pirsim::io
