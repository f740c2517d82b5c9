#include "engine/sim/pedestrian.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "engine/body/ground.hpp"
#include "model/core/text.hpp"
#include "pirsim/error.hpp"

namespace pirsim::sim {

double distance(const Vec2& point, const Stadium& stadium) {
  return body::distance(point, stadium.a, stadium.b) - stadium.radius_m;
}

void append_discs(const Stadium& stadium, double more_m, std::vector<body::Disc>& discs) {
  constexpr double spacing_m = 0.2;
  const double length = glm::distance(stadium.a, stadium.b);
  const int n_more = static_cast<int>(std::ceil(length / spacing_m));
  for (int i = 0; i <= n_more; ++i) {
    const double share = n_more == 0 ? 0.0 : static_cast<double>(i) / n_more;
    discs.push_back({stadium.a + share * (stadium.b - stadium.a), stadium.radius_m + more_m});
  }
}

namespace {

constexpr double sitting_m = 0.25;  ///< assumed: the same from pelvis and knees (0.2-0.3)
constexpr double walking_m =
    0.95;  ///< assumed: who walks needs a way to stop before a leaf that begins to turn (0.8-1.2)
constexpr double leaf_patience_s = 20.0;  ///< then a leaf opens past whoever stands there, as walkers pass each other

bool leads_by(const DoorLeaf& leaf, const DoorUser& user) {
  return user.gait == DoorUser::Gait::led && leaf.distance_to_sweep_m(user.now) < walking_m;
}

using body::Stage;
using PersonSolidity = Presence::Solidity;

constexpr double look_ahead_m = 1.2;      ///< assumed: how far ahead a walker minds others (tried 0.8-2)
constexpr double foresight_s = 1.5;       ///< assumed: how long before ways cross one gives way (tried 1-2)
constexpr double sitter_gap_m = 0.06;     ///< kept beside that in planning: what a rounded corner cuts, and 1 cm
constexpr double squeeze_corner_m = 0.1;  ///< radius of their corners: little is cut off them
constexpr double squeeze_speed = 0.5;     ///< assumed: of the usual pace
constexpr double braking_m_s2 = 1.5;      ///< assumed, as Motion's acceleration
constexpr double patience_s = 0.5;        ///< assumed: wait before looking for another way (tried 0.3-1)
constexpr double patience_step_s = 0.35;  ///< more for some, so that two don't dodge alike
constexpr double wish_after_s = 1.0;      ///< assumed: held up for so long one asks others to make way (tried 0.5-2)
constexpr double walked_on_m = 0.5;       ///< who has come so far isn't held up any more
constexpr double passed_m = 0.8;          ///< who passes through others goes at least so far
constexpr double stuck_s = 20.0;          ///< then people pass through each other (people.md)
constexpr double stuck_in_all_s = 60.0;   ///< assumed: held up so long in one errand is stuck too (tried 40-120)

std::string text(const Vec2& place) { return "(" + fixed(place.x, 2) + ", " + fixed(place.y, 2) + ") m"; }

constexpr double way_step_m = 0.05;
constexpr double unlimited_m = std::numeric_limits<double>::infinity();

using body::Stage;
using PersonSolidity = Presence::Solidity;

constexpr double wish_reaches_m = 3.0;  ///< assumed: who stands farther along a wished way isn't concerned yet
constexpr double place_reach_m = 3.0;   ///< farther away nobody goes to wait
constexpr double aside_most_s = 10.0;   ///< assumed: nobody waits aside for longer (tried 5-20)
constexpr double get_up_after_s = 3.0;  ///< assumed: who is held up for so long asks sitters to get up
constexpr double ask_every_s = 1.0;     ///< how often it is found out who bars the way
constexpr double up_most_s = 40.0;      ///< assumed: nobody who got up waits for longer
constexpr double past_m = 0.8;          ///< assumed: beyond the seat of who got up one is past it

double distance_to_way(const Vec2& point, const std::vector<Vec2>& way, double reach_m) {
  double nearest = glm::distance(point, way.front()), walked = 0.0;
  for (std::size_t i = 0; i + 1 < way.size() && walked < reach_m; ++i) {
    nearest = std::min(nearest, body::distance(point, way[i], way[i + 1]));
    walked += glm::distance(way[i], way[i + 1]);
  }
  return nearest;
}

bool comes_near(const std::vector<Vec2>& way, const Stadium& trunk, double near_m) {
  constexpr double step_m = 0.05;
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const int n_steps = static_cast<int>(std::ceil(glm::distance(way[i], way[i + 1]) / step_m));
    for (int k = 0; k <= n_steps; ++k) {
      const double share = n_steps == 0 ? 0.0 : static_cast<double>(k) / n_steps;
      if (distance(way[i] + share * (way[i + 1] - way[i]), trunk) < near_m) return true;
    }
  }
  return false;
}

/// How far along the way its point next to this one is.
double along(const std::vector<Vec2>& way, const Vec2& point) {
  double nearest = glm::distance(point, way.front()), walked = 0.0, there = 0.0;
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const Vec2 leg = way[i + 1] - way[i];
    const double length = glm::length(leg);
    const double away = body::distance(point, way[i], way[i + 1]);
    if (away < nearest && length > 0.0) {
      nearest = away;
      there = walked + std::clamp(glm::dot(point - way[i], leg) / length, 0.0, length);
    }
    walked += length;
  }
  return there;
}

}  // namespace

