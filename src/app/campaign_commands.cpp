#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/output_checks.hpp"
#include "app/row_output.hpp"
#include "app/summary_output.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "studies/campaign.hpp"
#include "studies/row_tally.hpp"

namespace pirsim::app {

void status(const CampaignOptions& options) {
  const std::vector<studies::ShardReport> shards = studies::campaign_status(options.folder);
  if (options.verbosity != Verbosity::quiet) std::cerr << studies::to_text(shards);
  if (const std::string rest = studies::array_specification(shards); !rest.empty()) std::cout << rest << '\n';
  require_written();
}

namespace {

/// The script of the shards, read again for what a summary wants to know of it.
ScriptSpec script_of(const CampaignOptions& options) {
  if (options.script.empty()) throw Error(ErrorCode::usage, "--summary needs --script FILE, that of the shards");
  const io::Provenance made = studies::campaign_provenance(options.folder);
  ScriptSpec script = io::read_script(options.script, options.overrides);
  script.seed = made.seed;
  script.replicates = static_cast<int>(made.study_runs / script.trials.size());
  if (io::to_yaml(script) != made.resolved_script) {
    throw Error(ErrorCode::input, Where{options.script.string()}, "isn't the script of these shards");
  }
  return script;
}

std::vector<std::string> trial_ids(const ScriptSpec& script) {
  std::vector<std::string> ids;
  for (const TrialSpec& trial : script.trials) ids.push_back(trial.id);
  return ids;
}

}  // namespace

void merge(const CampaignOptions& options) {
  if (options.output.empty()) throw Error(ErrorCode::usage, "-o FILE is missing");
  check_outputs({{"-o", options.output, table_endings()}, {"--summary", options.summary, {".csv", ".md"}}}, {});
  ScriptSpec script;
  std::optional<io::AtomicFile> file;
  std::optional<studies::RowTally> tally;
  if (!options.summary.empty()) {
    script = script_of(options);
    file.emplace(options.summary);
    tally.emplace(trial_ids(script), script.summary, measured_cells(script));
  }
  const studies::Sink sink = [&](std::string_view bytes) { tally->add(bytes); };
  const io::Manifest merged = studies::merge_campaign(options.folder, options.output, tally ? sink : studies::Sink());
  if (tally) write_summary(tally->finish(), *file, options.summary, script.name, options.verbosity);
  if (options.verbosity != Verbosity::quiet) {
    std::cerr << "merged " << merged.runs.count() << " runs, " << merged.rows << " rows\n";
  }
}

}  // namespace pirsim::app
