// Frames of thermopile arrays against the solid-angle integral, closed forms and laws of noise; beams at a door.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <optional>

#include "engine/pir/optics.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/thermal_array.hpp"
#include "files/write/frame_writer.hpp"
#include "support/catch.hpp"
#include "support/door_scene.hpp"
#include "support/shipped.hpp"
#include "surveys/sight.hpp"

using namespace pirsim;
using pirsim::test::act;

namespace {

constexpr double room_c = 20.0, target_c = 35.0;

ArraySpec grid_eye(int rays_per_pixel) {
  ArraySpec spec = *io::read_sensor_model(test::data("sensors/AMG8833.yaml")).array;
  spec.rays_per_pixel = rays_per_pixel;
  return spec;
}

ArraySpec silent(ArraySpec spec) {
  spec.netd_k = spec.common_k = spec.offset_k = spec.column_k = spec.fixed_k = spec.step_k = 0.0;
  spec.dead_pixels = 0;
  return spec;
}

/// An array at the origin that looks along -Z at a wall 4 m ahead.
SceneSpec before_a_wall(const ArraySpec& spec) {
  SceneSpec scene;
  scene.name = "a wall";
  scene.meshes = {pirsim::testing::box_mesh({-50, -50, -4.1}, {50, 50, -4})};
  scene.floor = FloorArea({{{-3, -4}, {3, -4}, {3, 4}, {-3, 4}}}, -1.5);
  SensorModelSpec& model = scene.sensor_models["A"];
  model.id = "A";
  model.array = spec;
  scene.arrays = {SensorSpec{"A1", "A", Frame{}}};
  return scene;
}

SensingInForce sensing() {
  SensingInForce sensing;
  sensing.ambient_c = room_c;
  return sensing;
}

struct Eye {
  explicit Eye(const SceneSpec& scene)
      : room(scene.meshes), array(scene, 0, sensing(), 1, room, {}), powers(array.power().n_receivers(), 0) {}
  std::vector<double> empty() {
    std::vector<double> celsius(array.n_pixels());
    array.see(powers, celsius);
    return celsius;
  }
  /// Of one sphere as warm as the target.
  std::vector<double> seen(const PosedSphere& sphere) {
    sim::BodyRadiance radiance{};
    radiance.fill(pir::band_radiance(pir::kelvin(target_c), array.band()));
    sim::PowerMeter meter(array.power(), array.make_tracer(fastest_tracer), 0);
    const std::vector<PosedShape> solids{sphere};
    meter.measure(solids, radiance, powers);
    return empty();
  }
  rt::Room room;
  sim::ThermalArray array;
  std::vector<sim::PowerSteps> powers;
};

/// By brute force over a fine grid of angles, without rays, lattice or table: of each pixel the share of its response
/// that falls on the target, and the temperature of the black body that radiates as much.
std::vector<double> integral(const ArraySpec& spec, const std::function<bool(const Vec3&)>& hits, double step = 0.05) {
  const pir::Band band{spec.from_um, spec.to_um};
  const double cold = pir::band_radiance(pir::kelvin(room_c), band),
               warm = pir::band_radiance(pir::kelvin(target_c), band);
  const double sigma = *spec.pixel_deg / std::sqrt(8.0 * std::log(2.0)), end_deg = 89.0;
  const double end_x = 0.5 * spec.wide_deg + 2.0 * sigma, end_y = 0.5 * spec.tall_deg + 2.0 * sigma;  // of the response
  std::vector<double> celsius;
  for (int row = 0; row < spec.rows; ++row) {
    for (int column = 0; column < spec.columns; ++column) {
      const double x0 = (column - 0.5 * (spec.columns - 1)) * spec.wide_deg / spec.columns;
      const double y0 = (0.5 * (spec.rows - 1) - row) * spec.tall_deg / spec.rows;
      double all = 0.0, on_target = 0.0;
      for (double dx = -4.0 * sigma + 0.5 * step; dx < 4.0 * sigma; dx += step) {
        for (double dy = -4.0 * sigma + 0.5 * step; dy < 4.0 * sigma; dy += step) {
          const double x = radians(x0 + dx), y = radians(y0 + dy), off = std::hypot(x, y);
          if (std::abs(x0 + dx) > end_x || std::abs(y0 + dy) > end_y || off > radians(end_deg)) continue;
          const double weight = std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma)) * std::sin(off) / off;
          all += weight;
          if (hits({std::sin(off) * x / off, std::sin(off) * y / off, -std::cos(off)})) on_target += weight;
        }
      }
      const double radiance = cold + (warm - cold) * on_target / all;
      double low = room_c - 1.0, high = target_c + 1.0;
      for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        (pir::band_radiance(pir::kelvin(middle), band) < radiance ? low : high) = middle;
      }
      celsius.push_back(low);
    }
  }
  return celsius;
}

double farthest(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

double rms(const std::vector<float>& values, const std::function<bool(std::size_t)>& counts = {}) {
  double sum = 0.0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (counts && !counts(i)) continue;
    sum += std::pow(static_cast<double>(values[i]) - room_c, 2);
    ++n;
  }
  return std::sqrt(sum / static_cast<double>(n));
}

}  // namespace

