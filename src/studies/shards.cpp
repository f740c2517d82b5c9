#include "studies/campaign.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <iomanip>
#include <sstream>

#include "pirsim/error.hpp"

namespace pirsim::studies {
namespace {

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::usage, "--shard: " + message); }

std::optional<std::uint32_t> whole_number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  return fault == std::errc{} && end == text.data() + text.size() && !text.empty() ? std::optional(value)
                                                                                   : std::nullopt;
}

std::uint32_t variable(const Environment& environment, const char* name) {
  const std::optional<std::string> text = environment(name);
  if (!text) refuse(std::string(name) + " isn't set; use --shard auto/N");
  const std::optional<std::uint32_t> value = whole_number(*text);
  if (!value) refuse(std::string(name) + ": expected a whole number, got '" + *text + "'");
  return *value;
}

/// A task of a job array, and the array as far as its manager tells.
struct Task {
  const char* variable;  ///< where its number stands
  std::uint32_t id = 0;
  struct Array {
    std::uint32_t first = 0, last = 0, step = 1;
    std::uint32_t count = 0;  ///< of tasks
  };
  std::function<Array()> array;
};

Task find_task(const Environment& environment) {
  if (environment("SLURM_ARRAY_TASK_ID")) {
    return {"SLURM_ARRAY_TASK_ID", variable(environment, "SLURM_ARRAY_TASK_ID"), [&environment] {
              return Task::Array{
                  variable(environment, "SLURM_ARRAY_TASK_MIN"), variable(environment, "SLURM_ARRAY_TASK_MAX"),
                  variable(environment, "SLURM_ARRAY_TASK_STEP"), variable(environment, "SLURM_ARRAY_TASK_COUNT")};
            }};
  }
  if (const auto id = environment("SGE_TASK_ID"); id && *id != "undefined") {  // so it is outside of an array
    return {"SGE_TASK_ID", variable(environment, "SGE_TASK_ID"), [&environment] {
              Task::Array array{variable(environment, "SGE_TASK_FIRST"), variable(environment, "SGE_TASK_LAST"),
                                variable(environment, "SGE_TASK_STEPSIZE"), 0};
              if (array.step > 0 && array.last >= array.first)
                array.count = (array.last - array.first) / array.step + 1;
              return array;
            }};
  }
  for (const char* name : {"PBS_ARRAY_INDEX", "PBS_ARRAYID"}) {
    if (!environment(name)) continue;
    return {name, variable(environment, name),
            []() -> Task::Array { refuse("PBS doesn't tell a task how many tasks there are; use --shard auto/N"); }};
  }
  refuse(
      "'auto' takes its number from a job array of Slurm (SLURM_ARRAY_TASK_ID), SGE (SGE_TASK_ID) or PBS "
      "(PBS_ARRAY_INDEX), and none of these variables is set; outside of an array use --shard I/N");
}

Shard shard_in_whole_array(const Task& task) {
  const Task::Array array = task.array();
  const std::string id = task.variable + (" = " + std::to_string(task.id));
  const bool is_even = array.step > 0 && array.last >= array.first && array.count > 0 &&
                       (array.last - array.first) / array.step + 1 == array.count &&
                       (array.last - array.first) % array.step == 0;
  if (!is_even) {
    refuse("the numbers of this array aren't evenly spaced (" + std::to_string(array.count) + " from " +
           std::to_string(array.first) + " to " + std::to_string(array.last) +
           "), so the shard can't be determined; number the tasks 1 to N and use --shard auto/N");
  }
  if (task.id < array.first || task.id > array.last || (task.id - array.first) % array.step != 0) {
    refuse(id + " is not a task of its array");
  }
  return {(task.id - array.first) / array.step + 1, array.count};
}

}  // namespace

std::optional<std::string> process_environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? std::optional<std::string>(value) : std::nullopt;
}

Shard parse_shard(std::string_view text, const Environment& environment) {
  if (text == "auto") return shard_in_whole_array(find_task(environment));
  const std::size_t slash = std::min(text.find('/'), text.size());
  const std::string_view index = text.substr(0, slash);
  const auto count = whole_number(text.substr(std::min(slash + 1, text.size())));
  const auto number = index == "auto" ? std::optional(find_task(environment).id) : whole_number(index);
  if (!number || !count) refuse("expected I/N, auto/N or auto, got '" + std::string(text) + "'");
  if (*number < 1 || *number > *count) {
    refuse("there is no shard " + std::to_string(*number) + " of " + std::to_string(*count) +
           "; they are numbered 1 to N");
  }
  return {*number, *count};
}

std::string shard_name(const Shard& shard) {
  std::ostringstream name;
  name << std::setfill('0') << "shard-" << std::setw(4) << shard.index << "-of-" << std::setw(4) << shard.count;
  return name.str();
}

std::optional<Shard> shard_of(std::string_view file_name) {
  if (!file_name.starts_with("shard-")) return std::nullopt;
  const std::size_t of = file_name.find("-of-");
  if (of == std::string_view::npos) return std::nullopt;
  const auto index = whole_number(file_name.substr(6, of - 6));
  const auto count = whole_number(file_name.substr(of + 4, file_name.find('.') - of - 4));
  if (!index || !count || *index < 1 || *index > *count) return std::nullopt;
  const Shard shard{*index, *count};
  return file_name.starts_with(shard_name(shard)) ? std::optional(shard) : std::nullopt;
}

}  // namespace pirsim::studies
