// A study with the reference table that its data are compared with.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "reconcile/ensemble/reference_table.hpp"
#include "reconcile/inference/table_view.hpp"

namespace pirsim::reconcile {

/// For one shape of data.
struct ReferenceStudy {
  RealizationSource source;
  StudyFrame frame;
  std::vector<CellKnowledge> knowledge;
  DataShape shape;
  ReferenceTable table;
  std::string key;  ///< of the table

  /// What the plain model's training datasets say of these trials (sorted).
  [[nodiscard]] FeatureMap map(std::vector<std::size_t> trials) const;
  /// The table as it looks in these trials (sorted); must not outlive the study.
  [[nodiscard]] std::shared_ptr<const TableView> view(std::vector<std::size_t> trials, unsigned threads) const;
};
[[nodiscard]] ReferenceStudy make_reference_study(
    const SceneSpec& scene, const ScriptSpec& script, const Settings& settings,
    const std::function<DataShape(const StudyFrame&, std::span<const Series> pilot)>& shape_of_data,
    const Context& context = {});

}  // namespace pirsim::reconcile
