// Light for sets of sensors by columns of motion: against a plain loop, `control`, brute force and runs of each set.
#include "surveys/placement.hpp"

#include <algorithm>
#include <random>

#include "pirsim/control.hpp"
#include "pirsim/io.hpp"
#include "pirsim/look.hpp"
#include "pirsim/study.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::studies;

namespace {

bool bit(const RowBits& bits, std::size_t row) { return (bits[row / 64] >> (row % 64) & 1U) != 0; }
void put(RowBits& bits, std::size_t row) { bits[row / 64] |= std::uint64_t{1} << (row % 64); }

/// Two areas whose people come and go, long empty times among them; half of the sensors watch each.
LightRows random_rows(unsigned seed, std::size_t n_sensors) {
  std::mt19937 draw(seed);
  LightRows rows;
  rows.areas = {"a", "b"};
  for (std::size_t i = 0; i < n_sensors; ++i) {
    rows.sensors.push_back("PIR" + std::to_string(i));
    rows.area_of.emplace_back(i % 2);
  }
  for (int r = 0; r < 2; ++r) {
    LightRun run;
    run.n_rows = 3000 + 37 * static_cast<std::size_t>(r);
    const RowBits nothing((run.n_rows + 63) / 64, 0);
    run.occupied.assign(2, nothing);
    run.moved.assign(n_sensors, nothing);
    for (std::size_t area = 0; area < 2; ++area) {
      bool is_there = false;
      for (std::size_t row = 0; row < run.n_rows; ++row) {
        if (draw() % 300 == 0) is_there = !is_there;
        if (!is_there) continue;
        put(run.occupied[area], row);
        for (std::size_t i = area; i < n_sensors; i += 2) {
          if (draw() % (60 + 40 * i) == 0) put(run.moved[i], row);
        }
      }
    }
    rows.runs.push_back(std::move(run));
  }
  return rows;
}

PlacementLightSpec light_with(double delay_min, double wave_s) {
  PlacementLightSpec light;
  light.delay_min = delay_min;
  light.wave_s = wave_s;
  return light;
}

/// Said anew, row by row: lit in the row of a motion and for the delay after it; who was in the dark for longer than
/// the waving takes brings it back.
LightSums plainly(const LightRows& rows, const std::vector<std::size_t>& chosen, std::int64_t delay,
                  std::int64_t wave) {
  LightSums sums;
  for (std::size_t area = 0; area < rows.areas.size(); ++area) {
    for (const LightRun& run : rows.runs) {
      std::int64_t left = -1, dark = 0;  // rows that it stays lit beyond this one; -1: dark
      for (std::size_t row = 0; row < run.n_rows; ++row) {
        const bool is_there = bit(run.occupied[area], row);
        const bool moves = std::ranges::any_of(
            chosen, [&](std::size_t i) { return rows.area_of[i] == area && bit(run.moved[i], row); });
        const bool was_lit = left >= 0;
        if (moves || (!was_lit && is_there && dark >= wave)) {
          left = delay;
        } else if (was_lit) {
          --left;
        }
        const bool is_lit = left >= 0;
        // The row in which it goes off begins no waving yet.
        dark = is_lit || was_lit || !is_there ? 0 : dark + 1;
        sums.occupied += is_there ? 1 : 0;
        sums.lit_empty += is_lit && !is_there ? 1 : 0;
        sums.dark += !is_lit && is_there ? 1 : 0;
        sums.false_offs += was_lit && !is_lit && is_there ? 1 : 0;
      }
    }
  }
  return sums;
}

LightSums at_once(const LightRows& rows, const std::vector<std::size_t>& chosen, const PlacementLightSpec& light) {
  return LightSearch(rows, light).of(chosen);
}

}  // namespace

TEST_CASE("light by columns of bits is light row by row", "[placement]") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const LightRows rows = random_rows(seed, 6);
    for (const std::vector<std::size_t>& chosen : {std::vector<std::size_t>{}, {0}, {0, 1, 4}, {0, 1, 2, 3, 4, 5}}) {
      INFO(seed << ' ' << chosen.size());
      CHECK(at_once(rows, chosen, light_with(1.0, 10.0)) == plainly(rows, chosen, 60, 10));
      CHECK(at_once(rows, chosen, light_with(0.0, 0.0)) == plainly(rows, chosen, 0, 0));
      CHECK(at_once(rows, chosen, light_with(3.0, 30.0)) == plainly(rows, chosen, 180, 30));
    }
  }
}

