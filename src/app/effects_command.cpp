#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "effects/catalogue.hpp"
#include "pirsim/csv.hpp"

namespace pirsim::app {
namespace {

struct EffectsOptions {
  std::string name;  ///< empty: all
  std::string format = "text";
};

struct ParameterLine {
  const effects::EffectInfo& info;
  const effects::ParameterInfo& parameter;
  std::string only_if;
};

constexpr Column<ParameterLine> parameters[]{
    {{"effect", Holds::text, "its name"}, [](const ParameterLine& line) -> Cell { return line.info.name; }},
    {{"family", Holds::text, "what it is about"},
     [](const ParameterLine& line) -> Cell { return name(line.info.family); }},
    {{"stage", Holds::text, "where it acts"}, [](const ParameterLine& line) -> Cell { return line.info.stage; }},
    {{"reach", Holds::text, "what has to be simulated anew with it"},
     [](const ParameterLine& line) -> Cell { return name(line.info.reach); }},
    {{"parameter", Holds::text, "its name"}, [](const ParameterLine& line) -> Cell { return line.parameter.name; }},
    {{"unit", Holds::text, "empty: a pure number"},
     [](const ParameterLine& line) -> Cell { return line.parameter.unit; }},
    {{"off", Holds::number, "with this value of its strength the effect does nothing"},
     [](const ParameterLine& line) -> Cell {
       return line.parameter.role == effects::Role::strength ? Cell(line.parameter.off) : Cell();
     }},
    {{"typical", Holds::number, "what a script gets that doesn't say"},
     [](const ParameterLine& line) -> Cell { return line.parameter.typical; }},
    {{"low", Holds::number, "least that is expected"},
     [](const ParameterLine& line) -> Cell { return line.parameter.low; }},
    {{"high", Holds::number, "most that is expected"},
     [](const ParameterLine& line) -> Cell { return line.parameter.high; }},
    {{"scale", Holds::text, "on which values between them are alike"},
     [](const ParameterLine& line) -> Cell { return name(line.parameter.scale); }},
    {{"source", Holds::text, "of the range"}, [](const ParameterLine& line) -> Cell { return line.parameter.source; }},
    {{"fingerprint", Holds::text, "what the effect does to the data"},
     [](const ParameterLine& line) -> Cell { return line.info.fingerprint; }},
    {{"only_if", Holds::text, "a choice without which the parameter means nothing"},
     [](const ParameterLine& line) -> Cell { return line.only_if; }},
    {{"least", Holds::number, "least that is accepted"},
     [](const ParameterLine& line) -> Cell { return line.parameter.least; }},
    {{"most", Holds::number, "most that is accepted"},
     [](const ParameterLine& line) -> Cell { return line.parameter.most; }},
};

void print_csv(std::ostream& out, const std::vector<const effects::Effect*>& chosen) {
  io::TableWriter<ParameterLine> csv(out, std::span<const Column<ParameterLine>>(parameters));
  for (const effects::Effect* effect : chosen) {
    for (const effects::ParameterInfo& parameter : effect->info.parameters) {
      const effects::Condition& only = parameter.only_if;
      csv.write({effect->info, parameter, only.choice.empty() ? "" : only.choice + ": " + only.word});
    }
  }
}

void list_effects(const EffectsOptions& options) {
  std::vector<const effects::Effect*> chosen = effects::catalogue();
  if (!options.name.empty()) chosen = {&effects::find(options.name)};
  if (options.format == "csv") {
    print_csv(std::cout, chosen);
  } else if (options.format == "md") {
    std::cout << effects::list_markdown();
  } else if (!options.name.empty()) {
    std::cout << effects::to_text(*chosen.front());
  } else {
    std::cout << effects::list_text();
  }
  require_written();
}

}  // namespace

void add_effects_command(CLI::App& app) {
  CLI::App& command = add_command(app, "effects", "list what a script can add to the plain model", R"(
  pirsim effects                                                   all, one a line
  pirsim effects dead_time                                         one in detail
  pirsim effects --format csv                                      every parameter with its range
)");
  const auto options = std::make_shared<EffectsOptions>();
  command.add_option("name", options->name, "one effect in detail")->option_text("NAME");
  command.add_option("--format", options->format, "text, csv or md")
      ->option_text("NAME")
      ->check(CLI::IsMember({"text", "csv", "md"}));
  command.callback([options] { list_effects(*options); });
}

}  // namespace pirsim::app