Doors::Doors(const CompiledStudy& study, std::uint32_t run)
    : steps_(rest_steps(study.array().leaves())), barred_(steps_.size(), 0) {
  for (std::uint32_t i = 0; i < steps_.size(); ++i) {
    const Goal goal = steps_[i] == 0 ? Goal::shut : Goal::open;
    doors_.push_back({.goal = goal, .habit = Stream({study.seed(), run, i, Purpose::door_habit})});
  }
}

void Doors::advance(const CompiledStudy& study, std::int64_t tick, std::span<const DoorUser> users) {
  for (std::size_t i = 0; i < doors_.size(); ++i) {
    if (study.scene().doors[i].state != DoorState::open) advance_one(study, i, tick, users);
  }
}

void Doors::note_pass(const CompiledStudy& study, std::size_t i, std::int64_t tick) {
  const DoorSpec& spec = study.scene().doors[i];
  Door& door = doors_[i];
  door.shut_behind = spec.state == DoorState::shut || door.habit.uniform() < spec.shut_share;
  door.open_until = tick + std::llround(spec.stands_open_s * study.sensing().tick_rate_hz);
}

bool Doors::is_clear(const DoorLeaf& leaf, std::size_t i, std::span<const DoorUser> users) const {
  const bool rests = leaf.rests(steps_[i]);
  return std::ranges::none_of(users, [&](const DoorUser& user) {
    // Whoever stands outside and opens the door to come in has room there that nobody knows of.
    if (user.place == DoorUser::Place::doorway && user.wants == i) return false;
    const double keep_m = user.gait != DoorUser::Gait::stands && rests ? walking_m
                          : user.knees != user.now                     ? sitting_m
                                                                       : clear_m;
    if (glm::distance(user.now, leaf.threshold()) > leaf.reach_m() + 1.0 + keep_m) return false;
    return std::min({leaf.distance_to_sweep_m(user.now), leaf.distance_to_sweep_m(user.knees),
                     leaf.distance_to_sweep_m(0.5 * (user.now + user.knees))}) < keep_m;
  });
}

void Doors::advance_one(const CompiledStudy& study, std::size_t i, std::int64_t tick, std::span<const DoorUser> users) {
  const DoorLeaf& leaf = study.array().leaves()[i];
  Door& door = doors_[i];
  LeafStep& step = steps_[i];
  barred_[i] = 0;
  bool is_led = false, is_wanted = false;
  for (const DoorUser& user : users) {
    if (glm::distance(user.now, leaf.threshold()) > leaf.reach_m() + 3.0) continue;
    is_led = is_led || leads_by(leaf, user);
    is_wanted = is_wanted || is_led || user.wants == i;
    if (step != 0 && leaf.leads_through(user.before, user.now)) note_pass(study, i, tick);
  }
  if (!is_wanted) door.wanted_since.reset();
  if (is_wanted && !door.wanted_since) door.wanted_since = tick;
  if (is_wanted) door.goal = Goal::open;
  if (!is_wanted && step == leaf.open_step() && (door.shut_behind || tick >= door.open_until)) door.goal = Goal::shut;
  const LeafStep goal = door.goal == Goal::open ? leaf.open_step() : LeafStep{0};
  if (step == goal) return;
  const bool is_forced = is_wanted && (is_led || tick - *door.wanted_since >=
                                                     std::llround(leaf_patience_s * study.sensing().tick_rate_hz));
  if (!is_forced && !is_clear(leaf, i, users)) {
    barred_[i] = door.goal == Goal::open ? 1 : 0;
    return;
  }
  step = static_cast<LeafStep>(step < goal ? step + 1 : step - 1);
  if (step != goal) return;
  // If nobody goes through after all, it is shut as if somebody had left it open.
  door.shut_behind = step != 0 && study.scene().doors[i].state == DoorState::shut;
  door.open_until = tick + std::llround(study.scene().doors[i].stands_open_s * study.sensing().tick_rate_hz);
}

std::int64_t Doors::still_until(const CompiledStudy& study, std::int64_t tick) const noexcept {
  std::int64_t until = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 0; i < doors_.size(); ++i) {
    const DoorLeaf& leaf = study.array().leaves()[i];
    if (study.scene().doors[i].state == DoorState::open || (steps_[i] == 0 && doors_[i].goal == Goal::shut)) continue;
    if (!leaf.rests(steps_[i]) || doors_[i].shut_behind || doors_[i].goal == Goal::shut) return tick;
    until = std::min(until, doors_[i].open_until - 1);
  }
  return until;
}

