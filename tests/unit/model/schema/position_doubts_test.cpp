// Positions that a script takes for metres and seconds: which are doubted, and what they are said to look like.
#include "pirsim/model.hpp"

#include <cmath>
#include <functional>

#include "support/catch.hpp"

using namespace pirsim;

namespace {

/// A floor of 8 m x 6 m, from x 1 to 9 and z 0.5 to 6.5.
SceneSpec room() {
  SceneSpec scene;
  scene.floor = FloorArea({{{1, 0.5}, {9, 0.5}, {9, 6.5}, {1, 6.5}}}, 0.0);
  return scene;
}

/// Two people who walk up and down at 1.2 m/s for a minute, ten points a second.
ScriptSpec walkers(const std::function<Vec2(Vec2)>& placed, double second = 1.0) {
  PositionsSpec positions;
  for (const double z : {1.5, 5.0}) {
    TrackSpec& track = positions.tracks.emplace_back();
    track.person = z < 2.0 ? "A" : "B";
    for (int i = 0; i < 600; ++i) {
      track.times_s.push_back(0.1 * i * second);
      track.points.push_back(placed({5.0 + 3.5 * std::sin(0.1 * i * 1.2 / 3.5), z}));
    }
  }
  ScriptSpec script;
  TrialSpec& trial = script.trials.emplace_back();
  trial.occupancy.emplace().positions = std::move(positions);
  return script;
}

std::string doubt_of(const ScriptSpec& script) {
  const std::vector<Issue> issues = doubts_of_positions(room(), script);
  REQUIRE(issues.size() <= 1);
  return issues.empty() ? "" : issues.front().message;
}

}  // namespace

TEST_CASE("Positions are doubted for what is wrong with them, and not when they are right") {
  CHECK(doubt_of(walkers([](Vec2 p) { return p; })).empty());
  struct Wrong {
    const char* looks_like;
    std::function<Vec2(Vec2)> placed;
  };
  for (const Wrong& wrong :
       {Wrong{"They look like centimetres;", [](Vec2 p) { return 100.0 * p; }},
        Wrong{"millimetres;", [](Vec2 p) { return 1000.0 * p; }}, Wrong{"feet;", [](Vec2 p) { return p / 0.3048; }},
        Wrong{"z turned round;", [](Vec2 p) { return Vec2(p.x, -p.y); }},
        Wrong{"x turned round;", [](Vec2 p) { return Vec2(-p.x, p.y); }},
        Wrong{"centimetres with z turned round;", [](Vec2 p) { return Vec2(100.0 * p.x, -100.0 * p.y); }}}) {
    INFO(wrong.looks_like);
    CHECK_THAT(doubt_of(walkers(wrong.placed)), contains("over the floor") && contains(wrong.looks_like));
  }
  const std::string elsewhere = doubt_of(walkers([](Vec2 p) { return p + Vec2(500.0, 700.0); }));
  CHECK_THAT(elsewhere, contains("nobody is ever over the floor: they span x 501.50 to 508.50") &&
                            contains("the floor x 1.00 to 9.00") && !contains("look like"));
  CHECK_THAT(doubt_of(walkers([](Vec2 p) { return Vec2(1, 0.5) + 0.01 * p; })),
             contains("all positions lie within 0.07 m x 0.04 m of a floor of 8.00 m x 6.00 m"));
}

TEST_CASE("Steps that nobody can take are doubted, and walks that take for ever") {
  CHECK_THAT(doubt_of(walkers([](Vec2 p) { return p; }, 10.0)), contains("frames rather than seconds"));
  CHECK_THAT(doubt_of(walkers([](Vec2 p) { return p; }, 2000.0)), contains("milliseconds rather than seconds"));
  CHECK_THAT(doubt_of(walkers([](Vec2 p) { return p; }, 0.01)), contains("m/s"));
  ScriptSpec jump = walkers([](Vec2 p) { return p; });
  jump.trials[0].occupancy->positions->tracks[1].points[300].x = 1.1;
  CHECK_THAT(doubt_of(jump), contains("'B' goes") && contains("m in 0.10 s, until second 30.0"));
  // Readings a minute apart tell no walk, and somebody who sits doesn't walk.
  ScriptSpec minutes = walkers([](Vec2 p) { return p; });
  for (TrackSpec& track : minutes.trials[0].occupancy->positions->tracks) {
    for (double& seconds : track.times_s) seconds *= 600.0;
  }
  CHECK(doubt_of(minutes).empty());
  // The same file in several trials is told once.
  jump.trials.push_back(jump.trials[0]);
  CHECK_FALSE(doubt_of(jump).empty());
}
