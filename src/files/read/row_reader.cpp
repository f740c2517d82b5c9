#include "files/read/row_reader.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include "files/disk/file.hpp"
#include "files/disk/line_reader.hpp"
#include "files/read/csv_reader.hpp"
#include "model/core/text.hpp"
#include "model/schema/clock.hpp"
#include "model/schema/columns.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/sample.hpp"

namespace pirsim::io {
namespace {

/// A name that somebody mistyped: in other letters, or with one letter more, less or changed. A number at the end makes
/// it another name.
bool is_slip_of(std::string_view name, std::string_view meant) {
  const auto small = [](std::string_view text) {
    std::string result(text);
    for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return result;
  };
  const std::string a = small(name), b = small(meant);
  if (a == b) return true;
  constexpr std::size_t shortest = 5;
  if (b.size() < shortest || a.empty() || (a.back() >= '0' && a.back() <= '9')) return false;
  const auto begin = static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
  const std::string_view in_a = std::string_view(a).substr(begin), in_b = std::string_view(b).substr(begin);
  const auto behind = [](std::string_view text, std::size_t n) { return text.substr(std::min(n, text.size())); };
  if (behind(in_a, 1) == in_b || in_a == behind(in_b, 1) || behind(in_a, 1) == behind(in_b, 1)) return true;
  const bool is_swapped = in_a.size() > 1 && in_b.size() > 1 && in_a[0] == in_b[1] && in_a[1] == in_b[0];
  return is_swapped && behind(in_a, 2) == behind(in_b, 2);
}

/// By the tables' descriptions.
std::string_view alias_of(std::string_view name) {
  const auto known = std::ranges::find(columns_of<Sample>(), name, &ColumnInfo::name);
  return known == columns_of<Sample>().end() ? std::string_view() : known->alias;
}

std::string_view name_of(RowFormat::Column column) {
  switch (column) {
    case RowFormat::replicate:
      return "replicate";
    case RowFormat::room:
      return room_column.name;
    case RowFormat::trial:
      return "trial";
    case RowFormat::day:
      return day_column.name;
    case RowFormat::time_s:
      return "time_s";
    case RowFormat::time:
      return "time";
    case RowFormat::phase:
      return "phase";
    default:
      return "people";
  }
}

}  // namespace

// ------------------------------------------------------------------------------------------------------------- a line

RowFormat::RowFormat(std::string_view header, const Where& where)
    : file_(where.file), line_(header), line_number_(where.line) {
  RepeatedFaults unclosed;
  Diagnostics faults;
  if (!split(unclosed)) unclosed.tell(faults);
  faults.throw_if_errors();
  names_.assign(fields_.begin(), fields_.end());
  name_columns(where);
}

void RowFormat::name_columns(const Where& header) {
  Diagnostics faults;
  const auto field_of = [&](std::string_view name) -> std::optional<std::size_t> {
    const auto at = std::ranges::find(names_, name);
    if (name.empty() || at == names_.end()) return std::nullopt;
    return static_cast<std::size_t>(at - names_.begin());
  };
  if (names_.size() == 1 && names_.front().find_first_of(";\t") != std::string::npos)
    throw Error(ErrorCode::input, header, "columns must be separated by commas, not by semicolons or tabs");
  if (names_.size() > limits::log_columns)
    throw Error(ErrorCode::input, header, "more than " + std::to_string(limits::log_columns) + " fields");
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::string& name = names_[i];
    if (field_of(name).value_or(i) != i) faults.error(place(i), "column '" + name + "' appears twice");
    if (name.empty())
      faults.error(place(i), "a column without a name; tables are written without their index (pandas: index=False)");
    const Each owner = owner_of(name);
    if (owner == Each::area) {
      areas_.push_back(i);
      owners_.areas.push_back(name.substr(area_prefix.size()));
    } else if (owner == Each::door) {
      doors_.push_back(i);
      owners_.doors.push_back(name.substr(door_prefix.size()));
    } else if (!is_column_name(name) && !name.empty()) {
      sensors_.push_back(i);
      owners_.sensors.push_back(name);
    }
  }
  for (std::size_t column = 0; column < n_columns; ++column) {
    const std::string_view name = name_of(static_cast<Column>(column));
    const auto named = field_of(name), by_alias = field_of(alias_of(name));
    if (named && by_alias) {
      faults.error(place(*by_alias), "columns '" + std::string(name) + "' and '" + names_[*by_alias] +
                                         "' mean the same: give one of them");
    }
    at_[column] = named ? named : by_alias;
  }
  refuse_slips(faults);
  if (!at_[time_s] && !faults.has_errors()) {
    faults.error(header, "these aren't rows of a run or a dataset: column 'time_s' is missing" +
                             near_or_all("time_s", names_) +
                             "; if it is a log, say so (control --log, reconcile --map)");
  }
  if (sensors_.empty() && !faults.has_errors()) faults.error(header, "none of the columns is a sensor's");
  faults.throw_if_errors();
}

