// What lights do, row by row.
#pragma once

#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "files/disk/compression.hpp"
#include "files/disk/file.hpp"
#include "pirsim/control.hpp"
#include "show/report.hpp"

namespace pirsim::control {

/// A row a row, in a file: each light, and the people of its area. Throws Error(io).
class LitTable {
 public:
  LitTable(const std::filesystem::path& file, const RuleSpec& rule);
  void add(const Sample& row, const LitRow& lit);
  /// Puts the file in its place.
  void finish();

 private:
  void flush();

  io::AtomicFile file_;
  io::DataWriter data_;
  std::ostringstream text_;
};

// The page about light: curves over the delay, when it is lit, the worst moments.

/// When each light is lit and how many people are there, of the first days.
class LitDays {
 public:
  explicit LitDays(const RuleSpec& rule, double window_s);
  void add(const Sample& row, const LitRow& lit);
  [[nodiscard]] io::DaysChart chart() const;

 private:
  struct Bin {
    double lit = 0.0, known = 0.0;  ///< seconds
    std::int32_t people = -1;       ///< the most; -1: not known
  };
  using Key = std::tuple<int, std::string, std::int64_t>;  ///< replicate, trial, and the day since 1970 or of the run
  static constexpr double bin_s = 120.0;
  static constexpr std::size_t n_bins = 720, most_days = 14;
  std::vector<std::string> names_;
  double window_s_;
  std::vector<std::pair<Key, std::vector<Bin>>> days_;  ///< (n_bins x n_lights)
  bool has_clock_ = false, knows_people_ = false;
};

/// view: words of a command that makes a page of a moment, "pirsim view --scene room.gltf --script week.yaml"; or no
/// text.
[[nodiscard]] io::Report control_page(const Costs& costs, const LitDays& days, const std::string& view);
/// The figures of the rule's delays in a few lines, for a terminal.
[[nodiscard]] std::string to_text(const Costs& costs);

}  // namespace pirsim::control
