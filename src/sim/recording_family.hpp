// A study and others that differ from it in a little: whatever is the same is followed and traced once.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "sim/replay.hpp"

namespace pirsim::sim {

/// Who moves as the first study's people do (CompiledStudy::moves_people_as) isn't moved again; what rays that are the
/// same saw of a posture, or brought of it, isn't traced again. Belongs to one thread at a time. Remembers every
/// posture of the first study.
class RecordingFamily {
 public:
  /// Follows these runs of `first`, which must outlive the family.
  RecordingFamily(const Model& first, std::span<const std::uint32_t> runs);
  ~RecordingFamily();
  RecordingFamily(RecordingFamily&&) noexcept;
  RecordingFamily& operator=(RecordingFamily&&) noexcept;
  RecordingFamily(const RecordingFamily&) = delete;
  RecordingFamily& operator=(const RecordingFamily&) = delete;

  [[nodiscard]] const Recording& first() const noexcept;
  /// record() of a Model compiled like the first one, but for the order of sets. runs: of `other`; each is run of
  /// the same number of the first study as well, if that has been followed. Throws as the constructor does.
  [[nodiscard]] Recording record(const Model& other, std::span<const std::uint32_t> runs);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pirsim::sim
