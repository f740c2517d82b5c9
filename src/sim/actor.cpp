#include "sim/actor.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::sim {
namespace {

using body::Stage;

constexpr double look_ahead_m = 1.2;        ///< assumed: how far ahead a walker minds others (tried 0.8-2)
constexpr double foresight_s = 1.5;         ///< assumed: how long before ways cross one gives way (tried 1-2)
constexpr double gap_m = 0.1;               ///< assumed: kept between two people beside their radii
constexpr double doorway_m = 2.5;           ///< assumed: who comes in is through the door at that distance (tried 2-3)
constexpr double braking_m_s2 = 1.5;        ///< assumed, as Motion's acceleration
constexpr double patience_s = 0.5;          ///< assumed: wait before looking for another way
constexpr double patience_step_s = 0.7;     ///< more for every later person, so that two don't dodge alike
constexpr double search_every_s = 0.2;      ///< how often one who found no way looks again
constexpr double give_up_s = 60.0;          ///< then people block each other for good
constexpr double give_up_in_all_s = 180.0;  ///< assumed: then somebody tries the same few steps for ever

std::int64_t ticks(double seconds, const CompiledStudy& study) {
  return std::llround(seconds * study.sensing().tick_rate_hz);
}

Vec2 outside(const EntranceSpec& door) { return floor_point(door.world_from_entrance * Vec3(0, 0, door.outside_m)); }

bool leads_elsewhere(const ScriptedAction& action) {
  return !action.at_s &&
         (std::holds_alternative<action::Sit>(action.what) || std::holds_alternative<action::Walk>(action.what));
}

}  // namespace

Actor::Actor(const CompiledStudy& study, std::uint32_t run, std::uint32_t person)
    : person_(&study.trial_of(run).people[person]),
      index_(person),
      tilt_stream_({study.seed(), run, person, Purpose::spine_tilt}),
      scatter_stream_({study.seed(), run, person, Purpose::seat_scatter}),
      fidget_stream_({study.seed(), run, person, Purpose::fidgeting}) {}

std::string_view Actor::current_phase() const noexcept {
  if (!done() && begun_ && !action().phase.empty()) return action().phase;
  if (!present()) return "outside";
  if (!done() && begun_ && std::holds_alternative<action::Work>(action().what)) return "working";
  return body::name(motion_->stage());
}

Presence Actor::presence() const {
  const double speed = motion_->speed_m_s();
  return {motion_->position(),
          speed > 0.0 ? speed * direction_of(motion_->heading()) : Vec2(0.0),
          route_ ? route_->position(route_->length_m()) : motion_->position(),
          seat_,
          done() ? Presence::Script::carried_out : Presence::Script::going_on,
          person().humanoid.clearance_radius_m()};
}

void Actor::advance(const CompiledStudy& study, std::int64_t tick, std::span<const Presence> others,
                    std::size_t n_before) {
  carry_on(study, tick - 1, others);
  if (motion_) {
    keep_distance(study, others, n_before);
    if (motion_->stage() == Stage::seated) fidget(study);
    motion_->advance();
  }
  phase_ = current_phase();
  if (!done() && begun_ && errands_.empty() && time_is_up(tick)) finish_action();
}

void Actor::carry_on(const CompiledStudy& study, std::int64_t now, std::span<const Presence> others) {
  while (!done()) {
    if (!begun_) {
      if (action().at_s && now < ticks(*action().at_s, study)) return;
      begun_ = true;
      began_ = now;
      note_durations(study);
      plan(study);
    }
    while (!errands_.empty() && carry_out_first(study, others) == Progress::done) {
      errands_.pop_front();
      held_up_ticks_ = 0;
    }
    if (const auto* work_action = std::get_if<action::Work>(&action().what)) work(*work_action, now);
    const auto next = interrupting_action(study, now);
    if (!next && !(errands_.empty() && time_is_up(now))) return;
    finish_action();
    if (next) action_ = *next;
  }
}

void Actor::finish_action() {
  errands_.clear();
  held_up_ticks_ = 0;
  route_.reset();
  if (motion_ && std::holds_alternative<action::Work>(action().what)) motion_->rest();
  ++action_;
  begun_ = false;
}

