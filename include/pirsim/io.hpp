// Reading what users write: scenes (glTF 2.0), scripts, sensors and surveys (YAML). Formats: docs/formats.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "pirsim/sensor.hpp"
#include "pirsim/survey.hpp"

namespace pirsim::io {

// Rooms from glTF 2.0 files. How a room is marked up: docs/formats/scene.md.

struct SceneOptions {
  /// Where `<model>.yaml` of a sensor is looked for first; then in `sensors` beside the scene and beside its folder,
  /// in `$PIRSIM_DATA_DIR/sensors` and in `sensors` of the data_directories. The library itself carries the shipped
  /// models.
  std::vector<std::filesystem::path> sensor_directories;
  std::vector<std::filesystem::path> data_directories{};
  /// Marks for a scene that is left as it is, as YAML (docs/formats/scene.md); beside it are sensors looked for, too.
  std::filesystem::path marks{};
};

/// Reads a .gltf or .glb file with everything it refers to. Meshes are in world coordinates and cleaned.
/// Throws Error(io) for a file that can't be read and Error(input) with all faults of the file that could be told
/// apart; what was repaired or ignored stands in SceneSpec::warnings.
[[nodiscard]] SceneSpec read_scene(const std::filesystem::path& file, const SceneOptions& options = {});

/// Writes a scene that read_scene() reads back: .glb, or by any other extension .gltf with its buffer embedded.
/// Positions are stored in single precision. Throws Error(io), and Error(usage) for a floor with holes or of several
/// parts.
void write_scene(const std::filesystem::path& file, const SceneSpec& scene);

// Studies as YAML; the format is described in docs/formats/script.md.

/// Reads and validates a script. Each override is `sensing.rays_per_zone=9`: it replaces a value before reading.
/// The files that it names are looked for as find_beside() does, and last in these folders.
/// Throws Error (io: no such file; input: all faults with file:line:column; usage: an override).
[[nodiscard]] ScriptSpec read_script(const std::filesystem::path& file, std::span<const std::string> overrides = {},
                                     std::span<const std::filesystem::path> data_directories = {});

/// Reads a script from memory; `name` stands in messages, and its files are found from the working folder.
[[nodiscard]] ScriptSpec parse_script(std::string_view text, const std::string& name,
                                      std::span<const std::string> overrides = {},
                                      std::span<const std::filesystem::path> data_directories = {});

/// The script as YAML that read_script() reads back to the same spec: trials and people written out.
[[nodiscard]] std::string to_yaml(const ScriptSpec& script);

/// This script for a file in another folder: the files that it refers to are found from there.
[[nodiscard]] ScriptSpec moved(ScriptSpec script, const std::filesystem::path& folder);

// Reads a sensor's optics; the format is docs/formats/sensor.md.

/// data/sensors/*.yaml. Facets with a zone law are expanded to zones' corners. Throws Error (io, input).
[[nodiscard]] SensorModelSpec read_sensor_model(const std::filesystem::path& path);

// Sensor models by name.

/// The model that a sensor of this scene would get. Throws Error(input), at `named_at`, for a name that no folder has.
[[nodiscard]] SensorModelSpec find_sensor_model(const std::string& model, const std::filesystem::path& scene_file,
                                                const SceneOptions& options = {}, const Where& named_at = {});

// Coverage studies as YAML; the format is described in docs/formats/coverage.md.

/// Reads and validates; overrides as in read_script(). Throws Error (io, input, usage).
[[nodiscard]] CoverageSpec read_coverage(const std::filesystem::path& file,
                                         std::span<const std::string> overrides = {});

// Walk tests as YAML; the format is described in docs/formats/coverage.md.

/// Reads and validates; overrides as in read_script(). Throws Error (io, input, usage).
[[nodiscard]] WalkTestSpec read_walk_test(const std::filesystem::path& file,
                                          std::span<const std::string> overrides = {});

// Comparisons of sensor placements as YAML; the format is described in docs/formats/coverage.md.

/// Reads and validates; overrides and folders as in read_script(). Throws Error (io, input, usage).
[[nodiscard]] PlacementSpec read_placements(const std::filesystem::path& file,
                                            std::span<const std::string> overrides = {},
                                            std::span<const std::filesystem::path> data_directories = {});

// What is uncertain about a real room, as YAML; the format is described in docs/formats/reconcile.md.

/// Throws Error (io: no such file; input: all faults with file:line:column).
[[nodiscard]] NuisanceSpec read_nuisance(const std::filesystem::path& file);

// The data that comes with pirsim, found by name.

/// Its kinds. Each is a folder of data/.
enum class DataKind { rooms, plans, studies, recipes, sensors, measured };
/// "rooms".
[[nodiscard]] std::string_view folder_of(DataKind kind);

struct ShippedFile {
  DataKind kind;
  std::filesystem::path path;
};

/// Where it is looked for: `$PIRSIM_DATA_DIR`, then these folders, in which the kinds' folders lie.
[[nodiscard]] std::vector<std::filesystem::path> data_folders(
    std::span<const std::filesystem::path> data_directories = {});

/// All of it, by kind and then by name. Of files with one name the first folder's counts.
[[nodiscard]] std::vector<ShippedFile> shipped_files(std::span<const std::filesystem::path> data_directories = {});

/// The file itself if it exists, else the shipped one of that kind and name. Throws Error(io), with the nearest name,
/// if there is neither, and where a folder is named that lacks a shipped one. A file of any other folder is left to
/// whoever opens it.
[[nodiscard]] std::filesystem::path find_file(const std::filesystem::path& file, DataKind kind,
                                              std::span<const std::filesystem::path> data_directories = {});

struct NamedFile {
  std::filesystem::path path;  ///< beside the input that names it, or shipped
  std::string fault;           ///< "there is no file 'counts.csv'", with what is meant; empty: there is one
};

/// A file that an input names: in `folder`, where the input lies, or else the shipped one of that kind and name. A name
/// with a folder is that file alone.
[[nodiscard]] NamedFile find_beside(const std::filesystem::path& folder, const std::filesystem::path& file,
                                    DataKind kind, std::span<const std::filesystem::path> data_directories = {});

}  // namespace pirsim::io