/// A misspelt column would be taken for a sensor's.
void RowFormat::refuse_slips(Diagnostics& faults) const {
  for (const std::size_t i : sensors_) {
    for (std::size_t column = 0; column < n_columns; ++column) {
      const std::string_view name = name_of(static_cast<Column>(column));
      if (at_[column] || !is_slip_of(names_[i], name)) continue;
      faults.error(place(i), "unknown column '" + names_[i] + "' (did you mean '" + std::string(name) + "'?)");
      break;
    }
  }
}

bool RowFormat::split(RepeatedFaults& faults) {
  if (!split_fields(line_, ',', fields_, unquoted_)) {
    faults.add("quote", {file_, line_number_, 1}, "a quote isn't closed, or stands within a field");
    return false;
  }
  const bool is_plain = std::ranges::all_of(line_, [](char c) { return c >= ' ' && c < '\x7F'; });
  for (std::size_t i = 0; i < fields_.size() && !is_plain; ++i) {
    const std::string found = invisible_character(fields_[i], Lines::many);
    if (found.empty()) continue;
    faults.add("character", place(i), "the field '" + std::string(fields_[i]) + "' contains " + found);
    return false;
  }
  if (names_.empty() || fields_.size() == names_.size()) return true;
  faults.add("width", {file_, line_number_, 1},
             "expected " + std::to_string(names_.size()) + " fields, got " + std::to_string(fields_.size()));
  return false;
}

Where RowFormat::place(std::size_t field) const {
  std::size_t at = 0;
  bool is_quoted = false;
  for (; at < line_.size() && field > 0; ++at) {
    is_quoted = is_quoted != (line_[at] == '"');
    field -= line_[at] == ',' && !is_quoted ? 1 : 0;
  }
  return {file_, line_number_, static_cast<int>(at) + 1};
}

template <typename Number>
void RowFormat::take(Number& number, std::size_t field, RepeatedFaults& faults) const {
  const std::optional<Number> value = parse_number<Number>(fields_[field]);
  if (value && std::isfinite(static_cast<double>(*value))) {
    number = *value;
    return;
  }
  const std::string expected = std::is_integral_v<Number> ? ": expected a whole number" : ": expected a number";
  faults.add("number " + std::to_string(field), place(field),
             names_[field] + expected + (fields_[field].empty() ? "" : ", got '" + std::string(fields_[field]) + "'"));
}

/// With a point, too, as tables are written that had a missing value once.
int RowFormat::count(std::size_t field, RepeatedFaults& faults) const {
  std::string_view text = fields_[field];
  if (text.empty()) return unknown_people;
  if (text.ends_with(".0")) text.remove_suffix(2);
  const std::optional<int> value = parse_number<int>(text);
  if (value && *value >= 0) return *value;
  faults.add("count " + std::to_string(field), place(field),
             names_[field] + ": expected a number of people, got '" + std::string(fields_[field]) + "'");
  return unknown_people;
}

