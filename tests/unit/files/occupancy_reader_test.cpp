// Occupancies as users write them: forms of data that are understood, and what is said of those that aren't.
#include <fstream>

#include "model/schema/check_script.hpp"
#include "pirsim/io.hpp"
#include "pirsim/model.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

/// A folder with data and a script that names them.
class Files {
 public:
  explicit Files(const std::string& data) { write("c.csv", data); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_.path() / name) << text; }
  [[nodiscard]] ScriptSpec script(const std::string& occupancy, const std::string& more = "") const {
    write("s.yaml", "pirsim_script: 1\n" + more + "occupancy: {" + occupancy + "}\n");
    return io::read_script(folder_.path() / "s.yaml");
  }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

OccupancySpec occupancy_of(const std::string& data, const std::string& occupancy = "counts: c.csv",
                           const std::string& more = "") {
  return *Files(data).script(occupancy, more).trials.front().occupancy;
}

void refused_occupancy(const std::string& data, const std::string& message,
                       const std::string& occupancy = "counts: c.csv", const std::string& more = "") {
  INFO(data << occupancy);
  CHECK_THROWS_WITH(occupancy_of(data, occupancy, more), contains(message));
}

}  // namespace

TEST_CASE("Counts are read from door counters, readings with date and time in two columns, rows and plain seconds") {
  const CountsSpec counter = *occupancy_of("time,people\n2026-03-02T07:00,0\n2026-03-02 07:01:30,2\n").counts;
  CHECK(counter.begin == "2026-03-02T07:00:00");
  CHECK(counter.times_s == std::vector{0.0, 90.0});
  CHECK(counter.people == std::vector{0, 2});
  const CountsSpec uci =
      *occupancy_of("Date,Time,S6_PIR,Room_Occupancy_Count\n2017-12-22,10:49:41,0,1\n2017-12-22,10:50:12,0,1\n").counts;
  CHECK(uci.begin == "2017-12-22T10:49:41");
  CHECK(uci.times_s == std::vector{0.0, 31.0});
  const CountsSpec rows =
      *occupancy_of("replicate,trial,time_s,phase,people,PIR1\n1,1,1,working,0,0\n1,1,2,working,1,0\n").counts;
  CHECK(rows.begin.empty());
  CHECK(rows.times_s == std::vector{1.0, 2.0});
  const CountsSpec named =
      *occupancy_of("when,A,n\n0,7,\n3600,7,3.0\n7200,7,1\n7200,7,1\n", "counts: c.csv, time: when, people: n").counts;
  CHECK(named.times_s == std::vector{3600.0, 7200.0});  // what isn't known is left out
  CHECK(named.people == std::vector{3, 1});
}

TEST_CASE("An occupancy is read, written and read again to the same") {
  const Files files("time,people\n2026-03-02T07:00,0\n2026-03-02T18:00,2\n2026-03-03T09:00,1\n");
  const ScriptSpec script = files.script(
      "counts: c.csv, time: time, people: people, from: '06:30', to: '20:00', persons: 4, changes_within_s: 60, "
      "seats: [S1, S2], entrances: [door], style: choreographed");
  const OccupancySpec& occupancy = *script.trials.front().occupancy;
  CHECK(occupancy.from_h == 6.5);
  CHECK(occupancy.persons == 4);
  CHECK(occupancy.changes_within_s == 60.0);
  CHECK(occupancy.style == MotionStyle::choreographed);
  CHECK(script.files.size() == 2);  // the script and the data
  const std::string text = io::to_yaml(script);
  files.write("again.yaml", text);
  CHECK(io::to_yaml(io::read_script(files.path() / "again.yaml")) == text);
}

TEST_CASE("Counts of areas are columns of the same file") {
  const std::string keys = "counts: c.csv, areas: {kitchen: k, bath: b}";
  const CountsSpec all = *occupancy_of("time,k,b\n0,1,0\n60,,1\n120,0,1\n120,0,1\n", keys).counts;
  CHECK(all.times_s == std::vector{0.0, 120.0});
  CHECK(all.people == std::vector{1, 1});
  REQUIRE(all.areas.size() == 2);
  CHECK((all.areas[0].area == "kitchen" && all.areas[0].people == std::vector{1, 0}));
  CHECK((all.areas[1].area == "bath" && all.areas[1].people == std::vector{0, 1}));
  // With a total, the rest is elsewhere.
  CHECK(occupancy_of("time,people,k,b\n0,5,1,0\n9,1,1,0\n", keys).counts->people == std::vector{5, 1});
  refused_occupancy("time,people,k,b\n0,1,1,1\n", "c.csv:2:3: error: 2 people are in areas, but only 1 in all", keys);
  refused_occupancy("time,k\n0,1\n", "column 'b' is missing", keys);
  refused_occupancy("time,k,b\n0,1,0\n0,0,1\n", "c.csv:3:1: error: other numbers of areas for the same time", keys);
  refused_occupancy("time,k,b\n0,1,0\n", "expected each area's column, {kitchen: people_kitchen}",
                    "counts: c.csv, areas: [k]");
  refused_occupancy("time,k,b\n0,1,0\n", "expected each area's column, {kitchen: people_kitchen}",
                    "counts: c.csv, areas: {}");
}

