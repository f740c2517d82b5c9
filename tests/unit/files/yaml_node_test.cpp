#include "files/read/yaml.hpp"

#include <array>
#include <functional>

#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::io;

namespace {

/// What the error says, with its code in front.
std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.code())) + " " + error.what();
  }
  return "accepted";
}
std::string refusal_of(const std::string& text, std::vector<std::string> overrides = {}) {
  return refusal([&] { (void)YamlNode::parse(text, "f.yaml", overrides); });
}
std::vector<std::string> lines(const Diagnostics& faults) {
  std::vector<std::string> result;
  for (const Issue& issue : faults.issues()) result.push_back(to_string(issue));
  return result;
}

}  // namespace

TEST_CASE("a YAML map gives typed values and defaults", "[yaml]") {
  Diagnostics faults;
  YamlMap map(
      YamlNode::parse("a: 1.5\nb: +3\nc: hello\nd: [1, 2, -3e1]\ne: true\nf: beam\ng: [x, y]\nh: {i: 1}\n", "f"),
      faults, "thing");
  CHECK(map.number("a", 0.0) == 1.5);
  CHECK(map.number("absent", 7.0) == 7.0);
  CHECK(map.integer("b", 0) == 3);
  CHECK(map.text("c") == "hello");
  CHECK(map.required_numbers("d", 3) == std::vector<double>{1, 2, -30});
  CHECK(map.flag("e", false));
  CHECK(map.choice<int>("f", 0, {{"cluster", 1}, {"beam", 2}}) == 2);
  CHECK(map.texts("g") == std::vector<std::string>{"x", "y"});
  YamlMap inner(map.required_child("h"), faults, "inner");
  CHECK(inner.required_integer("i") == 1);
  inner.finish();
  map.finish();
  CHECK(lines(faults).empty());
}

TEST_CASE("every fault of a YAML map is told with its place", "[yaml]") {
  Diagnostics faults;
  YamlMap map(
      YamlNode::parse("a: one\nb: 2.5\nc: .nan\nd: 1e999\ne: 9\nf: 0\ng: bean\nh: [1, x]\nstatur_m: 2\n", "f.yaml"),
      faults, "person");
  (void)map.number("a", 0.0);
  (void)map.integer("b", 0);
  (void)map.number("c", 0.0);
  (void)map.number("d", 0.0);
  CHECK(map.number("e", 0.0, {.min = 1.0, .max = 8.0}) == 1.0);
  (void)map.number("f", 0.0, {.above = 0.0});
  (void)map.choice<int>("g", 0, {{"cluster", 1}, {"beam", 2}});
  (void)map.required_numbers("h", 2);
  (void)map.number("stature_m", 1.86);
  (void)map.required_text("id");
  map.finish();
  CHECK(lines(faults) == std::vector<std::string>{
                             "f.yaml:1:4: error: person: a: expected a finite number, got 'one'",
                             "f.yaml:2:4: error: person: b: expected a whole number, got '2.5'",
                             "f.yaml:3:4: error: person: c: expected a finite number, got '.nan'",
                             "f.yaml:4:4: error: person: d: expected a finite number, got '1e999'",
                             "f.yaml:5:4: error: person: e: expected a finite number >= 1 and <= 8, got '9'",
                             "f.yaml:6:4: error: person: f: expected a finite number > 0, got '0'",
                             "f.yaml:7:4: error: person: g: expected one of cluster, beam, got 'bean' (did you mean "
                             "'beam'?)",
                             "f.yaml:8:8: error: person: h: expected a finite number, got 'x'",
                             "f.yaml:1:1: error: person: 'id' is missing",
                             "f.yaml:9:1: error: person: unknown key 'statur_m' (did you mean 'stature_m'?)"});
}

