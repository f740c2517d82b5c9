#include "io/write/row_file.hpp"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "core/digest.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/compression.hpp"
#include "io/files/journal.hpp"
#include "io/files/posix_file.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {
namespace {

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
