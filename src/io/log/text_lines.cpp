#include "io/log/text_lines.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/text.hpp"
#include "io/log/log_units.hpp"
#include "io/log/stamp.hpp"

namespace pirsim::io {
namespace {

constexpr std::string_view publishes = "MQTT publish: topic '", with_payload = "', payload '";

/// What stands between two texts; none if one of them isn't there.
std::optional<std::string_view> between(std::string_view text, std::string_view begin, std::string_view end) {
  const std::size_t from = text.find(begin);
  if (from == std::string_view::npos) return std::nullopt;
  text.remove_prefix(from + begin.size());
  const std::size_t to = text.find(end);
  return to == std::string_view::npos ? std::nullopt : std::optional(text.substr(0, to));
}

/// Terminals' colours, "ESC[0;36m", left out.
std::string without_colours(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const std::size_t at = std::min(text.find("\x1B["), text.size());
    plain += text.substr(0, at);
    text.remove_prefix(at);
    if (!text.empty()) text.remove_prefix(std::min(text.find('m'), text.size() - 1) + 1);
  }
  return plain;
}

/// The time of day of "[08:37:08.123][D][...".
std::optional<std::int64_t> esphome_time(std::string_view text) {
  const std::size_t end = text.find("][");
  if (!text.starts_with('[') || end == std::string_view::npos || text.find("][", end + 3) != end + 3)
    return std::nullopt;
  const auto stamp = parse_stamp(text.substr(1, end - 1), LogMap::Dates::found);
  return stamp && stamp->kind == Stamp::Kind::time_of_day ? std::optional(stamp->us) : std::nullopt;
}

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

/// "2026-01-25 10:20:47" out of what stands before a message, with its fraction and its offset if it has them.
std::string_view time_in(std::string_view text) {
  constexpr std::string_view pattern = "dddd-dd-dd?dd:dd:dd";
  const auto matches = [](char c, char wanted) {
    return wanted == 'd' ? c >= '0' && c <= '9' : wanted == '?' ? c == 'T' || c == ' ' : c == wanted;
  };
  for (std::size_t at = 0; at + pattern.size() <= text.size(); ++at) {
    if (!std::ranges::equal(text.substr(at, pattern.size()), pattern, matches)) continue;
    const std::string_view rest = text.substr(at + pattern.size());
    std::size_t more = std::min(rest.find_first_not_of(".0123456789Z"), rest.size());
    if (more < rest.size() && (rest[more] == '+' || rest[more] == '-'))
      more = std::min(rest.find_first_not_of("0123456789:", more + 1), rest.size());
    return text.substr(at, pattern.size() + more);
  }
  return text.substr(std::min(text.find_first_not_of(' '), text.size()));  // which the timer refuses by name
}

std::string quoted_field(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

constexpr std::array<std::string_view, 3> properties{"occupancy", "presence", "motion"};

/// The state that a value of JSON tells.
std::string state_of(const nlohmann::json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
  if (value.is_null()) return "unknown";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

std::optional<TextLines::Writer> TextLines::writer_of(std::span<const HeadLine> head) {
  for (const HeadLine& line : head) {
    if (has(line.text, publishes) || has(line.text, "\tz2m:") || has(line.text, "Zigbee2MQTT:"))
      return Writer::zigbee2mqtt;
    if (has(line.text, "] [openhab.") || has(line.text, "] [org.openhab.") || has(line.text, "StateChangedEvent"))
      return Writer::openhab;
    if (esphome_time(without_colours(line.text))) return Writer::esphome;
  }
  return std::nullopt;
}

std::string_view TextLines::name() const {
  switch (writer_) {
    case Writer::openhab:
      return "openHAB's log";
    case Writer::zigbee2mqtt:
      return "Zigbee2MQTT's log";
    case Writer::esphome:
      break;
  }
  return "ESPHome's log";
}

void TextLines::read(const HeadLine& line, std::vector<HeadLine>& rows, LogRemarks& remarks) {
  const Changes changes = changes_in(without_colours(line.text), line.line, remarks);
  if (changes.empty()) ++n_other_;
  for (const Change& change : changes) {
    rows.push_back({change.time + '\t' + quoted_field(change.sensor) + '\t' + quoted_field(change.state), line.line});
  }
}

namespace {

/// "2024-01-31 18:02:11.123 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Hall' changed from OFF to ON", in
/// old versions without Item and quotes, of groups with "through" and a member behind it, in new ones with a source.
std::optional<std::array<std::string, 3>> openhab_change(std::string_view text) {
  constexpr std::string_view message = "] - ", changed = " changed from ", to = " to ";
  const std::size_t at = text.find(message), from = text.find(changed);
  if (at == std::string_view::npos || from == std::string_view::npos || from < at + message.size()) return std::nullopt;
  const std::string_view before = text.substr(0, at);
  if (!has(before, "StateChangedEvent")) return std::nullopt;
  std::string_view name = text.substr(at + message.size(), from - at - message.size());
  if (name.starts_with("Item '") && name.ends_with('\'')) name = name.substr(6, name.size() - 7);
  std::string_view state = text.substr(from + changed.size());
  for (const std::string_view tail : {" through ", " (source: "}) state = state.substr(0, state.rfind(tail));
  const std::size_t last = state.rfind(to);
  if (last == std::string_view::npos) return std::nullopt;
  state.remove_prefix(last + to.size());
  if (state == "UNDEF" || state == "NULL") state = "unknown";
  return std::array{std::string(before.substr(0, before.find(" ["))), std::string(name), std::string(state)};
}

}  // namespace

TextLines::Changes TextLines::changes_in(std::string_view text, int line, LogRemarks& remarks) {
  if (writer_ == Writer::zigbee2mqtt) return of_zigbee2mqtt(text);
  if (writer_ == Writer::esphome) return of_esphome(text, line, remarks);
  const auto change = openhab_change(text);
  return change ? Changes{{(*change)[0], (*change)[1], (*change)[2]}} : Changes{};
}

/// "... MQTT publish: topic 'zigbee2mqtt/hall', payload '{"occupancy":true}'": of the device's properties those that
/// tell motion. With `output: attribute` each has a topic of its own. A device that is offline isn't known.
TextLines::Changes TextLines::of_zigbee2mqtt(std::string_view text) {
  const auto topic = between(text, publishes, with_payload);
  if (!topic) return {};
  const std::string time(time_in(text.substr(0, text.find(publishes))));
  std::string_view payload = text.substr(text.find(with_payload) + with_payload.size());
  payload = payload.substr(0, payload.rfind('\''));
  std::string device(topic->substr(topic->find('/') + 1));  // without the base topic; npos + 1 is 0
  const nlohmann::json message = nlohmann::json::parse(payload, nullptr, false);
  const std::size_t slash = device.rfind('/');
  const std::string last = slash == std::string::npos ? std::string() : device.substr(slash + 1);
  std::map<std::string, std::string> states;
  if (last == "availability") {
    device.resize(slash);
    if (!has(payload, "offline")) return {};
    for (const auto& [property, told] : told_[device]) states[property] = "unavailable";
  } else if (std::ranges::find(properties, last) != properties.end() && !message.is_object()) {
    device.resize(slash);
    states[last] = message.is_discarded() ? std::string(payload) : state_of(message);
  } else if (message.is_object()) {
    for (const std::string_view property : properties) {
      if (const auto found = message.find(property); found != message.end())
        states[std::string(property)] = state_of(*found);
    }
  }
  Changes changes;
  for (const auto& [property, state] : states) {
    Change& before = told_[device][property];
    Change now{time, device + '_' + property, state};
    if (before == now) continue;  // another property changed in this second
    before = now;
    changes.push_back(std::move(now));
  }
  return changes;
}

/// "[08:37:08][D][binary_sensor:036]: 'Hall PIR': Sending state ON", or "'Hall PIR' >> ON".
TextLines::Changes TextLines::of_esphome(std::string_view text, int line, LogRemarks& remarks) {
  const auto us = esphome_time(text);
  if (!us) return {};
  std::string time = since_first_midnight(*us, line, remarks);  // of all lines, since a day may pass without motion
  const std::size_t tag = text.find("][binary_sensor:");
  const std::size_t begin = text.find('\'', std::min(tag, text.size())), end = text.rfind('\'');
  if (begin == std::string_view::npos || end <= begin) return {};
  const std::string_view state = text.substr(text.find_last_of(' ') + 1);
  if (state != "ON" && state != "OFF" && state != "UNKNOWN") return {};
  return {{std::move(time), std::string(text.substr(begin + 1, end - begin - 1)), std::string(state)}};
}

/// Lines stand in the order in which they were written, so that a clock that steps back begins a day.
std::string TextLines::since_first_midnight(std::int64_t us, int line, LogRemarks& remarks) {
  constexpr std::int64_t a_jitter_us = 60 * us_per_s, an_hour_twice_us = 7200 * us_per_s;  // assumed
  const std::int64_t back_us = last_us_ - us;
  if (back_us > a_jitter_us) {
    days_us_ += us_per_day;
    if (back_us < an_hour_twice_us) {
      remarks.add(
          "day turns",
          [&] {
            return Where{file_, line, 0};
          },
          [&] {
            return "the times step back by " + fixed(static_cast<double>(back_us) / (60.0 * us_per_s), 0) +
                   " min: it counts as the next day, unless clocks were put back here";
          });
    }
  }
  last_us_ = us;
  return fixed(static_cast<double>(days_us_ + us) / us_per_s, 6);
}

}  // namespace pirsim::io