TEST_CASE("light by columns of bits is what `control` makes of the same rows", "[placement]") {
  const LightRows rows = random_rows(7, 4);
  control::LightSpec light;
  light.delays_min = {2.0};
  light.wave_s = 10.0;
  control::RuleSpec rule;
  for (const std::string area : {"a", "b"}) {
    light.id = light.area = area;
    light.sensors = area == "a" ? std::vector<std::string>{"PIR0", "PIR2"} : std::vector<std::string>{"PIR1", "PIR3"};
    rule.lights.push_back(light);
  }
  control::Control control(rule, {rows.sensors, rows.areas, {}}, 1.0);
  int replicate = 0;
  for (const LightRun& run : rows.runs) {
    ++replicate;
    for (std::size_t row = 0; row < run.n_rows; ++row) {
      Sample sample;
      sample.replicate = replicate;
      sample.time_s = static_cast<double>(row + 1);
      for (const RowBits& moved : run.moved) sample.bits.push_back(bit(moved, row) ? 1 : 0);
      for (const RowBits& there : run.occupied) sample.people_of_areas.push_back(bit(there, row) ? 1 : 0);
      control.add(sample);
    }
  }
  const control::Costs costs = control.finish();
  const LightScore score = score_light(rows, light_with(2.0, 10.0));
  REQUIRE(score.areas.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const control::DelayCosts& at = costs.lights[i].at(2.0);
    CHECK(static_cast<double>(score.areas[i].false_offs) == at.false_offs);
    CHECK(score.areas[i].false_offs > 0);
    CHECK(score.areas[i].false_offs_an_hour() == Approx(at.false_offs_an_hour.value));
    CHECK(score.areas[i].dark_h == Approx(at.dark_h));
    CHECK(score.areas[i].lit_empty_h == Approx(at.lit_empty_h));
  }
  CHECK(score.all.false_offs == score.areas[0].false_offs + score.areas[1].false_offs);
}

TEST_CASE("of random columns the search finds what no other set beats, nearly always", "[placement]") {
  const PlacementLightSpec light = light_with(1.0, 10.0);
  int optimal = 0;
  constexpr int n_cases = 40;
  for (unsigned seed = 0; seed < n_cases; ++seed) {
    const LightRows rows = random_rows(seed, 8);
    LightSums least = plainly(rows, {0, 1, 2}, 60, 10);
    for (std::size_t i = 0; i < 8; ++i) {
      for (std::size_t j = i + 1; j < 8; ++j) {
        for (std::size_t k = j + 1; k < 8; ++k) {
          const LightSums sums = plainly(rows, {i, j, k}, 60, 10);
          if (sums.better_than(least)) least = sums;
        }
      }
    }
    LightSearch search(rows, light);
    const std::vector<std::size_t> found = best_of(search, {5, 6, 7});
    REQUIRE(found.size() == 3);
    CHECK_FALSE(search.of(found).better_than(least));
    CHECK_FALSE(search.of({5, 6, 7}).better_than(search.of(found)));
    optimal += search.of(found) == least ? 1 : 0;
  }
  CHECK(optimal >= n_cases * 9 / 10);
}

TEST_CASE("an area without a sensor counts as dark, and not as never switched off", "[placement]") {
  const LightRows rows = random_rows(3, 6);
  const PlacementLightSpec light = light_with(1.0, 10.0);
  const LightSums none = at_once(rows, {}, light), one_area = at_once(rows, {0, 2, 4}, light),
                  both = at_once(rows, {0, 2, 4, 1, 3, 5}, light);
  CHECK(one_area.false_offs < none.false_offs);
  CHECK(both.false_offs < one_area.false_offs);
}

namespace {

/// Two who type in a meeting room under ceiling sensors, without noise: what a sensor sees doesn't hang on its number.
struct Office {
  SceneSpec scene = io::read_scene(test::data_dir() / "rooms/meeting_room.gltf");
  PlacementSpec spec;

