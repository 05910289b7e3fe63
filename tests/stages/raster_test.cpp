// Planets and tiles of plates that are height maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>

#include "geo/core/error.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/isostasy/isostasy.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {
namespace {

PlatesParameters quick() {
  PlatesParameters p;
  p.model = "raster";
  p.samples = 12000;
  p.raster.columns = p.raster.rows = 128;
  p.raster.cycle_steps = 150;
  return p;
}

State laid(Grid grid, std::uint64_t seed, const PlatesParameters& parameters,
           Budget* budget = nullptr) {
  State state(std::make_shared<Grid>(std::move(grid)));
  const auto stage = make_plates_stage(parameters);
  StageIo io(state, stage->info());
  Context context;
  context.seed = seed;
  stage->run(io, context);
  if (budget != nullptr) *budget = context.budget;
  return state;
}

void expect_sound(const State& state) {
  const auto stage = make_plates_stage(quick());
  for (const FieldSpec* spec : stage->info().writes) {
    ASSERT_TRUE(state.has(*spec)) << spec->name;
    std::visit(
        [&](const auto& values) {
          for (const auto value : values) {
            ASSERT_TRUE(std::isfinite(static_cast<double>(value))) << spec->name;
          }
        },
        *state.values(*spec));
  }
  const auto type = state.read(field::boundary_type);
  const std::set<int> types(type.begin(), type.end());
  EXPECT_TRUE(types.contains(static_cast<int>(BoundaryType::interior)));
  EXPECT_TRUE(types.contains(static_cast<int>(BoundaryType::convergent)));
  EXPECT_TRUE(types.contains(static_cast<int>(BoundaryType::divergent)));
  const auto fraction = state.read(field::continental_fraction);
  for (const float f : fraction) {
    ASSERT_GE(f, 0.0F);
    ASSERT_LE(f, 1.0F);
  }
}

TEST(RasterPlanet, WritesAllThatItDeclaresAndItIsFinite) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    expect_sound(laid(Grid::sphere(144, 72), seed, quick()));
  }
}

TEST(RasterPlanet, ClosesItsBooks) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    Budget budget;
    laid(Grid::sphere(72, 36), seed, quick(), &budget);
    EXPECT_LT(std::abs(budget.at("raster_crust_closing_error")), 1e-12);
    EXPECT_GT(budget.at("raster_crust_created"), 0.0);
  }
}

TEST(RasterPlanet, HasTheWantedOceanAndLandAtItsHeight) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const State state = laid(Grid::sphere(192, 96), seed, quick());
    const Grid& grid = state.grid();
    const auto z = state.read(field::crust_elevation);
    double sea = 0.0;
    for (Index cell = 0; cell < grid.size(); ++cell) {
      if (z[cell] < 0.0F) sea += grid.area_m2(grid.row(cell));
    }
    EXPECT_NEAR(sea / grid.total_area_m2(), 0.71, 0.04) << "seed " << seed;
  }
}

/// Mean step between neighbours along a meridian line, against the mean of all others.
double seam(const State& state, int column) {
  const Grid& grid = state.grid();
  const auto z = state.has(field::elevation) ? state.read(field::elevation)
                                             : state.read(field::crust_elevation);
  const auto step = [&](int i) {
    double sum = 0.0;
    for (int j = 0; j < grid.ny(); ++j) {
      sum += std::abs(z[grid.cell(i, j)] - z[grid.cell((i + grid.nx() - 1) % grid.nx(), j)]);
    }
    return sum;
  };
  double all = 0.0;
  for (int i = 0; i < grid.nx(); ++i) all += step(i) / grid.nx();
  return step(column) / all;
}

TEST(RasterPlanet, HasNoSeamAtTheDateLine) {
  double mean = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    mean += seam(laid(Grid::sphere(256, 128), seed, quick()), 0) / 6.0;
  }
  EXPECT_LT(mean, 1.5);
}

