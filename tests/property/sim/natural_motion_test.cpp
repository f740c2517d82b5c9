// How people of natural style move: rates, still periods, limits, and what doesn't depend on them.
#include "sim/natural_motion.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

#include "pirsim/state.hpp"
#include "sim/run_state.hpp"
#include "support/body_checks.hpp"
#include "support/power_law.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::body;
using namespace pirsim::body::test;
using namespace pirsim::test;
using sim::ActKind;

namespace {

constexpr int tick_rate_hz = 50;
constexpr std::array activities{Activity::typing, Activity::reading, Activity::meeting, Activity::phone};

/// The joints, but for breathing.
std::array<double, 14> joints(const Motion& motion) {
  const Outline o = motion.outline();
  return {o.pelvis.heading,
          o.pelvis.position.x,
          o.pelvis.position.y,
          o.spine_tilt - motion.breath(),
          o.spine_lean,
          o.head_turn,
          o.reach,
          o.hand_ahead_m[0],
          o.hand_ahead_m[1],
          o.hand_up_m[0],
          o.hand_up_m[1],
          o.hand_to_head[0],
          o.hand_to_head[1],
          o.hand_offset_m};
}

bool differ(const std::array<double, 14>& a, const std::array<double, 14>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(a[i] - b[i]) > 1e-9) return true;
  }
  return false;
}

/// An observer who sees joints and nothing else.
class Observer {
 public:
  void see(const Motion& motion) {
    const auto now = joints(motion);
    const bool moves = !seen_.empty() && differ(now, seen_.back());
    if (moves && still_ticks_ > 0) still_s_.push_back(still_ticks_ * tick_s);
    still_ticks_ = moves ? 0 : still_ticks_ + 1;
    constexpr int a_moment = 15;
    if (still_ticks_ == a_moment) note_rest(now);
    seen_.assign(1, now);
  }
  /// Periods in which no joint moved, seconds.
  [[nodiscard]] const std::vector<double>& still_s() const { return still_s_; }
  /// How often trunk or chair came to rest elsewhere than before.
  [[nodiscard]] int shifts() const { return shifts_; }

 private:
  void note_rest(const std::array<double, 14>& now) {
    const std::array<double, 3> trunk{now[0], now[3], now[4]};
    if (rested_)
      shifts_ += std::abs(trunk[0] - rest_[0]) + std::abs(trunk[1] - rest_[1]) + std::abs(trunk[2] - rest_[2]) > 1e-6;
    rest_ = trunk;
    rested_ = true;
  }
  std::vector<std::array<double, 14>> seen_;
  std::array<double, 3> rest_{};
  bool rested_ = false;
  int still_ticks_ = 0, shifts_ = 0;
  std::vector<double> still_s_;
};

/// Somebody of natural style on a seat at a table, from the moment on when they sit.
struct Sitter {
  Sitter(std::uint32_t person, const Humanoid& humanoid, const SeatPlace& seat = desk_seat())
      : motion(humanoid, {0, 0.6}, 0.0, 0.0, tick_s), natural(11, 0, person, tick_rate_hz) {
    motion.sit_down(seat);
    while (!sits(motion)) tick(std::nullopt);
    motion.work({0.0, 3.0});
  }
  void tick(std::optional<Activity> activity, const sim::Attention& attention = {}) {
    natural.tick(motion, activity, attention);
    motion.advance();
  }
  Motion motion;
  sim::NaturalMotion natural;
};

struct Office {
  std::vector<double> shifts, fidgets, liveliness;  ///< (n_people) counts of an hour, and rates relative to the mean
  std::vector<double> still_s;
  double seen_shifts = 0.0;
};

