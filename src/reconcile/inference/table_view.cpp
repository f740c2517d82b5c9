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
      threads_(threads),
      plain_(table.statistics.select_rows(rows_of(table, 0, Part::all))),
      plain_reference_(tested_features(map_, map_.features(plain_, threads))) {}

const TableView::Rows& TableView::rows() const {
  std::call_once(rows_known_, [this] {
    rows_.features = map_.features(table_.statistics, threads_);
    rows_.p.assign(table_.rows.size(), 1.0);
    std::vector<std::size_t> seen;
    for (std::size_t hypothesis = 1; hypothesis < table_.n_hypotheses(); ++hypothesis) {
      const std::vector<std::size_t> own = rows_of(table_, hypothesis, Part::calibration);
      seen.insert(seen.end(), own.begin(), own.end());
    }
    std::size_t next = 0;
    ordered_parallel<double>(
        seen.size(), threads_,
        [&](std::size_t i) { return plain_reference_.p(tested_features(map_, rows_.features.row(seen[i]))); },
        [&](double& p) { rows_.p[seen[next++]] = p; });
  });
  return rows_;
}

double TableView::p(std::span<const float> statistics) const {
  return plain_reference_.p(tested_statistics(map_, statistics));
}

}  // namespace pirsim::reconcile
