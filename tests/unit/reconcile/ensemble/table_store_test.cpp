// Simulated datasets on disk.
#include "reconcile/ensemble/table_store.hpp"

#include <filesystem>

#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

TEST_CASE("a damaged chunk of a table is named, and what to do about it", "[reconcile]") {
  const TemporaryFolder folder;
  const TableStore store(folder.path(), "key");
  TableChunk chunk;
  chunk.datasets.push_back({{1, 7, {{"dead_time", {{"dead_s", 2.0}}, {}, {}}}}, {}});
  store.keep(3, chunk);
  REQUIRE(store.find(3)->datasets.size() == 1);
  const std::filesystem::path file = folder.path() / "realizations_0003.bin";
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 9);
  CHECK_THROWS_AS(store.find(3), Error);
  CHECK_THROWS_WITH(store.find(3), contains(file.string()) && contains("ends too early") && contains("remove"));
  store.keep(2, chunk);
  std::filesystem::rename(folder.path() / "realizations_0002.bin", file);
  CHECK_THROWS_WITH(store.find(3), contains("of other realizations"));
  std::filesystem::remove(folder.path() / "key.txt");
  const TableStore other(folder.path(), "another key");
  CHECK_THROWS_WITH(other.find(3), contains("of other inputs or settings"));
  std::filesystem::remove(file);
  CHECK_FALSE(store.find(3));
}
