#include "surveys/placement_page.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <utility>

#include "model/core/text.hpp"
#include "pirsim/response.hpp"
#include "surveys/picture.hpp"
#include "surveys/placement.hpp"
#include "surveys/study_report.hpp"

namespace pirsim::studies {
namespace {

PlacementView view_of(const SceneSpec& scene, const PlacementSpec& spec, const std::string& title, unsigned threads) {
  const CoverageStudy study = study_of(scene, spec.coverage, {});
  const CoverageMap map = run_coverage(study, threads);
  PlacementView view{map_of_all(study, map), watch_workers(study, SeatsTried::all, threads).by_any(),
                     seats_without_target(scene, counts_at_seats(study)), figures_of(map).all.seen_area_m2,
                     scene.sensors.size()};
  view.map.title = title;
  view.map.ringed_as = "seat where nobody at work is noticed";
  for (const SeatSpec& seat : scene.seats) {
    const auto is_seat = [&](const std::vector<std::string>& ids) {
      return std::ranges::find(ids, seat.id) != ids.end();
    };
    if (is_seat(view.at_work.deaf) || is_seat(view.at_work.unseen))
      view.map.ringed.push_back(floor_point(seat.world_from_seat.origin));
  }
  const std::size_t n_seats = view.at_work.noticed.size() + view.at_work.deaf.size() + view.at_work.unseen.size();
  view.map.note = "somebody at work is noticed in " + std::to_string(view.at_work.noticed.size()) + " of " +
                  std::to_string(n_seats) + " seats";
  return view;
}

std::string named(const std::vector<std::string>& seats) { return seats.empty() ? "none" : joined(seats, " "); }

io::ReportSection section_of(const std::string& heading, const PlacementView& view) {
  io::Table table{{"seats", "number", "which"}, {}};
  const auto row = [&](const std::string& what, const std::vector<std::string>& seats) {
    table.rows.push_back({what, std::to_string(seats.size()), named(seats)});
  };
  row("at work, noticed: in a second at least", view.at_work.noticed);
  row("of these, surely: in ten seconds at least", view.at_work.surely);
  row("at work, deaf: sensors see who works there and never report motion", view.at_work.deaf);
  row("at work, unseen: no sensor sees who works there", view.at_work.unseen);
  row("a turning target there isn't seen: no sensor reports its motion", view.target_unseen);
  return {heading,
          {std::to_string(view.n_sensors) + " sensors, which see the target on " + fixed(view.seen_area_m2, 2) +
           " m² of floor."},
          {std::move(table)},
          {view.map}};
}

/// What false-offs are, and what else is told of light.
std::string about_light(const PlacementLightSpec& light) {
  std::ostringstream text;
  text << "Light is switched by motion, an area's by the sensors that watch it, and goes off " << light.delay_min
       << " min after the last one. A false-off: it goes off while somebody is there. Who is in the dark has waved, "
          "and so "
          "brought it back, after "
       << light.wave_s << " s. The people are those of '" << light.people.name
       << "'. Sets are ranked by false-offs an occupied hour; among equals by the share of occupied time in the dark, "
          "then "
          "by hours that are lit and empty. An area without a sensor counts as one whose sensor sees nobody.";
  return text.str();
}

std::vector<std::string> in_columns(const PlacementLight& light) {
  return {fixed(light.false_offs_an_hour(), 3), percent(light.dark_share(), 2), fixed(light.lit_empty_h, 1)};
}

/// A row a set and area.
io::ReportSection light_by_area(const std::vector<PlacementScore>& scores) {
  io::Table table{
      {"set", "area", "sensors", "occupied, h", "false-offs", "an occupied hour", "in the dark", "lit and empty, h"},
      {}};
  for (const PlacementScore& score : scores) {
    for (const PlacementLight& area : score.areas) {
      std::vector<std::string> row{score.set.id, area.area.empty() ? "all" : area.area,
                                   std::to_string(area.sensors.size()), fixed(area.occupied_h, 1),
                                   std::to_string(area.false_offs)};
      const std::vector<std::string> more = in_columns(area);
      row.insert(row.end(), more.begin(), more.end());
      table.rows.push_back(std::move(row));
    }
  }
  return {"Light, area by area", {}, {std::move(table)}, {}};
}

io::Table ranking(const std::vector<PlacementScore>& scores, const PlacementSpec& spec) {
  io::Table table{{"rank", "set"}, {}};
  if (spec.light)
    table.headings.insert(table.headings.end(), {"false-offs an hour", "in the dark", "lit and empty, h"});
  table.headings.insert(table.headings.end(), {"floor: target seen, m²", "target not seen", "overlap",
                                               "seats at work: noticed", "surely", "at work: deaf", "at work: unseen"});
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const PlacementScore& s = scores[i];
    std::vector<std::string> row{std::to_string(i + 1), s.set.id};
    if (spec.light) {
      for (std::string& cell : in_columns(s.light)) row.push_back(std::move(cell));
    }
    row.insert(row.end(), {fixed(s.seen_area_m2, 2), percent(s.blind_fraction, 1), percent(s.overlap, 1),
                           std::to_string(s.at_work.noticed.size()), std::to_string(s.at_work.surely.size()),
                           std::to_string(s.at_work.deaf.size()), std::to_string(s.at_work.unseen.size())});
    table.rows.push_back(std::move(row));
  }
  return table;
}

io::Table places_of(const std::vector<SensorSpec>& sensors) {
  io::Table table{{"sensor", "model", "x, m", "y, m", "z, m"}, {}};
  for (const SensorSpec& sensor : sensors) {
    const Vec3& at = sensor.world_from_sensor.origin;
    table.rows.push_back({sensor.id, sensor.model, fixed(at.x, 2), fixed(at.y, 2), fixed(at.z, 2)});
  }
  return table;
}

// What `pirsim placements` prints.

/// "17.23 m2 found, 1.20 m2 more than even spacing (16.03 m2)"
std::string gain_by_area(const PlacementSearch& search) {
  const double found = search.found.seen_area_m2, even = search.even.seen_area_m2;
  return fixed(found, 2) + " m2 found, " + fixed(found - even, 2) + " m2 more than even spacing (" + fixed(even, 2) +
         " m2)";
}

/// "38 seats noticed, 30 surely, 41.00 m2 seen; with even spacing 24, 12 surely, 39.00 m2"
std::string gain_by_seats(const PlacementSearch& search) {
  const auto told = [](const PlacementScore& score, const std::string& noticed, const std::string& seen) {
    return std::to_string(score.at_work.noticed.size()) + noticed + ", " + std::to_string(score.at_work.surely.size()) +
           " surely, " + fixed(score.seen_area_m2, 2) + " m2" + seen;
  };
  return told(search.found, " seats noticed", " seen") + "; with even spacing " + told(search.even, "", "");
}

/// "0.31 false-offs an occupied hour, 1.2 % of it dark; with even spacing 0.52, 2.0 %"
std::string gain_by_light(const PlacementSearch& search) {
  const auto told = [](const PlacementLight& light, const std::string& offs, const std::string& dark) {
    return fixed(light.false_offs_an_hour(), 3) + offs + ", " + percent(light.dark_share(), 2) + dark;
  };
  return told(search.found.light, " false-offs an occupied hour", " of it dark") + "; with even spacing " +
         told(search.even.light, "", "");
}

std::string gain(const PlacementSearch& search, PlacementAim by) {
  switch (by) {
    case PlacementAim::area:
      return " sets tried: " + gain_by_area(search);
    case PlacementAim::seats:
      return " places tried: " + gain_by_seats(search);
    case PlacementAim::false_off:
      return " places tried: " + gain_by_light(search);
  }
  return {};
}

}  // namespace

