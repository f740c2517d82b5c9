#include "engine/sim/day_draw.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "model/schema/clock.hpp"

namespace pirsim::sim {

namespace {

constexpr double day_s = 24.0 * hour_s;

double stay_s(Stream& stream, double mean_s) {
  const double least_s = std::min(shortest_stay_s, mean_s);
  return least_s + exponential(stream, mean_s - least_s);
}

/// What is left of a stay that one finds going on.
double rest_of_stay_s(Stream& stream, double mean_s) {
  const double least_s = std::min(shortest_stay_s, mean_s);
  if (stream.uniform() * mean_s < least_s) return least_s * stream.uniform();
  return stay_s(stream, mean_s);
}

/// One person's moves between places, as found going on at any moment: shares of time hold from the first second.
class Moves {
 public:
  explicit Moves(const Habits& habits) : habits_(habits) {
    for (std::size_t i = 0; i < n_places; ++i) stays_s_[i] = habits_.stays_min[i] * minute_s;
    rates_ = markov_rates(habits_.shares, stays_s_);
  }

  void spend(double from_s, double to_s, Stream& stream, std::vector<Stay>& stays) const {
    std::size_t place = pick(stream, habits_.shares);
    double until_s = from_s + rest_of_stay_s(stream, stays_s_[place]);
    for (double now = from_s; now < to_s;) {
      stays.push_back({static_cast<Place>(place), now, std::min(until_s, to_s)});
      now = until_s;
      place = pick(stream, std::span(rates_).subspan(place * n_places, n_places));
      until_s = now + stay_s(stream, stays_s_[place]);
    }
  }

 private:
  Habits habits_;
  std::array<double, n_places> stays_s_{};
  std::vector<double> rates_;
};

/// Who is called to meetings of the schedule goes to no others.
Habits habits_in(const ScheduleSpec& schedule, Role role) {
  Habits habits = habits_of(role);
  if (std::ranges::find(schedule.meetings, Attendees::staff, &MeetingsSpec::attendees) == schedule.meetings.end())
    return habits;
  double& met = habits.shares[static_cast<std::size_t>(Place::meeting)];
  const double others = 1.0 - met;
  met = 0.0;
  for (double& share : habits.shares) share /= others;
  return habits;
}

std::vector<Stay> draw_agent(const ScheduleSpec& schedule, Role role, Stream& stream) {
  const double arrival = std::max(0.0, around(stream, schedule.arrival));
  const double departure = std::clamp(around(stream, schedule.departure), arrival, day_s - minute_s);
  const double lunch = around(stream, schedule.lunch);
  const double lunch_s = minute_s * std::max(0.0, schedule.lunch_min + schedule.lunch_sd_min * cut_normal(stream));
  std::vector<Stay> stays;
  const Moves moves(habits_in(schedule, role));
  if (lunch_s > 0.0 && lunch > arrival && lunch + lunch_s < departure) {
    moves.spend(arrival, lunch, stream, stays);
    stays.push_back({Place::lunch, lunch, lunch + lunch_s});
    moves.spend(lunch + lunch_s, departure, stream, stays);
  } else {
    moves.spend(arrival, departure, stream, stays);
  }
  return stays;
}

const Stay* stay_at(const std::vector<Stay>& stays, double at_s) {
  const auto stay = std::ranges::find_if(stays, [&](const Stay& s) { return s.from_s <= at_s && at_s < s.to_s; });
  return stay == stays.end() ? nullptr : &*stay;
}

/// Visits go to somebody who is at their desk then.
void find_hosts(const DaySource& source, DayDraw& draw) {
  for (std::size_t i = 0; i < draw.stays.size(); ++i) {
    Stream stream({source.seed, source.run, static_cast<std::uint32_t>(i), Purpose::schedule_conduct});
    for (Stay& stay : draw.stays[i]) {
      if (stay.place != Place::others_desk) continue;
      std::vector<std::size_t> hosts;
      for (std::size_t other = 0; other < draw.stays.size(); ++other) {
        const Stay* theirs = other == i ? nullptr : stay_at(draw.stays[other], stay.from_s);
        if (theirs != nullptr && theirs->place == Place::desk) hosts.push_back(other);
      }
      if (!hosts.empty()) stay.host = hosts[stream.index(static_cast<std::uint32_t>(hosts.size()))];
    }
  }
}

}  // namespace

Habits habits_of(Role role) {
  constexpr std::array<double, n_places> stays_min{60.0, 20.0, 60.0, 20.0};
  switch (role) {
    case Role::staff:
      return {{0.60, 0.20, 0.15, 0.05}, stays_min};
    case Role::manager:
      return {{0.50, 0.20, 0.20, 0.10}, stays_min};
    case Role::administrator:
      return {{0.70, 0.15, 0.05, 0.10}, stays_min};
  }
  return {};
}

std::size_t pick(Stream& stream, std::span<const double> weights) {
  double left = stream.uniform() * std::accumulate(weights.begin(), weights.end(), 0.0);
  std::size_t last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    last = i;
    if ((left -= weights[i]) < 0.0) break;
  }
  return last;
}

