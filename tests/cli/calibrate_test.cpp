// `terrane calibrate`: what it writes, refuses, and goes on with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/folder_contents.hpp"
#include "cli/program.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using Words = std::vector<std::string>;

/// Two planets of few cells.
const Words kSmall{"--set", "calibration.grid=64x32",
                   "--set", "calibration.seeds=1-2",
                   "--set", "calibration.held_out=3",
                   "--set", "calibration.held_out_grid=",
                   "--set", "erosion.steps=2",
                   "--set", "calibration.iterations=3",
                   "--set", "calibration.free=isostasy.margin_tilt_m, isostasy.ocean_swell_m"};

class Calibrate : public testing::Test {
 protected:
  Outcome calibrate(const Words& more, const std::string& target = "earth") {
    Words arguments{"calibrate", "--target", target, "-o", out_.string()};
    arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return terrane(arguments);
  }
  void expect_refusal(const Words& more, int code, const Words& says,
                      const std::string& target = "earth") {
    const Outcome outcome = calibrate(more, target);
    SCOPED_TRACE(testing::PrintToString(more) + ": " + outcome.err);
    EXPECT_EQ(outcome.code, code);
    EXPECT_EQ(outcome.out, "");
    for (const std::string& words : says)
      EXPECT_THAT(lines_of(outcome.err).back(), HasSubstr(words));
    EXPECT_FALSE(fs::exists(out_ / "calibration.json"));
  }
  /// What does not depend on the clock.
  json answer() {
    json all = json::parse(text_of(out_ / "calibration.json"));
    return all.at("parameters");
  }

  TemporaryFolder folder_;
  const fs::path out_ = folder_ / "out";
};

TEST_F(Calibrate, WritesWhatARunTakes) {
  const Outcome outcome = calibrate({});
  ASSERT_TRUE(outcome.code == 0 || outcome.code == 5) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("isostasy.margin_tilt_m = "));
  for (const char* name :
       {"calibration.json", "fitted.toml", "hypsometry.csv", "hypsometry.png", "report.html"}) {
    EXPECT_TRUE(fs::exists(out_ / name)) << name;
  }
  const Outcome run =
      terrane({"run", (out_ / "fitted.toml").string(), "--grid", "64x32", "--to", "erosion",
               "--no-vtk", "--no-maps", "-o", (folder_ / "run").string()});
  EXPECT_EQ(run.code, 0) << run.err;
}

TEST_F(Calibrate, GoesOnWhereItStoppedWithTheSameBits) {
  const std::string far = "--set=isostasy.ocean_swell_m=60";
  (void)calibrate({far});
  const json whole = answer();
  (void)calibrate({far, "--overwrite", "--set", "calibration.iterations=1"});
  EXPECT_NE(answer(), whole);
  (void)calibrate({far, "--resume"});
  EXPECT_EQ(answer(), whole);
}

TEST_F(Calibrate, IsTheSameForAnyNumberOfThreads) {
  (void)calibrate({"--threads=1"});
  const json one = answer();
  (void)calibrate({"--threads=3", "--overwrite"});
  EXPECT_EQ(answer(), one);
}

TEST_F(Calibrate, ReadsListsFromAFile) {
  std::ofstream(folder_ / "c.toml") << "[calibration]\nfree = [\"isostasy.swell_m\"]\nseeds = [4]\n"
                                       "priors = [\"isostasy.swell_m = 400 +- 100\"]\n";
  const Outcome outcome =
      terrane({"calibrate", (folder_ / "c.toml").string(), "--target", "earth-statistical", "-o",
               out_.string(), "--set", "calibration.grid=64x32", "--set",
               "calibration.held_out=", "--set", "calibration.held_out_grid=", "--set",
               "calibration.iterations=1", "--set", "erosion.steps=1"});
  ASSERT_TRUE(outcome.code == 0 || outcome.code == 5) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("isostasy.swell_m = "));
}

TEST_F(Calibrate, SaysThatATargetIsOutOfReachAndKeepsTheBest) {
  std::ofstream(folder_ / "far.csv") << "quantile,elevation_m\n0.1,20000\n0.5,30000\n0.9,50000\n";
  const Outcome outcome = calibrate({}, (folder_ / "far.csv").string());
  EXPECT_EQ(outcome.code, 5);
  EXPECT_THAT(lines_of(outcome.err).back(), HasSubstr("out of reach"));
  EXPECT_TRUE(fs::exists(out_ / "fitted.toml"));
}

TEST_F(Calibrate, TakesTheLargestSeedThereIs) {
  const Outcome outcome =
      calibrate({"--set=calibration.seeds=9223372036854775807",
                 "--set=calibration.held_out=9223372036854775805-9223372036854775806"});
  ASSERT_TRUE(outcome.code == 0 || outcome.code == 5) << outcome.err;
  const json all = json::parse(text_of(out_ / "calibration.json"));
  EXPECT_EQ(all["misfit"]["fitted"]["seeds"][0]["seed"], 9223372036854775807);
  EXPECT_EQ(all["misfit"]["held_out"]["seeds"].size(), 2U);
}

