#include "sim/schedule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "pirsim/geometry.hpp"
#include "pirsim/random.hpp"
#include "schema/schedule_people.hpp"

namespace pirsim::sim {
namespace {

constexpr double hour_s = 3600.0, minute_s = 60.0;
constexpr double shortest_stay_s = 120.0;  ///< assumed: nobody gets up for less

/// Share of time and mean stay. Ref: [ChenHongLuo2018], table 2; meetings are events of their own here, so that their
/// share is left out and the others are scaled up.
struct Habits {
  std::array<double, 3> shares;  ///< own desk, others' desks, outside
  std::array<double, 3> stays_min;
};
constexpr std::array<double, 3> stays_min{60.0, 20.0, 20.0};

Habits habits_of(Role role) {
  switch (role) {
    case Role::staff:
      return {{0.60, 0.20, 0.05}, stays_min};
    case Role::manager:
      return {{0.50, 0.20, 0.10}, stays_min};
    case Role::administrator:
      return {{0.70, 0.15, 0.10}, stays_min};
  }
  return {{0.60, 0.20, 0.05}, stays_min};
}

/// Actions of one person, timed in seconds of the run, and never two that begin at once.
class Timeline {
 public:
  explicit Timeline(const ScheduleSpec& schedule) : schedule_(schedule) {}

  /// Seconds of the day to seconds of the run.
  [[nodiscard]] double run_s(double day_s) const { return std::max(0.0, day_s - schedule_.from_h * hour_s); }

  /// day_s: none for what follows at once.
  void add(std::optional<double> day_s, Action what, std::string phase = {}) {
    ScriptedAction& action = actions_.emplace_back();
    action.what = std::move(what);
    action.phase = std::move(phase);
    action.where = schedule_.where;
    if (!day_s) return;
    last_s_ = std::max(run_s(*day_s), last_s_);
    action.at_s = last_s_;
  }
  void then(Action what, std::string phase = {}) { add(std::nullopt, std::move(what), std::move(phase)); }
  [[nodiscard]] std::vector<ScriptedAction> take() { return std::move(actions_); }

 private:
  const ScheduleSpec& schedule_;
  double last_s_ = 0.0;
  std::vector<ScriptedAction> actions_;
};

double around(Stream& stream, const ClockSpec& clock) {
  return clock.mean_h * hour_s + clock.sd_min * minute_s * std::clamp(stream.normal(), -3.0, 3.0);
}
double exponential(Stream& stream, double mean) { return -mean * std::log(1.0 - stream.uniform()); }

class Day {
 public:
  Day(const CompiledStudy& study, const TrialModel& trial, std::uint32_t run)
      : study_(study), trial_(trial), schedule_(*trial.schedule), run_(run) {
    day_ = day_number(schedule_.first_day, schedule_.where) + study.replicate_of(run) - 1;
    for (const EntranceSpec& door : study.scene().entrances) {
      const auto& wanted = schedule_.entrances;
      if (wanted.empty() || std::ranges::find(wanted, door.id) != wanted.end()) doors_.push_back(door.id);
    }
  }

  DayPlan draw() {
    DayPlan plan;
    for (const PersonModel& person : trial_.people) plan.push_back(person.spec.actions);
    if (!is_working_day(day_)) return plan;
    std::vector<std::size_t> guests;
    for (std::size_t i = 0; i < trial_.people.size(); ++i) {
      const auto& part = trial_.people[i].spec.part;
      if (!part) continue;
      if (part->part == SchedulePart::guest) guests.push_back(i);
      if (part->part == SchedulePart::cleaner) plan[i] = clean(i);
      if (part->part == SchedulePart::staff) plan[i] = schedule_.profile ? follow_profile(i) : work(i);
    }
    if (schedule_.meetings && !guests.empty()) hold_meetings(guests, plan);
    return plan;
  }

 private:
  [[nodiscard]] Stream stream_of(std::size_t person) const {
    return Stream({study_.seed(), run_, static_cast<std::uint32_t>(person), Purpose::schedule});
  }
  [[nodiscard]] const std::string& door_of(std::size_t person) const { return doors_[person % doors_.size()]; }

  Activity desk_activity(Stream& stream) const {
    const double u = stream.uniform();  // assumed shares: typing 0.65 (0.5-0.8), reading 0.25, phone 0.1
    return u < 0.65 ? Activity::typing : u < 0.90 ? Activity::reading : Activity::phone;
  }

  action::Work desk_work(Stream& stream) const {
    action::Work work;
    work.duration_s = 24.0 * hour_s;  // until what comes next
    work.activity = desk_activity(stream);
    return work;
  }

