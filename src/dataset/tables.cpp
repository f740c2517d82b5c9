#include <algorithm>
#include <cmath>

#include "dataset/description.hpp"
#include "pirsim/csv.hpp"

namespace pirsim::dataset {
namespace {

std::string rounded(double value) { return io::csv_number(std::round(1000.0 * value) / 1000.0); }

std::string kind_of(const DescribedRoom& room) {
  if (!room.kind) return "own";
  return *room.kind == RoomKind::office ? "office" : "meeting";
}

std::string rooms_table(const Description& described) {
  std::string text = "room,part,kind,scene,floor_m2,doors,seats,sensors,staff\n";
  for (const DescribedRoom& room : described.rooms) {
    const SceneSpec& scene = room.scene;
    text += std::to_string(room.number) + ',' + (room.part == Part::test_days ? "train" : name_of(room.part)) + ',' +
            kind_of(room) + ',' + io::csv_field(room.scene_file) + ',' + rounded(scene.floor.area_m2()) + ',' +
            std::to_string(scene.entrances.size()) + ',' + std::to_string(scene.seats.size()) + ',' +
            std::to_string(scene.sensors.size()) + ',' + std::to_string(room.staff) + '\n';
  }
  return text;
}

std::string sensors_table(const Description& described) {
  std::string text = "room,sensor,model,x_m,y_m,z_m,heading_deg,tilt_deg\n";
  for (const DescribedRoom& room : described.rooms) {
    for (const SensorSpec& sensor : room.scene.sensors) {
      const Frame& frame = sensor.world_from_sensor;
      const Vec3 forward = frame.forward();
      const double down = degrees(std::asin(std::clamp(-forward.y, -1.0, 1.0)));
      // Of one that looks straight down, where its picture's upper edge points.
      const bool looks_down = down > 89.9;
      const double heading = degrees(heading_of(looks_down ? floor_point(frame.up()) : floor_point(forward)));
      text += std::to_string(room.number) + ',' + io::csv_field(sensor.id) + ',' + io::csv_field(sensor.model) + ',' +
              rounded(frame.origin.x) + ',' + rounded(frame.origin.y) + ',' + rounded(frame.origin.z) + ',' +
              rounded(heading) + ',' + rounded(down) + '\n';
    }
  }
  return text;
}

std::string days_table(const Description& described) {
  std::string text =
      "room,day,date,part,rows,hours,most_people,presence_share,arrivals,departures,passes_through,failed\n";
  for (std::size_t i = 0; i < described.days.size(); ++i) {
    const RoomDayRecord& day = described.days[i];
    const auto empty = day.rows_by_people.find(0);
    const double absent = empty == day.rows_by_people.end() ? 0.0 : static_cast<double>(empty->second.all);
    text += std::to_string(day.room) + ',' + std::to_string(day.day) + ',' + day.date + ',' +
            name_of(described.parts[i]) + ',' + std::to_string(day.rows) + ',' + rounded(day.seconds / 3600.0) + ',' +
            std::to_string(day.most_people) + ',' +
            (day.rows == 0 ? "" : rounded(1.0 - absent / static_cast<double>(day.rows))) + ',' +
            std::to_string(day.arrivals) + ',' + std::to_string(day.departures) + ',' +
            std::to_string(day.passes_through) + ',' + io::csv_field(day.fault) + '\n';
  }
  return text;
}

std::string effects_table(const Description& described) {
  std::string text = "room,day,effect,sensor,parameter,value\n";
  for (const RoomDayRecord& day : described.days) {
    for (const EffectSpec& effect : day.effects) {
      const auto sensor = effect.choices.find("sensor");
      const std::string begin = std::to_string(day.room) + ',' + std::to_string(day.day) + ',' + effect.name + ',' +
                                (sensor == effect.choices.end() ? "" : io::csv_field(sensor->second)) + ',';
      for (const auto& [name, value] : effect.parameters) text += begin + name + ',' + io::csv_number(value) + '\n';
      for (const auto& [name, choice] : effect.choices) {
        if (name != "sensor") text += begin + name + ',' + io::csv_field(choice) + '\n';
      }
    }
  }
  return text;
}

}  // namespace

std::map<std::string, std::string> tables(const Description& described) {
  return {{"rooms.csv", rooms_table(described)},
          {"sensors.csv", sensors_table(described)},
          {"days.csv", days_table(described)},
          {"effects.csv", effects_table(described)}};
}

}  // namespace pirsim::dataset
