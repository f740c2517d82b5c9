#include "pirsim/error.hpp"

#include "support/catch.hpp"

using namespace pirsim;

TEST_CASE("a fault is told once at a place") {
  Diagnostics faults;
  faults.error({"a.yaml", 3, 1}, "too fast");
  faults.error({"a.yaml", 3, 1}, "too fast");
  faults.error({"a.yaml", 4, 1}, "too fast");
  faults.warning({"a.yaml", 3, 1}, "too fast");
  CHECK(faults.issues().size() == 3);
}

TEST_CASE("a list of what there is, is told once") {
  Diagnostics faults;
  faults.error({"a.yaml", 3, 1}, "seat 'S1' is not in flat.gltf; there are chair, sofa");
  faults.error({"a.yaml", 4, 1}, "seat 'S2' is not in flat.gltf; there are chair, sofa");
  faults.error({"a.yaml", 4, 1}, "seat 'S2' is not in flat.gltf; there are chair, sofa");
  faults.error({"a.yaml", 5, 1}, "entrance 'gate' is not in flat.gltf; there are door, back door");
  REQUIRE(faults.issues().size() == 3);
  CHECK(faults.issues()[0].message == "seat 'S1' is not in flat.gltf; there are chair, sofa");
  CHECK(faults.issues()[1].message == "seat 'S2' is not in flat.gltf");
  CHECK(faults.issues()[2].message == "entrance 'gate' is not in flat.gltf; there are door, back door");
}

TEST_CASE("a key without its unit is known by its beginning") {
  const std::vector<std::string> keys{"model", "position_m", "yaw_deg", "tilt_deg", "arm_period_s", "arm_amplitude_m"};
  CHECK(did_you_mean("yaw", keys) == " (did you mean 'yaw_deg'?)");
  CHECK(did_you_mean("Tilt", keys) == " (did you mean 'tilt_deg'?)");
  CHECK(did_you_mean("yaw", {"raw", "yaw_deg"}) == " (did you mean 'yaw_deg'?)");
  CHECK(did_you_mean("arm", keys).empty());  // two go on like this
  CHECK(did_you_mean("ya", keys).empty());   // no whole word
  CHECK(did_you_mean("", {"_deg"}).empty());
}
