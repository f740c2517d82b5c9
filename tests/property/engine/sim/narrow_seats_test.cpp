// Seats between a table and a wall where a person has less room to stand than to walk.
#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/run_state.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

/// How far any solid reaches over the edge of the rectangle, metres; negative: the room that is left.
double beyond(const Bounds& solid, const Vec2& lower, const Vec2& upper) {
  return std::max({lower.x - solid.lower.x, lower.y - solid.lower.z, solid.upper.x - upper.x, solid.upper.z - upper.y});
}

bool is_narrow(const sim::PersonModel& person, const sim::SeatPlan& seat) {
  return seat.half_depth_m > 0.0 && seat.half_depth_m < person.humanoid.clearance_radius_m();
}

/// The greatest over a whole run, from coming to stand before the seat to setting out from there again.
double farthest_beyond_walls(const Model& model, std::uint32_t run, const sim::SeatPlan& seat) {
  const Vec2 lower = model.scene().floor.lower(), upper = model.scene().floor.upper();
  const Frame& world_from_seat = seat.place.world_from_seat;
  const Vec2 stand =
      floor_point(world_from_seat.origin) - seat.stand_back_m * direction_of(heading_of(world_from_seat));
  double farthest = -1.0;
  std::vector<PosedShape> solids;
  for (State state(model, run); !state.finished();) {
    step_tick(model, state);
    const sim::Actor& person = state.run_state().crowd.actors().front();
    if (!person.present()) continue;
    const body::Stage stage = person.motion().stage();
    const bool on_seat =
        stage != body::Stage::walking && stage != body::Stage::turning && stage != body::Stage::standing;
    if (!on_seat && glm::distance(person.motion().position(), stand) > 0.01) continue;
    solids.clear();
    sim::append_solids(person, solids);
    for (const PosedShape& solid : solids) farthest = std::max(farthest, beyond(bounds(solid), lower, upper));
  }
  return farthest;
}

}  // namespace

TEST_CASE("who sits down between a table and a wall goes through no wall") {
  for (const std::string room : {"meeting_room_alt5.gltf", "meeting_room_alt6.gltf"}) {
    const Model model = compile(shipped_scene(room), shipped_script("studyA.yaml", {"replicates=1"}));
    int n_narrow = 0;
    for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
      const sim::PersonModel& person = model.compiled().trial_of(run).people.front();
      const auto seat =
          std::ranges::find_if(person.seats, [&](const auto& used) { return is_narrow(person, used.second); });
      if (seat == person.seats.end()) continue;
      ++n_narrow;
      INFO(room << ", " << model.trial_of(run));
      const double beyond_m = farthest_beyond_walls(model, run, seat->second);
      CHECK(beyond_m < 0.0);
      CHECK(beyond_m > -0.5);  // there is a wall
    }
    CHECK(n_narrow >= 2);
  }
}
