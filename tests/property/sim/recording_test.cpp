#include "sim/compiled_study.hpp"
#include "sim/replay.hpp"

#include <numeric>

#include "pirsim/random.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

std::vector<std::uint32_t> all_runs(const Model& model) {
  std::vector<std::uint32_t> runs(model.n_runs());
  std::iota(runs.begin(), runs.end(), 0U);
  return runs;
}
Model short_study(const std::string& change_per) {
  return compile(shipped_scene("meeting_room.gltf"),
                 shipped_script("studyA.yaml", {"replicates=2", "people.0.actions.3.work.duration_s=65",
                                                "sensing.change_per=" + change_per}));
}
std::vector<RunResult> study_of(const Model& model) {
  std::vector<RunResult> results;
  run_study(model, {}, [&](const RunResult& result) { results.push_back(result); });
  return results;
}

/// Misses every trigger with probability one half.
class DozingLogic final : public DetectorLogic {
 public:
  explicit DozingLogic(const Model& model) : awake_(sim::make_logic(model)), seen_(model.scene().sensors.size()) {}
  void prepare(std::span<const ZoneSet> sets) override { awake_->prepare(sets); }
  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    awake_->begin_run(seed, run);
    stream_ = Stream({seed, run, 0, Purpose::test});
  }
  void tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> bits) noexcept override {
    std::fill(seen_.begin(), seen_.end(), std::uint8_t{0});
    awake_->tick(before, after, seen_);
    for (std::size_t s = 0; s < bits.size(); ++s) {
      if (seen_[s] != 0 && stream_.index(2) == 0) bits[s] = 1;
    }
  }

 private:
  std::unique_ptr<DetectorLogic> awake_;
  std::vector<std::uint8_t> seen_;
  Stream stream_{{}};
};

int total_bits(const RunResult& result) {
  int total = 0;
  for (const Sample& sample : result.samples) total += std::accumulate(sample.bits.begin(), sample.bits.end(), 0);
  return total;
}

}  // namespace

TEST_CASE("what is replayed from recorded zones is the study, bit for bit, whichever change counts") {
  const Model per_cluster = short_study("cluster"), per_beam = short_study("beam");
  const Recording tracks = record(per_cluster, all_runs(per_cluster));
  REQUIRE(tracks.runs.size() == 20);
  CHECK(tracks.sets.front() == ZoneSet(per_cluster.compiled().array().channels().n_zones()));
  int differences = 0;
  std::vector<std::vector<RunResult>> studies;
  // One recording serves both: the second study was never followed.
  for (const Model* model : {&per_cluster, &per_beam}) {
    const auto logic = sim::make_logic(*model);
    logic->prepare(tracks.sets);
    studies.push_back(study_of(*model));
    for (std::size_t i = 0; i < tracks.runs.size(); ++i) {
      const RunResult emitted = replay(tracks, i, *logic, 1);
      REQUIRE(emitted.trial == studies.back()[i].trial);
      REQUIRE(emitted.samples == studies.back()[i].samples);
    }
  }
  for (std::size_t i = 0; i < 20; ++i) differences += studies[0][i].samples == studies[1][i].samples ? 0 : 1;
  CHECK(differences > 0);  // the two logics do differ
}

TEST_CASE("a detector's chance follows from the seed and the run alone") {
  const Model model = short_study("cluster");
  const Recording tracks = record(model, all_runs(model), 1);
  DozingLogic dozing(model);
  dozing.prepare(tracks.sets);
  const auto rows = [&](std::size_t run, std::uint64_t seed) { return replay(tracks, run, dozing, seed).samples; };
  const auto first = rows(0, 1);
  CHECK(rows(1, 1) != rows(0, 1));
  CHECK(rows(0, 1) == first);
  CHECK(rows(0, 2) != first);
  CHECK(total_bits(replay(tracks, 0, dozing, 3)) < total_bits(tracks.runs[0].rows));
}

TEST_CASE("recordings don't depend on the number of threads") {
  const Model model = short_study("cluster");
  const Recording one = record(model, all_runs(model), 1), two = record(model, all_runs(model), 2);
  CHECK(one.sets == two.sets);
  for (std::size_t i = 0; i < one.runs.size(); ++i) REQUIRE(one.runs[i].sets == two.runs[i].sets);
}
