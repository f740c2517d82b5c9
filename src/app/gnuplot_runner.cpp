#include "app/gnuplot_runner.hpp"

#include <csignal>
#include <cstdio>

namespace pirsim::app {

bool run_gnuplot(const std::string& program) {
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

}  // namespace pirsim::app
