// How much alike two sensors of a log are. Private to io.
#pragma once

#include "pirsim/log_facts.hpp"

namespace pirsim::io {

/// Sets the pairs of facts and the length of their windows.
void add_pairs(const Log& log, LogFacts& facts);

}  // namespace pirsim::io
