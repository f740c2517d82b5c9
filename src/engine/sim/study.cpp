#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/pir/analog_circuit.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/run_state.hpp"
#include "engine/sim/thermal_array.hpp"
#include "model/core/parallel.hpp"
#include "pirsim/columns.hpp"
#include "pirsim/error.hpp"
#include "pirsim/model.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/state.hpp"
#include "pirsim/study.hpp"

namespace pirsim::sim {

/// Why an analog sensor's signal stands where it does. Follows one run tick by tick, and gives every zone and body part
/// an element and amplifier of its own: they are linear.
class Explainer {
 public:
  explicit Explainer(const CompiledStudy& study) : study_(study), meter_(study.array(), study.tracer()) {
    for (const auto& sensor : study.array().analog()->sensors()) {
      filters_.push_back(sensor ? std::optional(sensor->silent_filter) : std::nullopt);
    }
    const RayBundle& bundle = study.array().analog()->power().clipped();
    for (std::uint32_t sensor = 0; sensor < bundle.n_sensors(); ++sensor) {
      sensor_of_zone_.resize(bundle.first_zone(sensor + 1), sensor);
    }
    for (std::uint32_t zone = 0; zone < bundle.n_zones(); ++zone) {
      zone_of_ray_.resize(bundle.zone_rays_begin[zone + 1], zone);
    }
  }

  /// Before the first step_tick(): whoever is there has been there for long and shares in no signal until they move.
  void settle(const RunState& state) {
    meter_.explain(state.crowd.actors(), state.crowd.doors().steps(), met_);
    for (const PowerShare& each : met_) {
      shares_[{zone_of_ray_[each.ray], each.person, each.part}].before_w += watts(each);
    }
    for (auto& [source, share] : shares_) {
      share.sections = filters_[sensor_of_zone_[std::get<0>(source)]]->at_rest(share.before_w);
    }
  }

  /// After each step_tick(), from the first on; appends one row an analog sensor.
  void explain(const RunState& state, std::vector<TraceRow>& rows) {
    meter_.explain(state.crowd.actors(), state.crowd.doors().steps(), met_);
    for (const PowerShare& each : met_) shares_[{zone_of_ray_[each.ray], each.person, each.part}].now_w += watts(each);
    for (auto& [source, share] : shares_) {
      filters_[sensor_of_zone_[std::get<0>(source)]]->advance(share.sections, share.before_w, share.now_w, 0.0);
      share.before_w = std::exchange(share.now_w, 0.0);
    }
    const std::size_t first_row = rows.size();
    for (std::size_t i = 0; i < filters_.size(); ++i) {
      const auto& detector = state.detector.analog()[i];
      if (!detector) continue;
      rows.push_back({.tick = state.tick,
                      .sensor = i,
                      .power_w = detector->power_w,
                      .signal_v = detector->volts,
                      .output = pir::AnalogCircuit::on(*detector) ? std::uint8_t{1} : std::uint8_t{0}});
    }
    for (const auto& [source, share] : shares_) {
      const auto& [zone, person, part] = source;
      const std::size_t sensor = sensor_of_zone_[zone];
      const double volts = filters_[sensor]->output(share.sections);
      TraceRow& row = *std::ranges::find(rows.begin() + static_cast<std::ptrdiff_t>(first_row), rows.end(), sensor,
                                         &TraceRow::sensor);
      if (std::abs(volts) <= std::abs(row.share_v)) continue;
      row.share_v = volts;
      row.zone = zone - study_.array().analog()->power().clipped().first_zone(sensor);
      row.person = state.crowd.actors()[person].person().spec.id;
      row.part = body::name(part);
    }
  }

 private:
  /// Zone of the bundle, person, part.
  using Source = std::tuple<std::uint32_t, std::uint32_t, body::Part>;
  struct Share {
    pir::AnalogFilter::Sections sections{};
    double before_w = 0.0, now_w = 0.0;
  };

