#include "core/grouped_warnings.hpp"

#include <algorithm>
#include <utility>

namespace pirsim {
namespace {

constexpr std::size_t most_named = 3;  // a reader looks at the first, and mends all in the same way

}  // namespace

void GroupedWarnings::add(std::string_view kind, Where where, std::string name, std::string message) {
  const auto known = std::ranges::find(groups_, kind, &Group::kind);
  if (known == groups_.end()) {
    groups_.push_back({std::string(kind), std::move(where), std::move(message), {}, 0});
    return;
  }
  ++known->n_more;
  if (known->others.size() < most_named) known->others.push_back(std::move(name));
}

void GroupedWarnings::tell(Diagnostics& remarks) const {
  for (const Group& group : groups_) {
    std::string message = group.message;
    if (group.n_more > 0) {
      message += " (and " + std::to_string(group.n_more) + " more: ";
      for (std::size_t i = 0; i < group.others.size(); ++i) message += (i == 0 ? "" : ", ") + group.others[i];
      message += group.n_more > group.others.size() ? ", ...)" : ")";
    }
    remarks.warning(group.where, message);
  }
}

}  // namespace pirsim
