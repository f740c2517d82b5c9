// Every map that a refusal offers is tried: the log is read with it, or refused for something else.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "pirsim/log.hpp"
#include "support/catch.hpp"
#include "support/log_files.hpp"
#include "support/paths.hpp"

using namespace pirsim;
using test::tests_dir;
using Texts = std::vector<std::string>;

namespace {

struct Provocation {
  std::string text;
  std::string keys = {};  ///< of a map that is there already
};

std::string rows(const std::string& header, int n, const std::function<std::string(int)>& line) {
  std::string text = header + '\n';
  for (int i = 0; i < n; ++i) text += line(i) + '\n';
  return text;
}
std::string epoch(int s) { return std::to_string(1772438400 + s); }
std::string bit(int i) { return std::to_string(i % 2); }
/// At no equal steps.
int at(int i) { return 41 * i + 7 * (i % 5); }

std::vector<Provocation> provocations() {
  const auto two = [](int i) { return std::string(i % 2 == 0 ? "hall" : "desk"); };
  const auto zoned = [](int i) { return "2026-03-02 07:" + std::to_string(10 + i) + ":00 CET,A," + bit(i); };
  return {
      {"time,hall_motion\n2026-03-02 07:00:00,1\n"},
      {"time,hall_motion\n2026-03-02 07:00:00,1\n2026-03-02 07:00:00,0\n2026-03-02 07:00:00,1\n"},
      {rows("time,hall_motion", 9, [](int i) { return "01/02/2026 07:0" + std::to_string(i) + ":30," + bit(i / 3); })},
      {rows("time,sensor,state", 9, zoned)},
      {rows("time,A", 40, [](int i) { return std::to_string(46083 + i / 2) + (i % 2 == 0 ? ".5," : ".7,") + bit(i); })},
      {rows("Zeit,A", 40, [](int i) { return std::to_string(46083000 + 30 * i) + ',' + bit(i / 3); })},
      {rows("", 20, [](int i) { return std::to_string(i) + ',' + std::to_string(30 * i) + ',' + bit(i / 3); })},
      {rows("time,sensor,state", 20, [](int i) { return epoch(at(i)) + ",front_door," + bit(i); })},
      {"time,sensor,state\n1970-01-01 00:00:03,A,on\n2026-03-02 07:00:00,A,off\n2026-03-02 07:01:00,A,on\n2026-03-02 "
       "07:02:00,A,off\n"},
      {"time,sensor,state\n0,people,on\n5,people,off\n9,people,on\n"},
      {rows("start,end,sensor,busy", 20,
            [&](int i) { return epoch(at(i)) + ',' + epoch(at(i) + 9) + ',' + two(i) + ',' + bit(i / 3); })},
      {rows("time,device,value", 20,
            [&](int i) { return epoch(at(i)) + ',' + two(i) + (i / 2 % 2 == 0 ? ",none" : ",pir"); })},
      {rows("time,hall", 20, [&](int i) { return epoch(17 * i * i) + (i % 2 == 0 ? ",255" : ",0"); })},
      {rows("time,device,motion,presence", 24,
            [&](int i) { return epoch(at(i)) + ',' + two(i) + ',' + bit(i / 2) + ',' + bit(i / 5); }),
       "sensor: device"},
      {rows("time,device,sensor,state", 24,
            [&](int i) { return epoch(at(i)) + ',' + two(i) + (i / 3 % 2 == 0 ? ",a," : ",b,") + bit(i / 2); })},
      {rows("time,device,motion,occupancy", 24,
            [&](int i) { return epoch(at(i)) + ',' + two(i) + ',' + bit(i / 2) + ',' + bit(i / 5); })},
      {rows("time,sensor,state", 60, [&](int i) { return epoch(i / 2 * 30) + ',' + two(i) + ',' + bit(i / 2 / 7); })},
      {rows("when,who,spot,what", 24,
            [&](int i) { return epoch(at(i)) + (i % 2 == 0 ? ",A,left," : ",B,right,") + bit(i / 2); })},
      {rows("when,who,what", 6,
            [&](int i) {
              return epoch(at(i)) + (i < 2 ? ",A," : i < 4 ? ",B," : i < 5 ? ",C," : ",D,") + bit(i);
            })},
      {rows("time,people,occupants,hall_motion", 20,
            [](int i) {
              return epoch(30 * i) + ',' + std::to_string(i / 4) + ',' + std::to_string(i / 3) + ',' + bit(i / 3);
            })},
      {rows("time,hall_motion,room_occupancy", 40,
            [](int i) { return epoch(10 * i) + ',' + bit(i / 3) + ',' + bit(i / 5); })},
      {rows("time,moving,clear", 40, [](int i) { return epoch(10 * i) + (i / 3 % 2 == 0 ? ",0,1" : ",1,0"); })},
      {rows("time,A,B", 60,
            [](int i) { return epoch(30 * i) + (i % 2 == 0 ? "," : ",1") + (i % 7 == 0 ? ",1" : ",0"); })},
      {rows("time,A", 20, [](int i) { return epoch(30 * i) + ',' + bit(i); })},
      {rows("time,sensor", 20, [](int i) { return epoch(at(i)) + ",hall"; })},
      {rows("hours,hall", 20, [](int i) { return std::to_string(0.01 * i) + ',' + bit(i / 3); })},
      {rows("time,hall", 20, [](int i) { return std::to_string(1000 * i) + ',' + bit(i / 3); })},
      {rows("when,who,one,other", 20,
            [&](int i) { return epoch(at(i)) + ',' + two(i) + (i / 2 % 2 == 0 ? ",0,1" : ",1,0"); })},
      {rows("time,device,type,state", 40,
            [&](int i) { return epoch(at(i)) + ',' + two(i) + (i % 5 < 3 ? ",motion," : ",tamper,") + bit(i / 2); })},
      {rows("time,hall_vacant", 40, [](int i) { return epoch(10 * i) + ',' + bit(i / 3); })},
  };
}

/// The maps that a refusal names.
Texts maps_in(const std::string& message) {
  Texts maps;
  for (std::size_t from = 0; (from = message.find("{pirsim_log: 1, ", from)) != std::string::npos; ++from) {
    std::size_t end = from, depth = 0;
    do {
      depth += message[end] == '{' ? 1 : 0;
      depth -= message[end] == '}' ? 1 : 0;
    } while (depth > 0 && ++end < message.size());
    maps.push_back(message.substr(from, end + 1 - from));
  }
  return maps;
}
/// Why it is refused, in front of the maps; empty if it is read.
std::string fault_of(const Provocation& log, const std::string& map) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.write("log.csv", log.text);
  try {
    static_cast<void>(io::read_log({&file, 1}, map.empty() ? LogMap{} : io::parse_log_map(map, "map")));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}
std::string map_with(const std::string& keys) { return keys.empty() ? std::string() : "{pirsim_log: 1, " + keys + "}"; }

/// Of each place in the sources that offers maps: the longest text of its message.
Texts texts_of_offers() {
  Texts texts;
  const std::regex call(R"((with_maps|refuse_with|refuse_pairs)\()"), literal(R"re("((?:[^"\\]|\\.)*)")re");
  const std::filesystem::path logs = tests_dir().parent_path() / "src/logs";
  for (const auto& file : std::filesystem::directory_iterator(logs)) {
    if (file.path().extension() != ".cpp") continue;
    std::ifstream in(file.path());
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text = std::regex_replace(text, std::regex("\"\\n *\""), "");  // one text in two lines
    for (std::sregex_iterator at(text.begin(), text.end(), call), end; at != end; ++at) {
      const auto from = static_cast<std::size_t>(at->position());
      const std::string statement = text.substr(from, text.find(";\n", from) - from);
      std::string longest;
      for (std::sregex_iterator one(statement.begin(), statement.end(), literal); one != end; ++one)
        if ((*one)[1].length() > static_cast<std::ptrdiff_t>(longest.size())) longest = (*one)[1];
      if (longest.size() > 12) texts.push_back(longest);  // else it hands a message on
    }
  }
  return texts;
}

}  // namespace

TEST_CASE("every map that a refusal offers settles it") {
  Texts messages;
  for (const Provocation& log : provocations()) {
    const std::string message = fault_of(log, map_with(log.keys));
    CAPTURE(message, log.text.substr(0, 200));
    CHECK_FALSE(message.empty());
    const Texts maps = maps_in(message);
    CHECK_FALSE(maps.empty());
    std::size_t n_read = 0;
    for (const std::string& map : maps) {
      const std::string next = fault_of(log, map);
      CAPTURE(map, next);
      n_read += next.empty() ? 1 : 0;
      CHECK(next.substr(0, 60) != message.substr(0, 60));
    }
    CHECK(n_read > 0);
    messages.push_back(message);
  }
}

TEST_CASE("each place that offers a map is provoked") {
  Texts messages;
  for (const Provocation& log : provocations()) messages.push_back(fault_of(log, map_with(log.keys)));
  const Texts texts = texts_of_offers();
  CHECK(texts.size() >= 20);
  for (const std::string& text : texts) {
    CAPTURE(text);
    CHECK(std::ranges::any_of(messages, [&](const std::string& one) { return one.find(text) != std::string::npos; }));
  }
}
