// Journal: a table that keeps its lines in one, ended anywhere, is gone on with to the same table.
#include "files/disk/file.hpp"

#include <fstream>
#include <sstream>

#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using io::Journal;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t n_lines = 5;
using Lines = std::vector<std::string>;

/// All that a resumable table needs: squares of numbers, made from `base` on. Tells which lines it computed.
Lines squares(const fs::path& file, const std::string& base, std::size_t until = n_lines) {
  Journal journal(file);
  auto table = Journal::read(file);
  if (table && table->made_from == base) {
    journal.resume(*table);
  } else {
    journal.begin(base);
    table = Journal::Content{base, {}};
  }
  Lines computed;
  for (std::size_t i = table->pieces.size(); i < until; ++i) {
    computed.push_back(std::to_string((std::stoul(base) + i) * (std::stoul(base) + i)));
    journal.add(computed.back());
  }
  return computed;
}

void put(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

}  // namespace

TEST_CASE("a journal cut short at any byte is continued to the same bytes", "[io][journal]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "squares";
  CHECK(squares(file, "2") == Lines{"4", "9", "16", "25", "36"});
  const std::string whole = content(file);
  CHECK(whole == Journal::text({"2", {"4", "9", "16", "25", "36"}}));
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    put(file, whole.substr(0, cut));
    const auto sound = Journal::read(file);
    const std::size_t n = sound ? sound->pieces.size() : 0;
    CHECK(squares(file, "2").size() == n_lines - n);
    REQUIRE(content(file) == whole);
  }
}

TEST_CASE("lines that were altered, swapped, doubled or left out end a journal", "[io][journal]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "squares";
  squares(file, "2");
  std::istringstream all(content(file));
  Lines lines;
  for (std::string line; std::getline(all, line);) lines.push_back(line + '\n');
  const auto n_sound = [&](const Lines& some) {
    std::string text;
    for (const std::string& line : some) text += line;
    put(file, text);
    return Journal::read(file)->pieces.size();
  };
  CHECK(n_sound(lines) == n_lines);
  const std::string &made = lines[0], &a = lines[1], &b = lines[2], &c = lines[3];
  CHECK(n_sound({made, a, c, b}) == 1);
  CHECK(n_sound({made, a, a, b}) == 1);
  CHECK(n_sound({made, b, c}) == 0);
  CHECK(n_sound({made, a, "8" + b.substr(1), c}) == 1);
}

TEST_CASE("what is made from something else starts anew, and a first line that isn't sound is refused",
          "[io][journal]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "squares";
  CHECK_FALSE(Journal::read(file));
  squares(file, "2", 3);
  CHECK(squares(file, "3").size() == n_lines);
  CHECK(Journal::read(file)->made_from == "3");
  put(file, "a table of before\n4\n");
  CHECK_THROWS_WITH(Journal::read(file), contains("squares:1:1") && contains("another version of pirsim"));
}

TEST_CASE("one process at a time writes a journal, others may read it, and no link is followed", "[io][journal]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "squares";
  Journal journal(file);
  CHECK(journal.is_empty());
  journal.begin("2");
  journal.add("4");
  CHECK_THROWS_WITH(Journal(file), contains("another process is at work"));
  CHECK(Journal::read(file)->pieces == Lines{"4"});
  Journal moved = std::move(journal);
  CHECK_THROWS_WITH(Journal(file), contains("another process is at work"));
  moved.remove();
  CHECK_FALSE(fs::exists(file));
  const fs::path mine = folder.write("mine.txt", "mine");
  fs::create_symlink(mine, file);
  CHECK_THROWS_WITH(Journal(file), contains("is a link"));
  CHECK(content(mine) == "mine");
}
