#include "engine/pir/analog_circuit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::pir {
namespace {

enum class Pass { high, low };
struct Section {
  Pass pass;
  double tau_s;
};

// The sections' rates depend on the sections, on the power and its slope, and on the white noise.
constexpr std::size_t power = AnalogFilter::max_sections, slope = power + 1, white = power + 2, width = power + 3;
using Row = std::array<double, width>;
using Square = std::array<Row, width>;

std::vector<Section> sections_of(const DetectorSpec& spec) {
  const auto& [element, amplifier, comparator, report] = spec;
  if (!(element.thermal_s > 0.0 && element.electrical_s > 0.0 && amplifier.low_hz > 0.0 && amplifier.high_hz > 0.0 &&
        amplifier.order >= 1 && amplifier.order <= 3)) {
    throw Error(ErrorCode::usage, "detector: expected positive time constants and corners, and order 1 to 3");
  }
  // n equal sections together lose 3 dB where one loses 3 / n dB.
  const double one_of_n = std::sqrt(std::pow(2.0, 1.0 / amplifier.order) - 1.0);
  std::vector<Section> sections{{Pass::high, element.thermal_s}, {Pass::low, element.electrical_s}};
  for (int i = 0; i < amplifier.order; ++i) {
    sections.push_back({Pass::high, 1.0 / (2.0 * pi * amplifier.low_hz * one_of_n)});
  }
  for (int i = 0; i < amplifier.order; ++i) {
    sections.push_back({Pass::low, one_of_n / (2.0 * pi * amplifier.high_hz)});
  }
  return sections;
}

/// d/dt of everything, with time in ticks. Each section remembers what it lets through slowly: a low-pass hands that
/// on, a high-pass the rest.
Square rates(const std::vector<Section>& sections, double tick_s) {
  Square rate{};
  Row signal{};
  signal[power] = 1.0;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    for (std::size_t k = 0; k < width; ++k) rate[i][k] = signal[k] * (tick_s / sections[i].tau_s);
    rate[i][i] -= tick_s / sections[i].tau_s;
    if (sections[i].pass == Pass::low) signal = {};
    signal[i] += sections[i].pass == Pass::low ? 1.0 : -1.0;
    if (i == 0) signal[white] = 1.0;
  }
  rate[power][slope] = 1.0;
  return rate;
}

Square product(const Square& a, const Square& b) {
  Square c{};
  for (std::size_t i = 0; i < width; ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      for (std::size_t j = 0; j < width; ++j) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

/// By scaling and squaring of the Taylor series. Ref: [MolerVanLoan2003] method 3.
Square exponential(Square a) {
  double norm = 0.0;
  for (const Row& row : a) {
    double sum = 0.0;
    for (const double value : row) sum += std::abs(value);
    norm = std::max(norm, sum);
  }
  const int squarings = std::max(0, static_cast<int>(std::ceil(std::log2(std::max(norm, 1e-300)))) + 3);
  for (Row& row : a) {
    for (double& value : row) value = std::ldexp(value, -squarings);
  }
  constexpr int terms = 14;  // (1/8)^15 / 15! < 1e-25
  Square sum{}, term{};
  for (std::size_t i = 0; i < width; ++i) sum[i][i] = term[i][i] = 1.0;
  for (int n = 1; n <= terms; ++n) {
    term = product(term, a);
    for (std::size_t i = 0; i < width; ++i) {
      for (std::size_t j = 0; j < width; ++j) sum[i][j] += (term[i][j] /= n);
    }
  }
  for (int i = 0; i < squarings; ++i) sum = product(sum, sum);
  return sum;
}

template <std::size_t N>
using Grid = std::array<std::array<double, N>, N>;

/// a * b * a^T
template <std::size_t N>
Grid<N> sandwich(const Grid<N>& a, const Grid<N>& b) {
  Grid<N> half{}, whole{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t j = 0; j < N; ++j) half[i][j] += a[i][k] * b[k][j];
    }
  }
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) {
      for (std::size_t k = 0; k < N; ++k) whole[i][j] += half[i][k] * a[j][k];
    }
  }
  return whole;
}

