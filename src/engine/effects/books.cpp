#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "engine/effects/kit.hpp"

// What happens to rows after they were logged, and to counts of people before a study.
// Assumed: whole rows or columns, whatever they hold; counts that are off by one.
// Method: stages that change finished rows; counts of the study in force. Sources: no measurement.

namespace pirsim::effects {
namespace {

/// What a log shows of a sensor some of whose telegrams are lost. A sensor that holds its motion sends one when it goes
/// on and one when it goes off: what is lost leaves the log as it was until the next. Any other is asked in every
/// window.
class Telegrams {
 public:
  Telegrams(std::uint32_t sensor, const StageContext& context) {
    const auto model = context.scene.sensor_models.find(context.scene.sensors[sensor].model);
    holds_ = model != context.scene.sensor_models.end() && model->second.detector.report.hold_s > 0.0;
  }
  void begin_run() noexcept { sent_ = shown_ = 0; }
  /// Whether there is a telegram for others to disturb.
  [[nodiscard]] bool sends(std::uint8_t bit) const noexcept { return holds_ ? bit != sent_ : bit == 1; }
  /// The row's bit after a window whose telegram, if there was any, was lost.
  [[nodiscard]] std::uint8_t after(std::uint8_t bit, bool is_lost) noexcept {
    if (!holds_) return is_lost ? 0 : bit;
    if (sends(bit) && !is_lost) shown_ = bit;
    sent_ = bit;
    return shown_;
  }

 private:
  bool holds_ = false;
  std::uint8_t sent_ = 0, shown_ = 0;
};

std::vector<Telegrams> telegrams_of(const std::vector<std::uint32_t>& sensors, const StageContext& context) {
  std::vector<Telegrams> telegrams;
  for (const std::uint32_t sensor : sensors) telegrams.emplace_back(sensor, context);
  return telegrams;
}

// dead_sensor: a sensor that says nothing any more, or less and less.

/// Loses each telegram with one probability from a moment of the run on.
class DeadSensor final : public CloneableRowStage<DeadSensor> {
 public:
  DeadSensor(std::vector<std::uint32_t> sensors, std::vector<Telegrams> telegrams, double loss, double from_s)
      : sensors_(std::move(sensors)), telegrams_(std::move(telegrams)), loss_(loss), from_s_(from_s) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    streams_ = streams_of(sensors_, seed, run, Purpose::dead_sensor);
    for (Telegrams& telegrams : telegrams_) telegrams.begin_run();
  }

  void apply(Sample& row) noexcept override {
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      const bool lost = streams_[i].uniform() < loss_;
      std::uint8_t& bit = row.bits[sensors_[i]];
      bit = telegrams_[i].after(bit, lost && row.time_s > from_s_);
    }
  }

 private:
  std::vector<std::uint32_t> sensors_;
  std::vector<Telegrams> telegrams_;  ///< (n of sensors_)
  double loss_;
  double from_s_;
  std::vector<Stream> streams_;
};

std::unique_ptr<RowStage> make_dead_sensor(const EffectSpec& effect, const StageContext& context) {
  const std::vector<std::uint32_t> sensors = sensors_of(effect, context.scene);
  return std::make_unique<DeadSensor>(sensors, telegrams_of(sensors, context), effect.parameters.at("loss"),
                                      effect.parameters.at("from_s"));
}

void draw_dead_sensor(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  effect.choices["sensor"] = scene.sensors[stream.index(static_cast<std::uint32_t>(scene.sensors.size()))].id;
}

Effect dead_sensor() {
  return {.info = {.name = "dead_sensor",
                   .family = Family::data,
                   .stage = "books",
                   .summary = "From a moment of the run on, all of a sensor's telegrams are lost (dead), or a share of "
                              "them (dying, or a bad radio).",
                   .fingerprint = "one column is empty or thinned, the others fit",
                   .as_if = "rows of a sensor were lost",
                   .confused_with = {"missed_triggers"},
                   .parameters = {told_as("share of rows lost", strength("loss", "", 1.0, 0.5, 1.0, 1.0, "assumed")),
                                  detail("from_s", "s", 0.0, 0.0, 120.0, 0.0, 1e7, "assumed")},
                   .choices = {sensor_choice()},
                   .reach = Reach::rows,
                   .idle_in = {Survey::walk_test}},
          .make_row_stage = make_dead_sensor,
          .draw = draw_dead_sensor};
}

// labels_swapped: two sensors' columns are swapped.

class SwapColumns final : public CloneableRowStage<SwapColumns> {
 public:
  SwapColumns(std::size_t a, std::size_t b) : a_(a), b_(b) {}
  void begin_run(std::uint64_t, std::uint32_t) override {}
  void apply(Sample& row) noexcept override { std::swap(row.bits[a_], row.bits[b_]); }

 private:
  std::size_t a_, b_;
};

