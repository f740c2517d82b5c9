// The fields of one line of a table. Private to io.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pirsim::io {

/// The fields of a line. '"' quotes, doubled within quotes; ' ' separates at every run of spaces and tabs. They live as
/// long as the line and `unquoted`. False if a quote isn't closed.
[[nodiscard]] bool split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields,
                                std::vector<std::string>& unquoted);

}  // namespace pirsim::io
