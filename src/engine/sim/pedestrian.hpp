// What people know of each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/body/gait.hpp"
#include "engine/body/ground.hpp"
#include "engine/body/motion.hpp"
#include "engine/sim/compiled_study.hpp"
#include "model/schema/door_leaf.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/random.hpp"
#include "pirsim/sample.hpp"

namespace pirsim::sim {

/// Who goes first where two people are in each other's way: who has been held up since earlier, then who comes first
/// in the script. Ref: priority inheritance as in [Okumura2022].
struct Precedence {
  std::int64_t held_up_since = 0;  ///< tick
  std::uint32_t person = 0;
  auto operator<=>(const Precedence&) const = default;  ///< the lesser goes first
};

/// What a body takes up of the floor: everything within radius_m of the segment ab.
struct Stadium {
  Vec2 a{0.0}, b{0.0};
  double radius_m = 0.0;
};

/// Negative inside.
[[nodiscard]] double distance(const Vec2& point, const Stadium& stadium);
/// Discs that cover it, `more_m` larger, but for a centimetre between them.
void append_discs(const Stadium& stadium, double more_m, std::vector<body::Disc>& discs);

/// What others need to know to keep out of a person's way.
struct Presence {
  std::uint32_t person = 0;  ///< index in the trial
  Vec2 position{0.0};
  Vec2 velocity{0.0};     ///< m/s
  Vec2 destination{0.0};  ///< where the current walk leads; the position of who isn't walking
  std::string_view seat;  ///< taken: from setting out for it to walking away from it; or empty
  enum class Script { going_on, carried_out } script = Script::going_on;
  enum class Posture { on_feet, on_chair } posture = Posture::on_feet;  ///< on_chair: also on the way onto it or off it
  enum class Solidity { solid, passing_through } solidity = Solidity::solid;
  /// What others keep clear of: with arms and, of a sitter, leaning back; all the way between sitting and standing.
  Stadium room;
  Stadium trunk;       ///< instead of room, of who squeezes past: the trunk as it is now
  double gap_m = 0.0;  ///< what others keep beside `room` where they plan their way
  /// Of somebody who is held up: the way that they would go if nobody were there; others leave it if they can.
  std::shared_ptr<const std::vector<Vec2>> wished_way;
  Precedence precedence;  ///< of that wish
  /// Sitters who block the way even for somebody who squeezes past: this person asks them to get up.
  std::shared_ptr<const std::vector<std::uint32_t>> asks_up;
  // A sitter who got up for somebody goes back to the place where they sat, once that person has passed.
  std::optional<Vec2> got_up_from;
  std::optional<std::uint32_t> got_up_for;
};

[[nodiscard]] inline bool is_solid(const Presence& other) noexcept {
  return other.solidity == Presence::Solidity::solid;
}

/// Everybody in the scene but one, in the order of the script: a view.
class Others {
 public:
  class Iterator {
   public:
    using value_type = Presence;
    using difference_type = std::ptrdiff_t;
    Iterator() = default;
    Iterator(const Presence* at, const Presence* me) : at_(at), me_(me) {}
    const Presence& operator*() const noexcept { return *at_; }
    const Presence* operator->() const noexcept { return at_; }
    Iterator& operator++() noexcept {
      if (++at_ == me_) ++at_;
      return *this;
    }
    Iterator operator++(int) noexcept {
      const Iterator before = *this;
      ++*this;
      return before;
    }
    bool operator==(const Iterator& other) const noexcept { return at_ == other.at_; }

   private:
    const Presence* at_ = nullptr;
    const Presence* me_ = nullptr;  ///< is passed over, if not null
  };

  enum class Me { among_them, not_there };
  Others() = default;
  /// in_scene: outlives the view; n_before: how many of them come before me in the script.
  Others(std::span<const Presence> in_scene, std::size_t n_before, Me me)
      : in_scene_(in_scene), n_before_(n_before), me_(me == Me::among_them ? &in_scene[n_before] : nullptr) {}

