// A person's body_mesh in a script.
#include <glm/geometric.hpp>

#include "gltf_builder.hpp"
#include "model/geom/shapes.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

/// A glTF under construction with one mesh: a tetrahedron that lies 1, 2 and 3 dm along X, Y and Z.
struct BodyFile : GltfBuilder {
  int tetrahedron = mesh(positions({0, 0, 0, 0.1F, 0, 0, 0, 0.2F, 0, 0, 0, 0.3F}),
                         indices<std::uint16_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}));
  int part(const std::string& name, json more = json::object()) {
    more["mesh"] = tetrahedron;
    return node(name, more);
  }
};

const std::string one_person = "pirsim_script: 1\npeople:\n  - id: a\n    body_mesh: body.gltf\n    actions: []\n";

ScriptSpec script_with_body(const GltfBuilder& body, const std::string& script = one_person) {
  const TemporaryFolder folder;
  folder.write("body.gltf", body.text());
  return io::read_script(folder.write("script.yaml", script));
}

const TriMesh& mesh_of(const ScriptSpec& script, const std::string& part) {
  return script.trials.at(0).people.at(0).body_meshes.at(part).surface->mesh();
}

double mesh_volume(const TriMesh& mesh) {
  double sixfold = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sixfold += glm::dot(mesh.positions[a], glm::cross(mesh.positions[b], mesh.positions[c]));
  }
  return sixfold / 6.0;
}

}  // namespace

TEST_CASE("every named mesh of a body file is its part's, in metres", "[body_mesh]") {
  BodyFile file;
  file.part("torso");
  file.part("left_foot");
  file.node("empty, and of any name");
  const ScriptSpec script = script_with_body(file);
  const PersonSpec& person = script.trials.at(0).people.at(0);
  CHECK(person.body_mesh_file == "body.gltf");
  REQUIRE(person.body_meshes.size() == 2);
  const TriangleSurface& torso = *person.body_meshes.at("torso").surface;
  CHECK(torso.mesh().triangles.size() == 4);
  CHECK(glm::distance(torso.lower(), Vec3(0.0)) < 1e-7);
  CHECK(glm::distance(torso.upper(), Vec3(0.1, 0.2, 0.3)) < 1e-7);
  CHECK(mesh_volume(mesh_of(script, "left_foot")) == Approx(0.001).epsilon(1e-5));
}

TEST_CASE("a part's frame is its node's: where it stands doesn't count, scale and mirroring do", "[body_mesh]") {
  BodyFile file;
  const json turned = {0.5, 0.5, 0.5, 0.5};
  file.part("head", {{"translation", {0.3, 1.7, -2}}, {"rotation", turned}});
  const int scaled = file.child("right_foot", {{"mesh", file.tetrahedron}, {"scale", {-1, 1, 2}}});
  file.node("person", {{"translation", {5, 0, 0}}, {"rotation", turned}, {"scale", {2, 2, 2}}, {"children", {scaled}}});
  const ScriptSpec script = script_with_body(file);
  const auto& meshes = script.trials.at(0).people.at(0).body_meshes;
  CHECK(glm::distance(meshes.at("head").surface->upper(), Vec3(0.1, 0.2, 0.3)) < 1e-6);
  CHECK(glm::distance(meshes.at("head").surface->lower(), Vec3(0.0)) < 1e-6);
  CHECK(glm::distance(meshes.at("right_foot").surface->lower(), Vec3(-0.2, 0.0, 0.0)) < 1e-6);
  CHECK(glm::distance(meshes.at("right_foot").surface->upper(), Vec3(0.0, 0.4, 1.2)) < 1e-6);
  CHECK(mesh_volume(mesh_of(script, "right_foot")) == Approx(0.016).epsilon(1e-5));  // faces still look outward
}

