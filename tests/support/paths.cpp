// The only file that is compiled with the source tree's place in it.
#include "support/paths.hpp"

namespace pirsim::test {

std::filesystem::path data_dir() { return PIRSIM_DATA_DIR; }
std::filesystem::path tests_dir() { return PIRSIM_TESTS_DIR; }

}  // namespace pirsim::test
