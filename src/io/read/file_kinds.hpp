// What kind of file one is, told by the key of its format's version. Private to io and dataset.
#pragma once

#include <string>
#include <string_view>

#include "io/read/yaml_map.hpp"

namespace pirsim::io {

/// "a walk test: `pirsim walktest --script` takes it", of a text with such a key at the beginning of a line; or "".
[[nodiscard]] std::string kind_of_text(std::string_view text);
/// Throws Error(input) if the file lacks the key that it should have, and has that of another kind.
void refuse_other_kinds(const YamlMap& map, const std::string& version_key);

}  // namespace pirsim::io