TEST(RasterPlanet, IsNotDrawnTogetherAtThePoles) {
  // Along the parallel at 85 degrees a lattice of pinched cells would differ from cell to cell.
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const State state = laid(Grid::sphere(360, 180), seed, quick());
    const Grid& grid = state.grid();
    const auto z = state.read(field::crust_elevation);
    const auto rough = [&](int j) {
      double sum = 0.0;
      for (int i = 0; i < grid.nx(); ++i) {
        sum += std::abs(z[grid.cell(i, j)] - z[grid.cell((i + 1) % grid.nx(), j)]);
      }
      return sum / grid.nx();
    };
    double middle = 0.0;
    for (int j = 60; j < 120; ++j) middle += rough(j) / 60.0;
    EXPECT_LT(rough(175), middle) << "seed " << seed;
    EXPECT_LT(rough(4), middle) << "seed " << seed;
  }
}

TEST(RasterPlanet, MovesItsPlatesAsRigidBodies) {
  const State state = laid(Grid::sphere(144, 72), 5, quick());
  const Grid& grid = state.grid();
  const auto plate = state.read(field::plate_id);
  const auto east = state.read(field::plate_velocity_east);
  const auto north = state.read(field::plate_velocity_north);
  // A rotation keeps lengths: the relative velocity of two places has no part along their line.
  const auto vector = [&](Index cell) {
    const Vector3 up = grid.to_axis(grid.unit_vector(grid.column(cell), grid.row(cell)));
    const Vector3 to_east = normalised(Vector3{-up[1], up[0], 0.0});
    return add(scaled(to_east, east[cell]), cross(up, to_east), north[cell]);
  };
  int checked = 0;
  for (Index a = 500; a < grid.size(); a += 37) {
    const Index b = (a * 7) % grid.size();
    if (plate[a] != plate[b] || a == b) continue;
    const Vector3 at = grid.to_axis(grid.unit_vector(grid.column(a), grid.row(a)));
    const Vector3 other = grid.to_axis(grid.unit_vector(grid.column(b), grid.row(b)));
    const Vector3 way = normalised(add(at, other, -1.0));
    EXPECT_NEAR(dot(add(vector(a), vector(b), -1.0), way), 0.0, 0.05);
    ++checked;
  }
  EXPECT_GT(checked, 10);
}

TEST(RasterPlanet, CarriesIsostasy) {
  State state = laid(Grid::sphere(128, 64), 3, quick());
  IsostasyParameters parameters;
  parameters.crust = "simulated";
  const auto stage = make_isostasy_stage(parameters);
  StageIo io(state, stage->info());
  Context context;
  context.seed = 3;
  stage->run(io, context);
  const auto z = state.read(field::elevation);
  EXPECT_GT(*std::max_element(z.begin(), z.end()), 1000.0F);
  EXPECT_LT(*std::min_element(z.begin(), z.end()), -3000.0F);
}

void run(const Stage& stage, State& state, std::uint64_t seed) {
  StageIo io(state, stage.info());
  Context context;
  context.seed = seed;
  stage.run(io, context);
}

/// As the preset has it.
void settle(State& state, std::uint64_t seed) {
  IsostasyParameters parameters;
  parameters.crust = "simulated";
  parameters.margin_tilt_m = 250.0;
  parameters.shelf_edge = 0.84;
  parameters.ocean_depth_m = 0.0;
  run(*make_isostasy_stage(parameters), state, seed);
}

