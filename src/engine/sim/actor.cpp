#include "engine/sim/actor.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>

#include "engine/sim/occupancy.hpp"
#include "engine/sim/plan_people.hpp"
#include "model/schema/words.hpp"
#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::sim {
namespace {

using body::Stage;
using Course = ActionFacts::Course;
using Needs = ActionFacts::Needs;
using Pose = ActionFacts::Pose;

constexpr double gap_m = 0.1;          ///< assumed: kept between two people beside their radii
constexpr double doorway_m = 2.5;      ///< assumed: who comes in is through the door at that distance (tried 2-3)
constexpr double door_wait_s = 60.0;   ///< assumed: then one goes through the door whoever comes (tried 20-120)
constexpr double told_after_s = 10.0;  ///< assumed, of messages only: who waits for less is a little late
constexpr double adopts_s = 2.5;       ///< assumed (2-4): from lying flat onto a side, or up to half-lying
constexpr double half_drawn_up = 0.5;  ///< assumed (0.2-0.8): the legs of who lies on a side
constexpr double half_lying_rad = radians(40);  ///< assumed (25-55)
constexpr double room_wait_s = 20.0;            ///< then one comes in where somebody stands, and passes through them

std::int64_t ticks(double seconds, const CompiledStudy& study) {
  return std::llround(seconds * study.sensing().tick_rate_hz);
}

}  // namespace

Actor::Actor(const CompiledStudy& study, std::uint32_t run, std::uint32_t person, std::shared_ptr<const DayPlan> plan)
    : person_(&study.trial_of(run).people[person]),
      plan_(std::move(plan)),
      index_(person),
      tilt_stream_({study.seed(), run, person, Purpose::spine_tilt}),
      scatter_stream_({study.seed(), run, person, Purpose::seat_scatter}),
      restlessness_(this->person().spec.changes, study.seed(), run, person, study.tick_s()) {
  if (this->person().spec.style == MotionStyle::natural) {
    natural_.emplace(study.seed(), run, person, study.sensing().tick_rate_hz);
  }
  if (this->person().spec.pet) pet_.emplace(study, run, person);
}

std::string_view Actor::current_phase() const noexcept {
  if (begun_ && !action().phase.empty()) return action().phase;
  if (!present()) return phase_outside;
  if (facts_.desk_work != nullptr && !body_->got_up()) return phase_working;
  return body::name(body_->motion().stage());
}

Presence Actor::presence() const {
  Presence mine = body_->presence();
  mine.seat = seat_;
  mine.script = done() ? Presence::Script::carried_out : Presence::Script::going_on;
  return mine;
}

bool Actor::counts_on(const FloorArea& floor) const {
  return present() && person().spec.changes.role != PersonRole::object && floor.contains(motion().position());
}

void Actor::note(IncidentKind kind, std::int64_t tick) {
  incidents_.push_back({kind, tick, index_, body_ ? body_->motion().position() : Vec2(0.0)});
}

void Actor::begin(const CompiledStudy& study, const Others& others) {
  if (pet_) {
    const body::Outline outline = pet_->outline();
    body_.emplace(study, person(), index_, outline.pelvis.position, outline.pelvis.heading);
    return body_motion().pose_as(outline);
  }
  if (done() || action().at_s.value_or(0.0) > 0.0) return;
  const ActionFacts facts = facts_of(action().what);
  const bool is_led = facts.follows != nullptr;
  if ((facts.course != Course::comes && !is_led) || facts.entrance != nullptr) return;
  if (facts.appears_at != nullptr && somebody_near(*facts.appears_at, others)) return;
  start_action({study, others, 0});
  // Whose path begins with the run stands at its first point before the first tick.
  if (carry_out_first({study, others, is_led ? -1 : 0}) == Progress::going_on) return;
  errands_.pop_front();
  if (natural_) natural_->settle(body_motion(), activity_at_first());
}

/// What somebody who appears is busy with at once.
std::optional<Activity> Actor::activity_at_first() const {
  if (action_ + 1 == actions().size()) return std::nullopt;
  const ScriptedAction& next = actions()[action_ + 1];
  const ActionFacts facts = facts_of(next.what);
  return facts.course == Course::stays && next.at_s.value_or(0.0) <= 0.0 ? facts.activity : std::nullopt;
}

