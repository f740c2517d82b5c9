// Every file of tests/e2e/hostile/scenes is refused at the right place and with the right words.
#include <set>
#include <sstream>

#include "gltf_builder.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"

using namespace pirsim::test;

namespace {

const std::filesystem::path folder = pirsim::test::tests_dir() / "e2e/hostile/scenes";

struct Expected {
  std::string file, place, message;
};

std::vector<Expected> expected_faults() {
  std::vector<Expected> rows;
  std::ifstream table(folder / "expected.tsv");
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream cells(line);
    Expected& row = rows.emplace_back();
    std::getline(cells, row.file, '\t');
    std::getline(cells, row.place, '\t');
    std::getline(cells, row.message);
  }
  return rows;
}

}  // namespace

TEST_CASE("every hostile scene is refused with file, line and column and a message that says what is wrong",
          "[scene][hostile]") {
  std::set<std::string> listed{"expected.tsv", "README.md"};
  for (const Expected& expected : expected_faults()) {
    listed.insert(expected.file);
    const std::string told = fault_of(
        [&] { return pirsim::io::read_scene(folder / expected.file, {{pirsim::test::data_dir() / "sensors"}}); });
    const std::string place = expected.place == "-" ? ": error: " : ":" + expected.place + ": error: ";
    CHECK_THAT(told, contains(expected.file + place) && contains(expected.message));
  }
  CHECK(listed.size() > 40);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    INFO(entry.path());
    CHECK(listed.count(entry.path().filename().string()) == 1);
  }
}

TEST_CASE("a scene cut short anywhere is refused or read, never a crash", "[scene][hostile]") {
  GltfBuilder scene;
  scene.node("wall", {{"mesh", scene.mesh(scene.positions({0, 0, 0, 1, 0, 0, 0, 1, 0}))}});
  scene.floor();
  const TemporaryFolder temporary;
  for (const std::string& whole : {scene.text(), scene.binary()}) {
    for (std::size_t length = 0; length < whole.size(); length += 3) {
      const auto file = temporary.write("cut", whole.substr(0, length));
      if (fault_of([&] { return pirsim::io::read_scene(file); }) == "accepted") FAIL("accepted at " << length);
    }
  }
}

TEST_CASE("a scene with any one number changed is refused or read, never a crash", "[scene][hostile]") {
  GltfBuilder scene;
  const int p = scene.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  scene.node("wall", {{"mesh", scene.mesh(p, scene.indices<std::uint8_t>({0, 1, 2}))}, {"scale", {1, 2, 3}}});
  scene.floor();
  const std::string whole = scene.text();
  const TemporaryFolder temporary;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (std::isdigit(static_cast<unsigned char>(whole[i])) == 0) continue;
    for (const char* other : {"-1", "0", "7", "1e5", "4294967295", "99999999999999999999", "null", "\"x\"", "[[]]"}) {
      std::string changed = whole;
      changed.replace(i, 1, other);
      const auto file = temporary.write("changed.gltf", changed);
      const std::string told = fault_of([&] { return pirsim::io::read_scene(file); });
      if (told != "accepted" && told.find("changed.gltf:") == std::string::npos) FAIL(told);
    }
  }
}
