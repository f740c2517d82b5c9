#include "show/run_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <utility>

#include "files/disk/compression.hpp"
#include "show/report.hpp"

namespace pirsim::io {
namespace {

using Json = detail::ChartJson;

/// Poses on a grid compress to half the size. A quarter of a millimetre and of a milliradian can't be seen.
double on_grid(double value) { return std::round(value * 4096.0) / 4096.0; }

ExportedRun on_grid(ExportedRun run) {
  for (ExportedPerson& person : run.people) {
    for (ExportedPart& part : person.parts) {
      for (Frame& frame : part.world_from_part) {
        frame.origin = {on_grid(frame.origin.x), on_grid(frame.origin.y), on_grid(frame.origin.z)};
        const Quat& q = frame.rotation;
        frame.rotation = {on_grid(q.w), on_grid(q.x), on_grid(q.y), on_grid(q.z)};
      }
    }
  }
  return run;
}

std::string base64(std::string_view bytes) {
  static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto byte = [&](std::size_t i) {
    return i < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) : 0U;
  };
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::uint32_t three = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) text += digits[three >> shift & 63U];
  }
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  return text.replace(text.size() - padding, padding, padding, '=');
}

std::string packed(std::string_view bytes) {
  std::ostringstream gzip;
  DataWriter writer(gzip, Compression::gzip);
  writer.write(bytes);
  writer.finish();
  return base64(gzip.str());
}

Json json(const Vec3& v) { return {on_grid(v.x), on_grid(v.y), on_grid(v.z)}; }

Json json(const std::vector<PagePlace>& places) {
  Json all = Json::array();
  for (const PagePlace& place : places) all.push_back({{"name", place.name}, {"position", json(place.position)}});
  return all;
}

Json json(const std::vector<PageArea>& areas) {
  Json all = Json::array();
  for (const PageArea& area : areas) {
    Json loops = Json::array();
    for (const std::vector<Vec2>& loop : area.loops) {
      Json points = Json::array();
      for (const Vec2& p : loop) points.push_back({on_grid(p.x), on_grid(p.y)});
      loops.push_back(std::move(points));
    }
    all.push_back({{"name", area.name}, {"position", json(area.position)}, {"loops", std::move(loops)}});
  }
  return all;
}

Json json(const PageSensor& sensor) {
  Json signal = Json::array();
  for (const double volts : sensor.signal_v) signal.push_back(std::round(volts * 1000.0) / 1000.0);
  return {{"id", sensor.id},
          {"model", sensor.model},
          {"position", json(sensor.world_from_sensor.origin)},
          {"forward", json(sensor.world_from_sensor.forward())},
          {"first_zone", sensor.first_zone},
          {"zone_rays", sensor.zone_rays},
          {"signal_v", std::move(signal)},
          {"positive_v", sensor.positive_v},
          {"negative_v", sensor.negative_v}};
}

/// A byte a pixel, 1 to 255 from the coldest to the warmest of all frames; 0: dead.
Json json(const PageArray& array) {
  float lowest = std::numeric_limits<float>::max(), highest = std::numeric_limits<float>::lowest();
  for (const std::vector<float>& frame : array.celsius) {
    for (const float value : frame) {
      if (!std::isnan(value)) lowest = std::min(lowest, value), highest = std::max(highest, value);
    }
  }
  const float step = std::max(highest - lowest, 0.1F) / 254.0F;
  std::string bytes;
  for (const std::vector<float>& frame : array.celsius) {
    for (const float value : frame)
      bytes += std::isnan(value) ? '\0' : static_cast<char>(1 + std::lround((value - lowest) / step));
  }
  return {{"id", array.id},     {"model", array.model},     {"position", json(array.world_from_sensor.origin)},
          {"rows", array.rows}, {"columns", array.columns}, {"lowest_c", lowest},
          {"step_k", step},     {"bytes", base64(bytes)},   {"at_key", array.at_key}};
}

Json json(const std::vector<Sample>& rows) {
  Json times = Json::array(), people = Json::array(), phases = Json::array(), bits = Json::array();
  Json people_of_areas = Json::array();
  for (const Sample& row : rows) {
    times.push_back(row.time_s);
    people.push_back(row.people);
    if (!row.people_of_areas.empty()) people_of_areas.push_back(row.people_of_areas);
    phases.push_back(row.phase);
    std::string text;
    for (const std::uint8_t bit : row.bits) text += bit != 0 ? '1' : '0';
    bits.push_back(std::move(text));
  }
  return {{"time_s", std::move(times)},
          {"people", std::move(people)},
          {"people_of_areas", std::move(people_of_areas)},
          {"phase", std::move(phases)},
          {"bits", std::move(bits)},
          {"first_clock", rows.empty() ? "" : rows.front().clock}};
}

/// Shares in whole percent, which is finer than a colour tells.
Json json(const PageMap& map) {
  Json sensors = Json::array();
  for (const std::vector<double>& shares : map.shares) {
    Json percents = Json::array();
    for (const double share : shares) percents.push_back(share < 0.0 ? -1L : std::lround(100.0 * share));
    sensors.push_back(std::move(percents));
  }
  return {{"name", map.name},           {"x", map.lower.x},
          {"z", map.lower.y},           {"height_m", map.height_m},
          {"spacing_m", map.spacing_m}, {"n_columns", map.n_columns},
          {"n_rows", map.n_rows},       {"percent", std::move(sensors)}};
}

std::string json_text(const RunPage& page) {
  Json all{{"title", page.title},       {"first_person", page.first_person}, {"run_s", page.run_s},
           {"window_s", page.window_s}, {"keys_s", page.run.key_times_s},    {"sensors", Json::array()},
           {"seats", json(page.seats)}, {"doors", json(page.doors)},         {"areas", json(page.areas)},
           {"counted", page.counted},   {"people", Json::array()},           {"active_zones", page.active_zones},
           {"rows", json(page.rows)}};
  for (const PageSensor& sensor : page.sensors) all["sensors"].push_back(json(sensor));
  if (!page.arrays.empty()) all["arrays"] = Json::array();
  for (const PageArray& array : page.arrays) all["arrays"].push_back(json(array));
  for (const ExportedPerson& person : page.run.people) all["people"].push_back(person.id);
  if (page.map) all["map"] = json(*page.map);
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The template's texts are written as they stand, what is between @ and @ is replaced.
void fill_in(std::ostream& out, std::string_view text,
             const std::vector<std::pair<std::string_view, std::string>>& values) {
  while (true) {
    const std::size_t begin = text.find('@');
    out << text.substr(0, begin);
    if (begin == std::string_view::npos) return;
    const std::size_t end = text.find('@', begin + 1);
    for (const auto& [name, value] : values) {
      if (name == text.substr(begin + 1, end - begin - 1)) out << value;
    }
    text.remove_prefix(end + 1);
  }
}

}  // namespace

void write_run_page(std::ostream& out, const RunPage& page) {
  fill_in(out, detail::view_page(),
          {{"title", detail::escaped(page.title)},
           {"about", detail::escaped(page.about)},
           {"made_by", detail::escaped(page.made_by)},
           {"style", std::string(detail::palette()) + std::string(detail::view_style())},
           {"glb", packed(to_glb(on_grid(page.run)))},
           {"data", packed(json_text(page))},
           {"three", std::string(detail::three_script())},
           {"script", std::string(detail::view_script())}});
}

}  // namespace pirsim::io
