#include "reconcile/ensemble/reference_table.hpp"

#include <algorithm>
#include <utility>

#include "core/parallel.hpp"
#include "effects/catalogue.hpp"
#include "reconcile/ensemble/table_store.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t effects_per_attempt = 4096;  ///< keeps the streams of attempts apart
/// What a profile was made of looks less strange beside it than new data do: no realization of a table.
constexpr std::uint32_t first_pilot_realization = 1U << 26U;

/// Number of realizations for calibration before the n-th realization.
std::uint32_t n_for_calibration(std::uint32_t n) {
  std::uint32_t count = n / 5 * 2;
  for (std::uint32_t realization = n / 5 * 5; realization < n; ++realization)
    count += is_for_calibration(realization) ? 1 : 0;
  return count;
}

std::uint32_t place_in_catalogue(const effects::Effect& effect) {
  return static_cast<std::uint32_t>(std::ranges::find(effects::catalogue(), &effect) - effects::catalogue().begin());
}

/// Simulates the datasets of single realizations.
class RealizationJob {
 public:
  RealizationJob(const RealizationSource& source, const StudyFrame& frame, int n_replicates,
                 const TableSettings& settings)
      : source_(source), frame_(frame), n_replicates_(n_replicates), settings_(settings) {
    for (const std::string& hypothesis : settings.effects) effects_.push_back(&effects::find(hypothesis));
  }

  [[nodiscard]] TableChunk run(std::uint32_t index) const {
    TableChunk chunk;
    const SimulatedRealization realization(source_, frame_, index, n_replicates_);
    chunk.datasets.push_back({{0, index, {}}, realization.plain(0, n_replicates_)});
    for (std::uint32_t e = 0; e < effects_.size(); ++e) {
      if (has_dataset(*effects_[e], index)) add_effect(chunk, realization, index, e);
    }
    return chunk;
  }

 private:
  /// All effects are trained in the same realizations, so that what is between two of them isn't the realizations'
  /// doing. They are calibrated in realizations that differ as far as there are enough: a few strange ones shall not
  /// set the levels of all.
  [[nodiscard]] bool has_dataset(const effects::Effect& effect, std::uint32_t realization) const {
    const std::uint32_t wanted =
        effect.info.reach == effects::Reach::geometry ? settings_.n_traced : settings_.n_remembered;
    if (!is_for_calibration(realization)) return realization < wanted;
    const std::uint32_t n = n_for_calibration(settings_.n_realizations);
    const auto first = static_cast<std::uint32_t>(std::size_t{place_in_catalogue(effect)} * n /
                                                  effects::catalogue_for(source_.script).size());
    return (n_for_calibration(realization) + n - first) % n < n_for_calibration(wanted);
  }
  void add_effect(TableChunk& chunk, const SimulatedRealization& realization, std::uint32_t index,
                  std::uint32_t e) const {
    // What is drawn for an effect doesn't depend on which others are looked for.
    const std::uint32_t place = place_in_catalogue(*effects_[e]);
    for (std::uint32_t attempt = 0; attempt < most_attempts; ++attempt) {
      Stream stream({source_.seed, index, place + attempt * effects_per_attempt, Purpose::reference_parameters});
      const EffectSpec effect =
          effects::draw_from_prior(*effects_[e], realization.drawn().scene, realization.drawn().script, stream);
      auto data = realization.with_effects(std::span(&effect, 1), 0, n_replicates_);
      if (!data) continue;
      chunk.datasets.push_back({{e + 1, index, {effect}}, std::move(*data)});
      return;
    }
    ++chunk.n_left_out;
  }

  const RealizationSource& source_;
  const StudyFrame& frame_;
  int n_replicates_;
  const TableSettings& settings_;
  std::vector<const effects::Effect*> effects_;
};

}  // namespace

std::vector<Series> pilot_runs(const RealizationSource& source, const StudyFrame& frame, std::uint32_t n_realizations,
                               const Context& context) {
  std::vector<Series> all;
  ordered_parallel<std::vector<Series>>(
      n_realizations, context.threads,
      [&](std::size_t i) {
        return SimulatedRealization(source, frame, first_pilot_realization + static_cast<std::uint32_t>(i), 1)
            .plain(0, 1);
      },
      [&](std::vector<Series>& runs) { std::ranges::move(runs, std::back_inserter(all)); });
  return all;
}

ReferenceTable make_reference_table(const RealizationSource& source, const StudyFrame& frame, const DataShape& shape,
                                    const Profile& profile, const TableSettings& asked,
                                    const std::filesystem::path& folder, const Context& context) {
  TableSettings settings = asked;
  if (settings.effects.empty()) {
    for (const effects::Effect* effect : effects::catalogue_for(source.script)) {
      if (effect->info.same_as.empty()) settings.effects.push_back(effect->info.name);
    }
  }
  // What the script has is not looked for a second time: two of a kind on one sensor are refused.
  std::erase_if(settings.effects, [&](const std::string& hypothesis) {
    return std::ranges::find(source.script.effects, hypothesis, &EffectSpec::name) != source.script.effects.end();
  });
  // Nor what means nothing to any sensor.
  std::erase_if(settings.effects, [&](const std::string& hypothesis) {
    return !effects::means_anything(effects::find(hypothesis).info, source.scene, source.script.sensing);
  });
  if (settings.effects.empty())
    throw Error(ErrorCode::usage, "nothing is left to be looked for: the script has every effect that is asked for");
  ReferenceTable table;
  table.key = table_key(source, frame, shape.n_replicates, settings);
  TableStore store(folder, table.key);
  const RealizationJob job(source, frame, shape.n_replicates, settings);
  table.effects = settings.effects;
  table.profile = profile;
  table.n_realizations = settings.n_realizations;
  for_each_chunk(
      store, settings.n_realizations, context, [&](std::uint32_t index) { return job.run(index); },
      [&](TableChunk& chunk) {
        append_statistics(frame, shape, profile, chunk, context.threads, table.statistics);
        for (SimulatedDataset& dataset : chunk.datasets) table.rows.push_back(std::move(dataset.row));
        table.n_left_out += chunk.n_left_out;
      });
  return table;
}

}  // namespace pirsim::reconcile
