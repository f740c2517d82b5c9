#include <utility>

#include "pirsim/error.hpp"
#include "studies/campaign.hpp"

namespace pirsim::studies {

RowTally::RowTally(std::vector<std::string> trials, SummarySpec spec, std::vector<MeasuredCell> measured)
    : trials_(std::move(trials)), spec_(std::move(spec)), measured_(std::move(measured)) {}

void RowTally::add(std::string_view bytes) {
  for (const char c : bytes) {
    is_quoted_ = is_quoted_ != (c == '"');
    if (c != '\n' || is_quoted_) {
      line_ += c;
      continue;
    }
    take_line(line_);
    line_.clear();
  }
}

void RowTally::take_line(std::string_view line) {
  ++n_lines_;
  if (!format_) {
    const io::RowFormat& format = format_.emplace(line, Where{"rows", n_lines_, 1});
    summary_.emplace(trials_, format.columns().sensors, std::move(measured_));
    counts_.emplace(format.columns().sensors.size(), spec_, format.columns().areas);
    return;
  }
  io::RepeatedFaults found;
  if (!format_->read(line, n_lines_, row_, found)) {
    Diagnostics faults;
    found.tell(faults);
    faults.throw_if_errors();
  }
  if (row_.replicate != replicate_ || row_.trial != trial_) {
    end_run();
    replicate_ = row_.replicate;
    trial_ = row_.trial;
  }
  counts_->add(row_);
}

void RowTally::end_run() {
  if (replicate_) summary_->add_run(trial_, counts_->counts(), counts_->areas());
  counts_->reset();
}

const Summary& RowTally::finish() {
  if (!summary_ || !line_.empty()) throw Error(ErrorCode::input, "the rows end within a line");
  end_run();
  replicate_.reset();
  return *summary_;
}

}  // namespace pirsim::studies