PlacementViews views_of(const SceneSpec& scene, const PlacementSpec& spec, const PlacementReport& report,
                        unsigned threads) {
  PlacementViews views;
  if (!scene.sensors.empty()) views.before = view_of(scene, spec, "before: the scene's own sensors", threads);
  if (!report.ranked.empty() && !report.ranked[0].set.sensors.empty())
    views.after = view_of(report.best, spec, "after: " + report.ranked[0].set.id, threads);
  return views;
}

io::Report placement_report(const SceneSpec& scene, const PlacementSpec& spec, const PlacementReport& report,
                            const PlacementViews& views) {
  io::Report page;
  page.title = spec.coverage.name + ": where sensors go";
  page.paragraphs = {
      "Sets of sensors for " + scene.name + ", ranked by " + ranked_by(spec) + ". The sensors' response is " +
          responses_in_words(report.best, spec.coverage.sensing) + ".",
      "Each square of a map has the count of the sensor that reported motion of a turning target most often there: 0 "
      "means that none did. Somebody of natural style worked in each seat, alone; an orange ring is round each seat "
      "where "
      "no sensor noticed it. " +
          signs_of_maps(scene)};
  io::ReportSection sets{"Sets, best first", {}, {ranking(report.ranked, spec)}, {}};
  if (report.search && !report.search->gained) sets.paragraphs = {"The search found nothing better than even spacing."};
  page.sections.push_back(std::move(sets));
  if (spec.light) {
    page.paragraphs.push_back(about_light(*spec.light));
    page.sections.push_back(light_by_area(report.ranked));
  }
  if (views.before) page.sections.push_back(section_of("Before: the scene's own sensors", *views.before));
  if (views.after) {
    page.sections.push_back(section_of("After: the best set, " + report.ranked[0].set.id, *views.after));
    page.sections.back().tables.push_back(places_of(report.best.sensors));
  } else if (views.before && !report.ranked.empty()) {
    page.finding = "No set does better than the scene's own sensors.";
  }
  return page;
}

