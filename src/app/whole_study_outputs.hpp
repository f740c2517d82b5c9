// The outputs of a study that need all runs at once.
#pragma once

#include <memory>

#include "app/study_run.hpp"
#include "pirsim/study.hpp"

namespace pirsim::app {

[[nodiscard]] bool has_whole_study_outputs(const RunOptions& options);

/// Nothing of them is left if the study ends early.
class WholeStudyOutputs {
 public:
  WholeStudyOutputs(const Model& model, const Inputs& inputs, const RunOptions& options);
  ~WholeStudyOutputs();
  void add(const RunResult& result);
  void commit();
  /// What they need of every run.
  [[nodiscard]] Occupants occupants() const noexcept;

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

}  // namespace pirsim::app
