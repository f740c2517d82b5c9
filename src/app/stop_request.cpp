#include "app/stop_request.hpp"

#include <array>
#include <atomic>
#include <csignal>

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
