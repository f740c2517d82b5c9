#include "control/outputs.hpp"

#include <cmath>
#include <sstream>

#include "pirsim/csv.hpp"

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

}  // namespace pirsim::control
