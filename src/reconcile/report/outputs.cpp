#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "files/disk/file.hpp"
#include "model/core/text.hpp"
#include "model/schema/fields.hpp"
#include "pirsim/io.hpp"
#include "reconcile/data/measured.hpp"
#include "reconcile/report/pages.hpp"
#include "reconcile/report/sentences.hpp"

namespace pirsim::reconcile {
namespace {

using Json = nlohmann::ordered_json;

constexpr int report_schema = 1;

/// A list of what `of` makes of each.
template <typename Items, typename Of>
Json listed(const Items& items, const Of& of) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(of(item));
  return list;
}

Json to_json(const Location& location) {
  const auto of_cell = [](const LocatedCell& cell) -> Json {
    return {{"trial", cell.trial},
            {"sensor", cell.sensor},
            {"measured_s", cell.measured_s},
            {"expected_s", cell.expected_s},
            {"difference_s", cell.measured_s - cell.expected_s},
            {"band_s", {cell.low_s, cell.high_s}},
            {"adjusted_p", cell.adjusted_p},
            {"scatters", cell.scatters}};
  };
  const auto of_feature = [](const EnvelopeFeature& feature) -> Json {
    return {{"feature", feature.name.text},
            {"observed", feature.observed},
            {"median", feature.median},
            {"envelope", {feature.lower, feature.upper}},
            {"adjusted_p", feature.adjusted_p}};
  };
  return {{"p", location.p},
          {"simulated_datasets", location.n_simulated},
          {"mean_half_band_s", location.band_s},
          {"cells", listed(location.cells, of_cell)},
          {"envelope", listed(location.envelope, of_feature)}};
}

Json to_json(const HypothesisScore& score) {
  return {{"probability", score.probability},
          {"p", score.p},
          {"p_relative", score.p_relative},
          {"p_absolute", score.p_absolute},
          {"p_own", score.p_own}};
}

Json to_json(const Candidate& candidate) {
  Json json = {{"effect", candidate.score.hypothesis}, {"family", name(candidate.family)}, {"kept", candidate.kept}};
  json.update(to_json(candidate.score));
  json["reason"] = in_words(candidate);
  return json;
}

Json to_json(const FittedEffect& fitted) {
  Json parameters = Json::array();
  for (const FittedParameter& p : fitted.parameters) {
    parameters.push_back({{"name", p.name},
                          {"unit", p.unit},
                          {"value", p.value},
                          {"interval_90", {p.interval.low, p.interval.high}},
                          {"equally_likely", p.equally_likely},
                          {"off", p.is_strength ? Json(p.off) : Json()}});
  }
  Json choices = Json::object();
  for (const auto& [name, value] : fitted.effect.choices) choices[name] = value;
  Json probabilities = Json::object();
  for (const FittedChoice& choice : fitted.choices) {
    for (const auto& [word, probability] : choice.words)
      probabilities[choice.name][word.empty() ? "all" : word] = probability;
  }
  return {{"effect", fitted.effect.name},
          {"parameters", parameters},
          {"choices", choices},
          {"choice_probabilities", probabilities},
          {"interval_includes_off", fitted.includes_off}};
}

Json to_json(const Gap& gap) {
  return {{"energy_score", gap.energy_score},
          {"area_s", gap.area_s},
          {"cells_outside", gap.cells_outside},
          {"cells", gap.n_cells},
          {"p", gap.p}};
}

Json to_json(const Verification& v) {
  return {{"folds", v.n_folds},
          {"named_in_folds", v.names},
          {"before", to_json(v.before)},
          {"after", to_json(v.after)},
          {"noise_floor", v.noise_floor},
          {"gain_95", {v.gain.low, v.gain.high}},
          {"trials", v.n_trials},
          {"trials_better", v.n_better},
          {"sign_p", v.sign_p},
          {"share_closed", v.share_closed},
          {"placebo", {{"effect", v.placebo_effect}, {"energy_score", v.placebo}}},
          {"shrunk", v.shrunk},
          {"plain_model_refused", v.refused},
          {"closed", v.closed}};
}

Json to_json(const Look& look) { return {{"applied", look.applied}, {"level", look.level}, {"p", look.p}}; }

Json to_json(const RangeEnd& end) {
  return {{"effect", end.effect},
          {"parameter", end.parameter},
          {"unit", end.unit},
          {"looked_for", {end.looked_for.low, end.looked_for.high}},
          {"end", end.end},
          {"tried_to", end.tried_to},
          {"found", end.found ? Json(*end.found) : Json()}};
}

Json to_json(const Residuals& residuals, const std::string& sentence) {
  const auto of_driver = [](const ResidualDriver& driver) -> Json {
    return {{"who", driver.who},
            {"when", driver.when},
            {"what", driver.what},
            {"log_odds", driver.log_odds},
            {"standard_error", driver.standard_error},
            {"z", driver.z},
            {"p", driver.p}};
  };
  return {{"sentence", sentence}, {"drivers", listed(residuals.drivers, of_driver)}};
}

Json to_json(const DataFinding& finding) {
  Json places = Json::array();
  for (const DataFinding::Rows& place : finding.places)
    places.push_back({{"trial", place.trial}, {"run", place.replicate}, {"rows", {place.from_row, place.to_row}}});
  return {{"kind", name(finding.what)},
          {"impossible", finding.is_impossible},
          {"sensors", finding.sensors},
          {"places", places},
          {"rows", finding.n_rows},
          {"exceptions", finding.n_exceptions},
          {"every_s", finding.every_s > 0.0 ? Json(finding.every_s) : Json()},
          {"chance", finding.chance},
          {"sentence", in_words(finding)}};
}

constexpr Column<LocatedCell> located_cells[]{
    {{"trial", Holds::text, "as the script names it"}, [](const LocatedCell& cell) -> Cell { return cell.trial; }},
    {{"sensor", Holds::text, "as the scene names it"}, [](const LocatedCell& cell) -> Cell { return cell.sensor; }},
    {{"measured_s", Holds::number, "seconds with motion a run", "s"},
     [](const LocatedCell& cell) -> Cell { return cell.measured_s; }},
    {{"expected_s", Holds::number, "mean of the simulated datasets", "s"},
     [](const LocatedCell& cell) -> Cell { return cell.expected_s; }},
    {{"difference_s", Holds::number, "measured less expected", "s"},
     [](const LocatedCell& cell) -> Cell { return cell.measured_s - cell.expected_s; }},
    {{"low_s", Holds::number, "2.5 % of the simulated datasets lie below", "s"},
     [](const LocatedCell& cell) -> Cell { return cell.low_s; }},
    {{"high_s", Holds::number, "2.5 % of the simulated datasets lie above", "s"},
     [](const LocatedCell& cell) -> Cell { return cell.high_s; }},
    {{"adjusted_p", Holds::number, "below alpha, the cell differs whatever the others do"},
     [](const LocatedCell& cell) -> Cell { return cell.adjusted_p; }},
    {{"scatters", Holds::number, "by which it is off, of the model's own; a frame needs 3"},
     [](const LocatedCell& cell) -> Cell { return cell.scatters; }},
};

struct CandidateLine {
  const Candidate& candidate;
  std::string reason;