void Actor::start_action(const Scene& scene) {
  begun_ = true;
  facts_ = facts_of(action().what);
  began_ = scene.now;
  note_times(scene.study);
  plan(scene);
}

DoorUser Actor::door_user(const FloorArea& floor, const Vec2& before) const {
  constexpr double knees_m = 0.45;  // assumed: before the pelvis of who sits (0.4-0.55)
  DoorUser user;
  user.before = before;
  user.now = user.knees = motion().position();
  if (!body_->on_feet()) user.knees += knees_m * direction_of(motion().heading());
  constexpr double slow_m_s = 0.05;
  if (motion().speed_m_s() > slow_m_s) user.gait = DoorUser::Gait::walks;
  if (facts_.follows != nullptr) user.gait = DoorUser::Gait::led;
  user.wants = body_->wanted_door();
  if (user.wants && !floor.contains(user.now)) user.place = DoorUser::Place::doorway;
  return user;
}

void Actor::advance(const CompiledStudy& study, std::int64_t tick, const Others& others, const DoorsSeen& doors) {
  incidents_.clear();
  if (pet_) {
    pet_->advance(study, tick - 1, others, doors);
    return body_motion().pose_as(pet_->outline());
  }
  carry_on({study, others, tick - 1, doors});
  if (body_) {
    if (natural_) move_naturally();
    if (body_->motion().stage() != Stage::seated) {
      restlessness_.leave_seat();
    } else if (restlessness_.acts()) {
      restlessness_.tick(body_motion(), choreographed_work());
    }
    facts_.follows != nullptr ? body_motion().advance() : body_->advance(others, doors, tick - 1);
    if (const auto incident = body_->take_incident()) incidents_.push_back(*incident);
  }
  phase_ = current_phase();
  if (!done() && begun_ && errands_.empty() && time_is_up(tick)) finish_action();
}

void Actor::carry_on(const Scene& scene) {
  const auto sitter = sits_on_ && !done() ? Pedestrian::Sitter::may_get_up : Pedestrian::Sitter::stays;
  const bool busy =
      body_ && facts_.follows == nullptr && body_->makes_way(scene.others, scene.doors, scene.now, sitter);
  while (!done()) {
    if (!begun_) {
      if (action().at_s && scene.now < ticks(*action().at_s, scene.study)) return;
      start_action(scene);
    }
    if (!busy && sits_on_ && errands_.empty() && body_->got_up()) {
      body_->set_out();
      errands_.push_back(SitOn(*sits_on_));
    }
    while (!busy && !errands_.empty() && carry_out_first(scene) == Progress::done) {
      errands_.pop_front();
      waited_ticks_ = 0;
      if (body_) body_->set_out();
    }
    tilt_at_work(scene.now);
    const auto next = scene.now < called_at_ ? std::nullopt : interrupting_action(scene);
    if (!next && !(errands_.empty() && time_is_up(scene.now))) return;
    finish_action();
    if (next) action_ = *next;
  }
}

std::int64_t Actor::away_until(const CompiledStudy& study, std::int64_t tick) const {
  constexpr auto for_good = std::numeric_limits<std::int64_t>::max();
  if (present() || phase_ != current_phase()) return tick;  // an action has ended: the next tick tells
  if (done()) return for_good;
  std::int64_t until = for_good;
  for (std::size_t i = action_ + (begun_ ? 1 : 0); i < actions().size() && until == for_good; ++i) {
    if (actions()[i].at_s) until = ticks(*actions()[i].at_s, study);
  }
  if (!begun_) return action().at_s ? until : tick;
  const bool waits = errands_.empty() && facts_.course == Course::stays && facts_.needs == Needs::nothing;
  return waits ? std::min(until, began_ + lasts_ticks_ - 1) : tick;
}

void Actor::finish_action() {
  errands_.clear();
  waited_ticks_ = seat_wait_ticks_ = 0;
  if (body_) {
    body_->forget_way();
    body_->set_out();
    if (facts_.desk_work != nullptr) body_motion().rest();
  }
  ++action_;
  begun_ = false;
  facts_ = {};
}

