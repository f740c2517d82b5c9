#include "studies/coverage.hpp"

#include <fstream>
#include <set>
#include <sstream>

#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/each_field.hpp"
#include "support/shipped.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::studies;

namespace {

struct Given {
  SceneSpec scene;
  CoverageSpec spec;
};
Given small_given(double duration_s = 2.0) {
  SceneSpec scene;
  scene.floor = FloorArea({{{-2, -4}, {2, -4}, {2, 0}, {-2, 0}}}, 0.0);
  scene.sensors = {{"PIR", "EKMC1604111", Frame{{1, 0, 0, 0}, {0.0, 1.2, 0.0}}}};
  scene.sensor_models["EKMC1604111"] = io::read_sensor_model(test::data("sensors/EKMC1604111.yaml"));
  CoverageSpec spec;
  spec.spacing_m = 0.5;
  spec.duration_s = duration_s;
  return {std::move(scene), std::move(spec)};
}
CoverageStudy small_study(double duration_s = 2.0) {
  auto [scene, spec] = small_given(duration_s);
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

TEST_CASE("whatever field of a coverage study or of its sensors is changed, its rows are another's", "[coverage]") {
  auto [scene, spec] = small_given();
  SensorModelSpec& model = scene.sensor_models.begin()->second;
  model.response = Response::analog;
  model.detector.amplifier.volts_per_watt = 1e6;
  model.detector.comparator.pulse_count = 2;
  model.detector.comparator.pulse_window_s = 4.0;
  spec.effects = {{"soft_zone_edges", {{"sigma_deg", 1.0}}, {}, {}}};
  const auto print = [&] { return fingerprint(CoverageStudy(scene, spec)); };
  const std::string before = print();
  std::set<std::string> unseen, refused;
  const auto check = [&](const std::string& path) {
    try {
      if (print() == before) unseen.insert(path);
    } catch (const Error&) {
      refused.insert(path);
    }
  };
  test::each_change(spec, "spec", check);
  test::each_change(scene.sensor_models, "models", check);
  CHECK(print() == before);
  // What only messages say; and detectors of a survey have no noise.
  CHECK(unseen == std::set<std::string>{"models{EKMC1604111}.description",
                                        "models{EKMC1604111}.detector.amplifier.noise_v_pp",
                                        "spec.effects[0].where.column", "spec.effects[0].where.file",
                                        "spec.effects[0].where.line", "spec.name", "spec.without_where"});
  // What no study can have has no rows.
  CHECK(refused == std::set<std::string>{"models{EKMC1604111}.clusters[0].zones[0].polarity", "spec.effects[0].name",
                                         "spec.without"});
  model.clusters[0].zones[0].polarity *= -1;
  CHECK(print() != before);
}

TEST_CASE("lines that are sound but not of this place aren't taken", "[coverage]") {
  const ::TemporaryFolder folder;
  const auto file = folder.path() / "rows";
  store_rows(file, small_study(), 5);
  const std::string text = content(file);
  std::vector<std::string> lines;
  for (std::istringstream all(text); std::getline(all, lines.emplace_back());) {
  }
  std::swap(lines[2], lines[3]);
  std::string swapped;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) swapped += lines[i] + '\n';
  std::ofstream(file, std::ios::binary) << swapped;
  CHECK(RowStore(file, small_study()).n_found_rows() == 1);
}

TEST_CASE("two at work on one coverage are one too many, and no link is followed", "[coverage]") {
  const ::TemporaryFolder folder;
  const auto file = folder.path() / "rows";
  {
    const RowStore first(file, small_study());
    CHECK_THROWS_WITH(RowStore(file, small_study()), contains("another process is at work"));
  }
  const auto mine = folder.write("mine.txt", "mine");
  std::filesystem::remove(file);
  std::filesystem::create_symlink(mine, file);
  CHECK_THROWS_WITH(RowStore(file, small_study()), contains("is a link"));
  CHECK(content(mine) == "mine");
}

TEST_CASE("a complete study leaves no file of rows", "[coverage]") {
  const ::TemporaryFolder folder;
  const auto file = folder.path() / "rows";
  RowStore store(file, small_study());
  CHECK(std::filesystem::exists(file));
  store.remove();
  CHECK_FALSE(std::filesystem::exists(file));
}
