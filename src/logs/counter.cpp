#include "logs/counter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "files/disk/file.hpp"
#include "model/core/parallel.hpp"
#include "model/core/text.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/counting.hpp"
#include "pirsim/error.hpp"
#include "pirsim/random.hpp"

namespace pirsim::counting {
namespace {

double choose(int n, int k) {
  double ways = 1.0;
  for (int i = 1; i <= k; ++i) ways *= static_cast<double>(n - k + i) / i;
  return k < 0 || k > n ? 0.0 : ways;
}

double normalize(std::span<double> values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  for (double& value : values) value /= sum;
  return sum;
}

// The Baum-Welch algorithm where the counts are known and the modes are not.

constexpr double least_move = 1e-3;  ///< pseudo-moves, shared as the first ones are: none becomes impossible

int counts_of(std::span<const LabelledRoom> rooms) {
  int most = 0;
  for (const LabelledRoom& room : rooms) {
    for (const Stretch& day : room.days) {
      for (const int n : day.people) most = std::max(most, n);
    }
  }
  return most + 1;
}

/// How often each symbol comes with each count, in all rooms.
std::vector<double> seen_by_count(const Counter& counter, std::span<const LabelledRoom> rooms) {
  constexpr double pseudo_count = 1.0;
  const std::size_t n_symbols = size(counter.n_symbols());
  std::vector<double> seen(size(counter.n_counts) * n_symbols, pseudo_count);
  for (const LabelledRoom& room : rooms) {
    for (const Stretch& day : room.days) {
      for (const Reading& reading : readings_of(day)) {
        if (reading.people != unknown_count && reading.known == counter.n_sensors)
          seen[size(reading.people) * n_symbols + size(reading.active)] += 1.0;
      }
    }
  }
  divide_rows(seen, n_symbols);
  return seen;
}

std::vector<double> moves_by_count(const Counter& counter, std::span<const LabelledRoom> rooms) {
  constexpr double pseudo_count = 0.1;
  std::vector<double> moves(size(counter.n_counts * counter.n_counts), pseudo_count);
  for (const LabelledRoom& room : rooms) {
    for (const Stretch& day : room.days) {
      for (std::size_t i = 1; i < day.people.size(); ++i) {
        if (day.people[i - 1] != unknown_count && day.people[i] != unknown_count)
          moves[size(day.people[i - 1] * counter.n_counts + day.people[i])] += 1.0;
      }
    }
  }
  divide_rows(moves, size(counter.n_counts));
  return moves;
}

/// Where Baum-Welch begins: modes from quiet to busy, in which motion is less and more likely than on average.
std::vector<double> first_emissions(const Counter& counter, std::span<const LabelledRoom> rooms) {
  constexpr double odds = 4.0;  // between neighbouring modes; assumed, 2 to 8 tried
  const std::size_t n_symbols = size(counter.n_symbols());
  const std::vector<double> by_count = seen_by_count(counter, rooms);
  std::vector<double> emissions;
  for (int count = 0; count < counter.n_counts; ++count) {
    for (int mode = 0; mode < counter.settings.modes; ++mode) {
      const double tilt = std::pow(odds, mode - 0.5 * (counter.settings.modes - 1));
      for (std::size_t symbol = 0; symbol < n_symbols; ++symbol)
        emissions.push_back(by_count[size(count) * n_symbols + symbol] * (symbol == 0 ? 1.0 : tilt));
    }
  }
  divide_rows(emissions, n_symbols);
  return emissions;
}

std::vector<double> first_moves(const Counter& counter, std::span<const LabelledRoom> rooms) {
  constexpr double stays = 0.9;  // in its mode; assumed: training finds the same from 0.6
  const std::size_t modes = size(counter.settings.modes), n = size(counter.n_states());
  const std::vector<double> by_count = moves_by_count(counter, rooms);
  std::vector<double> moves(n * n);
  for (std::size_t from = 0; from < n; ++from) {
    for (std::size_t to = 0; to < n; ++to) {
      const double anywhere = 1.0 / static_cast<double>(modes);
      const bool same_count = from / modes == to / modes;
      const double of_mode = same_count ? (1.0 - stays) * anywhere + (from == to ? stays : 0.0) : anywhere;
      moves[from * n + to] = by_count[from / modes * size(counter.n_counts) + to / modes] * of_mode;
    }
  }
  divide_rows(moves, n);
  return moves;
}

/// What is expected of one room.
struct Expected {
  std::vector<double> moved;  ///< (states x states)
  std::vector<double> seen;   ///< (states x symbols)
  std::vector<double> been;   ///< (states)
};

Expected expected_of(const Counter& counter, const LabelledRoom& room, const RoomModel& model) {
  const std::size_t n = size(counter.n_states()), n_symbols = size(counter.n_symbols());
  Expected expected{std::vector<double>(n * n, 0.0), std::vector<double>(n * n_symbols, 0.0),
                    std::vector<double>(n, 0.0)};
  const RoomModel* const only = &model;
  const Lanes<1> lane(counter, std::span(&only, 1));
  std::vector<Lanes<1>::Values> moved(n * n);
  for (const Stretch& day : room.days) {
    const std::vector<Reading> readings = readings_of(day);
    std::vector<Lanes<1>::Values> beliefs = lane.forward(readings).beliefs;
    lane.smooth(readings, beliefs, moved);
    for (std::size_t i = 0; i < readings.size(); ++i) {
      for (std::size_t state = 0; state < n; ++state) {
        const double belief = beliefs[i * n + state][0];
        expected.been[state] += belief;
        if (readings[i].known == counter.n_sensors)
          expected.seen[state * n_symbols + size(readings[i].active)] += belief;
      }
    }
  }
  for (std::size_t i = 0; i < moved.size(); ++i) expected.moved[i] = moved[i][0];
  return expected;
}

void add(std::vector<double>& sum, const std::vector<double>& more) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
}

std::vector<Expected> expected_of_all(const Counter& counter, std::span<const LabelledRoom> rooms, unsigned threads) {
  std::vector<Expected> each;
  ordered_parallel<Expected>(
      rooms.size(), threads, [&](std::size_t r) { return expected_of(counter, rooms[r], counter.rooms[r]); },
      [&](Expected& one) { each.push_back(std::move(one)); });
  return each;
}

/// What was expected of a room, drawn to what all rooms have.
std::vector<double> drawn_to(const std::vector<double>& all, std::vector<double> own, double shrinkage,
                             std::size_t n_columns) {
  for (std::size_t i = 0; i < all.size(); ++i) own[i] += shrinkage * all[i];
  divide_rows(own, n_columns);
  return own;
}

/// One iteration: what is expected of all rooms, then what explains it best, with moves that all rooms share.
std::vector<double> improve(Counter& counter, std::span<const LabelledRoom> rooms,
                            const std::vector<double>& moves_at_first, unsigned threads) {
  const std::size_t n = size(counter.n_states()), n_symbols = size(counter.n_symbols());
  std::vector<Expected> each = expected_of_all(counter, rooms, threads);
  constexpr double pseudo_count = 0.5;
  std::vector<double> been(n, 1e-6), seen(n * n_symbols, pseudo_count), moved = moves_at_first;
  for (double& move : moved) move *= least_move;
  for (const Expected& one : each) {
    add(been, one.been);
    add(seen, one.seen);
    add(moved, one.moved);
  }
  divide_rows(moved, n);
  divide_rows(seen, n_symbols);
  for (std::size_t r = 0; r < each.size(); ++r) {
    counter.rooms[r].moves = moved;
    counter.rooms[r].emissions = drawn_to(seen, std::move(each[r].seen), counter.settings.shrinkage, n_symbols);
  }
  return been;
}

/// Only when all else is learned: rooms that learn with moves of their own are surer of their modes than they are right
/// (docs/counting.md).
void give_own_moves(Counter& counter, std::span<const LabelledRoom> rooms, unsigned threads) {
  std::vector<Expected> each = expected_of_all(counter, rooms, threads);
  for (std::size_t r = 0; r < each.size(); ++r) {
    counter.rooms[r].moves = drawn_to(counter.rooms[r].moves, std::move(each[r].moved), counter.settings.shrinkage,
                                      size(counter.n_states()));
  }
}

/// A room's counts as often as they were there, each in modes as in all rooms.
std::vector<double> first_of(const Counter& counter, const LabelledRoom& room, const std::vector<double>& been) {
  std::vector<double> counts(size(counter.n_counts), 1.0), first(been);
  for (const Stretch& day : room.days) {
    for (const int n : day.people) {
      if (n != unknown_count) counts[size(n)] += 1.0;
    }
  }
  divide_rows(counts, counts.size());
  divide_rows(first, size(counter.settings.modes));
  for (std::size_t state = 0; state < first.size(); ++state)
    first[state] *= counts[state / size(counter.settings.modes)];
  return first;
}

void require_alike(std::span<const LabelledRoom> rooms) {
  if (rooms.empty()) throw Error(ErrorCode::input, "there is no room to learn from");
  const auto lacks_days = std::ranges::find_if(rooms, [](const LabelledRoom& room) { return room.days.empty(); });
  if (lacks_days != rooms.end())
    throw Error(ErrorCode::input, "room " + std::to_string(lacks_days->number) + " has no days to learn from");
  const int n_sensors = rooms.front().days.front().n_sensors;
  for (const LabelledRoom& room : rooms) {
    for (const Stretch& day : room.days) {
      if (day.n_sensors != n_sensors || day.n_sensors == 0)
        throw Error(ErrorCode::input, "rooms " + std::to_string(rooms.front().number) + " and " +
                                          std::to_string(room.number) + " have " + std::to_string(n_sensors) + " and " +
                                          std::to_string(day.n_sensors) +
                                          " sensors: a counter learns from rooms that have as many");
      if (day.people.size() != day.n_readings())
        throw Error(ErrorCode::input, "room " + std::to_string(room.number) + ": its readings have no counts");
    }
  }
  if (counts_of(rooms) < 2) throw Error(ErrorCode::input, "nobody is in any of the rooms: there is nothing to learn");
}

constexpr double nobody_knows = std::numeric_limits<double>::quiet_NaN();
constexpr double never_s = std::numeric_limits<double>::infinity();

// A counter as JSON.

using Json = nlohmann::ordered_json;
constexpr int format_version = 2;

/// A value of a counter's file, and where in it. What isn't as it must be throws std::domain_error.
class Told {
 public:
  explicit Told(const Json& json, std::string path = {}) : json_(&json), path_(std::move(path)) {}

