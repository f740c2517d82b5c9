#include "reconcile/inference/table_view.hpp"

#include <utility>

#include "core/parallel.hpp"
#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {

TableView::TableView(const SceneSpec& scene, const StudyFrame& frame, const std::vector<CellKnowledge>& knowledge,
                     const ReferenceTable& table, std::vector<std::size_t> trials, unsigned threads)
    : scene_(scene),
      frame_(frame),
      table_(table),
      map_(frame, knowledge, table.statistics.select_rows(rows_of(table, 0, Part::training)), std::move(trials)),
      features_(map_.features(table.statistics, threads)),
      plain_(table.statistics.select_rows(rows_of(table, 0, Part::all))),
      plain_reference_(tested_features(map_, features_.select_rows(rows_of(table, 0, Part::all)))),
      p_of_rows_(table.rows.size(), 1.0) {
  std::vector<std::size_t> rows;
  for (std::size_t hypothesis = 1; hypothesis < table.n_hypotheses(); ++hypothesis) {
    const std::vector<std::size_t> own = rows_of(table, hypothesis, Part::calibration);
    rows.insert(rows.end(), own.begin(), own.end());
  }
  std::size_t next = 0;
  ordered_parallel<double>(
      rows.size(), threads,
      [&](std::size_t i) { return plain_reference_.p(tested_features(map_, features_.row(rows[i]))); },
      [&](double& p) { p_of_rows_[rows[next++]] = p; });
}

double TableView::p(std::span<const float> statistics) const {
  return plain_reference_.p(tested_statistics(map_, statistics));
}

}  // namespace pirsim::reconcile
