// What is odd or wrong in a log, a kind once. Private to io.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/error.hpp"

namespace pirsim::io {

/// Of one severity. Logs have the same oddity a million times: the first is told, with how many more there are.
class LogRemarks {
 public:
  /// `kind` is what they have in common; message() and where() are asked for the first one alone.
  template <typename GiveWhere, typename GiveMessage>
  void add(std::string_view kind, GiveWhere where, GiveMessage message) {
    ++n_;
    for (Kind& known : kinds_) {
      if (known.name == kind) {
        ++known.n;
        return;
      }
    }
    kinds_.push_back({std::string(kind), where(), message(), 1});
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return n_; }
  [[nodiscard]] std::vector<Issue> issues(Severity severity) const {
    std::vector<Issue> issues;
    for (const Kind& kind : kinds_) {
      const std::string more = kind.n == 1 ? "" : "; " + std::to_string(kind.n - 1) + " more like this";
      issues.push_back({severity, kind.where, kind.message + more});
    }
    return issues;
  }

 private:
  struct Kind {
    std::string name;
    Where where;
    std::string message;
    std::uint64_t n;
  };
  std::vector<Kind> kinds_;
  std::uint64_t n_ = 0;
};

}  // namespace pirsim::io
