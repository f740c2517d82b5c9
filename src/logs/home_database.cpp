#include "logs/home_database.hpp"

#include <sqlite3.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "files/disk/file.hpp"
#include "logs/times.hpp"
#include "model/core/random.hpp"
#include "model/core/text.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {
namespace {

namespace fs = std::filesystem;

/// None of what is read once, from where it stands.
std::string first_bytes(const fs::path& file) {
  std::error_code fault;
  if (file == standard_input || !fs::is_regular_file(file, fault)) return {};
  std::array<char, 20> bytes{};
  PosixFile opened(file, PosixFile::Mode::read);
  return {bytes.data(), opened.read(bytes.data(), bytes.size())};
}

/// Whether its changes may stand in a second file, "-wal".
bool has_second_file(const fs::path& file) {
  constexpr std::size_t read_version = 19;  // https://www.sqlite.org/fileformat.html, 1.3: 2 of such a database
  const std::string bytes = first_bytes(file);
  return bytes.size() > read_version && bytes[read_version] == 2;
}

/// A file's name as SQLite's URI.
std::string uri_of(const fs::path& file) {
  constexpr std::string_view digits = "0123456789ABCDEF", plain = "/._-";
  std::string uri = "file:";
  for (const char c : file.string()) {
    const bool is_word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    const auto byte = static_cast<unsigned char>(c);
    uri += is_word || plain.find(c) != std::string_view::npos
               ? std::string(1, c)
               : std::string{'%', digits[byte >> 4U], digits[byte & 15U]};
  }
  return uri;
}

std::string text_of(sqlite3_stmt* row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return text == nullptr ? std::string()
                         : std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
}

/// "2021-05-03 12:34:56.123456", in UTC.
std::optional<std::int64_t> moment_of(const std::string& text) {
  const auto stamp = parse_stamp(text, LogMap::Dates::found);
  const bool is_moment = stamp && (stamp->kind == Stamp::Kind::local || stamp->kind == Stamp::Kind::absolute);
  return is_moment ? std::optional(stamp->us) : std::nullopt;
}

std::string in_sql(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + '\'';
}

/// A row of a table of tabs. A text that holds one, or a quote, is no motion sensor's.
std::string line_of(std::int64_t us, const std::string& entity, std::string state) {
  std::ranges::replace_if(
      state, [](char c) { return c == '"' || (c >= 0 && c < ' '); }, ' ');
  return fixed(static_cast<double>(us) / us_per_s, 6) + '\t' + entity + '\t' + state;
}

}  // namespace

bool is_database(const fs::path& file) { return first_bytes(file).starts_with("SQLite format 3"); }

void HomeDatabase::Close::operator()(sqlite3* database) const noexcept { sqlite3_close(database); }
void HomeDatabase::Close::operator()(sqlite3_stmt* statement) const noexcept { sqlite3_finalize(statement); }

HomeDatabase::HomeDatabase(const fs::path& file, std::span<const std::string> entities) : path_(file) {
  open();
  rows_ = prepare(query(entities));
  read_stops();
}

/// One with a second file is read with it. A copy without can be opened if SQLite is told that nobody writes to it.
void HomeDatabase::open() {
  const fs::path real = fs::canonical(path_);
  std::error_code fault;
  const bool is_whole = has_second_file(real) && !fs::exists(real.string() + "-wal", fault);
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2((uri_of(real) + "?mode=ro" + (is_whole ? "&immutable=1" : "")).c_str(), &opened,
                                   SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  database_.reset(opened);
  if (code != SQLITE_OK) fail();
}

void HomeDatabase::fail() const {
  const int code = sqlite3_errcode(database_.get());
  const std::string hint = code == SQLITE_CANTOPEN || code == SQLITE_READONLY
                               ? "; its -wal file is read with it: copy both to a folder in which you may write"
                               : "";
  throw Error(ErrorCode::io, Where{path_.string()},
              "can't be read: " + std::string(sqlite3_errmsg(database_.get())) + hint);
}

HomeDatabase::Statement HomeDatabase::prepare(const std::string& sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) fail();
  return Statement(statement);
}

