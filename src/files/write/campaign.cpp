#include "files/write/campaign.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "files/disk/compression.hpp"
#include "files/disk/file.hpp"
#include "files/write/row_file.hpp"
#include "model/core/random.hpp"
#include "pirsim/error.hpp"

namespace pirsim::studies {
namespace {

namespace fs = std::filesystem;
using ShardState = ShardReport::State;

/// What is known of one shard without reading its data. Of the manifest only what differs from shard to shard is kept:
/// there may be many thousands.
struct Entry {
  ShardReport report;
  fs::path file;
  std::string made;  ///< hash of the provenance
  io::Manifest brief;
};

std::string digest(const io::Provenance& provenance) {
  io::Manifest only;
  only.provenance = provenance;
  Sha256 hash;
  hash.add(io::to_json(only, -1));
  return hash.hex();
}

void read_manifest_of(Entry& entry) {
  try {
    entry.brief = io::read_manifest(io::manifest_path(entry.file));
    entry.made = digest(entry.brief.provenance);
    const RunRange runs = runs_of(entry.report.shard, entry.brief.provenance.study_runs);
    entry.brief.provenance.resolved_script.clear();
    entry.brief.provenance.inputs.clear();
    entry.report.state = ShardState::done;
    if (entry.brief.shard == entry.report.shard && entry.brief.runs == runs) return;
    entry.report.why = "its manifest is that of another shard";
  } catch (const Error& error) {
    if (error.code() != ErrorCode::input) throw;
    entry.report.why = error.issues().front().message;
  }
  entry.report.state = ShardState::broken;
}

/// Told as broken: whoever isn't of the largest party (the first one of them, if there are more).
void compare_provenances(std::vector<Entry>& entries) {
  std::map<std::string, std::size_t> parties;
  for (const Entry& entry : entries) {
    if (entry.report.state == ShardState::done) ++parties[entry.made];
  }
  const Entry* typical = nullptr;
  for (const Entry& entry : entries) {
    if (entry.report.state != ShardState::done) continue;
    if (typical == nullptr || parties[entry.made] > parties[typical->made]) typical = &entry;
  }
  std::map<std::string, const Entry*> by_hash;  // of the data: no two shards hold the same rows
  for (Entry& entry : entries) {
    if (entry.report.state != ShardState::done) continue;
    if (entry.made != typical->made) {
      const auto unlike = io::differences(io::read_manifest(io::manifest_path(entry.file)).provenance,
                                          io::read_manifest(io::manifest_path(typical->file)).provenance);
      entry.report.state = ShardState::broken;
      entry.report.why = "remove it: its inputs differ from those of " + typical->file.filename().string() + ":";
      for (const std::string& each : unlike) entry.report.why += ' ' + each;
    } else if (entry.brief.rows > 0 && !by_hash.emplace(entry.brief.sha256, &entry).second) {
      entry.report.state = ShardState::broken;
      entry.report.why = "holds the rows of " + by_hash[entry.brief.sha256]->file.filename().string();
    }
  }
}

struct Listing {
  std::uint32_t count = 0;
  std::map<std::uint32_t, std::vector<fs::path>> with_manifest;  ///< data files by index
  std::map<std::uint32_t, fs::path> begun;                       ///< something is there
};

Listing list_folder(const fs::path& folder) {
  std::error_code fault;
  fs::directory_iterator entry(folder, fault);
  if (fault) throw Error(ErrorCode::io, Where{folder.string()}, "can't be listed: " + fault.message());
  Listing listing;
  for (const fs::directory_iterator end; entry != end; entry.increment(fault)) {
    if (fault) throw Error(ErrorCode::io, Where{folder.string()}, "can't be listed: " + fault.message());
    const std::optional<Shard> shard = shard_of(entry->path().filename().string());
    if (!shard) continue;
    if (listing.count != 0 && listing.count != shard->count) {
      throw Error(ErrorCode::input, Where{folder.string()},
                  "holds shards of " + std::to_string(std::min(listing.count, shard->count)) + " and of " +
                      std::to_string(std::max(listing.count, shard->count)));
    }
    listing.count = shard->count;
    listing.begun[shard->index] = entry->path();
    if (entry->path().extension() == ".json") {
      listing.with_manifest[shard->index].push_back(fs::path(entry->path()).replace_extension());
    }
  }
  if (listing.count == 0) {
    throw Error(ErrorCode::input, Where{folder.string()}, "holds no shards (shard-0001-of-0100.csv and so on)");
  }
  return listing;
}

std::vector<Entry> survey(const fs::path& folder) {
  const Listing listing = list_folder(folder);
  std::vector<Entry> entries(listing.count);
  for (std::uint32_t i = 0; i < listing.count; ++i) {
    Entry& entry = entries[i];
    entry.report.shard = {i + 1, listing.count};
    const auto found = listing.with_manifest.find(i + 1);
    if (found == listing.with_manifest.end()) {
      if (listing.begun.contains(i + 1)) entry.report.state = ShardState::unfinished;
    } else if (found->second.size() > 1) {
      entry.report.state = ShardState::broken;
      entry.report.why = "is there more than once: " + found->second[0].filename().string() + " and " +
                         found->second[1].filename().string();
    } else {
      entry.file = found->second.front();
      read_manifest_of(entry);
    }
  }
  compare_provenances(entries);
  return entries;
}

/// Copies the rows of one shard, its header only if it is the first, and checks hash and header.
class Merger {
 public:
  Merger(io::AtomicFile& file, io::Compression compression, const Sink& sink)
      : file_(file), writer_(file.stream(), compression), sink_(sink) {}