std::optional<std::size_t> Actor::interrupting_action(const Scene& scene) const {
  std::optional<std::size_t> latest;
  for (std::size_t i = action_ + 1; i < actions().size(); ++i) {
    const std::optional<double>& at_s = actions()[i].at_s;
    if (at_s && scene.now < ticks(*at_s, scene.study)) break;  // times ascend
    if (at_s) latest = i;
  }
  return latest;
}

/// In ticks, once an action: they are asked for every tick.
void Actor::note_times(const CompiledStudy& study) {
  const auto later = std::span(actions()).subspan(action_ + 1);
  const auto call = std::ranges::find_if(later, [](const ScriptedAction& other) { return other.at_s.has_value(); });
  called_at_ = call == later.end() ? std::numeric_limits<std::int64_t>::max() : ticks(*call->at_s, study);
  lasts_ticks_ = ticks(facts_.lasts_s, study);
  if (facts_.desk_work == nullptr) return;
  tilt_every_ticks_ = std::max<std::int64_t>(1, ticks(facts_.desk_work->tilt_every_s, study));
}

bool Actor::time_is_up(std::int64_t now) const noexcept { return now - began_ >= lasts_ticks_; }

void Actor::plan(const Scene& scene) {
  const auto entrance = [&](const std::string& id) -> const EntranceSpec& {
    return *std::ranges::find(scene.study.scene().entrances, id, &EntranceSpec::id);
  };
  if (facts_.course != Course::stays) sits_on_.reset();
  if (!present() && facts_.needs != Needs::nothing) return;  // called away before they came: nothing to do
  if (present() && facts_.course == Course::comes) return;   // called back before they had left
  if (facts_.follows != nullptr) {
    const action::Follow& follow = *facts_.follows;
    std::vector<double> headings;
    for (const double heading_deg : follow.headings_deg) headings.push_back(radians(heading_deg));
    errands_.push_back(FollowPath{std::make_shared<const body::FollowedPath>(follow.times_s, follow.points, headings)});
    errands_.push_back(Vanish{});
  } else if (facts_.appears_at != nullptr) {
    errands_.push_back(ComeIn{*facts_.appears_at, radians(*facts_.heading_deg)});
  } else if (facts_.course == Course::comes && facts_.place != nullptr) {
    plan_being_there(scene, *facts_.place);
  } else if (facts_.course == Course::comes) {
    plan_entering(entrance(*facts_.entrance));
  } else if (facts_.course == Course::goes) {
    plan_leaving(entrance(*facts_.entrance));
  } else if (facts_.seat != nullptr) {
    plan_sitting(*facts_.seat);
  } else if (facts_.place != nullptr) {
    plan_place(scene, *facts_.place);
  } else if (facts_.walks()) {
    for (const Vec2& point : facts_.walks_to) errands_.push_back(WalkTo{point});
  } else if (facts_.heading_deg) {
    errands_.push_back(FaceTo{radians(*facts_.heading_deg)});
  } else if (facts_.pose == Pose::upright) {
    errands_.push_back(StandUp{});
  } else if (facts_.desk_work != nullptr) {
    if (body_->motion().stage() == Stage::seated) {
      begin_work();
    } else if (!sits_on_) {
      lasts_ticks_ = 0;  // did without a seat
    }
  }
}

void Actor::begin_work() {
  const action::Work& work = *facts_.desk_work;
  body_motion().work({natural_ ? 0.0 : work.arm_amplitude_m, work.arm_period_s});
}

void Actor::plan_entering(const EntranceSpec& door) {
  const ScriptedAction* next = action_ + 1 < actions().size() ? &actions()[action_ + 1] : nullptr;
  const std::string* seat_next = next != nullptr ? facts_of(next->what).takes() : nullptr;
  if (seat_next != nullptr) errands_.push_back(WaitForSeat{*seat_next});  // better outside than in the doorway
  errands_.push_back(WaitForDoor{outside_of(door), Through::in});
  errands_.push_back(ComeIn{outside_of(door), heading_of(door.world_from_entrance)});
  if (next != nullptr && leads_on(*next)) return;
  errands_.push_back(WalkTo{inside_of(door, person().humanoid)});
}

