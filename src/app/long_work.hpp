// Work that takes a while: what it is, how far it is, and whether it is to stop.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "app/options.hpp"

namespace pirsim::app {

/// What takes a while, and in what it is counted.
struct Work {
  std::string what;          ///< "simulating"
  std::uint64_t total = 0;   ///< 0: nothing can be counted
  std::string unit = {};     ///< "runs"
  double simulated_s = 0.0;  ///< that all of it simulates; 0: nobody knows beforehand
};

/// Tells on standard error what is done now, how far it is and how long it will take, whether or not a part of it ends
/// meanwhile. On a terminal one line that overwrites itself and goes away; elsewhere a line after some seconds, then
/// now and then one. What is soon done is not told, and nothing is if all is to be quiet.
class Progress {
 public:
  Progress(Work work, Verbosity verbosity);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // From any thread.

  /// One of the total is done.
  void finished();
  /// So many were there already: they say nothing of how long the others take.
  void found(std::uint64_t n);
  /// So much more is simulated.
  void simulated(double seconds);

  [[nodiscard]] double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;
  enum class Style { silent, terminal, lines };
  enum class Told { nothing, something };
  struct Mark {
    Clock::time_point when;
    double simulated_s = 0.0;
  };

  void keep_telling(const std::stop_token& stop);
  // With the mutex held.
  void tell();
  [[nodiscard]] std::string left() const;

  Work work_;
  Style style_;
  Clock::time_point begun_ = Clock::now();
  mutable std::mutex mutex_;  ///< of all that follows
  std::condition_variable_any changed_;
  std::uint64_t done_ = 0, found_ = 0;
  double simulated_s_ = 0.0;
  Told told_ = Told::nothing;
  Mark before_{begun_}, last_{begun_};  ///< some seconds apart
  std::jthread teller_;                 ///< last, so that it ends first
};

/// "40 s", "12 min", "3 h 20 min"
[[nodiscard]] std::string in_words(std::chrono::duration<double> time);

/// SIGINT and SIGTERM as a wish to stop when it suits, as long as it lives. A second signal of the kind ends the
/// process at once. One at a time.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  [[nodiscard]] bool was_made() const noexcept;
  [[nodiscard]] std::string signal_name() const;
  /// For work that can't be resumed: throws Error(stopped), so that unfinished outputs are removed.
  void throw_if_made() const;
};

}  // namespace pirsim::app