  void add(const Entry& entry) {
    io::DataReader reader(entry.file);
    io::DataCheck check(entry.brief);
    std::string header;
    bool in_header = true;
    while (const std::size_t n = reader.read(buffer_.data(), buffer_.size())) {
      std::string_view part(buffer_.data(), n);
      check.add(part);
      if (in_header) {
        const std::size_t end = part.find('\n');
        in_header = end == std::string_view::npos;
        header += part.substr(0, in_header ? part.size() : end + 1);
        part.remove_prefix(in_header ? part.size() : end + 1);
        if (header.size() > longest_header || check.is_too_long()) break;
        if (!in_header) take_header(header, entry);
      }
      write(part);
    }
    if (const std::string fault = check.fault(); !fault.empty()) {
      throw Error(ErrorCode::input, Where{entry.file.string()},
                  "its content differs from what its manifest says: " + fault);
    }
  }
  /// Fills in bytes and hash.
  void finish(io::Manifest& manifest) {
    writer_.finish();
    file_.commit();
    manifest.bytes = bytes_;
    manifest.sha256 = hash_.hex();
  }

 private:
  static constexpr std::size_t longest_header = 1U << 24U;

  void take_header(const std::string& header, const Entry& entry) {
    if (header_.empty()) {
      header_ = header;
      write(header);
    } else if (header != header_) {
      throw Error(ErrorCode::input, Where{entry.file.string(), 1, 1}, "its columns are not those of the first shard");
    }
  }
  void write(std::string_view part) {
    hash_.add(part);
    bytes_ += part.size();
    if (sink_) sink_(part);
    writer_.write(part);
    if (!file_.stream()) file_.commit();  // says why it can't be written
  }

