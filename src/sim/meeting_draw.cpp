#include "sim/meeting_draw.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace pirsim::sim {
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

void draw_meetings(const DaySource& source, DayDraw& draw) {
  for (std::size_t room = 0; room < source.schedule.meetings.size(); ++room) draw_guests_meetings(source, room, draw);
  draw_staff_meetings(source, draw);
}

}  // namespace pirsim::sim
