// Effect after effect, until the model with them can have made the data.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reconcile/inference/analyst.hpp"
#include "reconcile/inference/model_check.hpp"
#include "reconcile/inference/reference_study.hpp"

namespace pirsim::reconcile {

/// One reconciliation in the making.
class Loop {
 public:
  Loop(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured, const Settings& settings,
       const Context& context)
      : scene_(scene), script_(script), measured_(measured), settings_(settings), context_(context) {}
  [[nodiscard]] Outcome run();

 private:
  /// A look at the data with the table of one model.
  struct Step {
    ReferenceStudy reference;
    std::shared_ptr<const TableView> view;  ///< of the reference's table, in the trials that are looked at
    std::vector<DataNote> notes;            ///< what was done with which measured rows
    std::vector<DataFinding> findings;      ///< what is wrong with them; of the first look
    std::vector<float> observed;            ///< statistics of the measured data
    Outcome outcome;
    SeenRows seen;
    std::size_t likeliest = 0;            ///< hypothesis
    FittedEffect best;                    ///< of that hypothesis
    std::vector<FittedEffect> relatives;  ///< of the effect named: what it may be taken for
  };
  const Step& look(const Settings& settings, double level);
  bool look_beyond(RangeEnd& end);  ///< true if a strength there passes: it is applied
  void apply_first();               ///< stronger than was looked for if only that does
  /// A name that a relative would do twice as well without is one of the two.
  void compare_relatives();
  void take_look();  ///< with all that has been applied
  void apply_more();
  /// With all that was applied; none if no effect may explain the rest, or people can hardly get about in that model.
  const Step* look_for_more(double level);
  /// Effects that are worth a table beside those that were applied: beside one, those that the first table doesn't rule
  /// out as its partner; beside more, all that were asked for.
  [[nodiscard]] std::optional<std::vector<std::string>> worth_a_table(double level) const;
  void tell_first(const Step& first);
  void tell(TrailEvent event) { outcome_.trail.push_back(std::move(event)); }
  void conclude();
  [[nodiscard]] bool is_nearest() const;  ///< the one effect applied comes near enough to be told as such
  void take_back();                       ///< the one name that was given
  void explain();
  void explain_rest();
  void verify_effects();
  /// p of the global test of the model with all that has been applied, its data simulated anew.
  [[nodiscard]] GlobalP p_with_all(double level) const;
  [[nodiscard]] Settings with_all(double level, std::vector<std::string> effects) const;
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] std::vector<EffectSpec> patch() const;
  [[nodiscard]] std::vector<std::size_t> training_trials() const;

  const SceneSpec& scene_;
  const ScriptSpec& script_;
  const Measured& measured_;
  const Settings& settings_;
  const Context& context_;
  std::deque<Step> steps_;             ///< addresses stay
  std::vector<FittedEffect> applied_;  ///< one of each step
  bool passes_ = false;                ///< the model with all of them can have made the data
  std::optional<Verdict> rest_;        ///< of the last look for more, where one was needed
  Outcome outcome_;
};

}  // namespace pirsim::reconcile
