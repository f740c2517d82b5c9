#include "io/read/reader_parts.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "io/read/yaml_map.hpp"
#include "schema/action_facts.hpp"

namespace pirsim::io {
namespace {

Vec2 read_point(const YamlNode& node, Diagnostics& faults, std::string_view what) {
  const std::vector<double> xz = read_numbers(node, faults, what, accepted::on_floor_m);
  if (xz.size() == 2) return {xz[0], xz[1]};
  if (node.is_list()) faults.error(node.where(), std::string(what) + ": expected two numbers, x and z");
  return Vec2(0.0);
}

Action read_wait_s(const YamlNode& node, Diagnostics& faults) {
  action::Wait wait;
  each_number(wait, [&](const char*, double& value, const NumberRange& range) {
    value = node.number(faults, "wait_s", range);
  });
  return wait;
}
Action read_wait(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "wait");
  action::Wait wait;
  map.require("duration_s");
  read_fields(map, wait);
  map.finish();
  return wait;
}
Action read_appear(const YamlNode& node, Diagnostics& faults) {
  action::Appear appear;
  if (!node.is_map()) {
    appear.place = node.text(faults, "appear");
    return appear;
  }
  YamlMap map(node, faults, "appear");
  if (map.has("place")) {
    appear.place = map.required_text("place");
    appear.posture = map.choice("posture", appear.posture,
                                words_of<LyingPosture, LyingPosture>(field_of<&action::Appear::posture>()));
  } else {
    appear.point = read_point(map.required_child("at_xz_m"), faults, "at_xz_m");
    read_numbers(map, appear);
  }
  map.finish();
  return appear;
}
Action read_enter(const YamlNode& node, Diagnostics& faults) { return action::Enter{node.text(faults, "enter")}; }
Action read_walk(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "walk");
  action::Walk walk;
  for (const YamlNode& point : map.required_list("to_xz_m", limits::walk_points))
    walk.points.push_back(read_point(point, faults, "to_xz_m"));
  read_fields(map, walk);
  map.finish();
  return walk;
}
Action read_sit(const YamlNode& node, Diagnostics& faults) {
  if (!node.is_map()) return action::Sit{node.text(faults, "sit")};
  YamlMap map(node, faults, "sit");
  action::Sit sit;
  sit.seat = map.required_text("seat");
  read_fields(map, sit);
  map.finish();
  return sit;
}
/// Of who goes to a place: its name, or a map with more.
template <typename What>
Action read_place(const YamlNode& node, Diagnostics& faults, const char* name) {
  What what;
  if (!node.is_map()) {
    what.place = node.text(faults, name);
    return what;
  }
  YamlMap map(node, faults, name);
  what.place = map.required_text("place");
  read_fields(map, what);
  map.finish();
  return what;
}
Action read_lie(const YamlNode& node, Diagnostics& faults) { return read_place<action::Lie>(node, faults, "lie"); }
Action read_stand(const YamlNode& node, Diagnostics& faults) {
  return read_place<action::Stand>(node, faults, "stand");
}
Action read_work(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "work");
  action::Work work;
  read_fields(map, work);
  map.finish();
  return work;
}
Action read_rise(const YamlNode& node, Diagnostics& faults) {
  if (!node.is_null() && !node.is_scalar()) faults.error(node.where(), "rise: expected nothing");
  return action::Rise{};
}
Action read_turn(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "turn");
  action::Turn turn;
  map.require("heading_deg");
  read_numbers(map, turn);
  map.finish();
  return turn;
}
Action read_leave(const YamlNode& node, Diagnostics& faults) { return action::Leave{node.text(faults, "leave")}; }

Action read_follow(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "follow");
  action::Follow follow;
  for (const YamlNode& row : map.required_list("t_x_z", limits::walk_points)) {
    const std::vector<double> numbers = read_numbers(row, faults, "t_x_z");
    if (numbers.size() != 3 && numbers.size() != 4) {
      if (row.is_list()) faults.error(row.where(), "t_x_z: expected three numbers, t, x and z, or four with a heading");
      continue;
    }
    follow.times_s.push_back(numbers[0]);
    follow.points.emplace_back(numbers[1], numbers[2]);
    if (numbers.size() == 4) follow.headings_deg.push_back(numbers[3]);
  }
  const std::string fault = follow_fault(follow.times_s, follow.points, follow.headings_deg);
  if (!fault.empty() && !faults.has_errors()) faults.error(map.where("t_x_z"), "t_x_z: " + fault);
  map.finish();
  return follow;
}

enum class Form { scalar, map, either };

struct ActionKind {
  const char* key;
  Action (*read)(const YamlNode&, Diagnostics&);
  Form form;
  const char* example;
};
constexpr std::array<ActionKind, 13> kinds{
    {{"wait_s", read_wait_s, Form::scalar, "{wait_s: 60}"},
     {"wait", read_wait, Form::map, "{wait: {duration_s: 60}}"},
     {"appear", read_appear, Form::either, "{appear: bed}"},
     {"enter", read_enter, Form::scalar, "{enter: door, at: \"09:00\"}"},
     {"walk", read_walk, Form::map, "{walk: {to_xz_m: [[1, -2], [3, -2]]}}"},
     {"sit", read_sit, Form::either, "{sit: S1, at: \"09:00\"}"},
     {"lie", read_lie, Form::either, "{lie: bed, at: \"23:00\"}"},
     {"stand", read_stand, Form::either, "{stand: stove, at: \"12:00\"}"},
     {"work", read_work, Form::map, "{work: {duration_s: 180}}"},
     {"rise", read_rise, Form::scalar, "{rise: , at: \"10:00\"}"},
     {"turn", read_turn, Form::map, "{turn: {heading_deg: 90}}"},
     {"leave", read_leave, Form::scalar, "{leave: door, at: \"17:00\"}"},
     {"follow", read_follow, Form::map, "{follow: {t_x_z: [[0, 1, -2], [5, 3, -2]]}}"}}};

