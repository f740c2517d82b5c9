// What a command reads and writes, as its options declare it: nothing that is read is written over.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace pirsim::app {

/// A file or folder of an option.
struct NamedFile {
  std::string option;                      ///< "--summary"
  std::filesystem::path file;              ///< or folder; empty: not asked for
  std::vector<std::string> endings = {};   ///< that an output's name may have; none: any
  std::vector<std::string> contents = {};  ///< of a folder: "recipe.yaml", "*.png", "pool" with all below; none: a file
};

/// Of one command. What is asked for is known once the options are.
class Files {
 public:
  using List = std::function<std::vector<NamedFile>()>;
  void add_inputs(List inputs) { inputs_.push_back(std::move(inputs)); }
  void add_outputs(List outputs) { outputs_.push_back(std::move(outputs)); }

  /// Tells what is wrong with the names of outputs before any work is done. Throws Error(usage) for an ending that
  /// isn't known, for two outputs in one place, and for an output in the place of an input, whatever their names are;
  /// Error(io) for a folder that is missing, a folder where a file is wanted, and a file where a folder is. What isn't
  /// a file, as /dev/stdout, is written over by nobody.
  void check() const;
  /// Throws Error(usage) for an output in the place of one of these files, which reading has found.
  void keep(const std::vector<std::filesystem::path>& read) const;

 private:
  std::vector<List> inputs_, outputs_;
};

/// ".csv, .csv.gz or .csv.zst"
[[nodiscard]] std::string in_words(const std::vector<std::string>& endings);
/// Would the file lie in that folder, however deep, or be the folder itself?
[[nodiscard]] bool is_below(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace pirsim::app
