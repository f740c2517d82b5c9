// Which delay to take.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/text.hpp"
#include "pirsim/control.hpp"

namespace pirsim::control {
namespace {

constexpr double days_a_week = 7.0;

/// Below which a Poisson mean lies in 95 of 100 cases, n events seen [WilsonHilferty1931]; within 1 %.
double most_expected(std::int64_t n) {
  constexpr double normal_95 = 1.6449;
  const double k = static_cast<double>(n) + 1.0;
  return k * std::pow(1.0 - 1.0 / (9.0 * k) + normal_95 / (3.0 * std::sqrt(k)), 3.0);
}

double a_week(const LightCosts& light, const DelayCosts& at) {
  return days_a_week * light.a_day(static_cast<double>(at.false_offs));
}
/// Days differ, and few events tell little: whichever is wider.
double at_most_a_week(const LightCosts& light, const DelayCosts& at) {
  const auto& over_days = at.false_offs_an_hour.over_days;
  const double by_days = over_days ? over_days->high * light.occupied_h : 0.0;
  return days_a_week * light.a_day(std::max(by_days, most_expected(at.false_offs)));
}

std::string minutes(const DelayCosts& at) { return shortest_number(at.delay_min) + " min"; }
std::string hours(double h) {
  const double s = std::round(3600.0 * h);
  return s < 60.0 ? fixed(s, 0) + " s" : h < 0.1 ? fixed(s / 60.0, 1) + " min" : fixed(h, 1) + " h";
}
std::string allowed(const LightCosts& light) {
  const double times = light.at_most_a_week;
  return "less than " + (times == 1.0 ? "once" : shortest_number(times) + " times") + " a week";
}
std::string often(double a_week) {
  if (a_week == 0.0) return "not once";
  return a_week < days_a_week ? fixed(a_week, 1) + " times a week" : fixed(a_week / days_a_week, 1) + " times a day";
}

/// To compare a delay with: the rule's, or else the next shorter one that people know; none for the shortest.
const DelayCosts* other_than(const LightCosts& light, double delay_min) {
  constexpr std::array usual{1.0, 5.0, 10.0, 15.0, 20.0, 30.0, 60.0};
  if (light.rule_delays_min.front() != delay_min) return &light.at(light.rule_delays_min.front());
  const auto above = std::ranges::lower_bound(usual, delay_min);
  return above == usual.begin() ? nullptr : &light.at(*(above - 1));
}

/// From which on all hold.
template <typename Holds>
const DelayCosts* first_of_rest(const LightCosts& light, Holds holds) {
  const DelayCosts* first = nullptr;
  for (auto at = light.by_delay.rbegin(); at != light.by_delay.rend() && holds(*at); ++at) first = &*at;
  return first;
}

std::string empty_light(const LightCosts& light, const DelayCosts& at) {
  return hours(light.a_day(at.lit_empty_h)) + " of empty light a day";
}

std::string compared(const LightCosts& light, const DelayCosts& at) {
  const DelayCosts* other = other_than(light, at.delay_min);
  if (other == nullptr) return ".";
  return "; at " + minutes(*other) + " " + often(a_week(light, *other)) + ", and " +
         hours(light.a_day(other->lit_empty_h)) + ".";
}

/// What is off can't go off.
std::string dark_all_the_same(const DelayCosts& at) {
  constexpr double worth_a_word = 0.05;  // assumed (0.01 to 0.2)
  if (at.dark_share.value < worth_a_word) return {};
  return " Somebody is in the dark for " + percent(at.dark_share.value) + " of their time all the same.";
}

std::string shown(const LightCosts& light, const DelayCosts& at) {
  return minutes(at) + ": off on somebody " + allowed(light) + ", " + empty_light(light, at) + compared(light, at) +
         dark_all_the_same(at);
}

std::string best_guess(const LightCosts& light, const DelayCosts& at) {
  const double enough = std::ceil(days_a_week / light.at_most_a_week * most_expected(0));
  const std::string seen =
      at.false_offs == 0 ? "no false-off" : counted(static_cast<std::size_t>(at.false_offs), "false-off");
  const double days = std::round(10.0 * light.known_days) / 10.0;
  const std::string data = days < 1.0    ? hours(24.0 * light.known_days) + " is too little"
                           : days == 1.0 ? "1 day is too little"
                                         : shortest_number(days) + " days are too few";
  return data + " to tell which delay goes off on somebody " + allowed(light) + ": " + fixed(enough, 0) +
         " days without a false-off would do. The best guess is " + minutes(at) + ": " + seen + " in " +
         hours(light.occupied_h) + " of occupied time, which shows less than one in " +
         hours(light.occupied_h / most_expected(at.false_offs)) + " (95 %), and " + empty_light(light, at) +
         compared(light, at) + dark_all_the_same(at);
}

std::string no_delay(const LightCosts& light) {
  const DelayCosts& longest = light.by_delay.back();
  return "no delay up to " + minutes(longest) + " keeps false-offs to " + allowed(light) + ": at " + minutes(longest) +
         " it goes off on somebody " + often(a_week(light, longest)) + ", with " + empty_light(light, longest) +
         compared(light, longest) + dark_all_the_same(longest);
}

std::string without_people(const LightCosts& light) {
  const DelayCosts& at = light.at(light.rule_delays_min.front());
  const auto costs = [&](const DelayCosts& of) {
    return hours(light.a_day(of.lit_h)) + " lit a day, switched on " + fixed(of.switched_on_a_day, 1) + " times";
  };
  const DelayCosts* other = other_than(light, at.delay_min);
  return "whom it goes off on isn't known; at " + minutes(at) + " " + costs(at) +
         (other != nullptr ? "; at " + minutes(*other) + " " + costs(*other) : "") + ".";
}

}  // namespace

Advice advise(const LightCosts& light) {
  using Ground = Advice::Ground;
  const std::string name = light.id + ": ";
  if (!(light.known_days > 0.0)) return {Ground::nobody_came, {}, name + "nothing is known: no delay can be judged."};
  if (light.people == People::unknown) return {Ground::unknown_people, {}, name + without_people(light)};
  if (!(light.occupied_h > 0.0)) return {Ground::nobody_came, {}, name + "nobody came: no delay can be judged."};
  const auto is_below = [&](auto rate) {
    return [&light, rate](const DelayCosts& at) { return rate(light, at) < light.at_most_a_week; };
  };
  if (const DelayCosts* at = first_of_rest(light, is_below(at_most_a_week)))
    return {Ground::shown, at->delay_min, name + shown(light, *at)};
  if (const DelayCosts* at = first_of_rest(light, is_below(a_week)))
    return {Ground::too_few_days, at->delay_min, name + best_guess(light, *at)};
  return {Ground::no_delay, {}, name + no_delay(light)};
}

}  // namespace pirsim::control