  [[noreturn]] void refuse(const std::string& why) const {
    throw std::domain_error(path_.empty() ? why : path_ + ": " + why);
  }
  [[nodiscard]] std::optional<Told> find(const std::string& key) const {
    if (!json_->is_object()) refuse("expected an object");
    const auto found = json_->find(key);
    return found == json_->end() ? std::nullopt : std::optional(Told(*found, path_.empty() ? key : path_ + '.' + key));
  }
  [[nodiscard]] Told member(const std::string& key) const {
    auto found = find(key);
    if (!found) refuse("'" + key + "' is missing");
    return *found;
  }
  [[nodiscard]] std::vector<Told> items() const {
    if (!json_->is_array()) refuse("expected a list");
    std::vector<Told> items;
    for (std::size_t i = 0; i < json_->size(); ++i)
      items.emplace_back((*json_)[i], path_ + '[' + std::to_string(i) + ']');
    return items;
  }
  [[nodiscard]] std::vector<Told> items(std::size_t n) const {
    auto found = items();
    if (found.size() != n) refuse("expected " + std::to_string(n) + " values, got " + std::to_string(found.size()));
    return found;
  }
  [[nodiscard]] bool is_null() const { return json_->is_null(); }
  [[nodiscard]] double number(double least, double most) const {
    const double value = json_->is_number() ? json_->get<double>() : nobody_knows;
    if (value >= least && value <= most) return value;
    refuse("expected a number" + (most < never_s ? " from " + shortest_number(least) + " to " + shortest_number(most)
                                  : least > -never_s ? " from " + shortest_number(least)
                                                     : ""));
  }
  [[nodiscard]] double positive() const {
    const double value = number(0.0, std::numeric_limits<double>::max());
    if (!(value > 0.0)) refuse("expected a number above 0");
    return value;
  }
  [[nodiscard]] int whole(int least, int most) const {
    if (json_->is_number_integer() && json_->get<double>() >= least && json_->get<double>() <= most)
      return json_->get<int>();
    refuse("expected a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  }
  [[nodiscard]] std::string text() const {
    if (!json_->is_string()) refuse("expected a text");
    return json_->get<std::string>();
  }
  [[nodiscard]] bool operator==(int number) const { return *json_ == number; }

  /// Probabilities, none below `least`, in rows that add up to 1.
  [[nodiscard]] std::vector<double> table(std::size_t n_rows, std::size_t n_columns, double least = 0.0) const {
    std::vector<double> values;
    for (const Told& value : items(n_rows * n_columns)) values.push_back(value.number(least, 1.0));
    for (std::size_t row = 0; row < n_rows; ++row) {
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(row * n_columns);
      if (std::abs(std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(n_columns), 0.0) - 1.0) > 1e-6)
        refuse("row " + std::to_string(row + 1) + " of probabilities doesn't add up to 1");
    }
    return values;
  }

 private:
  const Json* json_;
  std::string path_;
};

/// No reading is impossible, whoever is there: else there may be nobody left to believe in. Products with moves and
/// beliefs stay far above the least number that there is.
constexpr double least_emission = 1e-100;  // assumed: of training the least is some 1e-9

std::vector<std::string> names(const Told& told, int n_sensors) {
  std::vector<std::string> names;
  for (const Told& one : told.items(size(n_sensors))) {
    if (std::ranges::find(names, one.text()) != names.end()) one.refuse("'" + one.text() + "' stands here twice");
    names.push_back(one.text());
  }
  return names;
}

std::vector<std::optional<double>> holds(const Told& told, int n_sensors) {
  std::vector<std::optional<double>> holds;
  for (const Told& one : told.items(size(n_sensors)))
    holds.push_back(one.is_null() ? std::nullopt : std::optional(one.number(0.0, never_s)));
  return holds;
}

Interval interval(const Told& told) {
  const auto ends = told.items(2);
  return {ends[0].number(-never_s, never_s), ends[1].number(-never_s, never_s)};
}

Counter counter_from(const Told& told) {
  const Told version = told.member("pirsim_counter");
  const bool has_moves_in_common = version == 1;  // and rooms as lively as they are
  if (!has_moves_in_common && !(version == format_version))
    version.refuse("this pirsim reads versions 1 and " + std::to_string(format_version));
  if (told.find("model"))
    told.refuse("it counts by another model than hidden Markov; pirsim.counting of Python counts with it");
  constexpr int most_modes = 100, most_sensors = 1000, most_counts = 1000, most_rooms = 1'000'000'000;
  constexpr double longest_step_s = 86'400.0;
  Counter counter;
  counter.settings.step_s = told.member("step_s").positive();
  if (counter.settings.step_s > longest_step_s) told.member("step_s").refuse("longer than a day");
  counter.settings.modes = told.member("modes").whole(1, most_modes);
  counter.n_sensors = told.member("sensors").whole(1, most_sensors);
  counter.n_counts = told.member("counts").whole(2, most_counts);
  const std::size_t n = size(counter.n_states());
  double weights = 0.0;
  const auto add = [&](RoomModel model, const Told& of) {
    model.weight = of.member("weight").number(0.0, never_s);
    weights += model.weight;
    model.emissions = of.member("emissions").table(n, size(counter.n_symbols()), least_emission);
    counter.rooms.push_back(std::move(model));
  };
  for (const Told& room : told.member("rooms").items()) {
    RoomModel model;
    model.number = room.member("room").whole(0, most_rooms);
    model.first = room.member("first").table(1, n);
    model.moves = (has_moves_in_common ? told : room).member("moves").table(n, n);
    if (has_moves_in_common) {
      add(std::move(model), room);
      continue;
    }
    for (const Told& one : room.member("versions").items()) {
      model.liveliness = one.member("liveliness").positive();
      add(model, one);
    }
  }
  if (!(std::abs(weights - 1.0) < 1e-6)) told.member("rooms").refuse("the rooms' weights don't add up to 1");
  if (const auto error = told.find("expected_error")) counter.expected_error = interval(*error);
  if (const auto figures = told.find("figures_off")) {
    counter.figures_off.emplace();
    for (const auto& [name, off] : figure_names) {
      const Interval found = interval(figures->member(name));
      (*counter.figures_off).*off = {found.low, found.high};
    }
  }
  if (const auto warning = told.find("warning")) counter.warning = warning->text();
  if (const auto found = told.find("sensor_names")) counter.sensors = names(*found, counter.n_sensors);
  if (const auto found = told.find("holds_s")) counter.holds_s = holds(*found, counter.n_sensors);
  return counter;
}

}  // namespace

void divide_rows(std::span<double> table, std::size_t n_columns) {
  for (std::size_t row = 0; row < table.size(); row += n_columns) normalize(table.subspan(row, n_columns));
}

std::vector<Reading> readings_of(const Stretch& stretch) {
  std::vector<Reading> readings(stretch.n_readings());
  for (std::size_t i = 0; i < readings.size(); ++i) {
    for (std::size_t k = 0; k < size(stretch.n_sensors); ++k) {
      const std::uint8_t bit = stretch.motion[i * size(stretch.n_sensors) + k];
      readings[i].known += bit == unknown_bit ? 0 : 1;
      readings[i].active += bit == 1 ? 1 : 0;
    }
    if (!stretch.people.empty()) readings[i].people = stretch.people[i];
  }
  return readings;
}

StateRange states_of(const Counter& counter, const Reading& reading) {
  if (reading.people == unknown_count) return {0, size(counter.n_states())};
  const std::size_t count = size(std::min(reading.people, counter.n_counts - 1)), modes = size(counter.settings.modes);
  return {count * modes, (count + 1) * modes};
}

template <std::size_t n_lanes>
Lanes<n_lanes>::Lanes(const Counter& counter, std::span<const RoomModel* const> rooms) : counter_(&counter) {
  first_.resize(rooms.front()->first.size());
  moves_.resize(rooms.front()->moves.size());
  emissions_.resize(rooms.front()->emissions.size());
  for (std::size_t lane = 0; lane < n_lanes; ++lane) {
    const RoomModel& room = *rooms[std::min(lane, rooms.size() - 1)];
    for (std::size_t i = 0; i < first_.size(); ++i) first_[i][lane] = room.first[i];
    for (std::size_t i = 0; i < moves_.size(); ++i) moves_[i][lane] = room.moves[i];
    for (std::size_t i = 0; i < emissions_.size(); ++i) emissions_[i][lane] = room.emissions[i];
  }
}

template <std::size_t n_lanes>
auto Lanes<n_lanes>::likelihood(std::size_t state, const Reading& reading) const -> Values {
  const std::span<const Values> own(emissions_.data() + state * size(counter_->n_symbols()),
                                    size(counter_->n_symbols()));
  if (reading.known == counter_->n_sensors) return own[size(reading.active)];
  const int unknown = counter_->n_sensors - reading.known;
  Values sum{};
  for (int all = reading.active; all <= reading.active + unknown; ++all) {
    const double ways = choose(all, reading.active) *
                        choose(counter_->n_sensors - all, reading.known - reading.active) /
                        choose(counter_->n_sensors, reading.known);
    for (std::size_t lane = 0; lane < n_lanes; ++lane) sum[lane] += own[size(all)][lane] * ways;
  }
  return sum;
}

namespace {

/// Every lane adds up to 1; what they added up to is returned.
template <std::size_t n_lanes>
std::array<double, n_lanes> normalize(std::span<std::array<double, n_lanes>> states) {
  std::array<double, n_lanes> sum{};
  for (const auto& state : states) {
    for (std::size_t lane = 0; lane < n_lanes; ++lane) sum[lane] += state[lane];
  }
  for (auto& state : states) {
    for (std::size_t lane = 0; lane < n_lanes; ++lane) state[lane] /= sum[lane];
  }
  return sum;
}

}  // namespace

template <std::size_t n_lanes>
auto Lanes<n_lanes>::step(std::span<const Values> before, StateRange range_before, const Reading& reading,
                          std::span<Values> after) const -> Values {
  const std::size_t n = size(counter_->n_states());
  const StateRange range = states_of(*counter_, reading);
  std::ranges::fill(after, Values{});
  for (std::size_t to = range.begin; to < range.end; ++to) {
    Values sum = before.empty() ? first_[to] : Values{};
    for (std::size_t from = range_before.begin; from < range_before.end && !before.empty(); ++from) {
      const Values& move = moves_[from * n + to];
      for (std::size_t lane = 0; lane < n_lanes; ++lane) sum[lane] += before[from][lane] * move[lane];
    }
    const Values seen = likelihood(to, reading);
    for (std::size_t lane = 0; lane < n_lanes; ++lane) after[to][lane] = sum[lane] * seen[lane];
  }
  return normalize(after);
}

template <std::size_t n_lanes>
auto Lanes<n_lanes>::forward(std::span<const Reading> readings) const -> Passed {
  const std::size_t n = size(counter_->n_states());
  Passed passed{std::vector<Values>(readings.size() * n), {}};
  std::span<const Values> before;
  StateRange range;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const std::span<Values> now(passed.beliefs.data() + i * n, n);
    const Values likelihoods = step(before, range, readings[i], now);
    for (std::size_t lane = 0; lane < n_lanes; ++lane) passed.log_likelihoods[lane] += std::log(likelihoods[lane]);
    before = now;
    range = states_of(*counter_, readings[i]);
  }
  return passed;
}