TEST_CASE("Counts read what logs read") {
  // 1772434800 is 2026-03-02T07:00 UTC.
  for (const char* text : {
           "time,people\n2026-03-02T07:00,0\n2026-03-02T07:10,1\n2026-03-02T07:20,4\n",
           "time;people\n2026-03-02 07:00:00;0\n2026-03-02 07:10:00;1\n2026-03-02 07:20:00;4\n",
           "time\tpeople\n2026-03-02T07:00Z\t0\n2026-03-02T07:10Z\t1\n2026-03-02T07:20Z\t4\n",
           "time,people\n2026-03-02T07:00+02:00,0\n2026-03-02T07:10+02:00,1\n2026-03-02T06:20+01:00,4\n",
           "time,people\n1772434800,0\n1772435400,1\n1772436000,4\n",
           "time,people\n1772434800000,0\n1772435400000,1\n1772436000000,4\n",
           "time;people\n02.03.2026 07:00;0,0\n02.03.2026 07:10;1,0\n02.03.2026 07:20;4,0\n",
           "zeit,people\n2026-03-02 07:00,0\n2026-03-02 07:10,1\n2026-03-02 07:15,unavailable\n2026-03-02 07:20,4\n",
           "entity_id,state,last_changed\nsensor.n,0,2026-03-02T07:00:00.000Z\nsensor.n,1,2026-03-02T07:10:00.000Z\n"
           "sensor.n,4,2026-03-02T07:20:00.000Z\n",
           "Date,Time,people\n03/02/2026,7:00 AM,0\n03/02/2026,7:10 AM,1\n03/02/2026,7:20 AM,4\n03/13/2026,7:20 AM,\n",
       }) {
    CAPTURE(text);
    const CountsSpec counts = *occupancy_of(text).counts;
    CHECK(counts.begin == "2026-03-02T07:00:00");
    CHECK(counts.times_s == std::vector{0.0, 600.0, 1200.0});
    CHECK(counts.people == std::vector{0, 1, 4});
  }
  refused_occupancy("time,people\n03/02/2026 07:00,0\n03/02/2026 07:10,1\n",
                    "c.csv:2:1: error: '03/02/2026 07:00' can be two dates");
  refused_occupancy("a,b,people\n2026-03-02 07:00,2026-03-02 07:00,0\n", "say `time: COLUMN` in the script");
  refused_occupancy("entity_id,state,last_changed\nsensor.n,0,2026-03-02T07:00Z\nsensor.m,1,2026-03-02T07:10Z\n",
                    "c.csv:3:1: error: rows of more than one entity: keep those of one entity_id");
}

TEST_CASE("Places and positions read what logs read") {
  for (const char* text : {"time_s,id,x,z\n10,a,1.5,-1\n11,a,1.5,-1\n", "time_s;id;x;z\n10;a;1,5;-1\n11;a;1,5;-1\n"}) {
    CAPTURE(text);
    const PositionsSpec positions = *occupancy_of(text, "positions: c.csv").positions;
    REQUIRE(positions.tracks.size() == 1);
    CHECK(positions.tracks[0].times_s == std::vector{10.0, 11.0});
    CHECK(positions.tracks[0].points[0].x == 1.5);
  }
  const std::string semicolons = "time;id;x;z\n02.03.2026 07:00:00;a;1,5;-1\n02.03.2026 07:00:01;a;1,5;-1\n";
  CHECK(occupancy_of(semicolons, "positions: c.csv").positions->begin == "2026-03-02T07:00:00");
  const std::string diary = "time;person;seat\n1772434800;a;S1\n1772434801;a;S1\n";
  CHECK(occupancy_of(diary, "places: c.csv").places->begin == "2026-03-02T07:00:00");
}

