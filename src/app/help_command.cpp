#include <iostream>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "pirsim/error.hpp"

namespace pirsim::app {
namespace {

CLI::App& find_command(CLI::App& parent, const std::string& name) {
  for (CLI::App* command : parent.get_subcommands(nullptr)) {
    if (command->check_name(name)) return *command;
  }
  const std::string owner = spoken_name(parent);
  throw Error(ErrorCode::usage, "help: '" + name + "' isn't a command" + (owner.empty() ? "" : " of '" + owner + "'") +
                                    did_you_mean(name, offered_commands(parent)));
}

/// CLI::App::help() would tell of the command that was called, which is `help`.
void print_help(CLI::App& app, const std::vector<std::string>& names) {
  CLI::App* command = &app;
  std::string spoken = app.get_name();
  for (const std::string& name : names) {
    command = &find_command(*command, name);
    spoken += ' ' + name;
  }
  std::cout << command->get_formatter()->make_help(command, spoken, CLI::AppFormatMode::Normal);
  require_written();
}

}  // namespace

void add_help_command(CLI::App& app) {
  CLI::App& command = add_command(app, "help", "options and examples of a command", R"(
  pirsim help                                                      as pirsim --help
  pirsim help reconcile plan                                       as pirsim reconcile plan --help
)");
  const auto names = std::make_shared<std::vector<std::string>>();
  command.add_option("command", *names, "which command (default: pirsim itself)")->option_text("CMD");
  command.callback([&app, names] { print_help(app, *names); });
}

}  // namespace pirsim::app
