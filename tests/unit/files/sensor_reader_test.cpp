#include "pirsim/io.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <sstream>

#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"
#include "support/turned_lens.hpp"

using namespace pirsim;

namespace {

const std::filesystem::path sensors = pirsim::test::data_dir() / "sensors";

struct PlaneZone {
  Vec2 centre;
  Vec2 half_diagonal;
  double range_m = 0.0;
};

/// An independent reading of the EKMC1604111's drawing.
std::vector<PlaneZone> second_reading() {
  std::ifstream file(sensors / "ekmc1604111_zones.csv");
  std::vector<PlaneZone> zones;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || std::isdigit(static_cast<unsigned char>(line[0])) == 0) continue;
    std::vector<double> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(std::stod(field));
    zones.push_back({{fields.at(3), fields.at(4)}, {fields.at(5), fields.at(6)}, fields.at(2)});
  }
  return zones;
}

Vec2 centre_of(const ZoneSpec& zone) {
  return (zone.corners[0] + zone.corners[1] + zone.corners[2] + zone.corners[3]) / 4.0;
}

/// Reads a sensor model from a file with this text; tests run in parallel, so the file has a name of its own.
SensorModelSpec model_of(const std::string& text) {
  static int count = 0;
  const std::string name = "pirsim_" + std::to_string(getpid()) + "_" + std::to_string(++count) + ".yaml";
  const std::filesystem::path path = std::filesystem::temp_directory_path() / name;
  std::ofstream(path) << text;
  const std::shared_ptr<void> cleanup(nullptr, [&](void*) { std::filesystem::remove(path); });
  return io::read_sensor_model(path);
}
/// All faults, one a line, with the file called f.
std::string refusal_of_sensor(const std::string& text) {
  std::string message;
  try {
    (void)model_of(text);
  } catch (const Error& error) {
    for (Issue issue : error.issues()) {
      issue.where.file = "f";
      if (!message.empty()) message += '\n';
      message += to_string(issue);
    }
  }
  return message;
}

}  // namespace

