#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "io/read/occupancy_tables.hpp"
#include "io/read/yaml_map.hpp"
#include "schema/limits.hpp"

namespace pirsim::io {
namespace {

class PlacesReader {
 public:
  PlacesReader(const CsvTable& table, PlacesSpec& places, Diagnostics& faults)
      : table_(table), places_(places), faults_(faults), columns_(table, faults) {}

  void read() {
    const TimeColumn time(table_, {}, faults_);
    seat_ = table_.column("seat") ? table_.column("seat") : table_.required_column("place", faults_);
    activity_ = table_.column("activity");
    require_one_run(table_, time, repeated_);
    if (!time.is_found() || !seat_ || !columns_.id) return repeated_.tell(faults_);
    if (table_.n_rows() > limits::occupancy_rows)
      return faults_.error(table_.header_place(), too_many(limits::occupancy_rows, "rows"));
    for (std::size_t row = 0; row < table_.n_rows(); ++row) {
      Diagnostics found;
      const auto seconds = time.seconds(row, found);
      const auto point = point_in(table_, row, columns_, found);
      repeated_.add("time or place", found);
      if (seconds) add_row({*seconds, row, point}, time.where(row));
    }
    repeated_.tell(faults_);
    if (rows_.empty() && !faults_.has_errors()) faults_.error(table_.header_place(), "expected at least one row");
    if (faults_.has_errors()) return;
    for (const auto& [person, rows] : rows_) add_stays(person, rows);
    places_.begin = begin_of(time, first_s_, [&](double by_s) {
      for (StaySpec& stay : places_.stays) stay.from_s += by_s, stay.to_s += by_s;
    });
  }

 private:
  struct Row {
    double seconds;
    std::size_t row;
    std::optional<Vec2> point;
  };

  void add_row(const Row& row, const Where& where) {
    if (has_rows_ && row.seconds < last_s_)
      return repeated_.add("backwards", where, "time runs backwards: this row is earlier than the one before");
    if (has_rows_ && row.seconds > last_s_) step_s_ = std::min(step_s_, row.seconds - last_s_);
    if (!has_rows_) first_s_ = row.seconds;
    has_rows_ = true;
    last_s_ = row.seconds;
    if (!names_somebody(table_, row.row, columns_, repeated_)) return;
    const std::string& person = table_.text(row.row, *columns_.id);
    std::vector<Row>& own = rows_[person];
    if (!own.empty() && own.back().seconds == row.seconds)
      return repeated_.add("twice", where,
                           "'" + person + "' has another row of this time: nobody is in two places at once");
    own.push_back(row);
  }

  [[nodiscard]] const std::string& seat_of(const Row& row) const { return table_.text(row.row, *seat_); }
  /// Off the seat, or on the way off it.
  [[nodiscard]] bool is_up(const Row& row) const {
    constexpr std::array<std::string_view, 4> up{"rising", "turning", "standing", "walking"};
    return activity_ && std::ranges::find(up, table_.text(row.row, *activity_)) != up.end();
  }

  void add_stays(const std::string& person, const std::vector<Row>& rows) {
    for (std::size_t begin = 0; begin < rows.size();) {
      std::size_t end = begin + 1;
      const bool rests = is_at_rest(rows, begin);
      const auto goes_on = [&](std::size_t i) {
        return follows(rows, i) && seat_of(rows[i]) == seat_of(rows[begin]) &&
               (!seat_of(rows[begin]).empty() || is_at_rest(rows, i) == rests);
      };
      while (end < rows.size() && goes_on(end)) ++end;
      StaySpec stay;
      stay.person = person;
      stay.seat = seat_of(rows[begin]);
      std::size_t last = end - 1;
      while (!stay.seat.empty() && last > begin && is_up(rows[last])) --last;
      // What a row tells has begun since the row before.
      stay.from_s = rows[begin].seconds - (std::isfinite(step_s_) ? step_s_ : 0.0);
      stay.to_s = rows[last].seconds;
      if (rows[begin].point && rows[last].point) stay.points = {*rows[begin].point, *rows[last].point};
      stay.then = end < rows.size() && follows(rows, end) ? AfterStay::goes_on : AfterStay::leaves;
      stay.where = table_.where(rows[begin].row, *seat_);
      places_.stays.push_back(std::move(stay));
      begin = end;
    }
  }
  /// Is the row of the same visit as the one before?
  [[nodiscard]] bool follows(const std::vector<Row>& rows, std::size_t i) const {
    return rows[i].seconds - rows[i - 1].seconds < 1.5 * step_s_;
  }
  /// On foot, and in the same place as in the next rows or in the ones before.
  [[nodiscard]] bool is_at_rest(const std::vector<Row>& rows, std::size_t i) const {
    constexpr double still_m = 0.02;
    constexpr std::size_t still_rows = 3;  // assumed: less is a halt on the way (2-5)
    const auto still = [&](std::size_t from) {
      if (from + still_rows > rows.size()) return false;
      for (std::size_t k = from; k < from + still_rows; ++k) {
        if (!rows[k].point || !seat_of(rows[k]).empty() || (k > from && !follows(rows, k))) return false;
        if (glm::distance(*rows[k].point, *rows[from].point) > still_m) return false;
      }
      return true;
    };
    for (std::size_t back = 0; back < still_rows && back <= i; ++back) {
      if (still(i - back)) return true;
    }
    return false;
  }

  const CsvTable& table_;
  PlacesSpec& places_;
  Diagnostics& faults_;
  RepeatedFaults repeated_;
  PersonColumns columns_;
  std::optional<std::size_t> seat_, activity_;
  std::map<std::string, std::vector<Row>> rows_;
  bool has_rows_ = false;
  double first_s_ = 0.0, last_s_ = 0.0;
  double step_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace

void read_places(const CsvTable& table, PlacesSpec& places, Diagnostics& faults) {
  PlacesReader(table, places, faults).read();
}

}  // namespace pirsim::io
