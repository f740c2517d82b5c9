#include "model/schema/actions.hpp"

#include <glm/geometric.hpp>

#include "model/schema/fields.hpp"

namespace pirsim {
namespace {

using Course = ActionFacts::Course;
using Needs = ActionFacts::Needs;
using Pose = ActionFacts::Pose;

}  // namespace

ActionFacts facts_of(const action::Wait& wait) noexcept {
  static constexpr auto known = field_of<&action::Wait::activity>().range;
  return {.name = "wait", .lasts_s = wait.duration_s, .activity = wait.activity, .may_be_asked = known};
}

ActionFacts facts_of(const action::Appear& appear) noexcept {
  if (!appear.place.empty()) {
    return {.name = "appear",
            .course = Course::comes,
            .pose = Pose::of_place,
            .place = &appear.place,
            .lying = appear.posture};
  }
  return {.name = "appear",
          .course = Course::comes,
          .pose = Pose::upright,
          .appears_at = &appear.point,
          .heading_deg = appear.heading_deg};
}

ActionFacts facts_of(const action::Enter& enter) noexcept {
  return {.name = "enter", .course = Course::comes, .pose = Pose::upright, .entrance = &enter.entrance};
}

ActionFacts facts_of(const action::Walk& walk) noexcept {
  static constexpr auto known = field_of<&action::Walk::activity>().range;
  return {.name = "walk",
          .course = Course::moves,
          .needs = Needs::presence,
          .pose = Pose::upright,
          .walks_to = walk.points,
          .activity = walk.activity,
          .may_be_asked = known};
}

ActionFacts facts_of(const action::Sit& sit) noexcept {
  return {.name = "sit",
          .course = Course::moves,
          .needs = Needs::presence,
          .pose = Pose::seated,
          .seat = &sit.seat,
          .seat_wait_s = sit.wait_s,
          .if_taken = sit.if_taken};
}

ActionFacts facts_of(const action::Work& work) noexcept {
  static constexpr auto known = field_of<&action::Work::activity>().range;
  return {.name = "work",
          .needs = Needs::seat,
          .lasts_s = work.duration_s,
          .desk_work = &work,
          .activity = work.activity.value_or(Activity::typing),
          .may_be_asked = known};
}

ActionFacts facts_of(const action::Rise&) noexcept {
  return {.name = "rise", .course = Course::moves, .needs = Needs::rest, .pose = Pose::upright};
}

ActionFacts facts_of(const action::Leave& leave) noexcept {
  return {.name = "leave",
          .course = Course::goes,
          .needs = Needs::presence,
          .pose = Pose::upright,
          .entrance = &leave.entrance};
}

ActionFacts facts_of(const action::Turn& turn) noexcept {
  return {.name = "turn",
          .course = Course::moves,
          .needs = Needs::presence,
          .pose = Pose::upright,
          .heading_deg = turn.heading_deg};
}

ActionFacts facts_of(const action::Lie& lie) noexcept {
  return {.name = "lie",
          .course = Course::moves,
          .needs = Needs::presence,
          .pose = Pose::lying,
          .place = &lie.place,
          .lying = lie.posture,
          .seat_wait_s = lie.wait_s};
}

ActionFacts facts_of(const action::Stand& stand) noexcept {
  return {.name = "stand",
          .course = Course::moves,
          .needs = Needs::presence,
          .pose = Pose::upright,
          .place = &stand.place,
          .seat_wait_s = stand.wait_s};
}

ActionFacts facts_of(const action::Follow& follow) noexcept {
  return {.name = "follow", .course = Course::passes, .pose = Pose::upright, .follows = &follow};
}

ActionFacts facts_of(const Action& action) noexcept {
  return std::visit([](const auto& what) { return facts_of(what); }, action);
}

double shortest_s(const ActionFacts& facts, double speed_m_s, Vec2& at) noexcept {
  double way_s = 0.0;
  if (facts.walks()) {
    way_s = glm::distance(at, facts.walks_to.back()) / speed_m_s;
    at = facts.walks_to.back();
  }
  return facts.lasts_s + way_s;
}

bool leads_on(const ScriptedAction& next) noexcept {
  const ActionFacts facts = facts_of(next.what);
  return !next.at_s && (facts.walks() || facts.takes() != nullptr);
}

}  // namespace pirsim
