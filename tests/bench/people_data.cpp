// Still periods of sitters of natural style, as CSV for the pictures of docs/physics/people.md:
// pirsim_people_data PEOPLE
#include <cstdlib>
#include <iostream>
#include <string>

#include "support/natural_sitter.hpp"

using namespace pirsim;
using namespace pirsim::body::test;

namespace {

/// A seat at the origin of the floor, facing -Z, at a table of 0.74 m.
body::SeatPlace desk_seat() {
  body::SeatPlace seat;
  seat.world_from_seat.origin = {0.0, 0.531, 0.0};
  seat.table_height_m = 0.74;
  return seat;
}

}  // namespace

int main(int argc, char** argv) {
  const int n_people = argc == 2 ? std::atoi(argv[1]) : 0;
  if (n_people <= 0) {
    std::cerr << "usage: pirsim_people_data PEOPLE\n";
    return 2;
  }
  const body::Humanoid man{PersonSpec{}};
  std::cout << "activity,person,liveliness,shifts,fidgets,touches,looks,tasks,still_s\n";
  for (const Activity activity : {Activity::typing, Activity::reading, Activity::meeting, Activity::phone}) {
    for (int person = 0; person < n_people; ++person) {
      Sitter sitter(static_cast<std::uint32_t>(person), man, desk_seat());
      SitterObserver observer;
      for (int tick = 0; tick < 3600 * tick_rate_hz; ++tick) {
        sitter.tick(activity);
        observer.see(sitter.motion);
      }
      const sim::NaturalMotion& natural = sitter.natural;
      for (const double still_s : observer.still_s()) {
        std::cout << activity_names[static_cast<std::size_t>(activity)] << ',' << person << ',' << natural.liveliness();
        for (std::size_t kind = 0; kind <= sim::n_habits; ++kind)
          std::cout << ',' << natural.begun(static_cast<sim::ActKind>(kind));
        std::cout << ',' << still_s << '\n';
      }
    }
  }
}