TEST_CASE("a band's radiance goes with the published powers of the temperature, and is inverted", "[sim][array]") {
  for (const auto& [band, power] : {std::pair{pir::Band{8.0, 14.0}, 4.6}, std::pair{pir::Band{5.5, 14.0}, 5.2}}) {
    const double slope =
        std::log(pir::band_radiance(301.0, band) / pir::band_radiance(299.0, band)) / std::log(301.0 / 299.0);
    CHECK(slope == Approx(power).margin(0.1));
    const pir::Thermometer thermometer(band);
    for (double celsius = -60.0; celsius < 320.0; celsius += 0.7) {
      REQUIRE(std::abs(thermometer.celsius(pir::band_radiance(pir::kelvin(celsius), band)) - celsius) < 1e-4);
    }
  }
}

TEST_CASE("a warm plate before a wall: every pixel within 1 % of the solid-angle integral", "[sim][array][seconds]") {
  const ArraySpec spec = silent(grid_eye(1500));
  SceneSpec scene = before_a_wall(spec);
  const Vec3 low(-0.9, -0.2, -3.01), high(0.35, 0.75, -3.0);
  scene.meshes.push_back(pirsim::testing::box_mesh(low, high));
  scene.meshes.back().temperature_c = target_c;
  const std::vector<double> seen = Eye(scene).empty();
  const auto of_plate = [&](double aside) {
    return integral(spec, [&](const Vec3& d) {
      const Vec3 at = d * (high.z / d.z);
      return at.x - aside > low.x && at.x - aside < high.x && at.y > low.y && at.y < high.y;
    });
  };
  CHECK(farthest(seen, of_plate(0.0)) < 0.01 * (target_c - room_c));
  CHECK(farthest(seen, of_plate(0.02)) > 0.01 * (target_c - room_c));  // 2 cm aside would be noticed
  CHECK(*std::ranges::max_element(seen) > 30.0);
  CHECK(seen[7] == Approx(room_c).margin(0.05));  // the upper right corner, which the plate doesn't reach
  CHECK(seen[8 * 3 + 2] > seen[8 * 3 + 5]);       // it lies to the left
  CHECK(seen[8 * 2 + 3] > seen[8 * 5 + 3]);       // and above the middle
}

TEST_CASE("a warm sphere: pixels by the integral, and their sum by the closed form of its solid angle",
          "[sim][array][seconds]") {
  const ArraySpec spec = silent(grid_eye(1500));
  Eye eye(before_a_wall(spec));
  const Vec3 middle(0.15, -0.1, -2.0);
  for (const double radius : {0.12, 0.55}) {
    const std::vector<double> seen = eye.seen({Vec3f(middle), static_cast<float>(radius)});
    const double cosine = std::sqrt(1.0 - std::pow(radius / glm::length(middle), 2));
    const auto expected = integral(spec, [&](const Vec3& d) { return glm::dot(d, glm::normalize(middle)) > cosine; });
    INFO(radius);
    CHECK(farthest(seen, expected) < 0.01 * (*std::ranges::max_element(expected) - room_c));
    double sum = 0.0;  // of radiance times the pixels' own squares of the image
    const double pixel_sr = std::pow(radians(*spec.pixel_deg), 2);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const double off = radians(7.5 * std::hypot(static_cast<double>(i % 8) - 3.5, static_cast<double>(i / 8) - 3.5));
      sum += (pir::band_radiance(pir::kelvin(seen[i]), eye.array.band()) -
              pir::band_radiance(pir::kelvin(room_c), eye.array.band())) *
             pixel_sr * std::sin(off) / off;
    }
    const double closed = 2.0 * pi * (1.0 - cosine) *
                          (pir::band_radiance(pir::kelvin(target_c), eye.array.band()) -
                           pir::band_radiance(pir::kelvin(room_c), eye.array.band()));
    // A sphere as small as a pixel meets the ripple of their sum, 2 exp(-2 pi^2 0.425^2) = 5.7 % an axis.
    CHECK(sum == Approx(closed).epsilon(radius > 0.5 ? 0.01 : 0.12));
  }
}

TEST_CASE("wide pixels weigh directions by their solid angle", "[sim][array]") {
  ArraySpec spec = silent(grid_eye(4000));
  spec.rows = spec.columns = 2;
  spec.wide_deg = spec.tall_deg = 100.0;
  spec.pixel_deg = 50.0;
  const double off = radians(60.0), radius = 0.6, aside = std::sqrt(0.5) * std::sin(off);
  const Vec3 middle = 2.0 * Vec3(aside, aside, -std::cos(off));
  const std::vector<double> seen = Eye(before_a_wall(spec)).seen({Vec3f(middle), static_cast<float>(radius)});
  const double cosine = std::sqrt(1.0 - std::pow(radius / 2.0, 2));
  const auto expected = integral(
      spec, [&](const Vec3& d) { return glm::dot(d, glm::normalize(middle)) > cosine; }, 0.2);
  CHECK(farthest(seen, expected) < 0.01 * (*std::ranges::max_element(expected) - room_c));
}

