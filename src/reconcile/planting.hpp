// Datasets in which something is hidden, made to see whether it is found. Private to reconcile.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pirsim/reconcile/reconcile.hpp"
#include "pirsim/reconcile/selftest.hpp"
#include "reconcile/table_store.hpp"

namespace pirsim::reconcile {

struct Planted {
  CaseKind kind = CaseKind::nothing;
  Strength strength = Strength::none;
  std::string alien;                ///< name; empty without one
  std::vector<EffectSpec> effects;  ///< as drawn
  std::vector<float> statistics;    ///< (n_statistics)

  [[nodiscard]] std::string truth() const;  ///< effects and alien in words; "nothing"
};

/// Simulates them all, in worlds that no table has seen; those in which people can't get about are missing.
[[nodiscard]] std::vector<Planted> plant(const Laboratory& lab, const SelftestSettings& settings,
                                         const TableProgress& progress);

}  // namespace pirsim::reconcile
