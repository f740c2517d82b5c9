#include "app/gnuplot_runner.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>

#include "app/session.hpp"

namespace pirsim::app {
namespace {

/// Whether gnuplot ran the program to its end.
bool runs(const std::string& program) {
  // A gnuplot that isn't there or gives up must not end us with SIGPIPE.
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  bool done = false;
  if (std::FILE* pipe = ::popen("exec gnuplot 2>/dev/null", "w")) {
    const bool written = std::fwrite(program.data(), 1, program.size(), pipe) == program.size();
    done = ::pclose(pipe) == 0 && written;
  }
  std::signal(SIGPIPE, before);
  return done;
}

}  // namespace

void draw(const std::vector<std::string>& gnuplot_programs, Verbosity verbosity) {
  if (std::ranges::all_of(gnuplot_programs, runs)) return;
  Issue warning;
  warning.severity = Severity::warning;
  warning.message = "not all pictures could be drawn: gnuplot (package gnuplot-nox) isn't there or failed";
  tell({warning}, verbosity);
}

}  // namespace pirsim::app
