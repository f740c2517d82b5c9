// One person carrying out their script.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/body/gait.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/natural_motion.hpp"
#include "engine/sim/pedestrian.hpp"
#include "engine/sim/pet.hpp"
#include "engine/sim/schedule.hpp"
#include "model/schema/actions.hpp"
#include "model/schema/words.hpp"
#include "pirsim/random.hpp"

namespace pirsim::sim {

/// A value; all its randomness comes from streams keyed by (seed, run, person).
class Actor {
 public:
  /// plan: actions drawn for this run, or null: those of the script.
  Actor(const CompiledStudy& study, std::uint32_t run, std::uint32_t person, std::shared_ptr<const DayPlan> plan);

  /// Before tick 1, with those in the scene already: who appears at the start has been there all along, unless somebody
  /// stands there.
  void begin(const CompiledStudy& study, const Others& others);
  /// From tick - 1 to tick: starts, goes on with or interrupts actions, then moves the body. others: everyone
  /// else in the scene.
  /// Throws Error(infeasible) if there is no way to where the script leads, even without others.
  void advance(const CompiledStudy& study, std::int64_t tick, const Others& others, const DoorsSeen& doors);

  [[nodiscard]] bool present() const noexcept { return body_.has_value(); }
  [[nodiscard]] bool is_pet() const noexcept { return pet_.has_value(); }
  /// Is it a person over this floor area?
  [[nodiscard]] bool counts_on(const FloorArea& floor) const;
  [[nodiscard]] bool done() const noexcept { return action_ == actions().size(); }
  /// Up to this tick nothing of them changes; not beyond the present one (`tick`) of who is in the scene or about to
  /// be.
  [[nodiscard]] std::int64_t away_until(const CompiledStudy& study, std::int64_t tick) const;
  /// What the step to this tick was part of: the action's label, "outside", "working" or what the body did.
  [[nodiscard]] std::string_view phase() const noexcept { return phase_; }
  [[nodiscard]] const PersonModel& person() const noexcept { return *person_; }
  /// Only while present.
  [[nodiscard]] const body::Motion& motion() const { return body_->motion(); }
  [[nodiscard]] Presence presence() const;
  /// Only while present. before: where they were at the last tick.
  [[nodiscard]] DoorUser door_user(const FloorArea& floor, const Vec2& before) const;
  /// Taken, from setting out for it to walking away from it; or empty.
  [[nodiscard]] std::string_view seat() const noexcept { return seat_; }
  /// Sits or stands in a meeting, in natural style.
  [[nodiscard]] bool takes_part_in_meeting() const { return natural_ && body_ && is_at_meeting(); }
  /// From now on; speaker: where who speaks is.
  void attend(Talk talk, const std::optional<Vec2>& speaker, std::size_t n_others);
  /// What happened in the step to this tick.
  [[nodiscard]] std::span<const Incident> incidents() const noexcept { return incidents_; }

 private:
  // Steps that an action is made of; each begins when the body has settled.
  /// Appears once nobody stands there.
  struct ComeIn {
    Vec2 point;
    double heading;
  };
  enum class Through { in, out };
  /// Waits until nobody goes the other way through the door, a minute at most.
  struct WaitForDoor {
    Vec2 outside;
    Through way;
  };
  /// Waits until nobody else has taken the seat, as long as the script says.
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
  /// From where one has to stand and face before; goes back there first if somebody made them leave it.
  struct SitOn {
    body::SeatPlace place;
    Vec2 stand;
    double heading;
  };
  /// From the edge, as SitOn gets there.
  struct LieOn {
    SitOn edge;
    body::LyingPlace bed;
    LyingPosture posture;
  };
  /// Has been there all along; comes in once nobody has the place or stands before it.
  struct BeThere {
    SitOn before;  ///< of who sits or lies; of who stands, its place isn't used
    std::optional<LieOn> lies{};
    body::Stage stage = body::Stage::standing;
  };
  struct StandUp {};
  /// Walks to the first point, or to the second if somebody stands there.
  struct WalkOut {
    Vec2 outside;
    Vec2 behind_door;
  };
  struct Vanish {};
  /// Is where the path says at every tick.
  struct FollowPath {
    std::shared_ptr<const body::FollowedPath> path;
    std::size_t n_begun = 0;  ///< of its legs
  };
  using Errand = std::variant<ComeIn, WaitForDoor, WaitForSeat, TakeSeat, WalkTo, FaceTo, SitOn, LieOn, BeThere,
                              StandUp, WalkOut, Vanish, FollowPath>;

