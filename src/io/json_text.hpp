// A JSON text that knows where in the file each of its values stands. Private to io.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "pirsim/error.hpp"

namespace pirsim::io::detail {

/// Why a text is not read as JSON: its syntax, a number too large, or more levels or values than any scene needs, which
/// would exhaust stack or memory.
struct JsonFault {
  std::size_t offset = 0;
  std::string message;
};
[[nodiscard]] std::variant<nlohmann::json, JsonFault> parse_json(std::string_view text);

/// Places are found by scanning the text again: they are wanted only for the few values that a message is about.
class JsonText {
 public:
  enum class Places { known, unknown };  ///< unknown: the text is not a file of its own (a chunk of a .glb)

  /// Throws Error(input) with the place of a JsonFault.
  JsonText(std::string file, std::string text, Places places);

  [[nodiscard]] const nlohmann::json& root() const noexcept { return root_; }
  /// Place of the value at a JSON pointer such as `/nodes/4/extras`; of the nearest enclosing value that exists.
  [[nodiscard]] Where where(std::string_view pointer) const;
  /// Place of the key that names the value.
  [[nodiscard]] Where where_key(std::string_view pointer) const;

 private:
  enum class Target { value, key };
  [[nodiscard]] Where find(std::string_view pointer, Target target) const;
  [[nodiscard]] Where at(std::size_t offset) const;

  std::string file_;
  std::string text_;
  Places places_;
  nlohmann::json root_;
};

}  // namespace pirsim::io::detail
