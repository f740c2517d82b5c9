// Which zones are active as a byte each, which tests can count and compare one by one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/rt/tracer.hpp"
#include "pirsim/rays.hpp"

namespace pirsim::test {

using ZoneBytes = std::vector<std::uint8_t>;  ///< (n_zones) 1: active

inline ZoneBytes bytes_of(const ZoneSet& zones) {
  ZoneBytes bytes(zones.size());
  for (std::size_t zone = 0; zone < bytes.size(); ++zone) bytes[zone] = zones.test(zone) ? 1 : 0;
  return bytes;
}

/// What the tracer sees of these solids, as one person's.
inline ZoneBytes seen_by(rt::Tracer& tracer, std::span<const PosedShape> solids, std::size_t n_zones) {
  ZoneSet zones(n_zones);
  tracer.add(0, solids, zones);
  return bytes_of(zones);
}

}  // namespace pirsim::test
