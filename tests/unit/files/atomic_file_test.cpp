#include "files/disk/file.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>

#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using pirsim::io::AtomicFile;
namespace fs = std::filesystem;

namespace {

std::size_t n_files(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// The message of the Error(io) that `work` throws.
template <typename Work>
std::string io_fault(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::io);
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("an atomic file appears at commit, complete, and leaves nothing else", "[atomic_file]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.csv";
  AtomicFile file(path);
  file.stream() << "time_s,PIR1\n";
  file.stream().flush();
  CHECK_FALSE(fs::exists(path));
  file.commit();
  CHECK(content(path) == "time_s,PIR1\n");
  CHECK(n_files(folder.path()) == 1);
  CHECK_THROWS_AS(file.commit(), Error);
}

TEST_CASE("an atomic file that isn't committed leaves the old file as it was", "[atomic_file]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.csv";
  std::ofstream(path) << "old";
  { AtomicFile(path).stream() << "new"; }
  CHECK(content(path) == "old");
  CHECK(n_files(folder.path()) == 1);
  AtomicFile file(path);
  file.stream() << "new";
  file.commit();
  CHECK(content(path) == "new");
}

TEST_CASE("a folder that doesn't exist or a path that is a folder is an io error that names it", "[atomic_file]") {
  const TemporaryFolder folder;
  const std::string missing = io_fault([&] { AtomicFile(folder.path() / "none" / "a.csv"); });
  CHECK(missing.find("none/a.csv") != std::string::npos);
  CHECK(missing.find("No such file or directory") != std::string::npos);
  const std::string directory = io_fault([&] { AtomicFile(folder.path()); });
  CHECK(directory.find("Is a directory") != std::string::npos);
}

TEST_CASE("an unwritable folder is an io error and the old file in it survives", "[atomic_file]") {
  if (::geteuid() == 0) {
    WARN("skipped: the superuser can write to any folder");
    return;
  }
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.csv") << "old";
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  const std::string message = io_fault([&] { AtomicFile(folder.path() / "a.csv"); });
  fs::permissions(folder.path(), fs::perms::owner_all);
  CHECK(message.find("Permission denied") != std::string::npos);
  CHECK(content(folder.path() / "a.csv") == "old");
}

TEST_CASE("a rename that fails is an io error and removes the partial file", "[atomic_file]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.csv";
  AtomicFile file(path);
  file.stream() << "new";
  fs::create_directory(path);
  const std::string message = io_fault([&] { file.commit(); });
  CHECK(message.find("a.csv") != std::string::npos);
  CHECK(message.find("can't replace the file") != std::string::npos);
  CHECK(n_files(folder.path()) == 1);
}

TEST_CASE("a full disk is an io error that says so, whether little or much was written", "[atomic_file]") {
  if (!fs::exists("/dev/full")) return;
  for (const std::size_t size : {std::size_t{10}, std::size_t{1000000}}) {
    AtomicFile file("/dev/full");
    file.stream() << std::string(size, 'x') << "end";
    const std::string message = io_fault([&] { file.commit(); });
    CHECK(message.find("/dev/full") != std::string::npos);
    CHECK(message.find("No space left on device") != std::string::npos);
  }
  CHECK(fs::exists("/dev/full"));
}

TEST_CASE("a partial file that can't grow leaves the old file intact", "[atomic_file]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.csv";
  std::ofstream(path) << "old";
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit little{1000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &little);
  const std::string message = io_fault([&] {
    AtomicFile file(path);
    file.stream() << std::string(100000, 'x');
    file.commit();
  });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  CHECK(message.find("File too large") != std::string::npos);
  CHECK(content(path) == "old");
  CHECK(n_files(folder.path()) == 1);
}

TEST_CASE("what is written never goes where a link of another leads", "[atomic_file]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.csv", mine = folder.write("mine.txt", "mine");
  fs::create_symlink(mine, folder.path() / "a.csv.writing");
  for (int i = 0; i < 3; ++i)
    fs::create_symlink(mine, folder.path() / ("a.csv.writing-" + std::to_string(::getpid()) + '-' + std::to_string(i)));
  AtomicFile one(path), other(path);
  one.stream() << "one";
  other.stream() << std::string(200000, 'o');
  one.commit();
  CHECK(content(path) == "one");
  other.commit();
  CHECK(content(path) == std::string(200000, 'o'));
  CHECK(content(mine) == "mine");
}

TEST_CASE("what a killed writer left behind goes, and what another writes now stays", "[atomic_file]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.csv";
  folder.write("a.csv.writing-1-0", "of a process that was killed");
  folder.write("b.csv.writing-1-0", "of another file");
  AtomicFile one(path);
  CHECK_FALSE(fs::exists(folder.path() / "a.csv.writing-1-0"));
  CHECK(fs::exists(folder.path() / "b.csv.writing-1-0"));
  one.stream() << "one";
  AtomicFile other(path);
  other.stream() << "other";
  one.commit();
  other.commit();
  CHECK(content(path) == "other");
  CHECK(n_files(folder.path()) == 2);
}

TEST_CASE("a file that is to be written once stays as it is", "[atomic_file]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt";
  AtomicFile late(path);
  late.stream() << "late";
  CHECK(io::write_once(path, "first"));
  CHECK_FALSE(late.commit_if_new());
  CHECK(io::write_once(path, "first"));
  CHECK_FALSE(io::write_once(path, "second"));
  CHECK(content(path) == "first");
  CHECK(n_files(folder.path()) == 1);
}

TEST_CASE("a link is kept and the file that it names is replaced", "[atomic_file]") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "real.csv") << "old";
  fs::create_symlink("real.csv", folder.path() / "link.csv");
  AtomicFile file(folder.path() / "link.csv");
  file.stream() << "new";
  file.commit();
  CHECK(fs::is_symlink(folder.path() / "link.csv"));
  CHECK(content(folder.path() / "real.csv") == "new");
}

TEST_CASE("what isn't a regular file is written directly", "[atomic_file]") {
  AtomicFile file("/dev/null");
  file.stream() << "gone";
  file.commit();
  CHECK(fs::is_character_file("/dev/null"));
}
