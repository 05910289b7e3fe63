// Crust and relief of whole planets, from the plates on.
#include "geo/stages/isostasy/isostasy.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/crust/airy.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/numerics/quantiles.hpp"
#include "geo/kernels/plates/growth/convergent_margins.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {
namespace {

struct Planetary {
  State state;
  Budget budget;
};

/// Plates take longer than what is tested here: each planet's are made once.
const State& plates_of(int nx, std::uint64_t seed) {
  static std::map<std::pair<int, std::uint64_t>, State> made;
  const auto known = made.find({nx, seed});
  if (known != made.end()) return known->second;
  State state(std::make_shared<Grid>(Grid::sphere(nx, nx / 2)));
  Context context;
  context.seed = seed;
  const auto stage = make_plates_stage();
  StageIo io(state, stage->info());
  stage->run(io, context);
  return made.emplace(std::pair{nx, seed}, std::move(state)).first->second;
}

Planetary planet(int nx, std::uint64_t seed, const IsostasyParameters& parameters = {},
                 const Planet& body = {}) {
  Planetary out{plates_of(nx, seed), {}};
  Context context;
  context.seed = seed;
  context.planet = body;
  const auto stage = make_isostasy_stage(parameters);
  StageIo io(out.state, stage->info());
  stage->run(io, context);
  out.budget = context.budget;
  return out;
}

IsostasyParameters blueprint() {
  IsostasyParameters p;
  p.crust = "blueprint";
  p.compensation = "airy-dry";
  p.continental_km = 43.0;
  p.thickness_noise_km = 10.0;
  p.collision_km = 22.0;
  p.deformation_smoothing_km = 90.0;
  return p;
}

void check(const IsostasyParameters& parameters, bool plates_have_made_crust) {
  make_isostasy_stage(parameters)->check(Grid::sphere(8, 4), [&](const FieldSpec&) {
    return plates_have_made_crust;
  });
}

TEST(Isostasy, WhatFloatsIsLighterThanTheMantle) {
  check({}, false);
  for (double ColumnDensities::*heavy :
       {&ColumnDensities::continental_crust, &ColumnDensities::oceanic_crust,
        &ColumnDensities::water}) {
    IsostasyParameters parameters;
    parameters.density.*heavy = parameters.density.mantle;
    EXPECT_THROW(check(parameters, true), ConfigurationError);
  }
}

TEST(Isostasy, CrustThatNoPlatesMadeIsRefused) {
  for (const char* crust : {"simulated", "given"}) {
    IsostasyParameters parameters;
    parameters.crust = crust;
    check(parameters, true);
    EXPECT_THROW(check(parameters, false), ConfigurationError);
    EXPECT_THROW(planet(64, 1, parameters), ConfigurationError);
  }
}

TEST(Isostasy, SeaCoversItsShareOfTheArea) {
  for (const auto& parameters : {IsostasyParameters{}, blueprint()}) {
    for (const double ocean : {0.3, 0.71, 0.9}) {
      const Planetary p = planet(512, 3, parameters, {.ocean_fraction = ocean});
      const Grid& grid = p.state.grid();
      const auto z = p.state.read(field::elevation);
      // A row of cells at the equator is 1e-5 of the planet each.
      EXPECT_NEAR(fraction_below(grid, z, 0.0F), ocean, 1e-4) << parameters.crust;
    }
  }
}

double mean_depth_m(const Planetary& p) {
  const auto z = p.state.read(field::elevation);
  const Grid& grid = p.state.grid();
  const double sea = area_sum<double>(grid, [&](Index c) { return z[c] < 0.0F ? 1.0 : 0.0; });
  return area_sum<double>(grid, [&](Index c) { return z[c] < 0.0F ? -z[c] : 0.0; }) / sea;
}

TEST(Isostasy, ContinentsSettleUntilTheSeaIsAsDeepAsAsked) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const double depth_m : {3200.0, 3690.0, 4200.0}) {
      IsostasyParameters parameters;
      parameters.shelf_depth_m = 0.0;  // sediment would fill some of it
      parameters.ocean_depth_m = depth_m;
      // Where the shore moves onto other crust, the basins are others than before.
      EXPECT_NEAR(mean_depth_m(planet(256, seed, parameters)), depth_m, 40.0) << "seed " << seed;
    }
  }
}

