#include "io/write/manifest.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "io/files/atomic_file.hpp"
#include "io/files/input.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {
namespace {

constexpr int format_version = 2;

using nlohmann::ordered_json;

void compare(const char* what, const std::string& one, const std::string& other, std::vector<std::string>& found) {
  if (one != other) found.push_back(std::string(what) + " (" + one + ", not " + other + ")");
}

void compare_inputs(const std::vector<HashedFile>& one, const std::vector<HashedFile>& other,
                    std::vector<std::string>& found) {
  if (one.size() != other.size()) {
    const auto only_in = [](const std::vector<HashedFile>& these, const std::vector<HashedFile>& those) {
      std::string names;
      for (const HashedFile& file : these) {
        if (std::ranges::count(these, file.name, &HashedFile::name) >
            std::ranges::count(those, file.name, &HashedFile::name))
          names += (names.empty() ? "" : ", ") + file.name;
      }
      return names;
    };
    const std::string more = only_in(one, other), fewer = only_in(other, one);
    found.push_back("input files (" + (more.empty() ? "" : "with " + more) +
                    (more.empty() || fewer.empty() ? "" : ", ") + (fewer.empty() ? "" : "without " + fewer) +
                    "; a shipped sensor model is among them only where pirsim finds its file)");
    return;
  }
  for (std::size_t i = 0; i < one.size(); ++i) {
    compare("name of an input", one[i].name, other[i].name, found);
    if (one[i].name == other[i].name && one[i].sha256 != other[i].sha256) {
      found.push_back("content of " + one[i].name);
    }
  }
}

ordered_json tree_of(const RunNotes& notes) {
  ordered_json tree;
  tree["passes_through"] = notes.passes_through;
  if (!notes.first_pass.empty()) tree["first_pass"] = notes.first_pass;
  tree["seats_changed"] = notes.seats_changed;
  tree["seats_missed"] = notes.seats_missed;
  if (notes.waits_outside > 0) {
    tree["waits_outside"] = notes.waits_outside;
    tree["first_wait"] = notes.first_wait;
  }
  tree["failed_runs"] = ordered_json::array();
  for (const FailedRun& run : notes.failed) {
    ordered_json failed{{"run", run.run}, {"trial", run.trial}, {"replicate", run.replicate}, {"time_s", run.time_s}};
    if (!run.time.empty()) failed["time"] = run.time;
    failed["message"] = run.message;
    tree["failed_runs"].push_back(std::move(failed));
  }
  return tree;
}

ordered_json to_tree(const Manifest& manifest) {
  const Provenance& made = manifest.provenance;
  ordered_json inputs = ordered_json::array();
  for (const HashedFile& file : made.inputs) inputs.push_back({{"file", file.name}, {"sha256", file.sha256}});
  ordered_json tree = {{"pirsim_manifest", format_version},
                       {"version", made.version},
                       {"git_revision", made.git_revision},
                       {"compiler", made.compiler},
                       {"embree", made.embree},
                       {"tracer", manifest.tracer},
                       {"seed", made.seed},
                       {"study_runs", made.study_runs}};
  if (!manifest.table.empty()) tree["table"] = manifest.table;
  if (manifest.shard) tree["shard"] = {{"index", manifest.shard->index}, {"count", manifest.shard->count}};
  tree["first_run"] = manifest.runs.first;
  tree["runs"] = manifest.runs.count();
  tree["rows"] = manifest.rows;
  tree["bytes"] = manifest.bytes;
  tree["sha256"] = manifest.sha256;
  if (!manifest.notes.empty()) tree["people"] = tree_of(manifest.notes);
  tree["inputs"] = std::move(inputs);
  for (const auto& [sensor, response] : made.responses) tree["responses"][sensor] = response;
  tree["resolved_script"] = made.resolved_script;
  return tree;
}

/// A JSON number that counts something, and fits. Throws ordered_json::exception or std::out_of_range.
template <typename Number>
void take_count(const ordered_json& tree, Number& count) {
  const auto value = tree.get_ref<const ordered_json::number_unsigned_t&>();
  if (!std::in_range<Number>(value)) throw std::out_of_range("too large a number");
  count = static_cast<Number>(value);
}

RunNotes notes_from(const ordered_json& tree) {
  RunNotes notes;
  take_count(tree.at("passes_through"), notes.passes_through);
  notes.first_pass = tree.value("first_pass", "");
  take_count(tree.at("seats_changed"), notes.seats_changed);
  take_count(tree.at("seats_missed"), notes.seats_missed);
  if (tree.contains("waits_outside")) take_count(tree.at("waits_outside"), notes.waits_outside);
  notes.first_wait = tree.value("first_wait", "");
  for (const ordered_json& each : tree.at("failed_runs")) {
    FailedRun& run = notes.failed.emplace_back();
    take_count(each.at("run"), run.run);
    each.at("trial").get_to(run.trial);
    take_count(each.at("replicate"), run.replicate);
    each.at("time_s").get_to(run.time_s);
    run.time = each.value("time", "");
    each.at("message").get_to(run.message);
  }
  return notes;
}

Manifest from_tree(const ordered_json& tree) {
  Manifest manifest;
  Provenance& made = manifest.provenance;
  tree.at("version").get_to(made.version);
  tree.at("git_revision").get_to(made.git_revision);
  tree.at("compiler").get_to(made.compiler);
  tree.at("embree").get_to(made.embree);
  tree.at("tracer").get_to(manifest.tracer);
  manifest.table = tree.value("table", "");
  take_count(tree.at("seed"), made.seed);
  take_count(tree.at("study_runs"), made.study_runs);
  if (tree.contains("shard")) {
    Shard& shard = manifest.shard.emplace();
    take_count(tree.at("shard").at("index"), shard.index);
    take_count(tree.at("shard").at("count"), shard.count);
    if (shard.index < 1 || shard.index > shard.count) throw std::out_of_range("a shard that no study has");
  }
  std::uint64_t n_runs = 0;
  take_count(tree.at("first_run"), manifest.runs.first);
  take_count(tree.at("runs"), n_runs);
  if (n_runs > made.study_runs || manifest.runs.first > made.study_runs - n_runs)
    throw std::out_of_range("runs that the study doesn't have");
  manifest.runs.end = manifest.runs.first + static_cast<std::uint32_t>(n_runs);
  take_count(tree.at("rows"), manifest.rows);
  take_count(tree.at("bytes"), manifest.bytes);
  tree.at("sha256").get_to(manifest.sha256);
  if (tree.contains("people")) manifest.notes = notes_from(tree.at("people"));
  for (const ordered_json& file : tree.at("inputs")) made.inputs.push_back({file.at("file"), file.at("sha256")});
  if (tree.contains("responses")) {
    for (const auto& [sensor, response] : tree.at("responses").items())
      made.responses.emplace_back(sensor, response.get<std::string>());
  }
  tree.at("resolved_script").get_to(made.resolved_script);
  return manifest;
}

}  // namespace

