#include "control/outputs.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/text.hpp"
#include "pirsim/csv.hpp"

namespace pirsim::control {
namespace {

std::string number(double value) { return io::csv_number(std::round(value * 1e6) / 1e6); }

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
    const bool knows = light.people == People::known;
    for (const DelayCosts& at : light.by_delay) {
      text << light.id << ',' << number(at.delay_min) << ',' << light.days << ',' << number(light.hours) << ','
           << (knows ? number(light.occupied_h) : "") << ',' << number(at.lit_h) << ','
           << (knows ? number(at.lit_empty_h) : "") << ',' << (knows ? number(at.dark_h) : "") << ','
           << figure(at.lit_share) << ',' << number(at.switched_on_a_day);
      if (knows) {
        text << ',' << at.false_offs << ',' << figure(at.false_offs_an_hour) << ',' << figure(at.dark_share) << ','
             << number(at.longest_dark_s) << ',' << number(at.mean_wait_s) << ',' << number(at.longest_wait_s) << '\n';
      } else {
        text << ",,,,,,,,,,\n";
      }
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

Schedule::Schedule(const RuleSpec& rule, double window_s, int step_min) : step_min_(step_min), window_s_(window_s) {
  for (const LightSpec& light : rule.lights) names_.push_back(light.id);
}

void Schedule::add(const Sample& row, const LitRow& lit) {
  constexpr std::size_t to_date = 10, to_seconds = 19;
  if (row.clock.size() < to_seconds)
    throw Error(ErrorCode::input, "the rows have no clock, so that there is no schedule of their days");
  const auto two = [&](std::size_t at) { return 10 * (row.clock[at] - '0') + (row.clock[at + 1] - '0'); };
  // The row covers the time before its stamp: midnight's belongs to the day before.
  const double second = 3600.0 * two(11) + 60.0 * two(14) + two(17) - 0.5 * window_s_;
  std::string date = row.clock.substr(0, to_date);
  const std::size_t per_day = static_cast<std::size_t>(24 * 60 / step_min_) * names_.size();
  std::vector<Sums>* day = nullptr;
  if (second < 0.0) {
    if (days_.empty()) return;
    day = &std::prev(days_.end())->second;
  } else {
    day = &days_.try_emplace(date, std::vector<Sums>(per_day)).first->second;
  }
  const double in_day_s = second < 0.0 ? second + 86400.0 : second;
  const auto step = static_cast<std::size_t>(in_day_s / (60.0 * step_min_));
  for (std::size_t i = 0; i < names_.size(); ++i) {
    Sums& sums = (*day)[step * names_.size() + i];
    sums.lit += lit.lit[i] == 1 ? window_s_ : 0.0;
    sums.present += lit.people[i] > 0 ? window_s_ : 0.0;
  }
}

void Schedule::write(std::ostream& out) const {
  out << "time";
  for (const std::string& name : names_) out << ",light_" << name << ",presence_" << name;
  out << '\n';
  for (const auto& [date, sums] : days_) {
    for (std::size_t step = 0; step < sums.size() / names_.size(); ++step) {
      const int begin_min = static_cast<int>(step) * step_min_;
      out << date << 'T' << (begin_min < 600 ? "0" : "") << begin_min / 60 << (begin_min % 60 < 10 ? ":0" : ":")
          << begin_min % 60;
      for (std::size_t i = 0; i < names_.size(); ++i) {
        const Sums& at = sums[step * names_.size() + i];
        const auto share = [&](double s) { return fixed(std::min(1.0, s / (60.0 * step_min_)), 4); };
        out << ',' << share(at.lit) << ',' << share(at.present);
      }
      out << '\n';
    }
  }
}

}  // namespace pirsim::control
