#include "pirsim/reconcile/reference_table.hpp"

#include <algorithm>
#include <utility>

#include "pirsim/core/parallel.hpp"
#include "pirsim/effects/catalogue.hpp"
#include "reconcile/table_store.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t worlds_per_chunk = 25;
constexpr std::uint32_t entries_per_attempt = 4096;  ///< keeps the streams of attempts apart

/// Simulates the datasets of single worlds.
class WorldJob {
 public:
  WorldJob(const WorldSource& source, const StudyFrame& frame, const DataShape& shape, const Profile& profile,
           const TableSettings& settings)
      : source_(source), frame_(frame), shape_(shape), profile_(profile), settings_(settings) {
    for (const std::string& entry : settings.entries) effects_.push_back(&effects::find(entry));
  }

  [[nodiscard]] TableChunk run(std::uint32_t index) const {
    TableChunk chunk;
    const int n = shape_.n_replicates;
    const SimulatedWorld world(source_, frame_, index, n * settings_.plain_per_world);
    for (int i = 0; i < settings_.plain_per_world; ++i) add(chunk, {0, index, {}}, world.plain(i * n, n));
    for (std::uint32_t e = 0; e < effects_.size(); ++e) {
      if (index < n_datasets(*effects_[e])) add_effect(chunk, world, index, e);
    }
    return chunk;
  }

 private:
  [[nodiscard]] std::uint32_t n_datasets(const effects::Effect& effect) const {
    return effect.info.reach == effects::Reach::geometry ? settings_.n_traced : settings_.n_remembered;
  }
  void add_effect(TableChunk& chunk, const SimulatedWorld& world, std::uint32_t index, std::uint32_t e) const {
    for (std::uint32_t attempt = 0; attempt < most_attempts; ++attempt) {
      Stream stream({source_.seed, index, e + attempt * entries_per_attempt, Purpose::reference_parameters});
      const EffectSpec effect =
          effects::draw_from_prior(*effects_[e], world.world().scene, world.world().script, stream);
      const auto data = world.with_effects(std::span(&effect, 1), 0, shape_.n_replicates);
      if (!data) continue;
      add(chunk, {e + 1, index, effect}, *data);
      return;
    }
    ++chunk.n_left_out;
  }
  void add(TableChunk& chunk, TableRow row, const std::vector<Series>& data) const {
    chunk.rows.push_back(std::move(row));
    chunk.statistics.append_row(std::span<const float>(statistics_of(frame_, shape_, profile_, data)));
  }

  const WorldSource& source_;
  const StudyFrame& frame_;
  const DataShape& shape_;
  const Profile& profile_;
  const TableSettings& settings_;
  std::vector<const effects::Effect*> effects_;
};

void append(TableChunk& chunk, TableChunk& more) {
  chunk.n_left_out += more.n_left_out;
  for (std::size_t i = 0; i < more.rows.size(); ++i) {
    chunk.rows.push_back(std::move(more.rows[i]));
    chunk.statistics.append_row(std::as_const(more.statistics).row(i));
  }
}

}  // namespace

std::vector<Series> pilot_runs(const WorldSource& source, const StudyFrame& frame, std::uint32_t n_worlds,
                               unsigned threads) {
  std::vector<Series> all;
  ordered_parallel<std::vector<Series>>(
      n_worlds, threads,
      [&](std::size_t i) { return SimulatedWorld(source, frame, static_cast<std::uint32_t>(i), 1).plain(0, 1); },
      [&](std::vector<Series>& runs) { std::ranges::move(runs, std::back_inserter(all)); });
  return all;
}

ReferenceTable make_reference_table(const WorldSource& source, const StudyFrame& frame, const DataShape& shape,
                                    const Profile& profile, const TableSettings& asked,
                                    const std::filesystem::path& folder, const TableProgress& progress) {
  TableSettings settings = asked;
  if (settings.entries.empty()) {
    for (const effects::Effect* effect : effects::catalogue()) settings.entries.push_back(effect->info.name);
  }
  // What the script has is not looked for a second time: two of a kind on one sensor are refused.
  std::erase_if(settings.entries, [&](const std::string& entry) {
    return std::ranges::find(source.script.effects, entry, &EffectSpec::name) != source.script.effects.end();
  });
  const TableStore store(folder, table_key(source, frame, shape, settings));
  const WorldJob job(source, frame, shape, profile, settings);
  ReferenceTable table;
  table.effects = settings.entries;
  table.profile = profile;
  table.n_worlds = settings.n_worlds;
  TableChunk all;
  for (std::uint32_t first = 0; first < settings.n_worlds; first += worlds_per_chunk) {
    const std::uint32_t n = std::min(worlds_per_chunk, settings.n_worlds - first);
    std::optional<TableChunk> chunk = store.find(first / worlds_per_chunk);
    if (!chunk) {
      chunk.emplace();
      ordered_parallel<TableChunk>(
          n, settings.threads, [&](std::size_t i) { return job.run(first + static_cast<std::uint32_t>(i)); },
          [&](TableChunk& one) { append(*chunk, one); });
      store.keep(first / worlds_per_chunk, *chunk);
    }
    append(all, *chunk);
    if (progress.worlds) progress.worlds(first + n, settings.n_worlds);
  }
  table.rows = std::move(all.rows);
  table.statistics = std::move(all.statistics);
  table.n_left_out = all.n_left_out;
  return table;
}

}  // namespace pirsim::reconcile
