// How one person moves: the state machine of standing, walking, turning, sitting down, sitting and rising.
#pragma once

#include <optional>
#include <vector>

#include "pirsim/body/body_part.hpp"
#include "pirsim/body/humanoid.hpp"
#include "pirsim/body/route.hpp"
#include "pirsim/geom/frame.hpp"

namespace pirsim::body {

enum class Stage { standing, walking, turning, sitting_down, seated, rising };
[[nodiscard]] std::string_view name(Stage stage) noexcept;

/// A seat as the body needs it.
struct SeatPlace {
  Frame world_from_seat;                 ///< pelvis rests at the origin, facing -Z
  double floor_height_m = 0.0;           ///< y of the floor under the feet
  std::optional<double> table_height_m;  ///< y of what the forearms rest on; none: hands on the thighs
};

/// Arm and spine motion of a seated person (Stefansson et al. 2021, section 3.1).
struct DeskWork {
  double arm_amplitude_m = 0.1;
  double arm_period_s = 3.0;
};

/// A value: copying it copies the whole state of the person's body. Commands may be given at any time; every part
/// stays continuous in position whatever the order of commands, and joint speeds stay bounded.
class Motion {
 public:
  /// Standing still, feet together. floor_height_m: y of the floor.
  Motion(const Humanoid& humanoid, const Vec2& position, double heading, double floor_height_m, double tick_s);

  // Commands. A command that needs another stage first (walk while seated) throws std::logic_error: the caller
  // sequences them; stop() and rise() lead back to standing from anywhere.
  void walk(const Route& route);        ///< from standing; the route starts here
  void turn_to(double heading);         ///< from standing, in place, with small steps
  void stop();                          ///< from walking or turning: comes to stand within two steps
  void sit_down(const SeatPlace& seat); ///< from standing, facing as the seat does; also reverses rising from it
  void rise();                          ///< from seated or sitting_down: back to where sitting down began
  void work(const DeskWork& work);      ///< from seated: forearms to the table, then oscillating
  void rest();                          ///< ends desk work: arms and spine come to rest
  void tilt_spine(double radians);      ///< target of the spine's tilt, positive forward; only while seated
  /// Upper bound of the walking speed from now on (m/s); 0 lets a walker wait on the spot.
  void limit_speed(double metres_per_second);

  void advance();  ///< one tick

  [[nodiscard]] Stage stage() const noexcept;
  /// Nothing of the last command is left to do (desk work and sitting go on while settled).
  [[nodiscard]] bool settled() const noexcept;
  [[nodiscard]] Vec2 position() const noexcept;  ///< of the pelvis over the floor
  [[nodiscard]] double heading() const noexcept;
  [[nodiscard]] double speed_m_s() const noexcept;
  [[nodiscard]] Posture posture() const;

 private:
  struct Impl;
};

/// Where to stand before sitting down there: how far before the seat's pelvis point (along the facing direction) a
/// person stands who falls back into it without moving the chair.
[[nodiscard]] double fall_back_m(const Humanoid& humanoid, const SeatPlace& seat) noexcept;

}  // namespace pirsim::body