template <std::size_t n_lanes>
void Lanes<n_lanes>::smooth(std::span<const Reading> readings, std::span<Values> beliefs,
                            std::span<Values> moved) const {
  const std::size_t n = size(counter_->n_states());
  constexpr double most_ratio = 1e290;  // finite, however sure the past was of what the future refutes
  std::vector<Values> ratio(n);         // of what is believed of the next reading to what was expected of it
  for (std::size_t i = readings.size() < 2 ? 0 : readings.size() - 1; i-- > 0;) {
    const std::span<Values> now = beliefs.subspan(i * n, n), next = beliefs.subspan((i + 1) * n, n);
    const StateRange range = states_of(*counter_, readings[i]), after = states_of(*counter_, readings[i + 1]);
    for (std::size_t to = after.begin; to < after.end; ++to) {
      Values expected{};
      for (std::size_t from = range.begin; from < range.end; ++from) {
        const Values& move = moves_[from * n + to];
        for (std::size_t lane = 0; lane < n_lanes; ++lane) expected[lane] += now[from][lane] * move[lane];
      }
      for (std::size_t lane = 0; lane < n_lanes; ++lane)
        ratio[to][lane] = next[to][lane] > 0.0 ? std::min(next[to][lane] / expected[lane], most_ratio) : 0.0;
    }
    for (std::size_t from = range.begin; from < range.end; ++from) {
      Values later{};
      for (std::size_t to = after.begin; to < after.end; ++to) {
        const Values& move = moves_[from * n + to];
        for (std::size_t lane = 0; lane < n_lanes; ++lane) {
          const double factor = move[lane] * ratio[to][lane];
          later[lane] += factor;
          if (!moved.empty()) moved[from * n + to][lane] += now[from][lane] * factor;
        }
      }
      for (std::size_t lane = 0; lane < n_lanes; ++lane) now[from][lane] *= later[lane];
    }
    normalize(now);
  }
}

