// The documents say what the code says.
#include <fstream>
#include <sstream>

#include "engine/effects/catalogue.hpp"
#include "property/engine/effects/warm_up.cpp"
#include "support/catch.hpp"
#include "support/effects.hpp"
#include "support/paths.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(tests_dir() / ".." / file);
  REQUIRE(in);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Text between two bars of a table's row; 0 is what is before the first bar.
std::string cell(const std::string& row, int number) {
  std::istringstream cells(row);
  std::string text;
  for (int i = 0; i <= number; ++i) REQUIRE(static_cast<bool>(std::getline(cells, text, '|')));
  return text;
}

}  // namespace

TEST_CASE("docs/effects.md ends with the catalogue as the program lists it") {
  const std::string document = text_of("docs/effects.md"), list = effects::list_markdown();
  REQUIRE(document.size() > list.size());
  CHECK(document.substr(document.size() - list.size()) == list);
}

TEST_CASE("the page states which values each parameter takes, and a script may give these and no others") {
  const std::string document = text_of("docs/effects.md");
  const auto faults_of = [](const EffectSpec& spec) {
    Diagnostics diagnostics;
    effects::check(std::span(&spec, 1), diagnostics);
    return diagnostics.issues().size();
  };
  const auto number = [](double value) {
    std::ostringstream out;
    out << value;
    return out.str();
  };
  for (const effects::EffectInfo& info : effects::list()) {
    const std::size_t section = document.find("### " + info.name + "\n");
    REQUIRE(section != std::string::npos);
    for (const effects::ParameterInfo& parameter : info.parameters) {
      INFO(info.name << '.' << parameter.name);
      const std::size_t row = document.find("| `" + parameter.name + "` | ", section);
      REQUIRE(row != std::string::npos);
      const std::string accepted = cell(document.substr(row, document.find('\n', row) - row), 5);
      CHECK(accepted.starts_with(" " + number(parameter.least) + " to " + number(parameter.most) + " "));
      EffectSpec spec{info.name, {}, {}, {}};
      if (!parameter.only_if.choice.empty()) spec.choices[parameter.only_if.choice] = parameter.only_if.word;
      const double beyond = 1e-3 * (parameter.most - parameter.least);
      for (const double value : {parameter.least, parameter.most}) {
        spec.parameters[parameter.name] = value;
        CHECK(faults_of(spec) == 0);
      }
      for (const double value : {parameter.least - beyond, parameter.most + beyond}) {
        spec.parameters[parameter.name] = value;
        CHECK(faults_of(spec) == 1);
      }
    }
  }
}

TEST_CASE("the how-to shows the file that is compiled and tested here") {
  const std::string document = text_of("docs/howto/add_an_effect.md");
  CHECK_THAT(document, contains("```cpp\n" + text_of("tests/property/engine/effects/warm_up.cpp") + "```\n"));
}

TEST_CASE("the effect of the how-to silences the first seconds and nothing after them") {
  const Model model = compile(shipped_scene("meeting_room.gltf"), short_study_a());
  const effects::Effect entry = effects::warm_up_effects().front();
  const EffectSpec spec = effects::resolved(entry, {"warm_up", {{"duration_s", 12.0}}, {}, {}});
  effects::Pipeline pipeline;
  REQUIRE(entry.info.reach == effects::Reach::triggers);
  pipeline.add(entry.make_stage(spec, {model.scene(), model.script().sensing, model.rays()}));
  pipeline.begin_run(1, 0);
  for (std::int64_t tick = 1; tick <= 1000; ++tick) {
    std::vector<std::uint8_t> triggers(5, 1);
    pipeline.hear(tick, triggers);
    REQUIRE(std::ranges::count(triggers, std::uint8_t{1}) == (tick <= 600 ? 0 : 5));
  }
}