Pedestrian::Pedestrian(const CompiledStudy& study, const PersonModel& person, std::uint32_t index, const Vec2& point,
                       double heading)
    : person_(&person),
      index_(index),
      tick_rate_hz_(study.sensing().tick_rate_hz),
      motion_(person.humanoid, point, heading, study.scene().floor.height_m(), study.tick_s()) {}

std::int64_t Pedestrian::ticks(double seconds) const noexcept {
  return std::max<std::int64_t>(1, std::llround(seconds * tick_rate_hz_));
}

bool Pedestrian::on_feet() const noexcept {
  const Stage stage = motion_.stage();
  return stage == Stage::standing || stage == Stage::walking || stage == Stage::turning;
}

Presence Pedestrian::presence() const {
  Presence mine;
  mine.person = index_;
  mine.position = motion_.position();
  const double speed = motion_.speed_m_s();
  if (speed > 0.0) mine.velocity = speed * direction_of(motion_.heading());
  mine.destination = target().value_or(mine.position);
  mine.solidity = solidity_;
  const body::Humanoid& body = person_->humanoid;
  const double clearance_m = person_->floor->clearance_m();
  mine.posture = on_feet() ? Presence::Posture::on_feet : Presence::Posture::on_chair;
  if (on_feet()) {
    mine.gap_m = gap_m;
    mine.room = {mine.position, mine.position, clearance_m};
    mine.trunk = {mine.position, mine.position, body.trunk_radius_m()};
  } else if (motion_.stage() == Stage::seated) {
    const Vec2 ahead = direction_of(motion_.heading()), right(-ahead.y, ahead.x);
    const auto back_m = [&](double tilt) { return std::max(0.0, -std::sin(tilt)) * body.trunk_height_m(); };
    const double beside_m = body.half_width_m() - 0.5 * body.half_depth_m();  // covers the trunk's corners
    mine.gap_m = sitter_gap_m;
    mine.room = {mine.position, mine.position - back_m(-leaning_back_rad) * ahead, body.trunk_radius_m()};
    const Vec2 middle = mine.position - 0.5 * back_m(motion_.spine_tilt()) * ahead;
    mine.trunk = {middle - beside_m * right, middle + beside_m * right,
                  body.half_depth_m() + 0.5 * back_m(motion_.spine_tilt())};
  } else if (motion_.stage() == Stage::lying) {
    mine.gap_m = sitter_gap_m;
    mine.room = mine.trunk = {mine.position, mine.position, body.trunk_radius_m()};
  } else {
    mine.gap_m = sitter_gap_m;
    mine.room = {mine.position, motion_.drawn_back(), clearance_m};
    mine.trunk = {mine.position, motion_.drawn_back(), body.trunk_radius_m()};
  }
  mine.wished_way = wished_way_;
  if (wished_way_) mine.asks_up = asks_up_;
  mine.got_up_from = got_up_from_;
  if (aside_) {
    mine.precedence = aside_->precedence;
    if (aside_->way) mine.got_up_for = aside_->whom;
  } else if (held_up_since_) {
    mine.precedence = {*held_up_since_, index_};
  }
  return mine;
}

double Pedestrian::gap_to(const Presence& other) const noexcept {
  return width_ == Width::narrow ? squeeze_gap_m : other.gap_m;
}

void Pedestrian::forget_way() noexcept {
  width_ = Width::usual;
  route_.reset();
  target_.reset();
  wished_way_.reset();
}

std::optional<Incident> Pedestrian::take_incident() noexcept {
  if (!incident_) return std::nullopt;
  const auto taken = incident_;
  incident_.reset();
  return taken;
}

bool Pedestrian::is_held_up(std::int64_t now) const noexcept {
  return held_up_since_ && now - *held_up_since_ >= ticks(wish_after_s);
}

void Pedestrian::be_held_up(std::int64_t now) {
  ++blocked_ticks_;
  ++held_up_ticks_;
  if (!held_up_since_) {
    held_up_since_ = now;
    held_up_at_ = motion_.position();
    asks_up_.reset();
    is_let_by_ = false;
  }
  if (solidity_ != PersonSolidity::solid) return;
  const bool stuck = !is_let_by_ && now - *held_up_since_ >= ticks(stuck_s);
  if (stuck || held_up_ticks_ >= ticks(stuck_in_all_s)) pass_through(now);
}

void Pedestrian::pass_through(std::int64_t now) {
  solidity_ = PersonSolidity::passing_through;
  held_up_at_ = motion_.position();
  incident_ = Incident{IncidentKind::passed_through, now, index_, motion_.position()};
  aside_.reset();
  wished_way_.reset();
  held_up_since_.reset();
  held_up_ticks_ = blocked_ticks_ = 0;
  if (motion_.stage() == Stage::walking) motion_.stop();
  route_.reset();
}

