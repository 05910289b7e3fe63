// Tiles whose opposite sides meet, from the command line.
#include <gtest/gtest.h>
#include <netcdf.h>

#include "cli/program.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class Torus : public testing::Test {
 protected:
  Outcome run(const Words& more) {
    Words arguments{"run",
                    "--topology",
                    "torus",
                    "-o",
                    out_.string(),
                    "--no-vtk",
                    "--quiet",
                    "--set",
                    "plates.raster.map_columns=64",
                    "--set",
                    "plates.raster.map_rows=64",
                    "--set",
                    "plates.raster.cycle_steps=60",
                    "--set",
                    "erosion.steps=5",
                    "--set",
                    "climate.resolution_deg=10"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return terrane(arguments);
  }

  TemporaryFolder folder_;
  const fs::path out_ = folder_ / "out";
};

TEST_F(Torus, RunsFromPlatesToBiomesWithFilesAndPictures) {
  const Outcome outcome = run({"--grid", "64x64", "--set", "output.map_width_px=400"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(stages_of(out_),
            (Words{"plates", "isostasy", "erosion", "climate", "hydrology", "biomes"}));
  EXPECT_TRUE(fs::exists(out_ / "maps" / "elevation.png"));
  int id = 0, x = -1;
  ASSERT_EQ(nc_open((out_ / "05-hydrology.nc").c_str(), NC_NOWRITE, &id), NC_NOERR);
  char units[8] = {};
  EXPECT_EQ(nc_inq_varid(id, "x", &x), NC_NOERR);
  EXPECT_EQ(nc_get_att_text(id, x, "units", units), NC_NOERR);
  EXPECT_EQ(std::string(units), "m");
  nc_close(id);
}

TEST_F(Torus, GoesOnWhereItStopped) {
  ASSERT_EQ(run({"--grid", "64x64", "--to", "erosion", "--no-maps"}).code, 0);
  const Outcome outcome = terrane({"run", "--resume", "-o", out_.string(), "--to", "biomes",
                                   "--no-maps", "--no-vtk", "--quiet"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(stages_of(out_).size(), 6U);
}

TEST_F(Torus, SaysInOneLineWhatATorusHasNot) {
  struct Wrong {
    Words more;
    const char* told;
  };
  const Wrong wrongs[] = {
      {{"--set", "plates.model=growth"}, "plates.model must be raster"},
      {{"--set", "isostasy.crust=margins"}, "isostasy.crust must be simulated"},
      {{"--to", "island"}, "a torus is none"},
      {{"--grid", "64x32"}, "plates.raster.map_rows = 64"},
      {{"--set", "plates.raster.plate_speed=1,fast"}, "plate_speed: entry 1 is \"fast\""},
      {{"--dem", "relief.nc"}, "run.topology = torus"},
  };
  for (const Wrong& wrong : wrongs) {
    const Outcome outcome = run(wrong.more);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(wrong.told), std::string::npos) << outcome.err;
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
    EXPECT_FALSE(fs::exists(out_)) << "a folder was begun";
    fs::remove_all(out_);
  }
}

}  // namespace
}  // namespace geo