template class Lanes<1>;
template class Lanes<side_by_side>;

Counter train(std::span<const LabelledRoom> rooms, const Settings& settings, unsigned threads) {
  require_alike(rooms);
  Counter counter{settings, rooms.front().days.front().n_sensors, counts_of(rooms), {}, {}};
  const std::vector<double> moves_at_first = first_moves(counter, rooms);
  const std::vector<double> emissions = first_emissions(counter, rooms);
  const std::vector<double> anywhere(size(counter.n_states()), 1.0 / counter.n_states());
  for (const LabelledRoom& room : rooms)
    counter.rooms.push_back(
        {room.number, 1.0 / static_cast<double>(rooms.size()), anywhere, moves_at_first, emissions});
  std::vector<double> been = anywhere;
  for (int i = 0; i < settings.iterations; ++i) been = improve(counter, rooms, moves_at_first, threads);
  for (std::size_t r = 0; r < rooms.size(); ++r) counter.rooms[r].first = first_of(counter, rooms[r], been);
  give_own_moves(counter, rooms, threads);
  return counter;
}

namespace {

using Block = Lanes<side_by_side>;

/// Calls visit(lanes, numbers of their models) until all these models had their turn.
template <typename Visit>
void each_block(const Counter& counter, std::span<const std::size_t> numbers, const Visit& visit) {
  std::array<const RoomModel*, side_by_side> rooms{};
  for (std::size_t first = 0; first < numbers.size(); first += side_by_side) {
    const std::span<const std::size_t> own = numbers.subspan(first, std::min(side_by_side, numbers.size() - first));
    for (std::size_t lane = 0; lane < own.size(); ++lane) rooms[lane] = &counter.rooms[own[lane]];
    visit(Block(counter, std::span(rooms).first(own.size())), own);
  }
}

/// Numbers of the models that have something to say.
std::vector<std::size_t> weighty(const Counter& counter) {
  std::vector<std::size_t> numbers;
  for (std::size_t r = 0; r < counter.rooms.size(); ++r) {
    if (counter.rooms[r].weight > 0.0) numbers.push_back(r);
  }
  return numbers;
}

}  // namespace

