#include "engine/sim/thermal_array.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "engine/sim/run_state.hpp"
#include "model/core/random.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/error.hpp"
#include "pirsim/random.hpp"

namespace pirsim::sim {
namespace {

/// Of a ray, m^2 sr: any will do, since only the radiance is of interest.
constexpr double ray_weight = 1e-6;
constexpr double sigma_of_width = 0.42466090014400953;     // 1 / (2 sqrt(2 ln 2)): full width at half of a Gaussian
constexpr std::size_t most_columns = 640;                  // fields of ArraySpec
constexpr double margin_sigmas = 2.0, reach_sigmas = 4.0;  // of the lattice beyond the pixels; of a pixel's response

/// The quantiles of the standard normal law at (i + 1/2) / 2^16, of which noise takes each as often: a hundred normal
/// numbers then cost less than looking at a person. None is beyond 4.3.
const std::vector<float>& normal_quantiles() {
  static const std::vector<float> quantiles = [] {
    constexpr std::size_t n = 1U << 16U;
    std::vector<float> all(n);
    double x = 0.0;
    for (std::size_t i = n / 2; i < n; ++i) {
      const double above = (static_cast<double>(n - i) - 0.5) / n;
      for (int step = 0; step < 4; ++step)  // Newton's, from the one before
        x += (0.5 * std::erfc(x / std::numbers::sqrt2) - above) * std::sqrt(2.0 * pi) * std::exp(0.5 * x * x);
      all[i] = static_cast<float>(x);
      all[n - 1 - i] = -all[i];
    }
    return all;
  }();
  return quantiles;
}

/// Two normal numbers a word of the stream.
void draw_normals(Stream& stream, std::span<float> numbers) {
  const float* quantiles = normal_quantiles().data();
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    const std::uint32_t word = stream.next_u32();
    numbers[i] = quantiles[word & 0xFFFFU];
    if (i + 1 < numbers.size()) numbers[i + 1] = quantiles[word >> 16U];
  }
}

double rate_of(const ArraySpec& spec, const SensingSpec& sensing) {
  return sensing.frame_rate_hz.value_or(spec.rate_hz);
}

/// The field as the image sees it, degrees: x to the right, y up; as far from the middle as off the axis.
struct Field {
  explicit Field(const ArraySpec& spec)
      : pitch(spec.wide_deg / spec.columns, spec.tall_deg / spec.rows),
        sigma(spec.pixel_deg ? Vec2(*spec.pixel_deg * sigma_of_width) : pitch * sigma_of_width),
        size(Vec2(spec.wide_deg, spec.tall_deg) + 2.0 * margin_sigmas * sigma) {}

  [[nodiscard]] double n_rays(const ArraySpec& spec) const {
    return std::ceil(spec.rays_per_pixel * size.x * size.y / (pitch.x * pitch.y));
  }

  Vec2 pitch, sigma, size;
};

Vec2 centre_of(const ArraySpec& spec, const Field& field, int row, int column) {
  return {(column + 0.5) * field.pitch.x - 0.5 * spec.wide_deg, 0.5 * spec.tall_deg - (row + 0.5) * field.pitch.y};
}

Vec3 direction_of(const Vec2& image) {
  const double off_axis = radians(glm::length(image));
  const double ratio = off_axis > 0.0 ? std::sin(off_axis) / glm::length(image) : 0.0;
  return {ratio * image.x, ratio * image.y, -std::cos(off_axis)};
}

/// Solid angle over area of the image.
double stretch(const Vec2& image) {
  const double off_axis = radians(glm::length(image));
  return off_axis > 0.0 ? std::sin(off_axis) / off_axis : 1.0;
}

std::vector<Vec2> lattice_of(const ArraySpec& spec) {
  const Field field(spec);
  const int n = static_cast<int>(field.n_rays(spec));
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) {
    const Vec2 point = (pir::lattice_point(i, n) - Vec2(0.5)) * field.size;
    constexpr double widest_deg = 89.0;
    if (glm::length(point) < widest_deg) points.push_back(point);
  }
  return points;
}

pir::PowerRays rays_of(const SensorSpec& sensor, const ArraySpec& spec) {
  pir::PowerRays rays;
  const Frame& frame = sensor.world_from_sensor;
  for (const Vec2& point : lattice_of(spec)) {
    rays.bundle.rays.push_back({Vec3f(frame.origin), Vec3f(glm::normalize(frame.rotation * direction_of(point)))});
    rays.bundle.range.push_back(pir::out_of_sight_m);
    rays.weights.push_back(ray_weight);
  }
  rays.bundle.zone_rays_begin.push_back(static_cast<std::uint32_t>(rays.bundle.rays.size()));
  rays.bundle.cluster_zones_begin.push_back(1);
  rays.bundle.sensor_clusters_begin.push_back(1);
  return rays;
}

/// Which array it is, by its name: others may be put before it.
std::uint64_t number_of(const std::string& name) { return std::stoull(sha256(name).substr(0, 16), nullptr, 16); }

