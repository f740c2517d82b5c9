#include "app/commands.hpp"

#include <algorithm>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/session.hpp"
#include "engine/effects/catalogue.hpp"
#include "model/core/text.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/error.hpp"

namespace pirsim::app {
namespace {

CLI::App& find_command(CLI::App& parent, const std::string& name) {
  for (CLI::App* command : parent.get_subcommands(nullptr)) {
    if (command->check_name(name)) return *command;
  }
  const std::string owner = spoken_name(parent);
  throw Error(ErrorCode::usage, "help: '" + name + "' isn't a command" + (owner.empty() ? "" : " of '" + owner + "'") +
                                    did_you_mean(name, offered_commands(parent)));
}

/// CLI::App::help() would tell of the command that was called, which is `help`.
void print_help(CLI::App& app, const std::vector<std::string>& names) {
  CLI::App* command = &app;
  std::string spoken = app.get_name();
  for (const std::string& name : names) {
    command = &find_command(*command, name);
    spoken += ' ' + name;
  }
  std::cout << command->get_formatter()->make_help(command, spoken, CLI::AppFormatMode::Normal);
  require_written();
}

}  // namespace

void add_help_command(CLI::App& app) {
  CLI::App& command = add_command(app, "help", "options and examples of a command", R"(
  pirsim help                                                      as pirsim --help
  pirsim help reconcile plan                                       as pirsim reconcile plan --help
)");
  const auto names = std::make_shared<std::vector<std::string>>();
  command.add_option("command", *names, "which command (default: pirsim itself)")->option_text("CMD");
  command.callback([&app, names] { print_help(app, *names); });
}

namespace {

namespace fs = std::filesystem;

std::vector<io::ShippedFile> all_files() {
  std::vector<io::ShippedFile> files = io::shipped_files(data_directories());
  if (!files.empty()) return files;
  std::vector<std::string> searched;
  for (const fs::path& folder : io::data_folders(data_directories())) searched.push_back("'" + folder.string() + "'");
  throw Error(ErrorCode::io, "the data that comes with pirsim isn't in " + joined(searched, ", ") +
                                 "; PIRSIM_DATA_DIR can name its folder");
}

/// What a file of sensors describes; nothing of another kind, nor of a faulty file, whose faults are its users' affair.
std::optional<SensorModelSpec> model_in(const io::ShippedFile& file) {
  if (file.kind != io::DataKind::sensors) return std::nullopt;
  try {
    return io::read_sensor_model(file.path);
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// Each folder, and below it the names of its files; of sensors also what they are, and in which products.
void list_files() {
  fs::path folder;
  for (const io::ShippedFile& file : all_files()) {
    if (file.path.parent_path() != folder) {
      std::cout << (folder.empty() ? "" : "\n") << file.path.parent_path().string() << '\n';
      folder = file.path.parent_path();
    }
    std::cout << "  " << file.path.filename().string();
    if (const auto model = model_in(file)) {
      std::cout << "  " << model->description << (model->names.empty() ? "" : " (" + joined(model->names, ", ") + ')');
    }
    std::cout << '\n';
  }
}

void tell_path(const std::string& name) {
  std::vector<std::string> names;
  for (const io::ShippedFile& file : all_files()) {
    names.push_back(file.path.filename().string());
    if (names.back() != name) continue;
    std::cout << file.path.string() << '\n';
    return;
  }
  const auto is_meant = [&](const std::string& known) { return bare_name(known) == bare_name(name); };
  for (const io::ShippedFile& file : all_files()) {
    const auto model = model_in(file);
    if (!model) continue;
    if (is_meant(file.path.stem().string()) || std::ranges::any_of(model->names, is_meant)) {
      std::cout << file.path.string() << '\n';
      return;
    }
    names.insert(names.end(), model->names.begin(), model->names.end());
  }
  throw Error(ErrorCode::usage, "data: '" + name + "' isn't shipped" + near_or_all(name, names));
}

}  // namespace

void add_data_command(CLI::App& app) {
  CLI::App& command =
      add_command(app, "data", "list the rooms, studies, recipes and sensors that come with pirsim", R"x(
  pirsim data                                                      where they are, and their names
  pirsim check --scene meeting_room.gltf --script studyA.yaml      a shipped name will do for a file that isn't here
  cp "$(pirsim data studyA.yaml)" .                                one to begin with
  pirsim data "everything presence one"                            the file of the sensor that a product has
)x");
  const auto name = std::make_shared<std::string>();
  command.add_option("name", *name, "where this one is")->option_text("NAME");
  command.callback([name] {
    name->empty() ? list_files() : tell_path(*name);
    require_written();
  });
}

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
