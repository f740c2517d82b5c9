#include "sim/crowd.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "schema/phase_names.hpp"
#include "sim/occupancy.hpp"

namespace pirsim::sim {

std::optional<std::uint32_t> Conversation::speaker(std::span<const std::uint32_t> participants, std::int64_t tick,
                                                   int tick_rate_hz) {
  constexpr double shortest_turn_s = 2.0, mean_further_s = 18.0;  // assumed: seconds to minutes (means of 10-40 tried)
  if (participants.size() < 2) return speaker_ = std::nullopt;
  const bool there = speaker_ && std::ranges::binary_search(participants, *speaker_);
  if (there && tick < until_) return speaker_;
  speaker_ = participants[stream_.index(static_cast<std::uint32_t>(participants.size()))];
  const double turn_s = shortest_turn_s - mean_further_s * std::log(1.0 - stream_.uniform());
  until_ = tick + std::llround(turn_s * tick_rate_hz);
  return speaker_;
}

Crowd::Crowd(const CompiledStudy& study, std::uint32_t run) : doors_(study, run) {
  const auto n_conversations = static_cast<std::uint32_t>(std::max<std::size_t>(1, study.areas().size()));
  for (std::uint32_t i = 0; i < n_conversations; ++i) conversations_.emplace_back(study.seed(), run, i);
  const std::size_t n_people = study.trial_of(run).people.size();
  std::shared_ptr<const DayPlan> plan;
  const TrialModel& trial = study.trial_of(run);
  if (trial.schedule) plan = std::make_shared<const DayPlan>(draw_day(study, run));
  if (trial.occupancy) plan = std::make_shared<const DayPlan>(draw_occupancy(study, run));
  for (std::uint32_t person = 0; person < n_people; ++person) actors_.emplace_back(study, run, person, plan);
  seated_.resize(n_people, 0);
  for (std::size_t i = 0; i < n_people; ++i) {
    actors_[i].begin(study, {in_scene_, in_scene_.size(), Others::Me::not_there});
    if (n_people > 1 && actors_[i].present()) in_scene_.push_back(actors_[i].presence());  // of one nobody asks
  }
}

/// Who takes part in a meeting looks at whoever speaks in their area.
void Crowd::let_speak(const CompiledStudy& study, std::int64_t tick) {
  participants_.clear();
  for (std::uint32_t i = 0; i < actors_.size(); ++i) {
    if (actors_[i].takes_part_in_meeting()) participants_.push_back(i);
  }
  const Areas& areas = study.areas();
  for (std::size_t area = 0; area < conversations_.size() && !participants_.empty(); ++area) {
    together_.clear();
    std::ranges::copy_if(participants_, std::back_inserter(together_), [&](std::uint32_t i) {
      return areas.empty() || areas.at(actors_[i].motion().position()) == area;
    });
    if (together_.empty()) continue;
    const auto speaker = conversations_[area].speaker(together_, tick, study.sensing().tick_rate_hz);
    for (const std::uint32_t i : together_) {
      std::optional<Vec2> place;
      if (speaker) place = actors_[*speaker].motion().position();
      actors_[i].attend(i == speaker ? Talk::speaks : speaker ? Talk::listens : Talk::none, place);
    }
  }
}

void Crowd::advance(const CompiledStudy& study, std::int64_t tick) {
  let_speak(study, tick);
  if (actors_.size() == 1) {  // nobody asks
    actors_.front().advance(study, tick, {}, doors_.seen(study));
  } else if (!actors_.empty()) {
    advance_among_others(study, tick);
  }
  note_seats_left(study);
  if (!doors_.steps().empty()) turn_leaves(study, tick);
}

/// People have seen the leaves as they stood at the last tick.
void Crowd::turn_leaves(const CompiledStudy& study, std::int64_t tick) {
  places_.resize(actors_.size());
  door_users_.clear();
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    const Actor& actor = actors_[i];
    if (!actor.present()) {
      places_[i].reset();
      continue;
    }
    const Vec2 now = actor.motion().position();
    door_users_.push_back(actor.door_user(study.scene().floor, places_[i].value_or(now)));
    places_[i] = now;
  }
  doors_.advance(study, tick, door_users_);
}

/// One after the other: those before a person in the script have been advanced already. Who comes or goes is seldom.
void Crowd::advance_among_others(const CompiledStudy& study, std::int64_t tick) {
  std::size_t n_before = 0;
  for (Actor& actor : actors_) {
    const bool was_there = actor.present();
    const auto me = was_there ? Others::Me::among_them : Others::Me::not_there;
    actor.advance(study, tick, {in_scene_, n_before, me}, doors_.seen(study));
    const auto at = in_scene_.begin() + static_cast<std::ptrdiff_t>(n_before);
    if (was_there && actor.present()) *at = actor.presence();
    if (was_there && !actor.present()) in_scene_.erase(at);
    if (!was_there && actor.present()) in_scene_.insert(at, actor.presence());
    if (actor.present()) ++n_before;
  }
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
  std::int64_t until = doors_.still_until(study, tick);
  for (const Actor& actor : actors_) until = std::min(until, actor.away_until(study, tick));
  return until;
}

std::string_view Crowd::phase() const noexcept { return actors_.empty() ? phase_outside : actors_.front().phase(); }

bool Crowd::done() const noexcept {
  return std::ranges::all_of(actors_, [](const Actor& actor) {
    return actor.done() || actor.person().spec.changes.role != PersonRole::subject;
  });
}

}  // namespace pirsim::sim