TEST_CASE("with the shipped number of rays a head is right to a tenth of its contrast", "[sim][array]") {
  const ArraySpec usual = silent(grid_eye(24)), fine = silent(grid_eye(600));
  Eye eye(before_a_wall(usual)), exact(before_a_wall(fine));
  double squares = 0.0;
  constexpr int n_heads = 10;
  for (int i = 0; i < n_heads; ++i) {
    const PosedSphere head{Vec3f(-0.8 + 0.16 * i, 0.5 - 0.1 * i, -2.0), 0.11F};
    const std::vector<double> by_few = eye.seen(head), by_many = exact.seen(head);
    const double off = farthest(by_few, by_many) / (*std::ranges::max_element(by_many) - room_c);
    squares += off * off / n_heads;
  }
  INFO("worst pixel, of the contrast: " << std::sqrt(squares));
  CHECK(std::sqrt(squares) < 0.13);  // 0.11; docs/physics/arrays.md tells it
}

TEST_CASE("noise grows as the root of the rate, and to the corners", "[sim][array]") {
  constexpr int n_frames = 400;
  for (const double rate_hz : {1.0, 4.0, 10.0}) {
    ArraySpec spec = silent(grid_eye(1));
    spec.netd_k = 0.05;
    spec.rate_hz = rate_hz;
    const Eye eye(before_a_wall(spec));
    const std::vector<double> celsius(64, room_c);
    std::vector<float> all, frame(64);
    for (int i = 1; i <= n_frames; ++i) {
      eye.array.read(celsius, 0, i, sim::ThermalArray::Pages::due, frame);
      all.insert(all.end(), frame.begin(), frame.end());
    }
    const double expected = 0.05 * std::sqrt(rate_hz), error = expected / std::sqrt(2.0 * 64 * n_frames);
    CHECK(std::abs(rms(all) - expected) < 4.0 * error);                 // one standard error: 0.44 %
    if (rate_hz > 1.0) CHECK(std::abs(rms(all) - 0.05) > 4.0 * error);  // the NETD of 1 Hz at this rate
  }
  ArraySpec melexis = *io::read_sensor_model(test::data("sensors/MLX90640-BAA.yaml")).array;
  ArraySpec spec = silent(melexis);
  spec.netd_k = melexis.netd_k;
  spec.rate_hz = 16.0;
  spec.sub_pages = 1;
  const Eye eye(before_a_wall(spec));
  const std::vector<double> celsius(768, room_c);
  std::vector<float> all, frame(768);
  for (int i = 1; i <= n_frames; ++i) {
    eye.array.read(celsius, 0, i, sim::ThermalArray::Pages::due, frame);
    all.insert(all.end(), frame.begin(), frame.end());
  }
  const auto at = [](std::size_t pixel) { return [pixel](std::size_t i) { return i % 768 == pixel; }; };
  CHECK(rms(all, at(12 * 32 + 16)) == Approx(0.28).epsilon(0.15));  // measured on public frames; 3.5 % is an error
  CHECK(rms(all, at(0)) == Approx(0.84).epsilon(0.15));
  std::vector<double> sizes;
  for (std::size_t pixel = 0; pixel < 768; ++pixel) sizes.push_back(rms(all, at(pixel)));
  std::ranges::sort(sizes);
  CHECK(sizes[384] == Approx(0.39).epsilon(0.25));  // in the median
}

TEST_CASE("noise is normal, and of pixels, frames, runs and arrays of their own", "[sim][array]") {
  ArraySpec spec = silent(grid_eye(1));
  spec.netd_k = 1.0;
  spec.rate_hz = 1.0;
  SceneSpec scene = before_a_wall(spec);
  scene.arrays.push_back(scene.arrays.front());
  scene.arrays.back().id = "A2";
  const Eye eye(scene);
  const sim::ThermalArray other(scene, 1, sensing(), 1, eye.room, {});
  constexpr int n_frames = 1000, n = 64 * n_frames;
  const std::vector<double> celsius(64, room_c);
  const auto series = [&](const sim::ThermalArray& array, std::uint32_t run) {
    std::vector<float> all(n);
    for (int i = 0; i < n_frames; ++i)
      array.read(celsius, run, i + 1, sim::ThermalArray::Pages::all, std::span(all).subspan(64U * i, 64));
    return all;
  };
  const std::vector<float> noise = series(eye.array, 0);
  const auto z = [](float value) { return static_cast<double>(value) - room_c; };
  for (const double limit : {0.5, 1.0, 2.0, 3.0}) {
    const double share = std::erfc(limit / std::sqrt(2.0)), error = std::sqrt(share * (1.0 - share) / n);
    const auto beyond = std::ranges::count_if(noise, [&](float value) { return std::abs(z(value)) > limit; });
    CHECK(std::abs(static_cast<double>(beyond) / n - share) < 4.0 * error);  // one: 0.2 % at 0.5, 7.6 % at 3
  }
  const auto correlation = [&](const std::vector<float>& b, std::size_t lag) {
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < n; ++i) sum += z(noise[i]) * z(b[i + lag]) / n;
    return sum * std::sqrt(n);  // in standard errors
  };
  for (const std::size_t lag : {1U, 2U, 7U, 8U, 63U, 64U, 65U}) CHECK(std::abs(correlation(noise, lag)) < 4.0);
  CHECK(std::abs(correlation(series(eye.array, 1), 0)) < 4.0);
  CHECK(std::abs(correlation(series(other, 0), 0)) < 4.0);
  CHECK(correlation(series(eye.array, 0), 0) > 200.0);
  spec = silent(spec);
  spec.common_k = 0.5;
  spec.rate_hz = 4.0;
  const Eye together(before_a_wall(spec));
  const std::vector<float> shared = series(together.array, 0);
  for (std::size_t i = 0; i < n; ++i) REQUIRE(shared[i] == shared[i / 64 * 64]);
  CHECK(rms(shared) == Approx(1.0).epsilon(0.09));  // 0.5 K times the root of 4; 2.2 % is an error
}

