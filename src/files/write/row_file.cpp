#include "files/write/row_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "files/disk/compression.hpp"
#include "files/disk/file.hpp"
#include "model/core/random.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string csv_number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

namespace {

template <typename... Kinds>
struct Visitor : Kinds... {
  using Kinds::operator()...;
};
template <typename... Kinds>
Visitor(Kinds...) -> Visitor<Kinds...>;

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

namespace fs = std::filesystem;

constexpr std::size_t block = 1U << 18U;
const std::string remedy = "; remove it, or run without --resume to replace it";

fs::path with_ending(fs::path path, const char* ending) { return path += ending; }
fs::path partial_of(const fs::path& file) { return with_ending(without_compression(file), ".partial"); }
fs::path journal_of(const fs::path& file) { return with_ending(without_compression(file), ".journal"); }

void rename_or_throw(const fs::path& from, const fs::path& to) {
  std::error_code fault;
  fs::rename(from, to, fault);
  if (fault) throw Error(ErrorCode::io, Where{to.string()}, "can't replace the file: " + fault.message());
}

void remove_or_throw(const fs::path& file) {
  std::error_code fault;
  fs::remove(file, fault);
  if (fault) throw Error(ErrorCode::io, Where{file.string()}, "can't be removed: " + fault.message());
}

std::optional<Manifest> readable_manifest(const fs::path& file) {
  std::error_code fault;
  if (!fs::exists(file, fault)) return std::nullopt;
  try {
    return read_manifest(file);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::input) throw;
    return std::nullopt;
  }
}

std::string in_words(const RunRange& runs) { return std::to_string(runs.first) + " to " + std::to_string(runs.end); }
std::string in_words(const std::optional<Shard>& shard) {
  return shard ? std::to_string(shard->index) + '/' + std::to_string(shard->count) : "none";
}

bool fits(const Manifest& found, const Manifest& wanted) {
  return found.runs == wanted.runs && found.shard == wanted.shard && found.table == wanted.table &&
         differences(found.provenance, wanted.provenance).empty();
}

void require_fit(const Manifest& found, const Manifest& wanted, const fs::path& file) {
  std::vector<std::string> unlike = differences(found.provenance, wanted.provenance);
  if (found.runs != wanted.runs)
    unlike.push_back("runs (" + in_words(found.runs) + ", not " + in_words(wanted.runs) + ')');
  if (found.table != wanted.table) {
    const auto name = [](const Manifest& one) { return one.table.empty() ? "rows" : one.table; };
    unlike.push_back("table (" + name(found) + ", not " + name(wanted) + ')');
  }
  if (found.shard != wanted.shard)
    unlike.push_back("shard (" + in_words(found.shard) + ", not " + in_words(wanted.shard) + ')');
  if (unlike.empty()) return;
  std::string text;
  for (const std::string& each : unlike) text += (text.empty() ? "" : ", ") + each;
  throw Error(ErrorCode::input, Where{file.string()}, "can't be resumed because its inputs differ: " + text + remedy);
}

/// How far the rows reached after a run.
struct Mark {
  std::uint32_t next_run = 0;
  std::uint64_t rows = 0;
  std::uint64_t bytes = 0;
  std::string sha256;
  RunNotes notes{};  ///< of that run
};

std::string to_text(const Mark& mark) {
  return std::to_string(mark.next_run) + ' ' + std::to_string(mark.rows) + ' ' + std::to_string(mark.bytes) + ' ' +
         mark.sha256 + (mark.notes.empty() ? "" : ' ' + to_json(mark.notes));
}

/// None if the text isn't that of a mark, or if a number doesn't fit its type.
std::optional<Mark> mark_from(std::string_view text) {
  Mark mark;
  const auto take_word = [&] {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    return word;
  };
  const auto take = [&](auto& number) {
    const auto found = parse_number<std::decay_t<decltype(number)>>(take_word());
    number = found.value_or(0);
    return found.has_value();
  };
  constexpr std::size_t hash_digits = 64;
  if (!take(mark.next_run) || !take(mark.rows) || !take(mark.bytes)) return std::nullopt;
  mark.sha256 = take_word();
  if (mark.sha256.size() != hash_digits) return std::nullopt;
  if (text.empty()) return mark;
  const std::optional<RunNotes> notes = notes_from_json(std::string(text));
  if (!notes) return std::nullopt;
  mark.notes = *notes;
  return mark;
}