/// What a tick of unit white noise after tick adds up to: the sum of advance^k drive drive^T (advance^T)^k, doubling
/// the number of terms each time.
template <std::size_t N>
Grid<N> stationary_covariance(Grid<N> advance, const std::array<double, N>& drive) {
  Grid<N> covariance{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) covariance[i][j] = drive[i] * drive[j];
  }
  constexpr int doublings = 48;  // more ticks than any decay lasts
  for (int doubling = 0; doubling < doublings; ++doubling) {
    const Grid<N> more = sandwich(advance, covariance);
    Grid<N> twice{};
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < N; ++k) {
        for (std::size_t j = 0; j < N; ++j) twice[i][j] += advance[i][k] * advance[k][j];
        covariance[i][k] += more[i][k];
      }
    }
    advance = twice;
  }
  return covariance;
}

/// Cholesky's lower triangle; a direction in which nothing varies gets zeros.
template <std::size_t N>
Grid<N> lower_root(const Grid<N>& covariance) {
  Grid<N> root{};
  for (std::size_t j = 0; j < N; ++j) {
    for (std::size_t i = j; i < N; ++i) {
      double rest = covariance[i][j];
      for (std::size_t k = 0; k < j; ++k) rest -= root[i][k] * root[j][k];
      if (i == j) root[j][j] = std::sqrt(std::max(rest, 0.0));
      if (i != j && root[j][j] > 0.0) root[i][j] = rest / root[j][j];
    }
  }
  return root;
}

}  // namespace

AnalogFilter::AnalogFilter(const DetectorSpec& spec, double volts_per_watt, double tick_s)
    : volts_per_watt_(volts_per_watt), noisy_(spec.amplifier.noise_v_pp > 0.0) {
  const std::vector<Section> sections = sections_of(spec);
  n_ = sections.size();
  const Square over_a_tick = exponential(rates(sections, tick_s));
  for (std::size_t i = 0; i < n_; ++i) {
    std::copy_n(over_a_tick[i].begin(), n_, advance_[i].begin());
    from_[i] = over_a_tick[i][power] - over_a_tick[i][slope];
    to_[i] = over_a_tick[i][slope];
    white_[i] = over_a_tick[i][white];
  }
  if (!noisy_) return;
  constexpr double standard_deviations = 6.6;
  const double variance = stationary_covariance(advance_, white_)[n_ - 1][n_ - 1];
  const double scale = spec.amplifier.noise_v_pp / standard_deviations / std::sqrt(variance);
  for (double& value : white_) value *= scale;
  noise_root_ = lower_root(stationary_covariance(advance_, white_));
}

AnalogFilter::Sections AnalogFilter::at_rest(double power_w) const noexcept {
  Sections sections{};
  sections[0] = power_w * volts_per_watt_;  // the thermal high-pass has taken it all up
  return sections;
}

void AnalogFilter::add_stationary_noise(Sections& sections, Stream& stream) const noexcept {
  for (std::size_t k = 0; k < n_; ++k) {
    const double value = stream.normal();
    for (std::size_t i = k; i < n_; ++i) sections[i] += noise_root_[i][k] * value;
  }
}

void AnalogFilter::advance(Sections& sections, double from_w, double to_w, double white_value) const noexcept {
  // While nothing is there the thermal section forgets, down to subnormal numbers, which take processors ten times as
  // long as others.
  constexpr double nothing_v = 1e-100;
  const double from_v = from_w * volts_per_watt_, to_v = to_w * volts_per_watt_;
  for (std::size_t i = n_; i-- > 0;) {  // from the last, which nobody else needs
    double value = from_[i] * from_v + to_[i] * to_v + white_[i] * white_value;
    for (std::size_t k = 0; k <= i; ++k) value += advance_[i][k] * sections[k];
    sections[i] = std::abs(value) < nothing_v ? 0.0 : value;
  }
}

namespace {

std::int32_t ticks(double seconds, double tick_s) { return static_cast<std::int32_t>(std::lround(seconds / tick_s)); }

/// Counts on without ever overflowing.
void age(std::int32_t& ticks) noexcept {
  constexpr std::int32_t oldest = 1 << 30;
  if (ticks < oldest) ++ticks;
}

}  // namespace

