#include "dataset/furnish.hpp"

namespace pirsim::dataset {

DrawnRoom draw_room(const RoomSpec& spec, std::uint64_t seed, int number, const io::SceneOptions& options) {
  std::vector<ModelFinder::Named> named;
  for (const SensorGroupSpec& group : spec.sensors) named.push_back({group.models, group.where});
  ModelFinder models(std::move(named), spec.where, options);
  Failures failures;
  for (int tries = 1; tries <= most_tries; ++tries) {
    Stream stream({seed, static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(tries), Purpose::room});
    auto drawn = furnish(spec, stream);
    if (const auto* lacking = std::get_if<NoPlace>(&drawn)) {
      failures.add(lacking->reason);
      continue;
    }
    auto& room = std::get<DrawnRoom>(drawn);
    room.number = number;
    room.tries = tries;
    room.scene.name = "room " + std::to_string(number);
    models.add_to(room.scene);
    const std::string fault = fault_of(room.scene);
    if (fault.empty()) return std::move(room);
    failures.add(fault);
  }
  failures.give_up("room", number, spec.where);
}

}  // namespace pirsim::dataset
