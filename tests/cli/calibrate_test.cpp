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

TEST_F(Calibrate, RefusesWhatCannotBeFitted) {
  expect_refusal({"--set=calibration.free=plates.count"}, 2, {"plates.count", "must be"});
  expect_refusal({"--set=calibration.free=isostasy.swel_m"}, 2, {"did you mean isostasy.swell_m"});
  expect_refusal({"--set=calibration.free=erosion.flow_exponent"}, 2, {"do not change with it"});
  expect_refusal({"--set=calibration.free="}, 2, {"must name a parameter"});
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

TEST_F(Calibrate, DoesNotTouchAnEarlierOne) {
  (void)calibrate({});
  const auto before = contents_of(out_);
  EXPECT_EQ(calibrate({}).code, 2);
  EXPECT_EQ(calibrate({"--resume", "--set", "isostasy.swell_m=100"}).code, 2);
  EXPECT_TRUE(contents_of(out_) == before);
}

}  // namespace
}  // namespace geo
