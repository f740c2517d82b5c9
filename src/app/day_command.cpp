// An ordinary day, or many, from a room alone: makes a script with a schedule and runs it.
#include <iostream>
#include <memory>
#include <sstream>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "app/study_run.hpp"
#include "core/text.hpp"
#include "io/write/spec_writer.hpp"
#include "schema/household_clocks.hpp"

namespace pirsim::app {
namespace {

struct DayOptions {
  RunOptions run;
  int staff = 0;
  int residents = 0;
  int days = 5;
  std::string first_day = "2026-03-02";
  std::string from, to, cleaning;  ///< empty: 00:00, 24:00 and 19:00; a home has none of them
  enum class Meetings { none, held } meetings = Meetings::none;
  enum class Action { run, print_script } action = Action::run;
};

/// "{mean: 08:30, sd_min: 30}"
std::string written(const ClockSpec& clock) {
  return "{mean: " + io::time_of_day(clock.mean_h) + ", sd_min: " + shortest_number(clock.sd_min) + "}";
}

std::string staff_lines(int staff) {
  const ScheduleSpec usual;
  return "  staff:\n    - {role: staff, count: " + std::to_string(staff) +
         "}    # or manager, administrator; seats: [S1, ...] for desks of their own\n  arrival: " +
         written(usual.arrival) + "\n  departure: " + written(usual.departure) + "\n  lunch: " + written(usual.lunch) +
         "\n  lunch_min: " + shortest_number(usual.lunch_min) +
         "\n  lunch_sd_min: " + shortest_number(usual.lunch_sd_min) + '\n';
}

std::string meeting_lines() {
  const MeetingsSpec usual;
  const auto listed = [](const std::vector<double>& values, int decimals) {
    std::vector<std::string> words;
    for (const double value : values) words.push_back(fixed(value, decimals));
    return "[" + joined(words, ", ") + "]\n";
  };
  return "  meetings:\n    fewest_a_day: " + std::to_string(usual.fewest_a_day) +
         "\n    most_a_day: " + std::to_string(usual.most_a_day) +
         "\n    fewest_people: " + std::to_string(usual.fewest_people) +
         "                   # most_people: 8, or as many as there are seats\n    durations_min: " +
         listed(usual.durations_min, 0) + "    probabilities: " + listed(usual.probabilities, 2) +
         "    from: " + io::time_of_day(usual.from_h) + "\n    to: " + io::time_of_day(usual.to_h) +
         "\n    lateness_min: " + shortest_number(usual.lateness_min) + '\n';
}

std::string home_lines() {
  const HouseholdSpec usual;
  std::string text = "    visits_a_week: " + shortest_number(usual.visits_a_week) +
                     "                   # evenings on which somebody comes\n";
  for (const HouseholdClock& named : household_clocks) {
    text += "    " + std::string(named.key) + ": " + written(usual.*named.clock);
    text += named.clock == &HouseholdSpec::leaves ? "  # who works; who works at home begins\n" : "\n";
  }
  return text;
}

std::string given_or(const std::string& text, const char* otherwise) { return text.empty() ? otherwise : text; }

std::string office_lines(const DayOptions& options) {
  std::ostringstream text;
  text << "  from: " << given_or(options.from, "00:00")
       << "                          # the part of each day that is simulated\n"
       << "  to: " << given_or(options.to, "24:00") << '\n';
  if (options.staff > 0) text << staff_lines(options.staff);
  if (options.meetings == DayOptions::Meetings::held) text << meeting_lines();
  if (options.cleaning != "none") text << "  cleaning: " << given_or(options.cleaning, "19:00") << '\n';
  return text.str();
}

/// Every other one works.
std::string household_lines(const DayOptions& options) {
  std::ostringstream text;
  text << "  household:                           # each day goes from 04:00 to 04:00\n    residents:\n";
  for (int i = 1; i <= options.residents; ++i) {
    const bool works = i % 2 == 1;
    text << "      - {id: resident_" << i << ", occupation: " << (works ? "works" : "at_home")
         << ", age_years: " << (works ? 40 : 68) << "}" << (i == 1 ? "    # or at_home, works_at_home" : "") << '\n';
  }
  text << home_lines();
  return text.str();
}

std::string script_text(const DayOptions& options) {
  const bool is_home = options.residents > 0;
  std::ostringstream text;
  text << "# Ordinary days. Each replicate is a day, from first_day on"
       << (is_home ? ".\n" : "; nobody comes on Saturdays and Sundays.\n") << "pirsim_script: 1\n"
       << "name: "
       << (is_home             ? "days at home"
           : options.staff > 0 ? "office days"
                               : "meeting days")
       << '\n'
       << "seed: 1\n"
       << "replicates: " << options.days << '\n'
       << "schedule:\n"
       << "  first_day: " << options.first_day << '\n'
       << (is_home ? household_lines(options) : office_lines(options));
  return text.str();
}

/// What is pasted into a script must be no more than a date or a time, or a word that stands for none.
void require_plain(const std::string& option, const std::string& text) {
  if (text.find_first_not_of("0123456789:-") != std::string::npos)
    throw Error(ErrorCode::usage, option + ": '" + text + "' is not made of digits, ':' and '-' alone");
}

constexpr const char* no_file = "";  // nobody could look up a line of it

/// The faults of a script that nobody wrote, told of the options that it was made from.
void check_made_script(const std::string& text, const std::string& first_day) {
  try {
    static_cast<void>(io::parse_script(text, no_file));
  } catch (const Error& fault) {
    const std::string& message = fault.issues().front().message;
    for (const auto& [key, option] : {std::pair("first_day: ", "--first-day: "), std::pair("from: ", "--from: "),
                                      std::pair("to: ", "--to: "), std::pair("cleaning: ", "--cleaning: ")}) {
      if (message.starts_with(key)) throw Error(ErrorCode::usage, option + message.substr(std::string(key).size()));
    }
    throw Error(ErrorCode::usage, (message.starts_with("'" + first_day + "'") ? "--first-day: " : "") + message);
  }
}

void day(const Inputs& inputs, const DayOptions& options) {
  const bool is_office = options.staff > 0 || options.meetings == DayOptions::Meetings::held;
  if (!is_office && options.residents == 0)
    throw Error(ErrorCode::usage, "say who comes: --staff N, --meetings or both; or --home N, who lives there");
  const bool has_office_times = !options.from.empty() || !options.to.empty() || !options.cleaning.empty();
  if (options.residents > 0 && (is_office || has_office_times))
    throw Error(ErrorCode::usage, "--home goes without --staff, --meetings, --from, --to and --cleaning");
  require_plain("--first-day", options.first_day);
  require_plain("--from", options.from);
  require_plain("--to", options.to);
  if (options.cleaning != "none") require_plain("--cleaning", options.cleaning);
  const std::string text = script_text(options);
  check_made_script(text, options.first_day);
  ScriptSpec script = io::parse_script(text, no_file, inputs.overrides, data_directories());
  keep_inputs(inputs, files_read(script, {}));
  if (options.action == DayOptions::Action::print_script) {
    std::cout << (inputs.overrides.empty() ? text : io::to_yaml(script));
    require_written();
    return;
  }
  check_options(options.run);
  run(load(inputs, std::move(script)), inputs, options.run);
}

constexpr const char* examples = R"(
  pirsim day --scene office.gltf --staff 8 -o week.csv --report week.html     a working week of an office
  pirsim day --scene meeting_room.gltf --meetings --days 1 -o day.csv         a day of meetings
  pirsim day --scene flat.gltf --home 2 --days 7 -o week.csv                  a week of two people at home
  pirsim day --scene office.gltf --staff 8 --days 1000 --shard 3/100 -o out   a block of a thousand days
  pirsim day --scene office.gltf --staff 8 --print-script > week.yaml         to be edited; then pirsim run
)";

}  // namespace

