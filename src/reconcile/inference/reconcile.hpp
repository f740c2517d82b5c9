// The whole loop: measured data and a model in, a verdict out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "reconcile/data/measured.hpp"
#include "reconcile/ensemble/reference_table.hpp"
#include "reconcile/inference/outcome.hpp"
#include "reconcile/inference/table_view.hpp"

namespace pirsim::reconcile {

struct Settings {
  NuisanceSpec nuisance;
  double alpha = 0.05;
  int max_effects = 3;
  std::uint64_t seed = 1;  ///< of the analysis; has nothing to do with the script's
  unsigned threads = 0;
  TableSettings table;
  std::filesystem::path table_folder;  ///< empty: the table is not kept
  std::size_t trees = 300;
  std::uint32_t verify_realizations = 60;  ///< simulated with each patched model
  std::vector<std::size_t> holdout;  ///< trials (ascending) kept from naming and fitting, to be judged on; none: folds
};

/// What a caller may tell its user while it waits.
struct Observer {
  std::function<void(const std::string&)> stage;                          ///< what begins now
  std::function<void(std::uint32_t done, std::uint32_t total)> progress;  ///< of the table
};

/// A study with the reference table for one shape of data.
struct ReferenceStudy {
  RealizationSource source;
  StudyFrame frame;
  std::vector<CellKnowledge> knowledge;
  DataShape shape;
  ReferenceTable table;
  std::string key;  ///< of the table

  /// What the plain model's training datasets say of these trials (sorted).
  [[nodiscard]] FeatureMap map(std::vector<std::size_t> trials) const;
  /// The table as it looks in these trials (sorted); must not outlive the reference study.
  [[nodiscard]] std::shared_ptr<const TableView> view(std::vector<std::size_t> trials, unsigned threads) const;
};
[[nodiscard]] ReferenceStudy make_reference_study(
    const SceneSpec& scene, const ScriptSpec& script, const Settings& settings,
    const std::function<DataShape(const StudyFrame&, std::span<const Series> pilot)>& shape_of_data,
    const Observer& observer = {});

[[nodiscard]] Outcome reconcile(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured,
                                const Settings& settings, const Observer& observer = {});

}  // namespace pirsim::reconcile
