#include "dataset/room_day.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/digest.hpp"
#include "io/files/compression.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/io.hpp"
#include "schema/areas.hpp"
#include "schema/clock.hpp"

namespace pirsim::dataset {
namespace {

/// Compressed as the ending of its name says.
std::string packed(const std::string& path, const std::string& text) {
  std::ostringstream out;
  io::DataWriter writer(out, io::compression_of(path));
  writer.write(text);
  writer.finish();
  return out.str();
}

/// Arrivals and departures in each window, by name, from who is over the floor at its end.
struct Movements {
  std::vector<int> arrivals, departures;  ///< (n_rows)
};

Movements movements(const RunResult& result) {
  Movements moved;
  std::set<std::string_view> before;
  std::size_t next = 0;
  for (const Sample& row : result.samples) {
    std::set<std::string_view> now;
    for (; next < result.occupants.size() && result.occupants[next].time_s <= row.time_s; ++next) {
      if (result.occupants[next].where == OccupantRow::Where::inside) now.insert(result.occupants[next].person);
    }
    const auto beyond = [](const auto& some, const auto& others) {
      return static_cast<int>(std::ranges::count_if(some, [&](const auto& one) { return !others.contains(one); }));
    };
    moved.arrivals.push_back(beyond(now, before));
    moved.departures.push_back(beyond(before, now));
    before = std::move(now);
  }
  return moved;
}

class DayWriter {
 public:
  DayWriter(const RecipeSpec& recipe, const SceneSpec& scene, const ColumnOwners& columns, RoomDay& made)
      : recipe_(recipe), columns_(columns), made_(made), room_(made.record.room), day_(made.record.day) {
    for (const SensorSpec& sensor : scene.sensors) sensors_.push_back(sensor.id);
    sensor_of_column_ = places(columns.sensors, sensors_);
    areas_ = Areas(scene).names();
    area_of_column_ = places(columns.areas, areas_);
    for (const DoorSpec& door : scene.doors) doors_.push_back(door.id);
    door_of_column_ = places(columns.doors, doors_);
  }

  void write(const RunResult& result) {
    const Movements moved = movements(result);
    note(result, moved);
    add(path("rows", recipe_.ending), rows(result.samples, moved));
    if (recipe_.occupants == Occupants::told) add(path("occupants", recipe_.ending), occupants(result.occupants));
    for (const Export shape : recipe_.exports) {
      if (shape == Export::uci864) {
        const int n_rows = rows_per_reading(recipe_.sensing).value();
        add(path("exports/uci864", ".csv"), to_uci864(readings(result.samples, n_rows), sensors_, areas_));
      }
      if (shape == Export::casas) add(path("exports/casas", ".txt"), to_casas(result, sensors_, doors_));
    }
  }

  void add(const std::string& path, const std::string& text) {
    std::string bytes = packed(path, text);
    made_.record.files.push_back({path, bytes.size(), sha256(bytes)});
    made_.contents.emplace(path, std::move(bytes));
  }

 private:
  /// Of each name among those of the room; -1: the room has none of that name.
  static std::vector<int> places(const std::vector<std::string>& names, const std::vector<std::string>& of_room) {
    std::vector<int> found;
    for (const std::string& name : names) {
      const auto at = std::ranges::find(of_room, name);
      found.push_back(at == of_room.end() ? -1 : static_cast<int>(at - of_room.begin()));
    }
    return found;
  }

  [[nodiscard]] std::string path(const std::string& folder, const std::string& ending) const {
    return day_path(folder, room_, day_, ending);
  }

  [[nodiscard]] double window_s() const {
    return static_cast<double>(recipe_.sensing.ticks_per_window) / recipe_.sensing.tick_rate_hz;
  }

  [[nodiscard]] std::string rows(const std::vector<Sample>& samples, const Movements& moved) const {
    std::ostringstream text;
    io::TableWriter<DayLine> csv(text, column_names<DayLine>(columns_));
    for (std::size_t i = 0; i < samples.size(); ++i)
      csv.write({room_, day_, samples[i], moved.arrivals[i], moved.departures[i], sensor_of_column_, area_of_column_,
                 door_of_column_});
    return text.str();
  }

