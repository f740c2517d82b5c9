// How people of natural style move: rates, still periods, limits, and what doesn't depend on them.
#include "sim/natural_motion.hpp"

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "support/body_checks.hpp"
#include "support/natural_sitter.hpp"
#include "support/power_law.hpp"

using namespace pirsim;
using namespace pirsim::body;
using namespace pirsim::body::test;
using namespace pirsim::test;
using sim::ActKind;

namespace {

constexpr std::array activities{Activity::typing, Activity::reading, Activity::meeting, Activity::phone};

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
    Sitter sitter(person, man(), desk_seat());
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

const Office& hours_of(Activity activity) {
  static std::map<Activity, Office> offices;
  if (!offices.contains(activity)) offices.emplace(activity, watch(activity, 40));
  return offices.at(activity);
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

TEST_CASE("natural sitters shift and fidget as often as was measured at desks, whatever they do", "[seconds]") {
  for (const Activity activity : activities) {
    const Office& office = hours_of(activity);
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

TEST_CASE("still periods of natural sitters follow a power law between 5 s and 5 min", "[seconds]") {
  for (const Activity activity : activities) {
    const PowerLawFit fit = fit_power_law(hours_of(activity).still_s, 5.0, 300.0);
    INFO(activity_names[static_cast<std::size_t>(activity)] << ": exponent " << fit.exponent << " +- "
                                                            << fit.standard_error << ", n " << fit.n << ", distance "
                                                            << fit.distance * std::sqrt(fit.n));
    CHECK(fit.n > 2500);
    CHECK(fit.exponent - 2.0 * fit.standard_error > 0.7);
    CHECK(fit.exponent + 2.0 * fit.standard_error < 1.1);
    CHECK(fit.fits());
  }
}

TEST_CASE("neither exponential still periods nor the paper's choreography pass for a power law") {
  for (const double mean_s : {5.0, 10.0, 30.0, 100.0}) {
    Stream stream({1, 0, 0, Purpose::test});
    std::vector<double> still_s(5000);
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

TEST_CASE("natural movements keep joints within their limits, and speeds and accelerations bounded", "[seconds]") {
  // assumed: unhurried reaching and looking round. Seen were 0.95 m/s, 6.4 m/s2, 5.0 rad/s (a head that looks from one
  // side to the other) and 88 rad/s2 (a forearm that is lifted from the table turns about its own axis as well).
  constexpr double fastest_m_s = 1.5, hardest_m_s2 = 10.0, fastest_rad_s = 6.5, hardest_rad_s2 = 120.0;
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
      Sitter sitter(person, humanoid, desk_seat());
      const Activity activity = activities[person % activities.size()];
      const char* what = activity_names[static_cast<std::size_t>(activity)];
      std::array<Posture, 3> last;
      last.fill(sitter.motion.posture());
      for (int tick = 0; tick < 600 * tick_rate_hz; ++tick) {
        const bool speaks = activity == Activity::meeting && tick / 1000 % 3 == 0;
        sitter.tick(activity, {speaks ? sim::Talk::speaks : sim::Talk::listens, tick / 1000 % 2 == 0 ? 2.0 : -0.4});
        soundness.add(humanoid, sitter.motion.posture());
        // Small movements go on at every second tick.
        constexpr double step_s = 2.0 * tick_s;
        if (tick % 2 != 0) continue;
        last = {last[1], last[2], sitter.motion.posture()};
        for (std::size_t part = 0; part < n_parts; ++part) {
          const Vec3 now = (last[2][part].origin - last[1][part].origin) / step_s;
          const Vec3 before = (last[1][part].origin - last[0][part].origin) / step_s;
          const Vec3 turns = turned(last[1][part].rotation, last[2][part].rotation) / step_s;
          const Vec3 turned_before = turned(last[0][part].rotation, last[1][part].rotation) / step_s;
          speed.add(glm::length(now), part, what);
          turn.add(glm::length(turns), part, what);
          if (tick < 4) continue;
          acceleration.add(glm::length(now - before) / step_s, part, what);
          turn_acceleration.add(glm::length(turns - turned_before) / step_s, part, what);
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

TEST_CASE("small movements of a natural sitter go on at every second of 50 ticks a second") {
  Sitter sitter(3, man(), desk_seat());
  const int until_hands_lie = 5 * tick_rate_hz;
  for (int tick = 0; tick < until_hands_lie; ++tick) sitter.tick(Activity::typing);
  auto last = joints(sitter.motion);
  int n_moved = 0;
  bool has_moved = false;
  for (int tick = 0; tick < 120 * tick_rate_hz; ++tick) {
    sitter.tick(Activity::typing);
    const auto now = joints(sitter.motion);
    const bool moves = differ(now, last);
    last = now;
    REQUIRE_FALSE((moves && has_moved));
    has_moved = moves;
    n_moved += moves ? 1 : 0;
  }
  CHECK(n_moved > 100);
}

TEST_CASE("people of natural style differ in liveliness and pace as they should") {
  constexpr std::uint32_t n = 4000;
  double mean = 0.0, log_mean = 0.0, log_square = 0.0, pace = 0.0, pace_square = 0.0;
  for (std::uint32_t person = 0; person < n; ++person) {
    const sim::NaturalMotion motion(5, 0, person, tick_rate_hz);
    const double rate = motion.liveliness(), speed = motion.pace(1.2);
    mean += rate / n;
    log_mean += std::log(rate) / n;
    log_square += std::log(rate) * std::log(rate) / n;
    pace += speed / n;
    pace_square += speed * speed / n;
  }
  // Of a log-normal variable with mean 1 and 0.4 for its logarithm: exp(0.16) - 1 is its variance.
  CHECK(std::abs(mean - 1.0) < 4.0 * std::sqrt(std::expm1(0.16) / n));
  CHECK(std::abs(std::sqrt(log_square - log_mean * log_mean) - 0.4) < 4.0 * 0.4 / std::sqrt(2.0 * n));
  CHECK(std::abs(pace - 1.2) < 4.0 * 0.2 / std::sqrt(1.0 * n));
  const double pace_sd = std::sqrt(pace_square - pace * pace);
  CHECK(pace_sd > 0.185);  // 0.2, cut at two standard deviations
  CHECK(pace_sd < 0.2);
}

TEST_CASE("who walks looks round and comes back to looking ahead, who phones has a hand at the ear") {
  for (const std::optional<Activity> activity : {std::optional<Activity>(), std::optional(Activity::phone)}) {
    double widest = 0.0;
    int ahead = 0, ticks = 0, held = 0, free = 0, leaning = 0;
    for (std::uint32_t person = 0; person < 20; ++person) {
      Motion motion(man(), {0, 0}, 0.0, 0.0, tick_s);
      sim::NaturalMotion natural(3, 0, person, tick_rate_hz);
      motion.walk(Route({{0, 0}, {0, -60}}));
      for (int since_start = 0; !stands(motion); ++since_start, ++ticks) {
        natural.tick(motion, activity, {});
        motion.advance();
        const Outline outline = motion.outline();
        widest = std::max(widest, std::abs(outline.head_turn));
        ahead += outline.head_turn == 0.0 ? 1 : 0;
        if (since_start < 2 * tick_rate_hz) continue;
        held += outline.hand_to_head[0] == 1.0 ? 1 : 0;
        free += outline.hand_to_head[0] == 0.0 ? 1 : 0;
        leaning += outline.spine_lean != 0.0 ? 1 : 0;
      }
    }
    CHECK(widest > 30 * degree);
    CHECK(ahead > ticks / 2);
    CHECK(ahead < 0.95 * ticks);
    CHECK((activity ? free : held) == 0);
    CHECK((activity ? held : free) > 10000);
    CHECK(leaning == 0);
  }
}

TEST_CASE("who stands shifts the weight and gestures at a whiteboard, and stands straight before walking on") {
  Motion motion(man(), {0, 0}, 0.0, 0.0, tick_s);
  sim::NaturalMotion natural(3, 0, 0, tick_rate_hz);
  double highest = 0.0;
  for (int tick = 0; tick < 600 * tick_rate_hz; ++tick) {
    natural.tick(motion, Activity::whiteboard, {});
    motion.advance();
    highest = std::max(highest, motion.outline().hand_to_head[1]);
  }
  CHECK(natural.begun(ActKind::shift) > 0);
  CHECK(natural.begun(ActKind::task) > 100);
  CHECK(highest > 0.5);
  motion.walk(Route({{0, 0}, {0, -10}}));
  for (int tick = 0; tick < 2 * tick_rate_hz; ++tick) {
    natural.tick(motion, std::nullopt, {});
    motion.advance();
  }
  CHECK(motion.outline().spine_lean == 0.0);
  CHECK(motion.outline().hand_to_head == std::array{0.0, 0.0});
}

TEST_CASE("a chair that was turned to its table stays turned to it") {
  SeatPlace seat = desk_seat();
  seat.approach_turn = 1.2;
  double most = 0.0;
  for (std::uint32_t person = 0; person < 8; ++person) {
    Sitter sitter(person, man(), seat);
    for (int tick = 0; tick < 1800 * tick_rate_hz; ++tick) {
      sitter.tick(Activity::typing);
      most = std::max(most, std::abs(sitter.motion.heading()));  // the seat faces 0
    }
  }
  CHECK(most > 5 * degree);
  CHECK(most < 19 * degree);
}
