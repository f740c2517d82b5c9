#include "app/summary_output.hpp"

#include <iostream>

#include "io/csv_reader.hpp"

namespace pirsim::app {

std::vector<MeasuredCell> measured_cells(const ScriptSpec& script) {
  const std::string& reference = script.summary.reference_file;
  if (reference.empty()) return {};
  return io::read_measured_cells(std::filesystem::path(script.directory) / reference);
}

void write_summary(const studies::Summary& summary, io::AtomicFile& file, const std::filesystem::path& path,
                   const std::string& title, Verbosity verbosity) {
  const bool is_document = path.extension() == ".md";
  if (is_document) file.stream() << "# " << title << ": seconds with motion\n\n";
  file.stream() << (is_document ? studies::to_markdown(summary) : studies::to_csv(summary));
  file.commit();
  if (verbosity != Verbosity::quiet) std::cerr << studies::to_text(summary);
}

}  // namespace pirsim::app