Comparator::Comparator(const ComparatorSpec& spec, const ReportSpec& report, double tick_s) : spec_(spec) {
  if (!(spec.positive_v > 0.0 && spec.negative_v > 0.0 && report.hold_s >= 0.0 && report.again_s >= 0.0 &&
        report.blind_s >= 0.0 && spec.pulse_window_s >= 0.0 && spec.pulse_count >= 1 &&
        spec.pulse_count <= most_pulses)) {
    throw Error(ErrorCode::usage, "comparator: expected positive thresholds, times of at least 0 and 1 to 8 pulses");
  }
  pulse_window_ = ticks(spec.pulse_window_s, tick_s);
  hold_ = ticks(report.hold_s, tick_s);
  again_ = ticks(report.again_s, tick_s);
  blind_ = ticks(report.blind_s, tick_s);
}

void Comparator::count_motion(State& state) const noexcept {
  state.on = true;
  state.hold_left = hold_;
  state.deaf_left = again_;
}

bool Comparator::count_pulse(State& state) const noexcept {
  if (spec_.pulse_signs == PulseSigns::alternating && state.pulses > 0 && state.side == state.last_pulse_side)
    return false;
  state.last_pulse_side = state.side;
  state.pulse_age[state.pulses++] = 0;
  return state.pulses >= spec_.pulse_count;
}

void Comparator::advance(State& state, double volts) const noexcept {
  advance_to(state, static_cast<std::int8_t>(volts > spec_.positive_v ? 1 : volts < -spec_.negative_v ? -1 : 0));
}

bool Comparator::counts(State& state, std::int8_t side) const noexcept {
  const std::int8_t before = state.side;
  state.side = side;
  if (state.on) return side != 0;
  if (state.deaf_left > 0) return false;
  for (int i = 0; i < state.pulses; ++i) age(state.pulse_age[i]);
  while (state.pulses > 0 && state.pulse_age[0] > pulse_window_) {
    std::copy(state.pulse_age + 1, state.pulse_age + state.pulses, state.pulse_age);
    state.pulse_age[--state.pulses] = 0;
  }
  return side != 0 && side != before && count_pulse(state);
}

void Comparator::report(State& state, bool motion) const noexcept {
  const bool is_deaf = state.deaf_left > 0;
  if (is_deaf) --state.deaf_left;
  if (motion && !is_deaf && (!state.on || again_ == 0 || state.hold_left > 0)) return count_motion(state);
  const bool is_lost = !motion && (state.on ? state.side != 0 : state.pulses >= spec_.pulse_count);
  if (is_lost) {
    state.side = 0;
    if (!state.on) --state.pulses;
  }
  if (!state.on) return;
  if (state.hold_left > 0) {
    --state.hold_left;
  } else {
    state = {.side = state.side, .deaf_left = std::max(state.deaf_left, blind_)};
  }
}

AnalogCircuit::AnalogCircuit(const DetectorSpec& spec, double volts_per_watt, double tick_s)
    : filter_(spec, volts_per_watt, tick_s),
      comparator_(spec.comparator, spec.report, tick_s),
      lowest_v_(spec.amplifier.lowest_v - spec.amplifier.offset_v),
      highest_v_(spec.amplifier.highest_v - spec.amplifier.offset_v) {}

AnalogCircuit::State AnalogCircuit::start(double power_w, StreamKey noise) const noexcept {
  State state{.sections = filter_.at_rest(power_w), .power_w = power_w, .noise = Stream(noise)};
  if (filter_.noisy()) filter_.add_stationary_noise(state.sections, state.noise);
  state.volts = std::clamp(filter_.output(state.sections), lowest_v_, highest_v_);
  return state;
}

void AnalogCircuit::advance(State& state, double power_w) const noexcept {
  advance(state, power_w, filter_.noisy() ? state.noise.normal() : 0.0);
}

void AnalogCircuit::advance(State& state, double power_w, double white) const noexcept {
  filter_.advance(state.sections, state.power_w, power_w, white);
  state.power_w = power_w;
  state.volts = std::clamp(filter_.output(state.sections), lowest_v_, highest_v_);
  comparator_.advance(state.comparator, state.volts);
}

}  // namespace pirsim::pir
