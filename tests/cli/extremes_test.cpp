// Planets at the ends of what is allowed, through all stages: no crash, no missing values, budgets
// that close, and no cost that the cells do not ask for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli/program.hpp"
#include "cli/relief_file.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;

class Extremes : public testing::Test {
 protected:
  /// Runs to the end and looks at everything that was computed; processor seconds.
  double expect_sound(const std::vector<std::string>& more, const std::string& threads = "2") {
    SCOPED_TRACE(testing::PrintToString(more));
    const fs::path out = folder_ / std::to_string(++runs_);
    std::vector<std::string> arguments{"run",
                                       "-o",
                                       out.string(),
                                       "--no-vtk",
                                       "--no-maps",
                                       "--set",
                                       "climate.resolution_deg=10",
                                       "--threads",
                                       threads};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = terrane(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    if (outcome.code == 0) expect_sound_files(out);
    return outcome.processor_s;
  }
  static void expect_sound_files(const fs::path& out) {
    int fields = 0;
    const auto manifest = manifest_of(out);
    ASSERT_TRUE(manifest.at("complete").get<bool>());
    for (const auto& stage : manifest.at("stages")) {
      for (const auto& [name, field] : stage.at("fields").items()) {
        EXPECT_EQ(field.at("missing"), 0) << stage.at("name") << ", " << name;
        EXPECT_TRUE(std::isfinite(field.at("mean").get<double>())) << name;
        ++fields;
      }
      if (!stage.contains("budget")) continue;
      for (const auto& [name, value] : stage.at("budget").items()) {
        ASSERT_TRUE(value.is_number()) << name;
        // Fields of rain hold single precision; all other budgets are of sums in double.
        const double closed = name == "air_water_closing_error" ? 1e-6 : 1e-9;
        if (name.ends_with("_error")) EXPECT_NEAR(value.get<double>(), 0.0, closed) << name;
      }
    }
    EXPECT_GT(fields, 25);
  }
  /// The same of a relief that is given, through the stages after isostasy.
  void expect_sound_on(const ReliefFile& relief, std::vector<std::string> more = {}) {
    const fs::path file = folder_ / "relief.nc";
    relief.write(file);
    more.insert(more.end(), {"--dem", file.string(), "--to", "biomes"});
    expect_sound(more);
  }
  static std::vector<std::string> small(std::vector<std::string> more) {
    more.insert(more.end(), {"--grid", "32x16", "--to", "biomes"});
    return more;
  }

  TemporaryFolder folder_;

 private:
  int runs_ = 0;
};

TEST_F(Extremes, NoOceanAndNothingElse) {
  for (const std::string share : {"0", "1"}) {
    expect_sound(small({"--set", "planet.ocean_fraction=" + share}));
  }
  for (const std::string volume_km3 : {"1", "1e12"}) {
    expect_sound(small(
        {"--set", "planet.sea_level=volume", "--set", "planet.water_volume_km3=" + volume_km3}));
  }
}

TEST_F(Extremes, OnePlateFewAndMany) {
  for (const std::string count : {"1", "2", "100"}) {
    expect_sound(small({"--set", "plates.count=" + count}));
  }
}

TEST_F(Extremes, SmallPlanetsAndLargeOnes) {
  for (const std::string radius_km : {"1", "500", "50000", "1e6"}) {
    expect_sound(small({"--set", "planet.radius_km=" + radius_km}));
  }
}

TEST_F(Extremes, GridsOfFewCells) {
  const auto cost_s = [&](const std::string& grid) {
    return expect_sound({"--grid", grid, "--to", "biomes"}, "1");
  };
  const double usual_s = cost_s("64x32");
  // They cost 0.9 to 1.05 of that: plates grow on a mesh of their own. Time of the processor by
  // itself varies by some 20 %.
  for (const std::string grid : {"4x3", "6x3", "512x3", "4x256"}) {
    EXPECT_LT(cost_s(grid), 1.6 * usual_s) << grid;
  }
}

TEST_F(Extremes, FlatReliefAndNothingButPits) {
  for (const double flat_m : {-3000.0, 0.0, 3000.0}) {
    expect_sound_on({.height_m = [=](double, double) { return flat_m; }});
  }
  // Every other cell is a pit; every pit stands alone, above the sea or below it.
  for (const double base_m : {500.0, -500.0, 0.0}) {
    expect_sound_on({.height_m = [=](double latitude_deg, double longitude_deg) {
      const int row = static_cast<int>(std::floor(latitude_deg / 5.0)),
                column = static_cast<int>(std::floor(longitude_deg / 5.0));
      return base_m - (row % 2 == 0 && column % 2 == 0 ? 100.0 : 0.0);
    }});
  }
}

}  // namespace
}  // namespace geo
