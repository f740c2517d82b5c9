// Time of one trace for each tracer: five sensors of 340 rays, one person of 13 solids who walks along the table.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "pirsim/rt/tracer.hpp"
#include "support/meeting_room.hpp"

using namespace pirsim;

namespace {

constexpr int n_ticks = 400;

enum class Person { walking, still, out_of_sight };

std::vector<PosedShape> person_at(Person person, int tick) {
  if (person == Person::out_of_sight) return testing::standing_person(60.0, 60.0 + 0.02 * tick, 0.0);
  const double along = person == Person::still ? 1.0 : 0.02 * (tick % 150);
  return testing::standing_person(5.2, -0.8 - along, 0.3, 0.25 * std::sin(0.1 * along / 0.02));
}

/// Least nanoseconds per trace of five rounds.
double time_of(rt::Tracer& tracer, std::size_t n_zones, Person person, int ticks) {
  ZoneActivity zones(n_zones);
  std::vector<std::vector<PosedShape>> poses;
  for (int tick = 0; tick < ticks; ++tick) poses.push_back(person_at(person, tick));
  double best = 1e30;
  for (int round = 0; round < 5; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (const auto& solids : poses) tracer.trace(solids, zones);
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
    best = std::min(best, spent.count() / ticks);
  }
  return best;
}

}  // namespace

int main() {
  const rt::Room room(testing::meeting_room());
  const RayBundle rated = testing::meeting_room_sensors();
  RayBundle clipped = rated;
  room.clip(clipped);
  std::printf("%zu rays, %zu zones, 13 solids; nanoseconds per trace\n", rated.rays.size(), rated.n_zones());
  std::printf("%-10s %12s %12s %14s\n", "tracer", "walking", "still", "out of sight");
  for (const rt::TracerKind kind : {rt::TracerKind::reference, rt::TracerKind::embree}) {
    const auto tracer = rt::make_tracer(kind, {&room, &rated, &clipped});
    const int ticks = kind == rt::TracerKind::reference ? n_ticks / 10 : n_ticks;
    std::printf("%-10s", std::string(rt::name(kind)).c_str());
    for (const Person person : {Person::walking, Person::still, Person::out_of_sight}) {
      std::printf(" %12.0f", time_of(*tracer, rated.n_zones(), person, ticks));
    }
    std::printf("\n");
  }
}
