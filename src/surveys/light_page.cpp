#include "surveys/light_page.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

#include "model/core/text.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/csv.hpp"

namespace pirsim::control {
namespace {

constexpr int decimals = 6;

bool knows_people(const LightCosts& light) { return light.people != People::unknown; }

/// Empty where it isn't known.
Cell number(double value) { return std::isnan(value) ? Cell() : Cell(value); }
template <double LightCosts::*member>
Cell of_light(const CostLine& line) {
  return number(line.light.*member);
}
template <double DelayCosts::*member>
Cell of_delay(const CostLine& line) {
  return number(line.at.*member);
}
template <Figure DelayCosts::*member>
Cell value_of(const CostLine& line) {
  return number((line.at.*member).value);
}
template <Figure DelayCosts::*member, double Interval::*end>
Cell end_of(const CostLine& line) {
  const Figure& figure = line.at.*member;
  return figure.over_days ? number((*figure.over_days).*end) : Cell();
}

constexpr ColumnInfo info(std::string_view name, std::string_view meaning, std::string_view unit = {}) {
  return {name, Holds::number, meaning, unit, When::always, {}, decimals};
}
constexpr std::string_view low = "low end of its interval over days", high = "high end of its interval over days";

constexpr Column<CostLine> costs_by_delay[]{
    {{"light", Holds::text, "its id"}, [](const CostLine& line) -> Cell { return line.light.id; }},
    {info("delay_min", "from the last motion until it goes off; empty: it goes by `nobody`", "min"),
     of_delay<&DelayCosts::delay_min>},
    {{"days", Holds::count, "of the rows"}, [](const CostLine& line) -> Cell { return line.light.days; }},
    {info("hours", "in which all of its sensors are known", "h"), of_light<&LightCosts::hours>},
    {info("occupied_h", "of them, with somebody there who doesn't sleep or go to bed", "h"),
     of_light<&LightCosts::occupied_h>},
    {info("lit_h", "with light", "h"), of_delay<&DelayCosts::lit_h>},
    {info("lit_empty_h", "with light while nobody was there", "h"), of_delay<&DelayCosts::lit_empty_h>},
    {info("dark_h", "without light while somebody was there", "h"), of_delay<&DelayCosts::dark_h>},
    {info("lit_share", "of all hours"), value_of<&DelayCosts::lit_share>},
    {info("lit_share_low", low), end_of<&DelayCosts::lit_share, &Interval::low>},
    {info("lit_share_high", high), end_of<&DelayCosts::lit_share, &Interval::high>},
    {info("switched_on_a_day", "how often"), of_delay<&DelayCosts::switched_on_a_day>},
    {info("false_offs", "how often it went off while somebody was there"),
     [](const CostLine& line) { return knows_people(line.light) ? Cell(line.at.false_offs) : Cell(); }},
    {info("false_offs_an_hour", "of occupied time"), value_of<&DelayCosts::false_offs_an_hour>},
    {info("false_offs_an_hour_low", low), end_of<&DelayCosts::false_offs_an_hour, &Interval::low>},
    {info("false_offs_an_hour_high", high), end_of<&DelayCosts::false_offs_an_hour, &Interval::high>},
    {info("dark_share", "of occupied time"), value_of<&DelayCosts::dark_share>},
    {info("dark_share_low", low), end_of<&DelayCosts::dark_share, &Interval::low>},
    {info("dark_share_high", high), end_of<&DelayCosts::dark_share, &Interval::high>},
    {info("longest_dark_s", "somebody was in the dark without a break", "s"), of_delay<&DelayCosts::longest_dark_s>},
    {info("mean_wait_s", "from coming into an empty area to light", "s"), of_delay<&DelayCosts::mean_wait_s>},
    {info("longest_wait_s", "the longest of these", "s"), of_delay<&DelayCosts::longest_wait_s>},
    {info("empty_share", "of all hours, with light while nobody was there"), value_of<&DelayCosts::empty_share>},
    {info("empty_share_low", low), end_of<&DelayCosts::empty_share, &Interval::low>},
    {info("empty_share_high", high), end_of<&DelayCosts::empty_share, &Interval::high>},
    {info("nobody", "it goes off once a counter gives so much to nobody being there; empty: after a delay"),
     [](const CostLine& line) { return line.at.nobody ? Cell(*line.at.nobody) : Cell(); }},
};

std::string minutes(double delay_min) { return shortest_number(delay_min) + " min"; }
std::string share(double value) { return percent(value, value < 0.1 ? 1 : 0); }
std::string range(const Figure& figure, double scale, int digits) {
  if (!figure.over_days) return "";
  return " (" + fixed(scale * figure.over_days->low, digits) + " to " + fixed(scale * figure.over_days->high, digits) +
         ")";
}
std::string time(double seconds) {
  return seconds < 120.0 ? fixed(seconds, 0) + " s" : fixed(seconds / 60.0, seconds < 6000.0 ? 1 : 0) + " min";
}
/// A dash for what isn't known.
std::string told(double value, int digits) { return std::isnan(value) ? "-" : fixed(value, digits); }

/// Its delays that a table tells.
std::vector<double> told_delays(const LightCosts& light) {
  std::vector<double> delays{1.0, 5.0, 10.0, 15.0, 20.0, 30.0, 60.0};
  delays.insert(delays.end(), light.rule_delays_min.begin(), light.rule_delays_min.end());
  std::ranges::sort(delays);
  delays.erase(std::ranges::unique(delays).begin(), delays.end());
  return delays;
}

std::string energy(const LightCosts& light, double hours) {
  return light.power_w > 0.0 ? fixed(light.a_day(hours) * light.power_w / 1000.0, 2) : "";
}

/// One line of a light's table; what isn't known, or means nothing there, is no text.
struct TableRow {
  std::string delay, offs, offs_an_hour, dark, longest_dark, lit, empty, switched_on, wait, energy;
};

void add(io::Table& table, const LightCosts& light, const TableRow& row) {
  const bool knows = knows_people(light);
  std::vector<std::string> texts{row.delay};
  if (knows) texts.insert(texts.end(), {row.offs, row.offs_an_hour, row.dark, row.longest_dark});
  texts.push_back(row.lit);
  if (knows) texts.push_back(row.empty);
  if (light.power_w > 0.0) texts.push_back(row.energy);
  texts.push_back(row.switched_on);
  if (knows) texts.push_back(row.wait);
  (table.headings.empty() ? table.headings : table.rows.emplace_back()) = std::move(texts);
}

io::Table table_of(const LightCosts& light) {
  io::Table table;
  add(table, light,
      {"delay, min", "off on somebody", "an occupied hour", "dark, %", "longest", "lit, h/day", "empty, h/day",
       "switched on", "wait", "kWh/day"});
  const auto tell = [&](const std::string& name, const DelayCosts& at) {
    add(table, light,
        {name, fixed(at.false_offs, light.people == People::expected ? 1 : 0),
         told(at.false_offs_an_hour.value, 2) + range(at.false_offs_an_hour, 1.0, 2),
         told(100.0 * at.dark_share.value, 1) + range(at.dark_share, 100.0, 1), time(at.longest_dark_s),
         fixed(light.a_day(at.lit_h), 2), fixed(light.a_day(at.lit_empty_h), 2), fixed(at.switched_on_a_day, 1),
         std::isnan(at.mean_wait_s) ? "-" : time(at.mean_wait_s), energy(light, at.lit_h)});
  };
  for (const double delay : told_delays(light)) tell(shortest_number(delay), light.at(delay));
  for (const DelayCosts& at : light.by_nobody) tell("P(nobody) " + percent(*at.nobody), at);
  const auto compare = [&](const std::string& name, double hours) {
    add(table, light,
        {name, "", "", "", "", fixed(light.a_day(hours), 2), fixed(light.a_day(hours - light.occupied_h), 2), "", "",
         energy(light, hours)});
  };
  compare("always on", light.hours);
  if (knows_people(light)) {
    compare("first in, last out", light.span_h);
    compare("ideal", light.occupied_h);
  }
  return table;
}

using Line = io::LineChart::Line;

/// Short delays leave people in the dark so often that the rest would be hidden.
template <typename Value>
Line curve(const LightCosts& light, const std::string& name, Value value) {
  constexpr double shortest_min = 3.0, longest_min = 60.0;
  Line line{name, {}};
  for (const DelayCosts& at : light.by_delay) {
    if (at.delay_min >= shortest_min && at.delay_min <= longest_min) line.points.push_back(value(at));
  }

  return line;
}

io::LineChart chart(std::string title, std::string y_label, std::vector<Line> lines) {
  io::LineChart chart;
  chart.title = std::move(title);
  chart.x_label = "delay, min";
  chart.y_label = std::move(y_label);
  chart.x_low = 0.0, chart.x_high = 60.0;
  double most = 0.0;
  for (const Line& line : lines) {
    for (const auto& point : line.points) most = std::max({most, point.y, point.high.value_or(0.0)});
  }
  chart.y_high = most > 0.0 ? 1.05 * most : 1.0;
  chart.lines = std::move(lines);
  chart.note = "From 3 min on.";
  return chart;
}

std::vector<io::Chart> charts_of(const LightCosts& light) {
  std::vector<io::Chart> charts;
  const auto of = [](const DelayCosts& at, const Figure& figure, double scale) {
    io::LineChart::Point point{at.delay_min, scale * figure.value, {}, {}};
    if (figure.over_days) point.low = scale * figure.over_days->low, point.high = scale * figure.over_days->high;
    return point;
  };
  if (light.occupied_h > 0.0) {
    charts.emplace_back(
        chart("How often it goes off on somebody", "times an occupied hour",
              {curve(light, light.id, [&](const DelayCosts& at) { return of(at, at.false_offs_an_hour, 1.0); })}));
  }
  const auto flat = [&](const std::string& name, double hours) {
    return curve(light, name, [&, hours](const DelayCosts& at) {
      return io::LineChart::Point{at.delay_min, light.a_day(hours), {}, {}};
    });
  };
  std::vector<Line> lines{curve(light, "lit", [&](const DelayCosts& at) {
    return io::LineChart::Point{at.delay_min, light.a_day(at.lit_h), {}, {}};
  })};
  if (knows_people(light)) {
    lines.push_back(curve(light, "lit and empty", [&](const DelayCosts& at) {
      return io::LineChart::Point{at.delay_min, light.a_day(at.lit_empty_h), {}, {}};
    }));
    lines.push_back(flat("first in, last out", light.span_h));
    lines.push_back(flat("ideal", light.occupied_h));
  }
  charts.emplace_back(chart("What the delay costs in light", "hours a day", std::move(lines)));
  return charts;
}

std::string moment(const DarkSpell& spell, double seconds) {
  if (spell.clock.empty()) return fixed(seconds, 0);
  constexpr std::size_t to_time = 11, hms = 8;
  const double since = seconds - spell.from_s;
  const auto hours = clock_hours(spell.clock.substr(to_time, hms));
  return clock_text(0, std::fmod(3600.0 * hours.value_or(0.0) + since + 86400.0, 86400.0)).substr(to_time, hms);
}

std::string command(const DarkSpell& spell, const std::string& view) {
  constexpr double before_s = 60.0, most_s = 300.0;
  std::string words = view.empty() ? "pirsim view --scene ... --script ..." : view;
  words += " --replicate " + std::to_string(spell.replicate);
  if (!spell.trial.empty()) words += " --trial " + spell.trial;
  const double from_s = std::max(0.0, spell.from_s - before_s);
  return words + " --from " + moment(spell, from_s) + " --to " +
         moment(spell, spell.from_s + std::min(spell.length_s, most_s)) + " -o moment.html";
}

io::ReportSection worst_section(const LightCosts& light, const std::string& view) {
  io::ReportSection section;
  section.heading = light.id + ": the longest times in the dark";
  section.paragraphs = {"With a delay of " + minutes(light.rule_delays_min.front()) +
                        ". A command shows five minutes of each; --to shows more."};
  io::Table table{{"replicate", "from", "for", "what happened", "look at it"}, {}};
  constexpr double shortest_s = 10.0;  // less is the time that sensors take to answer
  for (const DarkSpell& spell : light.worst) {
    if (spell.length_s < shortest_s) continue;
    table.rows.push_back(
        {std::to_string(spell.replicate) + (spell.trial.empty() ? "" : ", trial " + spell.trial),
         spell.clock.empty() ? fixed(spell.from_s, 0) + " s" : spell.clock, time(spell.length_s),
         spell.cause == DarkSpell::Cause::went_off ? "it went off on somebody" : "somebody came, and it stayed off",
         command(spell, view)});
  }
  if (table.rows.empty()) section.paragraphs = {"Nobody was in the dark for 10 s."};
  if (!table.rows.empty()) section.tables.push_back(std::move(table));
  return section;
}

/// Of one light, or of several together, by their first delays.
struct Sums {
  double occupied_h = 0.0, dark_h = 0.0, lit_a_day = 0.0, empty_a_day = 0.0, false_offs = 0.0, asleep_a_day = 0.0;