bool HomeDatabase::step(const Statement& statement) const {
  const int code = sqlite3_step(statement.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) fail();
  return code == SQLITE_ROW;
}

bool HomeDatabase::has_rows(const std::string& sql) const { return step(prepare(sql)); }
bool HomeDatabase::has_column(const std::string& table, const std::string& column) const {
  return has_rows("SELECT 1 FROM pragma_table_info(" + in_sql(table) + ") WHERE name = " + in_sql(column));
}

/// By the columns that are there rather than by the version: while a database is brought to a newer one, rows of both
/// are in it. https://github.com/home-assistant/core/blob/dev/homeassistant/components/recorder/db_schema.py
std::string HomeDatabase::query(std::span<const std::string> entities) {
  const bool names_apart = has_column("states", "metadata_id") && has_column("states_meta", "entity_id");  // from 38 on
  const bool has_names = has_column("states", "entity_id");
  const bool has_seconds = has_column("states", "last_updated_ts");  // from 31 on
  const bool has_texts = has_column("states", "last_updated");
  const bool has_views = has_rows("SELECT 1 FROM sqlite_master WHERE type = 'view'");  // which may never end
  if (has_views || !(names_apart || has_names) || !(has_seconds || has_texts) || !has_column("states", "state")) {
    throw Error(
        ErrorCode::input, Where{path_.string()},
        "expected a log, got a database (SQLite) that isn't Home Assistant's: it has no table of states, or has views; "
        "export its table as CSV");
  }
  const std::string name = !names_apart ? "s.entity_id"
                           : has_names  ? "COALESCE(m.entity_id, s.entity_id)"
                                        : "m.entity_id";
  names_ = {name, names_apart ? " LEFT JOIN states_meta m ON m.metadata_id = s.metadata_id" : ""};
  const std::string from_text = "(julianday(s.last_updated) - 2440587.5) * 86400.0";
  const bool all_seconds =
      has_seconds && !(has_texts && has_rows("SELECT 1 FROM states WHERE last_updated_ts IS NULL"));
  const std::string order = all_seconds   ? "s.last_updated_ts"
                            : has_seconds ? "COALESCE(s.last_updated_ts, " + from_text + ")"
                                          : "s.last_updated";
  std::vector<std::string> more;
  for (const std::string& entity : entities) more.push_back(in_sql(entity));
  return "SELECT " + std::string(has_seconds ? "s.last_updated_ts" : "NULL") + ", " +
         (has_texts ? "s.last_updated" : "NULL") + ", " + name + ", s.state FROM states s" + names_.second + " WHERE " +
         name + " LIKE 'binary\\_sensor.%' ESCAPE '\\'" +
         (more.empty() ? "" : " OR " + name + " IN (" + joined(more, ", ") + ")") + " ORDER BY " + order +
         ", s.state_id";
}

/// Of each binary sensor that has one: "motion", "door".
std::map<std::string, std::string, std::less<>> HomeDatabase::device_classes() const {
  std::map<std::string, std::string, std::less<>> classes;
  const bool is_apart = has_column("states", "attributes_id") && has_column("state_attributes", "shared_attrs");
  if (!is_apart && !has_column("states", "attributes")) return classes;
  const std::string text = is_apart ? "a.shared_attrs" : "s.attributes";
  const Statement found =
      prepare("SELECT DISTINCT " + names_.first + ", json_extract(" + text + ", '$.device_class') FROM states s" +
              names_.second + (is_apart ? " JOIN state_attributes a ON a.attributes_id = s.attributes_id" : "") +
              " WHERE CASE WHEN json_valid(" + text + ") THEN json_extract(" + text +
              ", '$.device_class') IS NOT NULL ELSE 0 END");
  while (step(found)) classes[text_of(found.get(), 0)] = text_of(found.get(), 1);
  return classes;
}

