// The parts of a glTF JSON that pirsim reads, checked for type, size and reference. Private to io.
#pragma once

#include "io/json_text.hpp"

namespace pirsim::io::detail {

/// Adds a fault for every member that pirsim reads whose type, size or reference is not as glTF asks. Buffers' contents
/// are not looked at.
void check_structure(const JsonText& text, Diagnostics& faults);

}  // namespace pirsim::io::detail
