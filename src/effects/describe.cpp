#include "core/text.hpp"
#include "effects/catalogue.hpp"

#include <algorithm>
#include <array>
#include <iomanip>
#include <sstream>
#include <utility>

namespace pirsim::effects {
namespace {

std::string with_unit(double value, const std::string& unit) {
  std::ostringstream out;
  out << value << (unit.empty() ? "" : " ") << unit;
  return out.str();
}

std::string range_of(const ParameterInfo& parameter) {
  std::ostringstream out;
  out << parameter.low;
  if (parameter.low != parameter.high) out << " to " << parameter.high;
  if (!parameter.unit.empty()) out << ' ' << parameter.unit;
  if (parameter.scale == Scale::logarithmic) out << ", logarithmic";
  return out.str();
}

/// What a script may say.
std::string limits_of(const ParameterInfo& parameter) {
  std::ostringstream out;
  out << parameter.least << " to " << parameter.most;
  if (!parameter.unit.empty()) out << ' ' << parameter.unit;
  return out.str();
}

std::string off_of(const ParameterInfo& parameter) {
  return parameter.role == Role::detail ? "-" : with_unit(parameter.off, parameter.unit);
}

/// Of the range, and with which choice the parameter means anything.
std::string source_of(const ParameterInfo& parameter) {
  const auto& [choice, word] = parameter.only_if;
  return choice.empty() ? parameter.source : parameter.source + "; only with " + choice + ": " + word;
}

std::string values_of(const ChoiceInfo& choice) {
  if (choice.kind == ChoiceKind::sensor) return "a sensor's name";
  if (choice.kind == ChoiceKind::mesh) return "a mesh's name";
  return joined(choice.words, ", ");
}

std::string in_script(const Effect& effect) {
  std::ostringstream out;
  out << "- " << effect.info.name << ": {";
  std::string separator;
  for (const ParameterInfo& parameter : effect.info.parameters) {
    if (parameter.role == Role::detail || !applies(parameter, {effect.info.name, {}, {}, {}})) continue;
    out << separator << parameter.name << ": " << parameter.typical;
    separator = ", ";
  }
  out << '}';
  return out.str();
}

std::string same_as_sentence(const EffectInfo& info) {
  return "The same change of the model as " + info.same_as + ": reconcile judges both as one, by that name.";
}

/// With which the name of a parameter in that unit ends.
std::string_view suffix_of(const std::string& unit) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> suffixes{{{"m", "_m"},
                                                                                   {"s", "_s"},
                                                                                   {"deg", "_deg"},
                                                                                   {"K", "_k"},
                                                                                   {"Hz", "_hz"},
                                                                                   {"%", "_percent"},
                                                                                   {"1/s", "_per_s"},
                                                                                   {"m/s", "_m_s"}}};
  const auto* found = std::ranges::find(suffixes, unit, [](const auto& entry) { return entry.first; });
  return found == suffixes.end() ? std::string_view() : found->second;
}

std::string spaced(std::string text) {
  std::ranges::replace(text, '_', ' ');
  return text;
}

void add_markdown(std::ostream& out, const Effect& effect) {
  const EffectInfo& info = effect.info;
  out << "### " << info.name << '\n' << info.summary << "\n\n";
  out << "Fingerprint: " << info.fingerprint << ".\n";
  if (!info.confused_with.empty()) out << "Easily taken for: " << joined(info.confused_with, ", ") << ".\n";
  if (!info.same_as.empty()) out << same_as_sentence(info) << "\n";
  if (!info.in_analog.empty()) out << "With analog sensors: " << info.in_analog << ".\n";
  out << '\n';
  for (const ParameterInfo& parameter : info.parameters) {
    out << "- `" << parameter.name << "` (";
    if (parameter.role != Role::detail) out << "off " << off_of(parameter) << ", ";
    out << "typical " << with_unit(parameter.typical, parameter.unit) << "): prior " << range_of(parameter)
        << "; accepted " << limits_of(parameter) << "; " << source_of(parameter) << '\n';
  }
  for (const ChoiceInfo& choice : info.choices) {
    out << "- `" << choice.name << "`: ";
    if (is_word(choice.kind)) out << values_of(choice) << "; ";
    out << "default " << choice.otherwise << '\n';
  }
  out << '\n';
}

}  // namespace

std::string phrase_of(const ParameterInfo& parameter) {
  if (!parameter.phrase.empty()) return parameter.phrase;
  std::string_view name = parameter.name;
  const std::string_view suffix = suffix_of(parameter.unit);
  if (name.ends_with(suffix)) name.remove_suffix(suffix.size());
  return spaced(std::string(name));
}

std::string phrase_of(const ChoiceInfo& choice, const std::string& value) {
  return spaced(choice.name) + " " + (is_word(choice.kind) ? spaced(value) : value);
}

std::string list_text() {
  std::ostringstream out;
  for (const Effect* effect : catalogue()) {
    out << std::left << std::setw(18) << effect->info.name << std::setw(13) << name(effect->info.family);
    const ParameterInfo& strength = effect->info.parameters.front();
    const std::string range = range_of(strength);
    out << std::setw(46)
        << (strength.name + " (off " + off_of(strength) + "; " + range.substr(0, range.find(',')) + ")")
        << effect->info.summary << '\n';
  }
  return out.str();
}

std::string to_text(const Effect& effect) {
  const EffectInfo& info = effect.info;
  std::ostringstream out;
  out << info.name << " (" << name(info.family) << ")\n" << info.summary << "\n\n";
  out << "fingerprint:      " << info.fingerprint << '\n';
  out << "easily taken for: " << joined(info.confused_with, ", ") << '\n';
  if (!info.same_as.empty()) out << "in data:          " << same_as_sentence(info) << '\n';
  if (!info.in_analog.empty()) out << "analog sensors:   " << info.in_analog << '\n';
  out << "acts in:          " << info.stage << " (" << name(info.reach) << ")\n\nparameters:\n";
  for (const ParameterInfo& parameter : info.parameters) {
    out << "  " << std::left << std::setw(16) << parameter.name << "off " << std::setw(8) << off_of(parameter)
        << "typical " << std::setw(10) << with_unit(parameter.typical, parameter.unit) << "prior "
        << range_of(parameter) << "\n                  accepted: " << limits_of(parameter)
        << "\n                  source: " << source_of(parameter) << '\n';
  }
  for (const ChoiceInfo& choice : info.choices) {
    out << "  " << std::left << std::setw(16) << choice.name << values_of(choice) << " (else: " << choice.otherwise
        << ")\n";
  }
  out << "\nin a script:\n  effects:\n    " << in_script(effect) << '\n';
  return out.str();
}

std::string list_markdown() {
  std::ostringstream out;
  constexpr std::array families{Family::optics,      Family::person,      Family::mounting, Family::occlusion,
                                Family::electronics, Family::environment, Family::motion,   Family::data};
  for (const Family family : families) {
    out << "## " << name(family) << '\n';
    for (const Effect* effect : catalogue()) {
      if (effect->info.family == family) add_markdown(out, *effect);
    }
  }
  return out.str();
}

}  // namespace pirsim::effects
