#include "app/log_inputs.hpp"

#include <iostream>

#include "app/long_work.hpp"
#include "app/session.hpp"
#include "io/files/input.hpp"
#include "io/pages/log_text.hpp"

namespace pirsim::app {

void offer_log(CLI::App& command, LogInputs& log) {
  CLI::Option* files = as_input(command.add_option("--log", log.files, "the log; several files are parts of one"))
                           ->option_text("FILE")
                           ->required();
  declare_inputs(command, files, log.files);
  offer_input_file(command, "--map", log.map, "what the log's columns mean (pirsim log --print-map)");
  command.add_option("--time-zone", log.time_zone, "where the room is, as Europe/Berlin: for times of day")
      ->option_text("ZONE");
}

std::vector<std::string> words_of(const LogInputs& log) {
  std::vector<std::string> words{"--log"};
  for (const std::filesystem::path& file : log.files) words.push_back(typed(file));
  if (!log.map.empty()) words.insert(words.end(), {"--map", typed(log.map)});
  if (!log.time_zone.empty()) words.insert(words.end(), {"--time-zone", log.time_zone});
  return words;
}

Log read_log(const LogInputs& inputs, Verbosity verbosity) {
  LogMap map = inputs.map.empty() ? LogMap{} : io::read_log_map(inputs.map);
  if (!inputs.time_zone.empty()) map.time_zone = inputs.time_zone;
  Log log = [&] {
    const Progress progress({.what = "reading the log"}, verbosity);
    const StopRequest stop;
    return io::read_log(inputs.files, map, {[&](std::uint64_t) { stop.throw_if_made(); }});
  }();
  if (log.clock == LogClock::zoned && map.time_zone.empty()) {
    log.remarks.push_back({Severity::warning, Where{inputs.files.front().string()},
                           "its times tell an offset, and no zone is named: hours of the day are taken as they are "
                           "written; name the room's zone (--time-zone Europe/Berlin)"});
  }
  if (verbosity != Verbosity::quiet)
    std::cerr << io::name_of_input(inputs.files.front()) << " is read as " << io::form_in_words(log) << '\n';
  tell(log.remarks, verbosity);
  return log;
}

}  // namespace pirsim::app