/// A value of another form than the action takes is told with an example.
Action read_value(const ActionKind& kind, const YamlNode& value, Diagnostics& faults) {
  Diagnostics told;
  Action action = kind.read(value, told);
  const bool fits = (value.is_map() && kind.form != Form::scalar) || (value.is_scalar() && kind.form != Form::map);
  for (const Issue& issue : told.issues()) {
    const bool is_of_form = !fits && issue.where == value.where();
    faults.error(issue.where, issue.message + (is_of_form ? std::string("; for example ") + kind.example : ""));
  }
  return action;
}

std::vector<std::string> action_names() {
  std::vector<std::string> names;
  for (const ActionKind& kind : kinds) names.emplace_back(kind.key);
  return names;
}

/// The nearest name, or else all that there are.
std::string hint(const std::string& name) {
  const std::vector<std::string> names = action_names();
  std::string text = did_you_mean(name, names);
  if (!text.empty()) return text;
  for (const std::string& known : names) text += (text.empty() ? "; known are " : ", ") + known;
  return text;
}

/// The moment of the run that `at` names. The caller knows that the action has it.
std::optional<double> read_at(YamlMap& map, const ScriptTime& time) {
  Diagnostics& faults = map.faults();
  const std::string text = map.text("at");
  const auto refuse = [&](const std::string& why) {
    faults.error(map.where("at"), "at: " + why);
    return std::nullopt;
  };
  if (map.has("at_s")) return refuse("stands beside at_s, and an action begins once: leave out one of them");
  if (!time.clock) {
    constexpr const char* why =
        "the script has no clock: add `begin: 2026-03-02T00:00`, the date and time at which a run begins, at its top, "
        "or write at_s, the seconds since a run began";
    return refuse(why);
  }
  const auto at_s = time.clock->run_seconds(text);
  if (!at_s) return refuse("expected a time of day, e.g. 06:45, or a date and a time, e.g. 2026-03-03T06:45");
  if (time.day_s) {
    if (text.find('-') != std::string::npos)
      return refuse("with a schedule every run is another day: leave out the date");
    if (*at_s > *time.day_s)
      return refuse(text + " isn't between the schedule's `from` and `to`, the part of a day that is simulated");
  }
  if (*at_s < 0.0) return refuse(text + " is before the run begins, at " + time.clock->text(0.0));
  if (!accepted::at_s.holds(*at_s)) return refuse(text + " is more than 115 days after the run begins");
  return at_s;
}

bool stands_beside_an_action(const std::string& key) { return key == "at_s" || key == "at" || key == "phase"; }

ScriptedAction read_action_map(const YamlNode& node, const ScriptTime& time, Diagnostics& faults) {
  YamlMap map(node, faults, "action");
  ScriptedAction action;
  action.where = node.where();
  action.at_s = map.optional_number("at_s", accepted::at_s);
  static_cast<void>(map.text("at"));  // known, so that finish() can suggest it
  if (map.has("at")) action.at_s = read_at(map, time);
  action.phase = map.text("phase");
  int found = 0;
  for (const ActionKind& kind : kinds) {
    if (!map.has(kind.key)) {
      static_cast<void>(map.child(kind.key));  // known, so that finish() can suggest it
      continue;
    }
    action.where = map.where(kind.key);
    action.what = read_value(kind, *map.child(kind.key), faults);
    ++found;
  }
  const std::vector<YamlKey> keys = node.keys();
  if (found == 0 && keys.size() == 1 && !stands_beside_an_action(keys[0].name)) {
    faults.error(keys[0].where, "'" + keys[0].name + "' isn't an action" + hint(keys[0].name));
    return action;
  }
  map.finish();
  if (found > 1) faults.error(node.where(), "one action per entry: start each with its own '-'");
  const bool nothing_else = std::ranges::all_of(keys, stands_beside_an_action, &YamlKey::name);
  if (found == 0 && nothing_else && (node.is_map() || node.is_null()))
    faults.error(node.where(), "an action is missing, e.g. `sit: S1`");
  return action;
}

}  // namespace

ScriptedAction read_action(const YamlNode& node, const ScriptTime& time, Diagnostics& faults) {
  if (!node.is_scalar()) return read_action_map(node, time, faults);
  const std::string word = node.text(faults, "action");
  if (word != "rise") {
    const bool is_known = std::ranges::any_of(kinds, [&](const ActionKind& kind) { return kind.key == word; });
    faults.error(node.where(), "'" + word + "' " +
                                   (is_known ? "needs a value: `" + word + ": ...`" : "isn't an action" + hint(word)));
  }
  return {action::Rise{}, std::nullopt, {}, node.where()};
}

}  // namespace pirsim::io