void Actor::plan_leaving(const EntranceSpec& door) {
  const double behind_m = std::min(door.outside_m, 2.0 * person().humanoid.clearance_radius_m());
  errands_.push_back(WaitForDoor{outside_of(door), Through::out});
  errands_.push_back(WalkOut{outside_of(door), floor_point(door.world_from_entrance * Vec3(0, 0, behind_m))});
  errands_.push_back(Vanish{});
}

Actor::SitOn Actor::way_to_sit(std::string_view id) {
  const SeatPlan& seat = person().seat_plan(id);
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
  const double heading = heading_of(place.world_from_seat) + place.approach_turn;
  return {place, standing_place(place, seat), heading};
}

void Actor::plan_sitting(std::string_view id) {
  const SitOn seat = way_to_sit(id);
  errands_.push_back(WaitForSeat{id});
  errands_.push_back(TakeSeat{id});
  errands_.push_back(WalkTo{seat.stand});
  errands_.push_back(FaceTo{seat.heading});
  errands_.push_back(seat);
}

Actor::LieOn Actor::way_to_lie(std::string_view id) const {
  const LyingPlan& plan = person().beds.find(id)->second;
  const Frame& edge = plan.bed.edge.world_from_seat;
  return {{plan.bed.edge, plan.edge.stand(edge), heading_of(edge)}, plan.bed, facts_.lying};
}

void Actor::plan_place(const Scene& scene, std::string_view id) {
  const PlaceSpec& place = *std::ranges::find(scene.study.scene().places, id, &PlaceSpec::id);
  errands_.push_back(WaitForSeat{id});
  errands_.push_back(TakeSeat{id});
  if (place.posture == PlacePosture::lie) {
    const LieOn bed = way_to_lie(id);
    errands_.push_back(WalkTo{bed.edge.stand});
    errands_.push_back(FaceTo{bed.edge.heading});
    errands_.push_back(bed);
  } else {
    errands_.push_back(WalkTo{floor_point(place.world_from_place.origin)});
    errands_.push_back(FaceTo{heading_of(place.world_from_place)});
  }
}

void Actor::plan_being_there(const Scene& scene, std::string_view id) {
  const auto& places = scene.study.scene().places;
  const auto place = std::ranges::find(places, id, &PlaceSpec::id);
  if (place == places.end()) {
    errands_.push_back(BeThere{way_to_sit(id), {}, Stage::seated});
  } else if (place->posture == PlacePosture::lie) {
    const LieOn bed = way_to_lie(id);
    errands_.push_back(BeThere{bed.edge, bed, Stage::lying});
  } else {
    const Frame& frame = place->world_from_place;
    errands_.push_back(BeThere{{{}, floor_point(frame.origin), heading_of(frame)}, {}, Stage::standing});
  }
}

/// A scattered seat may need a little more room before or behind it than the seat as it stands in the scene.
Vec2 Actor::standing_place(const body::SeatPlace& place, const SeatPlan& seat) const {
  constexpr double step_m = 0.02, farthest_m = 0.4;
  const Vec2 facing = direction_of(heading_of(place.world_from_seat) + place.approach_turn);
  const double away = place.feet_ahead_m > 0.0 ? -1.0 : 1.0;
  for (double more = 0.0; more <= farthest_m; more += step_m) {
    const Vec2 stand = seat.stand(place.world_from_seat, away * more);
    if (person().can_stand(stand, facing, seat.half_depth_m)) return stand;
  }
  return seat.stand(place.world_from_seat);
}

void Actor::tilt_at_work(std::int64_t now) {
  if (facts_.desk_work == nullptr || natural_ || !body_ || body_->motion().stage() != Stage::seated) return;
  const std::vector<double>& choices_deg = facts_.desk_work->tilt_choices_deg;
  const std::int64_t since = now - began_;
  if (choices_deg.empty() || since >= lasts_ticks_ || since % tilt_every_ticks_ != 0) return;
  body_motion().tilt_spine(radians(choices_deg[tilt_stream_.index(static_cast<std::uint32_t>(choices_deg.size()))]));
}

