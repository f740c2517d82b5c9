#include "dataset/flat_furnish.hpp"

namespace pirsim::dataset {

DrawnFlat draw_flat(const FlatSpec& spec, std::uint64_t seed, int number, const io::SceneOptions& options) {
  const auto which = static_cast<std::uint32_t>(number);
  // Drawn once: who is refused for lack of space stays.
  Stream people({seed, which, 0, Purpose::flat_household});
  const int residents = draw(spec.residents, people);
  ModelFinder models({{spec.models, spec.models_where}}, spec.where, options);
  Failures failures;
  for (int tries = 1; tries <= most_tries; ++tries) {
    Stream stream({seed, which, static_cast<std::uint32_t>(tries), Purpose::flat});
    auto drawn = furnish_flat(spec, residents, stream);
    if (const auto* lacking = std::get_if<NoPlace>(&drawn)) {
      failures.add(lacking->reason);
      continue;
    }
    auto& [flat, demands] = std::get<FurnishedFlat>(drawn);
    flat.number = number;
    flat.tries = tries;
    flat.scene.name = "flat " + std::to_string(number);
    models.add_to(flat.scene);
    const std::string fault = fault_of(flat.scene, demands);
    if (fault.empty()) return std::move(flat);
    failures.add(fault);
  }
  failures.give_up("flat", number, spec.where);
}

}  // namespace pirsim::dataset