TEST_CASE("trials and people share what one body file holds, and the script is written back as it was", "[body_mesh]") {
  BodyFile file;
  file.part("head");
  const TemporaryFolder folder;
  folder.write("bodies/body.glb", file.binary());
  const ScriptSpec script = io::read_script(folder.write("script.yaml", R"(pirsim_script: 1
trials: {for_each: {seat: [S1, S2], mesh: [body]}, id: "${seat}"}
people:
  - {id: a, body_mesh: "bodies/${mesh}.glb", actions: []}
  - {id: b, body_mesh: bodies/body.glb, actions: []}
  - {id: c, actions: []}
)"));
  REQUIRE(script.trials.size() == 2);
  const MeshSolid& head = script.trials[0].people[0].body_meshes.at("head");
  CHECK(script.trials[0].people[1].body_meshes.at("head") == head);
  CHECK(script.trials[1].people[0].body_meshes.at("head") == head);
  CHECK(script.trials[1].people[2].body_meshes.empty());

  const ScriptSpec again = io::read_script(folder.write("again.yaml", io::to_yaml(script)));
  CHECK(again.trials[1].people[1].body_mesh_file == "bodies/body.glb");
  CHECK(again.trials[1].people[1].body_meshes.size() == 1);
  CHECK(again.trials[1].people[2].body_mesh_file.empty());
}

TEST_CASE("a body file that can't be worn is refused with its place", "[body_mesh]") {
  const auto fault = [](const GltfBuilder& file) { return fault_of([&] { return script_with_body(file); }); };
  const auto with_node = [&](const std::string& name, const json& more = json::object()) {
    BodyFile file;
    file.part(name, more);
    return fault(file);
  };
  CHECK_THAT(with_node("left_forarm"), contains("body.gltf:"));
  CHECK_THAT(with_node("left_forarm"),
             contains("node 'left_forarm': no part of the body is called 'left_forarm' (did you mean "
                      "'left_forearm'?)"));
  CHECK_THAT(with_node(""), contains("no part of the body is called ''"));
  CHECK_THAT(with_node("torso", {{"scale", {1000, 1000, 1000}}}), contains("more than 3 m from the part's origin"));
  CHECK_THAT(with_node("torso", {{"scale", {1, 0, 1}}}), contains("singular"));
  CHECK_THAT(with_node("torso", {{"scale", {0, 0, 0}}}), contains("it is hidden"));

  BodyFile twice;
  twice.part("head");
  twice.part("head");
  CHECK_THAT(fault(twice), contains("a second mesh for this part"));
  BodyFile nobody;
  nobody.node("head");
  CHECK_THAT(fault(nobody), contains("no node has a mesh"));
  BodyFile flat;
  flat.node("head", {{"mesh", flat.mesh(flat.positions({0, 0, 0, 1, 0, 0, 2, 0, 0}))}});
  CHECK_THAT(fault(flat), contains("no triangle with an area"));
}

TEST_CASE("a fault of a body file is told with its line, once, beside the script's own", "[body_mesh]") {
  const TemporaryFolder folder;
  BodyFile file;
  file.part("hed");
  folder.write("body.gltf", file.text());
  const auto fault = [&](const std::string& script) {
    return fault_of([&] { return io::read_script(folder.write("script.yaml", script)); });
  };
  const std::string two = R"(pirsim_script: 1
trials: {for_each: {seat: [S1, S2]}, id: "${seat}"}
people:
  - {id: a, body_mesh: body.gltf, stature_m: 9, actions: []}
  - {id: b, body_mesh: body.gltf, actions: []}
)";
  const std::string text = fault(two);
  const std::string message = "no part of the body is called 'hed'";
  REQUIRE_THAT(text, contains(message));
  CHECK(text.find(message) == text.rfind(message));
  CHECK_THAT(text, contains("script.yaml:4:"));  // the stature
  const std::string glTF = file.text();
  const auto line =
      1 + std::count(glTF.begin(), glTF.begin() + static_cast<std::ptrdiff_t>(glTF.find("\"hed\"")), '\n');
  CHECK_THAT(text, contains("body.gltf:" + std::to_string(line) + ":"));

  CHECK_THAT(fault("pirsim_script: 1\npeople:\n  - {id: a, body_mesh: nobody.glb, actions: []}\n"),
             contains("script.yaml:3:24: error: body_mesh: there is no file"));
}