const action::Work* Actor::choreographed_work() const {
  return natural_ || !errands_.empty() ? nullptr : facts_.desk_work;
}

void Actor::move_naturally() {
  if (facts_.activity != Activity::meeting) attention_ = {};
  natural_->tick(body_motion(), facts_.activity, attention_);
}

bool Actor::is_at_meeting() const {
  if (facts_.activity != Activity::meeting) return false;
  const Stage stage = body_->motion().stage();
  return stage == Stage::seated || stage == Stage::standing;
}

void Actor::attend(Talk talk, const std::optional<Vec2>& speaker, std::size_t n_others) {
  attention_ = {talk, 0.0, n_others};
  if (!speaker || talk != Talk::listens) return;
  const Vec2 way = *speaker - body_->motion().position();
  attention_.towards = std::remainder(heading_of(way) - body_->motion().heading(), 2.0 * pi);
}

Progress Actor::carry_out_first(const Scene& scene) {
  return std::visit([&](auto& errand) { return carry_out(errand, scene); }, errands_.front());
}

/// If that is the person's style.
void Actor::adopt_manner() {
  if (!natural_) return;
  const PersonInForce& spec = person().spec;
  body_motion().set_manner(body::natural_manner(natural_->pace(spec.walking_speed_m_s), spec.stature_m));
}

Progress Actor::carry_out(const ComeIn& come, const Scene& scene) {
  const bool taken = somebody_near(come.point, scene.others);
  if (taken && ++waited_ticks_ < ticks(room_wait_s, scene.study)) return Progress::going_on;
  body_.emplace(scene.study, person(), index_, come.point, come.heading);
  adopt_manner();
  if (taken) body_->pass_through(scene.now);
  return Progress::done;
}

Progress Actor::carry_out(const WaitForDoor& door, const Scene& scene) {
  const bool waits = door_is_taken(door, scene.others) && ++waited_ticks_ < ticks(door_wait_s, scene.study);
  return waits ? Progress::going_on : Progress::done;
}

Progress Actor::carry_out(const WaitForSeat& wait, const Scene& scene) {
  if (std::ranges::find(scene.others, wait.seat, &Presence::seat) == scene.others.end()) return Progress::done;
  const bool before_coming_in = facts_.takes() == nullptr;
  const double wait_s = (before_coming_in ? facts_of(actions()[action_ + 1].what) : facts_).seat_wait_s;
  const bool for_good = std::ranges::none_of(
      scene.others, [](const Presence& other) { return other.script == Presence::Script::going_on; });
  if (!for_good && ++seat_wait_ticks_ < ticks(wait_s, scene.study)) {
    // Nobody sees them there: rows and occupants tell of it only by who is missing.
    if (before_coming_in && seat_wait_ticks_ == ticks(told_after_s, scene.study)) {
      const auto& next = std::get<WaitForDoor>(errands_[1]);
      incidents_.push_back({IncidentKind::waited_outside, scene.now + 1, index_, next.outside});
    }
    return Progress::going_on;
  }
  if (!before_coming_in) do_without_seat(scene);
  return Progress::done;
}

void Actor::do_without_seat(const Scene& scene) {
  const SeatSpec* other = facts_.if_taken == action::IfTaken::other_seat ? nearest_free_seat(scene) : nullptr;
  note(other != nullptr ? IncidentKind::seat_changed : IncidentKind::seat_missed, scene.now + 1);
  // The errand that asks for this is the first, and about to be popped.
  errands_.resize(1, errands_.front());
  if (other != nullptr) plan_sitting(other->id);
}

const SeatSpec* Actor::nearest_free_seat(const Scene& scene) const {
  const SeatSpec* nearest = nullptr;
  double least_m = 0.0;
  const Vec2 here = body_ ? body_->motion().position() : Vec2(0.0);
  for (const SeatSpec& seat : scene.study.scene().seats) {
    if (!person().can_use(seat.id)) continue;
    if (std::ranges::find(scene.others, seat.id, &Presence::seat) != scene.others.end()) continue;
    const double away_m = glm::distance(floor_point(seat.world_from_seat.origin), here);
    if (nearest != nullptr && away_m >= least_m) continue;
    nearest = &seat;
    least_m = away_m;
  }
  return nearest;
}

