// SIGINT and SIGTERM as a wish to stop when it suits. A second signal of the kind ends the process at once.
#pragma once

#include <string>

namespace pirsim::app {

/// Catches the signals as long as it lives. One at a time.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  [[nodiscard]] bool was_made() const noexcept;
  [[nodiscard]] std::string signal_name() const;
  /// For work that can't be gone on with: throws Error(stopped), so that unfinished outputs are removed.
  void throw_if_made() const;
};

}  // namespace pirsim::app
