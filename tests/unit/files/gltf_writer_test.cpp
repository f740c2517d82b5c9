#include "files/write/gltf_writer.hpp"

#include <tiny_gltf.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <map>

#include "model/geom/shapes.hpp"
#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::io;
namespace fs = std::filesystem;

namespace {

Quat random_rotation(Stream& stream) {
  return glm::normalize(Quat(stream.normal(), stream.normal(), stream.normal(), stream.normal()));
}

ExportedPerson person(const std::string& id, std::size_t n_keys, Stream& stream) {
  ExportedPerson result{id, {}, {}};
  for (std::size_t key = 0; key < n_keys; ++key) result.present.push_back(key % 4 == 3 ? 0 : 1);
  const std::vector<std::pair<std::string, Shape>> parts{{"head", Sphere{0.12}},
                                                         {"torso", Box{{0.2, 0.3, 0.1}}},
                                                         {"left_thigh", Capsule{0.08, 0.2}},
                                                         {"right_thigh", Capsule{0.08, 0.2}}};
  for (const auto& [name, shape] : parts) {
    ExportedPart part{id, name, shape, {}};
    for (std::size_t key = 0; key < n_keys; ++key) {
      part.world_from_part.push_back({random_rotation(stream), {stream.normal(), stream.normal(), stream.normal()}});
    }
    result.parts.push_back(part);
  }
  return result;
}

ExportedRun some_run() {
  Stream stream({.seed = 31});
  ExportedRun run;
  run.title = "S1, replicate 1";
  run.meshes = {{"wall", {{0, 0, 0}, {4, 0, 0}, {4, 2.5, 0}, {0, 2.5, 0}}, {{0, 1, 2}, {0, 2, 3}}},
                {"table", {{1, 0.7, 1}, {2, 0.7, 1}, {2, 0.7, 2}}, {{0, 2, 1}}},
                {"nothing", {}, {}}};
  run.people = {person("anna", 9, stream), person("bert", 9, stream)};
  run.beams = {{"PIR1", {{{0, 2.6, 0}, {1.25, 0, 3}}, {{0, 2.6, 0}, {2, 0, 3.1}}}}, {"PIR2", {}}};
  for (int key = 0; key < 9; ++key) run.key_times_s.push_back(0.04 * key);
  return run;
}

tinygltf::Model read_back(const fs::path& path) {
  tinygltf::TinyGLTF reader;
  tinygltf::Model model;
  std::string faults;
  std::string warnings;
  const bool sound = path.extension() == ".glb" ? reader.LoadBinaryFromFile(&model, &faults, &warnings, path.string())
                                                : reader.LoadASCIIFromFile(&model, &faults, &warnings, path.string());
  INFO(faults << warnings);
  REQUIRE(sound);
  return model;
}

std::vector<float> floats(const tinygltf::Model& model, int accessor_index) {
  const auto& accessor = model.accessors[static_cast<std::size_t>(accessor_index)];
  const auto& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
  REQUIRE(accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT);
  const auto width = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  std::vector<float> values(accessor.count * static_cast<std::size_t>(width));
  std::memcpy(values.data(), model.buffers[0].data.data() + view.byteOffset + accessor.byteOffset,
              values.size() * sizeof(float));
  return values;
}

std::map<std::string, int> node_names(const tinygltf::Model& model) {
  std::map<std::string, int> names;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) names[model.nodes[i].name] = static_cast<int>(i);
  return names;
}

/// Output values of the channel that moves `path` of a node; its times and interpolation are checked.
std::vector<float> track(const tinygltf::Model& model, const ExportedRun& run, int node, const std::string& path,
                         const std::string& interpolation) {
  REQUIRE(model.animations.size() == 1);
  for (const auto& channel : model.animations[0].channels) {
    if (channel.target_node != node || channel.target_path != path) continue;
    const auto& sampler = model.animations[0].samplers[static_cast<std::size_t>(channel.sampler)];
    CHECK(sampler.interpolation == interpolation);
    CHECK(floats(model, sampler.input) == std::vector<float>(run.key_times_s.begin(), run.key_times_s.end()));
    return floats(model, sampler.output);
  }
  FAIL("node " << node << " has no channel for " << path);
  return {};
}