  /// What surrounds the person at this tick.
  struct Scene {
    const CompiledStudy& study;
    Others others;
    std::int64_t now;
    DoorsSeen doors = {};
  };

  [[nodiscard]] bool is_at_meeting() const;
  [[nodiscard]] std::optional<Activity> activity_at_first() const;
  void start_action(const Scene& scene);
  void plan(const Scene& scene);
  void plan_entering(const EntranceSpec& door);
  void plan_leaving(const EntranceSpec& door);
  void plan_sitting(std::string_view seat);
  void plan_place(const Scene& scene, std::string_view place);
  void plan_being_there(const Scene& scene, std::string_view place);
  /// Scattered, as whoever sits down does each time.
  [[nodiscard]] SitOn way_to_sit(std::string_view seat);
  [[nodiscard]] LieOn way_to_lie(std::string_view place) const;
  void tilt_at_work(std::int64_t now);
  /// What a person of the paper's style is at, at a seat; null: nothing.
  [[nodiscard]] const action::Work* choreographed_work() const;
  void move_naturally();
  void carry_on(const Scene& scene);
  void finish_action();
  void note(IncidentKind kind, std::int64_t tick);
  [[nodiscard]] std::string_view current_phase() const noexcept;
  /// Index of the latest action whose moment has come, if it is later than the current one.
  [[nodiscard]] std::optional<std::size_t> interrupting_action(const Scene& scene) const;
  void note_times(const CompiledStudy& study);
  [[nodiscard]] bool time_is_up(std::int64_t now) const noexcept;
  [[nodiscard]] bool door_is_taken(const WaitForDoor& door, const Others& others) const;
  [[nodiscard]] bool somebody_near(const Vec2& point, const Others& others) const;
  Progress carry_out_first(const Scene& scene);
  void adopt_manner();
  Progress carry_out(const ComeIn& errand, const Scene& scene);
  Progress carry_out(const WaitForDoor& errand, const Scene& scene);
  Progress carry_out(const WaitForSeat& errand, const Scene& scene);
  Progress carry_out(const TakeSeat& errand, const Scene& scene);
  Progress carry_out(const WalkTo& errand, const Scene& scene);
  Progress carry_out(const FaceTo& errand, const Scene& scene);
  Progress carry_out(const SitOn& errand, const Scene& scene);
  Progress carry_out(const LieOn& errand, const Scene& scene);
  Progress carry_out(const BeThere& errand, const Scene& scene);
  Progress carry_out(const StandUp& errand, const Scene& scene);
  /// False until they stand before the seat or the edge, and sit down.
  bool sits_down(const SitOn& seat, const Scene& scene);
  void adopt(LyingPosture posture);
  Progress carry_out(const WalkOut& errand, const Scene& scene);
  Progress carry_out(const Vanish& errand, const Scene& scene);
  Progress carry_out(FollowPath& errand, const Scene& scene);
  void begin_work();
  /// The seat stayed taken: another one, or none.
  void do_without_seat(const Scene& scene);
  [[nodiscard]] const SeatSpec* nearest_free_seat(const Scene& scene) const;
  [[nodiscard]] Vec2 standing_place(const body::SeatPlace& place, const SeatPlan& seat) const;
  [[nodiscard]] const ScriptedAction& action() const { return actions()[action_]; }
  [[nodiscard]] const std::vector<ScriptedAction>& actions() const {
    return plan_ ? (*plan_)[index_] : person().spec.actions;
  }
  [[nodiscard]] body::Motion& body_motion() { return body_->motion(); }