TEST_CASE("What is wrong with counts is told with its line and column") {
  refused_occupancy("time,people\n2026-03-02T07:00,0\n2026-03-02T07:01,-1\n",
                    "c.csv:3:18: error: expected a number of people");
  refused_occupancy("time,people\n2026-03-02T07:00,0\n2026-03-02T07:01,1.5\n",
                    "c.csv:3:18: error: expected a number of people");
  refused_occupancy("time,people\n2026-03-02T07:00,0\n2026-03-02T06:59,1\n", "c.csv:3:1: error: time runs backwards");
  refused_occupancy("time,people\n2026-03-02T07:00,0\n2026-03-02T07:00,1\n",
                    "c.csv:3:18: error: another number for the same");
  refused_occupancy("time,people\n2026-03-02T07:00,0\n34,1\n", "c.csv:3:1: error: expected a local date and time");
  refused_occupancy("time,people\n1,0\nnoon,1\nnight,1\n",
                    "c.csv:3:1: error: expected seconds, or a local date and time, e.g. "
                    "2026-03-02T07:00:00, got 'noon'; 1 more like this");
  refused_occupancy("time,people\n", "c.csv:1:1: error: expected at least one reading");
  refused_occupancy("when,people\n1,0\n",
                    "no column `time`, `time_s` or `t`, nor `Date` and `Time`; there are when, people");
  refused_occupancy("time,n\n1,0\n",
                    "which column tells the number of people? Say `people: COLUMN` in the script; there are");
  refused_occupancy("time,people\n1,0\n", "column 'peple' is missing (did you mean 'people'?)",
                    "counts: c.csv, people: peple");
  refused_occupancy("replicate,time_s,people\n1,1,0\n1,2,0\n2,1,0\n", "c.csv:4:1: error: rows of more than one run");
  refused_occupancy("time,people\n1,0\n", "s.yaml:2:21: error: occupancy: there is no file", "counts: nowhere.csv");
  refused_occupancy("time,people\n1,0\n2,5000\n", "expected a number of people, 0 to 1000, got '5000'");
}

TEST_CASE("Nobody is in two places at once") {
  refused_occupancy("time_s,person,seat\n1,a,S1\n1,b,S2\n2,a,S1\n2,a,S3\n2,b,S2\n",
                    "c.csv:5:1: error: 'a' has another row of this time: nobody is in two places at once",
                    "places: c.csv");
  refused_occupancy("time_s,person,seat\n1,a,S1\n2,,S2\n", "c.csv:3:3: error: person: expected a name",
                    "places: c.csv");
  refused_occupancy("time_s,id,x,z,x_m\n1,a,3,-1,3\n", "columns 'x_m' and 'x' mean the same", "positions: c.csv");
  refused_occupancy("time_s,id,x,z\n1,a,3,-1\n2,,3,-1\n", "c.csv:3:3: error: id: expected a name", "positions: c.csv");
  CHECK(occupancy_of("time_s,person,seat\n1,a,S1\n1,b,S1\n2,a,S1\n3,a,S2\n", "places: c.csv").places->stays.size() ==
        3);
  ScriptSpec script = script_of({});
  PlacesSpec& places = script.trials.front().occupancy.emplace().places.emplace();
  places.stays = {
      {"a", "S1", 0.0, 60.0, {}, {}, {}}, {"b", "S2", 0.0, 60.0, {}, {}, {}}, {"a", "S2", 50.0, 90.0, {}, {}, {}}};
  CHECK_THROWS_WITH(compile(shipped_scene("meeting_room.gltf"), script),
                    contains("occupancy.places: 'a' is in two places at once, from second 50 on"));
}

TEST_CASE("What can't be in an occupancy is refused with its place") {
  const std::string hour = "time,people\n2026-03-02T07:00,0\n2026-03-02T08:00,2\n";
  refused_occupancy(hour, "s.yaml:2:13: error: occupancy: unknown key 'count' (did you mean 'counts'?)",
                    "count: c.csv");
  refused_occupancy(hour, "s.yaml:2:12: error: occupancy: expected one of `counts`, `places` and `positions`",
                    "style: natural");
  refused_occupancy(hour, "occupancy: 1 different people, but up to 2 are there at once", "counts: c.csv, persons: 1");
  refused_occupancy(hour, "`to` is not after `from`", "counts: c.csv, from: '09:00', to: '08:00'");
  refused_occupancy(hour, "the data have no reading between `from` and `to` of any day",
                    "counts: c.csv, from: '10:00'");
  refused_occupancy("time,people\n0,0\n10,1\n", "the data have seconds alone: add `begin`",
                    "counts: c.csv, from: '10:00'");
  refused_occupancy(hour, "say when runs begin: leave out `begin`", "counts: c.csv, from: '06:00'",
                    "begin: 2026-03-02T07:00\n");
  refused_occupancy(hour, "the data end at 2026-03-02T08:00:00, and the run begins at 2026-03-02T09:00:00",
                    "counts: c.csv", "begin: 2026-03-02T09:00\n");
  refused_occupancy(hour, "a schedule says who is there as well: leave out one of them", "counts: c.csv",
                    "schedule: {staff: [{count: 1}]}\n");
  refused_occupancy("time,people\n2026-01-01T00:00,0\n2026-12-31T00:00,1\n",
                    "the data last for 364 days, and a run at most 115");
}