/// When the last state before this moment was written.
std::optional<std::int64_t> HomeDatabase::last_before(std::int64_t us, const std::string& text) const {
  const bool has_numbers = has_column("states", "last_updated_ts");
  const Statement last =
      prepare(has_numbers ? "SELECT MAX(last_updated_ts) FROM states WHERE last_updated_ts < " +
                                fixed(static_cast<double>(us) / us_per_s, 6)
                          : "SELECT MAX(last_updated) FROM states WHERE last_updated < " + in_sql(text));
  if (!step(last) || sqlite3_column_type(last.get(), 0) == SQLITE_NULL) return std::nullopt;
  const auto at = has_numbers
                      ? std::optional<std::int64_t>(std::llround(sqlite3_column_double(last.get(), 0) * us_per_s))
                      : moment_of(text_of(last.get(), 0));
  return at ? std::optional(*at + 1) : std::nullopt;
}

void HomeDatabase::read_stops() {
  if (!has_column("recorder_runs", "start") || !has_column("recorder_runs", "end")) return;
  const std::string crashed = has_column("recorder_runs", "closed_incorrect") ? "closed_incorrect" : "0";
  const Statement runs = prepare("SELECT start, \"end\", " + crashed + " FROM recorder_runs ORDER BY start");
  std::optional<std::int64_t> ended;
  for (bool is_first = true; step(runs); is_first = false) {
    const auto begun = moment_of(text_of(runs.get(), 0));
    // Of a run that crashed Home Assistant writes that it ended when the next one began.
    if (!is_first && begun && !ended) ended = last_before(*begun, text_of(runs.get(), 0));
    if (ended && begun && *begun > *ended) stops_us_.push_back(*ended);
    const bool has_crashed = sqlite3_column_int(runs.get(), 2) != 0;
    ended = has_crashed ? std::nullopt : moment_of(text_of(runs.get(), 1));
  }
  std::ranges::reverse(stops_us_);
}

std::optional<HomeDatabase::StateChange> HomeDatabase::next_row() {
  if (!rows_ || !step(rows_)) {
    rows_.reset();  // else SQLite would begin anew
    return std::nullopt;
  }
  StateChange row{0, text_of(rows_.get(), 2), text_of(rows_.get(), 3)};
  if (sqlite3_column_type(rows_.get(), 0) != SQLITE_NULL) {
    row.us = std::llround(sqlite3_column_double(rows_.get(), 0) * us_per_s);
  } else if (const auto us = moment_of(text_of(rows_.get(), 1))) {
    row.us = *us;
  } else {
    throw Error(ErrorCode::input, Where{path_.string()}, "a state of " + row.entity + " without a time");
  }
  if (row.state.empty()) row.state = "unavailable";  // the entity was removed
  return row;
}

std::optional<std::string> HomeDatabase::next() {
  while (waiting_.empty()) {
    const auto row = next_row();
    if (!row) return std::nullopt;
    for (; !stops_us_.empty() && stops_us_.back() < row->us; stops_us_.pop_back()) {
      for (auto& [entity, state] : states_) {
        if (std::exchange(state, "unavailable") != "unavailable")
          waiting_.push_back(line_of(stops_us_.back(), entity, state));
      }
    }
    std::string& state = states_[row->entity];
    if (state != row->state)
      waiting_.push_back(line_of(row->us, row->entity, row->state));  // else its attributes changed
    state = row->state;
    std::ranges::reverse(waiting_);
  }
  std::string line = std::move(waiting_.back());
  waiting_.pop_back();
  return line;
}

InputFile HomeDatabase::file() const {
  PosixFile opened(path_, PosixFile::Mode::read);
  Sha256 hash;
  std::vector<char> block(1U << 20U);
  while (const std::size_t n = opened.read(block.data(), block.size())) hash.add({block.data(), n});
  return {path_.string(), hash.hex()};
}

}  // namespace pirsim::io