std::string ranked_by(const PlacementSpec& spec) {
  std::ostringstream delay;
  if (spec.light) delay << spec.light->delay_min;
  switch (spec.by) {
    case PlacementAim::area:
      return "seen area";
    case PlacementAim::seats:
      return "seats where somebody at work is noticed, then surely noticed, then by seen area";
    case PlacementAim::false_off:
      return "how seldom light goes off on somebody (delay " + delay.str() +
             " min), then by time in the dark, then by empty light";
  }
  return {};
}

std::string to_text(const std::vector<PlacementScore>& scores, const PlacementSpec& spec) {
  const bool has_light = spec.light.has_value();
  std::ostringstream out;
  out << "ranked by " << ranked_by(spec) << "\n      " << (has_light ? "  false-offs              lit and" : "")
      << "  floor, by a turning target        seats, by somebody at work there\n  rank"
      << (has_light ? "   an hour     dark, %  empty, h" : "")
      << "  seen, m2  not seen, %  overlap, %   noticed  surely  deaf  unseen  set\n"
      << std::fixed;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const PlacementScore& s = scores[i];
    out << std::setw(6) << i + 1;
    if (has_light) {
      out << std::setprecision(3) << std::setw(10) << s.light.false_offs_an_hour() << std::setprecision(2)
          << std::setw(12) << 100.0 * s.light.dark_share() << std::setw(10) << s.light.lit_empty_h;
    }
    out << std::setprecision(2) << std::setw(10) << s.seen_area_m2 << std::setprecision(1) << std::setw(13)
        << 100.0 * s.blind_fraction << std::setw(12) << 100.0 * s.overlap << std::setw(10) << s.at_work.noticed.size()
        << std::setw(8) << s.at_work.surely.size() << std::setw(6) << s.at_work.deaf.size() << std::setw(8)
        << s.at_work.unseen.size() << "  " << s.set.id << '\n';
  }
  out << "seats by name:\n";
  for (const PlacementScore& s : scores) {
    out << "  " << s.set.id << ": a turning target there isn't seen: " << named(s.blind_seats)
        << "; at work: deaf: " << named(s.at_work.deaf) << ", unseen: " << named(s.at_work.unseen) << '\n';
  }
  return out.str();
}

namespace {

std::string place_of(const SensorSpec& sensor, const std::string& model) {
  const Vec3 p = sensor.world_from_sensor.origin;
  return "  " + sensor.id + model + "  " + fixed(p.x, 2) + ' ' + fixed(p.y, 2) + ' ' + fixed(p.z, 2) + '\n';
}

}  // namespace

std::string to_text(const PlacementSearch& search, PlacementAim by) {
  std::ostringstream out;
  out << search.evaluations << gain(search, by)
      << (search.gained ? "" : "; the search found nothing better than even spacing") << ". Sensors at:\n";
  for (const SensorSpec& sensor : search.found.set.sensors) out << place_of(sensor, {});
  return out.str();
}

std::string to_text(const SensorSetSpec& set) {
  std::string text = set.id + ":\n";
  for (const SensorSpec& sensor : set.sensors) text += place_of(sensor, " (" + sensor.model + ")");
  return text;
}

}  // namespace pirsim::studies