double cut_normal(Stream& stream) { return std::clamp(stream.normal(), -3.0, 3.0); }

double around(Stream& stream, const ClockSpec& clock) {
  return clock.mean_h * hour_s + clock.sd_min * minute_s * cut_normal(stream);
}

double exponential(Stream& stream, double mean) { return -mean * std::log(1.0 - stream.uniform()); }

std::vector<action::Work> draw_desk_work(Stream& stream, double for_s) {
  constexpr double shortest_s = 2.0 * minute_s, further_s = 8.0 * minute_s;  // assumed: an activity (means of 5-20 min)
  std::vector<action::Work> works;
  for (double left_s = for_s; left_s > 0.0;) {
    action::Work& work = works.emplace_back();
    work.duration_s = shortest_s + exponential(stream, further_s);
    const double u = stream.uniform();  // assumed shares: typing 0.65 (0.5-0.8), reading 0.25, phone 0.1
    work.activity = u < 0.65 ? Activity::typing : u < 0.90 ? Activity::reading : Activity::phone;
    left_s -= work.duration_s;
    if (left_s <= 0.0) work.duration_s = until_next_s;
  }
  return works;
}

std::vector<double> markov_rates(std::span<const double> shares, std::span<const double> stays) {
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

namespace {

void shuffle(Stream& stream, std::vector<std::size_t>& list) {
  for (std::size_t i = list.size(); i > 1; --i)
    std::swap(list[i - 1], list[stream.index(static_cast<std::uint32_t>(i))]);
}

Stream meetings_stream(const DaySource& source, std::size_t room) {
  return Stream({source.seed, source.run, static_cast<std::uint32_t>(room), Purpose::schedule_meetings});
}

struct Slot {
  double begin_s, end_s;
  int people;
};

std::vector<Slot> held_slots(const MeetingsSpec& spec) {
  std::vector<Slot> slots;
  for (const HeldMeetingSpec& held : spec.held) {
    slots.push_back({held.at_h * hour_s, held.at_h * hour_s + held.duration_min * minute_s, held.people});
  }
  std::ranges::sort(slots, {}, &Slot::begin_s);
  return slots;
}

/// Number and lengths first, then where they lie among the free quarters of an hour, all ways equally likely: so their
/// lengths are as asked for. The last ones drawn are left out if all together are longer than the day.
std::vector<Slot> drawn_slots(const MeetingsSpec& spec, int most_people, Stream& stream) {
  constexpr double quarter_s = 15.0 * minute_s;
  const auto range = [&](int low, int high) {
    return low + static_cast<int>(stream.index(static_cast<std::uint32_t>(std::max(0, high - low) + 1)));
  };
  const auto all = static_cast<std::int64_t>((spec.to_h - spec.from_h) * hour_s / quarter_s + 1e-9);
  std::int64_t used = 0;
  std::vector<double> lengths;
  for (int left = range(spec.fewest_a_day, spec.most_a_day); left > 0; --left) {
    const double length_s = spec.durations_min[pick(stream, spec.probabilities)] * minute_s;
    const auto quarters = static_cast<std::int64_t>(std::ceil(length_s / quarter_s - 1e-9));
    if (used + quarters > all) break;
    used += quarters;
    lengths.push_back(length_s);
  }
  // The free quarters before each of n meetings: n of (free + n) places, none taken twice.
  std::vector<std::size_t> places(static_cast<std::size_t>(all - used) + lengths.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  shuffle(stream, places);
  places.resize(lengths.size());
  std::ranges::sort(places);
  std::vector<Slot> slots;
  double before_s = 0.0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const double begin_s = spec.from_h * hour_s + static_cast<double>(places[i] - i) * quarter_s + before_s;
    slots.push_back({begin_s, begin_s + lengths[i], range(spec.fewest_people, most_people)});
    before_s += std::ceil(lengths[i] / quarter_s - 1e-9) * quarter_s;
  }
  return slots;
}

Attendance attend(const Slot& slot, double lateness_s, Stream& stream) {
  constexpr double punctual_s = 3.0 * minute_s;  // assumed (0-5 min): the first come so long before
  constexpr double leaves_early = 0.1;           // assumed (0-0.2)
  const double length_s = slot.end_s - slot.begin_s;
  Attendance person;
  const double late_s = exponential(stream, lateness_s + punctual_s) - punctual_s;
  person.comes_s = slot.begin_s + std::min(late_s, 0.5 * length_s);
  const double share = stream.uniform(), within = stream.uniform();
  person.goes_s =
      share < leaves_early ? slot.begin_s + (0.6 + 0.3 * within) * length_s : slot.end_s + minute_s * within;
  return person;
}

std::vector<Slot> slots_of(const MeetingsSpec& spec, int most_people, Stream& stream) {
  return spec.held.empty() ? drawn_slots(spec, most_people, stream) : held_slots(spec);
}

/// Those of `people` who come, as many as the slot is for.
Meeting draw_meeting(const Slot& slot, std::size_t room, double lateness_s, std::vector<std::size_t> people,
                     Stream& stream) {
  constexpr double presented = 0.5;  // assumed (0.3-0.7): share of meetings in which somebody stands at the screen
  shuffle(stream, people);
  people.resize(std::min(static_cast<std::size_t>(slot.people), people.size()));
  Meeting meeting{room, slot.begin_s, slot.end_s, {}};
  for (const std::size_t person : people) {
    meeting.people.push_back(attend(slot, lateness_s, stream));
    meeting.people.back().person = person;
  }
  const double shown = stream.uniform(), share = stream.uniform();
  if (shown >= presented || people.size() < 2) return meeting;
  Attendance& speaker = *std::ranges::min_element(meeting.people, {}, &Attendance::comes_s);
  speaker.goes_s = std::max(speaker.goes_s, slot.end_s);
  speaker.presents_until_s = slot.begin_s + (0.3 + 0.4 * share) * (slot.end_s - slot.begin_s);
  return meeting;
}

/// Is somebody at work all the time, neither at lunch nor called to another meeting?
bool can_attend(const std::vector<Stay>& stays, const std::vector<Meeting>& meetings, const Slot& slot) {
  double there_s = 0.0;
  for (const Stay& stay : stays) {
    const double both_s = std::min(stay.to_s, slot.end_s) - std::max(stay.from_s, slot.begin_s);
    if (stay.meeting) {  // from its beginning to its end, however late they come
      const Meeting& other = meetings[*stay.meeting];
      if (other.begin_s < slot.end_s && slot.begin_s < other.end_s) return false;
    }
    if (both_s <= 0.0) continue;
    if (stay.place == Place::lunch) return false;
    there_s += both_s;
  }
  return there_s >= slot.end_s - slot.begin_s - 1e-6;
}

/// Where a stay takes the place of others, they end before or go on after.
void put_in(std::vector<Stay>& stays, const Stay& stay) {
  std::vector<Stay> result;
  for (const Stay& old : stays) {
    Stay before = old, after = old;
    before.to_s = std::min(old.to_s, stay.from_s);
    after.from_s = std::max(old.from_s, stay.to_s);
    if (before.to_s > before.from_s) result.push_back(before);
    if (after.to_s > after.from_s) result.push_back(after);
  }
  result.insert(std::ranges::find_if(result, [&](const Stay& other) { return other.from_s > stay.from_s; }), stay);
  stays = std::move(result);
}

/// They come no earlier than to work, and from the meeting before.
void call_in(DayDraw& draw, Meeting meeting) {
  for (Attendance& who : meeting.people) {
    std::vector<Stay>& stays = draw.stays[who.person];
    who.comes_s = std::max(who.comes_s, stays.front().from_s);
    for (const Stay& stay : stays) {
      if (stay.meeting && stay.from_s < who.comes_s) who.comes_s = std::max(who.comes_s, stay.to_s);
    }
    who.comes_s = std::min(who.comes_s, who.goes_s - 1.0);
    put_in(stays, {Place::meeting, who.comes_s, who.goes_s, {}, draw.meetings.size()});
  }
  draw.meetings.push_back(std::move(meeting));
}

/// Meetings of those who are at work then, room by room in order of time; where fewer than two are, nobody meets.
void draw_staff_meetings(const DaySource& source, DayDraw& draw) {
  struct Call {
    Slot slot;
    std::size_t room;
  };
  std::vector<Call> calls;
  std::vector<Stream> streams;  // a room's
  const std::vector<MeetingsSpec>& rooms = source.schedule.meetings;
  for (std::size_t room = 0; room < rooms.size(); ++room) {
    streams.emplace_back(meetings_stream(source, room));
    if (rooms[room].attendees != Attendees::staff) continue;
    for (const Slot& slot : slots_of(rooms[room], source.most_at_meeting[room], streams.back()))
      calls.push_back({slot, room});
  }
  std::ranges::stable_sort(calls, {}, [](const Call& call) { return call.slot.begin_s; });
  for (const auto& [slot, room] : calls) {
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < draw.stays.size(); ++i) {
      if (can_attend(draw.stays[i], draw.meetings, slot)) free.push_back(i);
    }
    if (free.size() < 2) continue;
    call_in(draw, draw_meeting(slot, room, rooms[room].lateness_min * minute_s, std::move(free), streams[room]));
  }
}

void draw_guests_meetings(const DaySource& source, std::size_t room, DayDraw& draw) {
  std::vector<std::size_t> guests;
  for (std::size_t i = 0; i < source.people.size(); ++i) {
    const auto& person = source.people[i];
    if (person && person->part == SchedulePart::guest && person->room == room) guests.push_back(i);
  }
  if (guests.empty()) return;
  const MeetingsSpec& spec = source.schedule.meetings[room];
  Stream stream = meetings_stream(source, room);
  for (const Slot& slot : slots_of(spec, static_cast<int>(guests.size()), stream))
    draw.meetings.push_back(draw_meeting(slot, room, spec.lateness_min * minute_s, guests, stream));
}

}  // namespace

DayDraw draw_times(const DaySource& source) {
  DayDraw draw;
  draw.stays.resize(source.people.size());
  if (!is_working_day(source.day)) return draw;
  for (std::size_t i = 0; i < source.people.size(); ++i) {
    const auto& person = source.people[i];
    if (!person) continue;
    Stream stream({source.seed, source.run, static_cast<std::uint32_t>(i), Purpose::schedule});
    if (person->part == SchedulePart::cleaner)
      draw.cleaning_s = source.schedule.cleaning_h.value_or(0.0) * hour_s + 10.0 * minute_s * cut_normal(stream);
    if (person->part != SchedulePart::staff) continue;
    draw.stays[i] = draw_agent(source.schedule, person->role, stream);
  }
  for (std::size_t room = 0; room < source.schedule.meetings.size(); ++room) draw_guests_meetings(source, room, draw);
  draw_staff_meetings(source, draw);
  find_hosts(source, draw);
  return draw;
}

}  // namespace pirsim::sim