  const PersonModel* person_ = nullptr;
  std::shared_ptr<const DayPlan> plan_;
  std::uint32_t index_ = 0;         ///< of the person in the trial
  std::optional<Pedestrian> body_;  ///< while in the scene
  Attention attention_;
  std::optional<NaturalMotion> natural_;  ///< of who is of that style
  std::optional<Pet> pet_;                ///< moves the body, whatever the script
  std::size_t action_ = 0;                ///< index of the current action
  bool begun_ = false;                    ///< the current action has begun
  ActionFacts facts_;                     ///< of the current action; of none unless it has begun
  std::int64_t began_ = 0;                ///< tick at which it did
  std::int64_t lasts_ticks_ = 0;          ///< of a wait or work; others end when their errands are done
  std::int64_t called_at_ = 0;            ///< tick at which a later action interrupts the current one
  std::int64_t tilt_every_ticks_ = 1;     ///< of work
  std::deque<Errand> errands_;            ///< still to do for the current action
  std::string_view seat_;                 ///< taken, or empty
  std::optional<SitOn> sits_on_;          ///< where they go back to if they get up for somebody
  std::string_view phase_ = phase_outside;
  std::int64_t waited_ticks_ = 0;  ///< for the door, or for room to come in
  std::int64_t seat_wait_ticks_ = 0;
  std::vector<Incident> incidents_;
  Stream tilt_stream_;
  Stream scatter_stream_;
  Restlessness restlessness_;
};

// Who is where: all people of one run, carrying out their scripts among each other.

/// Turns of speech among whoever takes part. A value; draws from a stream of its own.
class Conversation {
 public:
  /// number: which of the conversations of a run.
  Conversation(std::uint64_t seed, std::uint32_t run, std::uint32_t number)
      : stream_({seed, run, number, Purpose::conversation}) {}

  /// Of these people, who speaks at this tick; nobody where fewer than two are. participants: ascending.
  [[nodiscard]] std::optional<std::uint32_t> speaker(std::span<const std::uint32_t> participants, std::int64_t tick,
                                                     int tick_rate_hz);

 private:
  Stream stream_;
  std::optional<std::uint32_t> speaker_;
  std::int64_t until_ = 0;
};

/// A value. Belongs to the study that it was made for, which outlives it.
class Crowd {
 public:
  /// The moment before the first tick.
  Crowd(const CompiledStudy& study, std::uint32_t run);

  /// To this tick (1, 2, ...), from the one before.
  void advance(const CompiledStudy& study, std::int64_t tick);

  [[nodiscard]] const std::vector<Actor>& actors() const noexcept { return actors_; }
  [[nodiscard]] const Doors& doors() const noexcept { return doors_; }
  /// Indices (into the scene's seats) of the seats from which somebody rose in the step to this tick.
  [[nodiscard]] const std::vector<std::size_t>& seats_left() const noexcept { return seats_left_; }
  /// Up to this tick nobody comes, and nothing of anybody changes; the present one (`tick`) if somebody is there.
  [[nodiscard]] std::int64_t away_until(const CompiledStudy& study, std::int64_t tick) const;
  /// What the first person does: the rows' phase.
  [[nodiscard]] std::string_view phase() const noexcept;
  /// Every subject has carried out all actions.
  [[nodiscard]] bool done() const noexcept;

 private:
  void advance_among_others(const CompiledStudy& study, std::int64_t tick);
  void note_seats_left(const CompiledStudy& study);
  void turn_leaves(const CompiledStudy& study, std::int64_t tick);
  void let_speak(const CompiledStudy& study, std::int64_t tick);

  std::vector<Actor> actors_;
  std::vector<Presence> in_scene_;    ///< as they are now, in the order of the script; empty where there is one actor
  std::vector<std::uint8_t> seated_;  ///< (n_actors) 1 while seated
  std::vector<std::size_t> seats_left_;
  std::vector<Conversation> conversations_;  ///< one of each area, one in a scene without areas
  Doors doors_;
  std::vector<std::optional<Vec2>> places_;  ///< (n_actors) at the last tick, in scenes with doors
  std::vector<std::uint32_t> participants_;  ///< scratch
  std::vector<std::uint32_t> together_;      ///< scratch
  std::vector<DoorUser> door_users_;         ///< scratch
};

}  // namespace pirsim::sim
