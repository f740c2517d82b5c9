#include "studies/campaign.hpp"

#include <algorithm>
#include <utility>

#include "io/files/atomic_file.hpp"
#include "pirsim/columns.hpp"
#include "pirsim/error.hpp"

namespace pirsim::studies {
namespace {

enum Column : std::size_t { replicate, trial };

}  // namespace

RowTally::RowTally(std::vector<std::string> trials, SummarySpec spec, std::vector<MeasuredCell> measured)
    : trials_(std::move(trials)), spec_(std::move(spec)), measured_(std::move(measured)) {}

void RowTally::add(std::string_view bytes) {
  for (const char c : bytes) {
    if (c == '"') {
      if (quotes_ == Quotes::closed) fields_.back() += c;  // the second of two
      quotes_ = quotes_ == Quotes::open ? Quotes::closed : Quotes::open;
    } else if (quotes_ != Quotes::open && (c == ',' || c == '\n')) {
      quotes_ = Quotes::none;
      if (c == '\n') {
        end_line();
      } else {
        fields_.emplace_back();
      }
    } else {
      fields_.back() += c;
    }
  }
}

void RowTally::end_line() {
  ++n_lines_;
  if (!summary_) {
    take_header();
  } else {
    if (fields_.size() != first_sensor_ + row_.bits.size()) {
      throw Error(ErrorCode::input, "line " + std::to_string(n_lines_) + " of the rows has too few or too many fields");
    }
    if (fields_[replicate] != replicate_ || fields_[trial] != trial_) {
      end_run();
      replicate_ = fields_[replicate];
      trial_ = fields_[trial];
    }
    row_.phase = fields_[phase_];
    for (std::size_t i = 0; i < row_.bits.size(); ++i) row_.bits[i] = fields_[first_sensor_ + i] == "1" ? 1 : 0;
    for (std::size_t i = 0; i < row_.people_of_areas.size(); ++i)
      row_.people_of_areas[i] = io::parse_number<int>(fields_[first_area_ + i]).value_or(0);
    counts_->add(row_);
  }
  fields_.assign(1, {});
}

void RowTally::take_header() {
  const auto begins_with = [&](const std::vector<std::string>& columns) {
    return fields_.size() >= columns.size() && std::equal(columns.begin(), columns.end(), fields_.begin());
  };
  ColumnOwners owners;
  for (const std::string& field : fields_) {
    if (is_column_of_area(field)) owners.areas.push_back(field.substr(area_prefix.size()));
    if (is_column_of_door(field)) owners.doors.push_back(field.substr(door_prefix.size()));
  }
  std::vector<std::string> columns = column_names<Sample>(owners);  // of days
  if (!begins_with(columns)) columns = column_names<Sample>(owners, [](When when) { return when != When::with_clock; });
  if (!begins_with(columns)) throw Error(ErrorCode::input, "the rows don't begin with the header of a study's rows");
  first_sensor_ = columns.size();
  first_area_ = first_sensor_ - owners.doors.size() - owners.areas.size();
  row_.people_of_areas.resize(owners.areas.size());
  phase_ = static_cast<std::size_t>(std::ranges::find(columns, "phase") - columns.begin());
  const std::vector<std::string> sensors(fields_.begin() + static_cast<std::ptrdiff_t>(first_sensor_), fields_.end());
  summary_.emplace(trials_, sensors, std::move(measured_));
  counts_.emplace(sensors.size(), spec_, owners.areas);
  row_.bits.resize(sensors.size());
}

void RowTally::end_run() {
  if (!replicate_.empty()) summary_->add_run(trial_, counts_->counts(), counts_->areas());
  counts_->reset();
}

const Summary& RowTally::finish() {
  if (!summary_ || fields_.size() != 1 || !fields_.front().empty()) {
    throw Error(ErrorCode::input, "the rows end within a line");
  }
  end_run();
  replicate_.clear();
  return *summary_;
}

}  // namespace pirsim::studies