Counter at_livelinesses(const Counter& counter) {
  if (std::ranges::count(counter.settings.livelinesses, 1.0) != 1)
    throw Error(ErrorCode::usage, "livelinesses: 1 must be among them, once: the rooms as they are");
  const std::size_t modes = size(counter.settings.modes), n_symbols = size(counter.n_symbols());
  Counter all = counter;
  all.rooms.clear();
  for (const RoomModel& room : counter.rooms) {
    for (const double odds : counter.settings.livelinesses) {
      RoomModel& version = all.rooms.emplace_back(room);
      version.weight = room.weight / static_cast<double>(counter.settings.livelinesses.size());
      version.liveliness = odds;
      for (std::size_t i = modes * n_symbols; i < version.emissions.size(); ++i)
        version.emissions[i] *= std::pow(odds, static_cast<double>(i % n_symbols));
      divide_rows(version.emissions, n_symbols);
    }
  }
  return all;
}

std::vector<double> log_likelihoods(const Counter& counter, std::span<const Stretch> stretches) {
  std::vector<double> sums(counter.rooms.size(), 0.0);
  std::vector<std::size_t> all(sums.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  for (const Stretch& stretch : stretches) {
    const std::vector<Reading> readings = readings_of(stretch);
    each_block(counter, all, [&](const Block& block, std::span<const std::size_t> numbers) {
      const Block::Values told = block.forward(readings).log_likelihoods;
      for (std::size_t lane = 0; lane < numbers.size(); ++lane) sums[numbers[lane]] += told[lane];
    });
  }
  return sums;
}

void weigh(Counter& counter, std::span<const double> log_likelihoods) {
  constexpr double hardly_any =
      1e-4;  // of the weightiest: together they would move a probability by a hundredth at most
  const double most = *std::ranges::max_element(log_likelihoods);
  double sum = 0.0;
  for (std::size_t r = 0; r < counter.rooms.size(); ++r) {
    RoomModel& room = counter.rooms[r];
    const double weight = std::exp(counter.settings.weight_power * (log_likelihoods[r] - most));
    room.weight = weight < hardly_any ? 0.0 : weight;
    sum += room.weight;
  }
  for (RoomModel& room : counter.rooms) room.weight /= sum;
}

std::vector<char> told_readings(const Stretch& stretch, double step_s, Pass pass) {
  const std::vector<Reading> readings = readings_of(stretch);
  std::vector<char> told(readings.size(), 0);
  double unknown_s = never_s;
  const auto look = [&](std::size_t i) {
    unknown_s = readings[i].known > 0 ? 0.0 : unknown_s + step_s;
    if (unknown_s <= longest_guess_s) told[i] = 1;
  };
  for (std::size_t i = 0; i < readings.size(); ++i) look(i);
  unknown_s = never_s;
  for (std::size_t i = readings.size(); pass == Pass::smoothed && i-- > 0;) look(i);
  return told;
}

bool Estimates::is_told(std::size_t reading) const { return !std::isnan(probabilities[reading * size(n_counts)]); }

int Estimates::quantile(std::size_t reading, double share) const {
  double reached = 0.0;
  for (int n = 0; n < n_counts - 1; ++n) {
    reached += probabilities[reading * size(n_counts) + size(n)];
    if (reached >= share - 1e-9) return n;
  }
  return n_counts - 1;
}

Estimates::Band Estimates::band(std::size_t reading, double share) const {
  constexpr double rounding = 1e-9;
  for (int width = 1; width < n_counts; ++width) {
    double most = 0.0;
    Band best;
    for (int least = 0; least + width <= n_counts; ++least) {
      const double odds = std::accumulate(probabilities.begin() + reading * size(n_counts) + least,
                                          probabilities.begin() + reading * size(n_counts) + least + width, 0.0);
      if (odds > most) most = odds, best = {least, least + width - 1};
    }
    if (most >= share - rounding) return best;
  }
  return {0, n_counts - 1};
}

Estimates estimate(const Counter& counter, const Stretch& stretch, Pass pass) {
  const std::vector<Reading> readings = readings_of(stretch);
  const std::size_t modes = size(counter.settings.modes);
  Estimates mixed{counter.n_counts, std::vector<double>(readings.size() * size(counter.n_counts), 0.0)};
  each_block(counter, weighty(counter), [&](const Block& block, std::span<const std::size_t> numbers) {
    Block::Passed passed = block.forward(readings);
    if (pass == Pass::smoothed) block.smooth(readings, passed.beliefs);
    for (std::size_t lane = 0; lane < numbers.size(); ++lane) {
      const double weight = counter.rooms[numbers[lane]].weight;
      for (std::size_t i = 0; i < passed.beliefs.size(); ++i)
        mixed.probabilities[i / modes] += weight * passed.beliefs[i][lane];
    }
  });
  const std::vector<char> told = told_readings(stretch, counter.settings.step_s, pass);
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (told[i] == 0)
      std::ranges::fill(std::span(mixed.probabilities).subspan(i * size(mixed.n_counts), size(mixed.n_counts)),
                        nobody_knows);
  }
  return mixed;
}

