#include "app/long_work.hpp"

#include <unistd.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <iostream>
#include <optional>
#include <system_error>
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

std::string in_words(std::chrono::duration<double> time) {
  constexpr long a_minute = 60, an_hour = 60 * a_minute;
  const long seconds = std::lround(time.count());
  if (seconds < 2 * a_minute) return std::to_string(seconds) + " s";
  const long minutes = (seconds + a_minute / 2) / a_minute;
  if (seconds < 2 * an_hour) return std::to_string(minutes) + " min";
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

Progress::Progress(Work work, Verbosity verbosity)
    : work_(std::move(work)),
      style_(verbosity == Verbosity::quiet ? Style::silent
             : isatty(STDERR_FILENO) != 0  ? Style::terminal
                                           : Style::lines) {
  if (style_ == Style::silent) return;
  try {
    teller_ = std::jthread([this](const std::stop_token& stop) { keep_telling(stop); });
  } catch (const std::system_error&) {
    style_ = Style::silent;  // the system gives no more threads
  }
}

Progress::~Progress() {
  if (!teller_.joinable()) return;
  teller_.request_stop();
  teller_.join();
  if (style_ == Style::terminal && told_ == Told::something) std::cerr << "\r\033[K" << std::flush;
}

double Progress::seconds() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }

void Progress::finished() {
  const std::lock_guard lock(mutex_);
  ++done_;
}
void Progress::found(std::uint64_t n) {
  const std::lock_guard lock(mutex_);
  done_ += n;
  found_ += n;
}
void Progress::simulated(double seconds) {
  const std::lock_guard lock(mutex_);
  simulated_s_ += seconds;
}

void Progress::keep_telling(const std::stop_token& stop) {
  using namespace std::chrono_literals;
  const bool lines = style_ == Style::lines;
  std::unique_lock lock(mutex_);
  const auto wait = [&](Clock::duration time) { changed_.wait_for(lock, stop, time, [] { return false; }); };
  for (wait(lines ? 4s : 1s); !stop.stop_requested(); wait(lines ? 20s : 200ms)) tell();
}

/// By what took longest to be simulated of late, until a whole part is done: nobody moves in a day's first hours.
std::string Progress::left() const {
  const std::chrono::duration<double> so_far = Clock::now() - begun_;
  const std::uint64_t made = done_ - found_;
  std::optional<double> times;  // that of what was done
  std::chrono::duration<double> took = so_far;
  if (work_.simulated_s > 0.0 && simulated_s_ > 0.0) {
    const double begun_s = made > 0 ? 0.0 : before_.simulated_s;
    if (made == 0) took = Clock::now() - before_.when;
    if (simulated_s_ > begun_s) times = (work_.simulated_s - simulated_s_) / (simulated_s_ - begun_s);
  } else if (made > 0 && done_ <= work_.total) {
    times = static_cast<double>(work_.total - done_) / static_cast<double>(made);
  }
  if (!times) return in_words(so_far) + " so far";
  return in_words(took * std::max(0.0, *times)) + " left";
}

void Progress::tell() {
  constexpr std::chrono::seconds apart{3};
  const std::string left = this->left();
  if (const auto now = Clock::now(); now - last_.when >= apart) before_ = std::exchange(last_, {now, simulated_s_});
  std::string line = work_.what + ": ";
  if (work_.total > 1) {
    // A search may try more than it was told to: then nobody knows how many more.
    line += std::to_string(done_) + (done_ <= work_.total ? " of " + std::to_string(work_.total) : "") + ' ' +
            work_.unit + ", ";
  }
  if (simulated_s_ > 0.0) {  // so that one part that takes long is followed on its way
    line += std::to_string(std::lround(simulated_s_));
    if (work_.simulated_s > 0.0) line += " of " + std::to_string(std::lround(work_.simulated_s));
    line += " s simulated, ";
  }
  line += left;
  told_ = Told::something;
  std::cerr << (style_ == Style::terminal ? '\r' + line + "\033[K" : line + '\n') << std::flush;
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
