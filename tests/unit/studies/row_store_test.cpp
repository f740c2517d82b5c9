#include "studies/coverage.hpp"

#include <fstream>
#include <sstream>

#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::studies;

namespace {

CoverageStudy small_study(double duration_s = 2.0) {
  SceneSpec scene;
  scene.floor = FloorArea({{{-2, -4}, {2, -4}, {2, 0}, {-2, 0}}}, 0.0);
  scene.sensors = {{"PIR", "EKMC1604111", Frame{{1, 0, 0, 0}, {0.0, 1.2, 0.0}}}};
  scene.sensor_models["EKMC1604111"] = io::read_sensor_model(test::data("sensors/EKMC1604111.yaml"));
  CoverageSpec spec;
  spec.spacing_m = 0.5;
  spec.duration_s = duration_s;
  return {std::move(scene), std::move(spec)};
}

std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

void store_rows(const std::filesystem::path& file, const CoverageStudy& study, std::size_t n_rows) {
  RowStore store(file, study);
  for (std::size_t row = store.n_found_rows(); row < n_rows; ++row) store.append(study.counts_of_row(row));
}

}  // namespace

TEST_CASE("a study that stopped anywhere, even within a line, goes on to the same map", "[coverage]") {
  const ::TemporaryFolder folder;
  const auto file = folder.path() / "rows";
  const CoverageStudy study = small_study();
  const std::vector<MotionCount> whole = run_coverage(study).counts;
  REQUIRE(std::ranges::count(whole, 0) < static_cast<std::ptrdiff_t>(whole.size()));
  store_rows(file, study, study.grid().n_rows());
  const std::string complete = content(file);
  for (std::size_t cut = 0; cut <= complete.size(); cut += 7) {
    std::ofstream(file, std::ios::binary) << complete.substr(0, cut);
    RowStore store(file, study);
    std::vector<MotionCount> counts = store.found();
    CHECK(counts.size() == store.n_found_rows() * study.grid().n_columns());
    run_rows(study, store.n_found_rows(), 2, [&](std::size_t, const std::vector<MotionCount>& row) {
      store.append(row);
      counts.insert(counts.end(), row.begin(), row.end());
    });
    CHECK(counts == whole);
    CHECK(content(file) == complete);
  }
}

TEST_CASE("rows of another study or with a changed digit aren't taken", "[coverage]") {
  const ::TemporaryFolder folder;
  const auto file = folder.path() / "rows";
  store_rows(file, small_study(2.0), 5);
  CHECK(RowStore(file, small_study(2.0)).n_found_rows() == 5);
  CHECK(RowStore(file, small_study(3.0)).n_found_rows() == 0);

  store_rows(file, small_study(2.0), 5);
  std::string text = content(file);
  const std::size_t second_row = text.find('\n', text.find('\n') + 1) + 1;
  text[second_row] = text[second_row] == '0' ? '1' : '0';
  std::ofstream(file, std::ios::binary) << text;
  CHECK(RowStore(file, small_study(2.0)).n_found_rows() == 1);
}

TEST_CASE("a complete study leaves no file of rows", "[coverage]") {
  const ::TemporaryFolder folder;
  const auto file = folder.path() / "rows";
  RowStore store(file, small_study());
  CHECK(std::filesystem::exists(file));
  store.remove();
  CHECK_FALSE(std::filesystem::exists(file));
}