std::size_t sensor_index(const EffectSpec& effect, const std::string& choice, std::size_t otherwise,
                         const SceneSpec& scene) {
  const auto named = effect.choices.find(choice);
  if (named == effect.choices.end()) return std::min(otherwise, scene.sensors.size() - 1);
  const auto sensor = std::ranges::find(scene.sensors, named->second, &SensorSpec::id);
  return static_cast<std::size_t>(sensor - scene.sensors.begin());
}

std::unique_ptr<RowStage> make_labels_swapped(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<SwapColumns>(sensor_index(effect, "sensor", 0, context.scene),
                                       sensor_index(effect, "other", 1, context.scene));
}

/// In a room with one sensor there is no other to name.
std::string fault_labels_swapped(const EffectSpec& effect, const SceneSpec& scene) {
  const std::size_t n = scene.sensors.size(), a = sensor_index(effect, "sensor", 0, scene);
  if (n < 2 || a >= n || a != sensor_index(effect, "other", 1, scene)) return "";
  return "sensor and other are both '" + scene.sensors[a].id + "': nothing would be swapped";
}

void draw_labels_swapped(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  const auto n = static_cast<std::uint32_t>(scene.sensors.size());
  const std::uint32_t a = stream.index(n);
  const std::uint32_t b = (a + 1 + stream.index(std::max(1U, n - 1))) % n;
  effect.choices["sensor"] = scene.sensors[a].id;
  effect.choices["other"] = scene.sensors[b].id;
}

Effect labels_swapped() {
  return {.info = {.name = "labels_swapped",
                   .family = Family::data,
                   .stage = "books",
                   .summary = "The columns of two sensors are swapped.",
                   .fingerprint = "two columns of the table of sums are permuted, everything else fits",
                   .as_if = "two sensors' labels were swapped",
                   .confused_with = {"mirrored_room"},
                   .parameters = {whether("swapped", "assumed: any two sensors")},
                   .choices = {{"sensor", ChoiceKind::sensor, {}, "the first sensor"},
                               {"other", ChoiceKind::sensor, {}, "the second sensor"}},
                   .reach = Reach::rows,
                   .idle_in = {Survey::walk_test}},
          .make_row_stage = make_labels_swapped,
          .draw = draw_labels_swapped,
          .fault = fault_labels_swapped};
}

// people_miscounted: for a while one person more, or one fewer, was there than an occupancy's counts say.

/// Whoever comes in addition is a person of their own.
void add_occupants(const StudyInForce& study, TrialInForce& trial) {
  const std::vector<int>& people = trial.occupancy->counts.people;
  const auto is_occupant = [](const PersonInForce& person) {
    return person.part && person.part->part == SchedulePart::occupant;
  };
  const auto most = people.empty() ? 0 : *std::ranges::max_element(people);
  auto n = std::ranges::count_if(trial.people, is_occupant);
  const auto known = std::ranges::find_if(trial.people, is_occupant);
  const MotionStyle style = known == trial.people.end() ? MotionStyle::natural : known->style;
  for (; n < most; ++n) {
    const PersonSpec body =
        drawn_body("occupant_" + std::to_string(n + 1), style, study.seed, static_cast<std::uint32_t>(n));
    trial.people.push_back({body, {}, ScheduledPerson{SchedulePart::occupant, pirsim::Role::staff, "", body}});
  }
}

/// A moment of the data: so much of all runs' time has gone by then.
double moment_of(const TrialInForce& trial, double share) {
  const double duration_s = trial.duration_s.value_or(0.0), n = static_cast<double>(trial.begins_s.size());
  const double run = std::min(std::floor(share * n), n - 1.0);
  return trial.begins_s[static_cast<std::size_t>(run)] + (share * n - run) * duration_s;
}

/// Counts with `by` more people from one moment to another, in the fullest of counted areas (assumed). That it begins
/// and ends there is a reading of its own.
void miscount(CountsSpec& counts, double from_s, double to_s, int by) {
  constexpr double apart_s = 1.0;
  CountsSpec changed = counts;
  changed.times_s.clear();
  changed.people.clear();
  for (AreaCountsSpec& area : changed.areas) area.people.clear();
  const auto add = [&](double at_s, std::size_t reading, int off) {
    if (!changed.times_s.empty() && at_s <= changed.times_s.back()) return;
    changed.times_s.push_back(at_s);
    changed.people.push_back(std::max(0, counts.people[reading] + off));
    const auto people_in = [&](const AreaCountsSpec& area) { return area.people[reading]; };
    const auto fullest = std::ranges::max_element(counts.areas, {}, people_in);
    for (std::size_t i = 0; i < counts.areas.size(); ++i)
      changed.areas[i].people.push_back(
          std::max(0, people_in(counts.areas[i]) + (&counts.areas[i] == &*fullest ? off : 0)));
  };
  const auto add_edge = [&](double at_s, std::size_t reading, int off_before, int off_after) {
    add(at_s - apart_s, reading, off_before);
    add(at_s, reading, off_after);
  };
  bool begun = false, ended = false;
  for (std::size_t i = 0; i < counts.people.size(); ++i) {
    const double at_s = counts.times_s[i];
    const std::size_t before = i == 0 ? 0 : i - 1;
    if (!begun && at_s > from_s) begun = (add_edge(from_s, before, 0, by), true);
    if (begun && !ended && at_s > to_s) ended = (add_edge(to_s, before, by, 0), true);
    add(at_s, i, begun && !ended ? by : 0);
  }
  counts = std::move(changed);
}

