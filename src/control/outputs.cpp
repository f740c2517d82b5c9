#include "control/outputs.hpp"

#include <cmath>
#include <span>
#include <sstream>
#include <string_view>

#include "pirsim/csv.hpp"

namespace pirsim::control {
namespace {

constexpr int decimals = 6;

struct CostLine {
  const LightCosts& light;
  const DelayCosts& at;
};

/// Empty where it isn't known.
Cell number(double value) { return std::isnan(value) ? Cell() : Cell(value); }
Cell end_of(const Figure& figure, double Interval::*end) {
  return figure.over_days ? number((*figure.over_days).*end) : Cell();
}

constexpr ColumnInfo info(std::string_view name, std::string_view meaning, std::string_view unit = {}) {
  return {name, Holds::number, meaning, unit, When::always, {}, decimals};
}
constexpr std::string_view low = "low end of its interval over days", high = "high end of its interval over days";

constexpr Column<CostLine> costs_by_delay[]{
    {{"light", Holds::text, "its id"}, [](const CostLine& line) -> Cell { return line.light.id; }},
    {info("delay_min", "from the last motion until it goes off", "min"),
     [](const CostLine& line) { return number(line.at.delay_min); }},
    {{"days", Holds::count, "of the rows"}, [](const CostLine& line) -> Cell { return line.light.days; }},
    {info("hours", "in which all of its sensors are known", "h"),
     [](const CostLine& line) { return number(line.light.hours); }},
    {info("occupied_h", "of them, with somebody there", "h"),
     [](const CostLine& line) { return number(line.light.occupied_h); }},
    {info("lit_h", "with light", "h"), [](const CostLine& line) { return number(line.at.lit_h); }},
    {info("lit_empty_h", "with light while nobody was there", "h"),
     [](const CostLine& line) { return number(line.at.lit_empty_h); }},
    {info("dark_h", "without light while somebody was there", "h"),
     [](const CostLine& line) { return number(line.at.dark_h); }},
    {info("lit_share", "of all hours"), [](const CostLine& line) { return number(line.at.lit_share.value); }},
    {info("lit_share_low", low), [](const CostLine& line) { return end_of(line.at.lit_share, &Interval::low); }},
    {info("lit_share_high", high), [](const CostLine& line) { return end_of(line.at.lit_share, &Interval::high); }},
    {info("switched_on_a_day", "how often"), [](const CostLine& line) { return number(line.at.switched_on_a_day); }},
    {{"false_offs", Holds::count, "how often it went off while somebody was there"},
     [](const CostLine& line) { return line.light.people == People::known ? Cell(line.at.false_offs) : Cell(); }},
    {info("false_offs_an_hour", "of occupied time"),
     [](const CostLine& line) { return number(line.at.false_offs_an_hour.value); }},
    {info("false_offs_an_hour_low", low),
     [](const CostLine& line) { return end_of(line.at.false_offs_an_hour, &Interval::low); }},
    {info("false_offs_an_hour_high", high),
     [](const CostLine& line) { return end_of(line.at.false_offs_an_hour, &Interval::high); }},
    {info("dark_share", "of occupied time"), [](const CostLine& line) { return number(line.at.dark_share.value); }},
    {info("dark_share_low", low), [](const CostLine& line) { return end_of(line.at.dark_share, &Interval::low); }},
    {info("dark_share_high", high), [](const CostLine& line) { return end_of(line.at.dark_share, &Interval::high); }},
    {info("longest_dark_s", "somebody was in the dark without a break", "s"),
     [](const CostLine& line) { return number(line.at.longest_dark_s); }},
    {info("mean_wait_s", "from coming into an empty area to light", "s"),
     [](const CostLine& line) { return number(line.at.mean_wait_s); }},
    {info("longest_wait_s", "the longest of these", "s"),
     [](const CostLine& line) { return number(line.at.longest_wait_s); }},
};

}  // namespace

std::string to_csv(const Costs& costs) {
  std::ostringstream text;
  io::TableWriter<CostLine> csv(text, std::span<const Column<CostLine>>(costs_by_delay));
  for (const LightCosts& light : costs.lights) {
    for (const DelayCosts& at : light.by_delay) csv.write({light, at});
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
