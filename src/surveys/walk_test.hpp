// A walk test, compiled and tried point by point.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/body/ground.hpp"
#include "engine/body/skeleton.hpp"
#include "engine/sim/observer.hpp"
#include "pirsim/coverage.hpp"
#include "pirsim/scene.hpp"
#include "show/report.hpp"
#include "surveys/coverage.hpp"

namespace pirsim::studies {

/// Immutable, shared by threads.
class WalkTest {
 public:
  WalkTest(SceneSpec scene, WalkTestSpec spec);

  /// With the effects in force.
  [[nodiscard]] const SurveyBase& survey() const noexcept { return survey_; }
  [[nodiscard]] const SceneSpec& scene() const noexcept { return survey_.scene(); }
  [[nodiscard]] const WalkTestSpec& spec() const noexcept { return spec_; }
  [[nodiscard]] const FloorGrid& grid() const noexcept { return grid_; }

  /// Effects that a walk test can't show.
  [[nodiscard]] std::vector<Issue> warnings() const;

  /// What moves at the origin, facing -Z, tick by tick; the first pose is the state before.
  struct Movement {
    std::vector<Shape> solids;
    sim::BodyRadiance radiance{};
    std::vector<std::vector<Frame>> poses;  ///< (n_ticks + 1 x n_solids)
  };
  [[nodiscard]] const Movement& crossing() const noexcept { return crossing_; }
  /// Of a sitter's forearms, or one for each plane in which an arm swings.
  [[nodiscard]] const std::vector<Movement>& minor_motions() const noexcept { return minor_motions_; }
  /// In every direction each of them.
  [[nodiscard]] std::uint32_t tries_a_point() const noexcept;
  [[nodiscard]] const body::WalkableFloor& floor() const noexcept { return floor_; }
  /// Can somebody sit, or the arm hang, over this point?
  [[nodiscard]] bool has_room_for_minor(const Vec2& point) const noexcept;

 private:
  [[nodiscard]] Movement of_person() const;
  [[nodiscard]] Movement make_crossing() const;
  [[nodiscard]] Movement make_arm_work() const;
  [[nodiscard]] Movement make_swing(ArmSwing plane) const;

  SurveyBase survey_;
  WalkTestSpec spec_;
  FloorGrid grid_;
  body::Humanoid humanoid_;
  body::WalkableFloor floor_;
  std::optional<body::Obstacles> around_arm_;
  Movement crossing_;
  std::vector<Movement> minor_motions_;
};

/// Tries one movement after another in the sensors' sight. Belongs to one thread and to a walk test that outlives it.
class WalkTester {
 public:
  explicit WalkTester(const WalkTest& test);
  /// A walk is tried if the whole path is walkable, sitting if the point is, an arm if nothing solid is where its axis
  /// is. number: of the point, which keys what effects draw.
  [[nodiscard]] PointResult try_point(const Vec2& point, std::uint32_t number);
  /// A sitter's forearms on a seat of the scene, facing as it does.
  [[nodiscard]] SeatResult try_seat(const SeatSpec& seat, std::uint32_t number);

 private:
  /// Adds a try: noticed in time?
  void attempt(const WalkTest::Movement& movement, const Frame& world_from_movement, std::uint32_t try_number,
               Tries& tries);
  void look(const WalkTest::Movement& movement, std::size_t tick, const Frame& world_from_movement,
            sim::Exposure& exposure);

  const WalkTest& test_;
  const sim::SensorArray& array_;
  sim::Observer observer_;
  sim::Detector detector_;
  sim::Logger logger_;
  sim::Exposure before_, after_;
  // Scratch.
  std::vector<PosedShape> solids_;
  std::vector<std::uint8_t> triggers_;
};

/// threads 0: all cores; changes nothing in the result.
[[nodiscard]] WalkTestResult run_walk_test(const WalkTest& test, unsigned threads = 0, const RowDone& row_done = {});

/// x_m, z_m, and for major and minor motion the tries, how many were noticed, and pass or fail.
[[nodiscard]] std::string to_csv(const WalkTest& test, const WalkTestResult& result);
/// Points that pass, of those tried, and the seats; for a terminal.
[[nodiscard]] std::string to_text(const WalkTest& test, const WalkTestResult& result);
[[nodiscard]] io::Report walk_test_report(const WalkTest& test, const WalkTestResult& result);

}  // namespace pirsim::studies
