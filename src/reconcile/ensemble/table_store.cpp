#include "reconcile/ensemble/table_store.hpp"

#include <algorithm>
#include <fstream>
#include <utility>

#include "core/parallel.hpp"
#include "io/files/atomic_file.hpp"
#include "pirsim/error.hpp"
#include "stats/binary.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::string_view kind = "pirsim reference table";
constexpr std::uint32_t format = 3;
constexpr std::uint32_t items_per_chunk = 25;

void write(stats::BinaryWriter& out, const EffectSpec& effect) {
  out.write(std::string_view(effect.name));
  out.write(static_cast<std::uint32_t>(effect.parameters.size()));
  for (const auto& [name, value] : effect.parameters) {
    out.write(std::string_view(name));
    out.write(value);
  }
  out.write(static_cast<std::uint32_t>(effect.choices.size()));
  for (const auto& [name, value] : effect.choices) {
    out.write(std::string_view(name));
    out.write(std::string_view(value));
  }
}

EffectSpec read_effect(stats::BinaryReader& in) {
  EffectSpec effect;
  effect.name = in.read_text();
  for (auto n = in.read<std::uint32_t>(); n > 0; --n) {
    const std::string name = in.read_text();
    effect.parameters[name] = in.read<double>();
  }
  for (auto n = in.read<std::uint32_t>(); n > 0; --n) {
    const std::string name = in.read_text();
    effect.choices[name] = in.read_text();
  }
  return effect;
}

/// Eight bits a byte; simulated data know all of them.
void write(stats::BinaryWriter& out, const Series& run) {
  out.write(static_cast<std::uint32_t>(run.trial));
  out.write(static_cast<std::int32_t>(run.replicate));
  for (const std::size_t n : {run.main_begin, run.main_end, run.bits.size()}) out.write(static_cast<std::uint32_t>(n));
  std::vector<std::uint8_t> packed((run.bits.size() + 7) / 8, 0);
  for (std::size_t i = 0; i < run.bits.size(); ++i) {
    if (run.bits[i] == 1) packed[i / 8] = static_cast<std::uint8_t>(packed[i / 8] | 1U << i % 8);
  }
  out.write(packed);
}

Series read_series(stats::BinaryReader& in) {
  Series run;
  run.trial = in.read<std::uint32_t>();
  run.replicate = in.read<std::int32_t>();
  run.main_begin = in.read<std::uint32_t>();
  run.main_end = in.read<std::uint32_t>();
  const auto n = in.read<std::uint32_t>();
  const auto packed = in.read_vector<std::uint8_t>();
  if (packed.size() != (n + 7U) / 8U)
    throw Error(ErrorCode::input, std::string(kind) + " is damaged: an impossible size");
  run.bits.reserve(n);
  for (std::uint32_t i = 0; i < n; ++i) run.bits.push_back(packed[i / 8] >> i % 8 & 1U);
  return run;
}

TableChunk read_chunk(std::istream& stream, const std::string& key, std::uint32_t number) {
  stats::BinaryReader in(stream, kind, format);
  if (in.read_text() != key) throw Error(ErrorCode::input, std::string(kind) + " is of other inputs or settings");
  if (in.read<std::uint32_t>() != number)
    throw Error(ErrorCode::input, std::string(kind) + " is of other realizations");
  TableChunk chunk;
  chunk.n_left_out = in.read<std::uint32_t>();
  for (auto n = in.read<std::uint32_t>(); n > 0; --n) {
    SimulatedDataset dataset;
    dataset.row.hypothesis = in.read<std::uint32_t>();
    dataset.row.realization = in.read<std::uint32_t>();
    for (auto m = in.read<std::uint32_t>(); m > 0; --m) dataset.row.effects.push_back(read_effect(in));
    for (auto m = in.read<std::uint32_t>(); m > 0; --m) dataset.runs.push_back(read_series(in));
    chunk.datasets.push_back(std::move(dataset));
  }
  in.finish();
  return chunk;
}

void append(TableChunk& chunk, TableChunk& more) {
  chunk.n_left_out += more.n_left_out;
  std::ranges::move(more.datasets, std::back_inserter(chunk.datasets));
}

}  // namespace

TableStore::TableStore(std::filesystem::path folder, const std::string& key) : folder_(std::move(folder)), key_(key) {
  if (!folder_.empty()) take(io::Journal::read(journal_path()));
}

std::filesystem::path TableStore::journal_path() const { return folder_ / "table.journal"; }

