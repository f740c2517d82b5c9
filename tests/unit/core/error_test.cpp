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
