// terrane diff, and what programs that watch and search are told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/program.hpp"
#include "cli/relief_file.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

using testing::HasSubstr;

/// A run of one stage over a relief.
void make_run(const TemporaryFolder& folder, const std::string& name, double hill_m) {
  ReliefFile relief;
  relief.height_m = [hill_m](double latitude_deg, double longitude_deg) {
    const bool hill =
        latitude_deg > 0.0 && latitude_deg < 5.0 && longitude_deg > 0.0 && longitude_deg < 5.0;
    return latitude_deg > -30.0 ? 100.0 + (hill ? hill_m : 0.0) : -2000.0;
  };
  relief.write(folder / (name + ".nc"));
  const Outcome outcome =
      terrane(quick_run(folder / (name + ".nc"), folder / name, {"--to", "erosion", "--no-vtk"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
}

TEST(Diff, OfARunWithItselfIsNothing) {
  const TemporaryFolder folder;
  make_run(folder, "a", 10.0);
  const std::string run = (folder / "a").string();
  const Outcome same = terrane({"diff", run, run});
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("the same"));
}

TEST(Diff, SaysWhereAndByHowMuchAndMindsTheTolerance) {
  const TemporaryFolder folder;
  make_run(folder, "a", 10.0);
  make_run(folder, "b", 12.5);
  const std::string a = (folder / "a" / "03-erosion.nc").string();
  const std::string b = (folder / "b" / "03-erosion.nc").string();
  const Outcome outcome = terrane({"diff", a, b, "--json"});
  EXPECT_EQ(outcome.code, 6) << outcome.err;
  EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_FALSE(json.at("same"));
  for (const auto& field : json.at("stages")[0].at("fields")) {
    if (field.at("name") != "elevation") continue;
    EXPECT_FALSE(field.at("same"));
    EXPECT_NEAR(field.at("largest").get<double>(), 2.5, 1e-4);
    EXPECT_NEAR(field.at("latitude").get<double>(), 2.5, 0.01);
    EXPECT_EQ(field.at("different"), 1.0);
  }
  const auto wide =
      nlohmann::json::parse(terrane({"diff", a, b, "--json", "--tolerance", "2.6"}).out);
  for (const auto& field : wide.at("stages")[0].at("fields")) {
    if (field.at("name") == "elevation") EXPECT_TRUE(field.at("same"));
  }
  const Outcome configurations = terrane(
      {"diff", (folder / "a" / "config.toml").string(), (folder / "b" / "config.toml").string()});
  EXPECT_EQ(configurations.code, 6);
  EXPECT_THAT(configurations.out, HasSubstr("dem.file"));
}

TEST(Diff, RefusesInOneLineWhatCannotBeCompared) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.toml") << "[run]\nseed = 3\n";
  const std::string toml = (folder / "a.toml").string();
  for (const auto& [arguments, code] :
       {std::pair{std::vector<std::string>{"diff", toml}, 2},
        std::pair{std::vector<std::string>{"diff", toml, folder.path().string()}, 2},
        std::pair{std::vector<std::string>{"diff", folder.path().string(), folder.path().string()},
                  2},
        std::pair{std::vector<std::string>{"diff", toml, toml, "--tolerance", "some"}, 2},
        std::pair{std::vector<std::string>{"diff", "absent.nc", "absent.nc"}, 4}}) {
    const Outcome outcome = terrane(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  }
}

TEST(JsonProgress, TellsBeginningsFractionsAndEndsOfStages) {
  const TemporaryFolder folder;
  ReliefFile{}.write(folder / "relief.nc");
  const Outcome outcome = terrane(quick_run(folder / "relief.nc", folder / "run",
                                            {"--to", "climate", "--no-vtk", "--json-progress"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  std::vector<std::string> begun, ended;
  for (const std::string& line : lines_of(outcome.err)) {
    const auto json = nlohmann::json::parse(line);
    if (!json.contains("event")) continue;
    if (json.at("event") == "stage-begins") begun.push_back(json.at("stage"));
    if (json.at("event") == "stage-ends") ended.push_back(json.at("stage"));
    if (json.at("event") == "progress") {
      EXPECT_GE(json.at("fraction").get<double>(), 0.0);
      EXPECT_LE(json.at("fraction").get<double>(), 1.0);
    }
  }
  EXPECT_EQ(begun, (std::vector<std::string>{"erosion", "climate"}));
  EXPECT_EQ(ended, begun);
}

TEST(Params, AreFoundByWords) {
  const Outcome of_stage = terrane({"params", "erosion", "crust", "thickness"});
  ASSERT_EQ(of_stage.code, 0) << of_stage.err;
  EXPECT_THAT(of_stage.out, HasSubstr("erosion.rebound_fraction"));
  const auto everywhere =
      nlohmann::json::parse(terrane({"params", "SEED", "--format", "json"}).out);
  bool found = false;
  for (const auto& row : everywhere) found = found || row.at("name") == "run.seed";
  EXPECT_TRUE(found);
  EXPECT_LT(everywhere.size(), 20U);
}

}  // namespace
}  // namespace geo