  [[nodiscard]] double watts(const PowerShare& share) const {
    const AnalogModel& analog = *study_.array().analog();
    const std::uint32_t sensor = sensor_of_zone_[zone_of_ray_[share.ray]];
    return static_cast<double>(share.power) * analog.watts_per_step(sensor, analog.power().receiver_of(share.ray));
  }

  const CompiledStudy& study_;
  PowerMeter meter_;
  std::vector<std::optional<pir::AnalogFilter>> filters_;  ///< (n_sensors) without noise
  std::vector<std::uint32_t> sensor_of_zone_, zone_of_ray_;
  std::map<Source, Share> shares_;  ///< of all that ever brought power
  std::vector<PowerShare> met_;     ///< scratch
};

}  // namespace pirsim::sim

namespace pirsim {
namespace {

void note_incidents(const sim::CompiledStudy& study, const sim::RunState& state, std::vector<RunIncident>& incidents) {
  for (const sim::Actor& actor : state.crowd.actors()) {
    for (const sim::Incident& incident : actor.incidents()) {
      incidents.push_back(
          {incident.kind, static_cast<double>(incident.tick) * study.tick_s(), actor.person().spec.id, incident.place});
    }
  }
}

void add_occupants(const sim::CompiledStudy& study, const sim::RunState& state, std::vector<OccupantRow>& rows) {
  for (const sim::Actor& actor : state.crowd.actors()) {
    if (actor.person().spec.changes.role == PersonRole::object) continue;
    if (!actor.present()) continue;
    const Vec2 place = actor.motion().position();
    const bool inside = study.scene().floor.contains(place);
    rows.push_back({state.sample.time_s, state.sample.clock, actor.person().spec.id, std::string(actor.phase()),
                    std::string(actor.seat()), place, inside ? OccupantRow::Where::inside : OccupantRow::Where::outside,
                    std::string(inside ? study.areas().name_at(place) : std::string_view())});
  }
}

sim::ZonesOf zones_for(Record record) {
  return record == Record::samples_and_zones ? sim::ZonesOf::all_sensors : sim::ZonesOf::zone_sensors;
}

RunResult run_with(sim::ObserverPool& observers, const sim::CompiledStudy& study, std::uint32_t run, Record record,
                   Trace trace, Occupants occupants, Frames frames, const std::function<void()>& window_done = {}) {
  RunResult result;
  result.run = run;
  result.replicate = study.replicate_of(run);
  result.trial = study.trial_of(run).id;
  sim::RunState state(study, run);
  *state.observer = observers.borrow();
  std::optional<sim::Explainer> explainer;
  if (trace == Trace::signals && study.array().analog() != nullptr) explainer.emplace(study);
  if (explainer) explainer->settle(state);
  std::vector<sim::Camera> cameras;
  const auto take_frames = [&] {
    for (sim::Camera& camera : cameras) camera.look(state);
  };
  for (std::size_t i = 0; frames == Frames::taken && i < study.arrays().size(); ++i)
    cameras.emplace_back(*study.arrays()[i], study.tracer(), run);
  take_frames();
  // Zones and signals are recorded at every tick, so no window may be passed over.
  const bool may_pass = record == Record::samples && !explainer;
  try {
    while (!state.finished) {
      if (may_pass && sim::pass_empty_window(study, state)) {
        take_frames();
        result.samples.push_back(state.sample);
        if (window_done) window_done();
        continue;
      }
      const bool window_ended = sim::step_tick(study, state);
      if (record == Record::samples_and_zones) result.zones.push_back(state.exposure().zones);
      if (explainer) explainer->explain(state, result.trace);
      take_frames();
      if (window_ended) result.samples.push_back(state.sample);
      if (window_ended && occupants == Occupants::told) add_occupants(study, state, result.occupants);
      note_incidents(study, state, result.incidents);
      if (window_ended && window_done) window_done();
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    result.samples.clear();
    result.zones.clear();
    result.trace.clear();
    result.occupants.clear();
    cameras.clear();
    result.fault = {static_cast<double>(state.tick) * study.tick_s(), error.issues().front().message};
  }
  for (sim::Camera& camera : cameras) result.frames.push_back(std::move(camera.frames()));
  return result;
}

}  // namespace

RunResult run_once(const Model& model, std::uint32_t run, Record record, Trace trace, Occupants occupants,
                   Frames frames) {
  sim::ObserverPool observers(model.compiled(), zones_for(record));
  return run_with(observers, model.compiled(), run, record, trace, occupants, frames);
}

void run_study(const Model& model, const StudyOptions& options, const std::function<void(const RunResult&)>& consume) {
  const RunRange range = options.runs.value_or(RunRange{0, model.n_runs()});
  const auto run_of = [&](std::size_t i) {
    return options.chosen ? (*options.chosen)[i] : range.first + static_cast<std::uint32_t>(i);
  };
  sim::ObserverPool observers(model.compiled(), zones_for(options.record));
  ordered_parallel<RunResult>(
      options.chosen ? options.chosen->size() : range.count(), options.threads,
      [&](std::size_t i) {
        return run_with(observers, model.compiled(), run_of(i), options.record, options.trace, options.occupants,
                        options.frames, options.window_done);
      },
      [&](RunResult& result) { consume(result); }, options.goes_on);
}

const SceneSpec& Model::scene() const noexcept { return compiled_->scene_given(); }
const ScriptSpec& Model::script() const noexcept { return compiled_->script_given(); }
std::uint32_t Model::n_runs() const noexcept { return compiled_->n_runs(); }
const std::string& Model::trial_of(std::uint32_t run) const noexcept { return compiled_->trial_of(run).id; }
int Model::replicate_of(std::uint32_t run) const noexcept { return compiled_->replicate_of(run); }
double Model::tick_s() const noexcept { return compiled_->tick_s(); }
const RayBundle& Model::rays() const noexcept { return compiled_->array().clipped(); }

std::vector<std::string> Model::columns() const {
  const bool has_clock =
      std::ranges::any_of(compiled_->trials(), [](const sim::TrialModel& trial) { return trial.clock.has_value(); });
  ColumnOwners owners{.areas = areas()};
  for (const DoorSpec& door : scene().doors) owners.doors.push_back(door.id);
  for (const SensorSpec& sensor : scene().sensors) owners.sensors.push_back(sensor.id);
  return column_names<Sample>(owners, [&](When when) { return when != When::with_clock || has_clock; });
}

const std::vector<std::string>& Model::areas() const noexcept { return compiled_->areas().names(); }

Model compile(SceneSpec scene, ScriptSpec script, const CompileOptions& options) {
  const sim::CompiledStudy* like = options.like != nullptr ? &options.like->compiled() : nullptr;
  return Model(std::make_shared<const sim::CompiledStudy>(std::move(scene), std::move(script), options.tracer, like));
}

State::State(const Model& model, std::uint32_t run)
    : study_(model.compiled_), run_state_(std::make_unique<sim::RunState>(model.compiled(), run)) {
  sim::settle(*study_, *run_state_);
}
State::State(const State& other)
    : study_(other.study_), run_state_(std::make_unique<sim::RunState>(*other.run_state_)) {}
State& State::operator=(const State& other) { return *this = State(other); }
State::State(State&&) noexcept = default;
State& State::operator=(State&&) noexcept = default;
State::~State() = default;

std::uint32_t State::run() const noexcept { return run_state_->run; }
std::int64_t State::tick() const noexcept { return run_state_->tick; }
const ZoneSet& State::zones() const { return sim::zones_of_all(*study_, *run_state_); }
const Sample& State::sample() const noexcept { return run_state_->sample; }
bool State::finished() const noexcept { return run_state_->finished; }

bool step_tick(const Model& model, State& state) { return sim::step_tick(model.compiled(), state.run_state()); }

bool step(const Model& model, State& state) {
  if (state.finished()) return false;
  if (sim::pass_empty_window(model.compiled(), state.run_state())) return true;
  while (!step_tick(model, state)) {
  }
  return true;
}

}  // namespace pirsim
