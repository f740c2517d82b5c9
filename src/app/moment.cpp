#include "app/moment.hpp"

#include "io/files/atomic_file.hpp"
#include "pirsim/error.hpp"

namespace pirsim::app {
namespace {

constexpr RunClock any_clock{};

/// As long as the run has a clock where it is a time of day.
std::optional<double> seconds_of(const std::string& text, const std::optional<RunClock>& clock) {
  if (const auto seconds = io::parse_number<double>(text); seconds && *seconds >= 0.0) return seconds;
  return clock ? clock->run_seconds(text) : elapsed_seconds(text);
}

std::string expected(const std::string& text) {
  return "expected seconds or H:MM:SS since the run began, or a time of day as its rows have it (19:00), not '" + text +
         "'";
}

}  // namespace

void offer_moment(CLI::App& command, const std::string& name, std::string& text, const std::string& what,
                  const std::string& otherwise) {
  const auto check = [](std::string& given) {
    return seconds_of(given, std::nullopt) || seconds_of(given, any_clock) ? std::string() : expected(given);
  };
  command
      .add_option(name, text,
                  what + ": seconds or H:MM:SS since the run began, or a time of day as its rows have it (default: " +
                      otherwise + ")")
      ->option_text("TIME")
      ->check(CLI::Validator(check, "", "moment"));
}

double moment(const std::string& option, const std::string& text, const std::optional<RunClock>& clock) {
  if (const auto seconds = seconds_of(text, clock)) return *seconds;
  if (clock || !seconds_of(text, any_clock)) throw Error(ErrorCode::usage, option + ": " + expected(text));
  throw Error(ErrorCode::usage, option + ": '" + text +
                                    "' is a time of day, and this study has no clock: add `begin: 2026-03-02T00:00` " +
                                    "to its script, or give seconds or H:MM:SS since the run began");
}

}  // namespace pirsim::app