Progress Actor::carry_out(const TakeSeat& take, const Scene&) {
  seat_ = take.seat;
  return Progress::done;
}

Progress Actor::carry_out(const WalkTo& walk, const Scene& scene) {
  constexpr double near_m = 1.5;  // assumed (1-2): where somebody stands already, beside them will do
  if (facts_.walks() && body_->is_held_up(scene.now) && somebody_near(walk.target, scene.others) &&
      glm::distance(body_->motion().position(), walk.target) < near_m) {
    body_->forget_way();
    return Progress::done;
  }
  const Progress progress = body_->go_to(walk.target, scene.others, scene.now);
  // A seat is left where the walk away from it begins, unless they are about to come back to it.
  const bool keeps_seat = facts_.takes() != nullptr || sits_on_;
  if (!keeps_seat && body_->motion().stage() == Stage::walking) seat_ = {};
  return progress;
}

Progress Actor::carry_out(const WalkOut& out, const Scene& scene) {
  const Vec2 target = body_->target().value_or(  // decided when setting out
      somebody_near(out.outside, scene.others) ? out.behind_door : out.outside);
  return carry_out(WalkTo{target}, scene);
}

Progress Actor::carry_out(const FaceTo& face, const Scene& scene) {
  if (body_->stand_up(scene.others, scene.now) == Progress::going_on) return Progress::going_on;
  if (std::abs(std::remainder(face.heading - body_->motion().heading(), 2.0 * pi)) < 1e-9) return Progress::done;
  body_motion().turn_to(face.heading);
  return Progress::going_on;
}

Progress Actor::carry_out(const SitOn& seat, const Scene& scene) {
  if (!sits_down(seat, scene)) return Progress::going_on;
  sits_on_ = seat;
  // Who got up for somebody goes on with what they were at.
  if (facts_.desk_work != nullptr) begin_work();
  return Progress::done;
}

bool Actor::sits_down(const SitOn& seat, const Scene& scene) {
  if (body_->motion().stage() == Stage::seated && body_->motion().settled()) return true;
  if (body_->motion().stage() != Stage::standing || !body_->motion().settled()) return false;
  constexpr double there_m = 0.05, facing_rad = 0.02;
  const bool there = glm::distance(body_->motion().position(), seat.stand) < there_m &&
                     std::abs(std::remainder(seat.heading - body_->motion().heading(), 2.0 * pi)) < facing_rad;
  if (there) {
    body_->sit_down(seat.place, scene.others, scene.now);
  } else {
    const SitOn again = seat;
    errands_.push_front(FaceTo{again.heading});
    errands_.push_front(WalkTo{again.stand});
  }
  return false;
}

Progress Actor::carry_out(const LieOn& lie, const Scene& scene) {
  const Stage stage = body_->motion().stage();
  if (stage == Stage::lying) {
    adopt(lie.posture);
    return Progress::done;
  }
  if (stage == Stage::lying_down) return Progress::going_on;
  const body::LyingPlace bed = lie.bed;
  if (sits_down(lie.edge, scene)) body_motion().lie_down(bed);
  return Progress::going_on;
}

/// What a body goes through on its way there is passed over.
Progress Actor::carry_out(const BeThere& there, const Scene& scene) {
  const bool since_long = scene.now == 0;  // when the run begins: nobody has to get past those beside
  const bool taken = (!since_long && somebody_near(there.before.stand, scene.others)) ||
                     std::ranges::find(scene.others, *facts_.place, &Presence::seat) != scene.others.end();
  if (taken && ++waited_ticks_ < ticks(room_wait_s, scene.study)) return Progress::going_on;
  body_.emplace(scene.study, person(), index_, there.before.stand, there.before.heading);
  adopt_manner();
  if (taken) body_->pass_through(scene.now);
  seat_ = *facts_.place;
  const auto until = [this](Stage stage) {
    while (body_->motion().stage() != stage || !body_->motion().settled()) body_motion().advance();
  };
  if (there.stage == Stage::standing) return Progress::done;
  body_motion().sit_down(there.before.place);
  until(Stage::seated);
  if (!there.lies) {
    sits_on_ = there.before;
    return Progress::done;
  }
  body_motion().lie_down(there.lies->bed);
  until(Stage::lying);
  adopt(there.lies->posture);
  for (int tick = 0; tick < ticks(adopts_s, scene.study); ++tick) body_motion().advance();
  return Progress::done;
}

