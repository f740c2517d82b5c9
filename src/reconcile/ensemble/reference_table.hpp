// What the model would have measured: many datasets of the plain model and of every effect in the catalogue.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <istream>
#include <optional>
#include <ostream>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "files/disk/file.hpp"
#include "model/core/random.hpp"
#include "pirsim/error.hpp"
#include "reconcile/data/statistics.hpp"
#include "reconcile/ensemble/realization.hpp"
#include "stats/matrix.hpp"

namespace pirsim::reconcile {

/// One simulated dataset. The same realization gives the same room and people for every hypothesis.
struct TableRow {
  std::uint32_t hypothesis = 0;  ///< 0: nothing; else 1 + index into ReferenceTable::effects
  std::uint32_t realization = 0;
  std::vector<EffectSpec> effects;  ///< as drawn; none for nothing
};

class ReferenceTable {
 public:
  std::string key;                   ///< table_key() of what it depends on
  std::vector<std::string> effects;  ///< names of the hypotheses from 1 on
  std::vector<TableRow> rows;        ///< by realization, then hypothesis
  stats::Matrix<float> statistics;   ///< (n_rows x n_statistics)
  Profile profile;                   ///< of the plain model, from pilot runs
  std::uint32_t n_realizations = 0;
  std::uint32_t n_left_out = 0;  ///< datasets in whose realizations people couldn't get about

  [[nodiscard]] std::size_t n_hypotheses() const noexcept { return 1 + effects.size(); }
  [[nodiscard]] std::string hypothesis_name(std::size_t hypothesis) const {
    return hypothesis == 0 ? "nothing" : effects[hypothesis - 1];
  }
};

/// Realizations are held back for calibration as wholes: nothing of them is seen in training.
[[nodiscard]] inline bool is_for_calibration(std::uint32_t realization) noexcept { return realization % 5 < 2; }

/// Simulates what isn't in the folder yet; chunks of realizations are kept there as they finish, so that an interrupted
/// table goes on where it stopped. An empty folder name keeps nothing. Throws Error(input) if the folder holds the
/// table of something else.
[[nodiscard]] ReferenceTable make_reference_table(const RealizationSource& source, const StudyFrame& frame,
                                                  const DataShape& shape, const Profile& profile,
                                                  const TableSettings& settings, const std::filesystem::path& folder,
                                                  const Context& context = {});

/// Pilot runs of the plain model, for profiles and shapes, in realizations that no table has.
[[nodiscard]] std::vector<Series> pilot_runs(const RealizationSource& source, const StudyFrame& frame,
                                             std::uint32_t n_realizations, const Context& context = {});
/// Datasets of a table of what surrounds people, as a fan or a draught, and of the plain model.
[[nodiscard]] std::vector<std::vector<Series>> surroundings_pilot(const RealizationSource& source,
                                                                  const StudyFrame& frame, int n_replicates,
                                                                  std::uint32_t n_realizations,
                                                                  const Context& context = {});

/// Everything that a table's simulated datasets depend on, as a digest: scene, script, nuisance, runs of every trial,
/// settings, catalogue, build.
[[nodiscard]] std::string table_key(const RealizationSource& source, const StudyFrame& frame, int n_replicates,
                                    const TableSettings& settings);

// Numbers to a stream of bytes and back, little-endian, with a digest: how fitted objects are kept.

static_assert(std::endian::native == std::endian::little, "the byte order of the format is that of the machine");

template <typename T>
concept Number = std::is_arithmetic_v<T>;

/// Starts with `kind` and a version, ends with the SHA-256 of all bytes between; call finish() last.
class BinaryWriter {
 public:
  BinaryWriter(std::ostream& out, std::string_view kind, std::uint32_t version) : out_(out) {
    write(kind);
    write(version);
  }

  template <Number T>
  void write(T value) {
    put(&value, sizeof value);
  }

  template <Number T>
  void write(const std::vector<T>& values) {
    write(static_cast<std::uint64_t>(values.size()));
    put(values.data(), values.size() * sizeof(T));
  }

  void write(std::string_view text) {
    write(static_cast<std::uint64_t>(text.size()));
    put(text.data(), text.size());
  }

  /// Writes the digest. Throws Error(io) if the stream has failed.
  void finish() {
    out_ << digest_.hex();
    if (!out_) throw Error(ErrorCode::io, "can't write a fitted object: the stream failed");
  }

 private:
  void put(const void* bytes, std::size_t count) {
    digest_.add({static_cast<const char*>(bytes), count});
    out_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
  }

