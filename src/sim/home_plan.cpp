#include "sim/home_plan.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/random.hpp"
#include "sim/action_line.hpp"
#include "sim/day_draw.hpp"
#include "sim/home_draw.hpp"

namespace pirsim::sim {
namespace {

enum class Posture { sit, lie, stand };

/// A seat or a place that people may take.
struct Spot {
  std::string id;
  Posture posture = Posture::sit;
  std::vector<std::string> uses;
  double taken_until_s = 0.0;  ///< by whoever came last
};

std::vector<Spot> spots_of(const SceneSpec& scene) {
  std::vector<Spot> spots;
  for (const SeatSpec& seat : scene.seats) spots.push_back({seat.id, Posture::sit, seat.uses});
  for (const PlaceSpec& place : scene.places)
    spots.push_back({place.id, place.posture == PlacePosture::lie ? Posture::lie : Posture::stand, place.uses});
  return spots;
}

bool is_for(const Spot& spot, std::string_view use) { return std::ranges::find(spot.uses, use) != spot.uses.end(); }

/// A resident's or a visitor's stay, among those of all.
struct PlannedStay {
  std::size_t person = 0;
  HomeStay stay;
};

class HomeDayPlan {
 public:
  HomeDayPlan(const CompiledStudy& study, std::uint32_t run)
      : study_(study),
        trial_(study.trial_of(run)),
        schedule_(*trial_.schedule),
        spots_(spots_of(study.scene())),
        door_(schedule_.entrances.empty() ? study.scene().entrances.front().id : schedule_.entrances.front()),
        lines_(trial_.people.size(), ActionLine(schedule_)),
        state_(trial_.people.size()) {
    for (std::size_t i = 0; i < trial_.people.size(); ++i)
      conduct_.emplace_back(StreamKey{study.seed(), run, static_cast<std::uint32_t>(i), Purpose::schedule_conduct});
    drawn_ = draw_home_day(*schedule_.household, study.seed(), run, day_of(study, run));
  }

  DayPlan take() {
    for (const PlannedStay& planned : in_order()) spend(planned.person, planned.stay);
    DayPlan plan;
    for (std::size_t i = 0; i < trial_.people.size(); ++i)
      plan.push_back(trial_.people[i].spec.part ? lines_[i].take() : trial_.people[i].spec.actions);
    return plan;
  }

 private:
  enum class State { unborn, present, away };

  /// Everybody's stays by their beginning; of two that begin at once, that of the resident who is named first.
  std::vector<PlannedStay> in_order() const {
    std::vector<PlannedStay> all;
    std::size_t resident = 0, visitor = 0;
    for (std::size_t i = 0; i < trial_.people.size(); ++i) {
      const auto& part = trial_.people[i].spec.part;
      if (part && part->part == SchedulePart::resident) {
        for (const HomeStay& stay : drawn_.residents[resident]) all.push_back({i, stay});
        ++resident;
      } else if (part && part->part == SchedulePart::visitor && visitor < drawn_.visits.size()) {
        const Visit& visit = drawn_.visits[visitor++];
        all.push_back({i, {HomeActivity::rest, visit.comes_s, visit.goes_s}});
        all.push_back({i, {HomeActivity::away, visit.goes_s, visit.goes_s}});
      }
    }
    std::ranges::stable_sort(all, {}, [](const PlannedStay& planned) { return planned.stay.from_s; });
    return all;
  }

  void spend(std::size_t person, const HomeStay& stay) {
    ActionLine& line = lines_[person];
    if (stay.activity == HomeActivity::away) {
      if (state_[person] == State::present) line.at(stay.from_s, action::Leave{door_});
      state_[person] = State::away;
      return;
    }
    if (state_[person] == State::unborn && trial_.people[person].spec.part->part == SchedulePart::resident) {
      line.at(stay.from_s, action::Appear{{}, 0.0, trial_.people[person].spec.part->seat});
    } else if (state_[person] != State::present) {
      line.at(stay.from_s, action::Enter{door_});
    }
    const bool was_there = state_[person] != State::unborn;
    state_[person] = State::present;
    const HomeManner manner = manner_of(stay.activity);
    Spot* const spot = spot_for(person, stay, manner);
    if (spot == nullptr) return stay_there(line, stay, manner);
    spot->taken_until_s = stay.to_s;
    if (was_there || spot->id != trial_.people[person].spec.part->seat) take(line, stay.from_s, *spot, manner.phase);
    if (stay.activity == HomeActivity::work && spot->posture == Posture::sit)
      return work_there(line, stay, conduct_[person], manner.phase);
    line.then(action::Wait{until_next_s, fitting(manner.activity, spot->posture)}, manner.phase);
  }

  static void take(ActionLine& line, double at_s, const Spot& spot, const char* phase) {
    switch (spot.posture) {
      case Posture::sit:
        return line.at(at_s, action::Sit{spot.id}, phase);
      case Posture::lie:
        return line.at(at_s, action::Lie{spot.id}, phase);
      case Posture::stand:
        return line.at(at_s, action::Stand{spot.id}, phase);
    }
  }

