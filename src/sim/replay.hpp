// Recordings replayed with the Model's own detector and with effects.
#pragma once

#include <memory>
#include <span>

#include "effects/pipeline.hpp"
#include "pirsim/recording.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::sim {

/// The detector that the Model's own runs have: sim::Detector, fed by a recording.
[[nodiscard]] std::unique_ptr<DetectorLogic> make_logic(const Model& model);

/// replay() with what the stages do to triggers and rows. With make_logic(model), the script's seed and the Model's
/// stages: the study's rows, bit for bit.
[[nodiscard]] RunResult replay(const Recording& recording, std::size_t index, DetectorLogic& detector,
                               std::uint64_t seed, const effects::Pipeline& stages);

/// What these effects do to triggers and rows of a study that was compiled without them, to be given to replay(). Those
/// that reach geometry are passed over: they need a Model of their own. Throws Error(input) for unknown names.
[[nodiscard]] effects::Pipeline make_stages(const Model& model, std::span<const EffectSpec> effects);

/// Without runs yet. Throws Error(usage) for sensors with an analog response.
[[nodiscard]] Recording empty_recording(const CompiledStudy& study);

}  // namespace pirsim::sim
