#include <algorithm>
#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "core/text.hpp"
#include "pirsim/error.hpp"

namespace pirsim::app {
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

}  // namespace pirsim::app