const tinygltf::Value& extras(const tinygltf::Model& model, int node) {
  return model.nodes[static_cast<std::size_t>(node)].extras.Get("pirsim");
}

/// Largest distance between the two rotations' images of the unit axes.
double rotation_gap(const Quat& a, const Quat& b) {
  double gap = 0.0;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
    gap = std::max(gap, glm::distance(a * axis, b * axis));
  return gap;
}

void check_equal(const tinygltf::Model& model, const ExportedRun& run) {
  const auto names = node_names(model);
  for (const ExportedPerson& someone : run.people) {
    const int person_node = names.at(someone.id);
    CHECK(extras(model, person_node).Get("type").Get<std::string>() == "person");
    const std::vector<float> scale = track(model, run, person_node, "scale", "STEP");
    for (std::size_t i = 0; i < scale.size(); ++i) CHECK(scale[i] == static_cast<float>(someone.present[i / 3]));
    for (const ExportedPart& part : someone.parts) {
      const int node = names.at(someone.id + "/" + part.part);
      const auto& siblings = model.nodes[static_cast<std::size_t>(person_node)].children;
      CHECK(std::count(siblings.begin(), siblings.end(), node) == 1);
      const std::vector<float> t = track(model, run, node, "translation", "LINEAR");
      const std::vector<float> r = track(model, run, node, "rotation", "LINEAR");
      for (std::size_t key = 0; key < part.world_from_part.size(); ++key) {
        const Frame& frame = part.world_from_part[key];
        CHECK(glm::distance(Vec3(t[3 * key], t[3 * key + 1], t[3 * key + 2]), frame.origin) < 1e-6);
        const Quat q(r[4 * key + 3], r[4 * key], r[4 * key + 1], r[4 * key + 2]);
        CHECK(std::abs(glm::length(q) - 1.0) < 1e-6);
        CHECK(rotation_gap(q, frame.rotation) < 1e-6);
        if (key == 0) continue;
        const Quat before(r[4 * key - 1], r[4 * key - 4], r[4 * key - 3], r[4 * key - 2]);
        CHECK(glm::dot(before, q) >= 0.0);
      }
    }
  }
}

/// Whether the file passes tools/validate_gltf, and what it said.
std::pair<bool, std::string> validated(const fs::path& file) {
  const fs::path said = file.string() + ".txt";
  const std::string tool = pirsim::test::tests_dir().parent_path() / "tools" / "validate_gltf";
  const int status = std::system(("'" + tool + "' '" + file.string() + "' >'" + said.string() + "' 2>&1").c_str());
  return {status == 0, content(said)};
}

}  // namespace

TEST_CASE("a run read back from either kind of glTF has the poses and presences that were written", "[gltf_writer]") {
  const TemporaryFolder folder;
  const ExportedRun run = some_run();
  for (const std::string name : {"run.gltf", "run.glb"}) {
    write_gltf(folder.path() / name, run);
    check_equal(read_back(folder.path() / name), run);
  }
  CHECK(content(folder.path() / "run.glb").substr(0, 4) == "glTF");
  CHECK(content(folder.path() / "run.gltf").substr(0, 1) == "{");
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 2);
}

TEST_CASE("every body part says which primitive it is and how large", "[gltf_writer]") {
  const TemporaryFolder folder;
  write_gltf(folder.path() / "run.gltf", some_run());
  const tinygltf::Model model = read_back(folder.path() / "run.gltf");
  const auto names = node_names(model);
  const auto& head = extras(model, names.at("anna/head"));
  CHECK(head.Get("type").Get<std::string>() == "body_part");
  CHECK(head.Get("person").Get<std::string>() == "anna");
  CHECK(head.Get("part").Get<std::string>() == "head");
  CHECK(head.Get("primitive").Get<std::string>() == "sphere");
  CHECK(head.Get("radius_m").GetNumberAsDouble() == 0.12);
  const auto& thigh = extras(model, names.at("bert/left_thigh"));
  CHECK(thigh.Get("primitive").Get<std::string>() == "capsule");
  CHECK(thigh.Get("radius_m").GetNumberAsDouble() == 0.08);
  CHECK(thigh.Get("half_length_m").GetNumberAsDouble() == 0.2);
  const auto& torso = extras(model, names.at("bert/torso"));
  CHECK(torso.Get("primitive").Get<std::string>() == "box");
  REQUIRE(torso.Get("half_extents_m").ArrayLen() == 3);
  CHECK(torso.Get("half_extents_m").Get(1).GetNumberAsDouble() == 0.3);
}

