// What this build is, for manifests and --version.
#pragma once

#include <string>

namespace pirsim {

[[nodiscard]] std::string version();       ///< "0.2.0"
[[nodiscard]] std::string git_revision();  ///< of the source at configure time, "unknown" outside a checkout
[[nodiscard]] std::string compiler();      ///< "GNU 12.2.0 RelWithDebInfo"

}  // namespace pirsim