/// Solid again once clear of everybody, on the way or at its end.
void Pedestrian::end_passing(const Others& others) noexcept {
  const bool clear = std::ranges::none_of(others, [&](const Presence& other) {
    return distance(motion_.position(), other.trunk) < person_->humanoid.trunk_radius_m();
  });
  const bool done = on_feet() ? !target_ || glm::distance(motion_.position(), held_up_at_) > passed_m
                              : motion_.stage() == Stage::seated || motion_.stage() == Stage::lying;
  if (clear && done) solidity_ = PersonSolidity::solid;
}

Progress Pedestrian::stand_up(const Others& others, std::int64_t now) {
  if (motion_.stage() == Stage::standing) return motion_.settled() ? Progress::done : Progress::going_on;
  const Stage stage = motion_.stage();
  const bool on_seat =
      stage == Stage::seated || stage == Stage::sitting_down || stage == Stage::lying || stage == Stage::lying_down;
  if (on_seat && (solidity_ != PersonSolidity::solid || free_to_draw_back(motion_.drawn_back(), others))) {
    motion_.rise();
    wished_way_.reset();
    held_up_since_.reset();
  } else if (on_seat) {
    be_held_up(now);
    wish_way({motion_.position(), motion_.drawn_back()}, now);
  }
  // A walk that isn't wanted any more; our own ends by itself.
  if (!on_seat && !route_ && motion_.stage() == Stage::walking) motion_.stop();
  return Progress::going_on;
}

void Pedestrian::sit_down(const body::SeatPlace& seat, const Others& others, std::int64_t now) {
  const Vec2 back = motion_.position() - body::fall_back_m(person_->humanoid, seat) * direction_of(motion_.heading());
  if (solidity_ != PersonSolidity::solid || free_to_draw_back(back, others)) {
    motion_.sit_down(seat);
    wished_way_.reset();
    held_up_since_.reset();
  } else {
    be_held_up(now);
    wish_way({motion_.position(), back}, now);
  }
}

void Pedestrian::wish_way(Way way, std::int64_t now) {
  if (!wished_way_ && is_held_up(now)) wished_way_ = std::make_shared<const Way>(std::move(way));
}

bool Pedestrian::free_to_draw_back(const Vec2& to, const Others& others) const {
  const Vec2 from = motion_.position();
  return std::ranges::none_of(others, [&](const Presence& other) {
    if (!is_solid(other)) return false;
    const double reach = other.trunk.radius_m + person_->humanoid.trunk_radius_m() + sitter_gap_m;
    // Who walks needs a way to stop.
    const Vec2 stops = other.position + glm::length(other.velocity) / (2.0 * braking_m_s2) * other.velocity;
    for (const Vec2& place : {other.position, stops}) {
      // Who sits beside is as near as ever; it is the way back that has to be free.
      if (body::distance(place, from, to) < reach &&
          glm::distance(place, to) < glm::distance(place, from) + sitter_gap_m)
        return true;
    }
    return false;
  });
}

std::optional<std::vector<Vec2>> Pedestrian::way_among(const Vec2& target, const Others& others) const {
  if (solidity_ != PersonSolidity::solid) {
    auto way = floor().find_way(motion_.position(), target);
    return way || !person_->narrow_floor ? way : person_->narrow_floor->find_way(motion_.position(), target);
  }
  std::vector<body::Disc> discs;
  constexpr double from_afar_m = 1.5;  // assumed (1-2): who stands at the goal may have gone by then
  for (const Presence& other : others) {
    if (!is_solid(other)) continue;
    const Stadium& taken = taken_by(other);
    if (distance(target, taken) < radius_m() + gap_to(other) && distance(motion_.position(), taken) > from_afar_m)
      continue;
    append_discs(taken, gap_to(other), discs);
  }
  return floor().find_way(motion_.position(), target, discs);
}

Progress Pedestrian::go_to(const Vec2& target, const Others& others, std::int64_t now) {
  if (target_ != target) route_.reset();
  if (route_ && motion_.stage() == Stage::walking) return Progress::going_on;
  target_ = target;
  if (stand_up(others, now) == Progress::going_on) return Progress::going_on;
  constexpr double arrived_m = 1e-6;
  if (glm::distance(motion_.position(), target) < arrived_m) {
    forget_way();
    held_up_since_.reset();
    return Progress::done;
  }
  if (!route_ && blocked_ticks_ % ticks(search_every_s) != 0) {
    be_held_up(now);
    return Progress::going_on;
  }
  if (!route_) {
    width_ = Width::usual;
    auto way = way_among(target, others);
    if (!way && is_held_up(now) && person_->narrow_floor) {
      width_ = Width::narrow;
      way = way_among(target, others);
      if (!way) width_ = Width::usual;
    }
    if (!way) {
      auto alone = person_->floor->find_way(motion_.position(), target);
      if (!alone && person_->narrow_floor) alone = person_->narrow_floor->find_way(motion_.position(), target);
      if (!alone) {
        throw Error(ErrorCode::infeasible, "'" + person_->spec.id + "' at " + text(motion_.position()) +
                                               " can't reach " + text(target) + ", even in an empty room");
      }
      be_held_up(now);
      wished_way_.reset();
      wish_way(*alone, now);
      ask_up(target, others, now);
      return Progress::going_on;
    }
    route_ = width_ == Width::narrow ? body::Route(*way, squeeze_corner_m) : body::Route(*way);
  }
  constexpr double facing_rad = 1e-6;
  const double off = std::remainder(route_->heading(0.0) - motion_.heading(), 2.0 * pi);
  if (std::abs(off) > facing_rad) {
    motion_.turn_to(route_->heading(0.0));
  } else {
    motion_.walk(*route_);
    walked_m_ = 0.0;
  }
  return Progress::going_on;
}