std::uint8_t RowFormat::bit(std::size_t field, RepeatedFaults& faults) const {
  const std::string_view text = fields_[field];
  if (text == "0" || text == "0.0") return 0;
  if (text == "1" || text == "1.0") return 1;
  if (!text.empty())
    faults.add("bit", place(field), names_[field] + ": expected 0 or 1, got '" + std::string(text) + "'");
  return unknown_bit;
}

/// A part of a second isn't told.
void RowFormat::take_clock(std::string& clock, RepeatedFaults& faults) const {
  constexpr std::size_t to_seconds = 19;
  clock = fields_[*at_[time]];
  if (clock.size() > to_seconds && clock[to_seconds] == '.') clock.resize(to_seconds);
  const std::optional<RunClock> moment = clock_from(clock);
  if (!moment) {
    faults.add("time", place(*at_[time]),
               "time: expected a local time, 2026-03-02T07:00:30, got '" + std::string(fields_[*at_[time]]) + "'");
  } else if (clock.size() != to_seconds || clock[10] != 'T' || clock.substr(11, 2) == "24") {
    clock = moment->text(0.0);
  }
}

bool RowFormat::read(std::string_view line, int line_number, Sample& row, RepeatedFaults& faults) {
  line_ = line, line_number_ = line_number;
  if (!split(faults)) return false;
  const std::size_t n_before = faults.size();
  const auto either = [&](Column one, Column other) { return at_[one] ? at_[one] : at_[other]; };
  row.replicate = 1;
  const auto part = either(trial, day);
  const auto run = at_[replicate] || at_[room] || part == at_[day] ? either(replicate, room) : at_[day];
  if (run) take(row.replicate, *run, faults);
  row.trial = part ? fields_[*part] : std::string_view();
  take(row.time_s, *at_[time_s], faults);
  row.clock.clear();
  if (at_[time]) take_clock(row.clock, faults);
  row.phase = at_[phase] ? fields_[*at_[phase]] : std::string_view();
  row.people = at_[people] ? count(*at_[people], faults) : unknown_people;
  row.people_of_areas.resize(areas_.size());
  row.doors.resize(doors_.size());
  row.bits.resize(sensors_.size());
  for (std::size_t i = 0; i < areas_.size(); ++i) row.people_of_areas[i] = count(areas_[i], faults);
  for (std::size_t i = 0; i < doors_.size(); ++i) row.doors[i] = bit(doors_[i], faults);
  for (std::size_t i = 0; i < sensors_.size(); ++i) row.bits[i] = bit(sensors_[i], faults);
  if (at_[room]) mark_absent(row, faults);
  return faults.size() == n_before;
}

/// What isn't there in the first row of a dataset's day is of other rooms, in all of its rows.
void RowFormat::mark_absent(Sample& row, RepeatedFaults& faults) {
  if (!own_day_ || own_day_->first != row.replicate || own_day_->second != row.trial) {
    own_day_.emplace(row.replicate, row.trial);
    is_absent_.assign(fields_.size(), false);
    for (const auto* of_room : {&sensors_, &areas_, &doors_}) {
      for (const std::size_t field : *of_room) is_absent_[field] = fields_[field].empty();
    }
  }
  const auto mark = [&](const std::vector<std::size_t>& of_room, auto& values, auto absent) {
    for (std::size_t i = 0; i < of_room.size(); ++i) {
      if (!is_absent_[of_room[i]]) continue;
      values[i] = absent;
      if (fields_[of_room[i]].empty()) continue;
      faults.add("absent", place(of_room[i]),
                 names_[of_room[i]] + ": its field is empty in the first row of this day, as where a room has none");
    }
  };
  mark(sensors_, row.bits, absent_bit);
  mark(doors_, row.doors, absent_bit);
  mark(areas_, row.people_of_areas, absent_people);
}

// ---------------------------------------------------------------------------------------------------------- all lines

