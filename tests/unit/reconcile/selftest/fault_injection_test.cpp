// What a self-test hides.
#include "reconcile/selftest/selftest.hpp"

#include <algorithm>
#include <filesystem>

#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/short_study.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

ReferenceStudy study_of(const Settings& analysis) {
  return make_full_study(test::shipped_scene("meeting_room.gltf"), test::short_study({"S4"}, 60.0), analysis,
                         Measured::Kind::series, 1);
}

}  // namespace

TEST_CASE("datasets that were injected are kept beside those of other numbers", "[reconcile][selftest]") {
  const TemporaryFolder folder;
  SelftestSettings settings;
  settings.analysis.table = {20, 20, 20, {"false_triggers"}};
  settings.n_nulls = 2;
  settings.n_injected = 0;
  settings.injected_folder = folder.path() / "injected";
  const ReferenceStudy reference = study_of(settings.analysis);
  const auto inject_so_many = [&](std::uint32_t n) {
    settings.n_nulls = n;
    return inject(reference, settings);
  };
  const auto changed_last = [&] {
    std::filesystem::file_time_type last{};
    for (const auto& hypothesis : std::filesystem::recursive_directory_iterator(folder.path()))
      last = std::max(last, hypothesis.last_write_time());
    return last;
  };
  CHECK(inject_so_many(2).size() == 2);
  CHECK(inject_so_many(3).size() == 3);
  const auto before = changed_last();
  CHECK(inject_so_many(2).size() == 2);
  CHECK(changed_last() == before);  // nothing was simulated again
}