/// How far one can go, on the route or straight on to a halt, before one comes too near to somebody, and nearer than
/// one is.
double Pedestrian::free_way_ahead(const Others& others) const {
  constexpr double step_m = 0.05;
  double free_m = look_ahead_m;
  const Vec2 here = motion_.position(), straight = direction_of(motion_.heading());
  const auto place = [&](double ahead_m) {
    return route_ ? route_->position(walked_m_ + ahead_m) : here + ahead_m * straight;
  };
  for (const Presence& other : others) {
    if (!is_solid(other)) continue;
    const Stadium& taken = taken_by(other);
    const double now_m = distance(here, taken);
    if (now_m > radius_m() + gap_to(other) + look_ahead_m) continue;
    const double keep_m = std::min(radius_m(), now_m - 1e-3);
    for (double ahead_m = 0.0; ahead_m < free_m + gap_to(other); ahead_m += step_m) {
      if (distance(place(ahead_m + step_m), taken) < keep_m) free_m = ahead_m - gap_to(other);
    }
  }
  return free_m;
}

/// Will somebody who goes first come too near within the next moments if both go on as they do?
bool Pedestrian::must_give_way(std::span<const Presence> others) const {
  for (const Presence& other : others) {
    if (!is_solid(other)) continue;
    const Vec2 offset = other.position - motion_.position();
    const Vec2 closing = other.velocity - motion_.pace_m_s() * direction_of(motion_.heading());
    const double speed2 = glm::dot(closing, closing);
    if (glm::length(other.velocity) < 0.1 || speed2 < 1e-6) continue;  // who stands is walked round
    const double when = std::clamp(-glm::dot(offset, closing) / speed2, 0.0, foresight_s);
    if (when > 0.0 && glm::length(offset + when * closing) < radius_m() + taken_by(other).radius_m + gap_to(other))
      return true;
  }
  return false;
}

void Pedestrian::keep_distance(const Others& others, const DoorsSeen& doors, std::int64_t now) {
  const double door_m = free_way_to_doors(doors);
  const double before_door = std::sqrt(2.0 * braking_m_s2 * std::max(0.0, door_m));
  if (solidity_ != PersonSolidity::solid) {
    motion_.limit_speed(std::min(motion_.pace_m_s(), before_door));
    return;
  }
  const double free_m = others.empty() ? look_ahead_m : free_way_ahead(others);
  const bool give_way = must_give_way(others.before_me());
  const double safe = give_way ? 0.0 : std::sqrt(2.0 * braking_m_s2 * std::max(0.0, free_m));
  const double pace = (width_ == Width::narrow ? squeeze_speed : 1.0) * motion_.pace_m_s();
  motion_.limit_speed(std::min({pace, safe, before_door}));
  if (free_m > (width_ == Width::narrow ? 0.0 : gap_m)) {
    blocked_ticks_ = 0;
    return;
  }
  be_held_up(now);
  if (solidity_ != PersonSolidity::solid) return;
  if (blocked_ticks_ % ticks(patience_s + patience_step_s * (index_ % 4)) == 0) {
    motion_.stop();  // stands, then looks for a way round the others
    route_.reset();
  }
}

/// Would this tick's step bring my trunk into somebody's, or deeper into it?
bool Pedestrian::bumps_into(const Others& others) const {
  constexpr double near_m = 0.05;  // more than any step
  const bool moves =
      motion_.stage() != Stage::seated && motion_.stage() != Stage::standing && motion_.stage() != Stage::lying;
  if (!moves || solidity_ != PersonSolidity::solid) return false;
  const double radius_m = person_->humanoid.trunk_radius_m();
  const Vec2 here = motion_.position();
  const auto is_near = [&](const Presence& other) {
    return is_solid(other) && distance(here, other.trunk) < radius_m + near_m;
  };
  if (std::ranges::none_of(others, is_near)) return false;
  body::Motion next = motion_;
  next.advance();
  return std::ranges::any_of(others, [&](const Presence& other) {
    if (!is_near(other)) return false;
    const double then_m = distance(next.position(), other.trunk);
    return then_m < radius_m && then_m < distance(here, other.trunk);
  });
}