  explicit CandidateLine(const Candidate& of) : candidate(of), reason(in_words(of)) {}
};

constexpr Column<CandidateLine> candidate_lines[]{
    {{"effect", Holds::text, "its name"},
     [](const CandidateLine& line) -> Cell { return line.candidate.score.hypothesis; }},
    {{"family", Holds::text, "its family"},
     [](const CandidateLine& line) -> Cell { return name(line.candidate.family); }},
    {{"kept", Holds::bit, "1 if it isn't ruled out"},
     [](const CandidateLine& line) -> Cell { return line.candidate.kept ? 1 : 0; }},
    {{"probability", Holds::number, "among all effects, each as likely as the others beforehand"},
     [](const CandidateLine& line) -> Cell { return line.candidate.score.probability; }},
    {{"p", Holds::number, "of the next two: twice the smaller, at most 1"},
     [](const CandidateLine& line) -> Cell { return line.candidate.score.p; }},
    {{"p_relative", Holds::number, "share of its own datasets that another effect explains as well"},
     [](const CandidateLine& line) -> Cell { return line.candidate.score.p_relative; }},
    {{"p_absolute", Holds::number, "share of its own datasets that lie as far from the rest of them"},
     [](const CandidateLine& line) -> Cell { return line.candidate.score.p_absolute; }},
    {{"p_own", Holds::number, "share of its own datasets that look as much like those of an unknown effect"},
     [](const CandidateLine& line) -> Cell { return line.candidate.score.p_own; }},
    {{"reason", Holds::text, "why it was kept or ruled out"},
     [](const CandidateLine& line) -> Cell { return line.reason; }},
};

}  // namespace

