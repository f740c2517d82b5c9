#include "model/core/random.hpp"

#include <Random123/philox.h>
#include <openssl/evp.h>
#include <array>
#include <cmath>
#include <new>
#include <numbers>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"

namespace pirsim {

std::uint32_t Stream::next_u32() noexcept {
  if (used_ == 4) {
    const r123::Philox4x32 philox;
    const r123::Philox4x32::ctr_type counter{{key_.run, key_.entity, static_cast<std::uint32_t>(key_.purpose), block_}};
    const r123::Philox4x32::key_type key{
        {static_cast<std::uint32_t>(key_.seed), static_cast<std::uint32_t>(key_.seed >> 32U)}};
    const auto words = philox(counter, key);
    for (std::size_t i = 0; i < 4; ++i) words_[i] = words[i];
    ++block_;
    used_ = 0;
  }
  return words_[used_++];
}

double Stream::uniform() noexcept {
  const std::uint64_t high = next_u32();
  const std::uint64_t low = next_u32();
  return static_cast<double>(((high << 32U) | low) >> 11U) * 0x1.0p-53;
}

std::uint32_t Stream::index(std::uint32_t n) noexcept {
  // Lemire's multiply-shift with rejection. Ref: [Lemire2019]
  std::uint64_t product = std::uint64_t{next_u32()} * n;
  const std::uint32_t threshold = (0U - n) % n;
  while (static_cast<std::uint32_t>(product) < threshold) product = std::uint64_t{next_u32()} * n;
  return static_cast<std::uint32_t>(product >> 32U);
}

double Stream::normal() noexcept {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

struct Sha256::State {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  State() {
    if (context == nullptr) throw std::bad_alloc();
  }
  ~State() { EVP_MD_CTX_free(context); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

namespace {

void require(int success) {
  if (success != 1) throw Error(ErrorCode::internal, "the hash library failed");
}

}  // namespace

Sha256::Sha256() : state_(std::make_unique<State>()) {
  require(EVP_DigestInit_ex(state_->context, EVP_sha256(), nullptr));
}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::add(std::string_view bytes) { require(EVP_DigestUpdate(state_->context, bytes.data(), bytes.size())); }

std::string Sha256::hex() const {
  const State copy;  // finishing a digest ends it
  require(EVP_MD_CTX_copy_ex(copy.context, state_->context));
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  require(EVP_DigestFinal_ex(copy.context, digest.data(), &size));
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (unsigned i = 0; i < size; ++i) {
    text += digits[digest[i] >> 4U];
    text += digits[digest[i] & 15U];
  }
  return text;
}

std::string sha256(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.hex();
}

}  // namespace pirsim
