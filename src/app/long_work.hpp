// Work that takes a while: how far it is, and whether it is to stop.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "app/options.hpp"

namespace pirsim::app {

/// How far a study is, on standard error: one line that overwrites itself on a terminal, now and then a line elsewhere.
class Progress {
 public:
  /// unit: what is counted, in messages.
  Progress(std::uint32_t total, Verbosity verbosity, std::string unit = "runs");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void run_finished();
  [[nodiscard]] double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;
  enum class Style { silent, terminal, heartbeat };

  std::string unit_;
  std::uint32_t total_;
  std::uint32_t done_ = 0;
  Style style_;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point told_ = begun_;
};

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
