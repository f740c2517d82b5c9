// One person carrying out their script.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "body/motion.hpp"
#include "pirsim/random.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::sim {

/// What others need to know to keep out of a person's way.
struct Presence {
  Vec2 position{0.0};
  Vec2 velocity{0.0};     ///< m/s
  Vec2 destination{0.0};  ///< where the current walk leads; the position of who isn't walking
  std::string_view seat;  ///< taken: from setting out for it to walking away from it; or empty
  enum class Script { going_on, carried_out } script = Script::going_on;
  double radius_m = 0.0;
};

/// A value; all its randomness comes from streams keyed by (seed, run, person).
class Actor {
 public:
  Actor(const CompiledStudy& study, std::uint32_t run, std::uint32_t person);

  /// From tick - 1 to tick: starts, goes on with or interrupts actions, then moves the body. others: everyone else in
  /// the scene, in the order of the script; those before this person go first where ways cross.
  /// Throws Error(infeasible) when people block each other for good.
  void advance(const CompiledStudy& study, std::int64_t tick, std::span<const Presence> others, std::size_t n_before);

  [[nodiscard]] bool present() const noexcept { return motion_.has_value(); }
  [[nodiscard]] bool done() const noexcept { return action_ == person().spec.actions.size(); }
  /// What the step to this tick was part of: the action's label, "outside", "working" or what the body did.
  [[nodiscard]] std::string_view phase() const noexcept { return phase_; }
  [[nodiscard]] const PersonModel& person() const noexcept { return *person_; }
  /// Only while present.
  [[nodiscard]] const body::Motion& motion() const { return *motion_; }
  [[nodiscard]] Presence presence() const;
  /// Taken, from setting out for it to walking away from it; or empty.
  [[nodiscard]] std::string_view seat() const noexcept { return seat_; }

 private:
  // Steps that an action is made of; each begins when the body has settled.
  /// Appears once nobody stands there.
  struct ComeIn {
    Vec2 point;
    double heading;
  };
  enum class Through { in, out };
  /// Waits until nobody goes the other way through the door.
  struct WaitForDoor {
    Vec2 outside;
    Through way;
  };
  /// Waits until nobody else has taken the seat.
  struct WaitForSeat {
    std::string_view seat;
  };
  struct TakeSeat {
    std::string_view seat;
  };
  struct WalkTo {
    Vec2 target;
  };
  struct FaceTo {
    double heading;
  };
  struct SitOn {
    body::SeatPlace place;
  };
  struct StandUp {};
  /// Walks to the first point, or to the second if somebody stands there.
  struct WalkOut {
    Vec2 outside;
    Vec2 behind_door;
  };
  struct Vanish {};
  using Errand =
      std::variant<ComeIn, WaitForDoor, WaitForSeat, TakeSeat, WalkTo, FaceTo, SitOn, StandUp, WalkOut, Vanish>;
  enum class Progress { going_on, done };

  void plan(const CompiledStudy& study);
  void plan_entering(const EntranceSpec& door);
  void plan_leaving(const EntranceSpec& door);
  void plan_sitting();
  void work(const action::Work& work, std::int64_t now);
  void fidget(const CompiledStudy& study);
  void carry_on(const CompiledStudy& study, std::int64_t now, std::span<const Presence> others);
  void finish_action();
  [[nodiscard]] std::string_view current_phase() const noexcept;
  /// Index of the latest action whose moment has come, if it is later than the current one.
  [[nodiscard]] std::optional<std::size_t> interrupting_action(const CompiledStudy& study, std::int64_t now) const;
  void note_durations(const CompiledStudy& study);
  [[nodiscard]] bool time_is_up(std::int64_t now) const noexcept;
  [[nodiscard]] bool door_is_taken(const WaitForDoor& door, std::span<const Presence> others) const;
  [[nodiscard]] bool somebody_near(const Vec2& point, std::span<const Presence> others) const;
  [[nodiscard]] bool free_to_stand(std::span<const Presence> others) const;
  Progress carry_out_first(const CompiledStudy& study, std::span<const Presence> others);
  Progress carry_out(const ComeIn& errand, const CompiledStudy& study, std::span<const Presence> others);
  Progress carry_out(const WaitForDoor& errand, const CompiledStudy& study, std::span<const Presence> others);
  Progress carry_out(const WaitForSeat& errand, const CompiledStudy& study, std::span<const Presence> others);
  Progress carry_out(const TakeSeat& errand, const CompiledStudy& study, std::span<const Presence> others);
  Progress carry_out(const WalkTo& errand, const CompiledStudy& study, std::span<const Presence> others);
  Progress carry_out(const FaceTo& errand, const CompiledStudy& study, std::span<const Presence> others);
  Progress carry_out(const SitOn& errand, const CompiledStudy& study, std::span<const Presence> others);
  Progress carry_out(const StandUp& errand, const CompiledStudy& study, std::span<const Presence> others);
  Progress carry_out(const WalkOut& errand, const CompiledStudy& study, std::span<const Presence> others);
  Progress carry_out(const Vanish& errand, const CompiledStudy& study, std::span<const Presence> others);
  Progress wait_for_turn(const CompiledStudy& study, std::span<const Presence> others);
  Progress walk_to(const Vec2& target, const CompiledStudy& study, std::span<const Presence> others);
  Progress become_standing(const CompiledStudy& study, std::span<const Presence> others);
  void keep_distance(const CompiledStudy& study, std::span<const Presence> others, std::size_t n_before);
  [[nodiscard]] double free_way_ahead(std::span<const Presence> others) const;
  [[nodiscard]] bool must_give_way(std::span<const Presence> others) const;
  void wait_for_others(const CompiledStudy& study);
  void be_held_up(const CompiledStudy& study);
  [[noreturn]] void give_up_waiting() const;
  [[noreturn]] void give_up(const std::string& why) const;
  [[nodiscard]] Vec2 standing_place(const body::SeatPlace& place, const SeatPlan& seat) const;
  [[nodiscard]] const ScriptedAction& action() const { return person().spec.actions[action_]; }

  const PersonModel* person_ = nullptr;
  std::uint32_t index_ = 0;  ///< of the person in the trial
  std::optional<body::Motion> motion_;
  std::size_t action_ = 0;             ///< index of the current action
  bool begun_ = false;                 ///< the current action has begun
  std::int64_t began_ = 0;             ///< tick at which it did
  std::int64_t lasts_ticks_ = 0;       ///< of a wait or work; others end when their errands are done
  std::int64_t tilt_every_ticks_ = 1;  ///< of work
  std::deque<Errand> errands_;         ///< still to do for the current action
  std::optional<body::Route> route_;   ///< to walk once the body faces its start, or being walked
  std::string_view seat_;              ///< taken, or empty
  std::string_view phase_ = "outside";
  int blocked_ticks_ = 0;  ///< for how long others have been in the way
  int held_up_ticks_ = 0;  ///< the same in all since the current errand was set out on
  Stream tilt_stream_;
  Stream scatter_stream_;
  Stream fidget_stream_;
};

}  // namespace pirsim::sim