TEST_CASE("an array put before another doesn't change its noise, another name does", "[sim][array]") {
  ArraySpec spec = grid_eye(1);
  spec.netd_k = spec.offset_k = 1.0;
  const SceneSpec alone = before_a_wall(spec);
  SceneSpec second = alone, renamed = alone;
  second.arrays.insert(second.arrays.begin(), alone.arrays.front());
  second.arrays.front().id = "before";
  renamed.arrays.front().id = "other";
  const rt::Room room(alone.meshes);
  const std::vector<double> celsius(64, room_c);
  const auto frame = [&](const SceneSpec& scene, std::size_t index) {
    std::vector<float> frame(64);
    const sim::ThermalArray array(scene, index, sensing(), 1, room, {});
    array.read(celsius, 3, 77, sim::ThermalArray::Pages::all, frame);
    return frame;
  };
  CHECK(frame(second, 1) == frame(alone, 0));
  CHECK(frame(second, 0) != frame(alone, 0));
  CHECK(frame(renamed, 0) != frame(alone, 0));
}

TEST_CASE("files of frames have different names for different arrays, trials and replicates", "[sim][array]") {
  const std::vector<std::string> names{"A",
                                       "A_B",
                                       "B_C",
                                       "C",
                                       "B",
                                       "A_",
                                       "_B",
                                       "/",
                                       "%2F",
                                       "%",
                                       "..",
                                       ".",
                                       "",
                                       "a b",
                                       "A_B_C",
                                       "A%5FB",
                                       "ä",
                                       "*",
                                       "\\",
                                       ":",
                                       std::string(300, 'x'),
                                       std::string(301, 'x'),
                                       std::string(300, 'x') + "y"};
  std::map<std::string, std::array<std::string, 2>> files;
  for (const std::string& array : names) {
    for (const std::string& trial : names) {
      for (const int replicate : {1, 11}) {
        const std::string file = io::frame_file(array, trial, replicate);
        CAPTURE(array, trial, file);
        const auto [at, is_new] = files.emplace(file, std::array{array, trial + '/' + std::to_string(replicate)});
        CHECK(is_new);
        CHECK(std::filesystem::path(file).filename() == file);
        CHECK(file.size() <= 255);
      }
    }
  }
  CHECK(io::frame_file("A1", "S3", 2) == "A1_S3_2.npy");
  CHECK(io::frame_file("ARRAY1", "day_1", 2) == "ARRAY1_day_1_2.npy");
}

TEST_CASE("what a unit always adds has its sizes over units, and is the same in all runs", "[sim][array]") {
  ArraySpec spec = silent(grid_eye(1));
  spec.offset_k = 0.8;
  spec.column_k = 0.4;
  spec.fixed_k = 0.2;
  const SceneSpec scene = before_a_wall(spec);
  const rt::Room room(scene.meshes);
  const std::vector<double> celsius(64, room_c);
  constexpr int n_units = 200;
  double all = 0.0, columns = 0.0, rest = 0.0;  // mean squares
  for (int unit = 1; unit <= n_units; ++unit) {
    const sim::ThermalArray array(scene, 0, sensing(), static_cast<std::uint64_t>(unit), room, {});
    std::vector<float> frame(64), later(64);
    array.read(celsius, 0, 1, sim::ThermalArray::Pages::all, frame);
    array.read(celsius, 3, 77, sim::ThermalArray::Pages::all, later);
    REQUIRE(frame == later);
    std::array<double, 8> of_column{};
    for (std::size_t i = 0; i < 64; ++i) of_column[i % 8] += (static_cast<double>(frame[i]) - room_c) / 8.0;
    double mean = 0.0;
    for (const double column : of_column) mean += column / 8.0;
    all += mean * mean / n_units;
    for (const double column : of_column) columns += std::pow(column - mean, 2) / 7.0 / n_units;
    for (std::size_t i = 0; i < 64; ++i)
      rest += std::pow(static_cast<double>(frame[i]) - room_c - of_column[i % 8], 2) / 56.0 / n_units;
  }
  // Standard errors of these roots: 5.0, 1.9 and 0.7 %.
  CHECK(std::sqrt(all) == Approx(std::sqrt(0.64 + 0.16 / 8 + 0.04 / 64)).epsilon(0.20));
  CHECK(std::sqrt(columns) == Approx(std::sqrt(0.16 + 0.04 / 8)).epsilon(0.076));
  CHECK(std::sqrt(rest) == Approx(0.2).epsilon(0.027));
}

