// What a reconciliation leaves behind, as files; the formats are described in docs/formats/reconcile.md.
#pragma once

#include <string>

#include "pirsim/reconcile.hpp"

namespace pirsim::reconcile {

[[nodiscard]] std::string to_json(const Outcome& outcome, const Measured& measured, const Settings& settings,
                                  const Context& context, const Provenance& provenance);
[[nodiscard]] std::string where_csv(const Outcome& outcome);
[[nodiscard]] std::string candidates_csv(const Outcome& outcome);

}  // namespace pirsim::reconcile
