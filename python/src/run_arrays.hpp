// Rows of many runs as arrays [run, window, sensor].
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <map>
#include <pirsim/columns.hpp>
#include <pirsim/pirsim.hpp>
#include <string>
#include <vector>

namespace pirsim::python {

/// Takes results in order, without the GIL; to_dict() gives the arrays, with it.
class RunArrays {
 public:
  /// n_areas: of Model::areas().
  RunArrays(std::size_t n_sensors, std::size_t n_areas, std::size_t n_doors);

  void add(const RunResult& result);
  /// Runs differ in length: arrays are as long as the longest, zeros behind the end of a run, where `valid` is false.
  [[nodiscard]] nanobind::dict to_dict() &&;

 private:
  struct Rows {
    std::vector<std::uint8_t> bits;   ///< (n_windows x n_sensors)
    std::vector<std::uint8_t> doors;  ///< (n_windows x n_doors)
    std::vector<std::uint16_t> people, phase;
    std::vector<std::uint16_t> people_of_areas;  ///< (n_windows x n_areas)
    std::vector<std::int64_t> clock;             ///< seconds since 1970; empty without a clock
  };
  struct Fault {
    std::uint32_t run = 0;
    RunFault fault;
  };
  struct Incident {
    std::uint32_t run = 0;
    RunIncident incident;
  };
  /// A column of the command line's table, of all runs together.
  struct TableColumn {
    const Column<OccupantLine>* column;
    std::vector<double> numbers;
    std::vector<std::uint16_t> texts;  ///< by number
  };
  struct Signals {
    std::vector<std::uint32_t> run;
    std::vector<std::int64_t> tick;
    std::vector<std::uint16_t> sensor, zone, person, part;
    std::vector<double> power_w, signal_v, share_v;
    std::vector<std::uint8_t> output;
  };
  /// Texts by number, in the order in which they are met; the first is the empty one.
  class Words {
   public:
    [[nodiscard]] std::uint16_t number(std::string_view text);
    [[nodiscard]] nanobind::tuple all() const;

   private:
    std::map<std::string, std::uint16_t, std::less<>> numbers_{{"", 0}};
    std::vector<std::string> texts_{""};
  };

  void add_occupants(const RunResult& result);
  void add_signals(const RunResult& result);
  void add_zones(const RunResult& result);
  [[nodiscard]] nanobind::dict occupants();
  [[nodiscard]] nanobind::dict signals();
  [[nodiscard]] nanobind::list zones();
  void add_rows(nanobind::dict& arrays);

  std::size_t n_sensors_, n_areas_, n_doors_;
  std::size_t n_windows_ = 0;  ///< of the longest run
  bool has_clock_ = false;
  std::vector<double> time_s_;
  std::vector<Rows> rows_;
  std::vector<std::uint32_t> run_;
  std::vector<std::int32_t> replicate_;
  std::vector<std::string> trial_;
  std::vector<Fault> faults_;
  std::vector<Incident> incidents_;
  Words phases_, texts_;
  std::vector<std::uint32_t> occupant_run_;
  std::vector<TableColumn> occupants_;
  Signals signals_;
  struct Zones {
    std::size_t n_ticks = 0;
    std::vector<std::uint8_t> active;  ///< (n_ticks x n_zones)
  };
  std::vector<Zones> zones_;
};

}  // namespace pirsim::python
