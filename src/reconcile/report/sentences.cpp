#include "reconcile/report/sentences.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "core/text.hpp"
#include "effects/catalogue.hpp"

namespace pirsim::reconcile {

std::string enumerated(const std::vector<std::string>& names, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " " + last + " " : ", ") + names[i];
  }
  return text;
}

std::string short_number(double value) {
  std::ostringstream out;
  out << std::setprecision(3) << value;
  return out.str();
}

std::string p_in_words(double p, double least_p) {
  return (least_p > 0.0 && p <= least_p ? "p <= " : "p = ") + short_number(p);
}

std::string with_unit(double value, const std::string& unit) {
  const std::string number = short_number(value);
  if (unit.empty()) return number;
  return number + (unit.starts_with("1/") ? " per " + unit.substr(2) : " " + unit);
}

std::string fixed(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str() == "-0" ? "0" : out.str();
}

std::string rivals_in_words(const FittedEffect& fitted, const std::string& choice, const std::string& value) {
  constexpr double as_likely = 0.2;  // assumed: what is less probable isn't worth telling
  std::vector<std::string> rivals;
  for (const FittedChoice& fit : fitted.choices) {
    if (fit.name != choice) continue;
    for (const auto& [word, probability] : fit.words) {
      if (word == value || probability < as_likely) continue;
      rivals.push_back((word.empty() ? "all" : word) + ", probability " + fixed(probability, 2));
    }
  }
  return rivals.empty() ? "" : " (or " + joined(rivals, "; or ") + ")";
}

std::string name_in_words(const FittedEffect& fitted) {
  std::string text = fitted.effect.name;
  for (const std::string& twin : effects::twins_of(fitted.effect.name))
    text += " (or " + twin + ", the same in the model)";
  return text;
}

std::string strength_in_words(const FittedEffect& fitted) {
  const effects::EffectInfo& info = effects::find(fitted.effect.name).info;
  std::vector<std::string> told;
  for (const FittedParameter& p : fitted.parameters) {
    const auto parameter = std::ranges::find(info.parameters, p.name, &effects::ParameterInfo::name);
    told.push_back(effects::phrase_of(*parameter) + " " + with_unit(p.value, p.unit) +
                   (told.empty() ? " (90 % interval " : " (") + short_number(p.interval.low) + " to " +
                   short_number(p.interval.high) + ")");
  }
  for (const auto& [name, value] : fitted.effect.choices) {
    const auto choice = std::ranges::find(info.choices, name, &effects::ChoiceInfo::name);
    told.push_back(effects::phrase_of(*choice, value) + rivals_in_words(fitted, name, value));
  }
  return joined(told, ", ") + (fitted.includes_off ? ", so uncertain that the interval includes no effect" : "");
}

std::string in_words(const FittedEffect& fitted) {
  const std::string strength = strength_in_words(fitted);
  return name_in_words(fitted) + (strength.empty() ? "" : ": " + strength);
}

std::string in_words(const Look& look) {
  std::string text = "With " + enumerated(look.applied, "and") + " applied, the model " +
                     (look.passes() ? "can have made these data" : "still differs from the data") + " (" +
                     p_in_words(look.p, look.least_p) + ").";
  if (look.one_of.size() == 1) text += " What is missing beside it may be " + look.one_of.front() + ".";
  if (look.one_of.size() > 1)
    text += " What is missing beside it may be " + enumerated(look.one_of, "or") + ": these data can't tell.";
  return text;
}

std::vector<Candidate> with_twins(const std::vector<Candidate>& candidates) {
  std::vector<Candidate> all;
  for (const Candidate& candidate : candidates) {
    all.push_back(candidate);
    for (const std::string& twin : effects::twins_of(candidate.score.hypothesis)) {
      const auto is_twin = [&](const Candidate& other) { return other.score.hypothesis == twin; };
      if (std::ranges::any_of(candidates, is_twin)) continue;  // it was asked for
      all.push_back(candidate);
      all.back().score.hypothesis = twin;
      all.back().reason = reason::SameAs{candidate.score.hypothesis};
      all.back().named_together = false;
    }
  }
  return all;
}

}  // namespace pirsim::reconcile