TEST_CASE("the triangles of a part lie on its primitive, a capsule's along Y", "[gltf_writer]") {
  const TemporaryFolder folder;
  write_gltf(folder.path() / "run.gltf", some_run());
  const tinygltf::Model model = read_back(folder.path() / "run.gltf");
  const auto names = node_names(model);
  const auto positions = [&](const std::string& node) {
    const int mesh = model.nodes[static_cast<std::size_t>(names.at(node))].mesh;
    return floats(model, model.meshes[static_cast<std::size_t>(mesh)].primitives[0].attributes.at("POSITION"));
  };
  const auto capsule = positions("anna/left_thigh");
  double tallest = 0.0;
  for (std::size_t i = 0; i < capsule.size(); i += 3) {
    const Vec3 p(capsule[i], capsule[i + 1], capsule[i + 2]);
    const Vec3 on_axis(0.0, std::clamp(p.y, -0.2, 0.2), 0.0);
    CHECK(glm::distance(p, on_axis) == Approx(0.08).epsilon(1e-6));
    tallest = std::max(tallest, std::abs(p.y));
  }
  CHECK(tallest == Approx(0.28));
  const auto box = positions("anna/torso");
  for (std::size_t i = 0; i < box.size(); i += 3) {
    CHECK(std::abs(box[i]) == Approx(0.2));
    CHECK(std::abs(box[i + 1]) == Approx(0.3));
    CHECK(std::abs(box[i + 2]) == Approx(0.1));
  }
}

