// What this build is, for manifests and --version.
#pragma once

#include <string>

namespace pirsim {

[[nodiscard]] std::string version();       ///< "0.2.0"
[[nodiscard]] std::string git_revision();  ///< of the source at configure time, "unknown" outside a checkout
[[nodiscard]] std::string compiler();      ///< "GNU 12.2.0 RelWithDebInfo"

/// As outputs tell what made them: "pirsim 0.2.0 (1a2b3c4d)".
[[nodiscard]] std::string program();

}  // namespace pirsim