/// Lines with data: comments stand before the header.
class RowReader::Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : name_(file.string()), file_(std::in_place, file) {}
  Lines(std::string_view bytes, std::string name)
      : name_(std::move(name)), text_(text_from(std::string(bytes), name_)) {}

  [[nodiscard]] std::optional<std::string_view> next() {
    if (n_again_ < kept_.size()) return taken(kept_[n_again_++]);
    kept_.clear();
    n_again_ = 0;
    return data_line();
  }
  [[nodiscard]] int number() const noexcept { return number_; }
  [[nodiscard]] Where where() const { return {name_, number_, 1}; }

  /// The next ones, which next() gives, too.
  template <typename Take>
  void look_ahead(std::size_t n, const Take& take) {
    while (kept_.size() < n) {
      const auto line = data_line();
      if (!line) break;
      kept_.push_back({std::string(*line), number_});
      take(kept_.back().text, kept_.back().number);
    }
  }

 private:
  struct Kept {
    std::string text;
    int number;
  };
  std::string_view taken(const Kept& line) {
    number_ = line.number;
    return line.text;
  }

  std::optional<std::string_view> line() {
    ++n_lines_;
    if (file_) return file_->next();
    if (text_.size() == at_) return std::nullopt;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = std::string_view(text_).substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
  std::optional<std::string_view> data_line() {
    auto found = line();
    while (found && (found->empty() || (!has_header_ && found->starts_with('#')))) found = line();
    has_header_ = true;
    number_ = n_lines_;
    return found;
  }

  std::string name_;
  std::optional<LineReader> file_;
  std::string text_;
  std::size_t at_ = 0, n_again_ = 0;
  int n_lines_ = 0, number_ = 0;
  bool has_header_ = false;
  std::deque<Kept> kept_;
};

namespace {

template <typename Lines>
RowFormat format_of(Lines& lines) {
  const auto header = lines.next();
  if (!header) throw Error(ErrorCode::input, lines.where(), "expected a line with column names");
  return {*header, lines.where()};
}

}  // namespace

RowReader::RowReader(std::unique_ptr<Lines> lines)
    : lines_(std::move(lines)), format_(format_of(*lines_)), step_s_(usual_step_s()) {}
RowReader::RowReader(const std::filesystem::path& file) : RowReader(std::make_unique<Lines>(file)) {}
RowReader::RowReader(std::string_view bytes, const std::string& name)
    : RowReader(std::make_unique<Lines>(bytes, name)) {}
RowReader::~RowReader() = default;

double RowReader::usual_step_s() {
  constexpr std::size_t enough = 256;
  std::map<double, int> steps;  // how often rows are so far apart
  RowFormat format = format_;
  RepeatedFaults told_later;
  Sample before, row;
  double first_s = 0.0;
  std::size_t n = 0;
  lines_->look_ahead(enough, [&](std::string_view line, int number) {
    if (!format.read(line, number, row, told_later)) return;
    if (n++ == 0) first_s = row.time_s;
    const bool follows = n > 1 && row.replicate == before.replicate && row.trial == before.trial;
    if (follows && row.time_s > before.time_s) ++steps[std::round((row.time_s - before.time_s) * 1e6) / 1e6];
    std::swap(before, row);
  });
  const auto usual = std::ranges::max_element(steps, {}, &std::pair<const double, int>::second);
  if (usual == steps.end()) return std::max(0.0, first_s);
  // Of two rows alone the first tells how long it is, too: a run's first row ends a step after the run began.
  const double in_first = first_s > 0.0 ? usual->first / first_s : 0.0;
  const bool is_gap = n == 2 && in_first > 1.5 && std::abs(in_first - std::round(in_first)) < 1e-6;
  return is_gap ? first_s : usual->first;
}

bool RowReader::next(Sample& row) {
  const auto line = lines_->next();
  if (!line) return false;
  if (format_.read(*line, lines_->number(), row, faults_)) check(row);
  if (!faults_.empty()) refuse();
  return true;
}

/// With what else is wrong from here on.
void RowReader::refuse() {
  constexpr int enough = 100'000;  // rows: what comes may have no end
  Sample row;
  for (int i = 0; i < enough; ++i) {
    const auto line = lines_->next();
    if (!line) break;
    if (format_.read(*line, lines_->number(), row, faults_)) check(row);
  }
  Diagnostics faults;
  faults_.tell(faults);
  faults.throw_if_errors();
  throw Error(ErrorCode::internal, "rows were refused without a reason");
}