TEST_CASE("a part that is a mesh is exported as its own triangles, flat shaded", "[gltf_writer]") {
  const TemporaryFolder folder;
  ExportedRun run = some_run();
  const TriMesh hat{"hat", {{0, 0.3, 0}, {0.1, 0, 0}, {0, 0, -0.1}, {-0.1, 0, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  run.people[0].parts[0].shape = MeshSolid{std::make_shared<const TriangleSurface>(hat)};
  write_gltf(folder.path() / "run.gltf", run);
  const tinygltf::Model model = read_back(folder.path() / "run.gltf");
  check_equal(model, run);
  const int node = node_names(model).at("anna/head");
  CHECK(extras(model, node).Get("primitive").Get<std::string>() == "mesh");
  const auto mesh = static_cast<std::size_t>(model.nodes[static_cast<std::size_t>(node)].mesh);
  const auto& attributes = model.meshes[mesh].primitives[0].attributes;
  CHECK(floats(model, attributes.at("POSITION")) ==
        std::vector<float>{0, 0.3F, 0, 0.1F, 0, 0, 0, 0, -0.1F, 0, 0.3F, 0, 0, 0, -0.1F, -0.1F, 0, 0});
  const std::vector<float> normals = floats(model, attributes.at("NORMAL"));
  REQUIRE(normals.size() == 18);
  CHECK(normals[0] > 0.0F);  // of the first triangle, to the right and up
  CHECK(normals[1] > 0.0F);
  CHECK(normals[9] < 0.0F);
  CHECK(normals[10] > 0.0F);
}

TEST_CASE("room and beams are exported as triangles and lines at their places", "[gltf_writer]") {
  const TemporaryFolder folder;
  write_gltf(folder.path() / "run.gltf", some_run());
  const tinygltf::Model model = read_back(folder.path() / "run.gltf");
  const auto names = node_names(model);
  CHECK(names.count("nothing") == 0);
  CHECK(names.count("PIR2/beams") == 0);
  const auto primitive = [&](const std::string& name) {
    const int mesh = model.nodes[static_cast<std::size_t>(names.at(name))].mesh;
    return model.meshes[static_cast<std::size_t>(mesh)].primitives[0];
  };
  const auto beams = primitive("PIR1/beams");
  CHECK(beams.mode == TINYGLTF_MODE_LINE);
  CHECK(extras(model, names.at("PIR1/beams")).Get("type").Get<std::string>() == "beams");
  CHECK(extras(model, names.at("PIR1/beams")).Get("sensor").Get<std::string>() == "PIR1");
  CHECK(floats(model, beams.attributes.at("POSITION")) ==
        std::vector<float>{0, 2.6F, 0, 1.25F, 0, 3, 0, 2.6F, 0, 2, 0, 3.1F});
  const auto table = primitive("table");
  CHECK(floats(model, table.attributes.at("POSITION")) == std::vector<float>{1, 0.7F, 1, 2, 0.7F, 1, 2, 0.7F, 2});
  CHECK(model.materials[static_cast<std::size_t>(table.material)].alphaMode == "OPAQUE");
  CHECK(model.materials[static_cast<std::size_t>(primitive("wall").material)].alphaMode == "BLEND");
}

TEST_CASE("exported runs pass the Khronos validator without errors or warnings", "[gltf_writer][seconds]") {
  const TemporaryFolder folder;
  ExportedRun without_people = some_run();
  without_people.people.clear();
  ExportedRun one_key = some_run();
  one_key.key_times_s.resize(1);
  for (ExportedPerson& someone : one_key.people) {
    someone.present.resize(1);
    for (ExportedPart& part : someone.parts) part.world_from_part.resize(1);
  }
  const std::map<std::string, ExportedRun> runs{
      {"run", some_run()}, {"no_people", without_people}, {"one_key", one_key}, {"empty", ExportedRun{}}};
  for (const auto& [name, run] : runs) {
    for (const std::string extension : {".gltf", ".glb"}) {
      const fs::path file = folder.path() / (name + extension);
      write_gltf(file, run);
      const auto [sound, said] = validated(file);
      INFO(said);
      CHECK(sound);
      if (said.find("SKIPPED") != std::string::npos) WARN(said);
    }
  }
}

TEST_CASE("the validator refuses an exported run that was tampered with", "[gltf_writer]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "run.gltf";
  write_gltf(file, some_run());
  std::string text = content(file);
  const std::size_t at = text.find("\"LINEAR\"");
  REQUIRE(at != std::string::npos);
  std::ofstream(file) << text.replace(at, 8, "\"CUBICSPLINE\"");
  const auto [sound, said] = validated(file);
  if (said.find("SKIPPED") != std::string::npos) return;
  CHECK_FALSE(sound);
}

TEST_CASE("the same run is written as the same bytes", "[gltf_writer]") {
  const TemporaryFolder folder;
  write_gltf(folder.path() / "a.glb", some_run());
  write_gltf(folder.path() / "b.glb", some_run());
  CHECK(content(folder.path() / "a.glb") == content(folder.path() / "b.glb"));
}

TEST_CASE("runs whose keys, poses or presences don't match are refused and nothing is written", "[gltf_writer]") {
  const TemporaryFolder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(ExportedRun&)>> faults{
      [](ExportedRun& run) { run.key_times_s.pop_back(); },
      [](ExportedRun& run) { run.key_times_s[3] = run.key_times_s[2]; },
      [](ExportedRun& run) { run.key_times_s[0] = -1.0; },
      [&](ExportedRun& run) { run.key_times_s[8] = nan; },
      [](ExportedRun& run) { run.people[1].present.pop_back(); },
      [](ExportedRun& run) { run.people[1].parts[2].world_from_part.pop_back(); },
      [&](ExportedRun& run) { run.people[0].parts[0].world_from_part[4].origin.y = nan; },
      [](ExportedRun& run) { run.people[0].parts[0].world_from_part[4].rotation = Quat(0, 0, 0, 0); },
      [&](ExportedRun& run) { run.meshes[0].positions[1].x = nan; },
      [](ExportedRun& run) { run.meshes[0].triangles[1][2] = 4; },
      [&](ExportedRun& run) { run.beams[0].segments[0].second.z = nan; },
      [](ExportedRun& run) { run.people[0].id = "not UTF-8: \xFF"; }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    ExportedRun run = some_run();
    faults[i](run);
    INFO("fault " << i);
    try {
      write_gltf(folder.path() / "run.gltf", run);
      FAIL_CHECK("no error");
    } catch (const Error& error) {
      CHECK(error.code() == ErrorCode::usage);
    }
  }
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("a run that can't be stored is an io error", "[gltf_writer]") {
  const TemporaryFolder folder;
  try {
    write_gltf(folder.path() / "none" / "run.gltf", some_run());
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::io);
  }
}