TEST(Isostasy, ASettledContinentIsAsThickAsItsHeightAsks) {
  IsostasyParameters free, settled;
  free.ocean_depth_m = 0.0;
  const Planetary before = planet(256, 2, free), after = planet(256, 2, settled);
  const double rise_m = after.budget.at("continental_rise_m");
  ASSERT_GT(std::abs(rise_m), 10.0);
  EXPECT_FALSE(before.budget.contains("continental_rise_m"));
  const double thickening_m =
      rise_m / (1.0 - settled.density.continental_crust / settled.density.mantle);
  const auto fraction = before.state.read(field::continental_fraction);
  const auto thin = before.state.read(field::crust_thickness),
             thick = after.state.read(field::crust_thickness);
  for (Index c = 0; c < before.state.grid().size(); ++c) {
    ASSERT_NEAR(thick[c] - thin[c], thickening_m * fraction[c], 0.1);
  }
}

TEST(Isostasy, ASmallSeaSettlesNoContinents) {
  // It lies on ocean floor alone: how deep it is does not depend on continents.
  const Planetary p = planet(256, 1, {}, {.ocean_fraction = 0.4});
  EXPECT_EQ(p.budget.at("continental_rise_m"), 0.0);
}

TEST(Isostasy, QuietMarginsSlopeSteadilyFromShelfToFloor) {
  constexpr int kParts = 5;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Planetary p = planet(256, seed);
    const Grid& grid = p.state.grid();
    const auto z = p.state.read(field::elevation), f = p.state.read(field::continental_fraction),
               belt = p.state.read(field::convergent_deformation);
    std::array<double, kParts> sum{}, area{};
    for (Index c = 0; c < grid.size(); ++c) {
      if (belt[c] > 0.01F || f[c] <= 0.0F || f[c] >= 1.0F) continue;
      const int part = static_cast<int>(kParts * f[c]);
      sum[part] += grid.area_m2(grid.row(c)) * z[c];
      area[part] += grid.area_m2(grid.row(c));
    }
    for (int k = 0; k < kParts; ++k) {
      const double floor_m = sum[0] / area[0], shelf_m = sum[kParts - 1] / area[kParts - 1];
      const double even_m = floor_m + (shelf_m - floor_m) * k / (kParts - 1);
      EXPECT_NEAR(sum[k] / area[k], even_m, 600.0) << "seed " << seed << ", part " << k;
    }
  }
}

TEST(Isostasy, FieldsStayInTheirRangesOnManyPlanets) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const auto& parameters : {IsostasyParameters{}, blueprint()}) {
      SCOPED_TRACE(parameters.crust + ", seed " + std::to_string(seed));
      const Planetary p = planet(256, seed, parameters);
      const auto within = [&](const Field<float>& spec, float low, float high) {
        const auto values = p.state.read(spec);
        const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
        EXPECT_GE(*least, low) << spec.name;
        EXPECT_LE(*greatest, high) << spec.name;
        EXPECT_TRUE(
            std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }));
      };
      within(field::convergent_deformation, 0.0F, 1.0F);
      within(field::divergent_deformation, 0.0F, 1.0F);
      within(field::transform_deformation, 0.0F, 1.0F);
      within(field::lithospheric_weakness, 0.0F, 1.0F);
      within(field::continental_fraction, 0.0F, 1.0F);
      within(field::crust_thickness, 3e3F, 80e3F);
      within(field::crust_density, 2700.0F, 2900.01F);
      within(field::erodibility, 0.49e-6F, 4.51e-6F);
      within(field::elevation, -12e3F, 10e3F);
    }
  }
}

