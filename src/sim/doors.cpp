#include "sim/doors.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace pirsim::sim {
namespace {

constexpr double sitting_m = 0.25;  ///< assumed: the same from pelvis and knees (0.2-0.3)
constexpr double walking_m =
    0.95;  ///< assumed: who walks needs a way to stop before a leaf that begins to turn (0.8-1.2)
constexpr double leaf_patience_s = 20.0;  ///< then a leaf opens past whoever stands there, as walkers pass each other

bool leads_by(const DoorLeaf& leaf, const DoorUser& user) {
  return user.gait == DoorUser::Gait::led && leaf.distance_to_sweep_m(user.now) < walking_m;
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

}  // namespace pirsim::sim
