#include "io/gltf_materials.hpp"

#include <string>
#include <utility>

namespace pirsim::io::detail {
namespace {

using nlohmann::json;

std::optional<double> temperature_of(const json& mark, const GltfDocument& document, const std::string& pointer,
                                     Diagnostics& remarks) {
  if (!mark.is_object()) {
    remarks.error(document.text.where(pointer), "'pirsim' must be an object with a 'temperature_c'");
    return std::nullopt;
  }
  for (const auto& [key, unused] : mark.items()) {
    if (key == "temperature_c") continue;
    remarks.error(document.text.where_key(pointer + '/' + key),
                  "unknown key '" + key + "' of a material" + did_you_mean(key, {"temperature_c"}));
    return std::nullopt;
  }
  const auto value = mark.find("temperature_c");
  if (value != mark.end() && value->is_number() && *value >= coldest_surface_c && *value <= hottest_surface_c) {
    return value->get<double>();
  }
  remarks.error(document.text.where(pointer), "a material needs 'temperature_c' from -50 to 200");
  return std::nullopt;
}

}  // namespace

std::vector<std::optional<double>> material_temperatures_c(const GltfDocument& document, Diagnostics& remarks) {
  const json& root = document.text.root();
  const auto materials = root.find("materials");  // of the text: the model is read without them
  if (materials == root.end() || !materials->is_array()) return {};
  std::vector<std::optional<double>> temperatures(materials->size());
  for (std::size_t i = 0; i < temperatures.size(); ++i) {
    if (!(*materials)[i].is_object()) continue;
    const auto extras = (*materials)[i].find("extras");
    if (extras == (*materials)[i].end() || !extras->is_object() || !extras->contains("pirsim")) continue;
    const json& given = (*extras)["pirsim"];
    json mark = given;
    if (given.is_string()) {  // as with nodes
      auto parsed = parse_json(given.get<std::string>());
      mark = std::holds_alternative<json>(parsed) ? std::get<json>(std::move(parsed)) : json();
    }
    const std::string pointer = "/materials/" + std::to_string(i) + "/extras/pirsim";
    temperatures[i] = temperature_of(mark, document, pointer, remarks);
  }
  return temperatures;
}

}  // namespace pirsim::io::detail
