#include "reconcile/ensemble/simulated_realization.hpp"

#include <algorithm>

#include "effects/catalogue.hpp"
#include "sim/recording_family.hpp"
#include "sim/remembered_triggers.hpp"

namespace pirsim::reconcile {
namespace {

/// Of these trials; none given: of all.
std::vector<std::uint32_t> runs_of(const Model& model, std::span<const std::size_t> trials) {
  std::vector<std::uint32_t> runs;
  const std::size_t n_trials = model.script().trials.size();
  for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
    if (trials.empty() || std::ranges::find(trials, run % n_trials) != trials.end()) runs.push_back(run);
  }
  return runs;
}

void add_series(const StudyFrame& frame, const RunResult& result, int first, std::vector<Series>& data) {
  if (result.samples.empty()) return;
  auto series = series_of(frame, result.replicate - first, result.samples.front().trial, result.samples);
  if (series) data.push_back(std::move(*series));
}

/// Both. What the script has is never looked for again, so one of the same name is the nuisance's, and gives way.
std::vector<EffectSpec> together(std::vector<EffectSpec> own, std::span<const EffectSpec> more) {
  std::erase_if(own, [&](const EffectSpec& effect) {
    return std::ranges::find(more, effect.name, &EffectSpec::name) != more.end();
  });
  own.insert(own.end(), more.begin(), more.end());
  return own;
}

}  // namespace

std::shared_ptr<const Model> model_to_share(const SceneSpec& scene, const ScriptSpec& script) {
  try {
    return std::make_shared<const Model>(compile(scene, script));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    return nullptr;
  }
}

struct SimulatedRealization::Traced {
  /// A recording as its Model's detectors take it.
  struct Emitter {
    /// like: of a Model with the same seed, or null.
    Emitter(const Model& of, const Recording& from, sim::NoiseMemory& noise, const Emitter* like)
        : model(of),
          tracks(from),
          logic(std::make_unique<sim::RememberedTriggers>(of.compiled(), from, noise,
                                                          like != nullptr ? like->logic.get() : nullptr)) {}
    [[nodiscard]] std::vector<Series> emit(const StudyFrame& frame, const effects::Pipeline& pipeline, int first,
                                           int n) const {
      first *= frame.n_days();
      n *= frame.n_days();
      std::vector<Series> data;
      for (std::size_t i = 0; i < tracks.runs.size(); ++i) {
        const int replicate = tracks.runs[i].rows.replicate;
        if (replicate <= first || replicate > first + n) continue;
        add_series(frame, sim::replay(tracks, i, *logic, model.script().seed, pipeline), first, data);
      }
      return in_units(frame, std::move(data));
    }

    const Model& model;
    const Recording& tracks;
    std::unique_ptr<sim::RememberedTriggers> logic;
  };

  Traced(const Realization& realization, const Model* like)
      : model(compile(realization.scene, realization.script, {.like = like})),
        family(model, runs_of(model, {})),
        emitter(model, family.first(), noise, nullptr) {}

  Model model;
  sim::RecordingFamily family;
  sim::NoiseMemory noise;
  Emitter emitter;
};

SimulatedRealization::SimulatedRealization(const RealizationSource& source, const StudyFrame& frame,
                                           std::uint32_t index, int n_runs)
    : frame_(&frame) {
  for (std::uint32_t attempt = 0;; ++attempt) {
    realization_ = draw_realization(source.scene, source.script, source.nuisance, source.seed, index, attempt);
    realization_.script.replicates = n_runs * frame.n_days();
    try {
      traced_ = std::make_unique<Traced>(realization_, source.like.get());
      return;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::infeasible || attempt + 1 == most_rooms) throw;
    }
  }
}

SimulatedRealization::~SimulatedRealization() = default;
SimulatedRealization::SimulatedRealization(SimulatedRealization&&) noexcept = default;
SimulatedRealization& SimulatedRealization::operator=(SimulatedRealization&&) noexcept = default;

std::optional<std::vector<Series>> SimulatedRealization::with(std::span<const EffectSpec> more, int first,
                                                              int n) const {
  if (!acts_on_remembered_zones(more)) return std::nullopt;
  const effects::Pipeline stages = sim::make_stages(traced_->model, together(realization_.script.effects, more));
  const Recording& tracks = traced_->family.first();
  const bool far_enough = std::ranges::all_of(
      tracks.runs, [&](const RecordedRun& track) { return sim::goes_as_far_as(track, tracks.sensing, stages); });
  if (!far_enough) return std::nullopt;
  return traced_->emitter.emit(*frame_, stages, first, n);
}

std::vector<Series> SimulatedRealization::anew(std::span<const EffectSpec> more, int n,
                                               std::span<const std::size_t> trials) const {
  Realization altered = realization_;
  altered.script.effects = together(std::move(altered.script.effects), more);
  altered.script.replicates = n * frame_->n_days();
  const Model model = compile(altered.scene, altered.script, {.like = &traced_->model});
  const Recording tracks =
      traced_->family.record(model, runs_of(model, frame_->units.empty() ? trials : std::span<const std::size_t>{}));
  return Traced::Emitter(model, tracks, traced_->noise, &traced_->emitter)
      .emit(*frame_, model.compiled().stages(), 0, n);
}

std::optional<std::vector<Series>> SimulatedRealization::with_effects(std::span<const EffectSpec> more, int first,
                                                                      int n,
                                                                      std::span<const std::size_t> trials) const {
  try {
    auto remembered = with(more, first, n);
    auto data = remembered ? std::move(*remembered) : anew(more, n, trials);
    std::erase_if(data, [&](const Series& run) {
      return !trials.empty() && std::ranges::find(trials, run.trial) == trials.end();
    });
    return data;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    return std::nullopt;
  }
}

bool acts_on_remembered_zones(std::span<const EffectSpec> effects) {
  return std::ranges::all_of(effects, [](const EffectSpec& effect) {
    return effects::find(effect.name).info.reach != effects::Reach::geometry;
  });
}

}  // namespace pirsim::reconcile