TEST_CASE("text that is not a YAML tree of names is refused with line and column", "[yaml]") {
  CHECK(refusal_of("a: [1, 2\nb: 3\n").find("3 f.yaml:2:") == 0);
  CHECK(refusal_of("a: 1\n\tb: 2\n").find("3 f.yaml:") == 0);
  CHECK(refusal_of("a: 1\nb: 2\na: 3\n") == "3 f.yaml:3:1: error: key 'a' appears twice (first in line 1)");
  CHECK(refusal_of("x: {a: 1, a: 2}\n").find("3 f.yaml:1:11: error: key 'a' appears twice") == 0);
  CHECK(refusal_of("[1, 2]: 3\n") == "3 f.yaml:1:1: error: expected a name as key (is a bracket left open?)");
  CHECK(refusal_of("a: &x [*x]\n") == "3 f.yaml:1:8: error: an alias that refers to itself");
  CHECK(refusal_of("a: [1, !3, 2]\n") ==
        "3 f.yaml:1:8: error: the tag '!3' isn't known (a text that begins with ! stands in quotes)");
  CHECK(refusal_of("!mine {a: 1}\n").find("3 f.yaml:1:1: error: the tag '!mine'") == 0);
  CHECK(refusal_of("a: [!!str 3, \"!3\", ! 4]\nb: !!map {c: !!seq [1]}\n") == "accepted");
  CHECK(refusal_of("a: *nowhere\n").find("3 f.yaml:1:4:") == 0);
  CHECK(refusal_of("a:\n    b: 1\n  c: 2\n") ==
        "3 f.yaml:3:3: error: not YAML: end of map not found; check the indentation, here and above");
  CHECK(refusal_of("a: 1\n---\nb: 2\n").find("a second document") != std::string::npos);
  CHECK(refusal_of(std::string(5000, '[')).find("3 f.yaml:1:") == 0);
  CHECK(refusal_of("a: " + std::string(70, '[') + std::string(70, ']')) ==
        "3 f.yaml:1:67: error: nested more than 64 levels deep");
  CHECK(refusal_of("") == "accepted");
  CHECK(YamlNode::parse("", "f").is_null());
}

TEST_CASE("an alias bomb is refused before it is expanded", "[yaml]") {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 40; ++i) {
    const std::string below = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + below + ", " + below + ", " + below + "]\n";
  }
  CHECK(refusal_of(bomb).find("more than 1000000 values") != std::string::npos);
  const YamlNode shared = YamlNode::parse("a: &x {k: 1}\nb: *x\n", "f");
  CHECK(shared.items()[1].where().line == 1);
}

TEST_CASE("a file that is missing or a directory is an io error", "[yaml]") {
  CHECK(refusal([] { (void)pirsim::io::read_input("no/such.yaml"); }) == "4 no/such.yaml: error: no such file");
  CHECK(refusal([] { (void)pirsim::io::read_input("/"); }).find("4 /: error: is a directory") == 0);
}

TEST_CASE("overrides replace or add one node", "[yaml]") {
  const std::array<std::string, 4> overrides{"sensing.rays_per_zone=9", "trials.1.id=T9", "new.deep.key=[1, 2]",
                                             "seed=x"};
  Diagnostics faults;
  YamlMap map(YamlNode::parse("sensing: {rays_per_zone: 5}\ntrials: [{id: T0}, {id: T1}]\nseed: 1\n", "f", overrides),
              faults, "script");
  CHECK(YamlMap(map.required_child("sensing"), faults, "sensing").integer("rays_per_zone", 0) == 9);
  CHECK(YamlMap(map.list("trials")[0], faults, "trial").text("id") == "T0");
  CHECK(YamlMap(map.list("trials")[1], faults, "trial").text("id") == "T9");
  CHECK(faults.issues().empty());
  (void)map.integer("seed", 0, {.min = 0, .max = 9});
  map.finish();
  CHECK(lines(faults) ==
        std::vector<std::string>{"--set seed=x: error: script: seed: expected a whole number from 0 up to 9, got 'x'",
                                 "--set new.deep.key=[1, 2]: error: script: unknown key 'new'"});
}