  [[nodiscard]] Iterator begin() const noexcept {
    return {in_scene_.data() + (me_ != nullptr && n_before_ == 0 ? 1 : 0), me_};
  }
  [[nodiscard]] Iterator end() const noexcept { return {in_scene_.data() + in_scene_.size(), nullptr}; }
  [[nodiscard]] bool empty() const noexcept { return begin() == end(); }
  /// Those who go first where ways cross.
  [[nodiscard]] std::span<const Presence> before_me() const noexcept { return in_scene_.first(n_before_); }

 private:
  std::span<const Presence> in_scene_;
  std::size_t n_before_ = 0;
  const Presence* me_ = nullptr;
};

/// See RunIncident.
struct Incident {
  IncidentKind kind = IncidentKind::passed_through;
  std::int64_t tick = 0;
  std::uint32_t person = 0;
  Vec2 place{0.0};
};

// The doors of one run: which leaves stand open, who opens them, and when they are shut again.

/// What walkers see of doors.
struct DoorsSeen {
  std::span<const DoorLeaf> leaves;      ///< (n_doors)
  std::span<const LeafStep> steps;       ///< (n_doors)
  std::span<const std::uint8_t> barred;  ///< (n_doors) 1: would open but for somebody in its way
};

/// What doors know of somebody.
struct DoorUser {
  Vec2 before{0.0}, now{0.0};                                  ///< at the last tick and at this one
  Vec2 knees{0.0};                                             ///< of who sits; `now` of others
  enum class Gait { stands, walks, led } gait = Gait::stands;  ///< led: along a way that is given, through anything
  std::optional<std::size_t> wants;                            ///< door that they wait for, or go through next
  enum class Place { floor, doorway } place = Place::floor;    ///< of who wants one
};

/// A value. A leaf turns while nobody is in its way, so it pushes nobody; who wants to go through waits before what it
/// sweeps until it is open, and whoever stands in its way steps back.
class Doors {
 public:
  static constexpr double hold_m =
      0.6;  ///< assumed: kept from what a leaf sweeps by who waits: an arm that swings (0.5-0.7)

  static constexpr double clear_m =
      0.38;  ///< assumed: kept between a leaf that turns and who stands, less than who waits keeps (0.3-0.45)

  /// As they stand before a run.
  Doors(const CompiledStudy& study, std::uint32_t run);

  /// To this tick, after everybody has moved to it.
  void advance(const CompiledStudy& study, std::int64_t tick, std::span<const DoorUser> users);

  [[nodiscard]] std::span<const LeafStep> steps() const noexcept { return steps_; }
  [[nodiscard]] DoorsSeen seen(const CompiledStudy& study) const noexcept {
    return {study.array().leaves(), steps_, barred_};
  }
  /// Up to this tick nothing changes if nobody comes.
  [[nodiscard]] std::int64_t still_until(const CompiledStudy& study, std::int64_t tick) const noexcept;

 private:
  enum class Goal { open, shut };
  struct Door {
    Goal goal = Goal::shut;
    bool shut_behind = false;     ///< as soon as nobody is in the way
    std::int64_t open_until = 0;  ///< tick at which it is shut otherwise
    std::optional<std::int64_t> wanted_since = {};
    Stream habit;
  };
  void advance_one(const CompiledStudy& study, std::size_t door, std::int64_t tick, std::span<const DoorUser> users);
  void note_pass(const CompiledStudy& study, std::size_t door, std::int64_t tick);
  [[nodiscard]] bool is_clear(const DoorLeaf& leaf, std::size_t door, std::span<const DoorUser> users) const;

  std::vector<LeafStep> steps_;       ///< (n_doors)
  std::vector<std::uint8_t> barred_;  ///< (n_doors) see DoorsSeen
  std::vector<Door> doors_;           ///< (n_doors)
};

// A body among other bodies: finds its way, keeps its distance, makes way, and is never stuck for good.

enum class Progress { going_on, done };

/// One person on their feet or on a seat. A value: copies are independent. Its commands are repeated every tick until
/// they are done, and advance() ends the tick.
///
/// People make way for each other. Somebody who has been held up for a second tells the others which way they wish to
/// go. Another person who stands on that way steps aside, to the nearest place off it, unless they have been held up
/// for longer themselves. That person then has the precedence of the one for whom they make way. A sitter leans forward
/// for somebody who squeezes past, and gets up for somebody who can't squeeze past. Somebody who is still held up after
/// 20 s (longer while a sitter gets up for them) walks through the others, which is an incident.
class Pedestrian {
 public:
  Pedestrian(const CompiledStudy& study, const PersonModel& person, std::uint32_t index, const Vec2& point,
             double heading);