void add_day_command(CLI::App& app) {
  CLI::App& command = add_command(app, "day", "run ordinary days of an office, a meeting room or a home", examples);
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<DayOptions>();
  offer_scene(command, *inputs);
  offer_verbose(command, inputs->verbosity);
  offer_tracer(command, *inputs);
  offer_seed(command, *inputs);
  command.add_option("--staff", options->staff, "how many people have a desk in the room")
      ->option_text("N")
      ->check(CLI::Range(0, 200));
  command.add_flag_callback(
      "--meetings", [options] { options->meetings = DayOptions::Meetings::held; },
      "people from elsewhere meet in the room, on the seats that are nobody's desk");
  command.add_option("--home", options->residents, "how many people live there; every other one goes to work")
      ->option_text("N")
      ->check(CLI::Range(1, 5));
  command.add_option("--days", options->days, "how many days follow each other (default: 5)")
      ->option_text("N")
      ->check(CLI::Range(1, 10000000));
  command.add_option("--first-day", options->first_day, "default: 2026-03-02, a Monday")->option_text("DATE");
  command.add_option("--from", options->from, "time of day at which each run begins (default: 00:00)")
      ->option_text("TIME");
  command.add_option("--to", options->to, "time of day at which each run ends (default: 24:00)")->option_text("TIME");
  command.add_option("--cleaning", options->cleaning, "about when somebody cleans, or none (default: 19:00)")
      ->option_text("TIME");
  offer_run_options(command, std::shared_ptr<RunOptions>(options, &options->run));
  command.add_flag_callback(
      "--print-script", [options] { options->action = DayOptions::Action::print_script; },
      "print the script that this makes and stop");
  on_call(
      command, inputs, [options](const Inputs& given) { day(given, *options); }, Needs::scene);
}

}  // namespace pirsim::app
