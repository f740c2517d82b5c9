#include "app/output_checks.hpp"

#include <algorithm>
#include <map>

#include "io/atomic_file.hpp"
#include "pirsim/error.hpp"

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

}  // namespace pirsim::app
