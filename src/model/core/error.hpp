// Warnings of which one input may bring in thousands.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/error.hpp"

namespace pirsim {

/// Keeps of each kind the first warning in full, the names of some more, and how many there are.
class GroupedWarnings {
 public:
  /// kind: what such warnings have in common, shown to nobody; name: of what the warning tells, "seat 'S1'".
  void add(std::string_view kind, Where where, std::string name, std::string message);
  /// Adds one warning a kind, in the order of their first ones: "... (and 97 more: seat 'S2', seat 'S3', ...)".
  void tell(Diagnostics& remarks) const;

 private:
  struct Group {
    std::string kind;
    Where where;
    std::string message;
    std::vector<std::string> others;  ///< the first names after the first warning's
    std::size_t n_more = 0;
  };
  std::vector<Group> groups_;
};

}  // namespace pirsim
