// A body among other bodies: finds its way, keeps its distance, makes way, and is never stuck for good.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "body/motion.hpp"
#include "body/route.hpp"
#include "sim/compiled_study.hpp"
#include "sim/doors.hpp"
#include "sim/presence.hpp"

namespace pirsim::sim {

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