RunNotes& RunNotes::operator+=(const RunNotes& other) {
  passes_through += other.passes_through;
  if (first_pass.empty()) first_pass = other.first_pass;
  seats_changed += other.seats_changed;
  seats_missed += other.seats_missed;
  waits_outside += other.waits_outside;
  if (first_wait.empty()) first_wait = other.first_wait;
  failed.insert(failed.end(), other.failed.begin(), other.failed.end());
  return *this;
}

bool RunNotes::empty() const noexcept {
  return passes_through == 0 && seats_changed == 0 && seats_missed == 0 && waits_outside == 0 && failed.empty();
}

std::string RunNotes::remarks() const {
  std::string text;
  const auto tell = [&](std::uint64_t n, const char* what) {
    if (n > 0) text += (text.empty() ? "" : " ") + std::string(what) + std::to_string(n) + '.';
  };
  tell(failed.size(), "Runs that failed and are left out: ");
  tell(passes_through, "Times that a person who was held up walked through others: ");
  tell(seats_changed, "Times that a person took another seat: ");
  tell(seats_missed, "Times that a person stayed without a seat: ");
  tell(waits_outside, "Times that a person waited outside for a seat that was taken: ");
  return text;
}

std::string to_json(const RunNotes& notes) {
  return tree_of(notes).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::optional<RunNotes> notes_from_json(const std::string& text) {
  try {
    return notes_from(ordered_json::parse(text));
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

std::vector<std::string> differences(const Provenance& one, const Provenance& other) {
  std::vector<std::string> found;
  compare("version", one.version, other.version, found);
  compare("git revision", one.git_revision, other.git_revision, found);
  compare("compiler", one.compiler, other.compiler, found);
  compare("Embree", one.embree, other.embree, found);
  compare("seed", std::to_string(one.seed), std::to_string(other.seed), found);
  compare("number of runs in the study", std::to_string(one.study_runs), std::to_string(other.study_runs), found);
  compare_inputs(one.inputs, other.inputs, found);
  if (found.empty() && one.resolved_script != other.resolved_script) found.emplace_back("resolved script");
  return found;
}

std::vector<HashedFile> named(const std::vector<InputFile>& files) {
  std::vector<HashedFile> result;
  for (const InputFile& file : files) result.push_back({name_of_input(file.path), file.sha256});
  return result;
}

std::string to_json(const Manifest& manifest, int indent) {
  return to_tree(manifest).dump(indent, ' ', false, ordered_json::error_handler_t::replace);
}

Manifest manifest_from_json(const std::string& text, const std::string& name) {
  try {
    const ordered_json tree = ordered_json::parse(text);
    if (const int version = tree.at("pirsim_manifest").get<int>(); version != format_version) {
      throw Error(ErrorCode::input, Where{name},
                  "manifest of format " + std::to_string(version) + "; this pirsim reads format " +
                      std::to_string(format_version));
    }
    return from_tree(tree);
  } catch (const nlohmann::json::exception&) {
    throw Error(ErrorCode::input, Where{name}, "is no manifest of pirsim, or is damaged");
  } catch (const std::out_of_range& fault) {
    throw Error(ErrorCode::input, Where{name}, std::string("is damaged: it names ") + fault.what());
  }
}

std::filesystem::path manifest_path(const std::filesystem::path& data_file) {
  std::filesystem::path path = data_file;
  return path += ".json";
}

void write_manifest(const std::filesystem::path& file, const Manifest& manifest) {
  AtomicFile out(file);
  out.stream() << to_json(manifest, 2) << '\n';
  out.commit();
}

Manifest read_manifest(const std::filesystem::path& file) {
  constexpr std::size_t max_bytes = 1'000'000'000;  // a script with all of its trials written out, and every failed run
  return manifest_from_json(read_text_file(file, max_bytes), file.string());
}

}  // namespace pirsim::io
