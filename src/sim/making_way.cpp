// How a pedestrian makes way for others: on foot by stepping aside, on a chair by leaning forward or getting up.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "body/footprint.hpp"
#include "sim/pedestrian.hpp"

namespace pirsim::sim {
namespace {

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
