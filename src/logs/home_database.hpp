// Home Assistant's database, as rows of a table of time, sensor and state.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pirsim/input_file.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace pirsim::io {

/// Whether it is a file that SQLite wrote.
[[nodiscard]] bool is_database(const std::filesystem::path& file);

/// Its binary sensors, and `entities`, in order of time, a row a change. Nothing is known of any while Home Assistant
/// wasn't running. Opened for reading alone. Throws Error: io; input for another program's database.
class HomeDatabase {
 public:
  HomeDatabase(const std::filesystem::path& file, std::span<const std::string> entities);

  static constexpr std::string_view called = "Home Assistant's database";
  static constexpr std::string_view header = "time\tsensor\tstate";
  /// The next line of a table of tabs; none after the last.
  [[nodiscard]] std::optional<std::string> next();
  /// What Home Assistant takes an entity for, whatever it is called.
  [[nodiscard]] std::map<std::string, std::string, std::less<>> device_classes() const;
  [[nodiscard]] InputFile file() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const noexcept;
    void operator()(sqlite3_stmt* statement) const noexcept;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;
  struct StateChange {
    std::int64_t us = 0;
    std::string entity, state;
  };

  void open();
  [[nodiscard]] Statement prepare(const std::string& sql) const;
  [[nodiscard]] bool step(const Statement& statement) const;
  [[nodiscard]] bool has_column(const std::string& table, const std::string& column) const;
  [[nodiscard]] bool has_rows(const std::string& sql) const;
  [[nodiscard]] std::string query(std::span<const std::string> entities);
  void read_stops();
  [[nodiscard]] std::optional<std::int64_t> last_before(std::int64_t us, const std::string& text) const;
  [[nodiscard]] std::optional<StateChange> next_row();
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::pair<std::string, std::string> names_;  ///< of entities, in SQL: the expression, and what it joins
  std::unique_ptr<sqlite3, Close> database_;
  Statement rows_;
  std::vector<std::int64_t> stops_us_;  ///< when Home Assistant stopped, and was started later; the next one last
  std::map<std::string, std::string, std::less<>> states_;  ///< by entity, the last one told
  std::vector<std::string> waiting_;                        ///< lines, the next one last
};

}  // namespace pirsim::io