  void add(const LightCosts& light) {
    const DelayCosts& at = light.at(light.rule_delays_min.front());
    occupied_h += light.occupied_h;
    dark_h += at.dark_h;
    lit_a_day += light.a_day(at.lit_h);
    empty_a_day += light.a_day(at.lit_empty_h);
    asleep_a_day += light.a_day(light.asleep_h);
    false_offs += at.false_offs;
  }
  [[nodiscard]] double offs_an_hour() const { return false_offs / occupied_h; }
  [[nodiscard]] double dark_share() const { return dark_h / occupied_h; }
};

bool know_people(const Costs& costs) { return std::ranges::all_of(costs.lights, knows_people); }

std::string with_which_delay(const Costs& costs) {
  const double first = costs.lights.front().rule_delays_min.front();
  const bool all_alike = std::ranges::all_of(
      costs.lights, [&](const LightCosts& light) { return light.rule_delays_min.front() == first; });
  return all_alike ? "With a delay of " + minutes(first) : "With the rule's delays";
}

std::string worst_light(const Costs& costs) {
  const auto rate = [](const LightCosts& light) {
    return light.at(light.rule_delays_min.front()).false_offs_an_hour.value;
  };
  const LightCosts* worst = nullptr;
  for (const LightCosts& light : costs.lights) {
    if (light.occupied_h > 0.0 && (worst == nullptr || rate(light) > rate(*worst))) worst = &light;
  }
  return worst != nullptr && rate(*worst) > 0.0
             ? " The worst is " + worst->id + ", " + fixed(rate(*worst), 2) + " times."
             : "";
}

std::string finding_of(const Costs& costs) {
  Sums sums;
  for (const LightCosts& light : costs.lights) sums.add(light);
  const bool is_one = costs.lights.size() == 1;
  if (std::ranges::none_of(costs.lights, [](const LightCosts& light) { return light.known_days > 0.0; }))
    return "Nothing is known of any light in these rows.";
  const std::string lit_h = fixed(sums.lit_a_day, 2);
  std::string text = with_which_delay(costs);
  if (!(sums.occupied_h > 0.0)) {
    text += (is_one ? ", the light is on for " + lit_h + " h" : ", lights are on for " + lit_h + " light-hours") +
            " a day. ";
    return text + (know_people(costs)
                       ? "Nobody was there in all of the time."
                       : "The rows don't say when somebody is there, so who was left in the dark isn't known.");
  }
  if (is_one) {
    const LightCosts& light = costs.lights.front();
    text += ", the light goes off on somebody " + fixed(sums.offs_an_hour(), 2) + " times an occupied hour" +
            range(light.at(light.rule_delays_min.front()).false_offs_an_hour, 1.0, 2);
  } else {
    text += ", a light goes off on somebody " + fixed(sums.offs_an_hour(), 2) +
            " times in every hour that its area is occupied";
  }
  text += ". Somebody is in the dark for " + share(sums.dark_share()) + " of that time. Of " + lit_h +
          (is_one ? " lit hours" : " light-hours") + " a day, " + fixed(sums.empty_a_day, 2) + " are lit for nobody.";
  if (!is_one) text += worst_light(costs);
  if (sums.asleep_a_day == 0.0) return text;
  return text + " Who sleeps or goes to bed wants no light: " + fixed(sums.asleep_a_day, 1) +
         (is_one ? " h" : " light-hours") + " a day in which all who are there do so count as hours of nobody.";
}

/// A row a light, and one of all.
io::Table overview(const Costs& costs) {
  io::Table table{{"light", "delay", "off on somebody, an occupied hour", "dark, %", "lit, h/day", "empty, h/day"}, {}};
  const auto add = [&](const std::string& name, const std::string& delay, const Sums& sums) {
    table.rows.push_back({name, delay, told(sums.offs_an_hour(), 2), told(100.0 * sums.dark_share(), 1),
                          fixed(sums.lit_a_day, 2), fixed(sums.empty_a_day, 2)});
  };
  Sums all;
  for (const LightCosts& light : costs.lights) {
    Sums one;
    one.add(light);
    all.add(light);
    add(light.id, minutes(light.rule_delays_min.front()), one);
  }
  add("all", "", all);
  return table;
}

}  // namespace

std::string to_csv(const Costs& costs) {
  std::ostringstream text;
  io::TableWriter<CostLine> csv(text);
  for (const LightCosts& light : costs.lights) {
    for (const auto* all : {&light.by_delay, &light.by_nobody}) {
      for (const DelayCosts& at : *all) csv.write({light, at});
    }
  }
  return text.str();
}

// ------------------------------------------------------------------------------------------------------ light by row

LitTable::LitTable(const std::filesystem::path& file, const RuleSpec& rule)
    : file_(file), data_(file_.stream(), io::compression_of(file)) {
  constexpr std::size_t which_row = 4;  // columns of rows that say which one it is, the last of them its clock
  const char* before = "";
  for (const Column<Sample>& column : columns_of<Sample>().first(which_row)) {
    text_ << before << column.name;
    before = ",";
  }
  for (const LightSpec& light : rule.lights) text_ << ",lit_" << light.id;
  for (const LightSpec& light : rule.lights) text_ << ",people_" << light.id;
  text_ << '\n';
}

void LitTable::add(const Sample& row, const LitRow& lit) {
  text_ << row.replicate << ',' << io::csv_field(row.trial) << ',' << io::csv_number(row.time_s) << ',' << row.clock;
  for (const std::uint8_t bit : lit.lit) text_ << ',' << (bit < 2 ? std::to_string(bit) : "");
  for (const std::int32_t people : lit.people) text_ << ',' << (people >= 0 ? std::to_string(people) : "");
  text_ << '\n';
  constexpr std::streamoff piece = 1 << 16;
  if (text_.tellp() > piece) flush();
}

void LitTable::flush() {
  data_.write(text_.str());
  text_.str({});
}

void LitTable::finish() {
  flush();
  data_.finish();
  file_.commit();
}

LitDays::LitDays(const RuleSpec& rule, double window_s) : window_s_(window_s) {
  for (const LightSpec& light : rule.lights) names_.push_back(light.id);
}

void LitDays::add(const Sample& row, const LitRow& lit) {
  has_clock_ = has_clock_ || lit.ends_s;
  const double middle_s =
      lit.ends_s ? static_cast<double>(*lit.ends_s) - 0.5 * window_s_ : row.time_s - 0.5 * window_s_;
  const auto date = static_cast<std::int64_t>(std::floor(middle_s / day_s));
  Key key{row.replicate, row.trial, date};
  if (days_.empty() || days_.back().first != key) {
    if (days_.size() >= most_days) return;
    days_.emplace_back(std::move(key), std::vector<Bin>(n_bins * names_.size()));
  }
  const double from_s = std::max(0.0, middle_s - 0.5 * window_s_ - static_cast<double>(date * day_s));
  const double to_s = std::min<double>(day_s, middle_s + 0.5 * window_s_ - static_cast<double>(date * day_s));
  for (auto bin = static_cast<std::size_t>(from_s / bin_s); static_cast<double>(bin) * bin_s < to_s; ++bin) {
    const double begin_s = static_cast<double>(bin) * bin_s;
    const double s = std::min(to_s, begin_s + bin_s) - std::max(from_s, begin_s);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      Bin& at = days_.back().second[bin * names_.size() + i];
      at.lit += lit.lit[i] == 1 ? s : 0.0;
      at.known += lit.lit[i] <= 1 ? s : 0.0;
      at.people = std::max(at.people, lit.people[i]);
      knows_people_ = knows_people_ || lit.people[i] >= 0;
    }
  }
}