  io::AtomicFile& file_;
  io::DataWriter writer_;
  const Sink& sink_;
  std::string buffer_ = std::string(1U << 18U, '\0');
  std::string header_;
  Sha256 hash_;
  std::uint64_t bytes_ = 0;
};

/// What makes a shard, or goes on with it; "N/5" for any of five.
std::string option_of(const Shard& shard) {
  return "--shard " + (shard.index == 0 ? "N" : std::to_string(shard.index)) + '/' + std::to_string(shard.count) +
         " --resume";
}

const char* name(ShardState state) {
  switch (state) {
    case ShardState::done:
      return "done";
    case ShardState::missing:
      return "missing";
    case ShardState::unfinished:
      return "unfinished";
    case ShardState::broken:
      break;
  }
  return "broken";
}

}  // namespace

std::vector<ShardReport> campaign_status(const fs::path& folder) {
  std::vector<ShardReport> reports;
  for (Entry& entry : survey(folder)) {
    if (entry.report.state == ShardState::done) {
      entry.report.why = io::fault_of_data(entry.file, entry.brief);
      if (!entry.report.why.empty()) entry.report.state = ShardState::broken;
    }
    reports.push_back(std::move(entry.report));
  }
  return reports;
}

std::string array_specification(const std::vector<ShardReport>& shards) {
  std::string text;
  for (std::size_t i = 0; i < shards.size(); ++i) {
    if (shards[i].state == ShardState::done) continue;
    const std::size_t first = i;
    while (i + 1 < shards.size() && shards[i + 1].state != ShardState::done) ++i;
    text += (text.empty() ? "" : ",") + std::to_string(shards[first].shard.index);
    if (i > first) text += '-' + std::to_string(shards[i].shard.index);
  }
  return text;
}

std::string to_text(const std::vector<ShardReport>& shards) {
  std::string text;
  std::size_t done = 0;
  for (const ShardReport& each : shards) {
    if (each.state == ShardState::done) {
      ++done;
      continue;
    }
    text += shard_name(each.shard) + ": " + name(each.state) + (each.why.empty() ? "" : ": ") + each.why + '\n';
  }
  text += std::to_string(done) + " of " + std::to_string(shards.size()) + " shards are done";
  if (done < shards.size())
    text += "; run the others by their command with " + option_of({0, shards.front().shard.count});
  return text + '\n';
}

io::Provenance campaign_provenance(const fs::path& folder) {
  for (const Entry& entry : survey(folder)) {
    if (entry.report.state == ShardState::done) return io::read_manifest(io::manifest_path(entry.file)).provenance;
  }
  throw Error(ErrorCode::input, Where{folder.string()}, "no shard is finished");
}

io::Manifest merge_campaign(const fs::path& folder, const fs::path& output, const Sink& sink) {
  const std::vector<Entry> entries = survey(folder);
  Diagnostics faults;
  for (const Entry& entry : entries) {
    if (entry.report.state == ShardState::done) continue;
    const std::string why = entry.report.why.empty() ? "" : ": " + entry.report.why;
    faults.error(Where{(folder / shard_name(entry.report.shard)).string()},
                 name(entry.report.state) + why + "; run it by its command with " + option_of(entry.report.shard));
  }
  faults.throw_if_errors();

  io::Manifest manifest = io::read_manifest(io::manifest_path(entries.front().file));
  manifest.shard.reset();
  manifest.runs = {0, manifest.provenance.study_runs};
  manifest.rows = 0;
  manifest.notes = {};
  const fs::path side_car = io::manifest_path(output);
  io::AtomicFile file(output);
  Merger merger(file, io::compression_of(output), sink);
  std::uint32_t next_run = 0;
  for (const Entry& entry : entries) {
    if (entry.brief.runs.first != std::exchange(next_run, entry.brief.runs.end)) {
      throw Error(ErrorCode::input, Where{entry.file.string()}, "its runs don't follow those of the shard before");
    }
    merger.add(entry);
    manifest.rows += entry.brief.rows;
    manifest.notes += entry.brief.notes;
  }
  if (next_run != manifest.provenance.study_runs) {
    throw Error(ErrorCode::input, Where{folder.string()}, "the last runs of the study are missing");
  }
  std::error_code ignored;
  fs::remove(side_car, ignored);  // of an older file: it must not speak for the new one
  merger.finish(manifest);
  if (!io::is_written_directly(output)) io::write_manifest(side_car, manifest);
  return manifest;
}

namespace {

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::usage, "--shard: " + message); }

std::optional<std::uint32_t> whole_number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  return fault == std::errc{} && end == text.data() + text.size() && !text.empty() ? std::optional(value)
                                                                                   : std::nullopt;
}

std::uint32_t variable(const Environment& environment, const char* name) {
  const std::optional<std::string> text = environment(name);
  if (!text) refuse(std::string(name) + " isn't set; use --shard auto/N");
  const std::optional<std::uint32_t> value = whole_number(*text);
  if (!value) refuse(std::string(name) + ": expected a whole number, got '" + *text + "'");
  return *value;
}

/// A task of a job array, and the array as far as its manager tells.
struct Task {
  const char* variable;  ///< where its number stands
  std::uint32_t id = 0;
  struct Array {
    std::uint32_t first = 0, last = 0, step = 1;
    std::uint32_t count = 0;  ///< of tasks
  };
  std::function<Array()> array;
};

