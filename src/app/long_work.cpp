#include "app/long_work.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <iostream>
#include <utility>

#include "pirsim/error.hpp"

namespace pirsim::app {
namespace {

// A handler can't reach anything else, and any thread may ask.
std::atomic<int> caught = 0;
static_assert(std::atomic<int>::is_always_lock_free);  // what a handler may touch
constexpr std::array signals{SIGINT, SIGTERM};

extern "C" void remember(int signal) { caught = signal; }

void handle(void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  for (const int signal : signals) sigaction(signal, &action, nullptr);
}

}  // namespace

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

StopRequest::StopRequest() {
  caught = 0;
  handle(remember, static_cast<int>(SA_RESETHAND | SA_RESTART));
}
StopRequest::~StopRequest() { handle(SIG_DFL, 0); }

bool StopRequest::was_made() const noexcept { return caught != 0; }
std::string StopRequest::signal_name() const { return caught == SIGINT ? "SIGINT" : "SIGTERM"; }
void StopRequest::throw_if_made() const {
  if (was_made()) throw Error(ErrorCode::stopped, "stopped by " + signal_name());
}

}  // namespace pirsim::app
