// A counter as JSON.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "counting/passes.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/input.hpp"
#include "pirsim/counting.hpp"
#include "pirsim/error.hpp"
#include "schema/limits.hpp"

namespace pirsim::counting {
namespace {

using Json = nlohmann::ordered_json;
constexpr int format_version = 1;

/// Probabilities in rows that add up to 1.
std::vector<double> probabilities(const Json& json, std::size_t n_rows, std::size_t n_columns) {
  const bool all_numbers = std::ranges::all_of(json, [](const Json& value) { return value.is_number(); });
  if (!json.is_array() || !all_numbers) throw std::domain_error("a table isn't a list of numbers");
  const auto values = json.get<std::vector<double>>();
  if (values.size() != n_rows * n_columns) throw std::domain_error("a table has another size than its counts ask for");
  for (std::size_t row = 0; row < n_rows; ++row) {
    double sum = 0.0;
    for (std::size_t column = 0; column < n_columns; ++column) {
      const double value = values[row * n_columns + column];
      if (!(value >= 0.0 && value <= 1.0)) throw std::domain_error("a probability isn't between 0 and 1");
      sum += value;
    }
    if (std::abs(sum - 1.0) > 1e-6) throw std::domain_error("probabilities don't add up to 1");
  }
  return values;
}

double positive(const Json& json, const char* what) {
  const double value = json.get<double>();
  if (!(value > 0.0) || !std::isfinite(value)) throw std::domain_error(std::string(what) + " isn't above 0");
  return value;
}

int whole(const Json& json, const char* what, int least, int most) {
  const double value = json.is_number_integer() ? json.get<double>() : least - 1.0;
  if (value < least || value > most) {
    throw std::domain_error(std::string(what) + " isn't a whole number from " + std::to_string(least) + " to " +
                            std::to_string(most));
  }
  return json.get<int>();
}

/// No reading is impossible, whoever is there: else there may be nobody left to believe in. Products with moves and
/// beliefs stay far above the least number that there is.
std::vector<double> emissions(const Json& json, std::size_t n_states, std::size_t n_symbols) {
  constexpr double least = 1e-100;  // assumed: of training the least is some 1e-9
  std::vector<double> values = probabilities(json, n_states, n_symbols);
  if (!std::ranges::all_of(values, [](double value) { return value >= least; }))
    throw std::domain_error("an emission is below 1e-100: no reading is impossible");
  return values;
}

std::vector<std::string> names(const Json& json, int n_sensors) {
  auto names = json.get<std::vector<std::string>>();
  if (names.size() != size(n_sensors)) throw std::domain_error("sensor_names has another number of names than sensors");
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::ranges::find(names.begin() + static_cast<std::ptrdiff_t>(i) + 1, names.end(), names[i]) != names.end())
      throw std::domain_error("sensor_names has '" + names[i] + "' twice");
  }
  return names;
}

std::vector<std::optional<double>> holds(const Json& json, int n_sensors) {
  std::vector<std::optional<double>> holds;
  for (const Json& one : json) {
    if (!one.is_null() && !(one.get<double>() >= 0.0)) throw std::domain_error("holds_s has a value below 0");
    holds.push_back(one.is_null() ? std::nullopt : std::optional(one.get<double>()));
  }
  if (holds.size() != size(n_sensors)) throw std::domain_error("holds_s has another number of values than sensors");
  return holds;
}

const Json& member(const Json& json, const char* key) {
  if (!json.is_object() || !json.contains(key)) throw std::domain_error(std::string(key) + " is missing");
  return json.at(key);
}

Counter counter_from(const Json& json) {
  if (member(json, "pirsim_counter") != format_version)
    throw std::domain_error("pirsim_counter: this pirsim reads version " + std::to_string(format_version));
  if (const auto model = json.find("model"); model != json.end())
    throw std::domain_error("it counts by another model than hidden Markov; pirsim.counting of Python counts with it");
  constexpr int most_modes = 100, most_sensors = 1000, most_counts = 1000;
  Counter counter;
  counter.settings.step_s = positive(member(json, "step_s"), "step_s");
  constexpr double longest_step_s = 86'400.0;
  if (counter.settings.step_s > longest_step_s) throw std::domain_error("step_s is longer than a day");
  counter.settings.modes = whole(member(json, "modes"), "modes", 1, most_modes);
  counter.n_sensors = whole(member(json, "sensors"), "sensors", 1, most_sensors);
  counter.n_counts = whole(member(json, "counts"), "counts", 2, most_counts);
  const std::size_t n = size(counter.n_states());
  counter.moves = probabilities(member(json, "moves"), n, n);
  double weights = 0.0;
  for (const Json& room : member(json, "rooms")) {
    RoomModel& model = counter.rooms.emplace_back();
    constexpr int most_rooms = 1'000'000'000;
    model.number = whole(member(room, "room"), "room", 0, most_rooms);
    model.weight = member(room, "weight").get<double>();
    if (!(model.weight >= 0.0)) throw std::domain_error("a weight is below 0");
    weights += model.weight;
    model.first = probabilities(member(room, "first"), 1, n);
    model.emissions = emissions(member(room, "emissions"), n, size(counter.n_symbols()));
  }
  if (!(std::abs(weights - 1.0) < 1e-6)) throw std::domain_error("the rooms' weights don't add up to 1");
  if (const auto error = json.find("expected_error"); error != json.end())
    counter.expected_error = Interval{error->at(0).get<double>(), error->at(1).get<double>()};
  if (const auto warning = json.find("warning"); warning != json.end()) counter.warning = warning->get<std::string>();
  if (const auto told = json.find("sensor_names"); told != json.end())
    counter.sensors = names(*told, counter.n_sensors);
  if (const auto told = json.find("holds_s"); told != json.end()) counter.holds_s = holds(*told, counter.n_sensors);
  return counter;
}

}  // namespace

void write_counter(const std::filesystem::path& file, const Counter& counter) {
  Json rooms = Json::array();
  for (const RoomModel& room : counter.rooms) {
    rooms.push_back(
        {{"room", room.number}, {"weight", room.weight}, {"first", room.first}, {"emissions", room.emissions}});
  }
  Json json{{"pirsim_counter", format_version}, {"step_s", counter.settings.step_s}, {"modes", counter.settings.modes},
            {"sensors", counter.n_sensors},     {"counts", counter.n_counts},        {"moves", counter.moves},
            {"rooms", std::move(rooms)}};
  if (!counter.warning.empty()) json["warning"] = counter.warning;
  if (!counter.sensors.empty()) json["sensor_names"] = counter.sensors;
  for (const std::optional<double>& hold_s : counter.holds_s)
    json["holds_s"].push_back(hold_s ? Json(*hold_s) : Json());
  if (counter.expected_error) json["expected_error"] = {counter.expected_error->low, counter.expected_error->high};
  io::write_text_file(file, json.dump() + '\n');
}

std::string read_counter_bytes(const std::filesystem::path& file) {
  return io::read_input(file, limits::counter_bytes).bytes;
}

Counter parse_counter(std::string_view bytes, const std::string& name) {
  try {
    return counter_from(Json::parse(bytes));
  } catch (const nlohmann::json::parse_error&) {
    throw Error(ErrorCode::input, Where{name}, "isn't a counter: pirsim calibrate and pirsim.counting write one");
  } catch (const std::exception& fault) {
    throw Error(ErrorCode::input, Where{name}, std::string("isn't a counter as it should be: ") + fault.what());
  }
}

Counter read_counter(const std::filesystem::path& file) {
  return parse_counter(read_counter_bytes(file), file.string());
}

}  // namespace pirsim::counting
