#include "control/outputs.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/text.hpp"
#include "pirsim/csv.hpp"
#include "schema/clock.hpp"

namespace pirsim::control {
namespace {

/// No text for what isn't known.
std::string number(double value) {
  if (std::isnan(value)) return {};
  return io::csv_number(std::round(value * 1e6) / 1e6);
}

std::string figure(const Figure& figure) {
  const auto end = [&](double Interval::*which) { return figure.over_days ? number((*figure.over_days).*which) : ""; };
  return number(figure.value) + ',' + end(&Interval::low) + ',' + end(&Interval::high);
}

}  // namespace

std::string to_csv(const Costs& costs) {
  std::ostringstream text;
  text << "light,delay_min,days,hours,occupied_h,lit_h,lit_empty_h,dark_h,lit_share,lit_share_low,lit_share_high,"
          "switched_on_a_day,false_offs,false_offs_an_hour,false_offs_an_hour_low,false_offs_an_hour_high,dark_share,"
          "dark_share_low,dark_share_high,longest_dark_s,mean_wait_s,longest_wait_s\n";
  for (const LightCosts& light : costs.lights) {
    for (const DelayCosts& at : light.by_delay) {
      text << light.id << ',' << number(at.delay_min) << ',' << light.days << ',' << number(light.hours) << ','
           << number(light.occupied_h) << ',' << number(at.lit_h) << ',' << number(at.lit_empty_h) << ','
           << number(at.dark_h) << ',' << figure(at.lit_share) << ',' << number(at.switched_on_a_day) << ','
           << (light.people == People::known ? std::to_string(at.false_offs) : "") << ','
           << figure(at.false_offs_an_hour) << ',' << figure(at.dark_share) << ',' << number(at.longest_dark_s) << ','
           << number(at.mean_wait_s) << ',' << number(at.longest_wait_s) << '\n';
    }
  }
  return text.str();
}

// ------------------------------------------------------------------------------------------------------ light by row

LitTable::LitTable(std::ostream& out, const RuleSpec& rule) : out_(out) {
  constexpr std::size_t which_row = 4;  // columns of rows that say which one it is, the last of them its clock
  const char* before = "";
  for (const Column<Sample>& column : columns_of<Sample>().first(which_row)) {
    out_ << before << column.name;
    before = ",";
  }
  for (const LightSpec& light : rule.lights) out_ << ",lit_" << light.id;
  for (const LightSpec& light : rule.lights) out_ << ",people_" << light.id;
  out_ << '\n';
}

void LitTable::add(const Sample& row, const LitRow& lit) {
  out_ << row.replicate << ',' << io::csv_field(row.trial) << ',' << io::csv_number(row.time_s) << ',' << row.clock;
  for (const std::uint8_t bit : lit.lit) out_ << ',' << (bit < 2 ? std::to_string(bit) : "");
  for (const std::int32_t people : lit.people) out_ << ',' << (people >= 0 ? std::to_string(people) : "");
  out_ << '\n';
}

// -------------------------------------------------------------------------------------------------------- a schedule

Schedule::Schedule(const RuleSpec& rule, double window_s, int step_min, People people)
    : window_s_(window_s), step_s_(60.0 * step_min), people_(people) {
  for (const LightSpec& light : rule.lights) names_.push_back(light.id);
}

void Schedule::add(const LitRow& lit) {
  if (!lit.ends_s) throw Error(ErrorCode::input, "rows have no clock (`time`), and a schedule is one of dates");
  const auto end_s = static_cast<double>(*lit.ends_s);
  for (double from_s = end_s - window_s_; from_s < end_s;) {  // a row may cover several steps, and midnight
    const double step = std::floor(from_s / step_s_), to_s = std::min(end_s, (step + 1.0) * step_s_);
    const auto steps_a_day = static_cast<std::int64_t>(day_s / step_s_), at = static_cast<std::int64_t>(step);
    const std::int64_t day = (at - (at < 0 ? steps_a_day - 1 : 0)) / steps_a_day;
    std::vector<Sums>& sums =
        days_.try_emplace(day, static_cast<std::size_t>(steps_a_day) * names_.size()).first->second;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      Sums& of_light = sums[static_cast<std::size_t>(at - day * steps_a_day) * names_.size() + i];
      const double s = to_s - from_s;
      of_light.lit += lit.lit[i] == 1 ? s : 0.0;
      of_light.known += lit.lit[i] <= 1 ? s : 0.0;
      of_light.present += lit.people[i] > 0 ? s : 0.0;
      of_light.counted += lit.people[i] >= 0 ? s : 0.0;
    }
    from_s = to_s;
  }
}

void Schedule::write(std::ostream& out) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    bool is_known = false;
    for (const auto& [day, sums] : days_) {
      for (std::size_t at = i; at < sums.size(); at += names_.size()) is_known = is_known || sums[at].known > 0.0;
    }
    if (!is_known)
      throw Error(ErrorCode::input, "there is no schedule of light '" + names_[i] + "': nothing is known of it");
  }
  const bool knows = people_ == People::known;
  out << "time";
  for (const std::string& name : names_) out << ",light_" << name << (knows ? ",presence_" + name : "");
  out << '\n';
  const auto share = [](double part, double all) { return ',' + fixed(all > 0.0 ? part / all : 0.0, 4); };
  for (const auto& [day, sums] : days_) {
    for (std::size_t first = 0; first < sums.size(); first += names_.size()) {
      constexpr std::size_t to_minutes = 16;
      out << clock_text(day, static_cast<double>(first / names_.size()) * step_s_).substr(0, to_minutes);
      for (std::size_t i = first; i < first + names_.size(); ++i)
        out << share(sums[i].lit, sums[i].known) << (knows ? share(sums[i].present, sums[i].counted) : "");
      out << '\n';
    }
  }
}

std::vector<Issue> Schedule::remarks() const {
  double unknown_h = 0.0;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    std::size_t n = 0;
    for (const auto& [day, sums] : days_) {
      for (std::size_t at = i; at < sums.size(); at += names_.size())
        n += sums[at].known == 0.0 || (people_ == People::known && sums[at].counted == 0.0);
    }
    unknown_h = std::max(unknown_h, static_cast<double>(n) * step_s_ / 3600.0);
  }
  std::vector<Issue> remarks;
  const auto tell = [&](const std::string& text) {
    remarks.push_back({Severity::warning, {}, "the schedule " + text});
  };
  if (unknown_h > 0.0)
    tell("has " + fixed(unknown_h, 1) + " h of which nothing is known: it is dark" +
         (people_ == People::known ? " and empty" : "") + " there");
  if (days_.empty()) return remarks;
  const auto n_dates = static_cast<std::size_t>(days_.rbegin()->first - days_.begin()->first + 1);
  if (n_dates > days_.size())
    tell("lacks " + counted(n_dates - days_.size(), "date") +
         " between its first and its last: `Schedule:File` reads on");
  const auto is_leap_day = [](const auto& day) { return clock_text(day.first, 0.0).substr(4, 6) == "-02-29"; };
  if (std::ranges::any_of(days_, is_leap_day)) tell("has 29 February: of a leap year `Schedule:File` takes 8784 hours");
  return remarks;
}

}  // namespace pirsim::control