std::optional<std::size_t> Actor::interrupting_action(const CompiledStudy& study, std::int64_t now) const {
  const auto& actions = person().spec.actions;
  for (std::size_t i = actions.size(); i-- > action_ + 1;) {
    if (actions[i].at_s && now >= ticks(*actions[i].at_s, study)) return i;
  }
  return std::nullopt;
}

/// In ticks, once an action: they are asked for every tick.
void Actor::note_durations(const CompiledStudy& study) {
  lasts_ticks_ = 0;
  if (const auto* wait = std::get_if<action::Wait>(&action().what)) lasts_ticks_ = ticks(wait->duration_s, study);
  if (const auto* work = std::get_if<action::Work>(&action().what)) {
    lasts_ticks_ = ticks(work->duration_s, study);
    tilt_every_ticks_ = std::max<std::int64_t>(1, ticks(work->tilt_every_s, study));
  }
}

bool Actor::time_is_up(std::int64_t now) const noexcept { return now - began_ >= lasts_ticks_; }

void Actor::plan(const CompiledStudy& study) {
  const auto entrance = [&](const std::string& id) -> const EntranceSpec& {
    return *std::ranges::find(study.scene().entrances, id, &EntranceSpec::id);
  };
  const Action& what = action().what;
  const bool arrives = std::holds_alternative<action::Appear>(what) || std::holds_alternative<action::Enter>(what) ||
                       std::holds_alternative<action::Wait>(what);
  if (!present() && !arrives) return;  // called away before they came: nothing to do
  if (const auto* appear = std::get_if<action::Appear>(&what)) {
    errands_.push_back(ComeIn{appear->point, radians(appear->heading_deg)});
  } else if (const auto* enter = std::get_if<action::Enter>(&what)) {
    plan_entering(entrance(enter->entrance));
  } else if (const auto* walk = std::get_if<action::Walk>(&what)) {
    for (const Vec2& point : walk->points) errands_.push_back(WalkTo{point});
  } else if (std::holds_alternative<action::Sit>(what)) {
    plan_sitting();
  } else if (std::holds_alternative<action::Rise>(what)) {
    errands_.push_back(StandUp{});
  } else if (const auto* turn = std::get_if<action::Turn>(&what)) {
    errands_.push_back(FaceTo{radians(turn->heading_deg)});
  } else if (const auto* leave = std::get_if<action::Leave>(&what)) {
    plan_leaving(entrance(leave->entrance));
  } else if (const auto* work_action = std::get_if<action::Work>(&what)) {
    if (motion_->stage() != Stage::seated) give_up("'" + person().spec.id + "' is not seated when work begins");
    motion_->work({work_action->arm_amplitude_m, work_action->arm_period_s});
  }
}

void Actor::plan_entering(const EntranceSpec& door) {
  const auto& actions = person().spec.actions;
  const ScriptedAction* next = action_ + 1 < actions.size() ? &actions[action_ + 1] : nullptr;
  const auto* sit_next = next != nullptr ? std::get_if<action::Sit>(&next->what) : nullptr;
  if (sit_next != nullptr) errands_.push_back(WaitForSeat{sit_next->seat});  // better outside than in the doorway
  errands_.push_back(WaitForDoor{outside(door), Through::in});
  errands_.push_back(ComeIn{outside(door), heading_of(door.world_from_entrance)});
  if (next != nullptr && leads_elsewhere(*next)) return;
  const double inside_m = 2.0 * person().humanoid.clearance_radius_m();
  errands_.push_back(WalkTo{floor_point(door.world_from_entrance * Vec3(0, 0, -inside_m))});
}

void Actor::plan_leaving(const EntranceSpec& door) {
  const double behind_m = std::min(door.outside_m, 2.0 * person().humanoid.clearance_radius_m());
  errands_.push_back(WaitForDoor{outside(door), Through::out});
  errands_.push_back(WalkOut{outside(door), floor_point(door.world_from_entrance * Vec3(0, 0, behind_m))});
  errands_.push_back(Vanish{});
}

