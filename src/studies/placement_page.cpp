#include "studies/placement_page.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "core/text.hpp"
#include "pirsim/response.hpp"
#include "studies/placement.hpp"
#include "studies/room_plan.hpp"
#include "studies/study_report.hpp"

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

}  // namespace pirsim::studies
