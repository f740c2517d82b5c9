// Every form of a log that is read.
#include "pirsim/log.hpp"
#include "support/catch.hpp"
#include "support/log_files.hpp"

using namespace pirsim;
using Texts = std::vector<std::string>;

namespace {

std::string first_time(const Log& log) { return to_text(LogWindows(log, 1.0).begin(0), log.clock); }

}  // namespace

TEST_CASE("wide logs: times, bits and separators as loggers, spreadsheets and pandas write them") {
  const Texts expected{"0110", "0011"};
  for (const char* text :
       {"time,A,B\n2025-04-06T18:00:01,0,0\n2025-04-06T18:00:02,1,0\n2025-04-06T18:00:03,1,1\n2025-04-06T18:00:04,0,"
        "1\n",
        "time_s;A;B\r\n1,0;0,0;0,0\r\n2,0;1,0;0,0\r\n3,0;1,0;1,0\r\n4,0;0,0;1,0\r\n",
        "timestamp\tA\tB\n1743962401\toff\toff\n1743962402\ton\toff\n1743962403\ton\ton\n1743962404\toff\ton\n",
        "ts,A,B\n1743962401000,False,False\n1743962402000,True,False\n1743962403000,True,True\n1743962404000,False,"
        "True\n",
        "\"time\",\"A\",\"B\"\n\"2025-04-06 18:00:01\",\"0\",\"0\"\n\"2025-04-06 18:00:02\",\"1\",\"0\"\n"
        "\"2025-04-06 18:00:03\",\"1\",\"1\"\n\"2025-04-06 18:00:04\",\"0\",\"1\"\n",
        "sep=,\nTime,A,B\n0:00:01,0,0\n0:00:02,1,0\n0:00:03,1,1\n0:00:04,0,1\n",
        "\xEF\xBB\xBFtime,A,B\n06.04.2025 18:00:01,0,0\n06.04.2025 18:00:02,1,0\n06.04.2025 18:00:03,1,1\n06.04.2025 "
        "18:00:04,0,1"}) {
    const Log log = read_log_text(text);
    CAPTURE(text);
    CHECK(sensors_of(log) == Texts{"A", "B"});
    CHECK(log.has_readings());
    CHECK(log.interval_us == 1'000'000);
    CHECK(windows_of(log, 1.0) == expected);
    CHECK(log.remarks.empty());
  }
}

TEST_CASE("columns of areas are neither sensors nor the count of all people") {
  for (const char* text : {"time,people_hall,people,people_den,A\n2025-04-06T18:00:01,0,1,1,0\n"
                           "2025-04-06T18:00:02,1,2,1,1\n2025-04-06T18:00:03,0,0,0,0\n",
                           "time_s,people,people_hall,people_den,A\n1,1,0,1,0\n2,2,1,1,1\n3,0,0,0,0\n"}) {
    const Log log = read_log_text(text);
    CAPTURE(text);
    CHECK(sensors_of(log) == Texts{"A"});
    CHECK(LogWindows(log, 1.0).rows().people == std::vector<std::int32_t>{1, 2, 0});
  }
  CHECK_FALSE(read_log_text("time_s,people_hall,A\n1,1,0\n2,2,1\n").people);
}

TEST_CASE("the published occupancy readings, and as a spreadsheet saves them again") {
  const Log published = read_log_text(
      "Date,Time,S1_Temp,S1_Light,S5_CO2_Slope,S6_PIR,S7_PIR,Room_Occupancy_Count\n"
      "2017/12/22,23:59:34,24.94,0,0.77,0,0,1\n2017/12/23,00:00:04,24.94,0,0.65,0,1,1\n2017/12/"
      "23,00:00:34,25,0,0.5,1,0,2\n");
  const Log saved = read_log_text(
      "Date,Time,S1_Temp,S1_Light,S5_CO2_Slope,S6_PIR,S7_PIR,Room_Occupancy_Count\n"
      "12/22/2017,11:59:34 PM,24.94,0,0.77,0,0,1\n12/23/2017,12:00:04 "
      "AM,24.94,0,0.65,0,1,1\n12/23/2017,0:00:34,25,0,0.5,1,0,2\n");
  for (const Log* log : {&published, &saved}) {
    CHECK(sensors_of(*log) == Texts{"S6_PIR", "S7_PIR"});
    CHECK(log->others == Texts{"S1_Temp", "S1_Light", "S5_CO2_Slope"});
    const LogRows rows = LogWindows(*log, 30.0).rows();
    CHECK(to_text(rows.begin.front(), rows.clock) == "2017-12-22T23:59:30");
    CHECK(windows_of(*log, 30.0) == Texts{"001", "010"});
    CHECK(rows.people == std::vector<std::int32_t>{1, 1, 2});
  }
}

