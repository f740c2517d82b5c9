#include "sim/conversation.hpp"

#include <algorithm>
#include <cmath>

namespace pirsim::sim {

std::optional<std::uint32_t> Conversation::speaker(std::span<const std::uint32_t> participants, std::int64_t tick,
                                                   int tick_rate_hz) {
  constexpr double shortest_turn_s = 2.0, mean_further_s = 18.0;  // assumed: seconds to minutes (means of 10-40 tried)
  if (participants.size() < 2) return speaker_ = std::nullopt;
  const bool there = speaker_ && std::ranges::binary_search(participants, *speaker_);
  if (there && tick < until_) return speaker_;
  speaker_ = participants[stream_.index(static_cast<std::uint32_t>(participants.size()))];
  const double turn_s = shortest_turn_s - mean_further_s * std::log(1.0 - stream_.uniform());
  until_ = tick + std::llround(turn_s * tick_rate_hz);
  return speaker_;
}

}  // namespace pirsim::sim