TEST_CASE("a stack is a NumPy file, and a dead pixel an empty field", "[sim][array]") {
  const float dead = std::numeric_limits<float>::quiet_NaN();
  const FrameStack frames{
      2, 3, {0.5, 1.0}, {1.0F, dead, 3.0F, 4.0F, 5.0F, 6.25F, 7.0F, 8.0F, 9.0F, 10.0F, 11.0F, 1.5F}};
  const std::string bytes = io::to_npy(frames);
  CHECK(bytes.starts_with(std::string("\x93NUMPY\x01\0", 8)));
  CHECK(bytes.find("'<f4', 'fortran_order': False, 'shape': (2, 2, 3)") != std::string::npos);
  CHECK((bytes.size() - 12 * 4) % 64 == 0);
  CHECK(bytes.ends_with(std::string("\0\0\xC0\x3F", 4)));  // 1.5
  CHECK(io::frame_to_csv(frames, 0.99) == "1.00,,3.00\n4.00,5.00,6.25\n");
  CHECK(io::frame_to_csv(frames, 1.0).starts_with("7.00,"));
  CHECK(io::frame_to_csv(frames, 0.49).empty());
}

namespace {

SceneSpec room_with(const std::string& model, const Frame& frame) {
  SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  scene.sensor_models.emplace(model, io::read_sensor_model(test::data("sensors/" + model + ".yaml")));
  scene.arrays = {SensorSpec{"A1", model, frame}};
  return scene;
}
Frame below_ceiling(double x, double z) { return {glm::angleAxis(radians(-90.0), Vec3(1, 0, 0)), Vec3(x, 2.6, z)}; }

RunResult frames_of(const SceneSpec& scene, const ScriptSpec& script, std::uint32_t run = 0,
                    TracerKind kind = fastest_tracer) {
  return run_once(compile(scene, script, {kind}), run, Record::samples, Trace::none, Occupants::counted, Frames::taken);
}

ScriptSpec walker() {
  return test::script_of(
      {test::person("p", {act(action::Appear{{1.0, -0.6}, 0.0}), act(action::Walk{{{2.2, -3.6}, {5.5, -3.6}}})})});
}

}  // namespace

TEST_CASE("half of the frame is renewed at a time, as the squares of a chess board", "[sim][array]") {
  SceneSpec scene = room_with("MLX90640-BAA", below_ceiling(2.0, -2.0));
  ScriptSpec script = walker();
  script.sensing.frame_rate_hz = 8.0;
  const FrameStack frames = frames_of(scene, script).frames.front();
  REQUIRE(frames.times_s.size() > 20);
  CHECK(frames.times_s[7] == 1.0);
  CHECK(frames.times_s[2] == 0.38);  // of 0.375 s the nearest tick
  for (std::size_t pixel = 0; pixel < 768; ++pixel) REQUIRE(frames.celsius[pixel] > 15.0F);  // the first one is whole
  for (std::size_t k = 1; k < frames.times_s.size(); ++k) {
    std::size_t n_new = 0;
    for (std::size_t pixel = 0; pixel < 768; ++pixel) {
      if (frames.celsius[k * 768 + pixel] == frames.celsius[(k - 1) * 768 + pixel]) continue;
      ++n_new;
      REQUIRE((pixel / 32 + pixel % 32 + k + 1) % 2 == 0);
    }
    REQUIRE(n_new > 380);
  }
}

TEST_CASE("all tracers, threads and parts of a study give the same frames, and arrays change no row",
          "[sim][array][seconds]") {
  const SceneSpec scene = room_with("AMG8833", below_ceiling(2.0, -2.0));
  SceneSpec plain = scene;
  plain.arrays.clear();
  ScriptSpec script = walker();
  script.replicates = 4;
  const Model model = compile(scene, script);
  std::map<unsigned, std::vector<RunResult>> results;
  for (const unsigned threads : {1U, 2U}) {
    StudyOptions options{.threads = threads};
    options.frames = Frames::taken;
    run_study(model, options, [&](const RunResult& result) { results[threads].push_back(result); });
  }
  for (std::uint32_t run = 0; run < 4; ++run) {
    const FrameStack& frames = results[1][run].frames.front();
    CHECK(frames.celsius == results[2][run].frames.front().celsius);
    CHECK(frames.celsius == frames_of(scene, script, run).frames.front().celsius);
    CHECK(frames.celsius != results[1][(run + 1) % 4].frames.front().celsius);  // noise of its own
    CHECK(results[1][run].samples == run_once(compile(plain, script), run).samples);
  }
  for (const TracerKind kind : {TracerKind::reference, TracerKind::embree})
    CHECK(frames_of(scene, script, 0, kind).frames.front().celsius == results[1][0].frames.front().celsius);
  const float hottest = *std::ranges::max_element(results[1][0].frames.front().celsius);
  CHECK(hottest > 24.0F);  // the walker; the room has 23 degC
}