TEST_CASE("rows and a dataset's day of pirsim itself") {
  const Log rows = read_log_text(
      "replicate,trial,time_s,phase,people,PIR1,PIR2\n1,S1,1,walking,0,0,0\n1,S1,2,walking,1,1,0\n1,S1,3,working,1,0,"
      "0\n");
  CHECK(sensors_of(rows) == Texts{"PIR1", "PIR2"});
  CHECK(rows.clock == LogClock::elapsed);
  CHECK(LogWindows(rows, 1.0).rows().people == std::vector<std::int32_t>{0, 1, 1});
  const Log day = read_log_text(
      "room,day,time,time_s,people,presence,arrivals,departures,PIR1\n"
      "1,1,2026-03-02T08:00:30,30,0,0,0,0,0\n1,1,2026-03-02T08:01:00,60,1,1,1,0,1\n1,1,2026-03-02T08:01:30,90,1,1,0,0,"
      "\n");
  CHECK(sensors_of(day) == Texts{"PIR1"});
  CHECK(first_time(day) == "2026-03-02T08:00:29");
  CHECK(windows_of(day, 30.0) == Texts{"01."});
  CHECK_THROWS_WITH(
      read_log_text("replicate,trial,time_s,phase,people,PIR1\n1,S1,1,a,0,0\n1,S1,2,a,0,1\n1,S2,1,a,0,0\n"),
      contains("log.csv:4:1: error: another run begins here"));
}

TEST_CASE("events of Home Assistant: sensors by name, states unknown until told") {
  const Log log = read_log_text(
      "entity_id,state,last_changed\n"
      "binary_sensor.corner_motion,off,2025-04-06T17:59:00.000Z\n"
      "binary_sensor.corner_motion,on,2025-04-06T18:00:02.500Z\n"
      "binary_sensor.corner_motion,off,2025-04-06T18:00:04.000Z\n"
      "binary_sensor.hall_motion,unavailable,2025-04-06T18:00:00.000Z\n"
      "binary_sensor.hall_motion,off,2025-04-06T18:00:03.000Z\n"
      "light.hall,on,2025-04-06T18:00:03.100Z\n"
      "sensor.hall_temperature,21.5,2025-04-06T18:00:05.000Z\n");
  CHECK(sensors_of(log) == Texts{"binary_sensor.corner_motion", "binary_sensor.hall_motion"});
  CHECK(log.others == Texts{"light.hall", "sensor.hall_temperature"});
  CHECK(log.clock == LogClock::zoned);
  const Texts windows = windows_of(log, 1.0);
  CHECK(windows[0].substr(58) == "0000110.");  // on from 18:00:02.5 until :04
  CHECK(windows[1].substr(58) == ".....00.");  // the last window isn't over when the log ends
}

TEST_CASE("events of CASAS, with activities and lines of other sensors") {
  for (const std::string between : {" ", "\t"}) {
    std::string text =
        "2010-11-04 00:00:01.5 M003 ON Sleeping begin\n2010-11-04 00:00:03 M003 OFF\n"
        "2010-11-04 00:00:03.2 T002 21.5\n2010-11-04 00:00:04 M004 ON\n2010-11-04 00:00:04.1 D001 OPEN\n"
        "2010-11-04 00:00:06 M004 OFF\n";
    for (std::size_t at = 0; (at = text.find(' ', at)) != std::string::npos; ++at) text.replace(at, 1, between);
    const Log log = read_log_text(text);
    CHECK(sensors_of(log) == Texts{"M003", "M004"});
    CHECK(log.n_other_rows == 2);
    CHECK(windows_of(log, 1.0) == Texts{"11000.", "...11."});
  }
}

