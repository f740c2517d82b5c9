// Which sensors notice somebody at work: against runs, against a slow twin of its own tracer, and by construction.
#include "surveys/sight.hpp"

#include <algorithm>
#include <numeric>

#include "engine/body/motion.hpp"
#include "engine/rt/tracer.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/plan_people.hpp"
#include "pirsim/look.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"
#include "support/zone_bytes.hpp"
#include "surveys/placement.hpp"

using namespace pirsim;
using namespace pirsim::studies;
using namespace pirsim::test;

namespace {

/// A den of 11 x 6 m with a door, an armchair 1.6 m beside the point under a sensor on the ceiling, and one across the
/// room.
SceneSpec den() {
  SceneSpec scene;
  scene.name = "den";
  scene.floor = FloorArea({{{-3, -3}, {8, -3}, {8, 3}, {-3, 3}}}, 0.0);
  scene.sensor_models["EKMC1601111"] = io::find_sensor_model("EKMC1601111", {});
  scene.sensors = {{"CEILING", "EKMC1601111", Frame{glm::angleAxis(radians(-90.0), Vec3(1, 0, 0)), {0.0, 2.5, 0.0}}}};
  const auto seat = [](const std::string& id, double heading_deg, const Vec2& at) {
    return SeatSpec{id, Frame{rotation_from_heading(radians(heading_deg)), {at.x, 0.45, at.y}}};
  };
  scene.seats = {seat("armchair", -90.0, {-1.5, -0.5}), seat("far", 0.0, {7.0, 2.4})};
  scene.entrances = {{"door", Frame{rotation_from_heading(0.0), {1.5, 0.0, 3.0}}}};
  return scene;
}

action::Work reading(double seconds) {
  action::Work work;
  work.duration_s = seconds;
  work.activity = Activity::reading;
  return work;
}

ScriptSpec reads_for(double seconds, Response response, ChangePer change_per = ChangePer::cluster) {
  PersonSpec reader =
      person("reader", {act(action::Enter{"door"}), act(action::Sit{"armchair"}), act(reading(seconds))});
  reader.style = MotionStyle::natural;
  ScriptSpec script = script_of({reader});
  script.sensing.response = response;
  script.sensing.change_per = change_per;
  return script;
}

int seconds_with_motion_while_working(const Model& model) {
  int n = 0;
  for (const Sample& row : run_once(model, 0).samples) n += row.phase == "working" ? row.bits.front() : 0;
  return n;
}

WorkReport watched(const Model& model, const Worker& worker, unsigned threads = 0) {
  const sim::CompiledStudy& study = model.compiled();
  return watch_sitters({study.scene(), study.sensing(), study.array(), study.tracer(), study.seed()}, worker, threads);
}
WorkReport watched(const Model& model) { return watched(model, worker_of(model.compiled().trials())); }

}  // namespace

TEST_CASE("a seat where clusters are covered for good is told, and is as deaf in a run, as beams and heat aren't",
          "[sitters]") {
  const auto compiled = [](Response response, ChangePer change_per) {
    return compile(den(), reads_for(900.0, response, change_per));  // as long as it is watched
  };
  const Model deaf = compiled(Response::zones, ChangePer::cluster);
  const WorkNotice notice = watched(deaf).notice(0, 0);
  CHECK(notice.is_deaf());
  CHECK(notice.channels > 0);
  CHECK(notice.for_good == notice.channels);
  CHECK(seconds_with_motion_while_working(deaf) == 0);
  CHECK(watched(deaf).deaf_seats(0) == std::vector<std::string>{"armchair"});
  CHECK(watched(deaf).by_any().deaf == std::vector<std::string>{"armchair"});
  CHECK(check_study(deaf).text.find("CEILING is deaf to work in armchair (it sees somebody at work in 1 seat): ") !=
        std::string::npos);

  const Model beams = compiled(Response::zones, ChangePer::beam);
  CHECK(watched(beams).notice(0, 0).seconds > 0);
  CHECK(watched(beams).notice(0, 0).for_good < watched(beams).notice(0, 0).channels);
  CHECK(seconds_with_motion_while_working(beams) > 0);

  const Model heat = compiled(Response::analog, ChangePer::cluster);
  CHECK(watched(heat).notice(0, 0).seconds > 0);
  CHECK(seconds_with_motion_while_working(heat) > 0);
}

