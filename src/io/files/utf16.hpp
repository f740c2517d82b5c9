// UTF-16 to UTF-8, piece by piece.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pirsim::io {

class Utf16Decoder {
 public:
  enum class ByteOrder { little, big };
  explicit Utf16Decoder(ByteOrder order) noexcept : order_(order) {}

  /// Appends what the bytes say; a character that they cut waits for the next ones. What isn't UTF-16 is told in words,
  /// and `text` then ends before it.
  [[nodiscard]] std::optional<std::string> add(std::string_view bytes, std::string& text);
  /// After the last bytes: what is missing, in words.
  [[nodiscard]] std::optional<std::string> finish() const;

 private:
  ByteOrder order_;
  std::optional<unsigned char> half_;  ///< a unit's first byte
  char32_t high_ = 0;                  ///< the first of a pair of surrogates; 0: none waits
};

}  // namespace pirsim::io
