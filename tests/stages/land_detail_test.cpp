// Continents whose relief is made like exemplars.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "geo/kernels/exemplars/exemplar.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/stages/isostasy/isostasy.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {
namespace {

constexpr double kLongest_km = 500.0;  // that cells of 78 km show

struct Land {
  State noise, exemplars;
};

Land land_of(const std::string& model, const std::string& crust, std::uint64_t seed) {
  State state(std::make_shared<Grid>(Grid::sphere(512, 256)));
  static const auto kLibrary =
      std::make_shared<const ExemplarLibrary>(grow_exemplars({.cell_m = 7000.0, .ranges = 3.0}));
  const auto run = [&](const Stage& stage, State& on) {
    Context context;
    context.seed = seed;
    context.planet_exemplars = kLibrary;
    StageIo io(on, stage.info());
    stage.run(io, context);
  };
  PlatesParameters plates;
  plates.model = model;
  run(*make_plates_stage(plates), state);
  Land out{state, state};
  IsostasyParameters parameters;
  parameters.crust = crust;
  run(*make_isostasy_stage(parameters), out.noise);
  parameters.detail = "exemplars";
  parameters.detail_longest_km = kLongest_km;
  run(*make_isostasy_stage(parameters), out.exemplars);
  return out;
}

void expect_sound(const Land& land) {
  const Grid& grid = land.noise.grid();
  const auto before = land.noise.read(field::elevation);
  const auto after = land.exemplars.read(field::elevation);
  std::vector<float> change(grid.size());
  double squares = 0.0, area = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    change[c] = after[c] - before[c];
    if (before[c] < 0.0F) {
      EXPECT_EQ(change[c], 0.0F);
      continue;
    }
    EXPECT_GE(after[c], 0.0F);
    squares += static_cast<double>(change[c]) * change[c] * grid.area_m2(grid.row(c));
    area += grid.area_m2(grid.row(c));
  }
  const double changed_m = std::sqrt(squares / area);
  EXPECT_GT(changed_m, 60.0);
  // Means over larger windows stay.
  smooth(grid, std::span<float>(change), 0.75e3 * kLongest_km);
  double left = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (before[c] < 0.0F) continue;
    left += static_cast<double>(change[c]) * change[c] * grid.area_m2(grid.row(c));
  }
  EXPECT_LT(std::sqrt(left / area), 0.15 * changed_m);
}

TEST(LandDetail, ChangesLandAloneAndKeepsItsBroadMeans) {
  expect_sound(land_of("growth", "margins", 3));
}

TEST(LandDetail, StandsOnHeightsThatPlatesGave) { expect_sound(land_of("raster", "given", 3)); }

TEST(LandDetail, IsReadByTheFoldsOnlyWhereItIsAskedFor) {
  const auto guided = [](const std::string& detail) {
    IsostasyParameters parameters;
    parameters.detail = detail;
    const auto stage = make_isostasy_stage(parameters);
    const auto& fields = stage->info().optional;
    return std::find(fields.begin(), fields.end(), &field::fold_direction_east) != fields.end();
  };
  EXPECT_FALSE(guided("noise"));
  EXPECT_TRUE(guided("exemplars"));
}

}  // namespace
}  // namespace geo