TEST_CASE("out of every sensor's sight a sitter is unseen, not deaf to", "[sitters]") {
  const WorkReport report = watched(compile(den(), reads_for(60.0, Response::zones)));
  REQUIRE(report.seats == std::vector<std::string>{"armchair", "far"});
  CHECK(report.by_any().unseen == std::vector<std::string>{"far"});
  CHECK(report.notice(1, 0) == WorkNotice{});
}

namespace {

/// The metronome's arms on one seat, seen by the slow tracer: changes of clusters or zones second by second, and which
/// are covered at some tick and at all. After the hands have come to the table everything repeats after three seconds.
std::vector<WorkNotice> slowly_watched(const Model& model, const SeatSpec& seat, const PersonInForce& spec) {
  const sim::SensorArray& array = model.compiled().array();
  const RayBundle& rays = array.rated();
  const body::Humanoid humanoid(spec);
  const double floor_y = model.scene().floor.height_m();
  body::Motion motion =
      seated(humanoid, {seat.world_from_seat, floor_y, sim::table_height(seat, floor_y, array.room())}, model.tick_s());
  motion.work({0.1, 3.0});
  const auto tracer = array.make_tracer(TracerKind::reference, sim::ZonesOf::all_sensors);
  const auto channels = [&] {
    std::vector<PosedShape> solids;
    sim::append_solids(humanoid, motion.posture(), solids);
    const ZoneBytes zones = seen_by(*tracer, solids, rays.n_zones());
    if (model.script().sensing.change_per == ChangePer::beam) return zones;
    ZoneBytes clusters(rays.n_clusters());
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      for (auto zone = rays.cluster_zones_begin[i]; zone < rays.cluster_zones_begin[i + 1]; ++zone) {
        clusters[i] |= zones[zone];
      }
    }
    return clusters;
  };
  for (int tick = 0; tick < 250; ++tick) motion.advance();
  std::vector<ZoneBytes> seen{channels()};
  for (int tick = 0; tick < 150; ++tick) {
    motion.advance();
    seen.push_back(channels());
  }
  CHECK(seen.front() == seen.back());
  std::vector<WorkNotice> notices;
  for (std::size_t sensor = 0; sensor < array.n_sensors(); ++sensor) {
    std::size_t begin = rays.sensor_clusters_begin[sensor], end = rays.sensor_clusters_begin[sensor + 1];
    if (model.script().sensing.change_per == ChangePer::beam) {
      begin = rays.cluster_zones_begin[begin];
      end = rays.cluster_zones_begin[end];
    }
    WorkNotice notice;
    for (std::size_t second = 0; second < 3; ++second) {
      bool changes = false;
      for (std::size_t tick = 50 * second; tick < 50 * (second + 1); ++tick) {
        changes |= !std::equal(&seen[tick][begin], &seen[tick][0] + end, &seen[tick + 1][begin]);
      }
      notice.seconds += changes ? 100 : 0;  // of 300
    }
    for (std::size_t i = begin; i < end; ++i) {
      const auto covers = [i](const ZoneBytes& at) { return at[i] != 0; };
      notice.channels += std::ranges::any_of(seen, covers) ? 1 : 0;
      notice.for_good += std::ranges::all_of(seen, covers) ? 1 : 0;
    }
    notices.push_back(notice);
  }
  return notices;
}

}  // namespace

