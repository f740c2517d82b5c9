// How far a study is, on standard error: one line that overwrites itself on a terminal, now and then a line elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "app/options.hpp"

namespace pirsim::app {

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

}  // namespace pirsim::app
