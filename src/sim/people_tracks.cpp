#include "sim/people_tracks.hpp"

#include <algorithm>
#include <optional>

#include "sim/run_state.hpp"

namespace pirsim::sim {

PeopleTrack Postures::follow(const CompiledStudy& study, std::uint32_t run) {
  RunState state(study, run);
  const std::vector<Actor>& actors = state.crowd.actors();
  PeopleTrack track{
      {{run, study.replicate_of(run), study.trial_of(run).id, {}, {}, {}}, 0, {}, {}}, 0, actors.size(), {}};
  std::vector<std::uint64_t> figures;
  for (const Actor& actor : actors) figures.push_back(number_of(actor.person()));
  index_.make_room_for(actors.size());
  const auto note_postures = [&] {
    for (std::uint32_t i = 0; i < actors.size(); ++i) track.postures.push_back(number_of(i, figures[i], actors[i]));
  };
  note_postures();
  for (std::optional<std::int64_t> end; !end || state.tick < *end;) {
    if (move_tick(study, state) && !end) track.rows.rows.samples.push_back(state.sample);
    if (state.finished && !end) end = study.stages().heard_by(state.tick);
    for (const std::size_t seat : state.crowd.seats_left()) track.rows.seats_left.push_back({state.tick, seat});
    note_postures();
  }
  track.n_ticks = static_cast<std::size_t>(state.tick);
  return track;
}

void Postures::shrink(std::size_t n) noexcept {
  index_.shrink(n);
  people_.resize(std::min(n, people_.size()));
}

std::uint64_t Postures::number_of(const PersonModel& person) {
  const auto known = std::ranges::find_if(figures_, [&](const Figure& figure) {
    return figure.humanoid == person.humanoid && figure.radiance == person.radiance;
  });
  if (known != figures_.end()) return static_cast<std::uint64_t>(known - figures_.begin());
  figures_.push_back({person.humanoid, person.radiance});
  return figures_.size() - 1;
}

PostureIndex::Number Postures::number_of(std::uint32_t person, std::uint64_t figure, const Actor& actor) {
  if (!actor.present()) return 0;
  const PostureIndex::Number known = index_.find(person, figure, actor.motion().outline());
  if (known != 0) return known;
  people_.push_back(person);
  return index_.remember(person);
}

}  // namespace pirsim::sim