/// Told before anything is made of the array.
const ArraySpec& checked(const SceneSpec& scene, std::size_t index, const SensingInForce& sensing) {
  const SensorSpec& sensor = scene.arrays[index];
  const ArraySpec& spec = *scene.sensor_models.at(sensor.model).array;
  const auto refuse = [&](const std::string& message) {
    throw Error(ErrorCode::input, Where{scene.name}, "array '" + sensor.id + "': " + message);
  };
  if (rate_of(spec, sensing) > sensing.tick_rate_hz) {
    refuse("it can't give more frames a second than there are ticks (" + std::to_string(sensing.tick_rate_hz) +
           "): a lower sensing.frame_rate_hz, or a higher tick_rate_hz?");
  }
  if (Field(spec).n_rays(spec) > limits::rays)
    refuse("it has more than " + std::to_string(limits::rays) + " rays: fewer rays_per_pixel?");
  return spec;
}

}  // namespace

ThermalArray::ThermalArray(const SceneSpec& scene, std::size_t index, const SensingInForce& sensing, std::uint64_t seed,
                           const rt::Room& room, const std::vector<DoorLeaf>& leaves)
    : spec_(checked(scene, index, sensing)),
      seed_(seed ^ number_of(scene.arrays[index].id)),
      rate_hz_(rate_of(spec_, sensing)),
      tick_rate_hz_(sensing.tick_rate_hz),
      room_(&room),
      power_(rays_of(scene.arrays[index], spec_), pir::Band{spec_.from_um, spec_.to_um}, scene, sensing, room),
      thermometer_(power_.band()) {
  const Field field(spec_);
  const auto n_pixels = static_cast<std::size_t>(spec_.rows) * static_cast<std::size_t>(spec_.columns);
  std::vector<double> sums(n_pixels, 0.0);
  shares_begin_.push_back(0);
  for (const Vec2& point : lattice_of(spec_)) {
    const double weight = stretch(point);
    for (int row = 0; row < spec_.rows; ++row) {
      const double up = (point.y - centre_of(spec_, field, row, 0).y) / field.sigma.y;
      if (std::abs(up) > reach_sigmas) continue;
      for (int column = 0; column < spec_.columns; ++column) {
        const double right = (point.x - centre_of(spec_, field, row, column).x) / field.sigma.x;
        const double squares = right * right + up * up;
        if (squares > reach_sigmas * reach_sigmas) continue;
        const auto pixel = static_cast<std::uint32_t>(row * spec_.columns + column);
        shares_.push_back({pixel, weight * std::exp(-0.5 * squares)});
        sums[pixel] += shares_.back().of_pixel;
      }
    }
    shares_begin_.push_back(static_cast<std::uint32_t>(shares_.size()));
  }
  for (Share& share : shares_) share.of_pixel /= sums[share.pixel];
  if (!leaves.empty()) cuts_.emplace(power_.clipped(), leaves);
  backgrounds_.resize(n_pixels, 0.0);
  for (std::uint32_t ray = 0; ray + 1 < shares_begin_.size(); ++ray) {
    for (std::uint32_t i = shares_begin_[ray]; i < shares_begin_[ray + 1]; ++i)
      backgrounds_[shares_[i].pixel] += shares_[i].of_pixel * power_.background(ray);
  }
  for (const double radiance : backgrounds_) empty_c_.push_back(thermometer_.celsius(radiance));
  const double corner = glm::length(centre_of(spec_, field, 0, 0));
  for (int row = 0; row < spec_.rows; ++row) {
    for (int column = 0; column < spec_.columns; ++column) {
      const double out = corner > 0.0 ? glm::length(centre_of(spec_, field, row, column)) / corner : 0.0;
      const double times = spec_.centre_noise + (spec_.corner_noise - spec_.centre_noise) * out * out;
      noise_k_.push_back(times * spec_.netd_k * std::sqrt(rate_hz_));
    }
  }
  draw_unit();
}

void ThermalArray::draw_unit() {
  Stream stream({seed_, 0, 0, Purpose::array_unit});
  const double offset_k = spec_.offset_k * stream.normal();
  std::vector<double> columns_k;
  for (int column = 0; column < spec_.columns; ++column) columns_k.push_back(spec_.column_k * stream.normal());
  for (std::size_t pixel = 0; pixel < n_pixels(); ++pixel) {
    pattern_k_.push_back(offset_k + columns_k[pixel % columns_k.size()] + spec_.fixed_k * stream.normal());
  }
  for (int i = 0; i < spec_.dead_pixels; ++i)  // two may be the same
    pattern_k_[stream.index(static_cast<std::uint32_t>(n_pixels()))] = std::numeric_limits<double>::quiet_NaN();
}

std::unique_ptr<rt::Tracer> ThermalArray::make_tracer(TracerKind kind) const {
  return rt::make_tracer(kind, {room_, &power_.rays().bundle, &power_.clipped(), cuts_ ? &*cuts_ : nullptr});
}

std::int64_t ThermalArray::tick_of(std::int64_t frame) const noexcept {
  return std::llround(static_cast<double>(frame) * tick_rate_hz_ / rate_hz_);
}