TEST_F(Calibrate, ComparesAPartOfTheCurveThereAlone) {
  std::ofstream(folder_ / "part.csv")
      << "quantile,elevation_m\n0.2,-5000\n0.3,-4700\n0.4,-4300\n0.5,-3900\n0.6,-3300\n";
  (void)calibrate({}, (folder_ / "part.csv").string());
  const json all = json::parse(text_of(out_ / "calibration.json"));
  EXPECT_EQ(all["hypsometry"]["share_from"], 0.2);
  EXPECT_EQ(all["hypsometry"]["share_to"], 0.6);
  EXPECT_EQ(all["residuals"].size(), 5U);
  const auto rows = lines_of(text_of(out_ / "hypsometry.csv"));
  ASSERT_EQ(rows.size(), 101U);
  EXPECT_THAT(rows[1], testing::StartsWith("0.202,"));
  EXPECT_THAT(rows[100], testing::StartsWith("0.598,"));
}

TEST_F(Calibrate, SaysThatHeldOutPlanetsBecameAlike) {
  // Belts that no Earth has: what tells these planets apart goes with the fit.
  const Outcome outcome =
      calibrate({"--set=isostasy.collision_km=70", "--set=calibration.free=isostasy.collision_km",
                 "--set=calibration.held_out=3-5", "--set=calibration.iterations=8"});
  const json held_out = json::parse(text_of(out_ / "calibration.json"))["misfit"]["held_out"];
  EXPECT_EQ(held_out["collapsed"], true) << held_out.dump();
  EXPECT_THAT(outcome.err, HasSubstr("held-out planets have become alike"));
  EXPECT_THAT(text_of(out_ / "report.html"), HasSubstr("have become alike"));
}

TEST_F(Calibrate, RefusesATableThatFallsWithItsLine) {
  std::ofstream(folder_ / "falls.csv") << "quantile,elevation_m\n0.1,-5000\n0.5,100\n0.9,50\n";
  expect_refusal({}, 3, {"falls.csv:4: elevations must not fall"},
                 (folder_ / "falls.csv").string());
  std::ofstream(folder_ / "back.csv") << "quantile,elevation_m\n0.1,-5000\n0.5,100\n0.4,500\n";
  expect_refusal({}, 3, {"back.csv:4: quantiles must ascend"}, (folder_ / "back.csv").string());
}

TEST_F(Calibrate, RefusesWhatCannotBeFitted) {
  expect_refusal({"--set=calibration.free=plates.count"}, 2, {"plates.count", "must be"});
  expect_refusal({"--set=calibration.free=isostasy.swel_m"}, 2, {"did you mean isostasy.swell_m"});
  expect_refusal({"--set=calibration.free=erosion.flow_exponent"}, 2, {"do not change with it"});
  expect_refusal({"--set=calibration.free=isostasy.fracture_m"}, 2, {"do not change with it"});
  expect_refusal({"--set=calibration.free=planet.radius_km"}, 2, {"leaves the plates as they are"});
  expect_refusal({"--set=calibration.free="}, 2, {"must name a parameter"});
  expect_refusal({"--set=calibration.seeds=9223372036854775808"}, 2, {"whole numbers from 0 on"});
  expect_refusal({"--set=calibration.held_out=5-9223372036854775807"}, 2,
                 {"whole numbers from 0 on"});
  expect_refusal({"--set=erosion.hypsometry=rank"}, 2, {"must be none"});
  expect_refusal({"--preset=tectonica"}, 2, {"must be margins"});
  expect_refusal({"--set=calibration.held_out=2"}, 2, {"must not be one of calibration.seeds"});
  expect_refusal({"--set=calibration.priors=isostasy.swell_m = 1 +- 1"}, 2, {"calibration.free"});
  expect_refusal({"--set=calibration.terms=height = 1 +- 1"}, 2, {"land_fraction"});
  expect_refusal({"--set=calibration.bounds=isostasy.margin_tilt_m = 2000 .. 3000"}, 2,
                 {"its start"});
  expect_refusal({"--resume"}, 2, {"no calibration to go on with"});
  expect_refusal({}, 3, {"no such file"}, "mars");
  EXPECT_EQ(terrane({"calibrate", "-o", out_.string()}).code, 2);
}

TEST_F(Calibrate, OfAnotherBuildGoesOnOnlyByAWordThatIsKept) {
  (void)calibrate({});
  fs::remove(out_ / "calibration.json");
  const auto state_file = out_ / "calibration.state.json";
  const json state = json::parse(text_of(state_file));
  for (const std::string key : {"version", "commit", "build"}) {
    SCOPED_TRACE(key);
    auto other = state;
    other["written_by"][0][key] = "0.0.1";
    std::ofstream(state_file) << other.dump();
    expect_refusal({"--resume"}, 2, {"was made by terrane ", "0.0.1", "--allow-other-build"});
  }
  EXPECT_THAT(calibrate({"--resume", "--allow-other-build"}).code, testing::AnyOf(0, 5));
  const auto found = json::parse(text_of(out_ / "calibration.json"));
  ASSERT_EQ(found.at("written_by").size(), 2U);
  EXPECT_EQ(found.at("written_by")[0].at("build"), "0.0.1");
  EXPECT_EQ(found.at("written_by")[1], state.at("written_by")[0]);
}

TEST_F(Calibrate, DoesNotTouchAnEarlierOne) {
  (void)calibrate({});
  const auto before = contents_of(out_);
  EXPECT_EQ(calibrate({}).code, 2);
  EXPECT_EQ(calibrate({"--resume", "--set", "isostasy.swell_m=100"}).code, 2);
  EXPECT_TRUE(contents_of(out_) == before);
}

}  // namespace
}  // namespace geo
