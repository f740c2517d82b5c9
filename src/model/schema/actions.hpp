// What an action is, for everybody who asks: who carries it out, rehearses it, checks it or draws it for a bystander.
// A new kind of action is described by one overload of facts_of(). Its text is read and written in io, and the actor
// carries out what the facts say.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "pirsim/script.hpp"

namespace pirsim {

/// Points into the action that it describes.
struct ActionFacts {
  enum class Course { comes, stays, moves, goes, passes };  ///< what becomes of somebody's being in the room
  enum class Needs { nothing, presence, seat, rest };  ///< what has to be the case when it begins; rest: off the feet
  /// How somebody is when it is done; of_place: as the place's posture says.
  enum class Pose { kept, upright, seated, lying, of_place };

  std::string_view name{};  ///< as scripts have it
  Course course = Course::stays;
  Needs needs = Needs::nothing;
  Pose pose = Pose::kept;

  // Where it leads, in the order of getting there; none: to no such thing.
  const Vec2* appears_at = nullptr;
  const std::string* entrance = nullptr;
  std::span<const Vec2> walks_to{};
  const std::string* seat = nullptr;
  const std::string* place = nullptr;  ///< to lie or to stand; of who is there at once, to sit as well
  LyingPosture lying = LyingPosture::back;
  std::optional<double> heading_deg{};

  const action::Follow* follows = nullptr;  ///< there and back out of the scene, by points and times

  double seat_wait_s = 0.0;  ///< for a seat or a place that is taken
  action::IfTaken if_taken = action::IfTaken::next_action;

  double lasts_s = 0.0;                      ///< of what time ends; the way there isn't in it
  const action::Work* desk_work = nullptr;   ///< how the paper's style works
  std::optional<Activity> activity{};        ///< what natural style is busy with
  std::span<const Activity> may_be_asked{};  ///< activities that a script may ask for

  [[nodiscard]] bool walks() const noexcept { return !walks_to.empty(); }
  /// The seat or the place that it takes, or null.
  [[nodiscard]] const std::string* takes() const noexcept { return seat != nullptr ? seat : place; }
};

[[nodiscard]] ActionFacts facts_of(const action::Wait& wait) noexcept;
[[nodiscard]] ActionFacts facts_of(const action::Appear& appear) noexcept;
[[nodiscard]] ActionFacts facts_of(const action::Enter& enter) noexcept;
[[nodiscard]] ActionFacts facts_of(const action::Walk& walk) noexcept;
[[nodiscard]] ActionFacts facts_of(const action::Sit& sit) noexcept;
[[nodiscard]] ActionFacts facts_of(const action::Work& work) noexcept;
[[nodiscard]] ActionFacts facts_of(const action::Rise& rise) noexcept;
[[nodiscard]] ActionFacts facts_of(const action::Leave& leave) noexcept;
[[nodiscard]] ActionFacts facts_of(const action::Turn& turn) noexcept;
[[nodiscard]] ActionFacts facts_of(const action::Follow& follow) noexcept;
[[nodiscard]] ActionFacts facts_of(const action::Lie& lie) noexcept;
[[nodiscard]] ActionFacts facts_of(const action::Stand& stand) noexcept;
[[nodiscard]] ActionFacts facts_of(const Action& action) noexcept;

/// How long it takes at least: what time ends, and ways as the crow flies. at: moves on to where it leads.
[[nodiscard]] double shortest_s(const ActionFacts& facts, double speed_m_s, Vec2& at) noexcept;

/// Does one who comes in go on at once to where this action leads?
[[nodiscard]] bool leads_on(const ScriptedAction& next) noexcept;

/// The first action of a kind that anybody in the trial carries out, or null.
template <typename What>
[[nodiscard]] const What* first(const TrialSpec& trial) noexcept {
  for (const PersonSpec& person : trial.people) {
    for (const ScriptedAction& action : person.actions) {
      if (const auto* what = std::get_if<What>(&action.what)) return what;
    }
  }
  return nullptr;
}

/// Calls change(What&) for all actions of a kind.
template <typename What, typename Change>
void for_each(PersonSpec& person, const Change& change) {
  for (ScriptedAction& action : person.actions) {
    if (auto* what = std::get_if<What>(&action.what)) change(*what);
  }
}

/// Calls point(Vec2&) and heading_deg(double&) for all places and directions on the floor that an action names.
template <typename Point, typename Heading>
void for_each_place(Action& action, const Point& point, const Heading& heading_deg) {
  const auto change = [&](auto& what) {
    if constexpr (requires { what.point; }) point(what.point);
    if constexpr (requires { what.points; }) {
      for (Vec2& place : what.points) point(place);
    }
    if constexpr (requires { what.heading_deg; }) heading_deg(what.heading_deg);
  };
  std::visit(change, action);
}

}  // namespace pirsim
