// How one person moves: the state machine of standing, walking, turning, sitting down, sitting and rising, and of lying
// down from the edge of a bed, lying and getting up.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "engine/body/arms.hpp"
#include "engine/body/gait.hpp"
#include "engine/body/seating.hpp"
#include "engine/body/skeleton.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::body {

enum class Stage { standing, walking, turning, sitting_down, seated, rising, lying_down, lying, getting_up };
[[nodiscard]] std::string_view name(Stage stage) noexcept;

/// Small movements on top of what a stage does. Each goes to a target and stays there until it gets another.
enum class Channel : std::size_t {
  trunk_tilt,  ///< radians, positive forward
  trunk_lean,  ///< radians, positive to the right
  head_turn,   ///< radians, positive to the left
  chair_turn,  ///< radians, positive to the left; while seated
  // The four channels of the hands on the table act while the forearms lie on it. Their metres are those of somebody
  // 1.86 m tall; other people's hands move in proportion to their stature.
  left_hand_ahead,     ///< metres along the table, positive forward
  right_hand_ahead,    ///< metres along the table, positive forward
  left_hand_up,        ///< metres above the table
  right_hand_up,       ///< metres above the table
  left_hand_to_head,   ///< 0: the hand is where the posture puts it; 1: it is beside mouth and ear, sitting or standing
  right_hand_to_head,  ///< 0: the hand is where the posture puts it; 1: it is beside mouth and ear, sitting or standing
  // While lying.
  roll,   ///< radians, 0 on the back, positive towards the left side
  raise,  ///< radians of the trunk above the level
  curl,   ///< 0: legs stretched, 1: drawn up
};
inline constexpr std::size_t n_channels = 13;
inline constexpr double fidget_s = 0.6;  ///< assumed (0.4-1): a small move of trunk or head

/// What a person's posture depends on beside their measures. Equal outlines give equal postures, bit for bit, and a
/// choreography repeats its outlines; they cost a tenth of a posture. Doubles only, so that bytes can be compared.
struct Outline {
  Placement pelvis;
  double hip_height_m = 0.0;  ///< y in the world, as all heights here
  Feet feet{};
  double floor_height_m = 0.0;
  double spine_tilt = 0.0;
  double fall = 0.0;                     ///< 0 standing, 1 at the seat's height
  double reach = 0.0;                    ///< of the arms: 0 on the thighs, 1 on the table
  double thigh_angle = 0.0;              ///< when seated; 0 while fall is 0
  double table_height_m = 0.0;           ///< what the forearms rest on; 0 while reach is 0
  double hand_offset_m = 0.0;            ///< of the left hand ahead of its base place
  double head_turn = 0.0;                ///< to the left
  double spine_lean = 0.0;               ///< to the right
  double chest_m = 0.0;                  ///< see Pose
  std::array<double, 2> hand_ahead_m{};  ///< left, right; beyond hand_offset_m; 0 while reach is 0
  std::array<double, 2> hand_up_m{};
  std::array<double, 2> hand_to_head{};  ///< left, right; 0 to 1
  LyingOutline lying{};                  ///< all else is of the sitter on the edge while somebody lies
  bool operator==(const Outline&) const = default;
};
[[nodiscard]] Posture posture_of(const Humanoid& humanoid, const Outline& outline) noexcept;
/// By the pelvis, which is the middle of the trunk, the floor's height, `fall`, 1 where it lies, and `hand_ahead_m` of
/// either diagonal pair of paws alone.
[[nodiscard]] Posture posture_of(const AnimalMeasures& animal, const Outline& outline) noexcept;

/// How somebody walks, sits down and rises. Defaults: the paper's steps (of a stature of 1.86 m), times `assumed`
/// (0.8-2 s).
struct Manner {
  double pace_m_s = 1.0;
  double step_m = 0.5;  ///< longest way of the body during one step
  double sitting_down_s = 1.2, rising_s = 1.2;
  bool operator==(const Manner&) const = default;
};
/// Of people who move by themselves. A step is 0.63 m V^0.42 long at a stature of 1.75 m: the exponent is quoted,
/// Ref: [Grieve1966]; 0.63 `assumed` (0.6-0.66), which makes a walk ratio of 0.0064 m per step a minute at 1.3 m/s, in
/// the middle of what is measured, Ref: [Murakami2017]. It grows with the stature to the power 0.79, so that people of
/// all sizes walk alike by their Froude number, Ref: [Alexander1984]. Sitting down takes 1.5 s and rising 1.8 s
/// (`assumed`, 0.9-2 and 1.5-2: measured are 0.9 and 1.5 s, doi:10.1007/s40520-020-01715-9, to 1.9 and 2.0 s).
[[nodiscard]] Manner natural_manner(double pace_m_s, double stature_m) noexcept;