void Actor::plan_sitting() {
  const SeatPlan& seat = person().seats[action_];
  const SeatScatterSpec& scatter = person().spec.seat_scatter;
  body::SeatPlace place = seat.place;
  // Drawn whether used or not, so that a scatter of zero leaves every other draw where it was.
  const double dx = scatter_stream_.normal(), dz = scatter_stream_.normal(), turn = scatter_stream_.normal();
  place.world_from_seat.origin += scatter.position_sd_m * Vec3(dx, 0, dz);
  if (person().spec.changes.seat_shift_m != 0.0) {
    place.world_from_seat.origin += person().spec.changes.seat_shift_m * seat.place.world_from_seat.forward();
  }
  if (scatter.heading_sd_deg > 0.0) {
    place.world_from_seat.rotation =
        rotation_from_heading(radians(scatter.heading_sd_deg * turn)) * place.world_from_seat.rotation;
  }
  const double heading = heading_of(place.world_from_seat);
  const std::string_view id = std::get<action::Sit>(action().what).seat;
  errands_.push_back(WaitForSeat{id});
  errands_.push_back(TakeSeat{id});
  errands_.push_back(WalkTo{standing_place(place, seat)});
  errands_.push_back(FaceTo{heading});
  errands_.push_back(SitOn{place});
}

/// A scattered seat may need a little more room behind it than the seat as it stands in the scene.
Vec2 Actor::standing_place(const body::SeatPlace& place, const SeatPlan& seat) const {
  constexpr double step_m = 0.02, farthest_m = 0.4;
  const Vec2 pelvis = floor_point(place.world_from_seat.origin);
  const Vec2 facing = direction_of(heading_of(place.world_from_seat));
  for (double more = 0.0; more <= farthest_m; more += step_m) {
    const Vec2 stand = pelvis - (seat.stand_back_m + more) * facing;
    if (person().can_stand(stand, facing, seat.half_depth_m)) return stand;
  }
  return pelvis - seat.stand_back_m * facing;
}

void Actor::work(const action::Work& work, std::int64_t now) {
  const std::int64_t since = now - began_;
  if (work.tilt_choices_deg.empty() || since >= lasts_ticks_ || since % tilt_every_ticks_ != 0) return;
  const auto choice = tilt_stream_.index(static_cast<std::uint32_t>(work.tilt_choices_deg.size()));
  motion_->tilt_spine(radians(work.tilt_choices_deg[choice]));
}

void Actor::fidget(const CompiledStudy& study) {
  const FidgetSpec& fidgeting = person().spec.changes.fidgeting;
  if (fidgeting.rate_per_s <= 0.0) return;
  if (fidget_stream_.uniform() >= -std::expm1(-fidgeting.rate_per_s * study.tick_s())) return;
  const double way = 2.0 * fidget_stream_.uniform() - 1.0;
  if (fidget_stream_.index(2) == 0) {
    motion_->sway(radians(fidgeting.tilt_deg) * way);
  } else {
    motion_->turn_head(radians(fidgeting.turn_deg) * way);
  }
}

Actor::Progress Actor::carry_out_first(const CompiledStudy& study, std::span<const Presence> others) {
  return std::visit([&](const auto& errand) { return carry_out(errand, study, others); }, errands_.front());
}

Actor::Progress Actor::carry_out(const ComeIn& come, const CompiledStudy& study, std::span<const Presence> others) {
  if (somebody_near(come.point, others)) {
    wait_for_others(study);
    return Progress::going_on;
  }
  motion_.emplace(person().humanoid, come.point, come.heading, study.scene().floor.height_m(), study.tick_s());
  return Progress::done;
}

Actor::Progress Actor::carry_out(const WaitForDoor& door, const CompiledStudy& study,
                                 std::span<const Presence> others) {
  return door_is_taken(door, others) ? wait_for_turn(study, others) : Progress::done;
}

Actor::Progress Actor::carry_out(const WaitForSeat& wait, const CompiledStudy& study,
                                 std::span<const Presence> others) {
  const bool is_taken = std::ranges::find(others, wait.seat, &Presence::seat) != others.end();
  return is_taken ? wait_for_turn(study, others) : Progress::done;
}