TEST_CASE("who sits still for ten minutes stays visible to an array, and not to a PIR sensor",
          "[sim][array][seconds]") {
  SceneSpec scene = room_with("AMG8833", Frame{});
  const SeatSpec& seat = scene.seats.front();
  scene.arrays.front().world_from_sensor = below_ceiling(seat.world_from_seat.origin.x, seat.world_from_seat.origin.z);
  ScriptSpec script = test::script_of({test::person(
      "p", {act(action::Enter{scene.entrances.front().id}), act(action::Sit{seat.id}), act(action::Wait{640.0})})});
  script.sensing.response = Response::analog;
  script.sensing.frame_rate_hz = 1.0;
  script.sensing.tick_rate_hz = script.sensing.ticks_per_window = 20;
  const RunResult result = frames_of(scene, script);
  const FrameStack& frames = result.frames.front();
  const auto contrast = [&](std::size_t from, std::size_t to) {  // of the pixel with most, over the empty first second
    std::vector<double> sums(64, 0.0);
    for (std::size_t k = from; k < to; ++k) {
      for (std::size_t p = 0; p < 64; ++p)
        sums[p] += (static_cast<double>(frames.celsius[k * 64 + p]) - static_cast<double>(frames.celsius[p])) /
                   static_cast<double>(to - from);
    }
    return *std::ranges::max_element(sums);
  };
  const std::size_t n = frames.times_s.size();
  REQUIRE(n > 620);
  const double soon = contrast(40, 100), late = contrast(n - 60, n);
  INFO("seated, K: " << soon << " soon, " << late << " ten minutes later");
  CHECK(soon > 1.0);
  CHECK(std::abs(late - soon) < 0.2);  // steps of 0.25 K, a noise of 0.05 K, sixty frames
  int seconds_with_motion = 0, last_minute = 0;
  for (std::size_t i = 0; i < result.samples.size(); ++i) {
    const bool motion = std::ranges::any_of(result.samples[i].bits, [](std::uint8_t bit) { return bit != 0; });
    seconds_with_motion += motion ? 1 : 0;
    last_minute += motion && i + 60 >= result.samples.size() ? 1 : 0;
  }
  CHECK(seconds_with_motion > 0);
  CHECK(last_minute == 0);
}

TEST_CASE("who has gone isn't seen any more, whoever else moves", "[sim][array]") {
  SceneSpec scene = room_with("MLX90640-BAB", below_ceiling(2.0, -2.0));
  SensorModelSpec& model = scene.sensor_models.at("MLX90640-BAB");
  model.array = silent(*model.array);
  model.array->sub_pages = 1;
  const FrameStack frames =
      frames_of(scene, test::script_of(
                           {test::person("seen", {act(action::Follow{{0.0, 1.0}, {{2.0, -2.0}, {2.1, -2.0}}, {}})}),
                            test::person("aside", {act(action::Follow{{0.0, 3.0}, {{6.0, -1.0}, {6.0, -3.0}}, {}})})}))
          .frames.front();
  const auto hottest = [&](std::size_t frame) {
    return static_cast<double>(std::ranges::max(std::span(frames.celsius).subspan(768 * frame, 768)));
  };
  CHECK(hottest(2) > 25.0);
  CHECK(hottest(6) == Approx(23.0).margin(0.001));
}

TEST_CASE("a shut door hides who stands behind it", "[sim][array]") {
  const auto hottest = [](DoorState state) {
    SceneSpec scene = test::two_rooms({test::inner_door(state)});
    SensorModelSpec& model = scene.sensor_models["AMG8833"];
    model = io::read_sensor_model(test::data("sensors/AMG8833.yaml"));
    model.array = silent(*model.array);
    scene.arrays = {SensorSpec{"A1", "AMG8833", scene.sensors.front().world_from_sensor}};  // looks at the opening
    const ScriptSpec script =
        test::script_of({test::person("p", {act(action::Appear{{1.5, 0.0}, 0.0}), act(action::Wait{2.0})})});
    return static_cast<double>(std::ranges::max(frames_of(scene, script).frames.front().celsius));
  };
  CHECK(hottest(DoorState::open) > 23.5);
  CHECK(hottest(DoorState::shut) == Approx(23.0).margin(0.001));
}