/// So many people, an hour each.
Office watch(Activity activity, std::uint32_t n_people) {
  constexpr int hour = 3600 * tick_rate_hz;
  Office office;
  for (std::uint32_t person = 0; person < n_people; ++person) {
    Sitter sitter(person, man());
    Observer observer;
    for (int tick = 0; tick < hour; ++tick) {
      sitter.tick(activity);
      observer.see(sitter.motion);
    }
    office.shifts.push_back(static_cast<double>(sitter.natural.begun(ActKind::shift)));
    office.fidgets.push_back(static_cast<double>(sitter.natural.begun(ActKind::fidget)));
    office.liveliness.push_back(sitter.natural.liveliness());
    office.seen_shifts += observer.shifts();
    office.still_s.insert(office.still_s.end(), observer.still_s().begin(), observer.still_s().end());
  }
  return office;
}

double sum(const std::vector<double>& values) {
  double all = 0.0;
  for (const double value : values) all += value;
  return all;
}

struct Rate {
  double per_quarter, standard_error;
  [[nodiscard]] double deviations_from(double wanted) const { return std::abs(per_quarter - wanted) / standard_error; }
};
/// Per 15 minutes of a person of liveliness 1; the standard error from how people differ beside their liveliness.
Rate rate_of(const std::vector<double>& counts, const std::vector<double>& liveliness) {
  const double rate = sum(counts) / sum(liveliness);
  double squares = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double residual = counts[i] - rate * liveliness[i];
    squares += residual * residual;
  }
  return {0.25 * rate, 0.25 * std::sqrt(squares) / sum(liveliness)};
}

}  // namespace

TEST_CASE("natural sitters shift and fidget as often as was measured at desks, whatever they do") {
  for (const Activity activity : activities) {
    const Office office = watch(activity, 40);
    const Rate shifts = rate_of(office.shifts, office.liveliness), fidgets = rate_of(office.fidgets, office.liveliness);
    INFO(activity_names[static_cast<std::size_t>(activity)]
         << ": " << shifts.per_quarter << " +- " << shifts.standard_error << " shifts and " << fidgets.per_quarter
         << " +- " << fidgets.standard_error << " fidgets in 15 min; seen " << office.seen_shifts << " of "
         << sum(office.shifts));
    CHECK(shifts.standard_error < 0.4);
    CHECK(fidgets.standard_error < 0.5);
    CHECK(shifts.deviations_from(9.0) < 3.5);
    CHECK(fidgets.deviations_from(13.0) < 3.5);
    // Twin: a sixth more is told apart.
    CHECK(shifts.deviations_from(9.0 * 7.0 / 6.0) > 3.5);
    // Who sees the joints alone counts the same, but for shifts that follow upon one another without a rest.
    CHECK(office.seen_shifts <= sum(office.shifts));
    CHECK(office.seen_shifts > 0.85 * sum(office.shifts));
  }
}

TEST_CASE("still periods of natural sitters follow a power law between 5 s and 5 min") {
  for (const Activity activity : activities) {
    const PowerLawFit fit = fit_power_law(watch(activity, 40).still_s, 5.0, 300.0);
    INFO(activity_names[static_cast<std::size_t>(activity)] << ": exponent " << fit.exponent << " +- "
                                                            << fit.standard_error << ", n " << fit.n << ", distance "
                                                            << fit.distance * std::sqrt(fit.n));
    CHECK(fit.n > 3000);
    CHECK(fit.exponent - 2.0 * fit.standard_error > 0.7);
    CHECK(fit.exponent + 2.0 * fit.standard_error < 1.1);
    CHECK(fit.fits());
  }
}

TEST_CASE("neither exponential still periods nor the paper's choreography pass for a power law") {
  for (const double mean_s : {5.0, 10.0, 30.0, 100.0}) {
    Stream stream({1, 0, 0, Purpose::test});
    std::vector<double> still_s(20000);
    for (double& s : still_s) s = -mean_s * std::log(1.0 - stream.uniform());
    const PowerLawFit fit = fit_power_law(still_s, 5.0, 300.0);
    INFO("mean " << mean_s << ", exponent " << fit.exponent << ", n " << fit.n);
    CHECK_FALSE(fit.fits());
  }
  for (const double amplitude_m : {0.1, 0.0}) {
    Motion motion(man(), {0, 0.6}, 0.0, 0.0, tick_s);
    motion.sit_down(desk_seat());
    run_until(motion, sits, [](const Motion&) {});
    motion.work({amplitude_m, 3.0});
    Observer observer;
    Stream stream({2, 0, 0, Purpose::test});
    for (int tick = 0; tick < 3 * 3600 * tick_rate_hz; ++tick) {
      if (tick % (30 * tick_rate_hz) == 0) motion.tilt_spine(15.0 * degree * (stream.index(3) - 1.0));
      motion.advance();
      observer.see(motion);
    }
    CHECK_FALSE(fit_power_law(observer.still_s(), 5.0, 300.0).fits());
  }
}