namespace {

/// One of so many shares, by chance.
std::size_t pick(std::span<const double> shares, double uniform) {
  double left = uniform * std::accumulate(shares.begin(), shares.end(), 0.0);
  std::size_t last = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (!(shares[i] > 0.0)) continue;
    last = i;
    if ((left -= shares[i]) < 0.0) break;
  }
  return last;
}

/// States from the last reading back to the first, one course; as counts.
std::vector<int> course_of(const Counter& counter, const RoomModel& room, std::span<const Lanes<1>::Values> beliefs,
                           Stream stream) {
  const std::size_t n = size(counter.n_states());
  std::vector<int> people(beliefs.size() / n);
  std::vector<double> shares(n);
  std::size_t next = 0;
  for (std::size_t i = people.size(); i-- > 0;) {
    for (std::size_t state = 0; state < n; ++state)
      shares[state] = beliefs[i * n + state][0] * (i + 1 < people.size() ? room.moves[state * n + next] : 1.0);
    next = pick(shares, stream.uniform());
    people[i] = static_cast<int>(next / size(counter.settings.modes));
  }
  return people;
}

}  // namespace

std::vector<std::vector<int>> draw_people(const Counter& counter, const Stretch& stretch, int n_draws) {
  std::vector<double> weights;
  for (const RoomModel& room : counter.rooms) weights.push_back(room.weight);
  std::vector<std::vector<int>> draws(size(n_draws));
  const std::vector<Reading> readings = readings_of(stretch);
  std::vector<Lanes<1>::Values> beliefs;
  std::optional<std::size_t> last;
  for (int draw = 0; draw < n_draws; ++draw) {
    const std::size_t r = pick(weights, (draw + 0.5) / n_draws);  // rooms in order, each as often as its weight says
    const RoomModel* room = &counter.rooms[r];
    if (r != last) beliefs = Lanes<1>(counter, std::span(&room, 1)).forward(readings).beliefs;
    last = r;
    draws[size(draw)] =
        course_of(counter, *room, beliefs, Stream({1, static_cast<std::uint32_t>(draw), 0, Purpose::drawn_people}));
  }
  const std::vector<char> told = told_readings(stretch, counter.settings.step_s, Pass::smoothed);
  for (std::vector<int>& people : draws) {
    for (std::size_t i = 0; i < told.size(); ++i) {
      if (told[i] == 0) people[i] = unknown_count;
    }
  }
  return draws;
}

