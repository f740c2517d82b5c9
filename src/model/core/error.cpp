#include "model/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "model/core/text.hpp"
#include "pirsim/error.hpp"

namespace pirsim {
namespace {

std::string join(const std::vector<Issue>& issues) {
  std::string text;
  for (const Issue& issue : issues) {
    if (!text.empty()) text += '\n';
    text += to_string(issue);
  }
  return text;
}

std::vector<Issue> only(Issue issue) {
  std::vector<Issue> issues;
  issues.push_back(std::move(issue));
  return issues;
}

std::vector<Issue> of_severity(const std::vector<Issue>& issues, Severity severity) {
  std::vector<Issue> result;
  std::copy_if(issues.begin(), issues.end(), std::back_inserter(result),
               [&](const Issue& issue) { return issue.severity == severity; });
  return result;
}

/// A list of near_or_all() is told with the first fault that ends in it.
void leave_out_told_list(const std::vector<Issue>& issues, std::string& message) {
  const std::size_t begin = message.rfind(begin_of_list);
  if (begin == std::string::npos) return;
  const std::string list = message.substr(begin);
  if (std::ranges::any_of(issues, [&](const Issue& told) { return told.message.ends_with(list); }))
    message.erase(begin);
}

/// Nothing twice; a file made to annoy has millions of faults, which nobody reads.
void add(std::vector<Issue>& issues, Issue issue) {
  constexpr std::ptrdiff_t most = 100;
  const auto told =
      std::count_if(issues.begin(), issues.end(), [&](const Issue& other) { return other.severity == issue.severity; });
  if (told > most) return;
  const auto is_told = [&](const Issue& other) {
    return other.severity == issue.severity && other.where == issue.where && other.message == issue.message;
  };
  if (std::any_of(issues.begin(), issues.end(), is_told)) return;
  leave_out_told_list(issues, issue.message);
  if (std::any_of(issues.begin(), issues.end(), is_told)) return;
  if (told == most) {
    issue.where.line = issue.where.column = 0;
    issue.message = "there are more like these";
  }
  issues.push_back(std::move(issue));
}

/// Levenshtein distance, letters compared without case.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row.back();
}

/// The only candidate that goes on after the name with an underscore, as `yaw_deg` after `yaw`; null if there are more.
const std::string* whole_of(std::string_view name, const std::vector<std::string>& candidates) {
  const auto goes_on = [&](const std::string& candidate) {
    return candidate.size() > name.size() && candidate[name.size()] == '_' &&
           edit_distance(name, candidate.substr(0, name.size())) == 0;
  };
  const auto first = std::ranges::find_if(candidates, goes_on);
  if (name.empty() || first == candidates.end()) return nullptr;
  const bool is_only = std::find_if(first + 1, candidates.end(), goes_on) == candidates.end();
  return is_only ? &*first : nullptr;
}

}  // namespace

std::string to_string(const Issue& issue) {
  constexpr std::size_t longest_place = 4096;  // as paths; `--set KEY=VALUE` is a place, too
  std::string text;
  if (!issue.where.file.empty()) {
    text += tellable(issue.where.file.size() > longest_place ? shortened(issue.where.file) : issue.where.file) + ':';
    if (issue.where.line > 0) text += std::to_string(issue.where.line) + ':';
    if (issue.where.line > 0 && issue.where.column > 0) text += std::to_string(issue.where.column) + ':';
    text += ' ';
  }
  return text + (issue.severity == Severity::error ? "error: " : "warning: ") + tellable(issue.message);
}

Error::Error(ErrorCode code, std::vector<Issue> issues)
    : std::runtime_error(join(issues)), code_(code), issues_(std::move(issues)) {}
Error::Error(ErrorCode code, Where where, std::string message)
    : Error(code, only(Issue{Severity::error, std::move(where), std::move(message)})) {}
Error::Error(ErrorCode code, std::string message) : Error(code, Where{}, std::move(message)) {}

void Diagnostics::error(Where where, std::string message) {
  add(issues_, {Severity::error, std::move(where), std::move(message)});
}
void Diagnostics::warning(Where where, std::string message) {
  add(issues_, {Severity::warning, std::move(where), std::move(message)});
}
void Diagnostics::throw_if_errors(ErrorCode code) const {
  if (has_errors()) throw Error(code, of_severity(issues_, Severity::error));
}
bool Diagnostics::has_errors() const noexcept {
  return std::any_of(issues_.begin(), issues_.end(), [](const Issue& i) { return i.severity == Severity::error; });
}
std::vector<Issue> Diagnostics::warnings() const { return of_severity(issues_, Severity::warning); }

std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 100;  // no name that anybody means; and the time grows with the product of lengths
  if (name.size() > longest) return {};
  if (const std::string* whole = whole_of(name, candidates)) return " (did you mean '" + *whole + "'?)";
  std::size_t best = std::numeric_limits<std::size_t>::max();
  const std::string* nearest = nullptr;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > longest) continue;
    if (const std::size_t distance = edit_distance(name, candidate); distance < best) {
      best = distance;
      nearest = &candidate;
    }
  }
  const std::size_t limit = std::max<std::size_t>(1, name.size() / 3 + 1);
  const bool something_in_common = nearest != nullptr && best < std::max(name.size(), nearest->size());
  if (!something_in_common || best > limit) return {};
  return " (did you mean '" + *nearest + "'?)";
}

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
