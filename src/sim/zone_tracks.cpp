#include "sim/zone_tracks.hpp"

#include <algorithm>

#include "core/parallel.hpp"
#include "pirsim/effects.hpp"
#include "sim/add_triggers.hpp"
#include "sim/begin_tracks.hpp"
#include "sim/set_numbering.hpp"
#include "sim/state.hpp"

namespace pirsim::sim {
namespace {

/// A run with its own numbering of sets.
struct TracedRun {
  ZoneTrack track;
  std::vector<ZoneSet> sets;
};

TracedRun trace_run(const Model& model, std::uint32_t run) {
  TracedRun traced{{{run, model.replicate_of(run), model.trial_of(run).id, {}, {}, {}}, {}, {}}, {}};
  SetNumbering numbering(model.detector().n_zones());
  State state(model, run);
  ZoneSet last(model.detector().n_zones());
  std::uint32_t number = 0;
  while (!state.finished()) {
    if (step_tick(model, state)) traced.track.rows.samples.push_back(state.sample());
    for (const std::size_t seat : state.seats_left()) traced.track.seats_left.push_back({state.tick(), seat});
    if (state.zones() != last) {
      last = state.zones();
      number = numbering.number(last);
    }
    traced.track.sets.push_back(number);
  }
  traced.sets = std::move(numbering.sets());
  return traced;
}

}  // namespace

ZoneTracks trace(const Model& model, std::span<const std::uint32_t> runs, unsigned threads) {
  ZoneTracks tracks = begin_tracks(model);
  SetNumbering numbering(model.detector().n_zones());
  ordered_parallel<TracedRun>(
      runs.size(), threads, [&](std::size_t i) { return trace_run(model, runs[i]); },
      [&](TracedRun& traced) {
        std::vector<std::uint32_t> renumbered;
        for (const ZoneSet& set : traced.sets) renumbered.push_back(numbering.number(set));
        for (std::uint32_t& number : traced.track.sets) number = renumbered[number];
        tracks.runs.push_back(std::move(traced.track));
      });
  tracks.sets = std::move(numbering.sets());
  return tracks;
}

void ChangeLogic::prepare(std::span<const ZoneSet> sets) {
  channels_.clear();
  for (const ZoneSet& set : sets) {
    channels_.emplace_back(detector_.n_channels());
    detector_.add_channels(set, channels_.back());
  }
}

void ChangeLogic::begin_run(std::uint64_t seed, std::uint32_t run) { edge_draw_.begin_run(seed, run); }

void ChangeLogic::tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept {
  edge_draw_.tick();
  if (before == after) return;
  detector_.mark(channels_[before].words(), channels_[after].words(), edge_draw_.watched(), triggers);
}

void PolarityLogic::prepare(std::span<const ZoneSet> sets) {
  const std::size_t n = detector_.n_sensors();
  sums_.assign(sets.size() * n, 0.0);
  for (std::size_t i = 0; i < sets.size(); ++i) detector_.add_up(sets[i], std::span(sums_).subspan(i * n, n));
}

void PolarityLogic::begin_run(std::uint64_t, std::uint32_t) { detector_.begin_run(); }

void PolarityLogic::tick(std::uint32_t, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept {
  const std::size_t n = detector_.n_sensors();
  detector_.tick(std::span<const double>(sums_).subspan(after * n, n), triggers);
}

std::unique_ptr<DetectorLogic> make_logic(const Model& model) {
  if (model.polarity()) return std::make_unique<PolarityLogic>(*model.polarity());
  return std::make_unique<ChangeLogic>(model.detector(), model.edge_draw());
}

RunResult emit(const ZoneTracks& tracks, std::size_t index, DetectorLogic& detector, std::uint64_t seed,
               const effects::Pipeline& stages) {
  const ZoneTrack& track = tracks.runs[index];
  RunResult result = track.rows;
  effects::Pipeline pipeline = stages;
  pipeline.begin_run(seed, result.run);
  detector.begin_run(seed, result.run);
  std::vector<std::uint8_t> triggers(tracks.n_sensors);
  pir::WindowReader reader = make_reader(tracks.reader, tracks.n_sensors, tracks.ticks_per_window, seed, result.run);
  auto left = track.seats_left.begin();
  std::uint32_t before = 0;
  std::int64_t tick = 0;
  for (Sample& sample : result.samples) {
    for (int i = 0; i < tracks.ticks_per_window; ++i) {
      const std::uint32_t after = track.sets[static_cast<std::size_t>(tick)];
      ++tick;
      std::ranges::fill(triggers, std::uint8_t{0});
      detector.tick(before, after, triggers);
      before = after;
      for (; left != track.seats_left.end() && left->tick == tick; ++left) pipeline.seat_left(left->seat);
      add_triggers(pipeline, tick, triggers, reader);
    }
    sample.bits.assign(reader.readings().begin(), reader.readings().end());
    pipeline.apply(sample);
  }
  return result;
}

effects::Pipeline make_pipeline(const Model& model, std::span<const EffectSpec> effects) {
  Diagnostics diagnostics;
  effects::check(effects, model.scene(), diagnostics);
  diagnostics.throw_if_errors();
  return {effects, {model.scene(), model.script().sensing, model.clipped_rays()}};
}

}  // namespace pirsim::sim
