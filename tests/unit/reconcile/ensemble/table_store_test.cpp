// Simulated datasets on disk.
#include "reconcile/ensemble/reference_table.hpp"

#include <filesystem>

#include "files/disk/file.hpp"
#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

TEST_CASE("a damaged chunk of a table is named, and what to do about it", "[reconcile]") {
  const TemporaryFolder folder;
  TableStore store(folder.path(), "key");
  TableChunk chunk;
  const Series run{2, 3, 1, 4, {1, 0, 0, 1, 1, 1, 0, 0, 1, 0, 1, 0}};
  chunk.datasets.push_back({{1, 7, {{"dead_time", {{"dead_s", 2.0}}, {{"sensor", "PIR1"}}, {}}}}, {run}});
  chunk.n_left_out = 5;
  store.keep(3, chunk);
  const TableChunk kept = *store.find(3);
  REQUIRE(kept.datasets.size() == 1);
  const TableRow& row = kept.datasets.front().row;
  CHECK((row.hypothesis == 1 && row.realization == 7 && kept.n_left_out == 5));
  CHECK(row.effects.front().name == "dead_time");
  CHECK(row.effects.front().parameters == chunk.datasets.front().row.effects.front().parameters);
  CHECK(row.effects.front().choices == chunk.datasets.front().row.effects.front().choices);
  CHECK(kept.datasets.front().runs == std::vector{run});
  const std::filesystem::path file = folder.path() / "realizations_0003.bin";
  const std::string bytes = io::read_text_file(file);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    io::write_text_file(file, damaged);
    CHECK_THROWS_AS(store.find(3), Error);
  }
  for (const std::size_t n : {bytes.size() - 9, std::size_t{0}}) {
    std::filesystem::resize_file(file, n);
    CHECK_THROWS_WITH(store.find(3), contains(file.string()) && contains("is damaged") && contains("remove"));
  }
  store.keep(2, chunk);
  std::filesystem::rename(folder.path() / "realizations_0002.bin", file);
  CHECK_THROWS_WITH(store.find(3), contains("of other realizations"));
  CHECK_THROWS_WITH(TableStore(folder.path(), "another key"), contains("holds simulated datasets of other inputs"));
  std::filesystem::remove(file);
  CHECK_FALSE(store.find(3));
}

TEST_CASE("chunks that no journal tells of are refused, and not replaced", "[reconcile]") {
  const TemporaryFolder folder;
  folder.write("realizations_0000.bin", "of 0.1.0");
  CHECK_THROWS_WITH(TableStore(folder.path(), "key"), contains("without table.journal, as pirsim 0.1.0 wrote them"));
}

TEST_CASE("two may read a table, one at a time adds to it", "[reconcile]") {
  const TemporaryFolder folder;
  TableChunk chunk;
  chunk.datasets.push_back({{1, 7, {}}, {}});
  {
    TableStore writer(folder.path(), "key");
    writer.keep(0, chunk);
    TableStore reader(folder.path(), "key");
    CHECK(reader.find(0));
    CHECK_FALSE(reader.find(1));
    CHECK_THROWS_WITH(reader.keep(1, chunk), contains("another process is at work"));
  }
  TableStore later(folder.path(), "key");
  later.keep(1, chunk);
  const TableStore again(folder.path(), "key");
  CHECK(again.find(0));
  CHECK(again.find(1));
  CHECK_FALSE(again.find(2));
}

TEST_CASE("a chunk that was moved here from another table is told from this table's", "[reconcile]") {
  const TemporaryFolder folder, other;
  TableChunk chunk;
  chunk.datasets.push_back({{1, 7, {}}, {}});
  TableStore store(folder.path(), "key"), elsewhere(other.path(), "another key");
  store.keep(0, chunk);
  elsewhere.keep(0, chunk);
  const std::string name = "realizations_0000.bin";
  std::filesystem::copy_file(other.path() / name, folder.path() / name,
                             std::filesystem::copy_options::overwrite_existing);
  CHECK_THROWS_WITH(store.find(0), contains("of other inputs or settings"));
}