/// What no journal of these runs says, though every digest is right.
void require_next(const std::optional<Mark>& last, const Mark& mark, const RunRange& runs, const Where& where) {
  const std::uint32_t expected = last ? last->next_run + 1 : runs.first;
  const bool grows = !last || (mark.rows >= last->rows && mark.bytes >= last->bytes);
  if (mark.next_run == expected && mark.next_run <= runs.end && grows) return;
  throw Error(ErrorCode::input, where,
              "names run " + std::to_string(mark.next_run) + " with " + std::to_string(mark.rows) +
                  " rows, where run " + std::to_string(expected) + " of " + in_words(runs) + " would follow" + remedy);
}

/// How far the rows reach by a journal, with the notes of all runs; none if nothing was written.
std::optional<Mark> last_mark(const Journal::Content& journal, const fs::path& file, const RunRange& runs) {
  std::optional<Mark> last;
  RunNotes notes;
  int line = 1;
  for (const std::string& piece : journal.pieces) {
    const Where where{file.string(), ++line, 1};
    std::optional<Mark> mark = mark_from(piece);
    if (!mark) throw Error(ErrorCode::input, where, "isn't what a journal says of a run" + remedy);
    require_next(last, *mark, runs, where);
    notes += mark->notes;
    last = std::move(mark);
  }
  if (last) last->notes = std::move(notes);
  return last;
}

}  // namespace

void add_csv(std::string& line, const Cell& cell, int decimals) {
  const auto add_number = [&](auto number) {
    std::array<char, 32> text;
    line.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr);
  };
  std::visit(Visitor{[](std::monostate) {}, [&](std::int64_t number) { add_number(number); },
                     [&](double number) {
                       const double scale = decimals < 0 ? 1.0 : std::pow(10.0, decimals);
                       add_number(decimals < 0 ? number : std::round(scale * number) / scale);
                     },
                     [&](std::string_view text) {
                       if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
                         line += text;
                       } else {
                         line += csv_field(text);
                       }
                     },
                     [&](std::span<const std::uint8_t> bits) {
                       for (const std::uint8_t bit : bits) line += bit != 0 ? '1' : '0';
                     }},
             cell);
}

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

struct RowFile::Work {
  fs::path file, partial_path, journal_path;
  Manifest made;
  bool finished = false;
  std::optional<PosixFile> partial;
  std::optional<Journal> journal;
  Sha256 hash;
  Mark mark;
  RunNotes notes;

  void take_partial() {
    try {
      partial.emplace(partial_path, PosixFile::Mode::append);
    } catch (const Error&) {
      if (journal->is_empty()) journal->remove();  // of what never began
      throw;
    }
  }

  /// Leaves a damaged file or manifest to be made anew, but refuses one that something else made.
  bool is_finished() {
    std::error_code fault;
    if (fs::exists(journal_path, fault)) journal.emplace(journal_path);
    const fs::path manifest = manifest_path(file);
    const std::optional<Manifest> found = readable_manifest(manifest);
    if (!found) return false;
    if (!fits(*found, made) && fs::exists(journal_path, fault)) return false;  // it was about to be replaced
    require_fit(*found, made, manifest);
    if (!fault_of_data(file, *found).empty()) return false;
    finished = true;
    mark = {found->runs.end, found->rows, found->bytes, found->sha256};
    notes = found->notes;
    remove_traces();
    return true;
  }

  void open(const std::string& header, Start start) {
    if (!journal) journal.emplace(journal_path);
    if (start == Start::resume && recover()) return;
    take_partial();
    partial->truncate(0);
    hash = {};
    mark = {made.runs.first, 0, 0, {}};
    notes = {};
    journal->begin(to_json(made, -1));
    write(header, 0, {});
  }

  void write(std::string_view lines, std::uint64_t n_rows, const RunNotes& of_run) {
    partial->append(lines);
    hash.add(lines);
    mark.rows += n_rows;
    mark.bytes += lines.size();
    mark.sha256 = hash.hex();
    mark.notes = of_run;
    notes += of_run;
    journal->add(to_text(mark));
  }

  /// False if there is nothing to resume.
  bool recover() {
    const std::optional<Journal::Content> found = Journal::read(journal_path);
    if (!found) return false;
    require_fit(manifest_from_json(found->made_from, journal_path.string()), made, journal_path);
    const std::optional<Mark> last = last_mark(*found, journal_path, made.runs);
    if (!last) return false;
    std::error_code fault;
    const bool was_put_in_place = !fs::exists(partial_path, fault) && fs::is_regular_file(file, fault) &&
                                  compression_of(file) == Compression::none;
    if (was_put_in_place) rename_or_throw(file, partial_path);  // killed before its manifest
    if (!fs::is_regular_file(partial_path, fault)) return false;
    take_partial();
    if (!hash_whole_runs(*last)) return false;
    partial->truncate(mark.bytes);
    journal->resume(*found);
    notes = last->notes;
    return true;
  }