  /// What others see. destination and velocity are those of the walk.
  [[nodiscard]] Presence presence() const;
  [[nodiscard]] const body::Motion& motion() const noexcept { return motion_; }
  [[nodiscard]] body::Motion& motion() noexcept { return motion_; }
  /// Of the walk that is under way, if there is one.
  [[nodiscard]] std::optional<Vec2> target() const { return route_ ? target_ : std::nullopt; }

  /// Of whoever sits: has their script something left to do, so that they would come back to their seat?
  enum class Sitter { stays, may_get_up };
  /// Makes way for others if need be; true while that is what the body does, so that commands have to wait.
  bool makes_way(const Others& others, const DoorsSeen& doors, std::int64_t now, Sitter sitter) {
    return (aside_ || !others.empty() || !doors.leaves.empty()) && makes_way_among(others, doors, now, sitter);
  }
  [[nodiscard]] bool on_feet() const noexcept;
  /// For somebody, and hasn't sat down again.
  [[nodiscard]] bool got_up() const noexcept { return got_up_from_ && motion_.stage() != body::Stage::seated; }
  /// Rises if need be, then walks. Throws Error(infeasible) if there is no way even without others.
  Progress go_to(const Vec2& target, const Others& others, std::int64_t now);
  /// From a seat as soon as the way back is free; stops a walk that isn't one of go_to().
  Progress stand_up(const Others& others, std::int64_t now);
  /// From where one stands before the seat, as soon as there is room to draw the chair back.
  void sit_down(const body::SeatPlace& seat, const Others& others, std::int64_t now);
  void forget_way() noexcept;
  /// From now on through others, until clear of them: an incident.
  void pass_through(std::int64_t now);
  /// Others have been in the way for a second or longer.
  [[nodiscard]] bool is_held_up(std::int64_t now) const noexcept;
  /// A new errand: what held up the one before doesn't count any more.
  void set_out() noexcept {
    held_up_ticks_ = blocked_ticks_ = 0;
    held_up_since_.reset();
    wished_way_.reset();
  }

  void advance(const Others& others, const DoorsSeen& doors, std::int64_t now);
  /// The door before which they wait, or through which they go next.
  [[nodiscard]] std::optional<std::size_t> wanted_door() const noexcept { return wanted_door_; }

  /// Begun since the last call.
  [[nodiscard]] std::optional<Incident> take_incident() noexcept;

 private:
  using Way = std::vector<Vec2>;
  bool makes_way_among(const Others& others, const DoorsSeen& doors, std::int64_t now, Sitter sitter);

  static constexpr double gap_m = 0.1;              ///< assumed: kept between two people on foot beside their radii
  static constexpr double squeeze_gap_m = 0.03;     ///< assumed: between trunks that squeeze past (tried 0.02, 0.03)
  static constexpr double leaning_back_rad = 0.26;  ///< how far back a sitter leans: 15 degrees, as in the paper
  static constexpr double search_every_s = 0.2;     ///< how often one who found no way looks again

  struct Aside {
    Vec2 place{0.0};
    Precedence precedence;                 ///< inherited
    std::uint32_t whom = 0;                ///< way is made for
    std::int64_t until = 0;                ///< tick
    std::shared_ptr<const Way> way = {};   ///< theirs, if a sitter got up for them
    std::optional<std::size_t> door = {};  ///< way is made for its leaf
  };