void Pedestrian::advance(const Others& others, const DoorsSeen& doors, std::int64_t now) {
  wanted_door_.reset();
  if (!others.empty()) sit_up(others, now);
  const std::int64_t counted = held_up_ticks_;
  if (motion_.stage() == Stage::walking) keep_distance(others, doors, now);
  const Vec2 before = motion_.position();
  const bool waits = !others.empty() && bumps_into(others);
  if (waits && held_up_ticks_ == counted) be_held_up(now);
  if (waits && solidity_ == PersonSolidity::solid) motion_.halt();
  // Who is on the way onto a chair or off it waits where they are.
  const bool frozen = waits && solidity_ == PersonSolidity::solid && !on_feet();
  if (!frozen) motion_.advance();
  if (route_) walked_m_ += glm::distance(before, motion_.position());
  if (motion_.stage() == Stage::seated && !aside_) got_up_from_.reset();
  if (solidity_ != PersonSolidity::solid) end_passing(others);
  if (held_up_since_ && glm::distance(motion_.position(), held_up_at_) > walked_on_m) {
    held_up_since_.reset();
    wished_way_.reset();
  }
}

// How a pedestrian comes up to doors: they wait before what a leaf sweeps until it is open.

/// Whoever stands nearer than the usual already comes no nearer; who stands in the way of the leaf doesn't set out.
Pedestrian::WayToDoor Pedestrian::way_to_door(const DoorsSeen& doors, std::size_t door) const {
  const DoorLeaf& leaf = doors.leaves[door];
  const LeafStep step = doors.steps[door];
  const double farthest_m = look_ahead_m + leaf.reach_m() + Doors::hold_m;
  const bool is_always_open = leaf.rest_step() == leaf.open_step();
  if (is_always_open || glm::distance(motion_.position(), leaf.threshold()) > farthest_m + leaf.reach_m())
    return {unlimited_m, std::nullopt};
  constexpr double rounding_m = 1e-3;
  const double away_m = leaf.distance_to_sweep_m(motion_.position());
  const double keep_m = std::min(Doors::hold_m, away_m - rounding_m);
  bool leads_through = false;
  double enters_m = farthest_m, through_m = farthest_m;
  Vec2 here = route_->position(walked_m_);
  const double end_m = std::min(farthest_m, route_->length_m() - walked_m_ + way_step_m);
  for (double ahead_m = 0.0; ahead_m < end_m && !leads_through; ahead_m += way_step_m) {
    const double off_m = leaf.distance_to_sweep_m(here);
    const bool is_outside = off_m >= keep_m;
    if (is_outside && enters_m < farthest_m) break;  // past it
    if (off_m > keep_m + 2.0 * way_step_m) {         // comes no nearer than this on a way so long
      ahead_m += way_step_m * (std::floor((off_m - keep_m) / way_step_m) - 1.0);
      here = route_->position(walked_m_ + ahead_m + way_step_m);
      continue;
    }
    if (!is_outside) enters_m = std::min(enters_m, std::max(0.0, ahead_m - way_step_m));
    const Vec2 next = route_->position(walked_m_ + ahead_m + way_step_m);
    leads_through = leaf.leads_through(here, next);
    if (leads_through) through_m = ahead_m;
    here = next;
  }
  const std::optional<double> through = leads_through ? std::optional(through_m) : std::nullopt;
  if (step == leaf.open_step()) return {unlimited_m, through};
  if (away_m < Doors::clear_m) return {leads_through ? 0.0 : unlimited_m, through};
  return {enters_m < farthest_m && (leads_through || step != 0) ? enters_m : unlimited_m, through};
}

/// They want the door that they go through next; once it is open, one behind it that stops them before they are
/// through, as a front door beside that of the bathroom does.
double Pedestrian::free_way_to_doors(const DoorsSeen& doors) {
  double free_m = unlimited_m, nearest_m = unlimited_m, stops_m = unlimited_m;
  if (!route_) return free_m;
  std::optional<std::size_t> stopping;
  for (std::size_t i = 0; i < doors.leaves.size(); ++i) {
    const WayToDoor way = way_to_door(doors, i);
    free_m = std::min(free_m, way.free_m);
    if (!way.through_m) continue;
    if (way.free_m < stops_m) stops_m = way.free_m, stopping = i;
    if (*way.through_m < nearest_m) nearest_m = *way.through_m, wanted_door_ = i;
  }
  if (!stopping || stops_m >= nearest_m) return free_m;
  if (doors.steps[*wanted_door_] == doors.leaves[*wanted_door_].open_step()) wanted_door_ = stopping;
  return free_m;
}

// How a pedestrian makes way for others: on foot by stepping aside, on a chair by leaning forward or getting up.

bool Pedestrian::bars(const Presence& other, const Vec2& from, const Vec2& to) const {
  std::vector<body::Disc> discs;
  append_discs(other.trunk, squeeze_gap_m, discs);
  return !person_->narrow_floor->has_way(from, to, discs);
}