Actor::Progress Actor::wait_for_turn(const CompiledStudy& study, std::span<const Presence> others) {
  const bool for_good = std::ranges::find(others, Presence::Script::going_on, &Presence::script) == others.end();
  if (for_good) give_up("'" + person().spec.id + "' waits in vain: nobody of those there has anything more to do");
  if (present()) wait_for_others(study);  // who isn't there yet is in nobody's way, and may wait long
  return Progress::going_on;
}

Actor::Progress Actor::carry_out(const TakeSeat& take, const CompiledStudy&, std::span<const Presence>) {
  seat_ = take.seat;
  return Progress::done;
}

Actor::Progress Actor::carry_out(const WalkTo& walk, const CompiledStudy& study, std::span<const Presence> others) {
  return walk_to(walk.target, study, others);
}

Actor::Progress Actor::carry_out(const WalkOut& out, const CompiledStudy& study, std::span<const Presence> others) {
  if (route_) return walk_to(route_->position(route_->length_m()), study, others);  // decided when setting out
  return walk_to(somebody_near(out.outside, others) ? out.behind_door : out.outside, study, others);
}

Actor::Progress Actor::carry_out(const FaceTo& face, const CompiledStudy& study, std::span<const Presence> others) {
  if (become_standing(study, others) == Progress::going_on) return Progress::going_on;
  if (std::abs(std::remainder(face.heading - motion_->heading(), 2.0 * pi)) < 1e-9) return Progress::done;
  motion_->turn_to(face.heading);
  return Progress::going_on;
}

Actor::Progress Actor::carry_out(const SitOn& seat, const CompiledStudy&, std::span<const Presence>) {
  if (motion_->stage() == Stage::seated && motion_->settled()) return Progress::done;
  if (motion_->stage() == Stage::standing && motion_->settled()) motion_->sit_down(seat.place);
  return Progress::going_on;
}

Actor::Progress Actor::carry_out(const StandUp&, const CompiledStudy& study, std::span<const Presence> others) {
  return become_standing(study, others);
}

Actor::Progress Actor::carry_out(const Vanish&, const CompiledStudy&, std::span<const Presence>) {
  motion_.reset();
  return Progress::done;
}

bool Actor::somebody_near(const Vec2& point, std::span<const Presence> others) const {
  const double radius = person().humanoid.clearance_radius_m();
  return std::ranges::any_of(others, [&](const Presence& other) {
    return glm::distance(other.position, point) < other.radius_m + radius + gap_m;
  });
}

Actor::Progress Actor::become_standing(const CompiledStudy& study, std::span<const Presence> others) {
  if (motion_->stage() == Stage::standing) return motion_->settled() ? Progress::done : Progress::going_on;
  const bool on_seat = motion_->stage() == Stage::seated || motion_->stage() == Stage::sitting_down;
  if (on_seat && free_to_stand(others)) {
    motion_->rise();
  } else if (on_seat) {
    be_held_up(study);
  }
  // A walk or turn that an earlier action began and that isn't wanted any more; our own ends by itself.
  if (!on_seat && !route_ && motion_->stage() == Stage::walking) motion_->stop();
  return Progress::going_on;
}

bool Actor::door_is_taken(const WaitForDoor& door, std::span<const Presence> others) const {
  return std::ranges::any_of(others, [&](const Presence& other) {
    const bool goes_out = glm::distance(other.destination, door.outside) < gap_m;
    if (door.way == Through::in) return goes_out;
    const bool stays = glm::distance(other.destination, other.position) < gap_m;  // has no way in: let the other out
    return !goes_out && !stays && glm::distance(other.position, door.outside) < doorway_m;
  });
}

bool Actor::free_to_stand(std::span<const Presence> others) const {
  const double radius = person().humanoid.clearance_radius_m();
  const Vec2 behind = motion_->position() - radius * direction_of(motion_->heading());
  return std::ranges::none_of(others, [&](const Presence& other) {
    return glm::distance(other.position, behind) < other.radius_m + radius - gap_m;
  });
}