TEST_CASE("what check says of arrays follows their field and noise", "[sim][array]") {
  const auto remarks = [](const SceneSpec& scene) {
    const Model model = compile(scene, walker());
    return std::pair{studies::look_around(model), studies::warnings(studies::look_around(model), scene)};
  };
  SceneSpec scene = room_with("MLX90640-BAB", below_ceiling(3.5, -2.0));
  scene.sensors.clear();
  const auto [report, none] = remarks(scene);
  const SensorSight& sight = report.sensors.back();
  // 55 x 35 degrees from 2.6 m above the floor are 2.7 x 1.6 m there; a body reaches half a metre aside, a head is seen
  // only in less.
  const double seen_m2 = static_cast<double>(sight.places) * std::pow(report.spacing_m, 2);
  CHECK(seen_m2 > 0.5 * 2.7 * 1.6);
  CHECK(seen_m2 < (2.7 + 1.0) * (1.6 + 1.0));
  CHECK(sight.about.starts_with("32 x 24 pixels, noise 0.14 K in the middle"));  // 0.1 K, root of 4 Hz, 0.7
  double least_k = 0.0, most_k = 0.0;
  REQUIRE(std::sscanf(sight.about.c_str(), "%*[^;]; %*[^0-9]%lf to %lf K", &least_k, &most_k) == 2);
  CHECK(least_k >= 0.42);  // three times the noise in the middle
  CHECK(most_k > least_k + 1.0);
  CHECK(most_k < 12.0);  // bare skin has 34 degC, the room 23
  CHECK(none.empty());
  scene.sensor_models.at("MLX90640-BAB").array->netd_k = 50.0;
  const auto [blind, warned] = remarks(scene);
  CHECK(blind.sensors.back().sees_nothing());
  CHECK(warned.size() == 1);
  CHECK(sim::ArrayWatch::Contrast{1.0, 3.0}.is_seen());
  CHECK_FALSE(sim::ArrayWatch::Contrast{1.0, 2.9}.is_seen());
}

TEST_CASE("an array refuses what it can't do", "[sim][array]") {
  SceneSpec scene = room_with("AMG8833", below_ceiling(2.0, -2.0));
  ScriptSpec script = walker();
  script.sensing.tick_rate_hz = script.sensing.ticks_per_window = 5;
  CHECK_THROWS_WITH(compile(scene, script), contains("more frames a second than there are ticks (5)"));
  std::swap(scene.arrays, scene.sensors);
  CHECK_THROWS_WITH(compile(scene, walker()), contains("'AMG8833' is an array: it belongs into scene.arrays"));
}

TEST_CASE("what a kind of sensor hasn't is refused", "[sim][array][beam]") {
  struct Kind {
    std::string model, whose;
    std::vector<std::string> hasnt;
  };
  const SensorModelSpec other = io::read_sensor_model(test::data("sensors/EKMC1604111.yaml"));
  const std::map<std::string, std::function<void(SensorModelSpec&)>> sets{
      {"idle_share", [](SensorModelSpec& m) { m.idle_share = 0.5; }},
      {"plane_m", [](SensorModelSpec& m) { m.plane_m = 3.0; }},
      {"clusters", [&](SensorModelSpec& m) { m.clusters = other.clusters; }},
      {"optics", [](SensorModelSpec& m) { m.optics.blur_deg += 1.0; }},
      {"sensitivity", [](SensorModelSpec& m) { m.sensitivity.sd = 0.1; }},
      {"detector", [](SensorModelSpec& m) { m.detector.report.hold_s = 3.0; }}};
  for (const auto& [name, whose, hasnt] :
       {Kind{"AMG8833", "a thermal array", {"idle_share", "plane_m", "clusters", "optics", "sensitivity", "detector"}},
        Kind{"LIGHT-BARRIER", "a beam", {"optics", "sensitivity", "detector"}},
        Kind{"EKMC1604111", "a PIR sensor", {"idle_share"}}}) {
    for (const auto& [field, set] : sets) {
      SceneSpec scene = test::shipped_scene("meeting_room.gltf");
      SensorModelSpec& model = scene.sensor_models[name] =
          io::read_sensor_model(test::data("sensors/" + name + ".yaml"));
      CHECK_NOTHROW(compile(scene, walker()));
      set(model);
      INFO(name << " " << field);
      if (std::ranges::find(hasnt, field) == hasnt.end()) {
        CHECK_NOTHROW(compile(scene, walker()));
      } else {
        CHECK_THROWS_WITH(compile(scene, walker()), contains(field + ": is set, which " + whose + " doesn't have"));
      }
    }
  }
}

namespace {

/// Two light barriers in the opening of the entrance, 6 cm apart, at the height of the chest; the first one is outside.
SceneSpec with_barriers(std::vector<DoorSpec> doors = {}) {
  SceneSpec scene = test::two_rooms(std::move(doors));
  scene.sensors.clear();
  scene.sensor_models.emplace("LIGHT-BARRIER", io::read_sensor_model(test::data("sensors/LIGHT-BARRIER.yaml")));
  const Quat across = glm::angleAxis(radians(180.0), Vec3(0, 1, 0));  // towards +Z
  for (const auto& [id, x] : {std::pair{"outer", -0.03}, std::pair{"inner", 0.03}})
    scene.sensors.push_back({id, "LIGHT-BARRIER", {across, Vec3(x, 1.4, -0.44)}});
  return scene;
}

/// Who breaks the outer one first, and leaves the inner one last, has come in; by single ticks.
struct DoorCounter {
  int ins = 0, outs = 0;
  void see(std::uint8_t outer, std::uint8_t inner) {
    const int now = outer + 2 * inner;
    if (now == last_) return;
    if (last_ == 0) first_ = now;
    if (now == 0) {
      ins += first_ == 1 && last_ == 2 ? 1 : 0;
      outs += first_ == 2 && last_ == 1 ? 1 : 0;
    }
    last_ = now;
  }