Task find_task(const Environment& environment) {
  if (environment("SLURM_ARRAY_TASK_ID")) {
    return {"SLURM_ARRAY_TASK_ID", variable(environment, "SLURM_ARRAY_TASK_ID"), [&environment] {
              return Task::Array{
                  variable(environment, "SLURM_ARRAY_TASK_MIN"), variable(environment, "SLURM_ARRAY_TASK_MAX"),
                  variable(environment, "SLURM_ARRAY_TASK_STEP"), variable(environment, "SLURM_ARRAY_TASK_COUNT")};
            }};
  }
  if (const auto id = environment("SGE_TASK_ID"); id && *id != "undefined") {  // so it is outside of an array
    return {"SGE_TASK_ID", variable(environment, "SGE_TASK_ID"), [&environment] {
              Task::Array array{variable(environment, "SGE_TASK_FIRST"), variable(environment, "SGE_TASK_LAST"),
                                variable(environment, "SGE_TASK_STEPSIZE"), 0};
              if (array.step > 0 && array.last >= array.first)
                array.count = (array.last - array.first) / array.step + 1;
              return array;
            }};
  }
  for (const char* name : {"PBS_ARRAY_INDEX", "PBS_ARRAYID"}) {
    if (!environment(name)) continue;
    return {name, variable(environment, name),
            []() -> Task::Array { refuse("PBS doesn't tell a task how many tasks there are; use --shard auto/N"); }};
  }
  refuse(
      "'auto' takes its number from a job array of Slurm (SLURM_ARRAY_TASK_ID), SGE (SGE_TASK_ID) or PBS "
      "(PBS_ARRAY_INDEX), and none of these variables is set; outside of an array use --shard I/N");
}

Shard shard_in_whole_array(const Task& task) {
  const Task::Array array = task.array();
  const std::string id = task.variable + (" = " + std::to_string(task.id));
  const bool is_even = array.step > 0 && array.last >= array.first && array.count > 0 &&
                       (array.last - array.first) / array.step + 1 == array.count &&
                       (array.last - array.first) % array.step == 0;
  if (!is_even) {
    refuse("the numbers of this array aren't evenly spaced (" + std::to_string(array.count) + " from " +
           std::to_string(array.first) + " to " + std::to_string(array.last) +
           "), so the shard can't be determined; number the tasks 1 to N and use --shard auto/N");
  }
  if (task.id < array.first || task.id > array.last || (task.id - array.first) % array.step != 0) {
    refuse(id + " is not a task of its array");
  }
  return {(task.id - array.first) / array.step + 1, array.count};
}

}  // namespace

std::optional<std::string> process_environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? std::optional<std::string>(value) : std::nullopt;
}

Shard parse_shard(std::string_view text, const Environment& environment) {
  if (text == "auto") return shard_in_whole_array(find_task(environment));
  const std::size_t slash = std::min(text.find('/'), text.size());
  const std::string_view index = text.substr(0, slash);
  const auto count = whole_number(text.substr(std::min(slash + 1, text.size())));
  const auto number = index == "auto" ? std::optional(find_task(environment).id) : whole_number(index);
  if (!number || !count) refuse("expected I/N, auto/N or auto, got '" + std::string(text) + "'");
  if (*number < 1 || *number > *count) {
    refuse("there is no shard " + std::to_string(*number) + " of " + std::to_string(*count) +
           "; they are numbered 1 to N");
  }
  return {*number, *count};
}

std::string shard_name(const Shard& shard) {
  std::ostringstream name;
  name << std::setfill('0') << "shard-" << std::setw(4) << shard.index << "-of-" << std::setw(4) << shard.count;
  return name.str();
}

std::optional<Shard> shard_of(std::string_view file_name) {
  if (!file_name.starts_with("shard-")) return std::nullopt;
  const std::size_t of = file_name.find("-of-");
  if (of == std::string_view::npos) return std::nullopt;
  const auto index = whole_number(file_name.substr(6, of - 6));
  const auto count = whole_number(file_name.substr(of + 4, file_name.find('.') - of - 4));
  if (!index || !count || *index < 1 || *index > *count) return std::nullopt;
  const Shard shard{*index, *count};
  return file_name.starts_with(shard_name(shard)) ? std::optional(shard) : std::nullopt;
}

}  // namespace pirsim::studies