  /// at_s: none for who has just come in.
  void sit_at_desk(Timeline& line, std::optional<double> at_s, std::size_t person, Stream& stream) const {
    action::Sit sit{trial_.people[person].spec.part->seat};
    sit.if_taken = action::IfTaken::other_seat;
    line.add(at_s, sit);
    line.then(desk_work(stream));
  }

  void come(Timeline& line, double at_s, std::size_t person) const { line.add(at_s, action::Enter{door_of(person)}); }
  void go(Timeline& line, double at_s, std::size_t person) const { line.add(at_s, action::Leave{door_of(person)}); }

  /// Beside a colleague's desk, where one can stand; or none.
  [[nodiscard]] std::optional<Vec2> place_beside(std::size_t person, const std::string& seat, Stream& stream) const {
    const PersonModel& visitor = trial_.people[person];
    if (!visitor.can_use(seat)) return std::nullopt;
    const Frame& frame = visitor.seat_plan(seat).place.world_from_seat;
    const double first = 2.0 * pi * stream.uniform();
    for (const double away_m : {1.0, 1.2, 0.85}) {
      for (int k = 0; k < 12; ++k) {
        const Vec2 place = floor_point(frame.origin) + away_m * direction_of(first + 2.0 * pi * k / 12.0);
        if (visitor.floor->walkable(place) && is_out_of_the_way(visitor, place) &&
            visitor.floor->find_way(outside(door_of(person)), place)) {
          return place;
        }
      }
    }
    return std::nullopt;
  }

  /// On the floor, and not where others sit down.
  [[nodiscard]] bool is_out_of_the_way(const PersonModel& visitor, const Vec2& place) const {
    constexpr double from_seat_m = 0.8, from_standing_place_m = 0.75;
    if (!study_.scene().floor.contains(place)) return false;
    return std::ranges::none_of(visitor.seats, [&](const auto& entry) {
      const SeatPlan& plan = entry.second;
      const Frame& seat = plan.place.world_from_seat;
      const Vec2 stand =
          floor_point(seat.origin) - plan.stand_back_m * direction_of(heading_of(seat) + plan.place.approach_turn);
      return glm::distance(place, floor_point(seat.origin)) < from_seat_m ||
             glm::distance(place, stand) < from_standing_place_m;
    });
  }

  [[nodiscard]] Vec2 outside(const std::string& door) const {
    const auto& entrance = *std::ranges::find(study_.scene().entrances, door, &EntranceSpec::id);
    return floor_point(entrance.world_from_entrance * Vec3(0, 0, entrance.outside_m));
  }

  void visit(Timeline& line, std::optional<double> at_s, std::size_t person, Stream& stream) const {
    std::vector<std::string> others;
    for (const PersonModel& other : trial_.people) {
      const auto& part = other.spec.part;
      if (part && part->part == SchedulePart::staff && &other != &trial_.people[person]) others.push_back(part->seat);
    }
    if (others.empty()) return;
    const std::string& seat = others[stream.index(static_cast<std::uint32_t>(others.size()))];
    if (const auto place = place_beside(person, seat, stream)) {
      const action::Walk walk{{*place}};
      line.add(at_s, walk, "visiting");
      line.then(action::Wait{24.0 * hour_s}, "visiting");
    }
  }

  /// Between two moments of the day, from just inside the door: own desk first, then as the chain has it.
  void spend(Timeline& line, double from_s, double to_s, std::size_t person, Stream& stream) const {
    enum Place : std::size_t { desk, visiting, away };
    const Habits habits = habits_of(trial_.people[person].spec.part->role);
    const double all = std::accumulate(habits.shares.begin(), habits.shares.end(), 0.0);
    std::vector<double> shares, stays;
    for (std::size_t i = 0; i < 3; ++i) {
      shares.push_back(habits.shares[i] / all);
      stays.push_back(habits.stays_min[i] * minute_s);
    }
    const std::vector<double> rates = markov_rates(shares, stays);
    std::size_t place = desk;
    sit_at_desk(line, std::nullopt, person, stream);
    for (double now = from_s + exponential(stream, stays[desk]); now < to_s - shortest_stay_s;) {
      const double out = rates[place * 3] + rates[place * 3 + 1] + rates[place * 3 + 2];
      double left = stream.uniform() * out;
      std::size_t next = 0;
      while (next < 2 && (left -= rates[place * 3 + next]) >= 0.0) ++next;
      if (place == away) come(line, now, person);
      const std::optional<double> at_s = place == away ? std::nullopt : std::optional(now);
      if (next == desk) sit_at_desk(line, at_s, person, stream);
      if (next == visiting) visit(line, at_s, person, stream);
      if (next == away) go(line, now, person);
      place = next;
      now += std::max(shortest_stay_s, exponential(stream, stays[place]));
    }
  }