/// As few sitters as will do: those on the wished way, but for whoever can be squeezed past once the others are up.
void Pedestrian::ask_up(const Vec2& target, const Others& others, std::int64_t now) {
  if (!wished_way_ || !person_->narrow_floor || now - *held_up_since_ < ticks(get_up_after_s)) return;
  is_let_by_ = std::ranges::any_of(others, [&](const Presence& other) { return other.got_up_for == index_; });
  if (asks_up_ && now - asked_up_at_ < ticks(ask_every_s)) return;
  asked_up_at_ = now;
  std::vector<const Presence*> sitters;
  std::vector<std::uint32_t> asked;
  const double keep_m = person_->floor->clearance_m() + squeeze_gap_m;
  for (const Presence& other : others) {
    if (!is_solid(other) || other.posture != Presence::Posture::on_chair) continue;
    sitters.push_back(&other);
    if (comes_near(*wished_way_, other.trunk, keep_m)) asked.push_back(other.person);
  }
  for (std::size_t i = 0; i < asked.size();) {
    const std::uint32_t one = asked[i];
    std::vector<body::Disc> discs;
    for (const Presence* sitter : sitters) {
      const bool stays = sitter->person == one || std::ranges::find(asked, sitter->person) == asked.end();
      if (stays) append_discs(sitter->trunk, squeeze_gap_m, discs);
    }
    const bool can_stay = person_->narrow_floor->has_way(motion_.position(), target, discs);
    if (can_stay) {
      asked.erase(asked.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  asks_up_ = std::make_shared<const std::vector<std::uint32_t>>(std::move(asked));
}

template <class Accepts>
std::optional<Vec2> Pedestrian::nearest_place(const Others& others, const Accepts& accepts) const {
  constexpr int n_directions = 16;
  constexpr double step_m = 0.15;
  std::vector<body::Disc> discs;
  for (const Presence& other : others) {
    if (is_solid(other)) append_discs(other.room, 0.0, discs);
  }
  for (double away = step_m; away <= place_reach_m; away += step_m) {
    for (int k = 0; k < n_directions; ++k) {
      const Vec2 place = motion_.position() + away * direction_of(2.0 * pi * k / n_directions);
      if (!person_->floor->walkable(place, place, discs)) continue;
      if (!accepts(place)) continue;
      if (person_->floor->walkable(motion_.position(), place, discs) ||
          person_->floor->has_way(motion_.position(), place, discs)) {
        return place;
      }
    }
  }
  return std::nullopt;
}

std::optional<Vec2> Pedestrian::passing_place(const Presence& whom, const Others& others, double reach_m) const {
  const double keep_m = radius_m() + whom.room.radius_m + 0.5 * gap_m;
  return nearest_place(others, [&](const Vec2& place) {
    return distance_to_way(place, *whom.wished_way, reach_m + place_reach_m) >= keep_m;
  });
}

/// Once whom they got up for is past their seat, has sat down or has gone, and so has everybody else who got up and
/// whom they would bar.
bool Pedestrian::can_go_back(const Aside& aside, const Others& others, std::int64_t now) const {
  if (now % ticks(search_every_s) != 0) return false;
  const auto whom = std::ranges::find(others, aside.whom, &Presence::person);
  if (whom != others.end() && whom->posture == Presence::Posture::on_feet &&
      along(*aside.way, whom->position) < along(*aside.way, *got_up_from_) + past_m) {
    return false;
  }
  Presence seated;
  seated.trunk = {*got_up_from_, *got_up_from_, person_->humanoid.trunk_radius_m()};
  return std::ranges::none_of(others, [&](const Presence& other) {
    return other.got_up_from && other.posture == Presence::Posture::on_feet &&
           bars(seated, other.position, *other.got_up_from);
  });
}

/// For who can't squeeze past: if there is a place to wait.
bool Pedestrian::gets_up(const Others& others, std::int64_t now) {
  if (now % ticks(search_every_s) != 0) return false;
  const Presence* first = nullptr;
  for (const Presence& other : others) {
    if (!other.asks_up || std::ranges::find(*other.asks_up, index_) == other.asks_up->end()) continue;
    if (held_up_since_ && Precedence{*held_up_since_, index_} < other.precedence) continue;
    if (first == nullptr || other.precedence < first->precedence) first = &other;
  }
  if (first == nullptr) return false;
  constexpr double whole_way_m = 1e3;
  const auto place = passing_place(*first, others, whole_way_m);
  if (!place) return false;
  aside_ = Aside{*place, first->precedence, first->person, now + ticks(up_most_s), first->wished_way};
  got_up_from_ = motion_.position();
  return true;
}

bool Pedestrian::makes_way_among(const Others& others, const DoorsSeen& doors, std::int64_t now, Sitter sitter) {
  if (aside_) return waits_aside(others, doors, now);
  if (motion_.stage() == Stage::seated) {
    return sitter == Sitter::may_get_up && solidity_ == PersonSolidity::solid && gets_up(others, now);
  }
  return steps_back(others, doors, now) || steps_aside(others, now);
}

bool Pedestrian::waits_aside(const Others& others, const DoorsSeen& doors, std::int64_t now) {
  const bool got_up = aside_->way != nullptr;
  const bool free = aside_->door ? doors.leaves[*aside_->door].distance_to_sweep_m(motion_.position()) >= Doors::hold_m
                    : got_up     ? can_go_back(*aside_, others, now)
                                 : is_past(*aside_, others);
  if (now >= aside_->until || free) {
    aside_.reset();
    forget_way();
    if (motion_.stage() == Stage::walking) motion_.stop();
    return false;
  }
  if (!got_up) ++held_up_ticks_;
  const Vec2 place = aside_->place;
  if (go_to(place, others, now) == Progress::done) blocked_ticks_ = 0;
  return aside_.has_value();
}

/// Whom way was made for doesn't wish to come by here any more, and has walked on.
bool Pedestrian::is_past(const Aside& aside, const Others& others) const {
  const auto whom = std::ranges::find(others, aside.whom, &Presence::person);
  if (whom == others.end()) return true;
  if (whom->wished_way) return false;
  return glm::distance(whom->position, motion_.position()) > 2.0 * (radius_m() + whom->room.radius_m);
}

/// Off the way that somebody on foot wishes to go, if there is a place to wait.
bool Pedestrian::steps_aside(const Others& others, std::int64_t now) {
  if (!on_feet() || solidity_ != PersonSolidity::solid) return false;
  if (motion_.stage() == Stage::turning || now % ticks(search_every_s) != 0) return false;
  const bool walks_freely = motion_.speed_m_s() > 0.0 && !held_up_since_;
  if (walks_freely) return false;
  const Presence* first = nullptr;
  for (const Presence& other : others) {
    if (!other.wished_way || (held_up_since_ && Precedence{*held_up_since_, index_} < other.precedence)) continue;
    if (distance_to_way(motion_.position(), *other.wished_way, wish_reaches_m) >
        radius_m() + other.room.radius_m + gap_m) {
      continue;
    }
    if (first == nullptr || other.precedence < first->precedence) first = &other;
  }
  if (first == nullptr) return false;
  const auto place = passing_place(*first, others, wish_reaches_m);
  if (!place) return false;
  aside_ = Aside{*place, first->precedence, first->person, now + ticks(aside_most_s)};
  if (motion_.stage() == Stage::walking) motion_.stop();
  forget_way();
  return true;
}

/// To wait for the leaf, on the side on which they are; among others who can make way if there is no better one.
std::optional<Vec2> Pedestrian::place_before(const DoorLeaf& leaf, const Others& others) const {
  const auto is_before = [&](const Vec2& place) {
    return leaf.distance_to_sweep_m(place) > Doors::hold_m && leaf.on_one_side(motion_.position(), place);
  };
  const auto place = nearest_place(others, is_before);
  return place ? place : nearest_place({}, is_before);
}

/// Out of what a leaf sweeps that somebody wants to open, maybe themselves. Who walks there is gone in a moment.
bool Pedestrian::steps_back(const Others& others, const DoorsSeen& doors, std::int64_t now) {
  if (!on_feet() || motion_.stage() == Stage::turning || motion_.speed_m_s() > 0.0) return false;
  if (now % ticks(search_every_s) != 0) return false;
  for (std::size_t i = 0; i < doors.leaves.size(); ++i) {
    const DoorLeaf& leaf = doors.leaves[i];
    if (doors.barred[i] == 0 || leaf.distance_to_sweep_m(motion_.position()) >= Doors::clear_m) continue;
    const auto place = place_before(leaf, others);
    if (!place) continue;
    aside_ = Aside{*place, {held_up_since_.value_or(now), index_}, index_, now + ticks(aside_most_s), nullptr, i};
    if (motion_.stage() == Stage::walking) motion_.stop();
    forget_way();
    return true;
  }
  return false;
}

/// While somebody squeezes past, or wants to, a sitter leans forward instead of back.
void Pedestrian::sit_up(const Others& others, std::int64_t now) {
  if (motion_.stage() != Stage::seated) leans_forward_ = false;
  if (motion_.stage() != Stage::seated || now % ticks(search_every_s) != 0) return;
  constexpr double near_m = 1.5,
                   ahead_m = 0.3;  // assumed: at which wishes and people are minded (ahead: tried 0.06, 0.3)
  constexpr double forward_rad = 0.09, lean_s = 0.6;
  const Stadium room = presence().room;
  const bool asked = std::ranges::any_of(others, [&](const Presence& other) {
    if (other.wished_way) return glm::distance(other.position, motion_.position()) < near_m;
    return other.posture == Presence::Posture::on_feet &&
           distance(other.position, room) < other.trunk.radius_m + ahead_m;
  });
  if (asked == leans_forward_ || (asked && motion_.spine_tilt() > forward_rad)) return;
  motion_.adjust(body::Channel::trunk_tilt, asked ? leaning_back_rad : 0.0, lean_s);
  leans_forward_ = asked;
}

}  // namespace pirsim::sim
