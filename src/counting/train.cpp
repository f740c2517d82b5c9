// The Baum-Welch algorithm where the counts are known and the modes are not.
#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "counting/passes.hpp"
#include "pirsim/error.hpp"

namespace pirsim::counting {
namespace {

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
  constexpr double stays = 0.9;  // in its mode; assumed
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
  for (const Stretch& day : room.days) {
    const std::vector<Reading> readings = readings_of(day);
    std::vector<double> beliefs = forward(counter, model, readings).beliefs;
    smooth(counter, readings, beliefs, expected.moved);
    for (std::size_t i = 0; i < readings.size(); ++i) {
      for (std::size_t state = 0; state < n; ++state) {
        const double belief = beliefs[i * n + state];
        expected.been[state] += belief;
        if (readings[i].known == counter.n_sensors)
          expected.seen[state * n_symbols + size(readings[i].active)] += belief;
      }
    }
  }
  return expected;
}

void add(std::vector<double>& sum, const std::vector<double>& more) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
}

/// One iteration: what is expected of all rooms, then what explains it best.
std::vector<double> improve(Counter& counter, std::span<const LabelledRoom> rooms,
                            const std::vector<double>& moves_at_first, unsigned threads) {
  const std::size_t n = size(counter.n_states()), n_symbols = size(counter.n_symbols());
  std::vector<Expected> each;
  ordered_parallel<Expected>(
      rooms.size(), threads, [&](std::size_t r) { return expected_of(counter, rooms[r], counter.rooms[r]); },
      [&](Expected& one) { each.push_back(std::move(one)); });
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
  counter.moves = std::move(moved);
  for (std::size_t r = 0; r < each.size(); ++r) {
    for (std::size_t i = 0; i < seen.size(); ++i) each[r].seen[i] += counter.settings.shrinkage * seen[i];
    divide_rows(each[r].seen, n_symbols);
    counter.rooms[r].emissions = std::move(each[r].seen);
  }
  return been;
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

}  // namespace

Counter train(std::span<const LabelledRoom> rooms, const Settings& settings, unsigned threads) {
  require_alike(rooms);
  Counter counter{settings, rooms.front().days.front().n_sensors, counts_of(rooms), {}, {}, {}};
  const std::vector<double> moves_at_first = first_moves(counter, rooms);
  counter.moves = moves_at_first;
  const std::vector<double> emissions = first_emissions(counter, rooms);
  const std::vector<double> anywhere(size(counter.n_states()), 1.0 / counter.n_states());
  for (const LabelledRoom& room : rooms)
    counter.rooms.push_back({room.number, 1.0 / static_cast<double>(rooms.size()), anywhere, emissions});
  std::vector<double> been = anywhere;
  for (int i = 0; i < settings.iterations; ++i) been = improve(counter, rooms, moves_at_first, threads);
  for (std::size_t r = 0; r < rooms.size(); ++r) counter.rooms[r].first = first_of(counter, rooms[r], been);
  return counter;
}

}  // namespace pirsim::counting