TEST(Isostasy, BlueprintCrustFollowsItsFormulas) {
  // Without the noise and the smoothing of thickness, which no output tells, equations 3.1, 3.5 and
  // 3.3 give back thickness, density and elevation, up to the sea level and the overlay 3.6: at
  // most 120 m, and the same whatever the crust below.
  IsostasyParameters settings = blueprint();
  settings.thickness_noise_km = 0.0;
  settings.crust_smoothing_km = 0.0;
  std::vector<float> first_overlay;
  for (const double oceanic_km : {7.0, 9.0}) {
    settings.oceanic_km = oceanic_km;
    const Planetary p = planet(256, 1, settings);
    const auto share = p.state.read(field::continental_fraction);
    const auto convergent = p.state.read(field::convergent_deformation);
    const auto divergent = p.state.read(field::divergent_deformation);
    const auto transform = p.state.read(field::transform_deformation);
    const auto thickness = p.state.read(field::crust_thickness);
    const auto density = p.state.read(field::crust_density);
    const auto heat = p.state.read(field::heat_anomaly);
    const auto elevation = p.state.read(field::elevation);
    const double level = p.budget.at("sea_level_shift_m");
    std::vector<float> overlay(elevation.size());
    double greatest = 0.0;
    for (Index c = 0; c < p.state.grid().size(); ++c) {
      const double s = share[c];
      const double km = (1.0 - s) * oceanic_km + s * 43.0 + convergent[c] * (13.0 + 9.0 * s) -
                        20.0 * divergent[c] + 2.0 * transform[c];
      ASSERT_NEAR(thickness[c], 1e3 * std::clamp(km, 5.0, 75.0), 0.05);
      ASSERT_NEAR(density[c], (2900.0 - 100.0 * s) * (1.0 - 0.02 * heat[c]), 0.01);
      const double airy = thickness[c] * (3300.0 - density[c]) / 3300.0;
      overlay[c] = static_cast<float>(elevation[c] + level - airy);
      greatest = std::max(greatest, std::abs(static_cast<double>(overlay[c])));
    }
    EXPECT_LT(greatest, 120.0);
    EXPECT_GT(greatest, 40.0);
    if (first_overlay.empty()) first_overlay = overlay;
    for (std::size_t c = 0; c < overlay.size(); ++c) {
      ASSERT_NEAR(overlay[c], first_overlay[c], 0.01);
    }
  }
}

TEST(Isostasy, DeformationFadesAndCratonsAreStrong) {
  const Planetary p = planet(256, 2, blueprint());
  const auto weakness = p.state.read(field::lithospheric_weakness);
  const auto type = p.state.read(field::boundary_type);
  for (Index c = 0; c < p.state.grid().size(); ++c) {
    if (type[c] != 0) {
      ASSERT_GT(weakness[c], 0.75F);
    }
  }
  EXPECT_LT(*std::min_element(weakness.begin(), weakness.end()), 0.02F);
}

TEST(Isostasy, BlueprintDeformationIsTheLargestThatReachesACell) {
  // Equations 3.2 and 3.2a from the fields themselves, by brute force over all boundary cells.
  IsostasyParameters settings = blueprint();
  settings.deformation_smoothing_km = 0.0;
  const Planetary p = planet(128, 2, settings);
  const Grid& grid = p.state.grid();
  const auto type = p.state.read(field::boundary_type);
  const auto strength = p.state.read(field::boundary_strength);
  const auto share = p.state.read(field::continental_fraction);
  const std::array deformation{p.state.read(field::convergent_deformation),
                               p.state.read(field::divergent_deformation),
                               p.state.read(field::transform_deformation)};
  const auto weakness = p.state.read(field::lithospheric_weakness);
  const auto position = [&](Index c) { return grid.unit_vector(grid.column(c), grid.row(c)); };
  std::vector<Index> boundary;
  for (Index c = 0; c < grid.size(); ++c) {
    if (type[c] != 0) boundary.push_back(c);
  }
  constexpr std::array kLength_km{200.0, 150.0, 100.0};  // convergent, divergent, transform
  for (Index c = 0; c < grid.size(); ++c) {
    std::array<double, 3> reached{};
    double nearest_km = 1e9;
    for (const Index b : boundary) {
      const double km = 6371.0 * angle_between(position(c), position(b));
      const int kind = type[b] - 1;
      reached[kind] = std::max(reached[kind], strength[b] * std::exp(-km / kLength_km[kind]));
      nearest_km = std::min(nearest_km, km);
    }
    const double weak = std::exp(-nearest_km / 300.0);
    if (share[c] > 0.1F) reached[0] *= weak;
    // Distances handed from cell to cell may be too long, by a fraction of a cell of 313 km.
    const double found_km = -300.0 * std::log(weakness[c]);
    ASSERT_GT(found_km, nearest_km - 1.0);
    ASSERT_LT(found_km, nearest_km + 45.0);
    for (int kind = 0; kind < 3; ++kind) ASSERT_NEAR(deformation[kind][c], reached[kind], 2e-3);
  }
}