void alter_people_miscounted(StudyInForce& study, const EffectSpec& effect) {
  const double share = effect.parameters.at("share"), begin = effect.parameters.at("begin") * (1.0 - share);
  if (share <= 0.0) return;
  for (TrialInForce& trial : study.trials) {
    if (!trial.occupancy || trial.occupancy->counts.times_s.empty()) continue;
    miscount(trial.occupancy->counts, moment_of(trial, begin), moment_of(trial, begin + share),
             word(effect, "there_was") == "one_fewer_than_told" ? -1 : 1);
    add_occupants(study, trial);
  }
}

Effect people_miscounted() {
  return {.info = {.name = "people_miscounted",
                   .family = Family::data,
                   .stage = "books",
                   .summary = "For part of the time one person more, or one fewer, was there than the counts of an "
                              "`occupancy` say. It needs such counts.",
                   .fingerprint = "all sensors have more motion, or less, in stretches of one number of people",
                   .as_if = "people were miscounted for a while",
                   .confused_with = {"second_person", "missed_triggers", "range_scale"},
                   .parameters = {told_as("share of the time", strength("share", "", 0.3, 0.05, 1.0, 1.0,
                                                                        "assumed: of all runs' time, in one stretch")),
                                  told_as("begin (0 early, 1 late)",
                                          detail("begin", "", 0.5, 0.0, 1.0, 0.0, 1.0,
                                                 "any: 0 at the beginning, 1 as late as possible"))},
                   .choices = {{"there_was",
                                ChoiceKind::variant,
                                {"one_more_than_told", "one_fewer_than_told"},
                                "one_more_than_told"}},
                   .reach = Reach::geometry,
                   .needs = Needs::counts,
                   .idle_in = {Survey::coverage, Survey::walk_test}},
          .alter = alter_people_miscounted};
}

// telegram_collisions: sensors share a channel, on which those that report in the same window disturb each other.

enum class Survivor { none, one };

class TelegramCollisions final : public CloneableRowStage<TelegramCollisions> {
 public:
  TelegramCollisions(std::vector<Telegrams> telegrams, double chance, Survivor survivor)
      : telegrams_(std::move(telegrams)), chance_(chance), survivor_(survivor) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    stream_ = Stream({seed, run, 0, Purpose::telegram_collision});
    for (Telegrams& telegrams : telegrams_) telegrams.begin_run();
  }

  void apply(Sample& row) noexcept override {
    std::uint32_t n = 0;
    for (std::size_t i = 0; i < telegrams_.size(); ++i) n += telegrams_[i].sends(row.bits[i]) ? 1 : 0;
    const bool collide = n > 1 && stream_.uniform() < chance_;
    const std::uint32_t survives = collide && survivor_ == Survivor::one ? stream_.index(n) : n;
    std::uint32_t sender = 0;
    for (std::size_t i = 0; i < telegrams_.size(); ++i) {
      std::uint8_t& bit = row.bits[i];
      bit = telegrams_[i].after(bit, telegrams_[i].sends(bit) && collide && sender++ != survives);
    }
  }

 private:
  std::vector<Telegrams> telegrams_;  ///< (n_sensors)
  double chance_;
  Survivor survivor_;
  Stream stream_{{}};
};

std::unique_ptr<RowStage> make_telegram_collisions(const EffectSpec& effect, const StageContext& context) {
  std::vector<std::uint32_t> all(context.scene.sensors.size());
  std::iota(all.begin(), all.end(), 0U);
  return std::make_unique<TelegramCollisions>(telegrams_of(all, context), effect.parameters.at("probability"),
                                              word(effect, "survivor") == "one" ? Survivor::one : Survivor::none);
}

Effect telegram_collisions() {
  return {.info = {.name = "telegram_collisions",
                   .family = Family::electronics,
                   .stage = "books",
                   .summary = "Sensors share a channel. Where several report in one window (see motion or, if they "
                              "hold motion, go on or off), all their telegrams are lost, or all but a random one.",
                   .fingerprint = "rows with motion at two sensors or more are rare, each sensor alone fits",
                   .confused_with = {"missed_triggers", "dead_time"},
                   .parameters = {told_as("probability of a collision",
                                          strength("probability", "", 0.6, 0.2, 1.0, 1.0, "assumed"))},
                   .choices = {{"survivor", ChoiceKind::variant, {"none", "one"}, "none"}},
                   .reach = Reach::rows,
                   .idle_in = {Survey::walk_test}},
          .make_row_stage = make_telegram_collisions};
}

}  // namespace

std::vector<Effect> books_effects() {
  return {dead_sensor(), labels_swapped(), people_miscounted(), telegram_collisions()};
}

}  // namespace pirsim::effects
