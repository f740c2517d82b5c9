#include "rooms/room_day.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "files/disk/compression.hpp"
#include "files/write/campaign.hpp"
#include "files/write/casas_writer.hpp"
#include "files/write/frame_writer.hpp"
#include "model/core/random.hpp"
#include "model/schema/check_scene.hpp"
#include "model/schema/clock.hpp"
#include "model/schema/fingerprint.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/io.hpp"
#include "pirsim/version.hpp"
#include "rooms/flat.hpp"
#include "rooms/flat_layout.hpp"
#include "rooms/floor_plan.hpp"

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

  void write(const RunResult& result, const std::vector<SensorSpec>& arrays) {
    const Movements moved = movements(result);
    note(result, moved);
    add(path("rows", recipe_.ending), rows(result.samples, moved));
    if (recipe_.occupants == Occupants::told) add(path("occupants", recipe_.ending), occupants(result.occupants));
    for (std::size_t i = 0; i < result.frames.size(); ++i)
      add(path("frames", '_' + io::file_part(arrays[i].id) + ".npy"), io::to_npy(result.frames[i]));
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
    const RunResult result = run_once(model, static_cast<std::uint32_t>(day - 1), Record::samples, Trace::none,
                                      Occupants::told, recipe.frames);
    if (result.fault) {
      record.fault = result.fault->message;
    } else {
      writer.write(result, room.scene().arrays);
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

namespace fs = std::filesystem;

namespace {

std::string hash_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  Sha256 hash;
  std::string piece(1U << 20U, '\0');
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0)
    hash.add({piece.data(), static_cast<std::size_t>(in.gcount())});
  return hash.hex();
}

void add_sensors(Fingerprint& print, const FlatSpec& flats, const io::SceneOptions& options) {
  for (const SensorsAt at : flats.sensors_at) {
    for (const Mount mount : flats.mounts) {
      for (const std::string& model : models_of(flats, at, mount))
        print.add(io::find_sensor_model(model, {}, options, flats.models_where));
    }
  }
}

/// Of drawn rooms or homes.
void add_sensors(Fingerprint& print, const RoomGroupSpec& group, const io::SceneOptions& options) {
  if (group.home) return add_sensors(print, group.home->flats, options);
  for (const SensorGroupSpec& sensors : group.rooms.sensors) {
    for (const std::string& model : models_of(sensors))
      print.add(io::find_sensor_model(model, {}, options, sensors.where));
  }
}

/// "room.gltf 9f86d0...", of a file that the scene was read from.
std::string hash_told(const fs::path& file, const SceneSpec& scene) {
  const auto read = std::ranges::find(scene.files, file.string(), &InputFile::path);
  return file.filename().string() + ' ' + read->sha256;
}

std::string provenance_of(const RecipeSpec& recipe, const std::map<OwnScene, SceneSpec>& own_scenes,
                          const io::SceneOptions& options) {
  std::string text = "recipe " + sha256(recipe.text);
  Fingerprint print;
  for (const RoomGroupSpec& group : recipe.rooms) {
    for (const OwnScene& own : group.scenes) {
      const SceneSpec& scene = own_scenes.at(own);
      text += ", " + hash_told(own.file, scene);
      if (!own.marks.empty()) text += ", " + hash_told(own.marks, scene);
      print.add(scene);
    }
    if (group.scenes.empty()) add_sensors(print, group, options);
  }
  return text + ", sensors " + print.digest().substr(0, 16) + ", " + program() + ", " + compiler();
}

/// Groups of nothing but arrays have no column.
bool has_columns(const SensorGroupSpec& group, const io::SceneOptions& options) {
  return std::ranges::any_of(models_of(group), [&](const std::string& model) {
    return !io::find_sensor_model(model, {}, options, group.where).array;
  });
}

/// PIR1, PIR2, ..., as many as a drawn room may have.
std::vector<std::string> numbered_sensors(const RecipeSpec& recipe, const io::SceneOptions& options) {
  int most = 0;
  for (const RoomGroupSpec& group : recipe.rooms) {
    int sensors = 0;
    if (!group.scenes.empty() || group.home) continue;
    for (const SensorGroupSpec& sensor : group.rooms.sensors)
      sensors += has_columns(sensor, options) ? sensor.count.most : 0;
    most = std::max(most, sensors);
  }
  std::vector<std::string> names;
  for (int i = 1; i <= most; ++i) names.push_back("PIR" + std::to_string(i));
  return names;
}

void add_new(std::vector<std::string>& names, const std::vector<std::string>& more) {
  for (const std::string& name : more) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
}

ColumnOwners columns_of(const RecipeSpec& recipe, const std::map<OwnScene, SceneSpec>& own_scenes,
                        const io::SceneOptions& options) {
  ColumnOwners columns;
  columns.sensors = numbered_sensors(recipe, options);
  const auto add = [&](const ColumnOwners& names) {
    add_new(columns.sensors, names.sensors);
    add_new(columns.areas, names.areas);
    add_new(columns.doors, names.doors);
  };
  for (const RoomGroupSpec& group : recipe.rooms) {
    if (group.home) add(columns_of(group.home->flats));
    for (const OwnScene& own : group.scenes) {
      const SceneSpec& scene = own_scenes.at(own);
      ColumnOwners names{{}, Areas(scene).names(), {}};
      for (const SensorSpec& sensor : scene.sensors) names.sensors.push_back(sensor.id);
      for (const DoorSpec& door : scene.doors) names.doors.push_back(door.id);
      add(names);
    }
  }
  return columns;
}

constexpr const char* journal_ending = ".journal";

/// Of a whole dataset, or of one shard.
std::string journal_name(const std::optional<Shard>& shard) {
  return (shard ? studies::shard_name(*shard) : "dataset") + journal_ending;
}

}  // namespace