  [[nodiscard]] std::string occupants(const std::vector<OccupantRow>& rows) const {
    std::ostringstream text;
    io::TableWriter<DayOccupantLine> csv(text, column_names<DayOccupantLine>(columns_));
    for (const OccupantRow& row : rows) csv.write({room_, day_, row});
    return text.str();
  }

  void note(const RunResult& result, const Movements& moved) {
    RoomDayRecord& record = made_.record;
    record.rows = result.samples.size();
    record.seconds = static_cast<double>(record.rows) * window_s();
    std::array<double, 24> rows_in_hour{};
    for (std::size_t i = 0; i < result.samples.size(); ++i) {
      const Sample& row = result.samples[i];
      record.most_people = std::max(record.most_people, row.people);
      record.arrivals += static_cast<std::uint64_t>(moved.arrivals[i]);
      record.departures += static_cast<std::uint64_t>(moved.departures[i]);
      MotionCount& count = record.rows_by_people[row.people];
      ++count.all;
      if (std::ranges::any_of(row.bits, [](auto bit) { return bit != 0; })) ++count.with_motion;
      const std::size_t hour = hour_of(row);
      rows_in_hour[hour] += 1.0;
      record.presence[hour] += row.people > 0 ? 1.0 : 0.0;
      record.people[hour] += row.people;
      for (std::size_t area = 0; area < areas_.size(); ++area) {
        DayProfile& profile = record.areas[areas_[area]];
        profile.presence[hour] += row.people_of_areas[area] > 0 ? 1.0 : 0.0;
        profile.people[hour] += row.people_of_areas[area];
      }
    }
    const auto per_row = [&](std::array<double, 24>& sums) {
      for (std::size_t hour = 0; hour < 24; ++hour) {
        if (rows_in_hour[hour] != 0.0) sums[hour] /= rows_in_hour[hour];
      }
    };
    per_row(record.presence);
    per_row(record.people);
    for (auto& [area, profile] : record.areas) per_row(profile.presence), per_row(profile.people);
    if (const auto n_rows = rows_per_reading(recipe_.sensing)) {
      for (const Reading& reading : readings(result.samples, *n_rows)) {
        MotionCount& count = record.readings_by_people[reading.people];
        ++count.all;
        if (reading.any()) ++count.with_motion;
      }
    }
    for (const RunIncident& incident : result.incidents)
      record.passes_through += incident.kind == IncidentKind::passed_through ? 1 : 0;
  }

  /// A window that ends on the hour belongs to the hour before.
  static std::size_t hour_of(const Sample& row) {
    const auto digits = [&](std::size_t at) { return 10 * (row.clock[at] - '0') + (row.clock[at + 1] - '0'); };
    const int seconds = 3600 * digits(11) + 60 * digits(14) + digits(17);
    return static_cast<std::size_t>((seconds + 24 * 3600 - 1) % (24 * 3600) / 3600);
  }