LiveCount::LiveCount(const Counter& counter) : counter_(&counter), unknown_s_(never_s) {}

std::vector<double> LiveCount::next(std::span<const std::uint8_t> bits) {
  const Counter& counter = *counter_;
  if (bits.size() != size(counter.n_sensors)) {
    throw Error(ErrorCode::usage, "expected " + std::to_string(counter.n_sensors) + " bits, one a sensor, got " +
                                      std::to_string(bits.size()));
  }
  const std::size_t n = size(counter.n_states()), modes = size(counter.settings.modes);
  const Reading reading = readings_of({counter.n_sensors, {bits.begin(), bits.end()}}).front();
  std::vector<double> counts(size(counter.n_counts), 0.0), next(counter.rooms.size() * n);
  std::vector<Block::Values> before, after(n);
  each_block(counter, weighty(counter), [&](const Block& block, std::span<const std::size_t> numbers) {
    before.resize(belief_.empty() ? 0 : n);
    for (std::size_t i = 0; i < before.size() * numbers.size(); ++i)
      before[i % n][i / n] = belief_[numbers[i / n] * n + i % n];
    block.step(before, {0, n}, reading, after);
    for (std::size_t lane = 0; lane < numbers.size(); ++lane) {
      for (std::size_t state = 0; state < n; ++state) {
        next[numbers[lane] * n + state] = after[state][lane];
        counts[state / modes] += counter.rooms[numbers[lane]].weight * after[state][lane];
      }
    }
  });
  belief_ = std::move(next);
  unknown_s_ = reading.known > 0 ? 0.0 : unknown_s_ + counter.settings.step_s;
  if (unknown_s_ > longest_guess_s) std::ranges::fill(counts, nobody_knows);
  return counts;
}