void RowReader::check(const Sample& row) {
  const bool goes_on = !runs_.empty() && row.replicate == replicate_ && row.trial == trial_;
  n_missing_ = 0;
  if (goes_on && row.time_s <= time_s_) {
    faults_.add("order", format_.where(RowFormat::time_s),
                "time_s doesn't grow: " + csv_number(row.time_s) + " after " + csv_number(time_s_));
  } else if (goes_on) {
    n_missing_ = missing_in(row.time_s - time_s_);
    check_clock(row);
  } else {
    gap_ = n_alike_ = 0;
    if (!runs_.emplace(row.replicate, row.trial).second) {
      faults_.add("runs", lines_->where(),
                  "this row is of a run whose rows have ended before: a run's rows follow each other");
    }
    replicate_ = row.replicate;
    trial_ = row.trial;
  }
  time_s_ = row.time_s;
  clock_ = row.clock;
}

/// Both times go on alike, but for summer time.
void RowReader::check_clock(const Sample& row) {
  const auto now = clock_from(row.clock), before = clock_from(clock_);
  if (!now || !before) return;
  constexpr double most_shift_s = 7200.0, shifts_s = 900.0, whole_seconds = 1.0;
  const double by_clock_s = static_cast<double>(now->begin_s - before->begin_s), by_time_s = row.time_s - time_s_;
  const double apart_s = std::abs(by_clock_s - by_time_s);
  const bool is_shift = apart_s <= most_shift_s && std::abs(std::remainder(apart_s, shifts_s)) <= whole_seconds;
  if (apart_s <= whole_seconds || is_shift) return;
  faults_.add(
      "clock", format_.where(RowFormat::time),
      "time is " + csv_number(by_clock_s) + " s after the row before, and time_s " + csv_number(by_time_s) + " s");
}

std::int64_t RowReader::missing_in(double step_s) {
  constexpr double most = 1e8;  // assumed: three years of seconds
  constexpr int too_often = 2;
  const double steps = step_s / step_s_;
  const auto are_apart = [](double seconds) {
    return "rows are " + csv_number(std::round(seconds * 1e6) / 1e6) + " s apart";
  };
  const auto where = [&] { return format_.where(RowFormat::time_s); };
  if (!(std::abs(steps - std::round(steps)) < 1e-3 && steps > 0.5)) {
    faults_.add("step", where(),
                are_apart(step_s_) + ", and this one comes " + csv_number(std::round(step_s * 1e6) / 1e6) +
                    " s after the one before");
    return 0;
  }
  if (steps > most) {
    faults_.add("gap", where(),
                "this row comes " + csv_number(std::round(steps)) + " rows after the one before: too long a gap");
    return 0;
  }
  const std::int64_t n = std::llround(steps) - 1;
  n_alike_ = n > 0 && n == gap_ ? n_alike_ + 1 : 0;
  gap_ = n;
  if (n_alike_ >= too_often)
    faults_.add("step", where(),
                are_apart(step_s_) + " at first and " + csv_number(step_s) + " s here: give rows of one length");
  return n;
}

bool RowReader::next_of_all(Sample& row) {
  if (n_to_fill_ == 0) {
    if (!next(behind_gap_)) return false;
    n_to_fill_ = n_missing_ + 1;
  }
  if (--n_to_fill_ == 0) {
    row = behind_gap_;
    return true;
  }
  const double before_s = static_cast<double>(n_to_fill_) * step_s_;
  row = behind_gap_;
  row.time_s -= before_s;
  if (!row.clock.empty()) {
    if (const auto clock = clock_from(row.clock)) row.clock = clock->text(-before_s);
  }
  row.people = unknown_people;
  for (int& people : row.people_of_areas) people = people == absent_people ? absent_people : unknown_people;
  for (auto* bits : {&row.bits, &row.doors}) {
    for (std::uint8_t& bit : *bits) bit = bit == absent_bit ? absent_bit : unknown_bit;
  }
  return true;
}

}  // namespace pirsim::io
