#include "files/write/campaign.hpp"

#include "pirsim/error.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::studies;

namespace {

const std::string rows =
    "replicate,trial,time_s,phase,people,PIR1,\"PIR, two\"\n"
    "1,S1,1,walking,1,1,1\n"
    "1,S1,2,working,1,1,0\n"
    "1,S1,3,working,1,1,0\n"
    "1,\"S \"\"2\"\"\nb\",1,working,1,0,1\n"
    "2,S1,1,working,1,0,0\n"
    "2,\"S \"\"2\"\"\nb\",1,working,1,1,1\n";
const std::vector<std::string> trials{"S1", "S \"2\"\nb"};

RowTally tally_of(std::string_view text, std::size_t piece) {
  RowTally tally(trials, {{"working"}, {}, {}}, {});
  for (std::size_t i = 0; i < text.size(); i += piece) tally.add(text.substr(i, piece));
  return tally;
}

}  // namespace

TEST_CASE("a tally of rows counts each run whatever the pieces they come in", "[summary]") {
  for (const std::size_t piece : {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{64}, rows.size()}) {
    RowTally tally = tally_of(rows, piece);
    const std::vector<CellSummary> cells = tally.finish().cells();
    REQUIRE(cells.size() == 4);
    CHECK(cells[1].sensor == "PIR, two");
    CHECK(cells[2].trial == trials[1]);
    // By hand, without the row in which the person walks.
    const int runs[] = {2, 2, 2, 2}, least[] = {0, 0, 0, 1}, most[] = {2, 0, 1, 1};
    const double mean[] = {1.0, 0.0, 0.5, 1.0};
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(cells[i].runs == runs[i]);
      CHECK(cells[i].min == least[i]);
      CHECK(cells[i].max == most[i]);
      CHECK(cells[i].mean == mean[i]);
    }
  }
}

TEST_CASE("a tally of rows with areas counts people in them and no area as a sensor", "[summary]") {
  RowTally tally({"S1"}, {{"working"}, {}, {}}, {});
  tally.add(
      "replicate,trial,time_s,phase,people,people_hall,people_elsewhere,PIR1\n"
      "1,S1,1,walking,9,9,0,1\n1,S1,2,working,3,1,2,1\n1,S1,3,working,2,0,2,0\n2,S1,1,working,0,0,0,1\n");
  const Summary& summary = tally.finish();
  REQUIRE(summary.cells().size() == 1);
  CHECK(summary.cells()[0].sensor == "PIR1");
  CHECK(summary.cells()[0].mean == 1.0);
  REQUIRE(summary.areas().size() == 2);
  const AreaSums& rest = summary.areas()[1];
  CHECK(rest.area == "elsewhere");
  CHECK(rest.rows == 3);
  CHECK(rest.occupied == 2);
  CHECK(rest.person_rows == 4);
  CHECK(rest.most == 2);
  CHECK_THAT(to_markdown(summary), contains("| elsewhere | 2.0 | 66.7 | 2 |"));
}

TEST_CASE("a tally refuses what are not rows of the study", "[summary]") {
  CHECK_THROWS_AS(tally_of("a,b\n1,2\n", 64), Error);
  CHECK_THROWS_AS(tally_of(rows + "3,S1,1,working,1,1\n", 64), Error);
  CHECK_THROWS_AS(tally_of(rows + "3,S9,1,working,1,1,1\n4,S1,1,working,1,1,1\n", 64), Error);
  CHECK_THROWS_AS((void)tally_of(rows + "3,S1,1,wor", 64).finish(), Error);
  CHECK_THROWS_AS((void)tally_of("", 64).finish(), Error);
}