void write_counter(const std::filesystem::path& file, const Counter& counter) {
  Json rooms = Json::array();
  for (const RoomModel& model : counter.rooms) {
    if (!(model.weight > 0.0)) continue;
    if (rooms.empty() || rooms.back()["room"] != model.number)
      rooms.push_back(
          {{"room", model.number}, {"first", model.first}, {"moves", model.moves}, {"versions", Json::array()}});
    rooms.back()["versions"].push_back(
        {{"liveliness", model.liveliness}, {"weight", model.weight}, {"emissions", model.emissions}});
  }
  Json json{{"pirsim_counter", format_version}, {"step_s", counter.settings.step_s}, {"modes", counter.settings.modes},
            {"sensors", counter.n_sensors},     {"counts", counter.n_counts},        {"rooms", std::move(rooms)}};
  if (!counter.warning.empty()) json["warning"] = counter.warning;
  if (!counter.sensors.empty()) json["sensor_names"] = counter.sensors;
  for (const std::optional<double>& hold_s : counter.holds_s)
    json["holds_s"].push_back(hold_s ? Json(*hold_s) : Json());
  if (counter.expected_error) json["expected_error"] = {counter.expected_error->low, counter.expected_error->high};
  if (counter.figures_off) {
    for (const auto& [name, off] : figure_names)
      json["figures_off"][name] = {((*counter.figures_off).*off).mean, ((*counter.figures_off).*off).most};
  }
  io::write_text_file(file, json.dump() + '\n');
}

std::string read_counter_bytes(const std::filesystem::path& file) {
  return io::read_input(file, limits::counter_bytes).bytes;
}

Counter parse_counter(std::string_view bytes, const std::string& name) {
  try {
    const Json json = Json::parse(bytes);
    return counter_from(Told(json));
  } catch (const nlohmann::json::exception&) {
    throw Error(ErrorCode::input, Where{name}, "isn't a counter: pirsim calibrate and pirsim.counting write one");
  } catch (const std::exception& fault) {
    throw Error(ErrorCode::input, Where{name}, std::string("isn't a counter as it should be: ") + fault.what());
  }
}

Counter read_counter(const std::filesystem::path& file) {
  return parse_counter(read_counter_bytes(file), file.string());
}

}  // namespace pirsim::counting