  static void stay_there(ActionLine& line, const HomeStay& stay, const HomeManner& manner) {
    line.at(stay.from_s, action::Wait{until_next_s}, manner.phase);
  }

  /// As at a desk of an office: one thing after the other.
  static void work_there(ActionLine& line, const HomeStay& stay, Stream& stream, const char* phase) {
    for (double left_s = stay.to_s - stay.from_s; left_s > 0.0;) {
      action::Work work = draw_desk_work(stream);
      left_s -= work.duration_s;
      if (left_s <= 0.0) work.duration_s = until_next_s;
      line.then(work, phase);
    }
  }

  /// What a person of natural style can do in that posture.
  static std::optional<Activity> fitting(std::optional<Activity> activity, Posture posture) {
    if (!activity) return std::nullopt;
    const bool is_standing = *activity == Activity::cooking || *activity == Activity::washing;
    if (*activity == Activity::sleeping) return posture == Posture::lie ? activity : std::nullopt;
    if (*activity == Activity::eating) return posture == Posture::sit ? activity : std::nullopt;
    return is_standing == (posture == Posture::stand) ? activity : std::nullopt;
  }

  /// Sleepers have their own. Of others the first that is free, beginning with another for each person; none: nullptr.
  Spot* spot_for(std::size_t person, const HomeStay& stay, const HomeManner& manner) {
    const std::string& bed = trial_.people[person].spec.part->seat;
    if (stay.activity == HomeActivity::sleep && !bed.empty()) return &*std::ranges::find(spots_, bed, &Spot::id);
    const auto is_free = [&](const Spot& spot) {
      return spot.taken_until_s <= stay.from_s &&
             (spot.posture != Posture::sit || trial_.people[person].can_use(spot.id));
    };
    for (const std::string_view use : manner.uses) {
      std::vector<Spot*> fit;
      for (Spot& spot : spots_)
        if (is_for(spot, use)) fit.push_back(&spot);
      // Each person their own of those that are for it before all, then of those that will do.
      const auto others = std::ranges::stable_partition(fit, [&](Spot* spot) { return spot->uses.front() == use; });
      const std::size_t n_first = fit.size() - others.size();
      for (const std::span<Spot*> spots : {std::span(fit).first(n_first), std::span(fit).subspan(n_first)}) {
        for (std::size_t k = 0; k < spots.size(); ++k)
          if (Spot* const spot = spots[(person + k) % spots.size()]; is_free(*spot)) return spot;
      }
    }
    for (Spot& spot : spots_)
      if (spot.uses.empty() && spot.posture == Posture::sit && is_free(spot)) return &spot;
    return nullptr;
  }

  const CompiledStudy& study_;
  const TrialModel& trial_;
  const ScheduleSpec& schedule_;
  std::vector<Spot> spots_;
  std::string door_;
  std::vector<ActionLine> lines_;
  std::vector<State> state_;
  std::vector<Stream> conduct_;  ///< (n_people)
  HomeDay drawn_;
};

}  // namespace

HomeManner manner_of(HomeActivity activity) {
  switch (activity) {
    case HomeActivity::sleep:
      return {"sleeping", Activity::sleeping, {"sleep"}};
    case HomeActivity::toilet:
      return {"toilet", std::nullopt, {"toilet"}};
    case HomeActivity::wash:
      return {"washing", Activity::washing, {"wash", "shower", "dress"}};
    case HomeActivity::cook:
      return {"cooking", Activity::cooking, {"cook"}};
    case HomeActivity::eat:
      return {"eating", Activity::eating, {"eat"}};
    case HomeActivity::chores:
      return {"chores", Activity::cooking, {"chores", "cook", "wash"}};
    case HomeActivity::tv:
      return {"watching_tv", Activity::watching_tv, {"tv", "rest"}};
    case HomeActivity::read:
      return {"reading", Activity::reading, {"read", "rest", "tv"}};
    case HomeActivity::hobby:
      return {"hobby", Activity::reading, {"work", "play", "eat"}};
    case HomeActivity::rest:
      return {"resting", Activity::watching_tv, {"rest", "tv", "eat"}};
    case HomeActivity::work:
      return {"working", Activity::typing, {"work"}};
    case HomeActivity::away:
      break;
  }
  return {"away", std::nullopt, {}};
}

bool has_place_for(const SceneSpec& scene, HomeActivity activity) {
  const std::vector<std::string_view> uses = manner_of(activity).uses;
  return uses.empty() || std::ranges::any_of(spots_of(scene), [&](const Spot& spot) {
           return (spot.uses.empty() && spot.posture == Posture::sit) ||
                  std::ranges::any_of(uses, [&](std::string_view use) { return is_for(spot, use); });
         });
}

DayPlan plan_home_day(const CompiledStudy& study, std::uint32_t run) { return HomeDayPlan(study, run).take(); }

}  // namespace pirsim::sim