  std::ostream& out_;
  Sha256 digest_;
};

/// Reads what BinaryWriter wrote, in the same order. Every fault is Error(input) that names the kind.
class BinaryReader {
 public:
  /// Throws Error(input) if the stream holds something else or another version.
  BinaryReader(std::istream& in, std::string_view kind, std::uint32_t version) : in_(in), kind_(kind) {
    const auto length = read<std::uint64_t>();
    std::string found(length == kind.size() ? kind.size() : 0, '\0');
    get(found.data(), found.size());
    if (found != kind) fail("was expected, but the stream holds something else");
    const auto found_version = read<std::uint32_t>();
    if (found_version != version)
      fail("has version " + std::to_string(found_version) + ", this build reads version " + std::to_string(version));
  }

  template <Number T>
  [[nodiscard]] T read() {
    T value{};
    get(&value, sizeof value);
    return value;
  }

  template <Number T>
  [[nodiscard]] std::vector<T> read_vector() {
    std::vector<T> values;
    get_many(values, read<std::uint64_t>());
    return values;
  }

  [[nodiscard]] std::string read_text() {
    std::vector<char> text;
    get_many(text, read<std::uint64_t>());
    return {text.begin(), text.end()};
  }

  /// Compares the digest; throws Error(input) if it differs.
  void finish() {
    const std::string expected = digest_.hex();
    std::string found(expected.size(), '\0');
    get(found.data(), found.size());
    if (found != expected) fail("is damaged: its digest differs");
  }

 private:
  static constexpr std::uint64_t largest_count = 1ULL << 36U;
  template <typename T>
  void get_many(std::vector<T>& values, std::uint64_t count) {
    if (count > largest_count) fail("is damaged: an impossible size");
    constexpr std::uint64_t piece = 1ULL << 20U;  // a wrong count is noticed before memory runs out
    while (values.size() < count) {
      const std::uint64_t from = values.size(), more = std::min(piece, count - from);
      values.resize(from + more);
      get(values.data() + from, more * sizeof(T));
    }
  }

  void get(void* bytes, std::size_t count) {
    in_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count));
    if (static_cast<std::size_t>(in_.gcount()) != count) fail("ends too early");
    digest_.add({static_cast<const char*>(bytes), count});
  }

  void fail(const std::string& what) const { throw Error(ErrorCode::input, kind_ + " " + what); }
  std::istream& in_;
  std::string kind_;
  Sha256 digest_;
};

// Simulated datasets on disk: a folder with chunks of finished realizations, each of which names its key and number,
// and a journal of them. Private to reconcile.

/// The runs of one dataset as they were simulated: statistics are taken when they are needed, so that data with other
/// gaps, and other statistics, need no new simulation.
struct SimulatedDataset {
  TableRow row;
  std::vector<Series> runs;
};
/// Datasets of some realizations that follow each other.
struct TableChunk {
  std::vector<SimulatedDataset> datasets;
  std::uint32_t n_left_out = 0;
};

class TableStore {
 public:
  /// `key`: what the datasets depend on. An empty folder name keeps nothing. Throws Error(input) if the folder holds a
  /// table with another key.
  TableStore(std::filesystem::path folder, const std::string& key);
  /// None if the chunk isn't there. Throws Error(input) if it is damaged, of another table or of other realizations.
  [[nodiscard]] std::optional<TableChunk> find(std::uint32_t number) const;
  /// Before work that is to be kept; afterwards what another process kept meanwhile is found too. Throws Error(io) if
  /// the folder can't be written or another process is at work on it, which two may read.
  void claim();
  void keep(std::uint32_t number, const TableChunk& chunk);

 private:
  [[nodiscard]] std::filesystem::path file(std::uint32_t number) const;
  [[nodiscard]] std::filesystem::path journal_path() const;
  void take(const std::optional<io::Journal::Content>& journal);

  std::filesystem::path folder_;
  std::string key_;
  std::set<std::string> there_;         ///< names of chunks
  std::optional<io::Journal> journal_;  ///< once it is claimed
};

/// Simulates item `index` (a realization) with all of its datasets.
using ItemJob = std::function<TableChunk(std::uint32_t index)>;
/// Calls use(chunk) for the datasets of items 0 to n_items - 1, in order: those that aren't in the store are simulated,
/// on several threads, and kept there; the context is told how many are done.
void for_each_chunk(TableStore& store, std::uint32_t n_items, const Context& context, const ItemJob& job,
                    const std::function<void(TableChunk&)>& use);

/// A row a dataset.
void append_statistics(const StudyFrame& frame, const DataShape& shape, const Profile& profile, const TableChunk& chunk,
                       unsigned threads, stats::Matrix<float>& statistics);

}  // namespace pirsim::reconcile
