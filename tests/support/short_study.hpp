// Study A cut short: few seats, little work, so that many datasets cost seconds.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "support/shipped.hpp"

namespace pirsim::test {

inline ScriptSpec short_study(const std::vector<std::string>& seats, double work_s) {
  ScriptSpec script = shipped_script("studyA.yaml");
  script.replicates = 1;
  std::erase_if(script.trials, [&](const TrialSpec& t) { return std::ranges::find(seats, t.id) == seats.end(); });
  for (TrialSpec& trial : script.trials) {
    for (ScriptedAction& action : trial.people.front().actions) {
      if (auto* work = std::get_if<action::Work>(&action.what)) work->duration_s = work_s;
    }
  }
  return script;
}

}  // namespace pirsim::test
