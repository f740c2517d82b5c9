// Memory that belongs to no value.
#pragma once

#include <utility>

namespace pirsim::sim {

/// A member that changes no result: a copy begins empty, so that its owner can be copied by `= default`.
template <typename T>
class Scratch {
 public:
  Scratch() = default;
  Scratch(const Scratch&) noexcept {}
  Scratch(Scratch&& other) noexcept : value_(std::move(other.value_)) {}
  Scratch& operator=(const Scratch&) noexcept { return *this; }
  Scratch& operator=(Scratch&& other) noexcept {
    value_ = std::move(other.value_);
    return *this;
  }
  ~Scratch() = default;

  [[nodiscard]] T& operator*() noexcept { return value_; }

 private:
  T value_{};
};

}  // namespace pirsim::sim
