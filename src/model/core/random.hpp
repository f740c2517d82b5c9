// SHA-256 (FIPS 180-4), by which data and inputs are recognised.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace pirsim {

/// Takes bytes in pieces; the digest of what came so far can be asked for at any time.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  void add(std::string_view bytes);
  [[nodiscard]] std::string hex() const;  ///< 64 lower-case digits

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Of bytes at hand, as hex().
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace pirsim