  std::vector<ScriptedAction> work(std::size_t person) const {
    Stream stream = stream_of(person);
    const double arrival = around(stream, schedule_.arrival);
    const double departure = std::max(arrival + hour_s, around(stream, schedule_.departure));
    const double lunch = around(stream, schedule_.lunch);
    const double lunch_s = minute_s * std::max(15.0, schedule_.lunch_min + schedule_.lunch_sd_min *
                                                                               std::clamp(stream.normal(), -3.0, 3.0));
    Timeline line(schedule_);
    come(line, arrival, person);
    const bool eats_out = lunch > arrival + 0.5 * hour_s && lunch + lunch_s < departure - 0.5 * hour_s;
    if (eats_out) {
      spend(line, arrival, lunch, person, stream);
      go(line, lunch, person);
      come(line, lunch + lunch_s, person);
      spend(line, lunch + lunch_s, departure, person, stream);
    } else {
      spend(line, arrival, departure, person, stream);
    }
    go(line, departure, person);
    return line.take();
  }

  std::vector<ScriptedAction> follow_profile(std::size_t person) const {
    const ProfileSpec& profile = *schedule_.profile;
    Stream stream = stream_of(person);
    const auto share = [&](double day_s) { return profile.presence[static_cast<std::size_t>(day_s / hour_s) % 24]; };
    const double step_s = profile.step_min * minute_s, mobility = profile.mobility;
    Timeline line(schedule_);
    bool present = false;
    for (double now = 0.0; now + step_s <= 24.0 * hour_s; now += step_s) {
      const double p = share(now), next = share(std::min(now + step_s, 24.0 * hour_s - 1.0));
      const double comes = std::clamp((mobility - 1.0) / (mobility + 1.0) * p + next, 0.0, 1.0);
      const double stays = p > 0.0 ? std::clamp((p - 1.0) / p * comes + next / p, 0.0, 1.0) : 0.0;
      const bool then = stream.uniform() < (present ? stays : comes);
      const double at_s = now + step_s * stream.uniform();
      if (then && !present) {
        come(line, at_s, person);
        sit_at_desk(line, std::nullopt, person, stream);
      }
      if (!then && present) go(line, at_s, person);
      present = then;
    }
    if (present) go(line, 24.0 * hour_s - minute_s, person);
    return line.take();
  }

  std::vector<ScriptedAction> clean(std::size_t person) const {
    Stream stream = stream_of(person);
    Timeline line(schedule_);
    const double begin = *schedule_.cleaning_h * hour_s + 10.0 * minute_s * std::clamp(stream.normal(), -2.0, 2.0);
    come(line, begin, person);
    action::Walk round;
    const FloorArea& floor = study_.scene().floor;
    const PersonModel& cleaner = trial_.people[person];
    const Vec2 door = outside(door_of(person));
    for (int tries = 0; tries < 400 && round.points.size() < 40; ++tries) {
      const Vec2 place(floor.lower().x + (floor.upper().x - floor.lower().x) * stream.uniform(),
                       floor.lower().y + (floor.upper().y - floor.lower().y) * stream.uniform());
      if (floor.contains(place) && cleaner.floor->walkable(place) && cleaner.floor->find_way(door, place)) {
        round.points.push_back(place);
      }
    }
    line.then(round, "cleaning");
    line.then(action::Leave{door_of(person)});
    return line.take();
  }

