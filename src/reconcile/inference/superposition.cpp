#include "reconcile/inference/superposition.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/parallel.hpp"
#include "stats/class_shapes.hpp"
#include "stats/conformal.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::size_t fewest_pairs = 60;  ///< superposed datasets: two thirds of fewer have no shape (assumed)

using RowIn = std::map<std::uint32_t, std::size_t>;  ///< realization -> row of the table

std::vector<RowIn> rows_by_realization(const ReferenceTable& table) {
  std::vector<RowIn> rows(table.n_hypotheses());
  for (std::size_t i = 0; i < table.rows.size(); ++i) rows[table.rows[i].hypothesis][table.rows[i].realization] = i;
  return rows;
}

stats::Matrix<float> superposed(const stats::Matrix<float>& features, const RowIn& plain, const RowIn& first,
                                const RowIn& second) {
  stats::Matrix<float> sums;
  for (const auto& [realization, row] : first) {
    const auto other = second.find(realization), none = plain.find(realization);
    if (other == second.end() || none == plain.end()) continue;
    std::vector<float> sum(features.columns());
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] = features(row, i) + features(other->second, i) - features(none->second, i);
    sums.append_row(std::span<const float>(sum));
  }
  return sums;
}

/// How strange the data are among the rows, by the strangest block: p of two thirds of them against the others.
double p_among(const stats::Matrix<float>& rows, std::span<const float> data,
               const std::vector<std::vector<std::size_t>>& blocks, std::uint64_t seed) {
  std::vector<std::size_t> fitting, calibration;
  for (std::size_t i = 0; i < rows.rows(); ++i) (i % 3 == 0 ? calibration : fitting).push_back(i);
  stats::Matrix<double> known(calibration.size(), blocks.size());
  std::vector<double> own;
  const std::vector<int> one_class(fitting.size(), 0);
  stats::Matrix<float> wanted;
  wanted.append_row(data);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const stats::Matrix<float> block = rows.select_columns(blocks[b]);
    const auto shape = stats::ClassShapes::fit(block.select_rows(fitting), one_class, 1, {.seed = seed, .threads = 1});
    for (std::size_t i = 0; i < calibration.size(); ++i)
      known(i, b) = std::cbrt(shape.strangeness(block.row(calibration[i]), 0));
    own.push_back(std::cbrt(shape.strangeness(wanted.select_columns(blocks[b]).row(0), 0)));
  }
  return stats::StrangestMeasure(known).p(own);
}

}  // namespace

std::vector<Partner> partners_of(const TableView& view, std::size_t first, std::span<const float> measured,
                                 double level, const Context& context) {
  const ReferenceTable& table = view.table();
  const std::vector<RowIn> rows = rows_by_realization(table);
  const std::vector<float> data = view.map().features(measured);
  std::vector<Partner> partners;
  std::size_t second = 0;
  ordered_parallel<double>(
      table.n_hypotheses() - 1, context.threads,
      [&](std::size_t i) {
        if (i + 1 == first) return 0.0;
        const stats::Matrix<float> pairs = superposed(view.features(), rows[0], rows[first], rows[i + 1]);
        // Too few to tell: not ruled out, but after all that are compared.
        if (pairs.rows() < fewest_pairs) return std::nextafter(level, 1.0);
        return p_among(pairs, data, view.map().blocks(), context.seed);
      },
      [&](double& p) {
        ++second;
        if (p > level) partners.push_back({table.hypothesis_name(second), p});
      });
  std::ranges::stable_sort(partners, std::ranges::greater{}, &Partner::p);
  return partners;
}

}  // namespace pirsim::reconcile
