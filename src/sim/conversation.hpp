// Who speaks in a meeting.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pirsim/random.hpp"

namespace pirsim::sim {

/// Turns of speech among whoever takes part. A value; draws from a stream of its own.
class Conversation {
 public:
  Conversation(std::uint64_t seed, std::uint32_t run) : stream_({seed, run, 0, Purpose::conversation}) {}

  /// Of these people, who speaks at this tick; nobody where fewer than two are. participants: ascending.
  [[nodiscard]] std::optional<std::uint32_t> speaker(std::span<const std::uint32_t> participants, std::int64_t tick,
                                                     int tick_rate_hz);

 private:
  Stream stream_;
  std::optional<std::uint32_t> speaker_;
  std::int64_t until_ = 0;
};

}  // namespace pirsim::sim