  const RecipeSpec& recipe_;
  const ColumnOwners& columns_;  ///< of the dataset
  RoomDay& made_;
  int room_, day_;
  std::vector<std::string> sensors_, areas_, doors_;
  std::vector<int> sensor_of_column_, area_of_column_, door_of_column_;
};

}  // namespace

Model Room::model(ScriptSpec script) const {
  std::unique_lock lock(mutex_);
  if (!first_) return first_.emplace(compile(scene_, std::move(script)));
  lock.unlock();  // nobody changes it any more
  return compile(scene_, std::move(script), {.like = &*first_});
}

RoomDay simulate(const RecipeSpec& recipe, const Room& room, int day, const ColumnOwners& columns) {
  RoomDay made;
  RoomDayRecord& record = made.record;
  record.room = room.number();
  record.day = day;
  record.scene = room.file();
  ScriptSpec script = script_of(recipe, room.scene(), room.number(), day);
  const ScheduleSpec& schedule = *script.trials.front().schedule;
  record.date = clock_text(day_number(schedule.first_day, schedule.where) + day - 1, 0.0).substr(0, 10);
  record.ambient_c = script.sensing.ambient_c;
  for (const StaffSpec& staff : schedule.staff) record.staff += staff.count;
  if (schedule.household) record.staff += static_cast<int>(schedule.household->residents.size());
  record.effects = script.effects;
  DayWriter writer(recipe, room.scene(), columns, made);
  const std::string script_text = io::to_yaml(script);
  try {
    const Model model = room.model(std::move(script));
    const RunResult result =
        run_once(model, static_cast<std::uint32_t>(day - 1), Record::samples, Trace::none, Occupants::told);
    if (result.fault) {
      record.fault = result.fault->message;
    } else {
      writer.write(result);
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    record.fault = error.what();
  }
  if (record.fault.empty()) writer.add(day_path("scripts", room.number(), day, ".yaml"), script_text);
  return made;
}

// -- as JSON ---------------------------------------------------------------------------------------------------------

namespace {

using nlohmann::json;

json counts_to_json(const std::map<int, MotionCount>& counts) {
  json list = json::array();
  for (const auto& [people, count] : counts) list.push_back({people, count.all, count.with_motion});
  return list;
}
std::map<int, MotionCount> counts_from_json(const json& list) {
  std::map<int, MotionCount> counts;
  for (const json& one : list) {
    counts[one.at(0).get<int>()] = {one.at(1).get<std::uint64_t>(), one.at(2).get<std::uint64_t>()};
  }
  return counts;
}

json file_to_json(const WrittenFile& file) {
  return {{"path", file.path}, {"bytes", file.bytes}, {"sha256", file.sha256}};
}
WrittenFile file_from_json(const json& file) { return {file.at("path"), file.at("bytes"), file.at("sha256")}; }

}  // namespace

std::string to_json(const RoomDayRecord& r) {
  json effects = json::array(), files = json::array();
  for (const EffectSpec& effect : r.effects)
    effects.push_back({{"name", effect.name}, {"parameters", effect.parameters}, {"choices", effect.choices}});
  for (const WrittenFile& file : r.files) files.push_back(file_to_json(file));
  json document{{"room", r.room},
                {"day", r.day},
                {"date", r.date},
                {"rows", r.rows},
                {"seconds", r.seconds},
                {"ambient_c", r.ambient_c},
                {"staff", r.staff},
                {"most_people", r.most_people},
                {"arrivals", r.arrivals},
                {"departures", r.departures},
                {"passes_through", r.passes_through},
                {"rows_by_people", counts_to_json(r.rows_by_people)},
                {"readings_by_people", counts_to_json(r.readings_by_people)},
                {"presence", r.presence},
                {"people", r.people},
                {"effects", effects},
                {"files", files},
                {"fault", r.fault}};
  for (const auto& [area, profile] : r.areas) document["areas"][area] = {profile.presence, profile.people};
  if (r.scene) document["scene"] = file_to_json(*r.scene);
  return document.dump();
}

RoomDayRecord record_from_json(const std::string& text, const std::string& name) {
  try {
    const json d = json::parse(text);
    RoomDayRecord r;
    r.room = d.at("room");
    r.day = d.at("day");
    r.date = d.at("date");
    r.rows = d.at("rows");
    r.seconds = d.at("seconds");
    r.ambient_c = d.at("ambient_c");
    r.staff = d.at("staff");
    r.most_people = d.at("most_people");
    r.arrivals = d.at("arrivals");
    r.departures = d.at("departures");
    r.passes_through = d.at("passes_through");
    r.rows_by_people = counts_from_json(d.at("rows_by_people"));
    r.readings_by_people = counts_from_json(d.at("readings_by_people"));
    r.presence = d.at("presence").get<std::array<double, 24>>();
    r.people = d.at("people").get<std::array<double, 24>>();
    for (const json& e : d.at("effects")) {
      EffectSpec& effect = r.effects.emplace_back();
      effect.name = e.at("name");
      for (const auto& [key, value] : e.at("parameters").items()) effect.parameters[key] = value;
      for (const auto& [key, value] : e.at("choices").items()) effect.choices[key] = value;
    }
    for (const json& f : d.at("files")) r.files.push_back(file_from_json(f));
    if (d.contains("areas")) {
      for (const auto& [area, profile] : d.at("areas").items())
        r.areas[area] = {profile.at(0).get<std::array<double, 24>>(), profile.at(1).get<std::array<double, 24>>()};
    }
    if (d.contains("scene")) r.scene = file_from_json(d.at("scene"));
    r.fault = d.at("fault");
    return r;
  } catch (const json::exception& fault) {
    throw Error(ErrorCode::input, Where{name}, std::string("isn't what pirsim writes of a room-day: ") + fault.what());
  }
}

}  // namespace pirsim::dataset
