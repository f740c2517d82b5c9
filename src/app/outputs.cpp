#include "app/outputs.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <map>

#include "app/session.hpp"
#include "io/csv_reader.hpp"
#include "pirsim/error.hpp"
#include "pirsim/version.hpp"

namespace pirsim::app {
namespace {

namespace fs = std::filesystem;

void check_ending(const NamedOutput& output) {
  const std::string name = output.file.filename().string();
  const auto fits = [&](const std::string& ending) { return name.size() > ending.size() && name.ends_with(ending); };
  if (std::any_of(output.endings.begin(), output.endings.end(), fits) || io::is_written_directly(output.file)) return;
  std::string known;
  for (std::size_t i = 0; i < output.endings.size(); ++i) {
    known += (i == 0 ? "" : i + 1 == output.endings.size() ? " or " : ", ") + output.endings[i];
  }
  throw Error(ErrorCode::usage, output.option + ": '" + output.file.string() + "' must end in " + known);
}

/// "rows.csv" in a folder that isn't there: its journal or partial file would be the first to be missed.
void check_folder(const NamedOutput& output) {
  const fs::path folder = output.file.parent_path();
  std::error_code unknown;
  const fs::file_status status = fs::status(folder, unknown);
  if (folder.empty() || fs::is_directory(status) || status.type() == fs::file_type::none) return;
  const std::string name = "'" + folder.string() + "'";
  throw Error(ErrorCode::io, Where{output.file.string()},
              "can't write: " + (fs::exists(status) ? name + " isn't a folder" : "there is no folder " + name));
}

/// The same for all names of one file, as far as it can be told.
std::string identity(const fs::path& file) {
  std::error_code fault;
  const fs::path whole = fs::weakly_canonical(fs::absolute(file, fault), fault);
  return fault ? file.lexically_normal().string() : whole.string();
}

}  // namespace

const std::vector<std::string>& table_endings() {
  static const std::vector<std::string> endings{".csv", ".csv.gz", ".csv.zst"};
  return endings;
}

void check_outputs(const std::vector<NamedOutput>& outputs, const Inputs& inputs) {
  std::map<std::string, std::string> taken;
  for (const auto& [option, file] : {std::pair("--scene", inputs.scene), std::pair("--script", inputs.script)}) {
    if (!file.empty()) taken.emplace(identity(file), option);
  }
  for (const NamedOutput& output : outputs) {
    if (output.file.empty()) continue;
    check_ending(output);
    check_folder(output);
    if (output.file == "/dev/null") continue;
    const auto [first, is_new] = taken.emplace(identity(output.file), output.option);
    if (is_new) continue;
    throw Error(ErrorCode::usage,
                first->second + " and " + output.option + " are one file: '" + output.file.string() + "'");
  }
}

bool is_below(const fs::path& file, const fs::path& folder) {
  const fs::path inner = identity(file), outer = fs::path(identity(folder / "any")).parent_path();
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

void make_folder(const fs::path& folder) {
  std::error_code fault;
  fs::create_directories(folder, fault);
  if (fault) throw Error(ErrorCode::io, Where{folder.string()}, "can't make the folder: " + fault.message());
}

std::vector<MeasuredCell> measured_cells(const ScriptSpec& script) {
  const std::string& reference = script.summary.reference_file;
  if (reference.empty()) return {};
  return io::read_measured_cells(std::filesystem::path(script.directory) / reference);
}

void write_summary(const studies::Summary& summary, io::AtomicFile& file, const std::filesystem::path& path,
                   const std::string& title, Verbosity verbosity) {
  const bool is_document = path.extension() == ".md";
  if (is_document) file.stream() << "# " << title << ": seconds with motion\n\n";
  file.stream() << (is_document ? studies::to_markdown(summary) : studies::to_csv(summary));
  file.commit();
  if (verbosity != Verbosity::quiet) std::cerr << studies::to_text(summary);
}

void write_page(io::AtomicFile& file, io::Report report, const Inputs& inputs) {
  report.footer = "pirsim " + version() + " (" + git_revision() + "), " + inputs.scene.filename().string() + ", " +
                  inputs.script.filename().string();
  file.stream() << io::to_html(report);
  file.commit();
}

void require_written() {
  if (std::cout.flush()) return;
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  if (poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0) throw ClosedPipe{};
  throw Error(ErrorCode::io, "standard output can't be written: is the disk full?");
}

}  // namespace pirsim::app