Actor::Progress Actor::walk_to(const Vec2& target, const CompiledStudy& study, std::span<const Presence> others) {
  if (route_ && motion_->stage() == Stage::walking) return Progress::going_on;
  if (become_standing(study, others) == Progress::going_on) return Progress::going_on;
  constexpr double arrived_m = 1e-6;
  if (glm::distance(motion_->position(), target) < arrived_m) {
    route_.reset();
    return Progress::done;
  }
  if (!route_ && blocked_ticks_ % std::max<std::int64_t>(1, ticks(search_every_s, study)) != 0) {
    wait_for_others(study);
    return Progress::going_on;
  }
  if (!route_) {
    std::vector<body::Disc> discs;
    for (const Presence& other : others) discs.push_back({other.position, other.radius_m + gap_m});
    const auto way = person().floor->find_way(motion_->position(), target, discs);
    if (!way) {
      if (!person().floor->find_way(motion_->position(), target)) {
        give_up("'" + person().spec.id + "' finds no way to where they are to go, even if nobody stands in it");
      }
      wait_for_others(study);
      return Progress::going_on;
    }
    route_.emplace(*way);
  }
  constexpr double facing_rad = 1e-6;
  const double off = std::remainder(route_->heading(0.0) - motion_->heading(), 2.0 * pi);
  if (std::abs(off) > facing_rad) {
    motion_->turn_to(route_->heading(0.0));
  } else {
    motion_->walk(*route_);
    if (!std::holds_alternative<action::Sit>(action().what)) seat_ = {};
  }
  return Progress::going_on;
}

double Actor::free_way_ahead(std::span<const Presence> others) const {
  double free_m = look_ahead_m;
  if (others.empty()) return free_m;
  const Vec2 ahead = direction_of(motion_->heading());
  for (const Presence& other : others) {
    const Vec2 to_other = other.position - motion_->position();
    const double along = glm::dot(to_other, ahead);
    const double aside = std::abs(to_other.x * ahead.y - to_other.y * ahead.x);
    const double reach = person().humanoid.clearance_radius_m() + other.radius_m;
    if (along > 0.0 && aside < reach) {
      free_m = std::min(free_m, along - std::sqrt(reach * reach - aside * aside) - gap_m);
    }
  }
  return free_m;
}

/// Will somebody who goes first come too near within the next moments if both go on as they do?
bool Actor::must_give_way(std::span<const Presence> others) const {
  if (others.empty()) return false;
  const Presence mine = presence();
  for (const Presence& other : others) {
    const Vec2 offset = other.position - mine.position;
    const Vec2 closing = other.velocity - person().humanoid.walking_speed_m_s() * direction_of(motion_->heading());
    const double speed2 = glm::dot(closing, closing);
    if (glm::length(other.velocity) < 0.1 || speed2 < 1e-6) continue;  // who stands is walked round
    const double when = std::clamp(-glm::dot(offset, closing) / speed2, 0.0, foresight_s);
    if (when > 0.0 && glm::length(offset + when * closing) < mine.radius_m + other.radius_m + gap_m) return true;
  }
  return false;
}

void Actor::keep_distance(const CompiledStudy& study, std::span<const Presence> others, std::size_t n_before) {
  if (motion_->stage() != Stage::walking) return;
  const double free_m = free_way_ahead(others);
  const bool give_way = must_give_way(others.first(n_before));
  const double safe = give_way ? 0.0 : std::sqrt(2.0 * braking_m_s2 * std::max(0.0, free_m));
  motion_->limit_speed(std::min(person().humanoid.walking_speed_m_s(), safe));
  if (free_m > gap_m) {
    blocked_ticks_ = 0;
    return;
  }
  wait_for_others(study);
  if (blocked_ticks_ % ticks(patience_s + patience_step_s * index_, study) == 0) {
    motion_->stop();  // stands, then looks for a way round the others
    route_.reset();
  }
}

void Actor::give_up(const std::string& why) const { throw Error(ErrorCode::infeasible, action().where, why); }

void Actor::wait_for_others(const CompiledStudy& study) {
  if (++blocked_ticks_ > ticks(give_up_s, study)) give_up_waiting();
  be_held_up(study);
}

void Actor::be_held_up(const CompiledStudy& study) {
  if (++held_up_ticks_ > ticks(give_up_in_all_s, study)) give_up_waiting();
}

void Actor::give_up_waiting() const { give_up("'" + person().spec.id + "' waits in vain for others to make way"); }

}  // namespace pirsim::sim
