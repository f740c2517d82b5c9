// People who are where data say: tracked ones against the closed form, replayed ones against the run that was written.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <utility>

#include "engine/sim/run_state.hpp"
#include "pirsim/model.hpp"
#include "support/body_checks.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::sim;
using namespace pirsim::test;

namespace {

ScriptSpec script_of_tracks(const std::vector<TrackSpec>& tracks, MotionStyle style) {
  ScriptSpec script = script_of({});
  OccupancySpec& occupancy = script.trials.front().occupancy.emplace();
  occupancy.style = style;
  occupancy.positions.emplace().tracks = tracks;
  return script;
}

/// Straight from point to point, evenly in time; written anew, as the page says it.
Vec2 expected_at(const TrackSpec& track, double time_s) {
  for (std::size_t i = 0; i + 1 < track.times_s.size(); ++i) {
    if (time_s > track.times_s[i + 1]) continue;
    const double share = (time_s - track.times_s[i]) / (track.times_s[i + 1] - track.times_s[i]);
    return (1.0 - share) * track.points[i] + share * track.points[i + 1];
  }
  return track.points.back();
}

/// In the meeting room: round corners, a rest, back on its own way, through the table; another one crosses it.
std::vector<TrackSpec> two_tracks() {
  TrackSpec one;
  one.person = "one";
  one.times_s = {0.5, 2.0, 3.0, 5.0, 9.0, 10.0, 11.5, 12.01, 14.0};
  one.points = {{6.3, -0.6}, {4.8, -0.6}, {4.3, -1.4}, {4.3, -1.4}, {2.0, -3.5},
                {2.0, -3.5}, {3.5, -2.0}, {3.5, -1.8}, {3.4, -1.8}};
  TrackSpec other;
  other.person = "other";
  other.times_s = {1.0, 8.0};
  other.points = {{2.0, -0.6}, {6.0, -2.0}};
  return {one, other};
}

void check_tracks(const std::vector<TrackSpec>& tracks, MotionStyle style, int tick_rate_hz) {
  ScriptSpec script = script_of_tracks(tracks, style);
  script.sensing.tick_rate_hz = script.sensing.ticks_per_window = tick_rate_hz;
  const Model model = compile(shipped_scene("meeting_room.gltf"), script);
  RunState state(model.compiled(), 0);
  double farthest_m = 0.0;
  int n = 0;
  while (!state.finished) {
    move_tick(model.compiled(), state);
    const double now_s = static_cast<double>(state.tick) / tick_rate_hz;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      const Actor& actor = state.crowd.actors()[i];
      const bool there = now_s >= tracks[i].times_s.front() - 1e-9 && now_s <= tracks[i].times_s.back() + 1e-9;
      REQUIRE(actor.present() == there);
      if (!there) continue;
      farthest_m = std::max(farthest_m, glm::distance(actor.motion().position(), expected_at(tracks[i], now_s)));
      ++n;
    }
  }
  INFO(n << " positions");
  CHECK(n > 20 * tick_rate_hz);
  CHECK(farthest_m < 1e-9);
}

/// The seat that each person has taken, by time.
using Seats = std::map<std::string, std::map<double, std::string>>;

/// Person-seconds of the first in which the second has another seat, or none, so much later.
std::size_t n_differ(const Seats& were, const Seats& are, double later_s) {
  std::size_t n = 0;
  for (const auto& [person, rows] : were) {
    for (const auto& [time_s, seat] : rows) {
      const auto they = are.find(person);
      const auto there = they == are.end() ? rows.end() : they->second.find(time_s + later_s);
      if (they == are.end() || there == they->second.end() || there->second != seat) ++n;
    }
  }
  return n;
}

}  // namespace

TEST_CASE("Tracked people are at every tick where their points say, and there from the first to the last") {
  for (const MotionStyle style : {MotionStyle::natural, MotionStyle::choreographed}) {
    for (const int tick_rate_hz : {10, 50}) check_tracks(two_tracks(), style, tick_rate_hz);
  }
}

TEST_CASE("A tracked person's feet stand still while they stand, and swing as far as is walked") {
  const std::vector<TrackSpec> tracks = two_tracks();
  const Model model = compile(shipped_scene("meeting_room.gltf"), script_of_tracks(tracks, MotionStyle::choreographed));
  RunState state(model.compiled(), 0);
  body::Feet before{};
  double at_rest_m = 0.0, walked_m = 0.0, fastest_m_s = 0.0;
  while (!state.finished) {
    move_tick(model.compiled(), state);
    const Actor& actor = state.crowd.actors().front();
    if (!actor.present()) continue;
    const double now_s = static_cast<double>(state.tick) * model.tick_s();
    const body::Feet feet = actor.motion().outline().feet;
    if (now_s > 0.55) {
      for (const std::size_t side : {0U, 1U}) {
        const double moved_m = glm::distance(feet[side].print.position, before[side].print.position);
        if (now_s > 3.05 && now_s < 4.95) at_rest_m += moved_m;
        if (now_s < 2.95) walked_m += 0.5 * moved_m;  // of both: half of the way each
        fastest_m_s = std::max(fastest_m_s, moved_m / model.tick_s());
      }
    }
    before = feet;
  }
  CHECK(at_rest_m == 0.0);
  CHECK(std::abs(walked_m - (1.5 + std::hypot(0.5, 0.8))) < 0.3);
  CHECK(fastest_m_s < 6.0);  // a foot in the air goes at twice the pace, and half as fast again amid its swing
}