TEST(RasterPlanet, HasAFloorAsDeepAsItIsOld) {
  // Median depths of the Earth's floor by age (ETOPO and Mueller 2008), sediment and all.
  struct Age {
    float low_myr, high_myr, median_m;
  };
  constexpr Age kEarth[]{{10.0F, 20.0F, -3781.0F},
                         {20.0F, 40.0F, -4270.0F},
                         {40.0F, 60.0F, -4670.0F},
                         {60.0F, 80.0F, -4902.0F},
                         {80.0F, 110.0F, -4949.0F}};
  std::array<std::vector<float>, std::size(kEarth)> depths;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    State state = laid(Grid::sphere(192, 96), seed, quick());
    settle(state, seed);
    const auto age = state.read(field::crust_age);
    const auto share = state.read(field::continental_fraction);
    const auto z = state.read(field::elevation);
    for (Index c = 0; c < state.grid().size(); ++c) {
      if (share[c] > 0.01F || z[c] >= 0.0F) continue;
      for (std::size_t k = 0; k < depths.size(); ++k) {
        if (age[c] >= kEarth[k].low_myr && age[c] < kEarth[k].high_myr) depths[k].push_back(z[c]);
      }
    }
  }
  for (std::size_t k = 0; k < depths.size(); ++k) {
    ASSERT_GT(depths[k].size(), 300U) << kEarth[k].low_myr;
    const auto middle = depths[k].begin() + static_cast<std::ptrdiff_t>(depths[k].size() / 2);
    std::nth_element(depths[k].begin(), middle, depths[k].end());
    // Half of what separates the tenth from the ninetieth percentile of the Earth's is some 900 m;
    // medians of both agree within a third of that.
    EXPECT_NEAR(*middle, kEarth[k].median_m, 300.0F) << kEarth[k].low_myr << " Myr";
  }
}

TEST(RasterPlanet, KeepsItsSeaWhereTheFloorsDepthCountsFrom) {
  State state = laid(Grid::sphere(192, 96), 3, quick());
  IsostasyParameters parameters;
  parameters.crust = "simulated";
  parameters.ocean_depth_m = 0.0;
  const auto stage = make_isostasy_stage(parameters);
  StageIo io(state, stage->info());
  Context context;
  context.seed = 3;
  stage->run(io, context);
  EXPECT_NEAR(context.budget.at("sea_level_shift_m"), 0.0, 2.0);
}

/// Length of plate boundaries over area, in six belts of equal area from the equator to the poles,
/// over the mean of all.
std::array<double, 6> boundaries_by_belt(const State& state) {
  const Grid& grid = state.grid();
  const auto plate = state.read(field::plate_id);
  std::array<double, 6> length{}, area{};
  for (int j = 0; j < grid.ny(); ++j) {
    const double z = std::abs(std::sin(grid.latitude_deg(j) * 3.141592653589793 / 180.0));
    const auto belt = static_cast<std::size_t>(std::min(5.0, std::floor(6.0 * z)));
    for (int i = 0; i < grid.nx(); ++i) {
      const Index cell = grid.cell(i, j);
      area[belt] += grid.area_m2(j);
      if (plate[cell] != plate[grid.neighbour(i, j, kEast)]) length[belt] += grid.face_east_m(j);
      if (j + 1 < grid.ny() && plate[cell] != plate[grid.neighbour(i, j, kNorth)]) {
        length[belt] += grid.face_north_m(j);
      }
    }
  }
  double all = 0.0, everywhere = 0.0;
  for (std::size_t k = 0; k < 6; ++k) {
    all += length[k];
    everywhere += area[k];
  }
  for (std::size_t k = 0; k < 6; ++k) length[k] *= everywhere / (area[k] * all);
  return length;
}

TEST(RasterPlanet, PlateBoundariesHaveNoLatitude) {
  constexpr int kSeeds = 12;
  std::vector<std::array<double, 6>> found;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    PlatesParameters p = quick();
    p.raster.columns = p.raster.rows = 96;
    found.push_back(boundaries_by_belt(laid(Grid::sphere(144, 72), seed, p)));
  }
  for (std::size_t belt = 0; belt < 6; ++belt) {
    double sum = 0.0, square = 0.0;
    for (const auto& one : found) {
      sum += one[belt];
      square += one[belt] * one[belt];
    }
    const double mean = sum / kSeeds;
    const double error = std::sqrt((square / kSeeds - mean * mean) / (kSeeds - 1));
    EXPECT_NEAR(mean, 1.0, 3.5 * error) << "belt " << belt << ": by chance once in 2000 belts";
    EXPECT_LT(error, 0.2) << "too few seeds to tell";
  }
}