TEST(Isostasy, ContinentsAreThickAndOceansDeepen) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Planetary p = planet(256, seed);
    const Grid& grid = p.state.grid();
    const auto share = p.state.read(field::continental_fraction);
    const auto thickness = p.state.read(field::crust_thickness);
    const auto age = p.state.read(field::crust_age);
    const auto z = p.state.read(field::elevation);
    std::vector<std::uint8_t> land(grid.size()), young(grid.size()), old(grid.size());
    for (Index c = 0; c < grid.size(); ++c) {
      land[c] = share[c] > 0.99F;
      young[c] = share[c] < 0.01F && age[c] < 10.0F;
      old[c] = share[c] < 0.01F && age[c] > 80.0F && age[c] < 120.0F;
    }
    EXPECT_NEAR(area_mean(grid, thickness, land), 37e3, 4e3) << "seed " << seed;
    EXPECT_GT(quantile(grid, z, 0.5, young), quantile(grid, z, 0.5, old) + 1000.0F);
  }
}

TEST(Isostasy, RatherTheSamePlanetAtAnyResolution) {
  // Means over the cells of the coarser grid.
  const Planetary low = planet(512, 3), high = planet(2048, 3);
  const Grid& grid = low.state.grid();
  const auto z = low.state.read(field::elevation), fine = high.state.read(field::elevation);
  double agree = 0.0, total = 0.0, difference = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      double mean = 0.0;
      for (int dj = 0; dj < 4; ++dj) {
        for (int di = 0; di < 4; ++di) {
          mean += fine[high.state.grid().cell(4 * i + di, 4 * j + dj)] / 16.0;
        }
      }
      const double here = z[grid.cell(i, j)];
      agree += ((mean >= 0.0) == (here >= 0.0)) * grid.area_m2(j);
      difference += std::abs(mean - here) * grid.area_m2(j);
      total += grid.area_m2(j);
    }
  }
  EXPECT_GT(agree / total, 0.95);
  EXPECT_LT(difference / total, 200.0);
}

TEST(Isostasy, PolarRowsAreAsRoughAsTheirNeighbours) {
  // Steps between cells of a row 78 km apart near the equator and a few near a pole: what
  // neighbours differ by must shrink with their distance, row by row, without a jump.
  for (const auto& parameters : {IsostasyParameters{}, blueprint()}) {
    const Planetary p = planet(512, 3, parameters);
    const Grid& grid = p.state.grid();
    for (const auto* spec : {&field::elevation, &field::crust_thickness,
                             &field::convergent_deformation, &field::lithospheric_weakness}) {
      const auto values = p.state.read(*spec);
      const auto step = [&](int j) {
        double sum = 0.0;
        for (int i = 0; i < grid.nx(); ++i) {
          const double d = values[grid.cell(i, j)] - values[grid.cell((i + 1) % grid.nx(), j)];
          sum += d * d;
        }
        return std::sqrt(sum / grid.nx());
      };
      double typical = 0.0;
      for (int j = grid.ny() / 4; j < 3 * grid.ny() / 4; ++j) {
        typical = std::max(typical, step(j) / grid.spacing_east_m(j));
      }
      for (int j : {0, 1, 2, 3, grid.ny() - 4, grid.ny() - 3, grid.ny() - 2, grid.ny() - 1}) {
        EXPECT_LT(step(j) / grid.spacing_east_m(j), 2.0 * typical)
            << spec->name << ", row " << j << ", " << parameters.crust;
      }
    }
  }
}

/// Heights above the datum, with and without the plate's stiffness, in columns that the sea and
/// its shelves leave as they are.
struct Stiffness {
  Planetary stiff, soft;
  std::vector<double> change_m;
};
Stiffness stiffness(int nx, std::uint64_t seed, IsostasyParameters parameters = {}) {
  parameters.ocean_depth_m = 0.0;
  parameters.shelf_depth_m = 0.0;
  IsostasyParameters local = parameters;
  local.elastic_thickness_km = 0.0;
  Stiffness s{planet(nx, seed, parameters), planet(nx, seed, local), {}};
  const auto stiff = s.stiff.state.read(field::elevation),
             soft = s.soft.state.read(field::elevation);
  const double shift_m =
      s.stiff.budget.at("sea_level_shift_m") - s.soft.budget.at("sea_level_shift_m");
  for (std::size_t c = 0; c < stiff.size(); ++c) {
    s.change_m.push_back(static_cast<double>(stiff[c]) - soft[c] + shift_m);
  }
  return s;
}