TEST_CASE("A tracked person's body stays whole: round corners, back, sideways and at any pace") {
  std::vector<TrackSpec> tracks = two_tracks();
  tracks.front().times_s = {0.0, 1.0, 3.0, 4.0, 4.5, 5.0, 6.0, 7.0, 12.0};
  tracks[1].headings_deg = {20.0, 20.0};  // sideways
  TrackSpec back = tracks[1];
  back.person = "back";
  back.headings_deg = {-100.0, -100.0};
  tracks.push_back(back);
  ScriptSpec script = script_of_tracks(tracks, MotionStyle::natural);
  script.sensing.tick_rate_hz = script.sensing.ticks_per_window = 25;
  const Model model = compile(shipped_scene("meeting_room.gltf"), script);
  RunState state(model.compiled(), 0);
  std::array<body::test::Soundness, 3> bodies;
  while (!state.finished) {
    move_tick(model.compiled(), state);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const Actor& actor = state.crowd.actors()[i];
      if (actor.present()) bodies.at(i).add(actor.person().humanoid, actor.motion().posture());
    }
  }
  for (const auto& body : bodies) {
    CHECK(body.worst_gap_m < 1e-9);
    CHECK(body.lowest_m > -1e-9);
    // Nobody has time for a turn that the data don't show: on sharp ones a hip twists beyond its limit.
    CHECK(body.excess.radians < radians(15.0));
  }
}

TEST_CASE("A tracked person faces where they go, or as the data say") {
  TrackSpec track;
  track.person = "one";
  track.times_s = {0.0, 4.0};
  track.points = {{6.3, -0.6}, {2.3, -0.6}};  // towards -X, which is 90 degrees to the left of -Z
  const auto heading_at = [&](double at_s) {
    const Model model =
        compile(shipped_scene("meeting_room.gltf"), script_of_tracks({track}, MotionStyle::choreographed));
    RunState state(model.compiled(), 0);
    while (static_cast<double>(state.tick) * model.tick_s() < at_s) move_tick(model.compiled(), state);
    return degrees(state.crowd.actors().front().motion().heading());
  };
  CHECK(std::abs(heading_at(2.0) - 90.0) < 1e-6);
  track.headings_deg = {90.0, 170.0};
  CHECK(std::abs(heading_at(2.0) - 130.0) < 2.0);
}

TEST_CASE("What --occupants wrote is replayed: the same seats within seconds", "[seconds]") {
  const TemporaryFolder folder;
  const SceneSpec room = shipped_scene("meeting_room.gltf");
  const ScriptSpec day =
      shipped_script("meeting_day.yaml", std::vector<std::string>{"sensing.tick_rate_hz=10", "sensing.response=zones"});
  const auto seats_of = [](const RunResult& result) {
    Seats seats;
    for (const OccupantRow& row : result.occupants) {
      if (!row.seat.empty()) seats[row.person][row.time_s] = row.seat;
    }
    return seats;
  };
  const RunResult given = run_once(compile(room, day), 0, Record::samples, Trace::none, Occupants::told);
  {
    std::ofstream out(folder.path() / "occupants.csv");
    out << "time_s,person,activity,seat,x_m,z_m\n";
    for (const OccupantRow& row : given.occupants)
      out << row.time_s << ',' << row.person << ',' << row.activity << ',' << row.seat << ',' << row.place_m.x << ','
          << row.place_m.y << '\n';
    std::ofstream script(folder.path() / "s.yaml");
    script << "pirsim_script: 1\nsensing: {tick_rate_hz: 10, response: zones}\noccupancy: {places: occupants.csv}\n";
  }
  const ScriptSpec replay = io::read_script(folder.path() / "s.yaml");
  const RunResult again = run_once(compile(room, replay), 0, Record::samples, Trace::none, Occupants::told);
  CHECK(!again.fault);
  const auto were = seats_of(given), are = seats_of(again);
  REQUIRE(were.size() > 2);
  std::size_t seconds = 0, changes = 0;
  for (const auto& [person, rows] : were) {
    std::pair<double, std::string> last{-10.0, ""};
    for (const auto& now : rows) {
      changes += now.second != last.second || now.first > last.first + 1.5 ? 1 : 0;
      last = now;
      ++seconds;
    }
  }
  const std::size_t differ = n_differ(were, are, 0.0) + n_differ(are, were, 0.0);
  INFO(differ << " of " << seconds << " person-seconds in a seat differ, " << changes << " seats taken");
  CHECK(changes > 20);
  CHECK(differ <= 4 * changes);
  CHECK(n_differ(were, are, 5.0) >= 3 * changes);  // a twin that is five seconds late
}