TEST(RasterPlanet, HasTheSameContinentsOnAFinerGrid) {
  const State coarse = laid(Grid::sphere(96, 48), 4, quick()),
              fine = laid(Grid::sphere(288, 144), 4, quick());
  int same = 0;
  for (Index c = 0; c < coarse.grid().size(); ++c) {
    const Index middle =
        fine.grid().cell(3 * coarse.grid().column(c) + 1, 3 * coarse.grid().row(c) + 1);
    same += (coarse.read(field::crust_elevation)[c] >= 0.0F) ==
            (fine.read(field::crust_elevation)[middle] >= 0.0F);
  }
  EXPECT_GT(same, 0.98 * coarse.grid().size());
}

TEST(RasterTile, CarriesIsostasyAndRiversWithoutASeam) {
  State state = laid(Grid::torus(96, 96, 400e3, 400e3), 3, quick());
  settle(state, 3);
  run(*make_erosion_stage(), state, 3);
  EXPECT_LT(seam(state, 0), 2.0);
  const Grid& grid = state.grid();
  const auto z = state.read(field::elevation);
  const auto receiver = state.read(field::flow_receiver);
  const auto sea = std::count_if(z.begin(), z.end(), [](float value) { return value < 0.0F; });
  EXPECT_NEAR(static_cast<double>(sea) / grid.size(), 0.71, 0.01);
  // Rivers run on over the sides.
  int across = 0;
  for (Index c = 0; c < grid.size(); ++c) {
    ASSERT_GE(receiver[c], 0);
    across += std::abs(grid.column(receiver[c]) - grid.column(c)) > 1 ||
              std::abs(grid.row(receiver[c]) - grid.row(c)) > 1;
  }
  EXPECT_GT(across, 0);
}

TEST(RasterTile, IsNotStretched) {
  EXPECT_THROW(laid(Grid::torus(128, 64, 80e3, 80e3), 4, quick()), ConfigurationError);
}

/// Mean over seeds of the steps at a column, against the mean of all columns.
double mean_seam(int column) {
  constexpr int kSeeds = 12;
  double mean = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    mean += seam(laid(Grid::torus(128, 128, 80e3, 80e3), seed, quick()), column) / kSeeds;
  }
  return mean;
}

TEST(RasterTile, HasNoSeamWhereItsSidesMeet) {
  // One world has a coast there and another has not: as far from 1 as for planets' date line.
  EXPECT_LT(mean_seam(0), 1.5);
}

TEST(RasterTile, WritesAllThatItDeclares) {
  const State state = laid(Grid::torus(128, 128, 80e3, 80e3), 4, quick());
  expect_sound(state);
  const auto z = state.read(field::crust_elevation);
  const auto sea = std::count_if(z.begin(), z.end(), [](float value) { return value < 0.0F; });
  EXPECT_NEAR(static_cast<double>(sea) / static_cast<double>(z.size()), 0.71, 0.03);
}

TEST(RasterPlanet, SaysWhichOfThePlatesOwnSettingsIsWrong) {
  PlatesParameters p = quick();
  p.raster.plate_folding = "0.02, 7";
  try {
    laid(Grid::sphere(72, 36), 1, p);
    FAIL() << "accepted a folding ratio of 7";
  } catch (const ConfigurationError& error) {
    EXPECT_NE(std::string(error.what()).find("plates.raster.plate_folding"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("entry 1"), std::string::npos);
  }
  EXPECT_THROW(laid(Grid::plane(64, 64, 1e4, 1e4), 1, quick()), InputError);
}

}  // namespace
}  // namespace geo
