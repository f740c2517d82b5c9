// A virtual walk test: at every point of the floor, how surely is a walker or a sitter's arm noticed in time?
// In the manner of NEMA WD 7 (major and minor motion, cell by cell) and EN 50131-2-2 (walks in several directions).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "body/humanoid.hpp"
#include "body/walkable_floor.hpp"
#include "io/report.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/survey.hpp"
#include "rt/tracer.hpp"
#include "studies/floor_grid.hpp"

namespace pirsim::studies {

/// How many tries were possible at a point, and in how many of them any sensor reported motion in time.
struct Tries {
  int made = 0;
  int noticed = 0;
  [[nodiscard]] std::optional<double> probability() const {
    return made == 0 ? std::nullopt : std::optional(static_cast<double>(noticed) / made);
  }
};

struct PointResult {
  Tries major, minor;
};

/// Immutable, shared by threads.
class WalkTest {
 public:
  WalkTest(SceneSpec scene, WalkTestSpec spec);

  [[nodiscard]] const SceneSpec& scene() const noexcept { return scene_; }
  [[nodiscard]] const WalkTestSpec& spec() const noexcept { return spec_; }
  [[nodiscard]] const FloorGrid& grid() const noexcept { return grid_; }

  /// A walk is tried if the whole path is walkable, sitting if the point is.
  [[nodiscard]] PointResult try_point(const Vec2& point, rt::Tracer& tracer) const;
  /// Minor motion on a seat of the scene, facing as it does: noticed in time?
  [[nodiscard]] bool notices_sitter(const SeatSpec& seat, rt::Tracer& tracer) const;
  [[nodiscard]] std::unique_ptr<rt::Tracer> make_tracer() const;

 private:
  /// Postures tick by tick of a person at the origin who faces -Z; the first is the state before.
  using Movement = std::vector<body::Posture>;
  [[nodiscard]] Movement crossing() const;
  [[nodiscard]] Movement arm_work() const;
  [[nodiscard]] bool is_noticed(const Movement& movement, const Frame& world_from_movement, rt::Tracer& tracer) const;

  SceneSpec scene_;
  WalkTestSpec spec_;
  FloorGrid grid_;
  body::Humanoid humanoid_;
  body::WalkableFloor floor_;
  rt::Room room_;
  RayBundle rated_, clipped_;
  Movement crossing_, arm_work_;
};

struct SeatResult {
  std::string seat;
  bool noticed = false;
};
struct WalkTestResult {
  std::vector<PointResult> points;  ///< (n_rows x n_columns), without tries off the floor
  std::vector<SeatResult> seats;
};

/// threads 0: all cores; changes nothing in the result. `row_done` is called after each row of points.
[[nodiscard]] WalkTestResult run_walk_test(
    const WalkTest& test, unsigned threads = 0, const std::function<void()>& row_done = [] {});

/// x_m, z_m, and for major and minor motion the tries, how many were noticed, and pass or fail.
[[nodiscard]] std::string to_csv(const WalkTest& test, const WalkTestResult& result);
/// Points that pass, of those tried, and the seats; for a terminal.
[[nodiscard]] std::string to_text(const WalkTest& test, const WalkTestResult& result);
[[nodiscard]] io::Report walk_test_report(const WalkTest& test, const WalkTestResult& result);

}  // namespace pirsim::studies
