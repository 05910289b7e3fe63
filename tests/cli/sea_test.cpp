// The sea of a planet is one through all stages, also where a table of heights says where it is.
#include <gtest/gtest.h>
#include <netcdf.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "cli/program.hpp"
#include "cli/sample_run.hpp"
#include "geo/core/grid.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;
constexpr int kColumns = 96, kRows = 48;

/// Mars, roughly: lowest and highest ground -8.2 and 21.2 km, plains in the north about -4 km,
/// highlands in the south about 1.5 km (Smith et al. 1999, Science 284). 44.3 % lie below 0.
constexpr const char* kMars =
    "quantile,elevation_m\n0,-8200\n0.02,-6100\n0.06,-5000\n0.16,-4300\n0.26,-3800\n"
    "0.33,-2900\n0.38,-1500\n0.43,-300\n0.48,800\n0.6,1300\n0.75,1900\n0.88,2700\n0.96,4200\n"
    "0.99,7800\n1,21200\n";
constexpr double kBelowDatum = 0.43 + 0.05 * 300.0 / 1100.0;

/// The same above its lowest ground.
constexpr const char* kDryMars =
    "quantile,elevation_m\n0,150\n0.26,4400\n0.33,5300\n0.43,7900\n0.6,9500\n0.88,10900\n"
    "0.99,16000\n1,29400\n";

std::vector<float> values_of(const fs::path& file, const char* name) {
  std::vector<float> values(static_cast<std::size_t>(kColumns) * kRows);
  int id = 0, variable = 0;
  EXPECT_EQ(nc_open(file.c_str(), NC_NOWRITE, &id), NC_NOERR) << file;
  EXPECT_EQ(nc_inq_varid(id, name, &variable), NC_NOERR) << file << " " << name;
  EXPECT_EQ(nc_get_var_float(id, variable, values.data()), NC_NOERR) << file << " " << name;
  nc_close(id);
  return values;
}

double share_of_sea(const std::vector<float>& elevation_m) {
  const Grid grid = Grid::sphere(kColumns, kRows);
  double sea = 0.0;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (elevation_m[cell] < 0.0F) sea += grid.area_m2(grid.row(cell));
  }
  return sea / grid.total_area_m2();
}

class Sea : public testing::Test {
 protected:
  /// Runs to biomes with a table of heights; says the sea of each relief on the way.
  std::vector<double> seas(const char* table, const Words& more) {
    std::ofstream(folder_ / "heights.csv") << table;
    Words arguments{"run",         "--preset",
                    "hypsography", "-o",
                    out_.string(), "--to",
                    "biomes",      "--grid",
                    "96x48",       "--no-maps",
                    "--no-vtk",    "--quiet",
                    "--set",       "erosion.steps=8",
                    "--set",       "climate.resolution_deg=10",
                    "--set",       "fields.hypsography=" + (folder_ / "heights.csv").string()};
    for (const std::string& setting : more) arguments.insert(arguments.end(), {"--set", setting});
    const Outcome outcome = terrane(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    if (outcome.code != 0) return {};
    return {share_of_sea(values_of(out_ / "02-isostasy.nc", "elevation")),
            share_of_sea(values_of(out_ / "03-erosion.nc", "elevation")),
            share_of_sea(values_of(out_ / "05-hydrology.nc", "elevation"))};
  }
  void expect_seas(const std::vector<double>& found, double wanted) {
    // The largest cell, at the equator; shores run through cells.
    const double cell = 1.5708 / (static_cast<double>(kColumns) * kRows);
    ASSERT_EQ(found.size(), 3U);
    for (const double share : found) EXPECT_NEAR(share, wanted, cell);
  }

  TemporaryFolder folder_;
  const fs::path out_ = folder_ / "out";
};

TEST_F(Sea, OfATableIsThatOfAllStages) {
  expect_seas(seas(kMars, {"fields.hypsography_ocean=curve"}), kBelowDatum);
}

TEST_F(Sea, OfATableIsThatOfAllStagesWhereWaterIsAVolume) {
  expect_seas(seas(kMars, {"fields.hypsography_ocean=curve", "planet.sea_level=volume"}),
              kBelowDatum);
}

TEST_F(Sea, OfThePlanetIsThatOfAllStages) { expect_seas(seas(kMars, {}), 0.71); }

TEST_F(Sea, OfThePlanetIsThatOfAllStagesWhereTheTableHasNone) {
  expect_seas(seas(kDryMars, {"planet.ocean_fraction=0.3"}), 0.3);
}

TEST_F(Sea, OfAVolumeFillsTheSameBasinsInAllStages) {
  const auto found = seas(kMars, {"planet.sea_level=volume", "planet.water_volume_km3=2e8"});
  ASSERT_EQ(found.size(), 3U);
  EXPECT_GT(found.front(), 0.1);
  expect_seas(found, found.front());
}

TEST_F(Sea, IsNotWhereATableHasNone) {
  for (const Words& more : {Words{"fields.hypsography_ocean=curve"},
                            Words{"fields.hypsography_ocean=curve", "erosion.hypsometry=none"},
                            Words{"planet.ocean_fraction=0"}}) {
    expect_seas(seas(kDryMars, more), 0.0);
    // Life and weather go on without a sea: all that is land has a biome, and numbers are numbers.
    for (const char* name : {"temperature", "precipitation"}) {
      const auto values = values_of(out_ / "04-climate.nc", name);
      EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](float value) {
        return std::isfinite(value);
      })) << name;
    }
    const auto biome = values_of(out_ / "06-biomes.nc", "biome");
    EXPECT_TRUE(std::none_of(biome.begin(), biome.end(), [](float id) { return id == 0.0F; }));
    const auto heights = values_of(out_ / "03-erosion.nc", "elevation");
    EXPECT_GT(*std::min_element(heights.begin(), heights.end()), 100.0F) << "the table's datum";
    fs::remove_all(out_);
  }
}

}  // namespace
}  // namespace geo