  Office() {
    const TemporaryFolder folder;
    folder.write("people.yaml", R"(
pirsim_script: 1
sensing: {tick_rate_hz: 10}
people:
  - {id: one, style: natural, actions: [{enter: door}, {sit: S2}, {work: {duration_s: 1500}}, {leave: door}]}
  - {id: two, style: natural, actions: [{enter: door, at_s: 60}, {sit: S9}, {work: {duration_s: 900}}, {leave: door}]}
)");
    spec = io::read_placements(folder.write("places.yaml", R"(
pirsim_placements: 1
by: false_off
light: {script: people.yaml, delay_min: 0.5}
spacing_m: 1
duration_s: 2
target: {x_shapes: {}}
sets: [{id: as built}]
search:
  n_sensors: 2
  model: EKMC1601111
  evaluations: 6
  lines: [{from_m: [0.5, 2.6, -1.2], to_m: [6.5, 2.6, -1.2], tilt_deg: 90}, {from_m: [0.5, 2.6, -3.2], to_m: [6.5, 2.6, -3.2], tilt_deg: 90}]
)"));
    const SensorModelSpec model = io::find_sensor_model("EKMC1601111", test::data_dir() / "rooms/meeting_room.gltf");
    scene.sensor_models["EKMC1601111"] = model;
    for (auto& [id, known] : scene.sensor_models) known.detector.amplifier.noise_v_pp = 0.0;
  }
  [[nodiscard]] LightRows rows_of(const SensorSetSpec& set) const {
    return light_rows(with_set(scene, set), *spec.light, spec.coverage.sensing);
  }
};

}  // namespace

TEST_CASE("by false-offs, no other pair of the tried places is better, and columns are those of plain runs",
          "[placement][seconds]") {
  const Office office;
  constexpr int n_places = 6;
  std::vector<double> shares;
  for (int i = 0; i < n_places; ++i) shares.push_back((i + 0.5) / n_places);
  const LightRows all = office.rows_of(sensors_along(*office.spec.search, shares, ""));
  LightSums least;
  least.false_offs = 1'000'000;
  const auto sums_of = [&](const LightRows& rows) {
    return switch_light(rows, 0, std::vector<std::size_t>{0, 1}, *office.spec.light);
  };
  for (std::size_t i = 0; i < n_places; ++i) {
    for (std::size_t j = i + 1; j < n_places; ++j) {
      const LightRows pair = office.rows_of(sensors_along(*office.spec.search, {shares[i], shares[j]}, ""));
      CHECK(pair.runs[0].moved[0] == all.runs[0].moved[i]);
      CHECK(pair.runs[0].moved[1] == all.runs[0].moved[j]);
      if (sums_of(pair).better_than(least)) least = sums_of(pair);
    }
  }
  CHECK(all.runs[0].occupied[0] != RowBits(all.runs[0].occupied[0].size(), 0));
  const PlacementReport report = run_placements(office.scene, office.spec);
  const PlacementLight& found = report.search->found.light;
  const double row_h = all.window_s / 3600.0;
  CHECK(std::tuple(found.false_offs, found.dark_h) <=
        std::tuple(least.false_offs, static_cast<double>(least.dark) * row_h + 1e-12));
  CHECK(found.occupied_h > 0.4);
  const std::string text = report.text;
  INFO(text);
  CHECK(text.starts_with("ranked by how seldom light goes off on somebody (delay 0.5 min)"));
  CHECK(text.find("6 places tried: ") != std::string::npos);
  CHECK(report.ranked.front().light.false_offs <= report.ranked.back().light.false_offs);
}

TEST_CASE("the columns of a run are its rows", "[placement][seconds]") {
  const Office office;
  const LightRows rows = office.rows_of({});
  const Model model = compile(office.scene, office.spec.light->people);
  const RunResult run = run_once(model, 0);
  REQUIRE(rows.runs.size() == 1);
  REQUIRE(rows.runs[0].n_rows == run.samples.size());
  for (std::size_t row = 0; row < run.samples.size(); ++row) {
    REQUIRE(bit(rows.runs[0].occupied[0], row) == (run.samples[row].people > 0));
    for (std::size_t i = 0; i < rows.sensors.size(); ++i)
      REQUIRE(bit(rows.runs[0].moved[i], row) == (run.samples[row].bits[i] == 1));
  }
}

TEST_CASE("a study of light without people, or with too few places, is refused where it says so", "[placement]") {
  const TemporaryFolder folder;
  const auto fault = [&](const std::string& light) {
    try {
      static_cast<void>(io::read_placements(
          folder.write("p.yaml", "pirsim_placements: 1\ntarget: {x_shapes: {}}\nby: false_off\n" + light)));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(fault(""), contains("p.yaml:3:5: error: by: false_off: whose light?"));
  CHECK_THAT(fault("light: {delay_min: 5}\n"), contains("script"));
  CHECK_THAT(fault("light: {script: nowhere.yaml}\n"), contains("nowhere.yaml"));
  folder.write("w.yaml", "pirsim_script: 1\npeople: []\n");
  CHECK_THAT(fault("light: {script: w.yaml, delay_mn: 5}\n"), contains("delay_min"));
}
