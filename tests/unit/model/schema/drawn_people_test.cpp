// How warm people of schedules, households and counts are.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/study/people.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;

namespace {

constexpr std::uint32_t n_people = 4000;

std::vector<PersonSpec> crowd() {
  std::vector<PersonSpec> people;
  for (std::uint32_t i = 0; i < n_people; ++i) people.push_back(drawn_body("p", MotionStyle::natural, 7, i));
  return people;
}

double share(const std::vector<PersonSpec>& people, auto is_so) {
  return static_cast<double>(std::ranges::count_if(people, is_so)) / static_cast<double>(people.size());
}
/// Of a share p of so many people, three standard errors.
double margin(double p) { return 3.0 * std::sqrt(p * (1.0 - p) / n_people); }

}  // namespace

TEST_CASE("people wear what was measured in offices", "[schedule][warmth]") {
  const std::vector<PersonSpec> people = crowd();
  const auto lighter_than = [&](double clo) {
    return share(people, [&](const PersonSpec& person) { return person.warmth.clothing_clo < clo; });
  };
  CHECK(std::abs(lighter_than(0.59) - 0.5) < margin(0.5));  // median of all seasons [Schiavon2013]
  CHECK(std::abs(lighter_than(0.5) - 0.5) > margin(0.5));   // of summer
  CHECK(std::abs(lighter_than(0.66) - 0.5) > margin(0.5));  // of winter
  CHECK(std::abs(lighter_than(0.59 * std::exp(0.37)) - 0.8413) < margin(0.8413));  // a standard deviation above
  CHECK(std::abs(lighter_than(0.59 * std::exp(0.30)) - 0.8413) > margin(0.8413));
  for (const PersonSpec& person : people) {
    const bool short_sleeves = std::ranges::find(person.warmth.bare, "left_forearm") != person.warmth.bare.end();
    REQUIRE(short_sleeves == (person.warmth.clothing_clo < 0.59));
  }
}

TEST_CASE("people's skin differs as measured", "[schedule][warmth]") {
  const std::vector<PersonSpec> people = crowd();
  const double within = share(people, [](const PersonSpec& p) { return std::abs(p.warmth.skin_above_k) < 1.0; });
  CHECK(std::abs(within - 0.833) < margin(0.833));  // [Mehnert2000]
  const double above = share(people, [](const PersonSpec& p) { return p.warmth.skin_above_k > 0.0; });
  CHECK(std::abs(above - 0.5) < margin(0.5));
  CHECK_FALSE(people[0].warmth.skin_c);  // it follows the air
  CHECK(people[0].warmth.hair_share != people[1].warmth.hair_share);
}

TEST_CASE("what people wear is drawn beside how large they are", "[schedule][warmth]") {
  for (const std::uint32_t entity : {0U, 3U}) {
    const PersonSpec person = drawn_body("p", MotionStyle::natural, 11, entity);
    Stream body({11, 0, entity, Purpose::schedule_body});
    CHECK(person.stature_m == Approx(std::clamp(1.72 + 0.09 * body.normal(), 1.52, 1.92)));
    CHECK(person.mass_kg / (person.stature_m * person.stature_m) ==
          Approx(std::clamp(24.5 + 3.0 * body.normal(), 18.0, 32.0)));
    CHECK(person.warmth.clothing_clo == drawn_body("q", MotionStyle::choreographed, 11, entity).warmth.clothing_clo);
    CHECK(person.warmth.clothing_clo != drawn_body("p", MotionStyle::natural, 12, entity).warmth.clothing_clo);
  }
}
