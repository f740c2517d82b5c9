#include "io/read/file_kinds.hpp"

#include <array>

#include "pirsim/error.hpp"

namespace pirsim::io {
namespace {

struct FileKind {
  std::string_view version_key, told;
};
constexpr std::array<FileKind, 9> file_kinds{
    {{"pirsim_script", "a script: `--script` of run, check, preview and others takes it"},
     {"pirsim_walk_test", "a walk test: `pirsim walktest --script` takes it"},
     {"pirsim_coverage", "a coverage study: `pirsim coverage --script` takes it"},
     {"pirsim_placements", "a placement study: `pirsim placements --script` takes it"},
     {"pirsim_nuisance", "a nuisance file: `pirsim reconcile --nuisance` takes it"},
     {"pirsim_recipe", "a recipe: `pirsim dataset` and `pirsim room` take it"},
     {"pirsim_marks", "marks for a scene: `--marks` takes them beside `--scene`"},
     {"pirsim_log", "a map of a log: `pirsim log --map` takes it"},
     {"asset", "a glTF scene: `--scene` takes it"}}};

}  // namespace

std::string kind_of_text(std::string_view text) {
  for (const FileKind& kind : file_kinds) {
    const std::string key = std::string(kind.version_key) + ':';
    if (text.starts_with(key) || text.find('\n' + key) != std::string_view::npos) return std::string(kind.told);
  }
  return {};
}

void refuse_other_kinds(const YamlMap& map, const std::string& version_key) {
  if (map.has(version_key)) return;
  for (const FileKind& kind : file_kinds) {
    const std::string key(kind.version_key);
    if (map.has(key)) throw Error(ErrorCode::input, map.where(key), "this is " + std::string(kind.told));
  }
}

}  // namespace pirsim::io
