// `style: natural` and activities in scripts.
#include <fstream>

#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;

namespace {

std::string script(const std::string& style) {
  return "pirsim_script: 1\npeople:\n  - id: a\n" + style +
         "    actions:\n"
         "      - enter: door\n"
         "      - {walk: {to_xz_m: [[1, 2]], activity: phone}}\n"
         "      - {wait: {duration_s: 30, activity: whiteboard}}\n"
         "      - wait_s: 4\n"
         "      - sit: S1\n"
         "      - {work: {duration_s: 60, activity: reading}}\n"
         "      - {work: {duration_s: 60}}\n";
}

ScriptSpec read_style(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "s.yaml") << text;
  return io::read_script(folder.path() / "s.yaml");
}

std::string style_fault(const std::string& text) {
  try {
    static_cast<void>(read_style(text));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

void check_activities(const PersonSpec& person) {
  CHECK(person.style == MotionStyle::natural);
  CHECK(std::get<action::Walk>(person.actions[1].what).activity == Activity::phone);
  CHECK(std::get<action::Wait>(person.actions[2].what).activity == Activity::whiteboard);
  CHECK(std::get<action::Wait>(person.actions[2].what).duration_s == 30.0);
  CHECK_FALSE(std::get<action::Wait>(person.actions[3].what).activity);
  CHECK(std::get<action::Work>(person.actions[5].what).activity == Activity::reading);
  CHECK_FALSE(std::get<action::Work>(person.actions[6].what).activity);
}

}  // namespace

TEST_CASE("people of natural style say what they are busy with, and walk faster than the paper's") {
  const ScriptSpec natural = read_style(script("    style: natural\n"));
  check_activities(natural.trials.front().people.front());
  CHECK(natural.trials.front().people.front().walking_speed_m_s == 1.2);
  CHECK(read_style(script("    style: natural\n    walking_speed_m_s: 0.9\n"))
            .trials.front()
            .people.front()
            .walking_speed_m_s == 0.9);
  check_activities(read_style(io::to_yaml(natural)).trials.front().people.front());
}

TEST_CASE("an activity that nobody would see is refused with its line, and so is an unknown one") {
  for (const char* style : {"", "    style: choreographed\n"}) {
    const std::string text = style_fault(script(style));
    CHECK_THAT(text, contains("needs `style: natural`"));
    CHECK_THAT(text, contains(*style == '\0' ? "s.yaml:6:" : "s.yaml:7:"));
    CHECK_THAT(text, contains(*style == '\0' ? "s.yaml:7:" : "s.yaml:8:"));
  }
  std::string text = script("    style: natural\n");
  text.replace(text.find("whiteboard"), 10, "blackboard");
  CHECK_THAT(style_fault(text), contains("blackboard"));
}

TEST_CASE("an action refuses the activities of others, and lists its own") {
  const auto told = [](const std::string& was, const std::string& is) {
    std::string text = script("    style: natural\n");
    text.replace(text.find(was), was.size(), is);
    return style_fault(text);
  };
  CHECK_THAT(told("activity: reading", "activity: whiteboard"),
             contains("s.yaml:11:") && contains("activity: expected one of typing, reading, meeting, phone, got"));
  CHECK_THAT(told("activity: reading", "activity: readin"), contains("(did you mean 'reading'?)"));
  CHECK_THAT(told("activity: whiteboard", "activity: typing"),
             contains("activity: expected one of meeting, phone, whiteboard, reading, sleeping, watching_tv, cooking, "
                      "washing, eating, got"));
  CHECK_THAT(told("activity: phone", "activity: meeting"), contains("activity: expected phone, got"));
}