TEST_CASE("overrides that can't be applied are usage errors", "[yaml]") {
  const std::string text = "a: 1\nb: [1, 2]\n";
  CHECK(refusal_of(text, {"a"}) == "2 --set a: error: expected key.key=value");
  CHECK(refusal_of(text, {"=1"}).find("2 --set =1: error:") == 0);
  CHECK(refusal_of(text, {"a..b=1"}).find("a key is empty") != std::string::npos);
  CHECK(refusal_of(text, {"a.b=1"}).find("nothing can be set below the value '1'") != std::string::npos);
  CHECK(refusal_of(text, {"b.3=1"}).find("'3' is not an index") != std::string::npos);
  CHECK(refusal_of(text, {"b.x=1"}).find("'x' is not an index") != std::string::npos);
  CHECK(refusal_of(text, {"a=[1"}).find("2 --set a=[1: error: expected a name as key") == 0);
}

TEST_CASE("a list gets one item more under the number after its last", "[yaml]") {
  Diagnostics faults;
  const YamlNode node = YamlNode::parse("b: [1, 2]\n", "f.yaml", std::vector<std::string>{"b.2={c: 3}", "b.2.d=4"});
  const std::vector<YamlNode> items = node.value_of("b")->items();
  REQUIRE(items.size() == 3);
  CHECK(items[2].value_of("c")->integer(faults, "c") == 3);
  CHECK(items[2].value_of("d")->integer(faults, "d") == 4);
  CHECK(items[0].integer(faults, "b") == 1);
  CHECK_FALSE(faults.has_errors());
}

TEST_CASE("a tree as YAML reads back the same", "[yaml]") {
  const std::string text =
      "# a comment\na: 1\ntime: \"07:30\"\nnothing:\nword: 'null'\nlist:\n  - {count: [2, 3], name: 'a: b # c'}\n  - "
      "~\n"
      "map: {x: {y: [1, [2, 3]]}}\nempty: []\nnone: {}\n\"odd key: \": \"line\\nbreak\"\n";
  const YamlNode node = YamlNode::parse(text, "f.yaml");
  const std::string once = node.to_yaml();
  CHECK(YamlNode::parse(once, "g.yaml").to_yaml() == once);
  const YamlNode again = YamlNode::parse(once, "g.yaml");
  CHECK(again.n_values() == node.n_values());
  CHECK(again.value_of("nothing")->is_null());
  CHECK(again.value_of("word")->is_scalar());
  CHECK(again.value_of("empty")->is_list());
  CHECK(again.value_of("none")->is_map());
  Diagnostics faults;
  CHECK(again.value_of("odd key: ")->prose(faults, "odd") == "line\nbreak");
  CHECK(again.value_of("list")->items()[0].value_of("name")->text(faults, "name") == "a: b # c");
  CHECK_FALSE(faults.has_errors());
}

TEST_CASE("variables are replaced in scalars and unknown ones told once", "[yaml]") {
  const YamlNode node =
      YamlNode::parse("id: trial ${seat}\nseat: '${seat}'\nplain: $${seat} $5\nn: ${count}\n", "f.yaml");
  Diagnostics faults;
  YamlMap map(node.with({{"seat", "S7"}, {"count", "12"}}, faults), faults, "trial");
  CHECK(map.text("id") == "trial S7");
  CHECK(map.text("seat") == "S7");
  CHECK(map.text("plain") == "${seat} $5");
  CHECK(map.integer("n", 0) == 12);
  CHECK(faults.issues().empty());
  for (int i = 0; i < 2; ++i) (void)node.with({{"seat", "S7"}, {"counts", "12"}}, faults);
  CHECK(lines(faults) ==
        std::vector<std::string>{"f.yaml:4:4: error: '${count}' is not defined (did you mean 'counts'?)"});
}
