// A blind challenge: something is hidden in simulated data, what it is gets sealed, and a verdict is scored later.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/reconcile.hpp"
#include "pirsim/sample.hpp"
#include "reconcile/ensemble/simulated_realization.hpp"

namespace pirsim::reconcile {

/// What may be hidden.
enum class Hidden {
  any,              ///< one of the following: one 55 %, the others 15 % each (assumed)
  nothing,          ///< the plain model with nuisance
  one,              ///< an effect of the catalogue, from its prior
  two,              ///< two different ones
  out_of_catalogue  ///< something that the catalogue lacks
};
/// In the order of the enumeration.
inline constexpr std::array<std::string_view, 5> hidden_names{"any", "nothing", "one", "two", "out-of-catalogue"};
[[nodiscard]] std::string_view name(Hidden hidden) noexcept;

struct SealSettings {
  NuisanceSpec nuisance;
  Hidden hidden = Hidden::any;
  int n_replicates = 1;           ///< runs of every trial
  std::uint64_t secret_seed = 0;  ///< everything that is drawn follows from it
  std::string salt;               ///< so that answers can't be found by trying all; kept in the answer
};

inline constexpr int answer_schema = 1;
inline constexpr int report_schema = 1;  ///< of report.json, which is scored

struct Challenge {
  std::string rows;    ///< CSV as docs/formats/rows.md has it, but nothing that nobody can measure: neither `people`,
                       ///< which would tell a hidden one, nor a manifest, which would tell seed and effects
  std::string answer;  ///< JSON, to be kept secret; holds the rows' SHA-256 too
  std::string commitment;  ///< SHA-256 of the answer's bytes, to be published
};
/// Throws Error: usage if the catalogue has fewer effects beside the script's than are to be hidden (`any`: two),
/// infeasible if no attempt gives a room that people can get about in.
[[nodiscard]] Challenge seal(const SceneSpec& scene, const ScriptSpec& script, const SealSettings& settings);

enum class Mark {
  exact,   ///< these effects and no other; or rightly nothing, or rightly none in the catalogue
  family,  ///< other effects of the same families
  one_of,  ///< the truth is among several that could not be told apart
  part,    ///< one of two was named, and nothing else
  wrong,   ///< something else was named
  none     ///< nothing was named, though something of the catalogue or an out-of-catalogue fault was there
};
[[nodiscard]] std::string_view name(Mark mark) noexcept;

struct Score {
  Mark mark = Mark::none;
  std::vector<std::string> hidden;  ///< effects, or the fault's name
  Verdict verdict = Verdict::no_disagreement;
  std::vector<std::string> named;  ///< what the report names
};
/// A file that was read.
struct Document {
  std::string name;  ///< for messages
  std::string text;
};
/// answer: the sealed file; report: report.json. Throws Error(input) that names the file: the answer isn't the one
/// committed to, the report is about other data, or something in them isn't known.
[[nodiscard]] Score open_answer(const Document& answer, std::string_view commitment, const Document& report);

}  // namespace pirsim::reconcile
