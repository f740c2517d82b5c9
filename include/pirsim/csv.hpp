// Rows as CSV (RFC 4180): comma, LF, quotes only where needed, numbers in their shortest exact form.
#pragma once

#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/sample.hpp"

namespace pirsim::io {

/// A field as CSV writes it: quoted if it holds a comma, a quote or a line break.
[[nodiscard]] std::string csv_field(std::string_view text);
/// Shortest decimal that reads back as the same double: "1", "0.02".
[[nodiscard]] std::string csv_number(double value);

class CsvWriter {
 public:
  /// Writes the header line. The stream outlives the writer; its state tells about write errors.
  CsvWriter(std::ostream& out, const std::vector<std::string>& columns);
  void write(const Sample& sample);

 private:
  std::ostream& out_;
  enum class Clock { none, told } clock_;  ///< is there a column `time`?
};

/// Rows as somebody measures them: without `people`, whom nobody counts, and with `time_s` as their only time.
class MeasuredCsvWriter {
 public:
  MeasuredCsvWriter(std::ostream& out, const std::vector<std::string>& sensors);
  void write(const Sample& sample);

 private:
  std::ostream& out_;
};

/// Zone activity, so that others can check the bits: one line a tick and sensor, `zones` a string of 0 and 1 in the
/// order of the sensor's zones.
class ZoneCsvWriter {
 public:
  /// zones_begin: (n_sensors + 1) index of every sensor's first zone.
  ZoneCsvWriter(std::ostream& out, std::vector<std::string> sensors, std::vector<std::size_t> zones_begin);
  void write(int replicate, std::string_view trial, std::int64_t tick, std::span<const std::uint8_t> zones);

 private:
  std::ostream& out_;
  std::vector<std::string> sensors_;
  std::vector<std::size_t> zones_begin_;
};

/// Who is where and does what: one line a window and person.
class OccupantCsvWriter {
 public:
  explicit OccupantCsvWriter(std::ostream& out);
  void write(int replicate, std::string_view trial, const OccupantRow& row);

 private:
  std::ostream& out_;
};

/// What analog sensors received, made of it and why: one line a tick and sensor.
class TraceCsvWriter {
 public:
  TraceCsvWriter(std::ostream& out, std::vector<std::string> sensors, int tick_rate_hz);
  void write(int replicate, std::string_view trial, const TraceRow& row);

 private:
  std::ostream& out_;
  std::vector<std::string> sensors_;
  int tick_rate_hz_;
};

}  // namespace pirsim::io