io::DaysChart LitDays::chart() const {
  io::DaysChart chart;
  chart.title = "When it is lit";
  chart.note = "hatched: nothing is known";
  chart.bin_s = bin_s;
  chart.n_bins = static_cast<int>(n_bins);
  chart.ticks = has_clock_ ? io::DaysChart::Ticks::clock : io::DaysChart::Ticks::seconds;
  using Day = io::DaysChart;
  const auto runs_of = [&](const std::vector<Bin>& bins, std::size_t light, auto level_of) {
    std::vector<std::int32_t> levels;
    for (std::size_t bin = 0; bin < n_bins; ++bin) levels.push_back(level_of(bins[bin * names_.size() + light]));
    return Day::runs_of(levels);
  };
  for (const auto& [key, bins] : days_) {
    const auto& [replicate, trial, date] = key;
    constexpr std::size_t date_length = 10;
    const std::string run = "run " + std::to_string(replicate) + ", " + trial;
    const bool is_shared = std::ranges::any_of(
        days_, [&](const auto& other) { return other.first != key && std::get<2>(other.first) == date; });
    const std::string of_date = clock_text(date, 0.0).substr(0, date_length) + (is_shared ? ", " + run : "");
    Day::Day day{has_clock_ ? of_date : run, {}};
    for (std::size_t i = 0; i < names_.size(); ++i) {
      day.lines.push_back({names_[i], runs_of(bins, i, [](const Bin& bin) {
                             return bin.known == 0.0 ? Day::unknown : Day::level_of(bin.lit / bin.known);
                           })});
      if (!knows_people_) continue;
      day.lines.push_back({"people", runs_of(bins, i, [](const Bin& bin) { return bin.people; }), Day::Shows::people});
    }
    chart.days.push_back(std::move(day));
  }
  return chart;
}

