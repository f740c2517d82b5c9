#include "reconcile/validation/seal.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/digest.hpp"
#include "core/text.hpp"
#include "effects/catalogue.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/error.hpp"
#include "pirsim/reconcile.hpp"
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
      effects::catalogue_for(script), [&](const effects::Effect* effect) { return !has(script.effects, *effect); }));
  if (left >= most_effects(wanted)) return;
  throw Error(ErrorCode::usage, "'" + std::string(name(wanted)) +
                                    "' can't be hidden: effects that the script doesn't have: " + std::to_string(left) +
                                    ", needed: " + std::to_string(most_effects(wanted)));
}

Answer draw_answer(const SceneSpec& scene, const ScriptSpec& script, Hidden wanted, Stream& stream) {
  Answer answer;
  answer.kind = wanted == Hidden::any ? draw_kind(stream) : wanted;
  const std::vector<const effects::Effect*> catalogue = effects::catalogue_for(script);
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

namespace {

using Json = nlohmann::ordered_json;

/// A JSON file of pirsim's own; what is wrong with it is told with its name.
class JsonFile {
 public:
  JsonFile(const Document& document, const std::string& marker, int schema)
      : name_(document.name), json_(Json::parse(document.text, nullptr, false)) {
    if (!json_.is_object() || !json_.contains(marker)) refuse("expected a JSON object with '" + marker + "'");
    if (json_[marker] != schema)
      refuse("'" + marker + "' isn't " + std::to_string(schema) + ", the only one that this pirsim reads");
  }

  template <typename Value>
  [[nodiscard]] Value get(const std::string& place) const {
    try {
      return json_.at(Json::json_pointer(place)).get<Value>();
    } catch (const Json::exception&) {
      refuse("'" + place + "' isn't there, or isn't what it should be");
    }
  }

  /// The place of what is read there among these words.
  [[nodiscard]] std::size_t get_one_of(std::span<const std::string_view> words, const std::string& place) const {
    const auto word = get<std::string>(place);
    const auto known = std::ranges::find(words, word);
    if (known == words.end()) {
      const std::vector<std::string> all(words.begin(), words.end());
      refuse("'" + place + "' is '" + word + "', not one of " + joined(all, ", "));
    }
    return static_cast<std::size_t>(known - words.begin());
  }

  void require_effects(const std::vector<std::string>& names) const {
    std::vector<EffectSpec> effects;
    for (const std::string& name : names) effects.push_back({name, {}, {}, {name_}});
    Diagnostics faults;
    effects::check(effects, faults);
    faults.throw_if_errors();
  }

  [[noreturn]] void refuse(const std::string& message) const { throw Error(ErrorCode::input, {name_}, message); }

 private:
  std::string name_;
  Json json_;
};

struct Truth {
  explicit Truth(const JsonFile& answer)
      : kind(static_cast<Hidden>(answer.get_one_of(hidden_names, "/hidden"))),
        measured(answer.get<std::string>("/measured_sha256")) {
    const auto n = answer.get<std::vector<Json>>("/effects").size();
    for (std::size_t i = 0; i < n; ++i)
      effects.push_back(answer.get<std::string>("/effects/" + std::to_string(i) + "/name"));
    answer.require_effects(effects);
    std::ranges::sort(effects);
    if (!answer.get<Json>("/out_of_catalogue_fault").is_null())
      fault = answer.get<std::string>("/out_of_catalogue_fault/name");
  }

  Hidden kind;
  std::vector<std::string> effects;
  std::string fault;     ///< empty: none
  std::string measured;  ///< SHA-256
};

struct Finding {
  explicit Finding(const JsonFile& report)
      : verdict(static_cast<Verdict>(report.get_one_of(verdict_names, "/verdict"))),
        effects(report.get<std::vector<std::string>>("/effects")),
        measured(report.get<std::string>("/measured/sha256")) {
    report.require_effects(effects);
    const bool names_none = verdict == Verdict::no_disagreement || verdict == Verdict::none_in_catalogue;
    if (names_none && !effects.empty())
      report.refuse("'/effects' isn't empty, though the verdict is " + std::string(name(verdict)));
  }

  Verdict verdict;
  std::vector<std::string> effects;
  std::string measured;  ///< SHA-256
};

std::set<std::string> families_of(const std::set<std::string>& names) {
  std::set<std::string> families;
  for (const std::string& effect : names) families.emplace(effects::name(effects::find(effect).info.family));
  return families;
}

std::set<std::string> as_judged(const std::vector<std::string>& names) {
  std::set<std::string> judged;
  for (const std::string& name : names) judged.insert(effects::judged_as(name));
  return judged;
}

Mark mark_of_effects(const Truth& hidden, const Finding& finding) {
  const std::set<std::string> truth = as_judged(hidden.effects), named = as_judged(finding.effects);
  if (named.empty()) return Mark::none;
  const auto is_named = [&](const std::string& effect) { return named.contains(effect); };
  if (finding.verdict == Verdict::one_of || finding.verdict == Verdict::nearest) {
    if (std::ranges::any_of(truth, is_named)) return Mark::one_of;
  } else {
    if (named == truth) return Mark::exact;
    if (std::ranges::includes(truth, named)) return Mark::part;
  }
  return families_of(named) == families_of(truth) ? Mark::family : Mark::wrong;
}

Mark mark_of(const Truth& hidden, const Finding& finding) {
  const bool sees_nothing = finding.verdict == Verdict::no_disagreement;
  if (finding.verdict == Verdict::faulty_data) return Mark::wrong;  // the rows of a challenge are sound
  if (hidden.kind == Hidden::nothing) return sees_nothing ? Mark::exact : Mark::wrong;
  if (hidden.kind != Hidden::out_of_catalogue) return mark_of_effects(hidden, finding);
  if (finding.verdict == Verdict::none_in_catalogue) return Mark::exact;
  return sees_nothing ? Mark::none : Mark::wrong;
}

}  // namespace

std::string_view name(Mark mark) noexcept {
  constexpr std::string_view names[] = {"exact", "family", "one-of", "part", "wrong", "none"};
  return names[static_cast<std::size_t>(mark)];
}

Score open_answer(const Document& answer, std::string_view commitment, const Document& report) {
  const std::string digest = sha256(answer.text);
  if (digest != commitment) {
    throw Error(ErrorCode::input, {answer.name},
                "the answer is not the one that was committed to: its SHA-256 is " + digest);
  }
  const Truth hidden(JsonFile(answer, "pirsim_sealed_answer", answer_schema));
  const JsonFile judged(report, "pirsim_reconcile_report", report_schema);
  const Finding finding(judged);
  if (hidden.measured != finding.measured) judged.refuse("the report is about other data than those of this challenge");
  Score score;
  score.hidden = hidden.effects;
  if (!hidden.fault.empty()) score.hidden.push_back(hidden.fault);
  score.mark = mark_of(hidden, finding);
  score.verdict = finding.verdict;
  score.named = finding.effects;
  return score;
}

}  // namespace pirsim::reconcile
