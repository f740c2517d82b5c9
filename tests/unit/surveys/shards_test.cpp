#include "files/write/campaign.hpp"

#include <map>

#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::studies;

namespace {

Environment environment(std::map<std::string, std::string> values) {
  return [values = std::move(values)](const char* name) {
    const auto found = values.find(name);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  };
}

Environment slurm(const char* id, const char* min, const char* max, const char* step, const char* count) {
  return environment({{"SLURM_ARRAY_TASK_ID", id},
                      {"SLURM_ARRAY_TASK_MIN", min},
                      {"SLURM_ARRAY_TASK_MAX", max},
                      {"SLURM_ARRAY_TASK_STEP", step},
                      {"SLURM_ARRAY_TASK_COUNT", count}});
}

const Environment nothing = environment({});

std::string fault(std::string_view text, const Environment& variables) {
  try {
    const Shard shard = parse_shard(text, variables);
    return "accepted: " + std::to_string(shard.index) + "/" + std::to_string(shard.count);
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::usage);
    return error.what();
  }
}

/// A finished shard of two, with the rows of one run.
void write_shard(const TemporaryFolder& folder, std::uint32_t index, const std::string& header,
                 const std::string& rows) {
  const Shard shard{index, 2};
  io::Manifest made;
  made.provenance.study_runs = shard.count;
  made.shard = shard;
  made.runs = runs_of(shard, shard.count);
  io::RowFile file(folder.path() / (shard_name(shard) + ".csv"), made, header, io::RowFile::Start::anew);
  file.add_run(rows, 1);
  file.commit();
}

}  // namespace

TEST_CASE("shards are contiguous and hold every run once and differ by one run at most", "[shards]") {
  for (const std::uint32_t n_runs : {0U, 1U, 2U, 7U, 40U, 2000U, 4'000'000'000U}) {
    for (const std::uint32_t count : {1U, 2U, 3U, 7U, 41U, 1000U}) {
      std::uint32_t next = 0, least = n_runs, most = 0;
      for (std::uint32_t index = 1; index <= count; ++index) {
        const RunRange runs = runs_of({index, count}, n_runs);
        REQUIRE(runs.first == next);
        REQUIRE(runs.end >= runs.first);
        next = runs.end;
        least = std::min(least, runs.count());
        most = std::max(most, runs.count());
      }
      CHECK(next == n_runs);
      CHECK(most - least <= 1);
    }
  }
}

TEST_CASE("a shard is read as I of N and refused otherwise", "[shards]") {
  CHECK(parse_shard("3/100", nothing) == Shard{3, 100});
  CHECK(parse_shard("1/1", nothing) == Shard{1, 1});
  CHECK_THAT(fault("0/5", nothing), contains("there is no shard 0 of 5"));
  CHECK_THAT(fault("6/5", nothing), contains("there is no shard 6 of 5"));
  for (const char* text : {"", "3", "3/", "/3", "3/x", "-1/3", "1/3/5", "1 /3", "99999999999/99999999999", "Auto"}) {
    CHECK_THAT(fault(text, nothing), contains("expected I/N, auto/N or auto"));
  }
}

TEST_CASE("auto takes number and count from an evenly spaced array of Slurm", "[shards]") {
  CHECK(parse_shard("auto", slurm("0", "0", "99", "1", "100")) == Shard{1, 100});
  CHECK(parse_shard("auto", slurm("7", "1", "100", "1", "100")) == Shard{7, 100});
  CHECK(parse_shard("auto", slurm("10", "0", "10", "5", "3")) == Shard{3, 3});  // 0-14:5, as Slurm reports it
  CHECK_THAT(fault("auto", slurm("8", "1", "9", "1", "4")), contains("aren't evenly spaced"));  // 1,3,8-9
  CHECK_THAT(fault("auto", slurm("11", "1", "10", "1", "10")), contains("not a task of its array"));
  CHECK_THAT(fault("auto", slurm("x", "1", "10", "1", "10")), contains("expected a whole number, got 'x'"));
  CHECK_THAT(fault("auto", slurm("4", "1", "10", "0", "10")), contains("aren't evenly spaced"));
  CHECK_THAT(fault("auto", environment({{"SLURM_ARRAY_TASK_ID", "4"}})), contains("SLURM_ARRAY_TASK_MIN isn't set"));
}

TEST_CASE("auto of N takes only the number so that a part of an array can be submitted again", "[shards]") {
  CHECK(parse_shard("auto/100", slurm("8", "1", "9", "1", "4")) == Shard{8, 100});
  CHECK(parse_shard("auto/100", environment({{"PBS_ARRAY_INDEX", "8"}})) == Shard{8, 100});
  CHECK(parse_shard("auto/100", environment({{"PBS_ARRAYID", "8"}})) == Shard{8, 100});
  CHECK(parse_shard("auto/100", environment({{"SGE_TASK_ID", "8"}})) == Shard{8, 100});
  CHECK_THAT(fault("auto/100", environment({{"SGE_TASK_ID", "undefined"}})),
             contains("none of these variables is set"));
  CHECK_THAT(fault("auto/100", slurm("0", "0", "99", "1", "100")), contains("there is no shard 0 of 100"));
}

TEST_CASE("auto knows the arrays of SGE and says what PBS does not tell", "[shards]") {
  CHECK(parse_shard("auto", environment({{"SGE_TASK_ID", "7"},
                                         {"SGE_TASK_FIRST", "3"},
                                         {"SGE_TASK_LAST", "11"},
                                         {"SGE_TASK_STEPSIZE", "2"}})) == Shard{3, 5});
  CHECK_THAT(fault("auto", environment({{"PBS_ARRAY_INDEX", "8"}})), contains("PBS doesn't tell"));
  CHECK_THAT(fault("auto", nothing), contains("none of these variables is set") && contains("--shard I/N"));
}

TEST_CASE("a shard's name is read back and no other name is", "[shards]") {
  CHECK(shard_name({3, 100}) == "shard-0003-of-0100");
  for (const Shard shard : {Shard{1, 1}, Shard{3, 100}, Shard{9999, 10000}, Shard{12345, 99999}}) {
    CHECK(shard_of(shard_name(shard) + ".csv.zst.json") == shard);
    CHECK(shard_of(shard_name(shard)) == shard);
  }
  for (const char* name : {"shard-3-of-100.csv", "shard-0003-of-.csv", "shard-0101-of-0100.csv",
                           "shard-0000-of-0100.csv", "all.csv", "shard-0003", "shard-0003-of-01x0.csv", ""}) {
    CHECK_FALSE(shard_of(name));
  }
}

TEST_CASE("shards are merged under one header, and not where another column is as long", "[shards]") {
  const TemporaryFolder folder;
  const std::filesystem::path merged = folder.path() / "all.csv";
  write_shard(folder, 1, "trial,PIR1\n", "S1,0\n");
  write_shard(folder, 2, "trial,PIR1\n", "S2,1\n");
  CHECK(merge_campaign(folder.path(), merged).rows == 2);
  CHECK(content(merged) == "trial,PIR1\nS1,0\nS2,1\n");

  write_shard(folder, 2, "trial,PIR2\n", "S2,1\n");
  CHECK_THROWS_WITH(merge_campaign(folder.path(), merged), contains("its columns are not those of the first shard"));
  CHECK(content(merged) == "trial,PIR1\nS1,0\nS2,1\n");
}
