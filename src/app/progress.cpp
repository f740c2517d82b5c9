#include "app/progress.hpp"

#include <unistd.h>

#include <cmath>
#include <iostream>
#include <utility>

namespace pirsim::app {

Progress::Progress(std::uint32_t total, Verbosity verbosity, std::string unit)
    : unit_(std::move(unit)),
      total_(total),
      style_(verbosity == Verbosity::quiet ? Style::silent
             : isatty(STDERR_FILENO) != 0  ? Style::terminal
                                           : Style::heartbeat) {}

Progress::~Progress() {
  if (style_ == Style::terminal) std::cerr << "\r\033[K" << std::flush;
}

double Progress::seconds() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }

void Progress::run_finished() {
  ++done_;
  if (style_ == Style::silent) return;
  const double interval_s = style_ == Style::terminal ? 0.2 : 20.0;
  const auto now = Clock::now();
  if (std::chrono::duration<double>(now - told_).count() < interval_s) return;
  told_ = now;
  const double left_s = seconds() / done_ * (total_ - done_);
  const std::string line = std::to_string(done_) + " of " + std::to_string(total_) + " " + unit_ + ", " +
                           std::to_string(std::lround(left_s)) + " s left";
  if (style_ == Style::terminal) {
    std::cerr << '\r' << line << "\033[K" << std::flush;
  } else {
    std::cerr << line << '\n';
  }
}

}  // namespace pirsim::app
