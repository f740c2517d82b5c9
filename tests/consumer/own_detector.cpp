// A detector of one's own on recorded zones: a sensor triggers while at least `least` of its zones are active.
#include <pirsim/pirsim.hpp>

#include <iostream>
#include <vector>

namespace {

class Crowded final : public pirsim::DetectorLogic {
 public:
  Crowded(const pirsim::RayBundle& rays, int least) : rays_(rays), least_(least) {}

  void prepare(const pirsim::Recording& recording) override {
    crowded_.clear();
    for (std::uint32_t moment = 0; moment < recording.n_moments(); ++moment) {
      const pirsim::ZoneSet& set = recording.zones(moment);
      std::vector<std::uint8_t>& sensors = crowded_.emplace_back();
      for (std::size_t s = 0; s < rays_.n_sensors(); ++s) sensors.push_back(count(set, s) >= least_ ? 1 : 0);
    }
  }
  void begin_run(std::uint64_t, std::uint32_t) override {}
  void tick(std::uint32_t, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept override {
    for (std::size_t s = 0; s < triggers.size(); ++s) triggers[s] = crowded_[after][s];
  }

 private:
  int count(const pirsim::ZoneSet& set, std::size_t sensor) const {
    const auto first = rays_.cluster_zones_begin[rays_.sensor_clusters_begin[sensor]];
    const auto last = rays_.cluster_zones_begin[rays_.sensor_clusters_begin[sensor + 1]];
    int n = 0;
    for (auto zone = first; zone < last; ++zone) n += set.test(zone) ? 1 : 0;
    return n;
  }

  const pirsim::RayBundle& rays_;
  int least_;
  std::vector<std::vector<std::uint8_t>> crowded_;  ///< (n_moments x n_sensors)
};

int seconds_with_motion(const pirsim::Model& model, const pirsim::Recording& recording, int least) {
  Crowded logic(model.rays(), least);
  logic.prepare(recording);
  int seconds = 0;
  for (const pirsim::Sample& row : pirsim::replay(recording, 0, logic, /*seed=*/1).samples) {
    for (const auto bit : row.bits) seconds += bit;
  }
  return seconds;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const pirsim::Model model = pirsim::compile(pirsim::io::read_scene(argv[1]), pirsim::io::read_script(argv[2]));
    const std::vector<std::uint32_t> runs{7};
    const pirsim::Recording recording = pirsim::record(model, runs);
    for (const int least : {1, 3, 9}) std::cout << least << ' ' << seconds_with_motion(model, recording, least) << '\n';
  } catch (const pirsim::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
  }
}