/// A value: copying it copies the whole state of the person's body. Commands may be given at any time; every part
/// stays continuous in position whatever the order of commands, and joint speeds stay bounded.
class Motion {
 public:
  /// Standing still, feet together. floor_height_m: y of the floor.
  Motion(const Humanoid& humanoid, const Vec2& position, double heading, double floor_height_m, double tick_s);

  // Commands. A command that needs another stage first (walk while seated) throws Error(internal): the caller
  // sequences them; stop() and rise() lead back to standing from anywhere.
  /// From standing; the route starts here. Turns first where it leads off by more than 20 degrees, and at pivots.
  void walk(const Route& route);
  /// From standing at its start: goes along as follow_to() says, corners and all.
  /// headings: where the body faces, at these distances; none: where the route goes.
  void follow(const Route& route, std::span<const double> at_m, std::span<const double> headings);
  /// Where on that route it is with the next tick; stands at its end.
  void follow_to(double distance_m) noexcept { followed_m_ = distance_m; }
  void turn_to(double heading);  ///< from standing, in place, with small steps
  /// From walking or turning: comes to stand within two steps. Who waits in mid-stride (limit_speed(0)) brings the
  /// feet together on the spot, which counts as turning.
  void stop();
  void sit_down(const SeatPlace& seat);  ///< from standing, facing as the seat does; also reverses rising from it
  void lie_down(const LyingPlace& bed);  ///< from seated on its edge
  /// From seated, lying or on the way there: back to where sitting down began.
  void rise();
  void work(const DeskWork& work);  ///< from seated: forearms to the table, then oscillating
  void rest();                      ///< ends desk work: arms and spine come to rest
  void tilt_spine(double radians);  ///< target of the spine's tilt, positive forward; only while seated
  /// Anywhere but on the way onto or off a seat or a bed; rising brings all channels back to 0.
  void adjust(Channel channel, double target, double seconds);
  /// From now on small movements go on at every n-th tick alone, by n ticks. One that is asked for in between begins
  /// with the last of these: up to n - 1 ticks early.
  void move_in_steps_of(int n_ticks) noexcept { channel_step_ = n_ticks; }
  /// Where it goes or rests.
  [[nodiscard]] double target(Channel which) const noexcept { return channel(which).target(); }
  void breathe(double metres) noexcept { chest_m_ = metres; }  ///< the chest is so far forward from now on
  [[nodiscard]] double pace_m_s() const noexcept { return manner_.pace_m_s; }
  /// From the next walk, sitting down or rising on, instead of the paper's manner at the person's own pace.
  void set_manner(const Manner& manner) noexcept { manner_ = manner; }
  /// Upper bound of the walking speed from now on (m/s); 0 lets a walker wait on the spot.
  void limit_speed(double metres_per_second);
  void halt() noexcept;  ///< a walker stands still at once, in mid-stride
  /// From now on it is as this says: of a body that is moved from outside.
  void pose_as(const Outline& outline) noexcept;

  void advance();  ///< one tick

  [[nodiscard]] Stage stage() const noexcept { return stage_; }
  /// Nothing of the last command is left to do (desk work and sitting go on while settled).
  [[nodiscard]] bool settled() const noexcept;
  [[nodiscard]] Vec2 position() const noexcept;  ///< of the pelvis over the floor
  /// How far back the pelvis gets on the way onto the seat or off it; elsewhere the position.
  [[nodiscard]] Vec2 drawn_back() const noexcept { return on_seat() ? seating_.pelvis(1.0, 0.0).position : position(); }
  /// On the way from the edge of a bed, on it, or on the way back.
  [[nodiscard]] bool in_bed() const noexcept { return stage_ >= Stage::lying_down; }
  [[nodiscard]] double heading() const noexcept;
  [[nodiscard]] double speed_m_s() const noexcept;
  [[nodiscard]] double spine_tilt() const noexcept;  ///< positive forward
  [[nodiscard]] Outline outline() const noexcept;
  [[nodiscard]] Posture posture() const noexcept { return posture_of(humanoid_, outline()); }
  bool operator==(const Motion&) const = default;

