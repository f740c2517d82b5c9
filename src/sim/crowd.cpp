#include "sim/crowd.hpp"

#include <algorithm>
#include <limits>

#include "schema/phase_names.hpp"

namespace pirsim::sim {

Crowd::Crowd(const CompiledStudy& study, std::uint32_t run) : conversation_(study.seed(), run) {
  const std::size_t n_people = study.trial_of(run).people.size();
  std::shared_ptr<const DayPlan> plan;
  const TrialModel& trial = study.trial_of(run);
  if (trial.schedule) plan = std::make_shared<const DayPlan>(draw_day(study, run));
  for (std::uint32_t person = 0; person < n_people; ++person) actors_.emplace_back(study, run, person, plan);
  presences_.resize(n_people);
  seated_.resize(n_people, 0);
}

std::size_t Crowd::gather_others(std::size_t i) {
  others_.clear();
  if (actors_.size() == 1) return 0;
  std::size_t n_before = 0;
  for (std::size_t other = 0; other < actors_.size(); ++other) {
    if (other == i) n_before = others_.size();
    if (other != i && presences_[other]) others_.push_back(*presences_[other]);
  }
  return n_before;
}

/// Who takes part in a meeting looks at whoever speaks.
void Crowd::let_speak(const CompiledStudy& study, std::int64_t tick) {
  participants_.clear();
  for (std::uint32_t i = 0; i < actors_.size(); ++i) {
    if (actors_[i].takes_part_in_meeting()) participants_.push_back(i);
  }
  if (participants_.empty()) return;
  const auto speaker = conversation_.speaker(participants_, tick, study.sensing().tick_rate_hz);
  for (const std::uint32_t i : participants_) {
    std::optional<Vec2> place;
    if (speaker) place = actors_[*speaker].motion().position();
    actors_[i].attend(i == speaker ? Talk::speaks : speaker ? Talk::listens : Talk::none, place);
  }
}

void Crowd::advance(const CompiledStudy& study, std::int64_t tick) {
  let_speak(study, tick);
  std::size_t n_before = 0;
  bool gathered = false;
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    if (!gathered) n_before = gather_others(i);
    actors_[i].advance(study, tick, others_, n_before);
    if (actors_.size() == 1) continue;  // nobody asks
    presences_[i].reset();
    if (actors_[i].present()) presences_[i] = actors_[i].presence();
    // The next person's others are the same but for one: this person is where the next one was.
    gathered = presences_[i] && i + 1 < actors_.size() && presences_[i + 1];
    if (gathered) others_[n_before++] = *presences_[i];
  }
  note_seats_left(study);
}

void Crowd::note_seats_left(const CompiledStudy& study) {
  seats_left_.clear();
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    const Actor& actor = actors_[i];
    const bool seated = actor.present() && actor.motion().stage() == body::Stage::seated;
    if (seated_[i] != 0 && !seated) {
      const auto& seats = study.scene().seats;
      const auto seat = std::ranges::find(seats, actor.seat(), &SeatSpec::id);
      if (seat != seats.end()) seats_left_.push_back(static_cast<std::size_t>(seat - seats.begin()));
    }
    seated_[i] = seated ? 1 : 0;
  }
}

std::int64_t Crowd::away_until(const CompiledStudy& study, std::int64_t tick) const {
  std::int64_t until = std::numeric_limits<std::int64_t>::max();
  for (const Actor& actor : actors_) until = std::min(until, actor.away_until(study, tick));
  return until;
}

int Crowd::n_on_floor(const FloorArea& floor) const {
  return static_cast<int>(std::ranges::count_if(actors_, [&](const Actor& actor) { return actor.counts_on(floor); }));
}

std::string_view Crowd::phase() const noexcept { return actors_.empty() ? phase_outside : actors_.front().phase(); }

bool Crowd::done() const noexcept {
  return std::ranges::all_of(actors_, [](const Actor& actor) {
    return actor.done() || actor.person().spec.changes.role != PersonRole::subject;
  });
}

}  // namespace pirsim::sim
