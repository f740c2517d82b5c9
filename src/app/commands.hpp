// What the command line can do. Each returns normally or throws Error.
#pragma once

#include "app/options.hpp"

namespace pirsim::app {

void run(const Inputs& inputs, const RunOptions& options);
void check(const Inputs& inputs);
void preview(const Inputs& inputs, const PreviewOptions& options);
void coverage(const Inputs& inputs, const CoverageOptions& options);
void walk_test(const Inputs& inputs, const WalkTestOptions& options);
void placements(const Inputs& inputs, const PlacementOptions& options);
void status(const CampaignOptions& options);
void merge(const CampaignOptions& options);
void reconcile_data(const Inputs& inputs, const AnalysisOptions& analysis, const ReconcileOptions& options);
void seal_challenge(const Inputs& inputs, const SealOptions& options);
void open_challenge(const OpenOptions& options);
void list_effects(const EffectsOptions& options);
void reconcile_selftest(const Inputs& inputs, const AnalysisOptions& analysis, const SelftestOptions& options);
void reconcile_plan(const Inputs& inputs, const AnalysisOptions& analysis, const PlanOptions& options);
void export_gltf(const Inputs& inputs, const ExportOptions& options);

}  // namespace pirsim::app
