#include <iostream>

#include "app/commands.hpp"
#include "app/output_checks.hpp"
#include "app/row_output.hpp"
#include "pirsim/core/error.hpp"
#include "pirsim/studies/campaign.hpp"

namespace pirsim::app {

void status(const CampaignOptions& options) {
  const std::vector<studies::ShardReport> shards = studies::campaign_status(options.folder);
  if (options.verbosity != Verbosity::quiet) std::cerr << studies::to_text(shards);
  if (const std::string rest = studies::array_specification(shards); !rest.empty()) std::cout << rest << '\n';
  require_written();
}

void merge(const CampaignOptions& options) {
  if (options.output.empty()) throw Error(ErrorCode::usage, "-o FILE is missing");
  check_outputs({{"-o", options.output, table_endings()}}, {});
  const io::Manifest merged = studies::merge_campaign(options.folder, options.output);
  if (options.verbosity != Verbosity::quiet) {
    std::cerr << "merged " << merged.runs.count() << " runs, " << merged.rows << " rows\n";
  }
}

}  // namespace pirsim::app
