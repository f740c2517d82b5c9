// What all commands share: they begin by reading and compiling, and end with checked outputs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "files/disk/compression.hpp"
#include "files/disk/file.hpp"
#include "files/write/summary.hpp"
#include "pirsim/io.hpp"
#include "pirsim/model.hpp"
#include "pirsim/script.hpp"
#include "show/report.hpp"

namespace pirsim::studies {
class CoverageStudy;
}

namespace pirsim::app {

/// Reads and compiles; warnings of the readers go to standard error unless quiet.
[[nodiscard]] Model load(const Inputs& inputs);
/// With warnings as the inputs ask for them, and progress told or not.
[[nodiscard]] Model load(const Inputs& inputs, Verbosity of_progress);
/// Compiles a script that the command made with the room that it reads.
[[nodiscard]] Model load(const Inputs& inputs, ScriptSpec script);
/// Index of a run. Throws Error(usage).
[[nodiscard]] std::uint32_t find_run(const Model& model, const RunChoice& choice);
/// Where a scene's sensors are looked for: what the user names, and last the data that came with this program. Throws
/// Error(io) if the user names what isn't a folder.
[[nodiscard]] io::SceneOptions scene_options(const Inputs& inputs);
/// Where the data that came with this program may lie.
[[nodiscard]] std::vector<std::filesystem::path> data_directories();
/// The file, or else the shipped one of that name. Throws Error(io), with the nearest name, if there is neither.
[[nodiscard]] std::filesystem::path found(io::DataKind kind, const std::filesystem::path& file);
/// Of --scene and --script, which may name shipped files. Throw as io::read_scene() and io::read_script(), and
/// Error(usage) for an output in the place of what was read.
[[nodiscard]] SceneSpec read_scene(const Inputs& inputs);
[[nodiscard]] ScriptSpec read_script(const Inputs& inputs);
void tell(const std::vector<Issue>& issues, Verbosity verbosity);
/// Of the room, by the study's `without`: who takes a shipped study for a room of their own may not expect it.
void tell_what_is_left_out(const studies::CoverageStudy& study, Verbosity verbosity);

/// How the name of a summary may end; write_summary() goes by it.
[[nodiscard]] const std::vector<std::string>& summary_endings();

/// Throws Error(usage) for an output of the command in the place of one of these files, which reading has found.
void keep_inputs(const Inputs& inputs, const std::vector<std::filesystem::path>& read);
/// What a model was made from, and what its summary refers to.
[[nodiscard]] std::vector<std::filesystem::path> files_read(const ScriptSpec& script, const SceneSpec& scene);
/// With all that it lies in. Throws Error(io).
void make_folder(const std::filesystem::path& folder);

/// Those that the script's summary refers to; none if it doesn't.
[[nodiscard]] std::vector<MeasuredCell> measured_cells(const ScriptSpec& script);
/// A document, which ends with the remarks, if `path` ends in .md, else CSV; and a copy on standard error unless all is
/// quiet.
void write_summary(const studies::Summary& summary, io::AtomicFile& file, const std::filesystem::path& path,
                   const std::string& title, const std::string& remarks, Verbosity verbosity);
/// Writes a report with what made it in the footer, and commits the file.
void write_page(io::AtomicFile& file, io::Report report, const Inputs& inputs);
struct WrittenFile {
  std::filesystem::path file;  ///< empty: not asked for
  std::string about = {};      ///< "30 rows"
};
/// "wrote rows.csv: 30 rows, table.md" on standard error, of those that were asked for and are no streams; nothing if
/// quiet.
void tell_written(const std::vector<WrittenFile>& files, Verbosity verbosity);
/// "pirsim 0.2.0 (1a2b3c4), room.gltf, marks.yaml, study.yaml"
[[nodiscard]] std::string made_by(const Inputs& inputs);
/// The program and the files' names; an empty path is none.
[[nodiscard]] std::string made_from(const std::vector<std::filesystem::path>& files);

/// Thrown when nobody reads standard output any more, as in `pirsim ... | head`.
struct ClosedPipe {};
/// Throws ClosedPipe, or Error(io), if standard output fails.
void require_written();

}  // namespace pirsim::app
