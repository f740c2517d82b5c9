// RowFile: whatever is left on the disk, to resume gives the bytes of an undisturbed run.
#include "files/write/row_file.hpp"

#include <fstream>
#include <iterator>

#include "files/disk/file.hpp"
#include "model/core/random.hpp"
#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
namespace fs = std::filesystem;
using Start = io::RowFile::Start;

namespace {

constexpr std::uint32_t n_runs = 6;
const std::string header = "replicate,trial,PIR1\n";

std::string few_rows(std::uint32_t run) {
  std::string text;
  for (std::uint32_t i = 0; i <= run % 3; ++i) text += std::to_string(run) + ",S" + std::to_string(i) + ",1\n";
  return text;
}

std::string whole() {
  std::string text = header;
  for (std::uint32_t run = 0; run < n_runs; ++run) text += few_rows(run);
  return text;
}

io::Manifest made(std::uint64_t seed = 1) {
  io::Manifest manifest;
  manifest.provenance.version = "1";
  manifest.provenance.seed = seed;
  manifest.provenance.study_runs = n_runs;
  manifest.provenance.resolved_script = "a: 1\nb: \"\xC3\xA9\"\n";
  manifest.provenance.responses = {{"PIR2", "analog"}, {"PIR1", "zones"}};
  manifest.runs = {0, n_runs};
  return manifest;
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

/// Goes on from what is there up to, not including, run `until`.
void work(const fs::path& file, Start start, std::uint32_t until = n_runs) {
  io::RowFile rows(file, made(), header, start);
  if (rows.finished()) return;
  while (rows.next_run() < until) rows.add_run(few_rows(rows.next_run()), rows.next_run() % 3 + 1);
  if (until == n_runs) rows.commit();
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("a file of rows appears with its manifest and nothing else", "[io][row_file]") {
  for (const char* name : {"rows.csv", "rows.csv.gz", "rows.csv.zst"}) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / name;
    work(file, Start::anew);
    CHECK(files_in(folder.path()) == 2);
    const io::Manifest manifest = io::read_manifest(io::manifest_path(file));
    Sha256 hash;
    hash.add(whole());
    CHECK(manifest.sha256 == hash.hex());
    CHECK(manifest.bytes == whole().size());
    CHECK(manifest.rows == 12);
    CHECK(io::differences(manifest.provenance, made().provenance).empty());
    CHECK(manifest.provenance.responses == made().provenance.responses);
    CHECK(io::fault_of_data(file, manifest).empty());
    const std::string bytes = content(file);
    work(file, Start::resume);
    CHECK(content(file) == bytes);
  }
}

TEST_CASE("rows and journal cut short at any byte are gone on with to the same bytes", "[io][row_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "rows.csv", partial = folder.path() / "rows.csv.partial",
                 journal = folder.path() / "rows.csv.journal";
  work(file, Start::anew, 4);
  const std::string all_rows = content(partial), all_marks = content(journal);
  const auto check = [&](std::size_t n_rows, std::size_t n_marks) {
    write(partial, all_rows.substr(0, n_rows));
    write(journal, all_marks.substr(0, n_marks));
    work(file, Start::resume);
    INFO(n_rows << " bytes of rows, " << n_marks << " of the journal");
    REQUIRE(content(file) == whole());
    REQUIRE(files_in(folder.path()) == 2);
    fs::remove(file);
    fs::remove(io::manifest_path(file));
  };
  for (std::size_t n = 0; n <= all_marks.size(); ++n) check(all_rows.size(), n);
  for (std::size_t n = 0; n <= all_rows.size(); ++n) check(n, all_marks.size());
}

TEST_CASE("rows that are not what was written are made anew", "[io][row_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "rows.csv", partial = folder.path() / "rows.csv.partial";
  work(file, Start::anew, 4);
  std::string zeroed = content(partial);
  zeroed.replace(30, 8, 8, '\0');  // as a power failure may leave it
  write(partial, zeroed);
  io::RowFile rows(file, made(), header, Start::resume);
  CHECK(rows.next_run() == 0);
}

TEST_CASE("to resume keeps the runs that were whole", "[io][row_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "rows.csv.zst";
  work(file, Start::anew, 4);
  write(folder.path() / "rows.csv.partial", content(folder.path() / "rows.csv.partial") + "4,S0");
  CHECK(io::RowFile(file, made(), header, Start::resume).next_run() == 4);
  CHECK(io::RowFile(file, made(), header, Start::anew).next_run() == 0);
}

TEST_CASE("a file that lacks only its manifest is not computed again", "[io][row_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "rows.csv";
  work(file, Start::anew, 5);
  {
    io::RowFile rows(file, made(), header, Start::resume);
    rows.add_run(few_rows(5), 3);
  }
  fs::rename(folder.path() / "rows.csv.partial", file);  // and then it was killed
  {
    io::RowFile rows(file, made(), header, Start::resume);
    CHECK(rows.next_run() == n_runs);
    rows.commit();
  }
  CHECK(content(file) == whole());
  CHECK(files_in(folder.path()) == 2);
}

TEST_CASE("what something else made is refused and stays as it is", "[io][row_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "rows.csv", partial = folder.path() / "rows.csv.partial";
  const auto resume_other = [&] { io::RowFile(file, made(2), header, Start::resume); };
  work(file, Start::anew, 4);
  const std::string rows = content(partial);
  CHECK_THROWS_WITH(resume_other(), contains("can't be resumed") && contains("seed (1, not 2)"));
  CHECK(content(partial) == rows);
  work(file, Start::resume);
  CHECK_THROWS_WITH(resume_other(), contains("can't be resumed") && contains("rows.csv.json"));
  CHECK(content(file) == whole());
  { io::RowFile replaced(file, made(2), header, Start::anew); }
  CHECK(content(file) == whole());  // until the new one is whole
}

TEST_CASE("of inputs that are more or fewer those are named that only one side has", "[io][row_file]") {
  io::Provenance one, other;
  one.inputs = {{"study.yaml", "a"}, {"room.gltf", "b"}};
  other.inputs = {{"study.yaml", "a"}, {"room.gltf", "b"}, {"EYE.yaml", "c"}, {"eye.csv", "d"}};
  const std::vector<std::string> fewer = io::differences(one, other), more = io::differences(other, one);
  REQUIRE((fewer.size() == 1 && more.size() == 1));
  CHECK_THAT(fewer.front(), contains("input files (without EYE.yaml, eye.csv;"));
  CHECK_THAT(more.front(), contains("input files (with EYE.yaml, eye.csv;"));
}

TEST_CASE("a finished file that was damaged is made anew by resuming", "[io][row_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "rows.csv";
  for (const std::string& damaged : {whole() + "x", whole().substr(1), std::string()}) {
    work(file, Start::anew);
    write(file, damaged);
    CHECK_FALSE(io::fault_of_data(file, io::read_manifest(io::manifest_path(file))).empty());
    work(file, Start::resume);
    CHECK(content(file) == whole());
  }
  write(io::manifest_path(file), "{\"pirsim_man");
  work(file, Start::resume);
  CHECK(io::fault_of_data(file, io::read_manifest(io::manifest_path(file))).empty());
}

TEST_CASE("no bit of a journal can be altered without being noticed", "[io][row_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "rows.csv", partial = folder.path() / "rows.csv.partial",
                 journal = folder.path() / "rows.csv.journal";
  work(file, Start::anew, 4);
  const std::string rows = content(partial), marks = content(journal);
  std::size_t n_refused = 0;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    std::string altered = marks;
    altered[i] = static_cast<char>(altered[i] ^ 1);
    write(journal, altered);
    write(partial, rows);
    INFO("byte " << i);
    try {
      work(file, Start::resume);
      REQUIRE(content(file) == whole());
      REQUIRE(io::read_manifest(io::manifest_path(file)).rows == 12);
      fs::remove(file);
      fs::remove(io::manifest_path(file));
    } catch (const Error& error) {
      REQUIRE(error.code() == ErrorCode::input);
      ++n_refused;
    }
  }
  CHECK(n_refused > marks.find('\n') - 10);  // a first line that is whole, but altered
  CHECK(n_refused < marks.size());
}

TEST_CASE("two at work on one file is one too many", "[io][row_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "rows.csv";
  io::RowFile first(file, made(), header, Start::anew);
  for (const Start start : {Start::anew, Start::resume}) {
    CHECK_THROWS_WITH(io::RowFile(file, made(), header, start), contains("another process is at work"));
  }
}

TEST_CASE("what has no sense is discarded", "[io][row_file]") {
  const TemporaryFolder folder;
  io::RowFile rows(folder.path() / "rows.csv", made(), header, Start::anew);
  rows.add_run(few_rows(0), 1);
  CHECK_THROWS_AS(rows.commit(), Error);
  rows.discard();
  CHECK(files_in(folder.path()) == 0);
}

TEST_CASE("a run that failed has no rows, costs no other run any, and is told after every way to resume",
          "[io][row_file]") {
  const auto notes_of = [](std::uint32_t run) {
    io::RunNotes notes;
    if (run == 2) notes.failed.push_back({2, "S3", 1, 41.5, "2026-03-02T10:00:41", "'anna' finds no way"});
    if (run == 1 || run == 4) notes.passes_through = run;
    if (run == 1 || run == 4) notes.first_pass = "run " + std::to_string(run);
    return notes;
  };
  for (std::uint32_t until = 0; until <= n_runs; ++until) {
    INFO("ended before run " << until);
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "rows.csv";
    for (const std::uint32_t end : {until, n_runs}) {
      io::RowFile rows(file, made(), header, end == until ? Start::anew : Start::resume);
      if (rows.finished()) continue;
      while (rows.next_run() < end) {
        const std::uint32_t run = rows.next_run();
        rows.add_run(run == 2 ? "" : few_rows(run), run == 2 ? 0 : run % 3 + 1, notes_of(run));
      }
      if (end == n_runs) rows.commit();
    }
    std::string expected = header;
    for (const std::uint32_t run : {0U, 1U, 3U, 4U, 5U}) expected += few_rows(run);
    CHECK(content(file) == expected);
    const io::RunNotes told = io::read_manifest(io::manifest_path(file)).notes;
    REQUIRE(told.failed.size() == 1);
    CHECK(told.failed.front().trial == "S3");
    CHECK(told.failed.front().time_s == 41.5);
    CHECK(told.failed.front().time == "2026-03-02T10:00:41");
    CHECK(told.failed.front().message == "'anna' finds no way");
    CHECK(told.passes_through == 5);
    CHECK(told.first_pass == "run 1");
    CHECK(io::RowFile(file, made(), header, Start::resume).notes().failed.size() == 1);
  }
}

TEST_CASE("a manifest of a study with very many trials is read back", "[io][row_file]") {
  const TemporaryFolder folder;
  io::Manifest manifest = made();
  manifest.provenance.resolved_script.assign(io::max_text_file_bytes + 1, 'x');
  const fs::path file = io::manifest_path(folder.path() / "rows.csv");
  io::write_manifest(file, manifest);
  CHECK(io::differences(io::read_manifest(file).provenance, manifest.provenance).empty());
}