TEST_CASE("arms at desk work are noticed where the slow tracer's channels change", "[sitters]") {
  Worker worker;
  worker.person.stature_m = 1.75;
  worker.work.tilt_choices_deg = {};
  int n_deaf = 0, n_noticed = 0;
  for (const ChangePer change_per : {ChangePer::cluster, ChangePer::beam}) {
    SceneSpec scene = shipped_scene("meeting_room.gltf");
    scene.seats = {scene.seats[3], scene.seats[9]};
    ScriptSpec script = script_of({});
    script.sensing.response = Response::zones;
    script.sensing.change_per = change_per;
    const Model model = compile(scene, script);
    const WorkReport report = watched(model, worker);
    REQUIRE(report.seconds == 300);
    std::vector<WorkNotice> expected;
    for (const SeatSpec& seat : scene.seats) {
      const auto of_seat = slowly_watched(model, seat, worker.person);
      expected.insert(expected.end(), of_seat.begin(), of_seat.end());
    }
    CHECK(report.notices == expected);
    for (const WorkNotice& notice : report.notices) {
      n_deaf += notice.is_deaf() ? 1 : 0;
      n_noticed += notice.seconds > 0 ? 1 : 0;
    }
  }
  CHECK(n_deaf > 0);
  CHECK(n_noticed > 0);
}

TEST_CASE("the script's first desk worker is watched, or else somebody of natural style", "[sitters]") {
  const Model model = compile(den(), reads_for(60.0, Response::zones));
  const Worker reader = worker_of(model.compiled().trials());
  CHECK(reader.person.id == "reader");
  CHECK(reader.work.activity == Activity::reading);
  const Worker other = worker_of({});
  CHECK(other.person.style == MotionStyle::natural);
  CHECK(other.person.id.empty());
}

TEST_CASE("whatever the script's seed and its worker, a sofa is as deaf for check as for placements", "[sitters]") {
  SceneSpec scene = den();
  for (SeatSpec& seat : scene.seats) seat.uses = {"tv"};
  const auto notices_with = [&](std::uint64_t seed, MotionStyle style) {
    ScriptSpec script = reads_for(60.0, Response::analog);
    script.seed = seed;
    PersonSpec& reader = script.trials.front().people.front();
    if (style == MotionStyle::choreographed) std::get<action::Work>(reader.actions[2].what).activity.reset();
    reader.style = style;
    reader.stature_m = style == MotionStyle::natural ? 1.86 : 1.6;
    return check_study(compile(scene, script)).work.notices;
  };
  const auto same = [](const std::vector<WorkNotice>& a, const std::vector<WorkNotice>& b) {
    return std::ranges::equal(a, b, {}, &WorkNotice::seconds, &WorkNotice::seconds);
  };
  PlacementSpec placements;
  placements.by = PlacementAim::seats;
  const SeatsAtWork placed = seats_at_work(scene, placements, {"as built", scene.sensors}, 1);
  const auto by_check = notices_with(1, MotionStyle::natural);
  CHECK(same(by_check, notices_with(7, MotionStyle::natural)));
  CHECK(same(by_check, notices_with(7, MotionStyle::choreographed)));
  for (std::size_t i = 0; i < scene.seats.size(); ++i)
    CHECK((by_check[i].seconds > 0) == (std::ranges::count(placed.noticed, scene.seats[i].id) > 0));
}

TEST_CASE("of many seats thirty are tried, seats that nobody fits on are left out, and threads change nothing",
          "[sitters]") {
  SceneSpec scene = den();
  const SeatSpec armchair = scene.seats.front();
  scene.seats.clear();
  for (int i = 0; i < 120; ++i) {
    scene.seats.push_back(armchair);
    scene.seats.back().id = "seat_" + std::to_string(i);
    scene.seats.back().world_from_seat.origin.x += 0.02 * i;
  }
  scene.seats[24].world_from_seat.origin.y = 2.0;
  ScriptSpec script = script_of({});
  script.sensing.response = Response::zones;
  const Model model = compile(scene, script);
  const WorkReport one = watched(model, Worker{}, 1), four = watched(model, Worker{}, 4);
  CHECK(one.seats.size() == 29);
  CHECK(one.seats.front() == "seat_0");
  CHECK(one.seats.back() == "seat_116");
  CHECK(one.seats == four.seats);
  CHECK(one.notices == four.notices);
}
