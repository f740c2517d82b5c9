// What `pirsim placements` prints.
#include <iomanip>
#include <sstream>

#include "core/text.hpp"
#include "studies/placement.hpp"

namespace pirsim::studies {
namespace {

std::string listed(const std::vector<std::string>& names) { return names.empty() ? "none" : joined(names, " "); }

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
    out << "  " << s.set.id << ": a turning target there isn't seen: " << listed(s.blind_seats)
        << "; at work: deaf: " << listed(s.at_work.deaf) << ", unseen: " << listed(s.at_work.unseen) << '\n';
  }
  return out.str();
}

std::string to_text(const PlacementSearch& search, PlacementAim by) {
  std::ostringstream out;
  out << search.evaluations << gain(search, by)
      << (search.gained ? "" : "; the search found nothing better than even spacing") << ". Sensors at:\n"
      << std::fixed << std::setprecision(2);
  for (const SensorSpec& sensor : search.found.set.sensors) {
    const Vec3 p = sensor.world_from_sensor.origin;
    out << "  " << sensor.id << "  " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  }
  return out.str();
}

}  // namespace pirsim::studies
