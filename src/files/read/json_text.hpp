// A JSON text that knows where in the file each of its values stands. Private to io.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pirsim/error.hpp"

namespace pirsim::io::detail {

/// Why a text is not read as JSON: its syntax, a number too large, or more levels or values than any scene needs, which
/// would exhaust stack or memory.
struct JsonFault {
  std::size_t offset = 0;
  std::string message;
};
[[nodiscard]] std::variant<nlohmann::json, JsonFault> parse_json(std::string_view text);

/// Places are found by scanning the text again, since few values are asked about. Readers ask for every mark of a
/// scene, so what is in a long list or object is noted at the first question. Not for several threads at a time.
class JsonText {
 public:
  enum class Places { known, unknown };  ///< unknown: the text is not a file of its own (a chunk of a .glb)

  /// Throws Error(input) with the place of a JsonFault.
  JsonText(std::string file, std::string text, Places places);

  [[nodiscard]] const nlohmann::json& root() const noexcept { return *root_; }
  /// Place of the value at a JSON pointer such as `/nodes/4/extras`; of the nearest enclosing value that exists.
  [[nodiscard]] Where where(std::string_view pointer) const;
  /// Place of the key that names the value.
  [[nodiscard]] Where where_key(std::string_view pointer) const;

 private:
  enum class Target { value, key };
  /// Of a list or an object: offsets of what it holds, in the order of the text.
  struct Member {
    std::string name;     ///< of an object's member
    std::size_t key = 0;  ///< of its key; of a list's element: of its value
    std::size_t value = 0;
  };
  using Members = std::vector<Member>;
  struct LineAndColumn {
    std::size_t line = 1, column = 1;
  };
  [[nodiscard]] static Members members_of(std::string_view text, std::size_t offset);
  /// The member of that name or number of what begins at the offset, if it has one.
  [[nodiscard]] std::optional<Member> member_of(std::size_t offset, const std::string& name) const;
  void count(std::size_t from, std::size_t to, LineAndColumn& place) const;
  [[nodiscard]] Where find(std::string_view pointer, Target target) const;
  [[nodiscard]] Where at(std::size_t offset) const;

  std::string file_;
  std::string text_;
  Places places_;
  std::shared_ptr<const nlohmann::json> root_;
  mutable std::map<std::size_t, Members> noted_;  ///< by offset
  mutable std::vector<LineAndColumn> counted_;    ///< at every so many bytes
};

}  // namespace pirsim::io::detail
