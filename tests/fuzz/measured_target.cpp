// Tables of measured sums. What is accepted has no negative count and no cell twice.
#include <set>

#include "files/read/csv_reader.hpp"
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pirsim::test::read_as_file(data, size, ".csv", [](const std::filesystem::path& file) {
    std::set<std::pair<std::string, std::string>> seen;
    for (const pirsim::MeasuredCell& cell : pirsim::io::read_measured_cells(file)) {
      if (cell.real < 0 || !seen.emplace(cell.trial, cell.sensor).second) std::abort();
    }
  });
}
