#include "control/row_file.hpp"

#include <algorithm>

#include "io/files/atomic_file.hpp"
#include "io/log/log_words.hpp"

namespace pirsim::control {
namespace {

/// Of one of the tables of rows, and no sensor's.
bool has_a_meaning(std::string_view name) {
  const auto is_of = [&](const auto& columns) {
    return std::ranges::any_of(columns, [&](const auto& column) {
      return column.each == nullptr && (column.name == name || column.alias == name);
    });
  };
  return is_of(columns_of<Sample>()) || is_of(columns_of<DayLine>());
}

}  // namespace

RowFile::RowFile(const std::filesystem::path& file) : lines_(file) {
  if (!split()) throw Error(ErrorCode::input, lines_.where(), "the file is empty: expected rows of a run");
  names_.assign(fields_.begin(), fields_.end());
  const auto column = [&](std::string_view name) {
    const auto at = std::ranges::find(names_, name);
    return at == names_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(at - names_.begin()));
  };
  run_ = column("replicate") ? column("replicate") : column("room");
  trial_ = column("trial") ? column("trial") : column("day") ? column("day") : column("seat");
  time_s_ = column("time_s"), clock_ = column("time"), people_ = column("people");
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::string& name = names_[i];
    if (has_a_meaning(name)) continue;
    switch (owner_of(name)) {
      case Each::area:
        areas_.push_back(i);
        owners_.areas.push_back(name.substr(area_prefix.size()));
        break;
      case Each::door:
        doors_.push_back(i);
        owners_.doors.push_back(name.substr(door_prefix.size()));
        break;
      case Each::sensor:
        sensors_.push_back(i);
        owners_.sensors.push_back(name);
    }
  }
  if (!run_ || !trial_ || !time_s_ || sensors_.empty()) {
    throw Error(ErrorCode::input, lines_.where(),
                "these aren't rows of a run or a dataset, which begin with replicate,trial,time_s or room,day,time_s; "
                "is it a log? give it by --log");
  }
}

bool RowFile::split() {
  while (const auto line = lines_.next()) {
    if (line->empty()) continue;
    if (!io::split_fields(*line, ',', fields_, unquoted_))
      throw Error(ErrorCode::input, lines_.where(), "a quote isn't closed");
    return true;
  }
  return false;
}

template <typename Number>
Number RowFile::number(std::size_t column, Number if_empty) const {
  const std::string_view text = fields_[column];
  if (text.empty()) return if_empty;
  const auto value = io::parse_number<Number>(text);
  if (value) return *value;
  const auto at = static_cast<int>(text.data() - fields_.front().data()) + 1;
  throw Error(ErrorCode::input, lines_.where(at),
              names_[column] + ": expected a number, got '" + std::string(text) + "'");
}

bool RowFile::next(Sample& row) {
  if (!split()) return false;
  if (fields_.size() != names_.size()) {
    throw Error(ErrorCode::input, lines_.where(),
                "expected " + std::to_string(names_.size()) + " fields, got " + std::to_string(fields_.size()));
  }
  row.replicate = number<int>(*run_, 0);
  row.trial = fields_[*trial_];
  row.time_s = number<double>(*time_s_, 0.0);
  row.clock = clock_ ? fields_[*clock_] : std::string_view();
  row.people = people_ ? number<int>(*people_, 0) : -1;
  row.people_of_areas.resize(areas_.size());
  for (std::size_t i = 0; i < areas_.size(); ++i) row.people_of_areas[i] = number<int>(areas_[i], 0);
  row.doors.resize(doors_.size());
  for (std::size_t i = 0; i < doors_.size(); ++i) row.doors[i] = fields_[doors_[i]] == "1" ? 1 : 0;
  row.bits.resize(sensors_.size());
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    const std::string_view bit = fields_[sensors_[i]];
    row.bits[i] = bit == "1"                  ? 1
                  : bit == "0" || bit.empty() ? 0
                                              : static_cast<std::uint8_t>(number<int>(sensors_[i], 0) != 0);
  }
  return true;
}

}  // namespace pirsim::control