  void hold_meetings(const std::vector<std::size_t>& guests, DayPlan& plan) const {
    const MeetingsSpec& spec = *schedule_.meetings;
    Stream stream({study_.seed(), run_, 0, Purpose::schedule_meetings});
    struct Meeting {
      double begin, end;
    };
    std::vector<Meeting> meetings;
    const int wanted =
        spec.fewest_a_day +
        static_cast<int>(stream.index(static_cast<std::uint32_t>(spec.most_a_day - spec.fewest_a_day + 1)));
    constexpr double between_s = 5.0 * minute_s;
    for (int tries = 0; tries < 200 && static_cast<int>(meetings.size()) < wanted; ++tries) {
      double left = stream.uniform() * std::accumulate(spec.probabilities.begin(), spec.probabilities.end(), 0.0);
      std::size_t k = 0;
      while (k + 1 < spec.probabilities.size() && (left -= spec.probabilities[k]) >= 0.0) ++k;
      const double length = spec.durations_min[k] * minute_s;
      const double room = (spec.to_h - spec.from_h) * hour_s - length;
      if (room < 0.0) continue;
      const double quarter = 15.0 * minute_s;
      const double begin = spec.from_h * hour_s + std::floor(room * stream.uniform() / quarter) * quarter;
      const bool overlaps = std::ranges::any_of(meetings, [&](const Meeting& other) {
        return begin < other.end + between_s && other.begin < begin + length + between_s;
      });
      if (!overlaps) meetings.push_back({begin, begin + length});
    }
    std::ranges::sort(meetings, {}, &Meeting::begin);
    std::vector<Timeline> lines(guests.size(), Timeline(schedule_));
    std::vector<std::string> seats;
    for (const SeatSpec& seat : study_.scene().seats) seats.push_back(seat.id);
    const auto shuffle = [&](auto& list) {
      for (std::size_t i = list.size(); i > 1; --i)
        std::swap(list[i - 1], list[stream.index(static_cast<std::uint32_t>(i))]);
    };
    for (const Meeting& meeting : meetings) {
      std::vector<std::size_t> who(guests.size());
      std::iota(who.begin(), who.end(), 0U);
      shuffle(who);
      shuffle(seats);
      const int most = std::min(spec.most_people, static_cast<int>(guests.size()));
      const int n =
          spec.fewest_people +
          static_cast<int>(stream.index(static_cast<std::uint32_t>(std::max(1, most - spec.fewest_people + 1))));
      for (int i = 0; i < std::min<int>(n, static_cast<int>(guests.size())); ++i) {
        const double punctual_s = 3.0 * minute_s;
        const double comes =
            meeting.begin - punctual_s + exponential(stream, (spec.lateness_min * minute_s) + punctual_s);
        const bool leaves_early = stream.uniform() < 0.1;  // assumed (0-0.2)
        const double goes = leaves_early
                                ? meeting.begin + (0.5 + 0.4 * stream.uniform()) * (meeting.end - meeting.begin)
                                : meeting.end + minute_s * stream.uniform();
        if (comes > goes - 5.0 * minute_s) continue;
        Timeline& line = lines[who[static_cast<std::size_t>(i)]];
        const std::size_t person = guests[who[static_cast<std::size_t>(i)]];
        come(line, comes, person);
        action::Sit sit{seats[static_cast<std::size_t>(i) % seats.size()]};
        sit.if_taken = action::IfTaken::other_seat;
        if (!trial_.people[person].can_use(sit.seat)) sit.seat = trial_.people[person].seats.begin()->first;
        line.then(sit);
        action::Work listen;
        listen.duration_s = 24.0 * hour_s;
        listen.activity = Activity::meeting;
        line.then(listen);
        go(line, goes, person);
      }
    }
    for (std::size_t i = 0; i < guests.size(); ++i) plan[guests[i]] = lines[i].take();
  }

  const CompiledStudy& study_;
  const TrialModel& trial_;
  const ScheduleSpec& schedule_;
  std::uint32_t run_;
  std::int64_t day_ = 0;
  std::vector<std::string> doors_;
};

}  // namespace

std::vector<double> markov_rates(const std::vector<double>& shares, const std::vector<double>& stays) {
  const std::size_t n = shares.size();
  std::vector<double> flow(n);
  for (std::size_t i = 0; i < n; ++i) flow[i] = shares[i] / stays[i];
  // x_i = (S - sqrt(S^2 - 4 f_i)) / 2 for all but the largest flow, whose x may be beyond S / 2; S by bisection.
  const std::size_t largest = static_cast<std::size_t>(std::ranges::max_element(flow) - flow.begin());
  const auto share_of = [&](double sum, std::size_t i, double sign) {
    return 0.5 * (sum + sign * std::sqrt(std::max(0.0, sum * sum - 4.0 * flow[i])));
  };
  const double least = 2.0 * std::sqrt(flow[largest]);
  const auto excess = [&](double sum, double sign) {
    double total = -sum;
    for (std::size_t i = 0; i < n; ++i) total += share_of(sum, i, i == largest ? sign : -1.0);
    return total;
  };
  // At the least S both branches of the largest meet: with too much there it stays on the lower one, else on the upper.
  const double sign = excess(least, -1.0) >= 0.0 ? -1.0 : 1.0;
  double low = least, high = least;
  while ((excess(high, sign) > 0.0) == (excess(least, sign) > 0.0) && high < 1e6 * least) high *= 2.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    ((excess(middle, sign) > 0.0) == (excess(least, sign) > 0.0) ? low : high) = middle;
  }
  std::vector<double> rates(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      rates[i * n + j] =
          share_of(low, i, i == largest ? sign : -1.0) * share_of(low, j, j == largest ? sign : -1.0) / shares[i];
    }
  }
  return rates;
}

DayPlan draw_day(const CompiledStudy& study, const TrialModel& trial, std::uint32_t run) {
  return Day(study, trial, run).draw();
}

}  // namespace pirsim::sim
