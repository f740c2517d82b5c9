// Scores, plans and what a self-test counts in words.
#include <array>

#include "core/text.hpp"
#include "reconcile/report/sentences.hpp"

namespace pirsim::reconcile {

std::string sentence(const Score& score) {
  return std::string(name(score.mark)) + ": hidden was " +
         (score.hidden.empty() ? "nothing" : joined(score.hidden, ", ")) + ", the verdict was " +
         std::string(name(score.verdict)) + (score.named.empty() ? "" : " (" + joined(score.named, ", ") + ")");
}

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
  constexpr std::array<std::string_view, 36> texts{
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
      "a gap that shrunk on held-out trials, given the right name",
      "a gap closed on held-out trials, given the right name",
      "nine tenths of what can be closed, given the right name",
      "a gap that shrunk although nothing is hidden",
      "applied, the right name: the model passes",
      "applied, the name of an effect that the catalogue lacks: the model passes",
      "applied, the name of an out-of-catalogue fault: the model passes",
      "an effect that the catalogue lacks: a disagreement seen",
      "an effect that the catalogue lacks: called none in the catalogue, given a disagreement",
      "an effect that the catalogue lacks and the whole one names: called none in the catalogue, given a disagreement",
      "an effect that the catalogue lacks: called by one name",
      "an effect that the catalogue lacks: called by one name of another family",
      "a variant that the catalogue lacks: the right name, where the whole catalogue gives it",
      "people's motion, in the catalogue or not: called by a name of optics or electronics",
      "an out-of-catalogue fault: a disagreement seen",
      "an out-of-catalogue fault: called none in the catalogue, given a disagreement",
      "an out-of-catalogue fault: called by one name",
      "beyond the prior: exactly the right name, given a disagreement",
      "beyond the prior: one wrong name",
      "two effects, first look: one or both in the set, given a disagreement",
      "two effects, first look: no single effect will do, given a disagreement",
      "two effects, first look: one wrong name",
      "seen and in the set",
      "taken for each other"};
  return texts[static_cast<std::size_t>(counted)];
}

std::string_view in_words(Reached reached) noexcept {
  constexpr std::array<std::string_view, 5> names{"met", "met, but too few cases to be sure",
                                                  "not met, but too few cases to be sure", "not met", "not tested"};
  return names[static_cast<std::size_t>(reached)];
}

}  // namespace pirsim::reconcile