TEST_CASE("any table of time, sensor and state") {
  for (const char* text :
       {"when,who,what\n2025-04-06 18:00:00,A,0\n2025-04-06 18:00:01,A,1\n2025-04-06 18:00:02,B,0\n2025-04-06 "
        "18:00:03,A,0\n2025-04-06 18:00:03,B,1\n",
        "state;sensor;time\noff;A;100\non;A;101\noff;B;102\noff;A;103\non;B;103\n",
        "1743962400,A,clear\n1743962401,A,motion\n1743962402,B,clear\n1743962403,A,clear\n1743962403,B,motion\n"}) {
    const Log log = read_log_text(text);
    CAPTURE(text);
    CHECK(sensors_of(log) == Texts{"A", "B"});
    // The window in which the log ends is known where motion is in it.
    Texts windows = windows_of(log, 1.0);
    CHECK(windows == Texts{"011.", "..01"});
  }
}

TEST_CASE("a wide log that has a row whenever something changes") {
  const char* text =
      "time,A,B\n2025-04-06T18:00:00,0,0\n2025-04-06T18:00:02,1,0\n2025-04-06T18:00:03,1,1\n2025-04-06T18:00:30,0,1\n"
      "2025-04-06T18:00:31,0,0\n2025-04-06T18:02:00,1,0\n2025-04-06T18:02:01,0,0\n2025-04-06T18:02:40,0,1\n2025-04-"
      "06T18:03:00,0,0\n";
  const Log log = read_log_text(text);
  CHECK_FALSE(log.has_readings());
  CHECK(windows_of(log, 30.0) == Texts{"100010.", "110001."});
}

TEST_CASE("rows of changes with a count") {
  LogMap map;
  map.rows = LogMap::Rows::changes;
  const Log log = read_log_text("time_s,door,note,people\n0,0,a,0\n5,1,b,0\n7,1,c,2\n9,0,d,2\n20,0,e,1\n", map);
  CHECK(sensors_of(log) == Texts{"door"});
  CHECK(log.others == Texts{"note"});
  const LogRows rows = LogWindows(log, 5.0).rows();
  CHECK(windows_of(log, 5.0) == Texts{"0100."});
  CHECK(rows.people == std::vector<std::int32_t>{0, 2, 2, 2, -1});
}

TEST_CASE("a map says which column is which sensor, and an entity that counts") {
  LogMap map;
  map.sensors = {{"PIR2", "hall"}, {"PIR1", "corner"}};
  map.people = "counter";
  const Log log = read_log_text(
      "entity,state,time\ncorner,off,0\nhall,off,0\ncounter,0,0\nlamp,on,1\ncounter,2,2\nhall,on,2\ncounter,unknown,"
      "4\nhall,off,5\n",
      map);
  CHECK(sensors_of(log) == Texts{"PIR2", "PIR1"});
  CHECK(windows_of(log, 1.0) == Texts{"00111.", "00000."});
  CHECK(LogWindows(log, 1.0).rows().people == std::vector<std::int32_t>{0, 0, 2, 2, -1, -1});
  map.sensors = {{"PIR1", "korner"}};
  CHECK_THROWS_WITH(read_log_text("entity,state,time\ncorner,off,0\ncorner,on,1\n", map),
                    contains("no events of 'korner' (did you mean 'corner'?)"));
}

TEST_CASE("several files are one log: days of all sensors, or a file a sensor") {
  const TemporaryFolder folder;
  const auto read = [](std::vector<std::filesystem::path> files) { return io::read_log(files); };
  const auto first = folder.write("1.csv", "time_s,A,B\n1,0,1\n2,1,1\n"),
             second = folder.write("2.csv", "time_s,A,B\n3,0,1\n4,1,0\n");
  CHECK(windows_of(read({second, first}), 1.0) == Texts{"0101", "1110"});
  const auto late = folder.write("3.csv", "time_s,A,B\n7,0,1\n8,1,0\n");
  CHECK(windows_of(read({first, late}), 1.0) == Texts{"01....01", "11....10"});
  const auto other = folder.write("4.csv", "time_s,C\n2,0\n3,1\n");
  CHECK(windows_of(read({first, other}), 1.0) == Texts{"01.", "11.", ".01"});
  CHECK_THROWS_WITH(read({first, folder.write("5.csv", "time_s,A\n2,0\n3,1\n")}),
                    contains("it overlaps another file in time"));
  const auto monday = folder.write("6.txt", "2010-11-04 23:59:58 M1 OFF\n2010-11-04 23:59:59 M1 ON\n"),
             tuesday = folder.write("7.txt", "2010-11-05 00:00:01 M1 OFF\n2010-11-05 00:00:03 M1 ON\n");
  CHECK(windows_of(read({tuesday, monday}), 1.0) == Texts{"011001"});
  CHECK_THROWS_WITH(read({first, monday}), contains("another form than the first file"));
}