TEST_CASE("natural movements keep joints within their limits, and speeds and accelerations bounded") {
  // Hands that reach or gesture peak at 1 to 2 m/s (assumed). Seen were 1.4 m/s, 12 m/s2, 5 rad/s and 39 rad/s2.
  constexpr double fastest_m_s = 2.0, hardest_m_s2 = 16.0, fastest_rad_s = 6.5, hardest_rad_s2 = 50.0;
  struct Peak {
    double value = 0.0;
    std::string where;
    void add(double now, std::size_t part, const char* activity) {
      if (now > value) value = now, where = std::string(name(static_cast<Part>(part))) + ", " + activity;
    }
  } speed, acceleration, turn, turn_acceleration;
  const auto turned = [](const Quat& a, const Quat& b) {  // rotation vector from a to b
    Quat way = b * glm::conjugate(a);
    if (way.w < 0.0) way = -way;
    return 2.0 * Vec3(way.x, way.y, way.z);
  };
  for (const double stature_m : {1.5, 1.86, 2.05}) {
    PersonSpec spec;
    spec.stature_m = stature_m;
    spec.mass_kg = 22.0 * stature_m * stature_m;
    const Humanoid humanoid{spec};
    Soundness soundness;
    for (std::uint32_t person = 0; person < 12; ++person) {
      Sitter sitter(person, humanoid);
      const Activity activity = activities[person % activities.size()];
      const char* what = activity_names[static_cast<std::size_t>(activity)];
      std::array<Posture, 3> last;
      last.fill(sitter.motion.posture());
      for (int tick = 0; tick < 600 * tick_rate_hz; ++tick) {
        const bool speaks = activity == Activity::meeting && tick / 1000 % 3 == 0;
        sitter.tick(activity, {speaks ? sim::Talk::speaks : sim::Talk::listens, tick / 1000 % 2 == 0 ? 2.0 : -0.4});
        last = {last[1], last[2], sitter.motion.posture()};
        soundness.add(humanoid, last[2]);
        for (std::size_t part = 0; part < n_parts; ++part) {
          const Vec3 now = (last[2][part].origin - last[1][part].origin) / tick_s;
          const Vec3 before = (last[1][part].origin - last[0][part].origin) / tick_s;
          const Vec3 turns = turned(last[1][part].rotation, last[2][part].rotation) / tick_s;
          const Vec3 turned_before = turned(last[0][part].rotation, last[1][part].rotation) / tick_s;
          speed.add(glm::length(now), part, what);
          turn.add(glm::length(turns), part, what);
          if (tick < 2) continue;
          acceleration.add(glm::length(now - before) / tick_s, part, what);
          turn_acceleration.add(glm::length(turns - turned_before) / tick_s, part, what);
        }
      }
    }
    INFO("stature " << stature_m);
    soundness.check();
  }
  INFO("m/s " << speed.value << " (" << speed.where << "), m/s2 " << acceleration.value << " (" << acceleration.where
              << "), rad/s " << turn.value << " (" << turn.where << "), rad/s2 " << turn_acceleration.value << " ("
              << turn_acceleration.where << ")");
  CHECK(speed.value < fastest_m_s);
  CHECK(speed.value > 0.5);
  CHECK(acceleration.value < hardest_m_s2);
  CHECK(turn.value < fastest_rad_s);
  CHECK(turn_acceleration.value < hardest_rad_s2);
}
