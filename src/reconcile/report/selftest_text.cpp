// Plans and what a self-test counts in words, and a self-test as text.
#include <array>
#include <cmath>
#include <iomanip>
#include <span>
#include <sstream>

#include "core/text.hpp"
#include "pirsim/csv.hpp"
#include "reconcile/report/pages.hpp"
#include "reconcile/report/sentences.hpp"

namespace pirsim::reconcile {

std::string name(const Design& design) {
  constexpr std::array<std::string_view, 6> names{"as planned", "",           "all again",
                                                  "slow walk",  "empty room", "second by second"};
  if (design.kind == Design::Kind::trial_again) return "trial " + design.trial + " again";
  return std::string(names[static_cast<std::size_t>(design.kind)]);
}

std::string what_of(const Design& design) {
  constexpr std::array<std::string_view, 6> texts{
      "what is planned",       "",
      "every trial once more", "one person walking slowly through the room",
      "the empty room",        "the same, second by second instead of sums"};
  if (design.kind == Design::Kind::trial_again) return "trial " + design.trial + " once more";
  return std::string(texts[static_cast<std::size_t>(design.kind)]);
}

std::string sentence(const PlanResult& result) {
  const Design& planned = result.designs.front();
  const std::string now = "what is planned makes the right effect the likeliest in " + percent(planned.right) +
                          " of cases (" + short_number(planned.bits) + " bits)";
  const Design* best = result.best();
  if (best == nullptr) return "None of the further measurements tried is shown to help: " + now + ".";
  return "The best next measurement is " + what_of(*best) + " (" + short_number(best->minutes) + " min more): " + now +
         ", with it " + percent(best->right) + " (" + short_number(best->more_bits) + " bits more, 95 % interval " +
         short_number(best->more_bits_95.low) + " to " + short_number(best->more_bits_95.high) + ").";
}

std::string_view in_words(Counted counted) noexcept {
  constexpr std::array<std::string_view, 24> texts{
      "a disagreement although nothing is hidden",
      "a name although nothing is hidden",
      "a disagreement seen",
      "exactly the right name, given a disagreement",
      "the right family, given a disagreement",
      "a name, given a disagreement",
      "the right name, given a name",
      "one wrong name",
      "one wrong family",
      "the truth in the set, given a disagreement",
      "none in the catalogue, given a disagreement",
      "parameters within their 90 % intervals",
      "an effect that the catalogue lacks: a disagreement seen",
      "an effect that the catalogue lacks: called none in the catalogue, given a disagreement",
      "an effect that the catalogue lacks and the whole one names: called none in the catalogue, given a disagreement",
      "an effect that the catalogue lacks: called by one name",
      "an effect that the catalogue lacks: called by one name of another family",
      "people's motion, in the catalogue or not: called by a name of optics or electronics",
      "two effects, first look: one or both in the set, given a disagreement",
      "two effects, first look: no single effect will do, given a disagreement",
      "two effects, first look: one wrong name",
      "seen and in the set",
      "taken for each other"};
  return texts[static_cast<std::size_t>(counted)];
}

namespace {

std::string share(const Rate& rate) {
  if (rate.of == 0) return "no case";
  std::ostringstream out;
  out << std::fixed << std::setprecision(3) << rate.value() << " (" << rate.interval.low << "-" << rate.interval.high
      << ", " << rate.hits << " of " << rate.of << ")";
  return out.str();
}

}  // namespace

std::string to_markdown(const SelftestResult& result) {
  std::ostringstream out;
  out << "| how often | share (95 % interval) |\n|---|---|\n";
  for (const Rate& rate : rates_of(result)) out << "| " << in_words(rate.what) << " | " << share(rate) << " |\n";
  out << "| calibration error of the probabilities | " << calibration_error(result) << " |\n\n| effect |";
  for (const char* strength : {"weak", "medium", "strong"}) out << ' ' << strength << ": seen | and in the set |";
  out << "\n|---|---|---|---|---|---|---|\n";
  for (std::size_t hypothesis = 1; hypothesis < result.hypotheses.size(); ++hypothesis) {
    out << "| " << result.hypotheses[hypothesis] << " |";
    for (const Rate& rate : power_of(result, result.hypotheses[hypothesis])) {
      out << ' ' << (rate.of == 0 ? "no case" : fixed(rate.value(), 2)) << " |";
    }
    out << '\n';
  }
  out << "\nConfusion: of the cases with a disagreement (of nothing: of all), the share in which the column's "
         "hypothesis is "
         "the likeliest; less than 0.05 left out.\n\n| hidden | taken for |\n|---|---|\n";
  const auto confusion = confusion_of(result);
  for (std::size_t row = 0; row < confusion.size(); ++row) {
    out << "| " << result.hypotheses[row] << " |";
    std::string list;
    for (std::size_t column = 0; column < confusion.size(); ++column) {
      if (confusion[row][column] < 0.05) continue;
      list += (list.empty() ? " " : ", ") + result.hypotheses[column] + " " + fixed(confusion[row][column], 2);
    }
    out << list << " |\n";
  }
  return out.str();
}

namespace {

struct CaseLine {
  const InjectedCase& one;
  std::string named, hidden;
};

constexpr Column<CaseLine> case_lines[]{
    {{"dataset", Holds::count, "which dataset of those that were injected"},
     [](const CaseLine& line) -> Cell { return static_cast<std::int64_t>(line.one.injected); }},
    {{"kind", Holds::text, "what was hidden"}, [](const CaseLine& line) -> Cell { return name(line.one.kind); }},
    {{"truth", Holds::text, "the effects hidden, or nothing"},
     [](const CaseLine& line) -> Cell { return line.one.truth; }},
    {{"strength", Holds::text, "how strong"}, [](const CaseLine& line) -> Cell { return name(line.one.strength); }},
    {{"verdict", Holds::text, "what the workflow says"},
     [](const CaseLine& line) -> Cell { return name(line.one.verdict); }},
    {{"named", Holds::text, "effects that it names, or can't tell apart"},
     [](const CaseLine& line) -> Cell { return line.named; }},
    {{"family", Holds::text, "that it tells"},
     [](const CaseLine& line) -> Cell { return line.one.family ? Cell(name(*line.one.family)) : Cell(); }},
    {{"likeliest", Holds::text, "effect with the greatest probability"},
     [](const CaseLine& line) -> Cell { return line.one.likeliest; }},
    {{"p", Holds::number, "of the global test"}, [](const CaseLine& line) -> Cell { return line.one.p; }},
    {{"parameters", Holds::count, "fitted, if the right effect was named"},
     [](const CaseLine& line) -> Cell { return static_cast<std::int64_t>(line.one.n_parameters); }},
    {{"covered", Holds::count, "of them, whose interval holds the truth"},
     [](const CaseLine& line) -> Cell { return static_cast<std::int64_t>(line.one.n_covered); }},
    {{"hidden", Holds::text, "parameters of what was hidden"},
     [](const CaseLine& line) -> Cell { return line.hidden; }},
};

CaseLine line_of(const InjectedCase& one) {
  CaseLine line{one, joined(one.named, " "), {}};
  for (const EffectSpec& effect : one.effects) {
    for (const auto& [parameter, value] : effect.parameters)
      line.hidden += (line.hidden.empty() ? "" : " ") + parameter + "=" + io::csv_number(value);
    for (const auto& [choice, value] : effect.choices) line.hidden += " " + choice + "=" + value;
  }
  return line;
}

}  // namespace

std::string to_csv(const SelftestResult& result) {
  std::ostringstream out;
  io::TableWriter<CaseLine> csv(out, std::span<const Column<CaseLine>>(case_lines));
  for (const InjectedCase& one : result.cases) csv.write(line_of(one));
  return out.str();
}

}  // namespace pirsim::reconcile