Store::Store(const RecipeSpec& recipe, fs::path folder, const io::SceneOptions& scenes)
    : recipe_(recipe), folder_(std::move(folder)), scenes_(scenes) {
  for (const RoomGroupSpec& group : recipe.rooms) {
    for (const OwnScene& own : group.scenes) {
      if (!own_scenes_.contains(own)) own_scenes_.emplace(own, read_own(own, scenes_));
    }
  }
  provenance_ = provenance_of(recipe_, own_scenes_, scenes_);
  columns_ = columns_of(recipe_, own_scenes_, scenes_);
}

const SceneSpec* Store::own_scene(int room) const {
  const OwnScene* own = dataset::own_scene(recipe_, room);
  return own == nullptr ? nullptr : &own_scenes_.at(*own);
}

bool Store::is_whole(const WrittenFile& written, Look look) const {
  const fs::path file = folder_ / written.path;
  std::error_code fault;
  if (!fs::is_regular_file(file, fault) || fs::file_size(file, fault) != written.bytes || fault) return false;
  return look == Look::sizes || hash_of(file) == written.sha256;
}

bool Store::is_whole(const RoomDayRecord& record, Look look) const {
  const auto is_there = [&](const WrittenFile& written) { return is_whole(written, look); };
  return std::ranges::all_of(record.files, is_there) &&
         (look == Look::sizes || !record.scene || is_there(*record.scene));
}

std::vector<fs::path> Store::journals() const {
  std::vector<fs::path> files;
  std::error_code fault;  // of a folder that isn't there yet
  for (const auto& entry : fs::directory_iterator(folder_, fault)) {
    if (entry.path().extension() == journal_ending) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::map<std::uint32_t, RoomDayRecord> Store::records() const {
  std::map<std::uint32_t, RoomDayRecord> records;
  for (const fs::path& file : journals()) {
    const auto journal = io::Journal::read(file);
    if (!journal || journal->made_from != provenance_) continue;
    for (const std::string& piece : journal->pieces) {
      RoomDayRecord record = record_from_json(piece, file.string());
      const std::uint32_t index = index_of(recipe_, record.room, record.day);
      records.insert_or_assign(index, std::move(record));
    }
  }
  return records;
}

io::Journal Store::open_journal(const std::optional<Shard>& shard, DatasetOptions::Start start) const {
  const fs::path file = folder_ / journal_name(shard);
  io::Journal journal(file);
  const auto found = start == DatasetOptions::Start::resume ? io::Journal::read(file) : std::nullopt;
  if (found && found->made_from == provenance_) {
    journal.resume(*found);
  } else {
    journal.begin(provenance_);
  }
  return journal;
}

void Store::join_journals(const std::vector<RoomDayRecord>& records) const {
  std::vector<io::Journal> open;  // so that nobody adds to one meanwhile
  const fs::path whole = folder_ / journal_name({});
  std::vector<io::Journal> parts;
  for (const fs::path& file : journals()) (file == whole ? open : parts).emplace_back(file);
  io::Journal::Content all{provenance_, {}};
  for (const RoomDayRecord& record : records) all.pieces.push_back(to_json(record));
  io::write_text_file(whole, io::Journal::text(all));
  for (io::Journal& part : parts) part.remove();
}

void begin(const DatasetObserver& observer, DatasetObserver::Stage stage, std::size_t total) {
  if (observer.begin) observer.begin(stage, static_cast<std::uint32_t>(total));
}
void done_one(const DatasetObserver& observer) {
  if (observer.done_one) observer.done_one();
}

void make_folders(const fs::path& folder) {
  std::error_code fault;
  fs::create_directories(folder, fault);
  if (fault) throw Error(ErrorCode::io, Where{folder.string()}, "can't make the folder: " + fault.message());
}

void write_once(const fs::path& file, const std::string& text) {
  make_folders(file.parent_path());
  if (io::write_once(file, text)) return;
  throw Error(ErrorCode::input, Where{file.string()},
              "isn't what this recipe makes: move it away, or name another folder");
}

}  // namespace pirsim::dataset
