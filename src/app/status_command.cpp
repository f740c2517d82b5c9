#include <iostream>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "studies/campaign.hpp"

namespace pirsim::app {
namespace {

struct StatusOptions {
  std::filesystem::path folder;  ///< with shards
  Verbosity verbosity = Verbosity::normal;
};

void status(const StatusOptions& options) {
  const std::vector<studies::ShardReport> shards = [&] {
    const Progress progress({.what = "reading the shards of " + options.folder.string()}, options.verbosity);
    return studies::campaign_status(options.folder);
  }();
  if (options.verbosity != Verbosity::quiet) std::cerr << studies::to_text(shards);
  if (const std::string rest = studies::array_specification(shards); !rest.empty()) std::cout << rest << '\n';
  require_written();
}

}  // namespace

void add_status_command(CLI::App& app) {
  CLI::App& command = add_command(app, "status", "which shards of a folder are missing or broken", R"(
  pirsim status out                                                what is there; what is left, as Slurm's --array
  pirsim status out -q                                             only what is left
)");
  const auto options = std::make_shared<StatusOptions>();
  command.add_option("DIR", options->folder, "folder with the shards")->required()->group("Inputs");
  offer_quiet(command, options->verbosity);
  command.callback([options] { status(*options); });
}

}  // namespace pirsim::app
