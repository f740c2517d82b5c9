#include <iostream>

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

/// A line a parameter.
void print_csv(std::ostream& out, const effects::Effect& effect) {
  const effects::EffectInfo& info = effect.info;
  for (const effects::ParameterInfo& parameter : info.parameters) {
    const bool is_strength = parameter.role == effects::Role::strength;
    out << info.name << ',' << name(info.family) << ',' << info.stage << ',' << name(info.reach) << ','
        << parameter.name << ',' << parameter.unit << ',' << (is_strength ? io::csv_number(parameter.off) : "") << ','
        << io::csv_number(parameter.typical) << ',' << io::csv_number(parameter.low) << ','
        << io::csv_number(parameter.high) << ',' << name(parameter.scale) << ',' << io::csv_field(parameter.source)
        << ',' << io::csv_field(info.fingerprint) << ','
        << (parameter.only_if.choice.empty() ? "" : parameter.only_if.choice + ": " + parameter.only_if.word) << ','
        << io::csv_number(parameter.least) << ',' << io::csv_number(parameter.most) << '\n';
  }
}

void list_effects(const EffectsOptions& options) {
  std::vector<const effects::Effect*> chosen = effects::catalogue();
  if (!options.name.empty()) chosen = {&effects::find(options.name)};
  if (options.format == "csv") {
    std::cout << "effect,family,stage,reach,parameter,unit,off,typical,low,high,scale,source,fingerprint,only_if,least,"
                 "most\n";
    for (const effects::Effect* effect : chosen) print_csv(std::cout, *effect);
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
