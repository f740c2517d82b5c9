#include "files/write/casas_writer.hpp"

#include <algorithm>
#include <array>
#include <ostream>
#include <utility>

#include "model/schema/words.hpp"
#include "pirsim/columns.hpp"

namespace pirsim::io {
namespace {

/// "2026-03-02 08:30:00"
std::string moment(const std::string& clock) {
  std::string text = clock;
  std::ranges::replace(text, 'T', ' ');
  return text;
}

/// Somebody does one thing in these rows.
struct Spell {
  std::string activity;
  std::size_t first = 0, last = 0;
};

bool is_activity(const std::string& phase) { return std::ranges::find(phases_of_body, phase) == phases_of_body.end(); }

/// By person, in order of time; who is away does nothing.
std::map<std::string, std::vector<Spell>> spells_of(std::span<const Sample> rows,
                                                    std::span<const OccupantRow> occupants) {
  std::map<std::string, std::vector<Spell>> spells;
  std::size_t row = 0;
  for (const OccupantRow& occupant : occupants) {
    while (row < rows.size() && rows[row].time_s < occupant.time_s) ++row;
    if (!is_activity(occupant.activity)) continue;
    std::vector<Spell>& own = spells[occupant.person];
    if (!own.empty() && own.back().last + 1 == row && own.back().activity == occupant.activity) {
      own.back().last = row;
    } else {
      own.push_back({occupant.activity, row, row});
    }
  }
  return spells;
}

}  // namespace

std::vector<CasasWriter::Line> CasasWriter::lines_of(std::span<const Sample> rows) const {
  std::vector<Line> lines;
  std::vector<std::uint8_t> on(sensors_.size(), 0), open(doors_.size(), 0);
  const auto change = [&](std::size_t row, std::uint8_t& was, bool is, const std::string& name,
                          const std::array<const char*, 2>& words) {
    if ((was != 0) == is) return;
    was = is ? 1 : 0;
    lines.push_back({row, moment(rows[row].clock) + ' ' + name + ' ' + words[was]});
  };
  constexpr std::array motion{"OFF", "ON"}, contact{"CLOSE", "OPEN"};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t i = 0; i < on.size(); ++i) change(row, on[i], rows[row].bits[i] != 0, sensors_[i], motion);
    for (std::size_t i = 0; i < open.size(); ++i)
      change(row, open[i], rows[row].doors[i] != 0, column_of_door(doors_[i]), contact);
  }
  for (std::size_t i = 0; i < on.size(); ++i) change(rows.size() - 1, on[i], false, sensors_[i], motion);
  for (std::size_t i = 0; i < open.size(); ++i)
    change(rows.size() - 1, open[i], false, column_of_door(doors_[i]), contact);
  return lines;
}

void CasasWriter::end(const std::string& person, const Open& what) {
  if (what.last_line != nullptr) what.last_line->ends.push_back(person + '_' + what.activity);
}

void CasasWriter::label(std::span<const Sample> rows, std::span<const OccupantRow> occupants,
                        std::vector<Line>& lines) {
  std::map<std::string, Open> open;
  for (const auto& [person, spells] : spells_of(rows, occupants)) {
    for (const Spell& spell : spells) {
      const auto first = std::ranges::lower_bound(lines, spell.first, {}, &Line::row);
      const auto behind = std::ranges::upper_bound(lines, spell.last, {}, &Line::row);
      Open now{spell.activity, first < behind ? &*std::prev(behind) : nullptr, n_runs_};
      bool has_begun = false;
      if (const auto before = open_.find(person);
          spell.first == 0 && before != open_.end() && before->second.activity == spell.activity) {
        has_begun = before->second.last_line != nullptr;
        if (now.last_line == nullptr) now = before->second;
        open_.erase(before);
      }
      if (!has_begun && first < behind) first->begins.push_back(person + '_' + spell.activity);
      if (spell.last + 1 == rows.size()) {
        open[person] = now;
      } else {
        end(person, now);
      }
    }
  }
  for (const auto& [person, what] : open_) end(person, what);
  open_ = std::move(open);
}

void CasasWriter::write(const std::vector<Line>& lines) {
  for (const Line& line : lines) {
    // What begins and ends at the same line begins first, so that who reads on sees it end.
    for (const std::string& label : line.begins) out_ << line.text << ' ' << label << " begin\n";
    for (const std::string& label : line.ends) out_ << line.text << ' ' << label << " end\n";
    if (line.ends.empty() && line.begins.empty()) out_ << line.text << '\n';
  }
}

void CasasWriter::add(std::span<const Sample> rows, std::span<const OccupantRow> occupants) {
  if (rows.empty()) return;
  ++n_runs_;
  std::vector<Line> lines = lines_of(rows);
  label(rows, occupants, lines);
  // Lines before this run are written now: what nobody noticed in it ends there.
  std::erase_if(open_, [&](const auto& open) {
    if (open.second.run == n_runs_) return false;
    end(open.first, open.second);
    return true;
  });
  std::swap(lines_, lines);
  write(lines);
}

void CasasWriter::finish() {
  for (const auto& [person, what] : open_) end(person, what);
  open_.clear();
  write(std::exchange(lines_, {}));
}

}  // namespace pirsim::io