TEST(Isostasy, StiffnessHoldsUpNothingFarFromBeltsAndArcs) {
  // Where nothing loads the plate it does not bend: further than two flexural wavelengths from the
  // nearest belt or arc by a thousandth of what a belt's root would be.
  const IsostasyParameters parameters;
  const double restoring = (parameters.density.mantle - parameters.density.water) * 9.81;
  const double wavelength_km =
      2e-3 * std::numbers::pi * std::pow(4.0 * parameters.plate.rigidity_n_m() / restoring, 0.25);
  EXPECT_NEAR(wavelength_km, 344.0, 5.0);
  for (const std::uint64_t seed : {3, 11}) {
    const Stiffness s = stiffness(1024, seed);
    const Grid& grid = s.stiff.state.grid();
    const auto belt = s.stiff.state.read(field::convergent_deformation);
    std::vector<std::uint8_t> loaded(grid.size());
    for (Index c = 0; c < grid.size(); ++c) loaded[c] = belt[c] > 1e-3F;
    const auto away_km = distance_to_marked_km(grid, loaded);
    double most_m = 0.0, near_m = 0.0;
    int far = 0;
    for (Index c = 0; c < grid.size(); ++c) {
      const bool is_far = away_km[c] > 2.0 * wavelength_km;
      far += is_far;
      double& most = is_far ? most_m : near_m;
      most = std::max(most, std::abs(s.change_m[c]));
    }
    EXPECT_GT(far, grid.size() / 5) << "seed " << seed;
    EXPECT_LT(most_m, 10.0) << "seed " << seed;
    EXPECT_GT(near_m, 500.0) << "seed " << seed;
  }
}

TEST(Isostasy, OldBeltsStandInLocalBalance) {
  IsostasyParameters parameters;
  parameters.collision_km = 0.0;
  parameters.arc_km = 0.0;
  for (const double change_m : stiffness(256, 3, parameters).change_m) {
    ASSERT_NEAR(change_m, 0.0, 0.01);
  }
}

TEST(Isostasy, BudgetIsTheSumOverCells) {
  const Planetary p = planet(256, 4);
  const Grid& grid = p.state.grid();
  const auto share = p.state.read(field::continental_fraction);
  const auto thickness = p.state.read(field::crust_thickness);
  double volume = 0.0, area = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    volume += thickness[c] * grid.area_m2(grid.row(c));
    area += share[c] * grid.area_m2(grid.row(c));
  }
  EXPECT_NEAR(p.budget.at("crust_m3"), volume, 1e-9 * volume);
  EXPECT_NEAR(p.budget.at("continental_area_m2"), area, 1e-9 * area);
}

TEST(Isostasy, SameBitsForAnyNumberOfThreads) {
  const int threads = omp_get_max_threads();
  for (const auto& parameters : {IsostasyParameters{}, blueprint()}) {
    omp_set_num_threads(1);
    const Planetary one = planet(256, 5, parameters);
    omp_set_num_threads(4);
    const Planetary four = planet(256, 5, parameters);
    omp_set_num_threads(threads);
    for (const auto* spec : {&field::elevation, &field::crust_thickness, &field::erodibility,
                             &field::convergent_deformation}) {
      const auto a = one.state.read(*spec), b = four.state.read(*spec);
      EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin())) << spec->name;
    }
    EXPECT_EQ(one.budget, four.budget);
  }
}

TEST(Isostasy, AsksForAWholeSphere) {
  State state(std::make_shared<Grid>(Grid::torus(16, 16, 1e4, 1e4)));
  const auto stage = make_isostasy_stage();
  for (const FieldSpec* spec : stage->info().reads) {
    if (spec->type == Type::float32) state.set(*spec, std::vector<float>(256));
    if (spec->type == Type::int8) state.set(*spec, std::vector<std::int8_t>(256));
    if (spec->type == Type::int16) state.set(*spec, std::vector<std::int16_t>(256));
  }
  StageIo io(state, stage->info());
  Context context;
  EXPECT_THROW(stage->run(io, context), InputError);
}

}  // namespace
}  // namespace geo