TEST_CASE("the 68 zones of EKMC1604111 agree with a second reading of the drawing", "[sensor]") {
  const SensorModelSpec model = io::read_sensor_model(sensors / "EKMC1604111.yaml");
  std::vector<PlaneZone> expected = second_reading();
  REQUIRE(expected.size() == 68);
  CHECK(model.plane_m == 5.0);
  double squares = 0.0;
  double worst_size = 0.0;
  for (const ClusterSpec& cluster : model.clusters) {
    for (const ZoneSpec& zone : cluster.zones) {
      const Vec2 centre = centre_of(zone);
      const auto distance = [&](const PlaneZone& other) { return glm::length(other.centre - centre); };
      const auto nearest = std::min_element(expected.begin(), expected.end(),
                                            [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
      REQUIRE(nearest != expected.end());
      CHECK(distance(*nearest) < 0.015);
      CHECK(nearest->range_m == cluster.range_m);
      squares += distance(*nearest) * distance(*nearest);
      worst_size = std::max(worst_size, std::abs(zone.corners[0].x - centre.x - nearest->half_diagonal.x));
      worst_size = std::max(worst_size, std::abs(zone.corners[1].y - centre.y - nearest->half_diagonal.y));
      expected.erase(nearest);  // one to one
    }
  }
  CHECK(expected.empty());
  CHECK(std::sqrt(squares / 68.0) < 0.010);
  CHECK(worst_size < 0.005);
}

TEST_CASE("the pattern of EKMC1604111 has the printed edges and steps", "[sensor]") {
  const SensorModelSpec model = io::read_sensor_model(sensors / "EKMC1604111.yaml");
  Vec2 lower(1e9);
  Vec2 upper(-1e9);
  std::map<double, std::size_t> zones_of_range;
  for (const ClusterSpec& cluster : model.clusters) {
    zones_of_range[cluster.range_m] += cluster.zones.size();
    CHECK(cluster.range_m == (cluster.lens_step == 1 ? 12.0 : cluster.lens_step == 2 ? 6.0 : 3.0));
    for (const ZoneSpec& zone : cluster.zones) {
      for (const Vec2& corner : zone.corners) {
        lower = glm::min(lower, corner);
        upper = glm::max(upper, corner);
      }
    }
  }
  const auto projected_deg = [&](double x) { return std::atan(x / model.plane_m) * 180.0 / M_PI; };
  CHECK(std::abs(projected_deg(upper.y) - 6.6) < 0.2);
  CHECK(std::abs(projected_deg(lower.y) - -48.9) < 0.2);
  CHECK(std::abs(projected_deg(upper.x) - 56.1) < 0.2);
  CHECK(std::abs(projected_deg(lower.x) - -56.1) < 0.2);
  CHECK(std::abs(upper.x - lower.x - 14.9) < 0.05);  // printed with one decimal
  CHECK(std::abs(-lower.y - 5.7) < 0.05);
  CHECK(zones_of_range == std::map<double, std::size_t>{{3.0, 16}, {6.0, 24}, {12.0, 28}});
}

TEST_CASE("every lens file has the catalogue's number of zones, symmetric about its middle", "[sensor]") {
  const std::map<std::string, std::size_t> zones{
      {"EKMC1601111", 64},  {"EKMC1603111", 92},  {"EKMC1604111", 68}, {"EKMC1606111", 128}, {"EKMC1607111", 32},
      {"EKMC1691111", 112}, {"EKMC1693111", 84},  {"AMN31111", 64},    {"AMN32111", 104},    {"AMN33111", 24},
      {"AMN34111", 80},     {"EKMC1605111", 104}, {"EKMB1101111", 64}, {"HC-SR501", 58},     {"AM312", 42},
      {"RTCGQ11LM", 58},    {"RTCGQ14LM", 58},    {"SML001", 58},      {"E1745", 58},        {"SNZB-03", 58}};
  CHECK(test::shipped_lenses().size() == zones.size());
  for (const auto& [id, count] : zones) {
    const SensorModelSpec model = io::read_sensor_model(sensors / (id + ".yaml"));
    INFO(id);
    CHECK(model.id == id);
    std::size_t found = 0;
    double lowest = 0.0;
    double highest = 0.0;
    for (const ClusterSpec& cluster : model.clusters) {
      int polarity = 0;
      for (const ZoneSpec& zone : cluster.zones) {
        polarity += zone.polarity;
        lowest = std::min(lowest, centre_of(zone).x);
        highest = std::max(highest, centre_of(zone).x);
      }
      CHECK(std::abs(polarity) == (cluster.zones.size() == 3 ? 1 : 0));
      found += cluster.zones.size();
    }
    CHECK(found == count);
    CHECK(std::abs(lowest + highest) < 0.015);
  }
}

TEST_CASE("the low-profile lens misses the zones at its outer corners", "[sensor]") {
  const SensorModelSpec model = io::read_sensor_model(sensors / "EKMC1607111.yaml");
  for (const ClusterSpec& cluster : model.clusters) {
    const bool corner = std::abs(cluster.centre.x) > 1.0 && std::abs(cluster.centre.y) > 1.0;
    CHECK(cluster.zones.size() == (corner ? 3 : 4));
    for (const ZoneSpec& zone : cluster.zones) {
      if (!corner) continue;
      const Vec2 out = glm::sign(cluster.centre) * (centre_of(zone) - cluster.centre);
      CHECK_FALSE((out.x > 0.0 && out.y > 0.0));
    }
  }
}

TEST_CASE("a facet whose outermost zone isn't one alone can't miss it", "[sensor]") {
  const auto facet = [](const std::string& x_m) {
    return "id: X\nplane_m: 2\nlayout: square\nsources: {plane_m: 'assumed: a', range_m: 'assumed: b', x_m: 'assumed: "
           "a', "
           "y_m: 'assumed: a', zone_side_m: 'assumed: a', missing: 'assumed: a'}\n"
           "facets:\n  - {x_m: " +
           x_m + ", y_m: 1, zone_side_m: 0.1, range_m: 3, missing: outer}\n";
  };
  CHECK(refusal_of_sensor(facet("0")).find("two are equally far off the axis") != std::string::npos);
  CHECK(model_of(facet("0.5")).clusters.front().zones.size() == 3);
}

TEST_CASE("zones may be written out by their corners", "[sensor]") {
  const auto model = model_of(
      "id: X\nplane_m: 2\nrange_m: 4\nsources: {plane_m: 'assumed: a', range_m: "
      "'assumed: b', corners_m: 'assumed: c'}\n"
      "clusters:\n  - zones:\n    - corners_m: [[0, 0], [1, 0], [1, 1], [0, 1]]\n"
      "    - {corners_m: [[2, 0], [3, 0], [3, 1], [2, 1]]}\n");
  REQUIRE(model.clusters.size() == 1);
  CHECK(model.clusters[0].zones.size() == 2);
  CHECK(model.clusters[0].range_m == 4.0);
  CHECK(model.clusters[0].centre == Vec2(1.5, 0.5));
  CHECK(model.clusters[0].zones[1].corners[2] == Vec2(3, 1));
}

namespace {

std::string dome_file(const std::string& dome) {
  std::string text = "id: X\nrange_m: 4\ndome: {" + dome + "}\nsources: {range_m: 'quoted: a'";
  for (const char* key : {"lenses", "wide_deg", "tall_deg", "focal_mm", "strip_width_mm", "gap_mm"}) {
    if (dome.find(key) != std::string::npos) text += std::string(", ") + key + ": 'quoted: a'";
  }
  return text + "}\n";
}

}  // namespace

TEST_CASE("who gives a ceiling detector's 360 degrees is shown the field of view across it, which is right",
          "[sensor]") {
  const auto told = [](const char* key) {
    try {
      static_cast<void>(model_of(dome_file(std::string(key) + ": 360")));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const char* key : {"wide_deg", "tall_deg"}) {
    CHECK_THAT(told(key),
               contains("360 degrees of a ceiling detector go round its axis") && contains("`wide_deg: 135`"));
  }
  CHECK(degrees(2.0 * std::atan(6.0 / 2.5)) == Approx(135.0).margin(0.5));  // 12 m in diameter at 2.5 m
  CHECK(told("focal_mm").find("360 degrees") == std::string::npos);
  CHECK_NOTHROW(model_of(dome_file("wide_deg: 135")));
}

TEST_CASE("a single lens of a dome throws the element's strips straight ahead, mirrored", "[sensor]") {
  const auto model = model_of(dome_file("lenses: 1, wide_deg: 90, focal_mm: 10"));
  REQUIRE(model.clusters.size() == 1);
  CHECK(model.plane_m == 1.0);
  CHECK(model.clusters[0].range_m == 4.0);
  REQUIRE(model.clusters[0].zones.size() == 2);
  for (const ZoneSpec& zone : model.clusters[0].zones) {
    // The strips lie 0.5 to 1.5 mm beside the middle and are 2 mm high; what lies right looks left.
    for (const Vec2& corner : zone.corners) {
      const double out = -zone.polarity * corner.x;
      CHECK((std::abs(out - 0.05) < 1e-12 || std::abs(out - 0.15) < 1e-12));
      CHECK(std::abs(std::abs(corner.y) - 0.1) < 1e-12);
    }
  }
}

TEST_CASE("a dome's zones end where its field of view does and left is as right", "[sensor]") {
  for (const int lenses : {3, 8, 21, 29, 30, 64}) {
    for (const double wide_deg : {60.0, 110.0, 170.0}) {
      const auto model = model_of(
          dome_file("lenses: " + std::to_string(lenses) + ", tall_deg: 50, wide_deg: " + std::to_string(wide_deg)));
      INFO(lenses << " lenses, " << wide_deg << " degrees");
      CHECK(model.clusters.size() == static_cast<std::size_t>(lenses));
      double left = 0.0, right = 0.0, top_deg = 0.0;
      for (const ClusterSpec& cluster : model.clusters) {
        for (const ZoneSpec& zone : cluster.zones) {
          for (const Vec2& corner : zone.corners) {
            left = std::min(left, corner.x);
            right = std::max(right, corner.x);
            top_deg = std::max(top_deg, std::atan(corner.y / std::hypot(1.0, corner.x)) * 180.0 / M_PI);
          }
        }
        const auto is_mirrored = [&](const ClusterSpec& other) {
          return glm::length(other.centre - Vec2(-cluster.centre.x, cluster.centre.y)) < 1e-9;
        };
        CHECK(std::ranges::any_of(model.clusters, is_mirrored));
      }
      const double edge = std::tan(wide_deg * M_PI / 360.0);
      CHECK(std::abs(right / edge - 1.0) < 1e-9);
      CHECK(std::abs(left / edge + 1.0) < 1e-9);
      CHECK(top_deg < 25.5);
      if (lenses > 8) CHECK(top_deg > 23.0);
    }
  }
}

TEST_CASE("a dome's numbers need sources, and make sense", "[sensor]") {
  CHECK(model_of(dome_file("")).clusters.size() == 29);
  CHECK(refusal_of_sensor(dome_file("lenses: 0, wide_deg: 90")).find("dome: lenses: expected") != std::string::npos);
  CHECK(refusal_of_sensor(dome_file("lenses: 9, wide_deg: 180")).find("dome: wide_deg: expected") != std::string::npos);
  CHECK(refusal_of_sensor("id: X\nrange_m: 4\ndome: {lenses: 9, wide_deg: 90}\n"
                          "sources: {range_m: 'quoted: a', lenses: 'quoted: a'}\n") ==
        "f:3:19: error: 'wide_deg' has no entry under 'sources'");
}

TEST_CASE("products are known by what they carry, however their names are spelt", "[sensor]") {
  const auto refusal = [](const std::string& model) -> std::string {
    try {
      static_cast<void>(io::find_sensor_model(model, {}));
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  CHECK(refusal("HC-SR501").empty());
  CHECK_THAT(refusal("ep1"), contains("sensor model 'ep1' is called 'EKMC1603111' here"));
  CHECK_THAT(refusal("everything-presence one"), contains("is called 'EKMC1603111' here"));
  CHECK_THAT(refusal("hc sr501"), contains("is called 'HC-SR501' here"));
  CHECK_THAT(refusal("EKMC1604112"), contains("did you mean 'EKMC1604111'?"));
}

TEST_CASE("faults of a sensor file are told with line and column", "[sensor]") {
  const std::string head =
      "id: X\nplane_m: 2\nsources: {plane_m: 'assumed: a', range_m: 'assumed: b', x_m: 'assumed: a', "
      "y_m: 'assumed: a', corners_m: 'assumed: c', zone_side_m: 'assumed: a', pitch_m: 'assumed: a'}\n";
  CHECK(refusal_of_sensor(head) == "f:1:1: error: sensor: expected one of 'facets', 'clusters' and 'dome'");
  CHECK(refusal_of_sensor(head +
                          "layout: square\nfacets:\n  - {x_m: 0, y_m: 0, zone_side_m: 1, pitch_m: 2, range: 3}\n") ==
        "f:6:50: error: facet: unknown key 'range' (did you mean 'range_m'?)");
  CHECK(refusal_of_sensor(head +
                          "layout: squere\nfacets:\n  - {x_m: 0, y_m: 0, zone_side_m: -1, pitch_m: 2, range_m: 3}\n") ==
        "f:4:9: error: sensor: layout: expected one of diamond, square, got 'squere' (did you mean 'square'?)\n"
        "f:6:35: error: facet: zone_side_m: expected a finite number >= 0.001 and <= 1000, got '-1'");
  CHECK(refusal_of_sensor(head +
                          "clusters:\n  - range_m: 1\n    zones: [corners_m: [[0, 0], [1, 1], [1, 0], [0, 1]]]\n") ==
        "f:6:24: error: zone: corners_m: expected the corners of a convex area in order round it");
  CHECK(refusal_of_sensor("id: X\nplane_m: 2\nsources: {}\nclusters:\n  - range_m: 1\n"
                          "    zones: [corners_m: [[0, 0], [1, 0], [1, 1], [0, 1]]]\n")
            .find("f:2:1: error: 'plane_m' has no entry under 'sources'") == 0);
  CHECK(refusal_of_sensor("id: X\nplane_m: 2\nsources: {plane_m: 'guess: 2'}\nclusters: []\n")
            .find("expected 'quoted:', 'measured:', 'inferred:', 'fitted:' or 'assumed:' in front") !=
        std::string::npos);
}

TEST_CASE("keys of another kind of sensor are refused where they stand", "[sensor]") {
  for (const auto& [model, line] :
       {std::pair{"EKMC1604111", "idle_share: 0.8"}, std::pair{"EKMC1604111", "netd_k: 0.1"},
        std::pair{"AMG8833", "idle_share: 0.8"}, std::pair{"AMG8833", "range_m: 5"},
        std::pair{"LIGHT-BARRIER", "rows: 8"}, std::pair{"LIGHT-BARRIER", "report: {hold_s: 3}"}}) {
    std::stringstream text;
    text << line << '\n' << std::ifstream(sensors / (std::string(model) + ".yaml")).rdbuf();
    CHECK(refusal_of_sensor(text.str()).find("f:1:") != std::string::npos);
  }
}

TEST_CASE("a square facet without a pitch has the quad's, 1.0 mm between squares of 0.6 mm", "[sensor]") {
  const TemporaryFolder folder;
  const auto zones = [&](const std::string& pitch) {
    const std::string text =
        "id: A\nplane_m: 2.5\nrange_m: 5\nlayout: square\nfacets:\n  - {x_m: 1, y_m: 2, zone_side_m: 0.3" + pitch +
        "}\nsources: {plane_m: 'assumed: a', range_m: 'assumed: a', x_m: 'assumed: a', y_m: 'assumed: a', zone_side_m: "
        "'assumed: a'" +
        (pitch.empty() ? "" : ", pitch_m: 'assumed: a'") + "}\n";
    return io::read_sensor_model(folder.write("A.yaml", text)).clusters.front().zones;
  };
  const auto by_rule = zones(""), as_written = zones(", pitch_m: 0.5");
  REQUIRE(by_rule.size() == 4);
  for (std::size_t zone = 0; zone < 4; ++zone) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      CHECK(glm::distance(by_rule[zone].corners[corner], as_written[zone].corners[corner]) < 1e-12);
    }
  }
  CHECK(zones(", pitch_m: 0.6").front().corners[0].x > by_rule.front().corners[0].x + 0.04);
}

TEST_CASE("a file's element, amplifier and comparator are read and what it leaves out keeps its default", "[sensor]") {
  const std::string zones =
      "id: X\nplane_m: 2\nrange_m: 4\nclusters:\n  - zones:\n    - corners_m: [[0, 0], [1, 0], [1, 1], [0, 1]]\n";
  const std::string sources = "sources: {plane_m: 'assumed: a', range_m: 'assumed: b', corners_m: 'assumed: c'";
  const auto model =
      model_of(zones +
               "element: {thermal_s: 0.5}\namplifier: {order: 3, volts_per_watt: 2e6}\n"
               "comparator: {pulse_count: 2, pulse_window_s: 3, pulse_signs: alternating}\nreport: {hold_s: 7}\n" +
               sources +
               ", thermal_s: 'assumed: d', order: 'assumed: e', volts_per_watt: 'measured: f', "
               "pulse_count: 'quoted: g', pulse_window_s: 'quoted: h', pulse_signs: 'quoted: i', "
               "hold_s: 'quoted: j'}\n");
  CHECK(model.detector.element.thermal_s == 0.5);
  CHECK(model.detector.element.electrical_s == ElementSpec{}.electrical_s);
  CHECK(model.detector.amplifier.order == 3);
  CHECK(model.detector.amplifier.volts_per_watt == 2e6);
  CHECK(model.detector.comparator.pulse_signs == PulseSigns::alternating);
  CHECK(model.detector.report.hold_s == 7.0);
  CHECK(model.detector.report.blind_s == 0.0);
  CHECK(refusal_of_sensor(zones + "element: {thermal_s: 0.5}\n" + sources + "}\n") ==
        "f:7:11: error: 'thermal_s' has no entry under 'sources'");
}

TEST_CASE("a file's rated targets and sensitivity are read, and refused for lens steps that it hasn't", "[sensor]") {
  const std::string zones =
      "id: X\nplane_m: 2\nrange_m: 4\nclusters:\n  - zones:\n    - corners_m: [[0, 0], [1, 0], [1, 1], [0, 1]]\n";
  const std::string sources =
      "sources: {plane_m: 'assumed: a', range_m: 'assumed: b', corners_m: 'assumed: c', median: 'quoted: d', "
      "sd: 'assumed: e', zones: 'quoted: f', width_m: 'quoted: g', lens_step: 'quoted: h'}\n";
  const std::string sensitivity = "sensitivity: {median: 1.36, sd: 0.1}\n";
  const auto model = model_of(zones + sources + sensitivity + "targets: [{zones: 1, width_m: 0.2}]\n");
  REQUIRE(model.targets.size() == 1);
  CHECK(model.targets[0].lens_step == 1);
  CHECK(model.targets[0].zones == 1);
  CHECK(model.targets[0].width_m == 0.2);
  CHECK(model.targets[0].height_m == RatedTargetSpec{}.height_m);
  CHECK(model.sensitivity.median == 1.36);
  CHECK(model.sensitivity.sd == 0.1);
  CHECK(model_of(zones + sources).sensitivity.median == 1.0);
  CHECK(refusal_of_sensor(zones + sources + sensitivity + "targets: [{lens_step: 2, zones: 1, width_m: 0.2}]\n") ==
        "f:9:10: error: targets: no facet is of lens step 2");
  CHECK(refusal_of_sensor(zones + sources + sensitivity + "targets: [{zones: 1, width_m: 0.2}, {zones: 2}]\n") ==
        "f:9:10: error: targets: lens step 1 has two targets");
  CHECK(refusal_of_sensor(zones + sources + sensitivity + "targets: [{zones: 3, width_m: 0.2}]\n") != "");
  CHECK(refusal_of_sensor(zones + "sources: {plane_m: 'assumed: a', range_m: 'assumed: b', corners_m: 'assumed: c'}\n" +
                          "targets: [{zones: 1}]\n") == "f:8:12: error: 'zones' has no entry under 'sources'");
}

TEST_CASE("detectors that could never work are refused with their place", "[sensor]") {
  const std::string zones =
      "id: X\nplane_m: 2\nrange_m: 4\nclusters:\n  - zones:\n    - corners_m: [[0, 0], [1, 0], [1, 1], [0, 1]]\n"
      "sources: {plane_m: 'assumed: a', range_m: 'assumed: b', corners_m: 'assumed: c', low_hz: 'assumed: d', "
      "high_hz: 'assumed: d', pulse_count: 'assumed: d', positive_v: 'assumed: d', offset_v: 'assumed: d'}\n";
  CHECK(refusal_of_sensor(zones + "amplifier: {low_hz: 3, high_hz: 2}\n") ==
        "f:8:33: error: amplifier: expected high_hz above low_hz");
  CHECK(refusal_of_sensor(zones + "amplifier: {offset_v: 0.2}\n") ==
        "f:8:23: error: amplifier: expected offset_v between lowest_v and highest_v");
  CHECK(refusal_of_sensor(zones + "comparator: {pulse_count: 2}\n") ==
        "f:8:27: error: comparator: several pulses need a pulse_window_s");
  CHECK(refusal_of_sensor(zones + "comparator: {positive_v: 0.8}\n") ==
        "f:8:13: error: comparator: the output saturates before it reaches a threshold");
  CHECK(refusal_of_sensor(zones + "report: {hold: 2}\n").find("hold_s") != std::string::npos);
  CHECK(refusal_of_sensor(zones + "comparator: {hold_s: 2}\n") ==
        "f:8:22: error: comparator: 'hold_s' stands under 'report' beside 'comparator'\n"
        "f:8:14: error: 'hold_s' has no entry under 'sources'");
}

TEST_CASE("a lens too small for directions is refused", "[sensor]") {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    const auto file = folder.write("tiny.yaml", text);
    try {
      static_cast<void>(io::read_sensor_model(file));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  std::ifstream shipped(sensors / "EKMC1604111.yaml");
  std::string text(std::istreambuf_iterator<char>(shipped), {});
  const std::size_t at = text.find("plane_m: ");
  REQUIRE(at != std::string::npos);
  text.replace(at, text.find_first_of(" \n#", at + 9) - at, "plane_m: 1e-200");
  CHECK_THAT(refusal(text), contains("plane_m"));
}