double ThermalArray::time_s(std::int64_t frame) const noexcept {
  return static_cast<double>(tick_of(frame)) / tick_rate_hz_;
}

void ThermalArray::see(std::span<const PowerSteps> powers, std::span<double> celsius) const noexcept {
  std::ranges::copy(backgrounds_, celsius.begin());
  for (std::size_t ray = 0; ray < powers.size(); ++ray) {
    if (powers[ray] == 0) continue;
    const double radiance = static_cast<double>(powers[ray]) * (watts_per_step / ray_weight);
    for (std::uint32_t i = shares_begin_[ray]; i < shares_begin_[ray + 1]; ++i)
      celsius[shares_[i].pixel] += shares_[i].of_pixel * radiance;
  }
  for (std::size_t pixel = 0; pixel < celsius.size(); ++pixel) {
    double& value = celsius[pixel];
    value = value == backgrounds_[pixel] ? empty_c_[pixel] : thermometer_.celsius(value);
  }
}

void ThermalArray::read(std::span<const double> celsius, std::uint32_t run, std::int64_t frame, Pages pages,
                        std::span<float> values) const noexcept {
  Stream stream({seed_, run, static_cast<std::uint32_t>(frame), Purpose::array_frame});
  std::array<float, most_columns> normals{};
  draw_normals(stream, std::span(normals).first(1));
  const double common_k = spec_.common_k * std::sqrt(rate_hz_) * static_cast<double>(normals.front());
  const auto n_columns = static_cast<std::size_t>(spec_.columns), n_rows = static_cast<std::size_t>(spec_.rows);
  // Sub-pages as the squares of a chess board.
  const bool is_half = pages == Pages::due && spec_.sub_pages == 2;
  const double steps_per_k = spec_.step_k > 0.0 ? 1.0 / spec_.step_k : 0.0;
  constexpr double no_fraction = 0x1.8p52;  // a sum with it has no bits behind the point left; NaN stays
  for (std::size_t row = 0; row < n_rows; ++row) {
    const std::size_t first = is_half ? (row + static_cast<std::size_t>(frame)) % 2 : 0, stride = is_half ? 2 : 1;
    draw_normals(stream, std::span(normals).first((n_columns - first + stride - 1) / stride));
    const float* normal = normals.data();
    for (std::size_t pixel = row * n_columns + first; pixel < (row + 1) * n_columns; pixel += stride) {
      double value = celsius[pixel] + pattern_k_[pixel] + common_k + noise_k_[pixel] * static_cast<double>(*normal++);
      if (steps_per_k > 0.0) value = (value * steps_per_k + no_fraction - no_fraction) * spec_.step_k;
      values[pixel] = static_cast<float>(value);
    }
  }
}

ArrayWatch::ArrayWatch(const ThermalArray& array, TracerKind kind)
    : array_(array),
      meter_(array.power(), array.make_tracer(kind), 0),
      powers_(array.power().n_receivers(), 0),
      empty_(array.n_pixels()),
      celsius_(array.n_pixels()) {
  array_.see(powers_, empty_);
}

ArrayWatch::Contrast ArrayWatch::look(std::span<const PosedShape> solids, const BodyRadiance& radiance) {
  meter_.measure(solids.first(std::min(solids.size(), radiance.size())), radiance, powers_);
  array_.see(powers_, celsius_);
  Contrast most;
  for (std::size_t pixel = 0; pixel < celsius_.size(); ++pixel) {
    const double kelvin = std::abs(celsius_[pixel] - empty_[pixel]);
    constexpr double least_noise_k = 1e-3;
    const double times_noise = kelvin / std::max(array_.noise_k(pixel), least_noise_k);
    if (times_noise > most.times_noise) most = {kelvin, times_noise};
  }
  return most;
}

Camera::Camera(const ThermalArray& array, TracerKind kind, std::uint32_t run)
    : array_(array),
      run_(run),
      meter_(array.power(), array.make_tracer(kind), 0),
      celsius_(array.n_pixels()),
      last_(array.n_pixels()),
      frames_{array.spec().rows, array.spec().columns, {}, {}} {}

void Camera::look(const RunState& state) {
  const bool begins = next_ == 0;
  if (begins) {
    while (array_.tick_of(++next_) < state.tick) {
    }
  } else if (array_.tick_of(next_) > state.tick) {
    return;
  }
  const bool moved = meter_.follow(state.crowd.actors(), state.crowd.doors().steps());
  if (begins || moved) array_.see(meter_.powers(), celsius_);
  if (begins) array_.read(celsius_, run_, next_ - 1, ThermalArray::Pages::all, last_);
  for (; array_.tick_of(next_) <= state.tick; ++next_) {
    array_.read(celsius_, run_, next_, ThermalArray::Pages::due, last_);
    frames_.times_s.push_back(array_.time_s(next_));
    frames_.celsius.insert(frames_.celsius.end(), last_.begin(), last_.end());
  }
}

}  // namespace pirsim::sim
