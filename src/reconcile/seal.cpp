#include "pirsim/reconcile/seal.hpp"

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "pirsim/core/digest.hpp"
#include "pirsim/core/error.hpp"
#include "pirsim/effects/catalogue.hpp"
#include "pirsim/io/csv_writer.hpp"
#include "pirsim/reconcile/simulated_world.hpp"
#include "pirsim/sim/study.hpp"
#include "reconcile/aliens.hpp"

namespace pirsim::reconcile {
namespace {

using Json = nlohmann::ordered_json;

constexpr int answer_schema = 1;

struct Answer {
  Hidden kind = Hidden::nothing;
  std::vector<EffectSpec> effects;
  const Alien* alien = nullptr;
  std::size_t alien_sensor = 0;
};

Hidden draw_kind(Stream& stream) {
  const double u = stream.uniform();
  if (u < 0.55) return Hidden::one;
  if (u < 0.70) return Hidden::nothing;
  return u < 0.85 ? Hidden::two : Hidden::alien;
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
  if (answer.kind == Hidden::alien) {
    answer.alien = &aliens()[stream.index(static_cast<std::uint32_t>(aliens().size()))];
    answer.alien_sensor = stream.index(static_cast<std::uint32_t>(scene.sensors.size()));
  }
  while (answer.effects.size() < most_effects(answer.kind)) {
    const effects::Effect& effect = *catalogue[stream.index(static_cast<std::uint32_t>(catalogue.size()))];
    if (has(answer.effects, effect) || has(script.effects, effect)) continue;
    answer.effects.push_back(effects::draw_from_prior(effect, scene, script, stream));
  }
  return answer;
}

std::string simulate(const World& world, const Answer& answer, Stream& stream) {
  const Model model = compile(world.scene, world.script);
  std::ostringstream text;
  io::MeasuredCsvWriter csv(text, frame_of(world.scene, world.script).sensors);
  run_study(model, {.threads = 1}, [&](const RunResult& result) {
    std::vector<Sample> rows = result.samples;
    if (answer.alien != nullptr) answer.alien->apply(rows, answer.alien_sensor, stream);
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
  json["alien"] = answer.alien == nullptr
                      ? Json()
                      : Json{{"name", answer.alien->name}, {"sensor", scene.sensors[answer.alien_sensor].id}};
  json["seed"] = settings.secret_seed;
  json["salt"] = settings.salt;
  json["measured_sha256"] = sha256(rows);
  return json.dump(2) + '\n';
}

Json parse(std::string_view text, const char* what, const char* marker) {
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object() || !json.contains(marker)) {
    throw Error(ErrorCode::input, std::string(what) + ": expected a JSON object with '" + marker + "'");
  }
  return json;
}

std::set<std::string> families_of(const std::set<std::string>& names) {
  std::set<std::string> families;
  for (const std::string& effect : names) families.emplace(effects::name(effects::find(effect).info.family));
  return families;
}

template <typename Names>
std::set<std::string> as_judged(const Names& names) {
  std::set<std::string> judged;
  for (const std::string& name : names) judged.insert(effects::judged_as(name));
  return judged;
}

Mark mark_of_effects(const std::set<std::string>& truth, const std::string& verdict,
                     const std::set<std::string>& named) {
  if (named.empty()) return Mark::none;
  const auto is_named = [&](const std::string& effect) { return named.contains(effect); };
  if (verdict == "one-of") {
    if (std::ranges::any_of(truth, is_named)) return Mark::one_of;
  } else {
    if (named == truth) return Mark::exact;
    if (std::ranges::includes(truth, named)) return Mark::part;
  }
  return families_of(named) == families_of(truth) ? Mark::family : Mark::wrong;
}

Mark mark_of(Hidden kind, const std::set<std::string>& truth, const std::string& verdict,
             const std::set<std::string>& named) {
  if (kind == Hidden::nothing) return verdict == "no-disagreement" ? Mark::exact : Mark::wrong;
  if (kind != Hidden::alien) return mark_of_effects(truth, verdict, named);
  if (verdict == "none-in-catalogue") return Mark::exact;
  return verdict == "no-disagreement" ? Mark::none : Mark::wrong;
}

}  // namespace

std::string_view name(Hidden hidden) noexcept {
  constexpr std::string_view names[] = {"any", "nothing", "one", "two", "alien"};
  return names[static_cast<std::size_t>(hidden)];
}

std::string_view name(Mark mark) noexcept {
  constexpr std::string_view names[] = {"exact", "family", "one-of", "part", "wrong", "none"};
  return names[static_cast<std::size_t>(mark)];
}

Challenge seal(const SceneSpec& scene, const ScriptSpec& script, const SealSettings& settings) {
  require_effects_left(script, settings.hidden);
  for (std::uint32_t attempt = 0;; ++attempt) {
    Stream stream({settings.secret_seed, 0, attempt, Purpose::sealed_answer});
    const std::uint64_t world_seed = (std::uint64_t{stream.next_u32()} << 32U) | stream.next_u32();
    const Answer answer = draw_answer(scene, script, settings.hidden, stream);
    // Not from the secret itself: an analysis that happens to have the same seed would simulate this very world.
    World world = draw_world(scene, script, settings.nuisance, world_seed, 0, attempt);
    world.script.replicates = settings.n_replicates;
    world.script.effects.insert(world.script.effects.end(), answer.effects.begin(), answer.effects.end());
    try {
      Challenge challenge{simulate(world, answer, stream), {}, {}};
      challenge.answer = to_json(answer, settings, scene, challenge.rows);
      challenge.commitment = sha256(challenge.answer);
      return challenge;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::infeasible || attempt + 1 == most_attempts) throw;
    }
  }
}

Score open_answer(std::string_view answer, std::string_view commitment, std::string_view report) {
  if (sha256(answer) != commitment) {
    throw Error(ErrorCode::input, "the answer is not the one that was committed to: its SHA-256 is " + sha256(answer));
  }
  const Json sealed = parse(answer, "answer", "pirsim_sealed_answer");
  const Json judged = parse(report, "report", "pirsim_reconcile_report");
  try {
    if (sealed.at("measured_sha256") != judged.at("measured").at("sha256")) {
      throw Error(ErrorCode::input, "the report is about other data than those of this challenge");
    }
    Score score;
    std::set<std::string> truth;
    for (const Json& effect : sealed.at("effects")) truth.insert(effect.at("name").get<std::string>());
    score.hidden.assign(truth.begin(), truth.end());
    if (!sealed.at("alien").is_null()) score.hidden.push_back(sealed.at("alien").at("name").get<std::string>());
    const auto kind_name = sealed.at("hidden").get<std::string>();
    const Hidden kind = kind_name == "nothing" ? Hidden::nothing : kind_name == "alien" ? Hidden::alien : Hidden::one;
    const auto verdict = judged.at("verdict").get<std::string>();
    const auto named = judged.at("effects").get<std::vector<std::string>>();
    score.mark = mark_of(kind, as_judged(truth), verdict, as_judged(named));
    score.sentence = std::string(name(score.mark)) + ": hidden was " +
                     (score.hidden.empty() ? "nothing" : boost::algorithm::join(score.hidden, ", ")) +
                     ", the verdict was " + verdict +
                     (named.empty() ? "" : " (" + boost::algorithm::join(named, ", ") + ")");
    return score;
  } catch (const Json::exception& fault) {
    throw Error(ErrorCode::input, std::string("answer or report: ") + fault.what());
  }
}

}  // namespace pirsim::reconcile
