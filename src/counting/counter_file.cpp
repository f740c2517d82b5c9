// A counter as JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "counting/passes.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/input.hpp"
#include "pirsim/counting.hpp"
#include "pirsim/error.hpp"

namespace pirsim::counting {
namespace {

using Json = nlohmann::ordered_json;
constexpr int format_version = 1;

/// Probabilities in rows that add up to 1.
std::vector<double> probabilities(const Json& json, std::size_t n_rows, std::size_t n_columns) {
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
  const int value = json.get<int>();
  if (value < least || value > most) {
    throw std::domain_error(std::string(what) + " isn't from " + std::to_string(least) + " to " + std::to_string(most));
  }
  return value;
}

Counter counter_from(const Json& json) {
  if (json.at("pirsim_counter") != format_version)
    throw std::domain_error("pirsim_counter: this pirsim reads version " + std::to_string(format_version));
  constexpr int most_modes = 100, most_sensors = 1000, most_counts = 1000;
  Counter counter;
  counter.settings.step_s = positive(json.at("step_s"), "step_s");
  counter.settings.modes = whole(json.at("modes"), "modes", 1, most_modes);
  counter.n_sensors = whole(json.at("sensors"), "sensors", 1, most_sensors);
  counter.n_counts = whole(json.at("counts"), "counts", 2, most_counts);
  const std::size_t n = size(counter.n_states());
  counter.moves = probabilities(json.at("moves"), n, n);
  double weights = 0.0;
  for (const Json& room : json.at("rooms")) {
    RoomModel& model = counter.rooms.emplace_back();
    model.number = room.at("room").get<int>();
    model.weight = room.at("weight").get<double>();
    if (!(model.weight >= 0.0)) throw std::domain_error("a weight is below 0");
    weights += model.weight;
    model.first = probabilities(room.at("first"), 1, n);
    model.emissions = probabilities(room.at("emissions"), n, size(counter.n_symbols()));
  }
  if (!(std::abs(weights - 1.0) < 1e-6)) throw std::domain_error("the rooms' weights don't add up to 1");
  if (const auto error = json.find("expected_error"); error != json.end())
    counter.expected_error = Interval{error->at(0).get<double>(), error->at(1).get<double>()};
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
  if (counter.expected_error) json["expected_error"] = {counter.expected_error->low, counter.expected_error->high};
  io::write_text_file(file, json.dump() + '\n');
}

Counter read_counter(const std::filesystem::path& file) {
  const io::Input input = io::read_input(file);
  try {
    return counter_from(Json::parse(input.bytes));
  } catch (const nlohmann::json::parse_error&) {
    throw Error(ErrorCode::input, Where{file.string()},
                "isn't a counter: pirsim calibrate and pirsim.counting write one");
  } catch (const std::exception& fault) {
    throw Error(ErrorCode::input, Where{file.string()},
                std::string("isn't a counter as it should be: ") + fault.what());
  }
}

}  // namespace pirsim::counting
