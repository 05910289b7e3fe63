// Plates of a raster of their numbers.
#include "geo/io/input/plate_raster.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geo/core/error.hpp"
#include "geo/kernels/plates/region_outline.hpp"

namespace geo::io {
namespace {

using testing::HasSubstr;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

const std::string kHeader = "plate_id,pole_latitude_deg,pole_longitude_deg,rate_deg_myr\n";

/// Numbers on a planet of 30 x 15 cells.
Dem numbers(float (*plate)(const Centre&)) {
  Grid grid = Grid::sphere(30, 15, Ellipsoid{});
  std::vector<float> values(grid.size());
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) values[grid.cell(i, j)] = plate(grid.position(i, j));
  }
  return {std::move(values), std::move(grid), "numbers.nc:plate", "plate", {}, {}};
}

/// A cap, two halves of the rest, and a hole of no plate.
float cap_and_halves(const Centre& at) {
  if (at.latitude_deg > 60.0) return 7.0F;
  if (std::abs(at.latitude_deg) < 10.0 && std::abs(at.longitude_deg) < 20.0) return kNone;
  return at.longitude_deg < 30.0 ? 2.0F : -4.0F;
}

std::string refusal(const Dem& dem, const std::string& table) {
  try {
    (void)plates_of_raster(dem, Table(table, "motions.csv"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PlateRaster, EachCellLiesInTheOutlineOfItsPlateAlone) {
  const Dem dem = numbers(cap_and_halves);
  const auto plates = plates_of_raster(
      dem, Table(kHeader + "2,10,20,0.5\n7,0,0,0.1\n-4,-30,190,-0.2\n9,1,1,1\n", "motions.csv"));
  ASSERT_EQ(plates.size(), 3U);
  EXPECT_EQ(plates[0].name, "-4");
  EXPECT_EQ(plates[1].name, "2");
  EXPECT_EQ(plates[2].name, "7");
  EXPECT_EQ(plates[0].pole.longitude_deg, 190.0);
  EXPECT_EQ(plates[0].rate_deg_myr, -0.2);
  const Grid& grid = dem.grid;
  for (const PlateOutline& plate : plates) {
    const RegionOutline outline(plate.rings);
    for (Index cell = 0; cell < grid.size(); ++cell) {
      const bool is_on = dem.elevation_m[cell] == std::stof(plate.name);
      EXPECT_EQ(outline.holds(grid.position(grid.column(cell), grid.row(cell))), is_on)
          << "plate " << plate.name << ", cell " << cell;
    }
  }
}

TEST(PlateRaster, TheLastRowOfAPlateCounts) {
  const auto plates = plates_of_raster(
      numbers(cap_and_halves),
      Table("from_myr," + kHeader + "0,2,10,20,0.5\n0,7,0,0,0.1\n0,-4,0,0,1\n2,2,11,21,0.75\n",
            "motions.csv"));
  EXPECT_EQ(plates[1].pole.latitude_deg, 11.0);
  EXPECT_EQ(plates[1].rate_deg_myr, 0.75);
}

TEST(PlateRaster, WhatIsNoPlateIsRefused) {
  const Dem dem = numbers(cap_and_halves);
  const std::string all = "2,10,20,0.5\n7,0,0,0.1\n-4,-30,190,-0.2\n";
  EXPECT_EQ(refusal(dem, kHeader + all), "accepted");
  EXPECT_THAT(refusal(dem, kHeader + "2,10,20,0.5\n7,0,0,0.1\n"),
              HasSubstr("plate -4 has no row in fields.plate_rotations"));
  EXPECT_THAT(refusal(dem, "plate_id,rate_deg_myr\n2,1\n"),
              HasSubstr("motions.csv:1: has no column pole_latitude_deg"));
  EXPECT_THAT(refusal(dem, kHeader + all + "8.5,0,0,1\n"), HasSubstr("motions.csv:5: plate_id"));
  EXPECT_THAT(refusal(dem, kHeader + all + "8,91,0,1\n"), HasSubstr("motions.csv:5: the pole"));
  EXPECT_THAT(refusal(dem, kHeader + all + "8,0,0,101\n"), HasSubstr("rate_deg_myr"));
  EXPECT_THAT(refusal(numbers([](const Centre&) { return 2.0F; }), kHeader + all),
              HasSubstr("has 1 plate:"));
  EXPECT_THAT(refusal(numbers([](const Centre&) { return 2.5F; }), kHeader + all),
              HasSubstr("2.5 is no number of a plate"));
}

}  // namespace
}  // namespace geo::io
