#include "app/files.hpp"

#include <fnmatch.h>
#include <sys/stat.h>

#include <algorithm>
#include <tuple>

#include "io/files/atomic_file.hpp"
#include "pirsim/error.hpp"

namespace pirsim::app {
namespace {

namespace fs = std::filesystem;

/// Without links, as far as it is there.
fs::path whole(const fs::path& file) {
  std::error_code fault;
  const fs::path path = fs::weakly_canonical(fs::absolute(file, fault), fault);
  return fault ? file.lexically_normal() : path;
}

/// Do they name one file? Links, hard ones too, and letters that a file system takes for one another are names of it.
bool is_one_file(const fs::path& one, const fs::path& other) {
  struct stat a {
  }, b{};
  const bool is_there = ::stat(one.c_str(), &a) == 0;
  if (is_there != (::stat(other.c_str(), &b) == 0)) return false;
  return is_there ? a.st_dev == b.st_dev && a.st_ino == b.st_ino : whole(one) == whole(other);
}

bool fits(const std::string& pattern, const std::string& name) {
  return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

/// Is or will this be one of the folder's files? By its place, or since a link there, or another name, is it.
bool holds(const NamedFile& folder, const fs::path& file) {
  const std::string place = whole(file).lexically_relative(whole(folder.file)).string();
  return std::ranges::any_of(folder.contents, [&](const std::string& pattern) {
    if (fits(pattern, place) || fits(pattern + "/*", place)) return true;
    const fs::path names = fs::path(pattern).parent_path();
    std::error_code fault;
    for (fs::directory_iterator entry(folder.file / names, fault), end; !fault && entry != end;
         entry.increment(fault)) {
      if (fits(pattern, (names / entry->path().filename()).string()) && is_one_file(entry->path(), file)) return true;
    }
    return false;
  });
}

/// Is it the file, or one of the folder's?
bool takes(const NamedFile& one, const fs::path& file) {
  return one.contents.empty() ? is_one_file(one.file, file) : holds(one, file);
}

bool collide(const NamedFile& one, const NamedFile& other) {
  if (one.contents.empty()) return takes(other, one.file);
  if (other.contents.empty()) return takes(one, other.file);
  return whole(one.file) == whole(other.file) && std::ranges::any_of(one.contents, [&](const std::string& pattern) {
           return std::ranges::find(other.contents, pattern) != other.contents.end();
         });
}

std::string in_quotes(const fs::path& file) { return "'" + file.string() + "'"; }

void check_ending(const NamedFile& output) {
  const std::string name = output.file.filename().string();
  const auto is_end = [&](const std::string& ending) { return name.size() > ending.size() && name.ends_with(ending); };
  if (output.endings.empty() || std::ranges::any_of(output.endings, is_end)) return;
  if (io::is_written_directly(output.file)) return;
  throw Error(ErrorCode::usage,
              output.option + ": '" + output.file.string() + "' must end in " + in_words(output.endings));
}

/// Before hours of work: a file needs its folder, and a folder is made, unless a file is in the way.
void check_place(const NamedFile& output) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::io, Where{output.file.string()}, "can't write: " + why);
  };
  std::error_code unknown;
  const bool is_folder = !output.contents.empty();
  if (!is_folder && fs::is_directory(output.file, unknown)) refuse("it is a folder, and " + output.option + " a file");
  fs::path folder = is_folder ? output.file : output.file.parent_path();
  while (is_folder && folder.has_relative_path() && fs::status(folder, unknown).type() == fs::file_type::not_found)
    folder = folder.parent_path();
  const fs::file_status status = fs::status(folder, unknown);
  if (folder.empty() || fs::is_directory(status) || status.type() == fs::file_type::none) return;
  refuse(fs::exists(status) ? in_quotes(folder) + " isn't a folder" : "there is no folder " + in_quotes(folder));
}

[[noreturn]] void refuse(const NamedFile& one, const NamedFile& output, const char* why) {
  if (one.contents.empty() == output.contents.empty()) {
    throw Error(ErrorCode::usage, one.option + " and " + output.option +
                                      (one.contents.empty() ? " are one file: " : " are one folder: ") +
                                      in_quotes(one.file) + why);
  }
  const auto& [file, folder] = one.contents.empty() ? std::tie(one, output) : std::tie(output, one);
  throw Error(ErrorCode::usage, file.option + ": " + in_quotes(file.file) + " is one of the files of " + folder.option +
                                    " in " + in_quotes(folder.file) + why);
}

constexpr const char* lost = "; it would be overwritten";

std::vector<NamedFile> asked_for(const std::vector<Files::List>& lists) {
  std::vector<NamedFile> all;
  for (const Files::List& list : lists) {
    for (NamedFile& file : list()) {
      if (!file.file.empty()) all.push_back(std::move(file));
    }
  }
  return all;
}

}  // namespace

void Files::check() const {
  const std::vector<NamedFile> inputs = asked_for(inputs_), outputs = asked_for(outputs_);
  std::vector<NamedFile> before;
  std::error_code unknown;
  for (const NamedFile& output : outputs) {
    check_ending(output);
    const bool is_in_another = std::ranges::any_of(outputs, [&](const NamedFile& folder) {
      return &folder != &output && !folder.contents.empty() && is_below(output.file, folder.file);
    });
    if (!is_in_another) check_place(output);  // else its place may not be made yet
    for (const NamedFile& input : inputs) {
      // What isn't there, as a shipped file isn't here, can't be lost.
      const bool may_be_lost = !input.contents.empty() || fs::is_regular_file(input.file, unknown);
      if (may_be_lost && collide(input, output)) refuse(input, output, lost);
    }
    if (output.file == "/dev/null") continue;
    for (const NamedFile& other : before) {
      if (collide(other, output)) refuse(other, output, "");
    }
    before.push_back(output);
  }
}

void Files::keep(const std::vector<fs::path>& read) const {
  std::error_code unknown;
  for (const NamedFile& output : asked_for(outputs_)) {
    for (const fs::path& file : read) {
      if (!fs::is_regular_file(file, unknown) || !takes(output, file)) continue;
      throw Error(ErrorCode::usage, output.option + ": '" + file.string() + "' is read as an input" + lost);
    }
  }
}

std::string in_words(const std::vector<std::string>& endings) {
  std::string text;
  for (std::size_t i = 0; i < endings.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == endings.size() ? " or " : ", ") + endings[i];
  }
  return text;
}

bool is_below(const fs::path& file, const fs::path& folder) {
  const fs::path inner = whole(file), outer = (whole(folder / "any")).parent_path();
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

}  // namespace pirsim::app