std::string to_json(const Outcome& outcome, const Measured& measured, const Settings& settings, const Context& context,
                    const Provenance& provenance) {
  std::vector<std::string> notes = measured.notes;
  notes.insert(notes.end(), outcome.notes.begin(), outcome.notes.end());
  Json nuisance;
  each_number(settings.nuisance, [&](const char* key, double width, const auto&) { nuisance[key] = width; });
  Json json = {{"pirsim_reconcile_report", report_schema},
               {"verdict", name(outcome.verdict)},
               {"sentence", sentence(outcome)},
               {"details", details(outcome)},
               {"effects", outcome.named},
               {"program", provenance.program},
               {"scene", provenance.scene},
               {"script", provenance.script},
               {"measured",
                {{"file", provenance.measured},
                 {"sha256", measured.digest},
                 {"kind", measured.kind == Measured::Kind::series ? "series" : "sums"},
                 {"runs", measured.n_replicates()},
                 {"notes", notes}}},
               {"alpha", settings.alpha},
               {"seed", context.seed},
               {"table", outcome.table_key},
               {"nuisance", nuisance}};
  if (!provenance.marks.empty()) json["marks"] = provenance.marks;
  json["verdict_of_rows"] = name(outcome.verdict_of_rows);
  const auto as_json = [](const auto& item) { return to_json(item); };
  json["data_findings"] = listed(outcome.data_findings, as_json);
  json["where"] = to_json(outcome.location);
  json["nothing"] = to_json(outcome.nothing);
  json["family"] = {{"name", name(outcome.family.family)}, {"probability", outcome.family.probability}};
  json["candidates"] = listed(with_twins(outcome.candidates), as_json);
  json["fits"] = listed(outcome.fits, as_json);
  json["looks"] = listed(outcome.looks, as_json);
  for (std::size_t i = 0; i < outcome.looks.size(); ++i) json["looks"][i]["one_of"] = outcome.looks[i].one_of;
  json["relatives"] = listed(outcome.relatives, as_json);
  json["range_end"] = outcome.range_end ? to_json(*outcome.range_end) : Json();
  json["verification"] = outcome.verification ? to_json(*outcome.verification) : Json();
  json["residuals"] = outcome.residuals ? to_json(*outcome.residuals, sentence(*outcome.residuals)) : Json();
  json["left_over"] = outcome.left_over ? to_json(*outcome.left_over, sentence_of_rest(*outcome.left_over)) : Json();
  json["telling_features"] = listed(outcome.telling_features, std::mem_fn(&FeatureName::text));
  json["calibration_error"] = outcome.calibration_error;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

ScriptSpec patched(const ScriptSpec& script, const Outcome& outcome) {
  ScriptSpec with = script;
  if (outcome.verdict == Verdict::faulty_data) return with;
  for (const FittedEffect& fitted : outcome.fits) with.effects.push_back(fitted.effect);
  return with;
}

void write_report(const std::filesystem::path& folder, const Outcome& outcome, const Measured& measured,
                  const ScriptSpec& script, const Settings& settings, const Context& context,
                  const Provenance& provenance) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  io::write_text_file(folder / "where.csv", table_of(located_cells, outcome.location.cells));
  io::write_text_file(folder / "candidates.csv", table_of(candidate_lines, with_twins(outcome.candidates)));
  const std::filesystem::path patch = folder / "script_patched.yaml";
  if (!outcome.fits.empty()) {
    io::write_text_file(patch, io::to_yaml(io::moved(patched(script, outcome), folder)));
  } else {
    std::filesystem::remove(patch, fault);  // of an earlier analysis
  }
  // What is in the folder's trail already is never overwritten. Each analysis begins with the data's digest.
  const std::filesystem::path trail_file = folder / "trail.log";
  std::string trail = std::filesystem::exists(trail_file) ? io::read_text_file(trail_file) : std::string();
  std::size_t before = 0;
  std::istringstream lines(trail);
  for (std::string line; std::getline(lines, line);) before += line.starts_with("data " + measured.digest) ? 1 : 0;
  if (!trail.empty()) trail += '\n';
  for (const std::string& line : outcome.trail) trail += line + '\n';
  trail += "these data were analysed " + counted(before, "time") + " before in this folder\n";
  io::write_text_file(trail_file, trail);
  const std::vector<std::string>& phases = script.summary.phases;
  const std::vector<std::string> names{"--scene", provenance.scene, "--script", provenance.script};
  const Watched watched{provenance.model_options.empty() ? names : provenance.model_options,
                        phases.empty() ? "" : phases.front(), day_parts_of(script).empty()};
  io::Report page = report_page(outcome, watched);
  if (const TableSettings usual; settings.table.n_realizations != usual.n_realizations) {
    page.paragraphs.push_back("For this analysis the plain model was simulated " +
                              std::to_string(settings.table.n_realizations) + " times, not the usual " +
                              std::to_string(usual.n_realizations) + ": --budget scales this number and those of the " +
                              "effects. Fewer datasets rule out fewer effects.");
  }
  page.footer = provenance.program + ", " + provenance.scene +
                (provenance.marks.empty() ? "" : ", " + provenance.marks) + ", " + provenance.script + ", " +
                provenance.measured;
  io::write_text_file(folder / "report.html", io::to_html(page));
  io::write_text_file(folder / "report.json", to_json(outcome, measured, settings, context, provenance));
}

}  // namespace pirsim::reconcile
