// Where the tests find the project's files.
#pragma once

#include <filesystem>

namespace pirsim::test {

[[nodiscard]] std::filesystem::path data_dir();   ///< data/
[[nodiscard]] std::filesystem::path tests_dir();  ///< tests/

}  // namespace pirsim::test