void TableStore::take(const std::optional<io::Journal::Content>& journal) {
  if (journal && journal->made_from != key_) {
    throw Error(ErrorCode::input, {journal_path().string(), 0, 0},
                "this folder holds simulated datasets of other inputs, settings (seed, effects, numbers of datasets or "
                "runs, nuisance) or of another build: remove it or name another folder with --table");
  }
  if (!journal && std::filesystem::exists(file(0))) {
    throw Error(ErrorCode::input, {folder_.string(), 0, 0},
                "this folder holds simulated datasets without table.journal, as pirsim 0.1.0 wrote them: remove it or "
                "name another folder with --table");
  }
  there_.clear();
  if (journal) there_.insert(journal->pieces.begin(), journal->pieces.end());
}

void TableStore::claim() {
  if (folder_.empty() || journal_) return;
  std::error_code ignored;
  std::filesystem::create_directories(folder_, ignored);  // opening the journal says why it can't be
  journal_.emplace(journal_path());
  const auto found = io::Journal::read(journal_path());  // another process may have come first
  take(found);
  found ? journal_->resume(*found) : journal_->begin(key_);
}

std::filesystem::path TableStore::file(std::uint32_t number) const {
  const std::string digits = std::to_string(number);
  return folder_ / ("realizations_" + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits + ".bin");
}

std::optional<TableChunk> TableStore::find(std::uint32_t number) const {
  if (!there_.contains(file(number).filename()) || !std::filesystem::exists(file(number))) return std::nullopt;
  std::ifstream stream(file(number), std::ios::binary);
  try {
    return read_chunk(stream, key_, number);
  } catch (const Error& error) {
    throw Error(ErrorCode::input, {file(number).string(), 0, 0},
                error.issues().front().message + "; remove this file, and only its realizations are simulated again");
  }
}

void TableStore::keep(std::uint32_t number, const TableChunk& chunk) {
  if (folder_.empty()) return;
  claim();
  io::AtomicFile file_out(file(number));
  stats::BinaryWriter out(file_out.stream(), kind, format);
  out.write(std::string_view(key_));
  out.write(number);
  out.write(chunk.n_left_out);
  out.write(static_cast<std::uint32_t>(chunk.datasets.size()));
  for (const SimulatedDataset& dataset : chunk.datasets) {
    out.write(dataset.row.hypothesis);
    out.write(dataset.row.realization);
    out.write(static_cast<std::uint32_t>(dataset.row.effects.size()));
    for (const EffectSpec& effect : dataset.row.effects) write(out, effect);
    out.write(static_cast<std::uint32_t>(dataset.runs.size()));
    for (const Series& run : dataset.runs) write(out, run);
  }
  out.finish();
  file_out.commit();
  const std::string name = file(number).filename();
  if (there_.insert(name).second) journal_->add(name);
}

void for_each_chunk(TableStore& store, std::uint32_t n_items, const Context& context, const ItemJob& job,
                    const std::function<void(TableChunk&)>& use) {
  const auto tell = [&](std::uint32_t n_there) {
    if (context.observer.progress) context.observer.progress(n_there, n_items);
  };
  tell(0);
  for (std::uint32_t first = 0; first < n_items; first += items_per_chunk) {
    const std::uint32_t n = std::min(items_per_chunk, n_items - first);
    std::optional<TableChunk> chunk = store.find(first / items_per_chunk);
    if (!chunk) {
      store.claim();
      chunk = store.find(first / items_per_chunk);
    }
    if (chunk) {
      tell(first + n);
    } else {
      std::uint32_t n_there = first;
      chunk.emplace();
      ordered_parallel<TableChunk>(
          n, context.threads, [&](std::size_t i) { return job(first + static_cast<std::uint32_t>(i)); },
          [&](TableChunk& one) {
            append(*chunk, one);
            tell(++n_there);
          });
      store.keep(first / items_per_chunk, *chunk);
    }
    use(*chunk);
  }
}

void append_statistics(const StudyFrame& frame, const DataShape& shape, const Profile& profile, const TableChunk& chunk,
                       unsigned threads, stats::Matrix<float>& statistics) {
  ordered_parallel<std::vector<float>>(
      chunk.datasets.size(), threads,
      [&](std::size_t i) { return statistics_of(frame, shape, profile, chunk.datasets[i].runs); },
      [&](std::vector<float>& row) { statistics.append_row(std::span<const float>(row)); });
}

}  // namespace pirsim::reconcile
