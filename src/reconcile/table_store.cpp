#include "reconcile/table_store.hpp"

#include <algorithm>
#include <fstream>
#include <utility>

#include "pirsim/core/error.hpp"
#include "pirsim/core/parallel.hpp"
#include "pirsim/io/atomic_file.hpp"
#include "pirsim/stats/binary.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::string_view kind = "pirsim reference table";
constexpr std::uint32_t format = 2;
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

void append(TableChunk& chunk, TableChunk& more) {
  chunk.n_left_out += more.n_left_out;
  for (std::size_t i = 0; i < more.rows.size(); ++i) {
    chunk.rows.push_back(std::move(more.rows[i]));
    chunk.statistics.append_row(std::as_const(more.statistics).row(i));
  }
}

}  // namespace

TableStore::TableStore(std::filesystem::path folder, const std::string& key) : folder_(std::move(folder)) {
  if (folder_.empty()) return;
  std::error_code fault;
  std::filesystem::create_directories(folder_, fault);
  const std::filesystem::path key_file = folder_ / "key.txt";
  if (std::filesystem::exists(key_file)) {
    std::string known;
    std::ifstream(key_file) >> known;
    if (known == key) return;
    throw Error(ErrorCode::input, {key_file.string(), 0, 0},
                "this folder holds the reference table of another scene, script, nuisance, shape of data or build: "
                "remove it or name another folder with --table");
  }
  io::AtomicFile out(key_file);
  out.stream() << key << '\n';
  out.commit();
}

std::filesystem::path TableStore::file(std::uint32_t number) const {
  const std::string digits = std::to_string(number);
  return folder_ / ("worlds_" + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits + ".bin");
}

std::optional<TableChunk> TableStore::find(std::uint32_t number) const {
  if (folder_.empty() || !std::filesystem::exists(file(number))) return std::nullopt;
  std::ifstream stream(file(number), std::ios::binary);
  stats::BinaryReader in(stream, kind, format);
  TableChunk chunk;
  chunk.n_left_out = in.read<std::uint32_t>();
  for (auto n = in.read<std::uint32_t>(); n > 0; --n) {
    TableRow row;
    row.entry = in.read<std::uint32_t>();
    row.world = in.read<std::uint32_t>();
    for (auto m = in.read<std::uint32_t>(); m > 0; --m) row.effects.push_back(read_effect(in));
    chunk.rows.push_back(std::move(row));
  }
  chunk.statistics = in.read_matrix<float>();
  in.finish();
  return chunk;
}

void TableStore::keep(std::uint32_t number, const TableChunk& chunk) const {
  if (folder_.empty()) return;
  io::AtomicFile file_out(file(number));
  stats::BinaryWriter out(file_out.stream(), kind, format);
  out.write(chunk.n_left_out);
  out.write(static_cast<std::uint32_t>(chunk.rows.size()));
  for (const TableRow& row : chunk.rows) {
    out.write(row.entry);
    out.write(row.world);
    out.write(static_cast<std::uint32_t>(row.effects.size()));
    for (const EffectSpec& effect : row.effects) write(out, effect);
  }
  out.write(chunk.statistics);
  out.finish();
  file_out.commit();
}

TableChunk collect(const TableStore& store, std::uint32_t n_items, unsigned threads, const ItemJob& job,
                   const TableProgress& progress) {
  TableChunk all;
  for (std::uint32_t first = 0; first < n_items; first += items_per_chunk) {
    const std::uint32_t n = std::min(items_per_chunk, n_items - first);
    std::optional<TableChunk> chunk = store.find(first / items_per_chunk);
    if (!chunk) {
      chunk.emplace();
      ordered_parallel<TableChunk>(
          n, threads, [&](std::size_t i) { return job(first + static_cast<std::uint32_t>(i)); },
          [&](TableChunk& one) { append(*chunk, one); });
      store.keep(first / items_per_chunk, *chunk);
    }
    append(all, *chunk);
    if (progress.worlds) progress.worlds(first + n, n_items);
  }
  return all;
}

}  // namespace pirsim::reconcile
