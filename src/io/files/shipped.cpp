#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <string>

#include "core/text.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"

namespace pirsim::io {
namespace {

namespace fs = std::filesystem;

struct Kind {
  DataKind kind;
  std::string_view folder;
  std::array<std::string_view, 2> endings;  ///< what else lies there is about the data: pages, where numbers come from
};

constexpr std::array kinds{
    Kind{DataKind::rooms, "rooms", {".gltf", ".glb"}},      Kind{DataKind::studies, "studies", {".yaml", ".yml"}},
    Kind{DataKind::recipes, "recipes", {".yaml", ".yml"}},  Kind{DataKind::sensors, "sensors", {".yaml", ".yml"}},
    Kind{DataKind::measured, "measured", {".csv", ".csv"}},
};

/// By name.
std::map<std::string, fs::path> files_of(const Kind& kind, std::span<const fs::path> folders) {
  std::map<std::string, fs::path> files;
  for (const fs::path& folder : folders) {
    std::error_code fault;
    for (fs::directory_iterator entry(folder / kind.folder, fault), end; !fault && entry != end;
         entry.increment(fault)) {
      const fs::path& path = entry->path();
      if (std::ranges::find(kind.endings, path.extension().string()) == kind.endings.end()) continue;
      files.emplace(path.filename().string(), path.lexically_normal());  // the first of a name stays
    }
  }
  return files;
}

constexpr const char* dangling = "is a link to a file that isn't there";

const Kind& of(DataKind kind) { return *std::ranges::find(kinds, kind, &Kind::kind); }

}  // namespace

std::string_view folder_of(DataKind kind) { return of(kind).folder; }

std::vector<fs::path> data_folders(std::span<const fs::path> data_directories) {
  std::vector<fs::path> folders;
  std::error_code fault;
  if (const char* own = std::getenv("PIRSIM_DATA_DIR"); own != nullptr && *own != '\0') {
    if (!fs::is_directory(own, fault))
      throw Error(ErrorCode::io, Where{own}, "PIRSIM_DATA_DIR: there is no such folder");
    folders.emplace_back(own);
  }
  folders.insert(folders.end(), data_directories.begin(), data_directories.end());
  return folders;
}

std::vector<ShippedFile> shipped_files(std::span<const fs::path> data_directories) {
  const std::vector<fs::path> folders = data_folders(data_directories);
  std::vector<ShippedFile> all;
  for (const Kind& kind : kinds) {
    for (const auto& [name, path] : files_of(kind, folders)) all.push_back({kind.kind, path});
  }
  return all;
}

fs::path find_file(const fs::path& file, DataKind kind, std::span<const fs::path> data_directories) {
  std::error_code fault;
  if (fs::exists(file, fault)) return file;
  if (fs::is_symlink(file, fault)) throw Error(ErrorCode::io, Where{file.string()}, dangling);
  const auto files = files_of(of(kind), data_folders(data_directories));
  if (file.has_parent_path()) {
    const std::string bare = file.filename().string();
    if (!files.contains(bare)) return file;
    throw Error(ErrorCode::io, Where{file.string()}, "no such file; '" + bare + "' without a folder is a shipped one");
  }
  const std::string name = file.string();
  if (const auto shipped = files.find(name); shipped != files.end()) return shipped->second;
  std::vector<std::string> names;
  for (const auto& [known, path] : files) names.push_back(known);
  std::string among;
  if (!names.empty()) among = ", nor one among the shipped " + std::string(folder_of(kind)) + near_or_all(name, names);
  throw Error(ErrorCode::io, Where{name}, "no such file" + among);
}

NamedFile find_beside(const fs::path& folder, const fs::path& file, DataKind kind,
                      std::span<const fs::path> data_directories) {
  std::error_code fault;
  const fs::path beside = folder / file;
  if (fs::exists(beside, fault) && !fs::is_directory(beside, fault)) return {beside, {}};
  if (!fs::exists(beside, fault) && fs::is_symlink(beside, fault))
    return {beside, "'" + beside.string() + "' " + dangling};
  const auto files = files_of(of(kind), data_folders(data_directories));
  const std::string bare = file.filename().string();
  const auto shipped = files.find(bare);
  const std::string none = "there is no file '" + beside.string() + "'";
  if (file.has_parent_path()) {
    const bool is_shipped = shipped != files.end();
    return {beside, none + (is_shipped ? "; '" + bare + "' without a folder is a shipped one" : "")};
  }
  if (shipped != files.end()) return {shipped->second, {}};
  std::vector<std::string> names;
  for (const auto& [known, path] : files) names.push_back(known);
  return {beside, none + did_you_mean(bare, names)};
}

}  // namespace pirsim::io
