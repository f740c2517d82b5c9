#include "studies/study_report.hpp"

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <iomanip>
#include <sstream>

namespace pirsim::studies {
namespace {

std::string fixed(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

/// Stretches of rows in one of the counted phases.
std::vector<io::SeriesChart::Phase> counted_phases(const std::vector<Sample>& samples, const SummarySpec& spec,
                                                   double window_s) {
  std::vector<io::SeriesChart::Phase> phases;
  std::string current;
  for (const Sample& sample : samples) {
    const bool counted = std::ranges::find(spec.phases, sample.phase) != spec.phases.end();
    if (!counted) {
      current.clear();
    } else if (sample.phase == current) {
      phases.back().to_s = sample.time_s;
    } else {
      current = sample.phase;
      phases.push_back({current, sample.time_s - window_s, sample.time_s});
    }
  }
  return phases;
}

io::Table overall_table(const OverallSummary& overall) {
  io::Table table{{"over all cells", ""}, {}};
  table.rows = {{"cells with a measured count", std::to_string(overall.cells)},
                {"measured count within the simulated range", std::to_string(overall.inside)},
                {"expected if the measured counts were dealt at random", fixed(overall.shuffled_inside, 1)},
                {"simulated mean minus measured, average", fixed(overall.bias, 1)},
                {"average absolute error of the simulated means", fixed(overall.mean_absolute_error, 1)}};
  return table;
}

std::string note_of(const CellSummary& cell) {
  std::string note =
      "mean " + fixed(cell.mean, 1) + ", " + std::to_string(cell.min) + " to " + std::to_string(cell.max);
  if (cell.measured) {
    note += "; measured " + std::to_string(cell.measured->real) + (*cell.inside ? ", inside" : ", outside");
  }
  return note;
}

/// What was run, and what a count is.
std::string introduction(const Model& model, const std::vector<std::string>& sensors) {
  const ScriptSpec& script = model.script();
  return std::to_string(script.trials.size()) + " trials in " + model.scene().name + ", each run " +
         std::to_string(script.replicates) + " times, watched by " + boost::algorithm::join(sensors, ", ") +
         ". A count is the number of windows in which a sensor reported motion" +
         (script.summary.phases.empty()
              ? "."
              : " while the phase was " + boost::algorithm::join(script.summary.phases, ", ") + ".");
}

}  // namespace

StudyReport::StudyReport(const Model& model) : model_(&model) {
  for (const SensorSpec& sensor : model.scene().sensors) sensors_.push_back(sensor.id);
  for (const TrialSpec& trial : model.script().trials) {
    trials_.push_back({trial.id, {}, {}});
    if (trial.schedule) trials_.back().days.emplace(model, *trial.schedule);
  }
}

bool StudyReport::needs_occupants() const noexcept {
  return std::ranges::any_of(trials_, [](const Trial& trial) { return trial.days.has_value(); });
}

void StudyReport::add_run(const RunResult& result) {
  Trial& trial = trials_[result.run % trials_.size()];
  if (trial.days) return trial.days->add_run(result);
  if (result.replicate == 1) trial.samples = result.samples;
}

io::SeriesChart StudyReport::series_of(const Trial& trial) const {
  const SensingSpec& sensing = model_->script().sensing;
  io::SeriesChart chart;
  chart.title = trial.id;
  chart.window_s = static_cast<double>(sensing.ticks_per_window) / sensing.tick_rate_hz;
  if (!trial.samples.empty()) chart.end_s = trial.samples.back().time_s;
  chart.phases = counted_phases(trial.samples, model_->script().summary, chart.window_s);
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    auto& row = chart.rows.emplace_back();
    row.name = sensors_[i];
    for (const Sample& sample : trial.samples) {
      if (sample.bits[i] != 0) row.times_s.push_back(sample.time_s);
    }
  }
  return chart;
}

io::Report StudyReport::finish(const Summary& summary) const {
  const ScriptSpec& script = model_->script();
  const std::vector<CellSummary> cells = summary.cells();  // trials in order, sensors within each
  io::Report report;
  report.title = script.name;
  if (needs_occupants()) {
    report.paragraphs = {std::to_string(script.replicates) + (script.replicates == 1 ? " day in " : " days in ") +
                         model_->scene().name + ", watched by " + boost::algorithm::join(sensors_, ", ") + "."};
  } else {
    report.paragraphs = {introduction(*model_, sensors_)};
    io::ReportSection numbers{"In numbers", {}, {}, {}};
    if (summary.overall().cells > 0) {
      numbers.tables.push_back(overall_table(summary.overall()));
    } else {
      numbers.paragraphs.push_back("Nothing measured was given to compare with.");
    }
    report.sections.push_back(std::move(numbers));
  }

  for (std::size_t t = 0; t < trials_.size(); ++t) {
    if (trials_[t].days) {
      report.sections.push_back(trials_[t].days->section(trials_.size() == 1 ? "Days" : "Days of " + trials_[t].id));
      continue;
    }
    io::ReportSection section{trials_[t].id, {}, {}, {}};
    if (t == 0) {
      section.paragraphs = {
          "How often each count came out over the runs. The coloured line is the measured count, where " +
          std::string("there is one. Below: the first run, window by window") +
          (counted_phases(trials_[t].samples, script.summary, 1.0).empty() ? "." : "; counted windows are shaded.")};
    }
    for (std::size_t s = 0; s < sensors_.size(); ++s) {
      const CellSummary& cell = cells[t * sensors_.size() + s];
      if (cell.runs == 0) continue;
      std::optional<int> real;
      if (cell.measured) real = cell.measured->real;
      section.charts.emplace_back(io::HistogramChart{trials_[t].id + ", " + sensors_[s], note_of(cell),
                                                     "windows with motion", "windows", cell.counts, real});
    }
    io::SeriesChart series = series_of(trials_[t]);
    series.title += ", first run";
    if (!trials_[t].samples.empty()) section.charts.emplace_back(std::move(series));
    report.sections.push_back(std::move(section));
  }
  return report;
}

}  // namespace pirsim::studies