io::Report control_page(const Costs& costs, const LitDays& days, const std::string& view) {
  io::Report report;
  report.title = "Light: " + costs.rule;
  report.finding = finding_of(costs) + (costs.lights.size() == 1 ? " " + advise(costs.lights.front()).sentence : "");
  report.paragraphs = {
      "Every sensor reading switches the light as the rule says, once for every delay. What people do isn't changed by "
      "it: who sits in the dark doesn't wave. So a light that went off stays off until somebody moves anyway."};
  const bool is_expected = costs.lights.front().people == People::expected;
  if (is_expected) {
    report.paragraphs.emplace_back(
        "Nobody counted the people of these rows. A counter tells who may have been there; figures are means over what "
        "is likely, with the middle 90 % of it in parentheses. P(nobody) 90 %: instead of a delay, the light goes off "
        "once the counter, by what it has seen until then, gives 90 % to nobody being there, and motion brings it "
        "back.");
  }
  if (know_people(costs)) {
    report.paragraphs.emplace_back(
        "In the tables: off on somebody, how often it went off while somebody was in its area, and the same an "
        "occupied hour" +
        std::string(is_expected ? ". "
                                : ", with the middle 90 % of what days drawn with replacement give in parentheses. "
                                  "None in five days doesn't mean never: the range then reaches to what so many hours "
                                  "can't rule out. ") +
        "Dark: share of occupied time; longest, the longest such time. Empty: lit while nobody is there. "
        "Switched on: times a day. Wait: from coming into an empty area to light, on average; the delay hardly matters "
        "for it. First in, last out: lit from the day's first person to its last. Ideal: lit while somebody is there; "
        "less than that is dark time, and no saving.");
  }
  for (const Issue& remark : costs.remarks) report.paragraphs.push_back(remark.message + ".");
  if (costs.lights.size() > 1 && know_people(costs))
    report.sections.push_back({"All lights", {}, {overview(costs)}, {}});
  const std::vector<std::string> sentences = advise_all(costs.lights);
  for (std::size_t i = 0; i < costs.lights.size(); ++i) {
    const LightCosts& light = costs.lights[i];
    io::ReportSection section;
    section.heading = light.id;
    section.paragraphs = {
        "Switched by " + joined(light.sensors, ", ") + ". " + counted(static_cast<std::size_t>(light.days), "day") +
        ", " + fixed(light.hours, 1) + " hours" +
        (knows_people(light) ? ", of which " + fixed(light.occupied_h, 1) + " occupied" : "") +
        (light.unknown_h > 0.0 ? "; " + fixed(light.unknown_h, 1) + " more of which nothing is known" : "") + "."};
    if (costs.lights.size() > 1) section.paragraphs.insert(section.paragraphs.begin(), sentences[i]);
    section.tables.push_back(table_of(light));
    section.charts = charts_of(light);

    report.sections.push_back(std::move(section));
  }
  io::ReportSection lit;
  lit.heading = "The lit time, day by day";
  lit.paragraphs = {
      "The first days, each light by the delay that is told of above. The darker a line, the more of two minutes is "
      "lit."};
  lit.charts.emplace_back(days.chart());
  report.sections.push_back(std::move(lit));
  for (const LightCosts& light : costs.lights) {
    if (!light.worst.empty()) report.sections.push_back(worst_section(light, view));
  }
  return report;
}

std::string to_text(const Costs& costs) {
  std::ostringstream text;
  text << finding_of(costs) << '\n';
  double unknown_h = 0.0;
  for (const LightCosts& light : costs.lights) unknown_h = std::max(unknown_h, light.unknown_h);
  if (unknown_h >= 0.005)
    text << "Of " << fixed(unknown_h, 2) << " more hours nothing is known: they count for nothing.\n";
  if (costs.lights.size() > 1 && know_people(costs)) {
    for (const auto& row : overview(costs).rows) {
      text << "  " << std::left << std::setw(16) << row[0] << std::setw(8) << row[1] << "off on somebody " << row[2]
           << " an occupied hour, dark " << row[3] << " %, lit " << row[4] << " h a day, " << row[5]
           << " of them empty\n";
    }
  }
  for (const std::string& sentence : advise_all(costs.lights)) text << sentence << '\n';
  return text.str();
}

}  // namespace pirsim::control

template <>
std::span<const pirsim::Column<pirsim::control::CostLine>> pirsim::columns_of() {
  return control::costs_by_delay;
}