  /// Brings the hash to the mark. False if what is there isn't what was written, as after a power failure.
  bool hash_whole_runs(const Mark& wanted) {
    hash = {};
    std::string buffer(block, '\0');
    std::uint64_t left = wanted.bytes;
    while (left > 0) {
      const std::size_t n = partial->read(buffer.data(), std::min<std::uint64_t>(left, block));
      if (n == 0) return false;
      hash.add({buffer.data(), n});
      left -= n;
    }
    mark = wanted;
    return hash.hex() == wanted.sha256;
  }

  void put_in_place(const std::function<bool()>& goes_on) {
    const Compression compression = compression_of(file);
    if (compression == Compression::none) return rename_or_throw(partial_path, file);
    AtomicFile out(file);
    DataWriter writer(out.stream(), compression);
    partial->rewind();
    std::string buffer(block, '\0');
    while (const std::size_t n = partial->read(buffer.data(), buffer.size())) {
      writer.write({buffer.data(), n});
      if (!out.stream()) break;
      if (n == buffer.size() && goes_on && !goes_on())
        throw Error(ErrorCode::stopped, "stopped while the rows were compressed; --resume continues");
    }
    writer.finish();
    out.commit();
  }

  void remove_traces() {
    remove_or_throw(partial_path);
    remove_or_throw(journal_path);
  }
};

RowFile::RowFile(fs::path file, Manifest made, const std::string& header, Start start)
    : work_(std::make_unique<Work>()) {
  work_->file = resolved(file);
  work_->partial_path = partial_of(work_->file);
  work_->journal_path = journal_of(work_->file);
  work_->made = std::move(made);
  if (start == Start::anew || !work_->is_finished()) work_->open(header, start);
}

RowFile::~RowFile() = default;

bool RowFile::finished() const noexcept { return work_->finished; }
std::uint32_t RowFile::next_run() const noexcept { return work_->mark.next_run; }
std::uint64_t RowFile::rows() const noexcept { return work_->mark.rows; }

const RunNotes& RowFile::notes() const noexcept { return work_->notes; }

void RowFile::add_run(std::string_view lines, std::uint64_t n_rows, const RunNotes& notes) {
  ++work_->mark.next_run;
  work_->write(lines, n_rows, notes);
}

void RowFile::commit(const std::function<bool()>& goes_on) {
  Work& work = *work_;
  if (work.mark.next_run != work.made.runs.end) throw Error(ErrorCode::internal, "committed before the last run");
  work.made.rows = work.mark.rows;
  work.made.bytes = work.mark.bytes;
  work.made.sha256 = work.mark.sha256;
  work.made.notes = work.notes;
  remove_or_throw(manifest_path(work.file));  // of an older file: it must not speak for the new one
  work.put_in_place(goes_on);
  write_manifest(manifest_path(work.file), work.made);
  work.remove_traces();
  work.finished = true;
}

void RowFile::discard() noexcept {
  if (work_->finished) return;
  std::error_code ignored;
  fs::remove(work_->partial_path, ignored);
  fs::remove(work_->journal_path, ignored);
}

std::vector<fs::path> files_beside(const fs::path& file) {
  const fs::path target = resolved(file);
  return {manifest_path(target), partial_of(target), journal_of(target)};
}

void DataCheck::add(std::string_view bytes) {
  hash_.add(bytes);
  bytes_ += bytes.size();
  for (const char c : bytes) {
    is_quoted_ = is_quoted_ != (c == '"');
    lines_ += c == '\n' && !is_quoted_ ? 1 : 0;
  }
}

std::string DataCheck::fault() const {
  if (is_too_long()) return "longer than its manifest says";
  if (bytes_ < manifest_.bytes) return "shorter than its manifest says";
  if (hash_.hex() != manifest_.sha256) return "its hash is not the one in the manifest";
  return lines_ == manifest_.rows + 1 ? "" : "its manifest says another number of rows";  // beside the header
}

std::string fault_of_data(const fs::path& file, const Manifest& manifest) {
  std::error_code fault;
  if (!fs::is_regular_file(file, fault)) return "there is no data file";
  try {
    DataReader reader(file);
    DataCheck check(manifest);
    std::string buffer(block, '\0');
    while (const std::size_t n = reader.read(buffer.data(), buffer.size())) {
      check.add({buffer.data(), n});
      if (check.is_too_long()) break;
    }
    return check.fault();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::input) throw;
    return error.issues().front().message;
  }
}

}  // namespace pirsim::io
