// The plan's seat numbers are off by one.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

/// Who is said to sit on a seat sits on the one so many further in the scene's order, round its end.
void alter(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const auto n = static_cast<std::int64_t>(scene.seats.size());
  const std::vector<SeatSpec> drawn = scene.seats;
  const std::int64_t places = std::llround(effect.parameters.at("places"));
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int64_t from = ((i + places) % n + n) % n;
    scene.seats[static_cast<std::size_t>(i)].world_from_seat = drawn[static_cast<std::size_t>(from)].world_from_seat;
  }
}

void draw(EffectSpec& effect, const SceneSpec&, const ScriptSpec&, Stream& stream) {
  if (stream.index(2) == 1) effect.parameters["places"] *= -1.0;
}

}  // namespace

const Effect& seats_shifted() {
  static const Effect effect{.info = {.name = "seats_shifted",
                                      .family = Family::data,
                                      .stage = "books",
                                      .summary = "Seat names are shifted: each names the seat so many places further.",
                                      .fingerprint = "rows of the table of sums are permuted",
                                      .confused_with = {"mirrored_room"},
                                      .parameters = {{.name = "places",
                                                      .unit = "",
                                                      .off = 0.0,
                                                      .typical = 1.0,
                                                      .low = 1.0,
                                                      .high = 1.0,
                                                      .least = -1000.0,
                                                      .most = 1000.0,
                                                      .scale = Scale::whole,
                                                      .source = "assumed: one, either way"}},
                                      .reach = Reach::geometry,
                                      .idle_in = {Survey::coverage}},
                             .alter = alter,
                             .draw = draw};
  return effect;
}

}  // namespace pirsim::effects