  [[nodiscard]] std::int64_t ticks(double seconds) const noexcept;
  /// Squeezing past others, one draws in the arms and goes slowly; who sits pulls in the chair.
  enum class Width { usual, narrow };
  [[nodiscard]] const body::WalkableFloor& floor() const noexcept {
    return width_ == Width::narrow ? *person_->narrow_floor : *person_->floor;
  }
  [[nodiscard]] double radius_m() const noexcept { return floor().clearance_m(); }
  [[nodiscard]] const Stadium& taken_by(const Presence& other) const noexcept {
    return width_ == Width::narrow ? other.trunk : other.room;
  }
  [[nodiscard]] double gap_to(const Presence& other) const noexcept;
  [[nodiscard]] bool free_to_draw_back(const Vec2& to, const Others& others) const;
  [[nodiscard]] std::optional<std::vector<Vec2>> way_among(const Vec2& target, const Others& others) const;
  [[nodiscard]] double free_way_ahead(const Others& others) const;
  struct WayToDoor {
    double free_m = 0.0;              ///< on the route, before a leaf that isn't open is in the way
    std::optional<double> through_m;  ///< where the route leads through it, if it does so soon
  };
  [[nodiscard]] WayToDoor way_to_door(const DoorsSeen& doors, std::size_t door) const;
  /// Also notes which door they want to go through.
  [[nodiscard]] double free_way_to_doors(const DoorsSeen& doors);
  [[nodiscard]] bool must_give_way(std::span<const Presence> others) const;
  /// Near by: accepted, walkable among others, and so is a way there.
  template <class Accepts>
  [[nodiscard]] std::optional<Vec2> nearest_place(const Others& others, const Accepts& accepts) const;
  [[nodiscard]] std::optional<Vec2> passing_place(const Presence& whom, const Others& others, double reach_m) const;
  [[nodiscard]] bool can_go_back(const Aside& aside, const Others& others, std::int64_t now) const;
  [[nodiscard]] bool is_past(const Aside& aside, const Others& others) const;
  bool waits_aside(const Others& others, const DoorsSeen& doors, std::int64_t now);
  bool steps_aside(const Others& others, std::int64_t now);
  [[nodiscard]] std::optional<Vec2> place_before(const DoorLeaf& leaf, const Others& others) const;
  bool steps_back(const Others& others, const DoorsSeen& doors, std::int64_t now);
  bool gets_up(const Others& others, std::int64_t now);
  [[nodiscard]] bool bars(const Presence& other, const Vec2& from, const Vec2& to) const;
  void ask_up(const Vec2& target, const Others& others, std::int64_t now);
  [[nodiscard]] bool bumps_into(const Others& others) const;
  void keep_distance(const Others& others, const DoorsSeen& doors, std::int64_t now);
  void be_held_up(std::int64_t now);
  void wish_way(Way way, std::int64_t now);
  void sit_up(const Others& others, std::int64_t now);
  void end_passing(const Others& others) noexcept;

  const PersonModel* person_ = nullptr;
  std::uint32_t index_ = 0;
  int tick_rate_hz_ = 50;
  body::Motion motion_;
  std::optional<body::Route> route_;  ///< to walk once the body faces its start, or being walked
  double walked_m_ = 0.0;             ///< on it
  std::optional<Vec2> target_;        ///< of the last go_to()
  std::optional<Aside> aside_;
  std::shared_ptr<const Way> wished_way_;
  std::shared_ptr<const std::vector<std::uint32_t>> asks_up_;  ///< together with wished_way_
  std::int64_t asked_up_at_ = 0;                               ///< tick
  bool is_let_by_ = false;                                     ///< somebody got up for this person
  std::optional<Vec2> got_up_from_;
  std::optional<std::int64_t> held_up_since_;  ///< until half a metre is walked
  Vec2 held_up_at_{0.0};
  std::int64_t blocked_ticks_ = 0;  ///< since somebody came into the way
  std::int64_t held_up_ticks_ = 0;  ///< in all since the errand was set out on
  Width width_ = Width::usual;
  Presence::Solidity solidity_ = Presence::Solidity::solid;
  std::optional<std::size_t> wanted_door_;
  bool leans_forward_ = false;  ///< for somebody who squeezes past
  std::optional<Incident> incident_;
};

}  // namespace pirsim::sim
