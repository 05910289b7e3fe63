// terrane sweep: many runs, their table, and going on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cli/program.hpp"
#include "geo/io/input/table.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::vector<std::string> sweep_of(const TemporaryFolder& folder,
                                  const std::vector<std::string>& more) {
  std::vector<std::string> words{"sweep",   "--preset", "preview",
                                 "--grid",  "32x16",    "--to",
                                 "erosion", "-o",       (folder / "sweep").string()};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

io::Table table_of(const TemporaryFolder& folder) {
  return io::Table::of_file(folder / "sweep" / "sweep.csv");
}

std::size_t column_of(const io::Table& table, const std::string& name) {
  const auto& header = table.header();
  const auto at = std::find(header.begin(), header.end(), name);
  EXPECT_NE(at, header.end()) << name;
  return static_cast<std::size_t>(at - header.begin());
}

void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

TEST(Sweep, OfSeedsTabulatesTheirScores) {
  const TemporaryFolder folder;
  const Outcome outcome = terrane(sweep_of(folder, {"--seeds", "8..10,3", "-j", "2"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto table = table_of(folder);
  ASSERT_EQ(table.rows(), 4U);
  const std::vector<std::string> names{"seed-08", "seed-09", "seed-10", "seed-03"};
  for (std::size_t row = 0; row < names.size(); ++row) {
    EXPECT_EQ(table.text(row, 0), names[row]);
    EXPECT_EQ(table.number(row, column_of(table, "exit_code")), 0.0);
    EXPECT_GT(table.number(row, column_of(table, "figures")), 10.0);
    EXPECT_TRUE(fs::exists(folder / "sweep" / names[row] / "03-erosion.nc"));
    EXPECT_FALSE(fs::exists(folder / "sweep" / names[row] / "03-erosion.vti"));
  }
  EXPECT_NE(table.text(0, column_of(table, "land_mean")),
            table.text(1, column_of(table, "land_mean")));
}

TEST(Sweep, OfATableGivesEachRowItsValues) {
  const TemporaryFolder folder;
  write(folder / "table.csv",
        "run,planet.ocean_fraction,plates.count\nwet,0.9,12\n\"dry\",0.3,7\n");
  const Outcome outcome =
      terrane(sweep_of(folder, {(folder / "table.csv").string(), "--seeds", "1", "--scores-only"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto table = table_of(folder);
  ASSERT_EQ(table.rows(), 2U);
  EXPECT_EQ(table.text(0, 0), "wet-seed-1");
  EXPECT_EQ(table.text(1, column_of(table, "plates.count")), "7");
  const auto land = column_of(table, "land_fraction");
  EXPECT_NEAR(table.number(0, land), 10.0, 3.0);
  EXPECT_NEAR(table.number(1, land), 70.0, 3.0);
  EXPECT_FALSE(fs::exists(folder / "sweep" / "wet-seed-1"));  // scored, and gone
}

TEST(Sweep, GoesOnWhereItEnded) {
  const TemporaryFolder folder;
  ASSERT_EQ(terrane(sweep_of(folder, {"--seeds", "1"})).code, 0);
  const auto made = fs::last_write_time(folder / "sweep" / "seed-1" / "03-erosion.nc");
  ASSERT_EQ(terrane(sweep_of(folder, {"--seeds", "1..2"})).code, 0);
  EXPECT_EQ(fs::last_write_time(folder / "sweep" / "seed-1" / "03-erosion.nc"), made);
  EXPECT_EQ(table_of(folder).rows(), 2U);

  const Outcome other =
      terrane(sweep_of(folder, {"--seeds", "1..2", "--set", "planet.ocean_fraction=0.4"}));
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("another configuration"));
  const Outcome again = terrane(
      sweep_of(folder, {"--seeds", "1", "--set", "planet.ocean_fraction=0.4", "--overwrite"}));
  EXPECT_EQ(again.code, 0) << again.err;
}

TEST(Sweep, RefusesWhatNoRunCouldHaveBeforeTheFirst) {
  const TemporaryFolder folder;
  write(folder / "range.csv", "planet.radius_km\n6000\n-3\n");
  write(folder / "name.csv", "planet.radios_km\n6000\n");
  write(folder / "place.csv", "run,run.seed\n../up,1\n");
  write(folder / "twice.csv", "run,run.seed\na,1\na,2\n");
  const std::pair<const char*, const char*> cases[] = {
      {"range.csv", "row-0002: planet.radius_km = -3"},
      {"name.csv", "radius_km"},
      {"place.csv", "names a folder"},
      {"twice.csv", "two runs are called a"}};
  for (const auto& [file, words] : cases) {
    const Outcome outcome = terrane(sweep_of(folder, {(folder / file).string()}));
    EXPECT_EQ(outcome.code, 2) << file;
    EXPECT_THAT(outcome.err, HasSubstr(words));
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  }
  for (const char* seeds : {"", "a", "9..2", "1..", "-1", "1..99999999"}) {
    EXPECT_EQ(terrane(sweep_of(folder, {"--seeds", seeds})).code, 2) << seeds;
  }
  EXPECT_FALSE(fs::exists(folder / "sweep"));
}

TEST(Sweep, TellsOfTheRunsThatFailAndDoesTheOthers) {
  const TemporaryFolder folder;
  write(folder / "table.csv", "run,dem.file\ngood,\nbad,/nowhere/at/all.nc\n");
  const Outcome outcome = terrane(sweep_of(folder, {(folder / "table.csv").string()}));
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("1 of 2 runs failed"));
  const auto table = table_of(folder);
  EXPECT_EQ(table.number(0, column_of(table, "exit_code")), 0.0);
  EXPECT_EQ(table.number(1, column_of(table, "exit_code")), 4.0);
}

TEST(View, SaysWhereTheReportIs) {
  const TemporaryFolder folder;
  const Outcome none = terrane({"view", (folder / "x").string()});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("holds no report"));
}

}  // namespace
}  // namespace geo
