#include "reconcile/table_store.hpp"

#include <fstream>

#include "pirsim/core/error.hpp"
#include "pirsim/io/atomic_file.hpp"
#include "pirsim/stats/binary.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::string_view kind = "pirsim reference table";
constexpr std::uint32_t format = 1;

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
    row.effect = read_effect(in);
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
    write(out, row.effect);
  }
  out.write(chunk.statistics);
  out.finish();
  file_out.commit();
}

}  // namespace pirsim::reconcile