TEST_CASE("A run goes from the first reading to the last, from `begin`, or is one of the days that have readings") {
  const std::string data =
      "time,people\n2026-03-02T07:00,0\n2026-03-02T08:00,2\n2026-03-04T12:00,1\n2026-03-05T06:00,1\n";
  const OccupancyRuns all = runs_of(occupancy_of(data), "");
  CHECK(all.clock->text(0.0) == "2026-03-02T07:00:00");
  CHECK(all.duration_s == (2 * 24 + 23) * 3600.0);
  CHECK(all.begins_s == std::vector{0.0});
  const std::string noon = "2026-03-02T12:00";
  const OccupancyRuns later = runs_of(occupancy_of(data, "counts: c.csv", "begin: " + noon + "\n"), noon);
  CHECK(later.clock->text(0.0) == noon + ":00");
  CHECK(later.duration_s == (2 * 24 + 18) * 3600.0);
  CHECK(later.begins_s == std::vector{5 * 3600.0});
  const OccupancyRuns days = runs_of(occupancy_of(data, "counts: c.csv, from: '06:30', to: '20:00'"), "");
  CHECK(days.clock->text(0.0) == "2026-03-02T06:30:00");
  CHECK(days.duration_s == 13.5 * 3600.0);
  CHECK(days.begins_s == std::vector{-1800.0, 2 * 86400.0 - 1800.0});  // nothing is known of the 3rd, nor of the 5th
  const OccupancyRuns seconds = runs_of(occupancy_of("time_s,people\n1,0\n60,1\n"), "");
  CHECK(!seconds.clock);
  CHECK(seconds.duration_s == 60.0);
}

TEST_CASE("Replicates are the days of the data in turn") {
  const Files files("time,people\n2026-03-02T07:00,0\n2026-03-04T07:10,1\n");
  ScriptSpec script =
      files.script("counts: c.csv, from: '07:00', to: '07:15'", "replicates: 3\nsensing: {tick_rate_hz: 10}\n");
  const Model model = compile(shipped_scene("meeting_room.gltf"), script);
  std::vector<std::string> first, phases;
  for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
    const RunResult result = run_once(model, run);
    CHECK(result.samples.size() == 15 * 60);
    first.push_back(result.samples.front().clock);
    phases.push_back(result.samples[11 * 60].phase);
  }
  CHECK(first == std::vector<std::string>{"2026-03-02T07:00:01", "2026-03-04T07:00:01", "2026-03-02T07:00:01"});
  CHECK(phases == std::vector<std::string>{"empty", "occupied", "empty"});
}

TEST_CASE("More people than a room holds, and seats that it lacks, are refused with the reading") {
  const Files files("time,people\n0,0\n60,300\n120,2\n");
  const SceneSpec room = shipped_scene("meeting_room.gltf");
  CHECK_THROWS_WITH(compile(room, files.script("counts: c.csv")),
                    contains("c.csv:3:4: error: 300 people, but meeting_room.gltf holds"));
  files.write("c.csv", "time,people\n0,0\n60,3\n");
  CHECK_THROWS_WITH(compile(room, files.script("counts: c.csv, seats: [S11]")),
                    contains("occupancy: seat 'S11' is not in meeting_room.gltf (did you mean 'S1'?)"));
  CHECK_THROWS_WITH(compile(room, files.script("counts: c.csv, entrances: [dor]")),
                    contains("occupancy: entrance 'dor' is not in meeting_room.gltf (did you mean 'door'?)"));
}

TEST_CASE("An occupancy that a program made is checked as a file's is") {
  const auto fault = [](const CountsSpec& counts) {
    ScriptSpec script = script_of({});
    script.trials.front().occupancy.emplace().counts = counts;
    try {
      static_cast<void>(compile(shipped_scene("meeting_room.gltf"), script));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CountsSpec good;
  good.times_s = {0.0, 60.0};
  good.people = {0, 1};
  CHECK(fault(good) == "accepted");
  CountsSpec bad = good;
  bad.people = {0};
  CHECK_THAT(fault(bad), contains("script.trials[0].occupancy.counts: expected as many numbers as times"));
  bad = good;
  bad.times_s = {60.0, 60.0};
  CHECK_THAT(fault(bad), contains("occupancy.counts: expected times that ascend"));
  bad = good;
  bad.people = {0, -1};
  CHECK_THAT(fault(bad), contains("occupancy.counts: a number of people is below 0"));
  bad = good;
  bad.begin = "yesterday";
  CHECK_THAT(fault(bad), contains("expected the date and time of second 0"));
}
