#include "engine/sim/pet.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "model/schema/clock.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::sim {
namespace {

/// All assumed; docs/physics/pets.md has the ranges.
struct PetLife {
  double bouts_a_day;  ///< of roaming, if nights were days
  int ways_a_bout;     ///< in the mean
  double pause_s;      ///< mean, between two ways
  double pace_m_s;
  double by_night;  ///< bouts by night over those by day
};
constexpr PetLife life_of(PetKind kind) {
  return kind == PetKind::cat ? PetLife{24.0, 4, 12.0, 0.6, 0.5} : PetLife{24.0, 6, 20.0, 0.9, 0.1};
}

constexpr double night_begins_h = 23.0, night_ends_h = 6.0;
constexpr double perch_share = 0.6;  // of bouts that end on furniture, if there is any
constexpr double lies_down_s = 1.2, leg_s = 0.3, jump_s = 0.5, hop_m = 0.15, turn_rad_s = 4.0;
constexpr double stride = 1.8;     // over the height of the trunk's middle
constexpr double shies_m = 0.3;    // before a leaf that isn't open
constexpr double corner_m = 0.15;  // radius of bends
constexpr double lands_s = 1.0;    // after a jump, before it does anything else

double approached(double value, double goal, double step) {
  return goal > value ? std::min(goal, value + step) : std::max(goal, value - step);
}

bool is_shut_between(const Vec2& a, const Vec2& b, const DoorsSeen& doors) {
  for (std::size_t i = 0; i < doors.leaves.size(); ++i) {
    if (doors.steps[i] != doors.leaves[i].open_step() && doors.leaves[i].leads_through(a, b)) return true;
  }
  return false;
}

bool is_taken(const Perch& perch, const Others& people) {
  return std::ranges::find(people, perch.id, &Presence::seat) != people.end();
}

/// The nearest place on the floor from which it jumps.
std::optional<Vec2> place_before(const Vec2& perch, const Vec2& home, const body::WalkableFloor& floor) {
  constexpr double nearest_m = 0.2, farthest_m = 0.9, step_m = 0.1;  // assumed (0.7-1.2)
  constexpr int n_directions = 16;
  for (double away_m = nearest_m; away_m <= farthest_m; away_m += step_m) {
    for (int k = 0; k < n_directions; ++k) {
      const Vec2 place = perch + away_m * direction_of(2.0 * pi * k / n_directions);
      if (floor.walkable(place) && floor.has_way(home, place)) return place;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Haunts> haunts_of(const PetSpec& pet, const SceneSpec& scene, const body::WalkableFloor& floor) {
  constexpr double spacing_m = 0.25, highest_m = 1.3, pelvis_m = 0.09;
  std::optional<Vec2> anywhere, inside;
  const Vec2 lower = scene.floor.lower(), upper = scene.floor.upper();
  for (double z = lower.y + 0.5 * spacing_m; z < upper.y && !inside; z += spacing_m) {
    for (double x = lower.x + 0.5 * spacing_m; x < upper.x && !inside; x += spacing_m) {
      const Vec2 place(x, z);
      if (!scene.floor.contains(place) || !floor.walkable(place)) continue;
      if (!anywhere) anywhere = place;
      const auto leads_here = [&](const EntranceSpec& door) { return floor.has_way(outside_of(door), place); };
      if (std::ranges::any_of(scene.entrances, leads_here)) inside = place;
    }
  }
  if (!anywhere) return std::nullopt;
  Haunts haunts{inside.value_or(*anywhere), {}};
  const auto add = [&](const std::string& id, const std::vector<std::string>& uses, const Vec3& top) {
    const bool is_for_pets = std::ranges::find(uses, "pet") != uses.end();
    if (!is_for_pets && (pet.kind == PetKind::dog || top.y > scene.floor.height_m() + highest_m)) return;
    if (const auto before = place_before(floor_point(top), haunts.home, floor))
      haunts.perches.push_back({id, *before, top});
  };
  for (const SeatSpec& seat : scene.seats) add(seat.id, seat.uses, seat.world_from_seat.origin - Vec3(0, pelvis_m, 0));
  for (const PlaceSpec& place : scene.places) {
    if (place.posture == PlacePosture::lie) add(place.id, place.uses, place.world_from_place.origin);
  }
  return haunts;
}

Pet::Pet(const CompiledStudy& study, std::uint32_t run, std::uint32_t person)
    : me_(&study.trial_of(run).people[person]),
      run_(run),
      stream_({study.seed(), run, person, Purpose::pet}),
      height_m_(study.scene().floor.height_m()) {
  at_ = {drawn_place(study).value_or(me_->haunts.home), 2.0 * pi * stream_.uniform()};
  until_ = drawn_rest_ends(study, 0);
}

double Pet::drawn_around(double mean) noexcept { return -mean * std::log(1.0 - stream_.uniform()); }

/// Bouts come as a Poisson process; of those by night some are left out.
std::int64_t Pet::drawn_rest_ends(const CompiledStudy& study, std::int64_t now) {
  constexpr double day_s = 86400.0, hour_s = 3600.0;
  const PetLife life = life_of(me_->spec.pet->kind);
  const std::optional<RunClock> clock = study.clock_of(run_);
  double time_s = static_cast<double>(now) * study.tick_s();
  bool is_left_out = true;
  while (is_left_out) {
    time_s += drawn_around(day_s / life.bouts_a_day);
    const double hour = std::fmod((clock ? clock->begin_second() : 0.5 * day_s) + time_s, day_s) / hour_s;
    const bool is_night = clock && (hour >= night_begins_h || hour < night_ends_h);
    is_left_out = is_night && stream_.uniform() >= life.by_night;
  }
  return std::llround(time_s / study.tick_s());
}

/// Anywhere on its part of the floor.
std::optional<Vec2> Pet::drawn_place(const CompiledStudy& study) {
  constexpr int most_tries = 100;
  const FloorArea& floor = study.scene().floor;
  for (int i = 0; i < most_tries; ++i) {
    const double x = stream_.uniform(), z = stream_.uniform();
    const Vec2 place = floor.lower() + Vec2(x, z) * (floor.upper() - floor.lower());
    if (floor.contains(place) && me_->floor->walkable(place) && me_->floor->has_way(me_->haunts.home, place))
      return place;
  }
  return std::nullopt;
}

void Pet::stand_until(std::int64_t tick) noexcept {
  doing_ = Doing::stands;
  until_ = tick;
}

void Pet::lie_down(const CompiledStudy& study, std::int64_t now) {
  doing_ = Doing::lies;
  until_ = drawn_rest_ends(study, now);
}

bool Pet::go_to(const Vec2& place, const DoorsSeen& doors) {
  const auto way = me_->floor->find_way(at_.position, place);
  if (!way) return false;
  for (std::size_t i = 1; i < way->size(); ++i) {
    if (is_shut_between((*way)[i - 1], (*way)[i], doors)) return false;
  }
  route_ = body::Route(*way, corner_m);
  walked_m_ = 0.0;
  doing_ = Doing::walks;
  return true;
}

/// On the next way of this bout; lies down again where all doors are shut.
void Pet::set_out(const CompiledStudy& study, std::int64_t now, const Others& people, const DoorsSeen& doors) {
  constexpr int most_tries = 8;
  ways_left_ = std::max(0, ways_left_ - 1);
  const std::vector<Perch>& perches = me_->haunts.perches;
  if (ways_left_ == 0 && !perches.empty() && stream_.uniform() < perch_share) {
    const Perch& perch = perches[stream_.index(static_cast<std::uint32_t>(perches.size()))];
    if (!is_taken(perch, people) && go_to(perch.before, doors)) {
      perch_ = &perch;
      return;
    }
  }
  for (int i = 0; i < most_tries; ++i) {
    const auto place = drawn_place(study);
    if (place && go_to(*place, doors)) return;
  }
  lie_down(study, now);
}

void Pet::jump(const Vec3& to) noexcept {
  doing_ = Doing::jumps;
  from_ = {at_.position.x, height_m_, at_.position.y};
  to_ = to;
  share_ = 0.0;
}

void Pet::turn_to(double heading, double tick_s) noexcept {
  const double off = std::remainder(heading - at_.heading, 2.0 * pi);
  at_.heading += std::clamp(off, -turn_rad_s * tick_s, turn_rad_s * tick_s);
}

void Pet::walk(const CompiledStudy& study, std::int64_t now, const Others& people, const DoorsSeen& doors) {
  constexpr double ahead_rad = 0.8;  // else it turns on the spot
  const PetLife life = life_of(me_->spec.pet->kind);
  const auto after = [&](double seconds) { return now + std::llround(seconds / study.tick_s()); };
  if (is_shut_between(at_.position, route_.position(walked_m_ + shies_m), doors)) {
    perch_ = nullptr;
    return stand_until(after(drawn_around(life.pause_s)));
  }
  const double wanted = route_.heading(walked_m_);
  turn_to(wanted, study.tick_s());
  if (std::abs(std::remainder(wanted - at_.heading, 2.0 * pi)) > ahead_rad) return;
  walked_m_ += life.pace_m_s * study.tick_s();
  strided_m_ += life.pace_m_s * study.tick_s();
  at_.position = route_.position(walked_m_);
  if (walked_m_ < route_.length_m()) return;
  if (perch_ != nullptr && !is_taken(*perch_, people)) return jump(perch_->top);
  perch_ = nullptr;
  if (ways_left_ == 0) return lie_down(study, now);
  stand_until(after(drawn_around(life.pause_s)));
}

void Pet::fly(const CompiledStudy& study, std::int64_t now) {
  share_ = std::min(1.0, share_ + study.tick_s() / jump_s);
  const Vec3 here = from_ + share_ * (to_ - from_);
  at_.position = floor_point(here);
  height_m_ = here.y + 4.0 * hop_m * share_ * (1.0 - share_);
  turn_to(heading_of(floor_point(to_ - from_)), study.tick_s());
  if (share_ < 1.0) return;
  is_up_ = !is_up_;
  if (is_up_) return lie_down(study, now);
  perch_ = nullptr;
  stand_until(now + std::llround(lands_s / study.tick_s()));
}

void Pet::advance(const CompiledStudy& study, std::int64_t now, const Others& people, const DoorsSeen& doors) {
  lies_ = approached(lies_, doing_ == Doing::lies ? 1.0 : 0.0, study.tick_s() / lies_down_s);
  swing_ = approached(swing_, doing_ == Doing::walks ? 1.0 : 0.0, study.tick_s() / leg_s);
  switch (doing_) {
    case Doing::lies:
      if (now < until_ && !(is_up_ && is_taken(*perch_, people))) return;
      ways_left_ = 1 + static_cast<int>(
                           stream_.index(static_cast<std::uint32_t>(2 * life_of(me_->spec.pet->kind).ways_a_bout - 1)));
      return stand_until(now);
    case Doing::stands:
      if (lies_ > 0.0 || now < until_) return;
      if (is_up_) return jump({perch_->before.x, study.scene().floor.height_m(), perch_->before.y});
      return set_out(study, now, people, doors);
    case Doing::walks:
      return walk(study, now, people, doors);
    case Doing::jumps:
      return fly(study, now);
  }
}

body::Outline Pet::outline() const noexcept {
  const double stride_m = stride * me_->humanoid.animal()->axis_height_m;
  const double swung_m = 0.25 * stride_m * swing_ * std::sin(2.0 * pi * strided_m_ / stride_m);
  body::Outline outline;
  outline.pelvis = at_;
  outline.floor_height_m = height_m_;
  outline.fall = lies_;
  outline.hand_ahead_m = {swung_m, -swung_m};
  return outline;
}

}  // namespace pirsim::sim