 private:
  /// Where pelvis and feet are: follows from all that is below, kept because it changes rarely while seated.
  struct Stance {
    Placement pelvis;
    Feet feet{};
    double hip_height_m = 0.0;  ///< above the floor
    bool operator==(const Stance&) const = default;
  };
  [[nodiscard]] bool on_track() const noexcept { return stage_ == Stage::walking || stage_ == Stage::turning; }
  [[nodiscard]] bool on_seat() const noexcept { return stage_ != Stage::standing && !on_track(); }
  [[nodiscard]] int ticks(double seconds) const noexcept;
  [[nodiscard]] Placement pelvis() const noexcept;
  [[nodiscard]] Feet feet() const noexcept;
  [[nodiscard]] double hip_height_m(const Placement& pelvis, const Feet& feet) const noexcept;
  [[nodiscard]] const MinJerk& channel(Channel which) const noexcept {
    return channels_[static_cast<std::size_t>(which)];
  }
  [[nodiscard]] bool channels_rest() const noexcept;
  void turn_with_chair(Stance& stance) const noexcept;
  [[nodiscard]] double hand_offset_m() const noexcept;
  void begin_track(Stage stage, const Track& track, const StepStyle& style);
  [[nodiscard]] StepStyle walking_style() const noexcept;
  void begin_turn(double angle);
  void walk_from(const Route& route, double from_s);
  void advance_on_track();
  void advance_on_seat() noexcept;
  void advance_in_bed() noexcept;
  [[nodiscard]] LyingOutline lying_outline() const noexcept;
  void turn_to_table() noexcept;
  void bring_feet_together();
  void come_to_stand(const Placement& place, const Feet& feet) noexcept;
  void update_stance() noexcept;

  Humanoid humanoid_;
  double floor_height_m_ = 0.0;
  double tick_s_ = 0.02;
  Stage stage_ = Stage::standing;

  // Standing; also where sitting down began.
  Placement stand_;
  Feet stand_feet_{};

  Stance stance_;

  // Walking and turning; distances in metres or radians.
  Track track_;
  FootPlan steps_;
  double distance_ = 0.0;
  double track_speed_ = 0.0;
  double hips_lowered_m_ = 0.0;  ///< below standing at the start of a turn, fading
  Manner manner_;
  std::optional<double> followed_m_;  ///< of who follows a way: where on it with the next tick
  double speed_limit_m_s_ = std::numeric_limits<double>::infinity();
  /// What is left to walk after the present track: of a route with sharp turns.
  struct Remainder {
    Route route;
    double from_s = 0.0;
    bool operator==(const Remainder&) const = default;
  };
  std::optional<Remainder> remainder_;

  // Sitting.
  Seating seating_;
  MinJerk fall_;  ///< 0 standing, 1 at the seat's height
  MinJerk slide_m_;
  MinJerk tilt_;  ///< of the spine, beyond what falling and rising need
  std::array<MinJerk, n_channels> channels_;
  int channel_step_ = 1;        ///< ticks
  int since_channel_step_ = 0;  ///< ticks
  double chest_m_ = 0.0;
  MinJerk reach_;  ///< of the arms: 0 on the thighs, 1 on the table
  DeskWork work_;
  std::int64_t work_tick_ = 0;
  MinJerk hand_offset_left_over_m_;  ///< from desk work that was replaced by another, fading

  // Lying.
  LyingPlace bed_;
  MinJerk lying_;  ///< 0 on the edge, 1 lying

  std::optional<Outline> posed_;  ///< of who is moved from outside
};

// Postures that follow upon one another: only what has moved is worked out anew.

/// Of a pose or a posture: all that hangs together. Arrays are left, right.
struct Limbs {
  bool hips = true;
  bool spine = true;
  bool chest = true;
  bool head = true;
  bool arms = true;
  std::array<bool, 2> ankles{true, true};
};

/// Overwrites what depends on any of these of the outline, or of the pose; the rest stays as it is.
void update(Pose& pose, const Humanoid& humanoid, const Outline& outline, const Limbs& changed) noexcept;
void update(Posture& posture, const Humanoid& humanoid, const Pose& pose, const Limbs& changed) noexcept;

/// posture_of(), bit for bit, in less time where only arms or legs have moved since the last call.
class Poser {
 public:
  /// humanoid: outlives this.
  explicit Poser(const Humanoid& humanoid) noexcept : humanoid_(&humanoid) {}
  [[nodiscard]] const Humanoid& humanoid() const noexcept { return *humanoid_; }
  [[nodiscard]] const Posture& posture(const Outline& outline) noexcept;
  /// Bit i: the last call worked out part i anew.
  [[nodiscard]] std::uint32_t renewed() const noexcept { return renewed_; }

 private:
  const Humanoid* humanoid_;
  bool begun_ = false;
  Outline outline_;
  Pose pose_;
  Posture posture_;
  std::uint32_t renewed_ = 0;
};

}  // namespace pirsim::body
