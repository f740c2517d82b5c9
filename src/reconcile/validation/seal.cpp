#include "reconcile/validation/seal.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/digest.hpp"
#include "effects/catalogue.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/error.hpp"
#include "pirsim/study.hpp"
#include "reconcile/ensemble/simulated_realization.hpp"
#include "reconcile/validation/out_of_catalogue.hpp"

namespace pirsim::reconcile {
namespace {

using Json = nlohmann::ordered_json;

struct Answer {
  Hidden kind = Hidden::nothing;
  std::vector<EffectSpec> effects;
  const OutOfCatalogueFault* fault = nullptr;
  std::size_t faulty_sensor = 0;
};

Hidden draw_kind(Stream& stream) {
  const double u = stream.uniform();
  if (u < 0.55) return Hidden::one;
  if (u < 0.70) return Hidden::nothing;
  return u < 0.85 ? Hidden::two : Hidden::out_of_catalogue;
}

std::size_t most_effects(Hidden kind) {
  return kind == Hidden::one ? 1 : kind == Hidden::two || kind == Hidden::any ? 2 : 0;
}

bool has(const std::vector<EffectSpec>& effects, const effects::Effect& effect) {
  return std::ranges::find(effects, effect.info.name, &EffectSpec::name) != effects.end();
}

void require_effects_left(const ScriptSpec& script, Hidden wanted) {
  const auto left = static_cast<std::size_t>(std::ranges::count_if(
      effects::catalogue(), [&](const effects::Effect* effect) { return !has(script.effects, *effect); }));
  if (left >= most_effects(wanted)) return;
  throw Error(ErrorCode::usage, "'" + std::string(name(wanted)) +
                                    "' can't be hidden: effects that the script doesn't have: " + std::to_string(left) +
                                    ", needed: " + std::to_string(most_effects(wanted)));
}

Answer draw_answer(const SceneSpec& scene, const ScriptSpec& script, Hidden wanted, Stream& stream) {
  Answer answer;
  answer.kind = wanted == Hidden::any ? draw_kind(stream) : wanted;
  const auto& catalogue = effects::catalogue();
  if (answer.kind == Hidden::out_of_catalogue) {
    answer.fault =
        &out_of_catalogue_faults()[stream.index(static_cast<std::uint32_t>(out_of_catalogue_faults().size()))];
    answer.faulty_sensor = stream.index(static_cast<std::uint32_t>(scene.sensors.size()));
  }
  while (answer.effects.size() < most_effects(answer.kind)) {
    const effects::Effect& effect = *catalogue[stream.index(static_cast<std::uint32_t>(catalogue.size()))];
    if (has(answer.effects, effect) || has(script.effects, effect)) continue;
    answer.effects.push_back(effects::draw_from_prior(effect, scene, script, stream));
  }
  return answer;
}

std::string simulate(const Realization& realization, const Answer& answer, Stream& stream) {
  const Model model = compile(realization.scene, realization.script);
  std::ostringstream text;
  io::CsvWriter csv(text, measured_columns(frame_of(realization.scene, realization.script)));
  run_study(model, {.threads = 1}, [&](const RunResult& result) {
    std::vector<Sample> rows = result.samples;
    if (answer.fault != nullptr) answer.fault->apply(rows, answer.faulty_sensor, stream);
    for (const Sample& row : rows) csv.write(row);
  });
  return text.str();
}

std::string to_json(const Answer& answer, const SealSettings& settings, const SceneSpec& scene,
                    const std::string& rows) {
  Json effects = Json::array();
  for (const EffectSpec& effect : answer.effects) {
    Json parameters = Json::object(), choices = Json::object();
    for (const auto& [key, value] : effect.parameters) parameters[key] = value;
    for (const auto& [key, value] : effect.choices) choices[key] = value;
    effects.push_back({{"name", effect.name}, {"parameters", parameters}, {"choices", choices}});
  }
  Json json = {{"pirsim_sealed_answer", answer_schema}, {"hidden", name(answer.kind)}, {"effects", effects}};
  json["out_of_catalogue_fault"] =
      answer.fault == nullptr ? Json()
                              : Json{{"name", answer.fault->name}, {"sensor", scene.sensors[answer.faulty_sensor].id}};
  json["seed"] = settings.secret_seed;
  json["salt"] = settings.salt;
  json["measured_sha256"] = sha256(rows);
  return json.dump(2) + '\n';
}

}  // namespace

std::string_view name(Hidden hidden) noexcept { return hidden_names[static_cast<std::size_t>(hidden)]; }

Challenge seal(const SceneSpec& scene, const ScriptSpec& script, const SealSettings& settings) {
  require_effects_left(script, settings.hidden);
  for (std::uint32_t attempt = 0;; ++attempt) {
    Stream stream({settings.secret_seed, 0, attempt, Purpose::sealed_answer});
    const std::uint64_t realization_seed = (std::uint64_t{stream.next_u32()} << 32U) | stream.next_u32();
    const Answer answer = draw_answer(scene, script, settings.hidden, stream);
    // Not from the secret itself: an analysis that happens to have the same seed would simulate this very realization.
    Realization realization = draw_realization(scene, script, settings.nuisance, realization_seed, 0, attempt);
    realization.script.replicates = settings.n_replicates;
    realization.script.effects.insert(realization.script.effects.end(), answer.effects.begin(), answer.effects.end());
    try {
      Challenge challenge{simulate(realization, answer, stream), {}, {}};
      challenge.answer = to_json(answer, settings, scene, challenge.rows);
      challenge.commitment = sha256(challenge.answer);
      return challenge;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::infeasible || attempt + 1 == most_attempts) throw;
    }
  }
}

}  // namespace pirsim::reconcile
