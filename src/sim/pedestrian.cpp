#include "sim/pedestrian.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <iomanip>
#include <sstream>
#include <string>

#include "body/footprint.hpp"
#include "pirsim/error.hpp"

namespace pirsim::sim {
namespace {

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

std::string text(const Vec2& place) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(2) << '(' << place.x << ", " << place.y << ") m";
  return out.str();
}

}  // namespace

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

}  // namespace pirsim::sim