 private:
  int first_ = 0, last_ = 0;
};

ScriptSpec visitors() {
  std::vector<PersonSpec> people;
  int i = 0;
  for (const auto& [comes_s, goes_s] : {std::pair{0.0, 30.0}, std::pair{8.0, 60.0}, std::pair{16.0, 45.0}}) {
    const double z = -1.0 + i;
    people.push_back(test::person("p" + std::to_string(++i),
                                  {test::act_at(comes_s, action::Enter{"in"}), act(action::Walk{{{2.0, z}}}),
                                   test::act_at(goes_s, action::Leave{"in"})}));
  }
  ScriptSpec script = test::script_of(people);
  script.sensing.ticks_per_window = 1;
  return script;
}

}  // namespace

TEST_CASE("ins less outs are the people inside, where everybody passes the door singly", "[sim][beam]") {
  const Model model = compile(with_barriers(), visitors());
  const RunResult result = run_once(model, 0);
  DoorCounter counter;
  for (const Sample& row : result.samples) {
    counter.see(row.bits[0], row.bits[1]);
    for (const double asked_s : {6.0, 14.0, 26.0, 29.5, 40.0, 55.0})
      if (std::abs(row.time_s - asked_s) < 1e-9) CHECK(counter.ins - counter.outs == row.people);
  }
  CHECK(counter.ins == 3);
  CHECK(counter.outs == 3);
  // Who stands in the beams is there for as long: no change is needed.
  ScriptSpec script =
      test::script_of({test::person("p", {act(action::Appear{{0.0, 0.0}, 0.0}), act(action::Wait{5.0})})});
  const RunResult lingering = run_once(compile(with_barriers(), script), 0);
  CHECK(std::ranges::all_of(lingering.samples, [](const Sample& row) { return row.bits[0] == 1 && row.bits[1] == 1; }));
  // A script's response leaves beams as they are.
  script.sensing.response = Response::analog;
  CHECK(run_once(compile(with_barriers(), script), 0).samples == lingering.samples);
}

TEST_CASE("check doesn't warn of beams, which cross a door and not the floor", "[sim][beam]") {
  const Model model = compile(with_barriers(), visitors());
  const std::vector<Issue> told = studies::warnings(studies::look_around(model), model.scene());
  INFO((told.empty() ? "" : told.front().message));
  CHECK(told.empty());
  const std::string text = check_study(model).text;
  CHECK_THAT(text, contains("a beam: on while somebody or a leaf is in it") && !contains("NOBODY"));
}

TEST_CASE("all tracers break beams alike, and two abreast are one", "[sim][beam]") {
  const ScriptSpec script = visitors();
  const RunResult by_direct = run_once(compile(with_barriers(), script), 0);
  for (const TracerKind kind : {TracerKind::reference, TracerKind::embree})
    CHECK(run_once(compile(with_barriers(), script, {kind}), 0).samples == by_direct.samples);
  ScriptSpec abreast =
      test::script_of({test::person("a", {act(action::Follow{{0.0, 3.0}, {{-1.5, 0.2}, {1.5, 0.2}}, {}})}),
                       test::person("b", {act(action::Follow{{0.0, 3.0}, {{-1.5, -0.2}, {1.5, -0.2}}, {}})})});
  abreast.sensing.ticks_per_window = 1;
  DoorCounter counter;
  for (const Sample& row : run_once(compile(with_barriers(), abreast), 0).samples)
    counter.see(row.bits[0], row.bits[1]);
  CHECK(counter.ins == 1);
}

TEST_CASE("a range finder above the door sees heads below its threshold, and a leaf that turns", "[sim][beam]") {
  const auto broken = [](DoorState state, double idle_share) {
    SceneSpec scene = test::two_rooms({test::front_door(state)});
    SensorModelSpec model = io::read_sensor_model(test::data("sensors/VL53L1X.yaml"));
    model.idle_share = idle_share;
    scene.meshes.push_back(pirsim::testing::box_mesh({-3, -0.1, -3}, {6, 0, 3}));
    scene.sensor_models["VL53L1X"] = model;
    scene.sensors = {{"over", "VL53L1X", {glm::angleAxis(radians(-90.0), Vec3(1, 0, 0)), Vec3(0.35, 2.3, 0)}}};
    const RunResult result = run_once(compile(scene, visitors()), 0);
    return std::ranges::count_if(result.samples, [](const Sample& row) { return row.bits[0] != 0; });
  };
  const auto open = broken(DoorState::open, 0.85), shut = broken(DoorState::shut, 0.85);
  CHECK(open > 6 * 5);                       // six passes, of at least a tenth of a second each
  CHECK(broken(DoorState::open, 0.1) == 0);  // nobody's head is within 23 cm
  CHECK(shut > open + 12 * 5);               // a leaf that opens and shuts before and behind each
}