void Actor::adopt(LyingPosture posture) {
  using body::Channel;
  const double side = posture == LyingPosture::left_side ? 1.0 : posture == LyingPosture::right_side ? -1.0 : 0.0;
  body_motion().adjust(Channel::roll, side * 0.5 * pi, adopts_s);
  body_motion().adjust(Channel::curl, side == 0.0 ? 0.0 : half_drawn_up, adopts_s);
  body_motion().adjust(Channel::raise, posture == LyingPosture::half_lying ? half_lying_rad : 0.0, adopts_s);
}

Progress Actor::carry_out(const StandUp&, const Scene& scene) { return body_->stand_up(scene.others, scene.now); }

Progress Actor::carry_out(const Vanish&, const Scene&) {
  body_.reset();
  seat_ = {};
  sits_on_.reset();
  return Progress::done;
}

/// From scene.now to the next tick, at which they are where the path says.
Progress Actor::carry_out(FollowPath& follow, const Scene& scene) {
  const body::FollowedPath& path = *follow.path;
  const double time_s = static_cast<double>(scene.now + 1) * scene.study.tick_s();
  constexpr double rounding_s = 1e-9;
  if (time_s > path.last_s() + rounding_s) return Progress::done;
  if (time_s < path.first_s() - rounding_s) return Progress::going_on;
  if (!body_) body_.emplace(scene.study, person(), index_, path.start().position, path.start().heading);
  const std::size_t n_begun = path.n_begun(time_s);
  if (n_begun == 0) return Progress::going_on;
  for (; follow.n_begun < n_begun; ++follow.n_begun) {
    if (follow.n_begun > 0 &&
        body_->motion().stage() == Stage::walking) {  // comes to stand at the end of the one before
      body_motion().follow_to(path.legs()[follow.n_begun - 1].route.length_m());
      body_motion().advance();
    }
    const body::FollowedPath::Leg& leg = path.legs()[follow.n_begun];
    body_motion().follow(leg.route, leg.walked_m, leg.headings);
  }
  if (body_->motion().stage() == Stage::walking) body_motion().follow_to(path.legs()[n_begun - 1].walked_at(time_s));
  return Progress::going_on;
}

bool Actor::somebody_near(const Vec2& point, const Others& others) const {
  const double radius = person().humanoid.clearance_radius_m();
  return std::ranges::any_of(others, [&](const Presence& other) {
    return glm::distance(other.position, point) < other.room.radius_m + radius + gap_m;
  });
}

bool Actor::door_is_taken(const WaitForDoor& door, const Others& others) const {
  return std::ranges::any_of(others, [&](const Presence& other) {
    const bool goes_out = glm::distance(other.destination, door.outside) < gap_m;
    if (door.way == Through::in) return goes_out;
    const bool stays = glm::distance(other.destination, other.position) < gap_m;  // has no way in: let the other out
    return !goes_out && !stays && glm::distance(other.position, door.outside) < doorway_m;
  });
}

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
    if (n_people > 1 && actors_[i].present() && !actors_[i].is_pet())
      in_scene_.push_back(actors_[i].presence());  // of one nobody asks
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
      actors_[i].attend(i == speaker ? Talk::speaks
                        : speaker    ? Talk::listens
                                     : Talk::none,
                        place, together_.size() - 1);
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
    if (!actor.present() || actor.is_pet()) {
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
/// Pets see people; people don't mind pets.
void Crowd::advance_among_others(const CompiledStudy& study, std::int64_t tick) {
  std::size_t n_before = 0;
  for (Actor& actor : actors_) {
    if (actor.is_pet()) {
      actor.advance(study, tick, {in_scene_, n_before, Others::Me::not_there}, doors_.seen(study));
      continue;
    }
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
