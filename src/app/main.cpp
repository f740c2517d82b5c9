#include <unistd.h>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <string_view>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "engine/rt/room.hpp"
#include "pirsim/error.hpp"
#include "pirsim/version.hpp"

// pirsim's command line: argv -> a command, and errors -> messages and exit codes.

namespace {

using namespace pirsim;
using namespace pirsim::app;

constexpr const char* first_steps = R"(Examples:
  pirsim --scene room.gltf --script study.yaml                     rows of the whole study as CSV on stdout
  pirsim --scene room.gltf --script study.yaml -o rows.csv --summary table.md
  pirsim check --scene room.gltf --script study.yaml               validate, and report what each sensor can see
  pirsim help run                                                  options and examples of a command
)";

std::string version_text() {
  return program() + ", " + compiler() + ", Embree " + rt::embree_version() + " " + rt::instruction_set();
}

/// An empty text, as of a script's unset variable, is no value.
void refuse_empty_words(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const bool is_unset = word.starts_with("--") && word.find('=') == word.size() - 1;
    if (!word.empty() && !is_unset) continue;
    throw Error(ErrorCode::usage, "an empty text stands behind '" + std::string(is_unset ? word : argv[i - 1]) + "'");
  }
}

int run_command_line(int argc, char** argv) {
  refuse_empty_words(argc, argv);
  Command app{"Headless simulator of passive-infrared motion sensors", "pirsim"};
  app.formatter(help_formatter());
  app.footer(first_steps);
  app.set_version_flag("-V,--version", version_text);
  app.require_subcommand(0, 1);
  app.failure_message(explain);
  for (const auto add : all_commands) add(app);
  pass_options_on(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : static_cast<int>(ErrorCode::usage);
  }
  return 0;
}

/// Libraries may allocate where they must not throw, as nlohmann's destructor does: that ends here.
[[noreturn]] void end_without_memory() {
  try {
    if (const std::exception_ptr fault = std::current_exception()) std::rethrow_exception(fault);
  } catch (const std::bad_alloc&) {
    constexpr std::string_view message = "error: out of memory\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
    std::_Exit(static_cast<int>(ErrorCode::internal));
  } catch (...) {
  }
  std::abort();
}

}  // namespace

int main(int argc, char** argv) {
  std::set_terminate(end_without_memory);
  std::signal(SIGPIPE, SIG_IGN);  // so that unfinished files are removed first
  try {
    return run_command_line(argc, argv);
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
  } catch (const ClosedPipe&) {
    std::signal(SIGPIPE, SIG_DFL);  // `pirsim ... | head` ends quietly
    std::raise(SIGPIPE);
  } catch (const std::bad_alloc&) {
    std::cerr << "error: out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << "error: internal fault: " << error.what() << '\n';
  }
  return static_cast<int>(ErrorCode::internal);
}
