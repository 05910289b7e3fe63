// Sections 2 and 3: plates, crust, rock, isostasy.
#include <gtest/gtest.h>

#include <set>

#include "blueprint.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/kernels/plates/growth/continents.hpp"

namespace geo {
namespace {

using test::planet;

TEST(BlueprintPlates, AreContinentsFromTheMostBuoyantOnUntilTheShareIsReached) {
  // (3.1b): min(0.29 + 0.20, 0.85) of the area.
  const CubedSphere mesh(32);
  PlateGrowth model;
  model.count = 15;
  int beyond = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto plates = draw_plates(model, seed);
    const auto plate = grow_plates(model, mesh, plates, seed);
    const auto continental = continental_plates_reaching(mesh, plate, plates, 0.49);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < plates.size(); ++k) order.emplace_back(-plates[k].buoyancy, k);
    std::sort(order.begin(), order.end());
    double share = 0.0;
    for (const auto& [falling, k] : order) {
      ASSERT_EQ(continental[k] != 0, share < 0.49) << "seed " << seed << " plate " << k;
      for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
        if (plate[cell] == static_cast<int>(k)) {
          share += mesh.area_sr(cell) / (4.0 * std::numbers::pi);
        }
      }
    }
    double land = 0.0;
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      if (continental[plate[cell]] != 0) land += mesh.area_sr(cell) / (4.0 * std::numbers::pi);
    }
    beyond += land > 0.54 ? 1 : 0;
  }
  EXPECT_GT(beyond, 0);  // a last plate that is large goes beyond it
  const double share = test::share_of(planet().grid(), [](Index c) {
    return planet().read("plates", field::continental_fraction)[c] > 0.5F;
  });
  EXPECT_GT(share, 0.48);
}

TEST(BlueprintPlates, BeginAnywhere) {
  // 2.2 draws places on the sphere: some are as close as draws of 15 places are.
  PlateGrowth model;
  model.count = 15;
  model.centre_candidates = 1;
  double nearest = 0.0;
  constexpr int kSeeds = 200;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto plates = draw_plates(model, seed);
    double least = 4.0;
    for (std::size_t a = 0; a < plates.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        least = std::min(least, angle_between(plates[a].centre, plates[b].centre));
      }
    }
    nearest += least / kSeeds;
  }
  // Of 105 pairs the nearest: P(all > r) = exp(-105 (1 - cos r) / 2), whose mean is 0.172.
  EXPECT_NEAR(nearest, std::sqrt(std::numbers::pi / 105.0), 0.02);
}

/// The largest of strength exp(-d / L) over boundary cells of a type (3.2), cell by cell.
std::vector<float> propagated(BoundaryType type, double length_km) {
  const Grid& grid = planet().grid();
  const auto types = planet().read("plates", field::boundary_type);
  const auto strength = planet().read("plates", field::boundary_strength);
  std::vector<float> field(grid.size(), 0.0F);
  std::vector<Index> sources;
  for (Index c = 0; c < grid.size(); ++c) {
    if (types[c] == static_cast<int>(type)) sources.push_back(c);
  }
  for (Index c = 0; c < grid.size(); ++c) {
    const auto here = test::place(grid, c);
    double most = 0.0;
    for (const Index from : sources) {
      const double far_km = test::arc_km(here, test::place(grid, from));
      most = std::max(most, strength[from] * std::exp(-far_km / length_km));
    }
    field[c] = static_cast<float>(most);
  }
  return field;
}

TEST(BlueprintCrust, DeformationDiesAwayFromBoundaries) {
  const Grid& grid = planet().grid();
  const auto types = planet().read("plates", field::boundary_type);
  const auto weakness = planet().read("isostasy", field::lithospheric_weakness);
  const auto fraction = planet().read("isostasy", field::continental_fraction);
  std::vector<Index> boundary;
  for (Index c = 0; c < grid.size(); ++c) {
    if (types[c] != 0) boundary.push_back(c);
  }
  for (Index c = 0; c < grid.size(); ++c) {
    double nearest_km = 1e9;
    for (const Index b : boundary) {
      nearest_km = std::min(nearest_km, test::arc_km(test::place(grid, c), test::place(grid, b)));
    }
    ASSERT_NEAR(weakness[c], std::exp(-nearest_km / 300.0), 2e-3);  // (3.2a)
  }
  for (const auto& [type, length_km, field] :
       {std::tuple(BoundaryType::convergent, 200.0, &field::convergent_deformation),
        {BoundaryType::divergent, 150.0, &field::divergent_deformation},
        {BoundaryType::transform, 100.0, &field::transform_deformation}}) {
    auto expected = propagated(type, length_km);
    smooth(grid, expected, 90e3);  // 8 passes
    const auto found = planet().read("isostasy", *field);
    for (Index c = 0; c < grid.size(); ++c) {
      double value = std::clamp(expected[c], 0.0F, 1.0F);
      if (type == BoundaryType::convergent && fraction[c] > 0.1F) value *= weakness[c];
      ASSERT_NEAR(found[c], value, 0.01) << field->name << " of cell " << c;
    }
  }
}

TEST(BlueprintCrust, CoastsArePerturbed) {
  const Grid& grid = planet().grid();
  const auto plates = planet().read("plates", field::continental_fraction);
  std::vector<float> expected(plates.begin(), plates.end());
  smooth(grid, expected, 80e3);  // 20 passes
  const Noise noise(planet().seed, "isostasy.coast");
  for (Index c = 0; c < grid.size(); ++c) {
    const auto at = test::place(grid, c);
    const double n = test::octave(noise, at, 4) * 0.10 + test::octave(noise, at, 8) * 0.04 +
                     test::octave(noise, at, 16) * 0.01;
    const double margin = 1.0 - std::abs(2.0 * expected[c] - 1.0);  // (3.1c)
    expected[c] = static_cast<float>(std::clamp(expected[c] + n * margin, 0.0, 1.0));
  }
  smooth(grid, expected, 26e3);  // 3 passes
  const auto found = planet().read("isostasy", field::continental_fraction);
  for (Index c = 0; c < grid.size(); ++c) ASSERT_NEAR(found[c], expected[c], 1e-5);
}

TEST(BlueprintCrust, ThicknessIsThatOfItsTable) {
  const Grid& grid = planet().grid();
  const auto cf = planet().read("isostasy", field::continental_fraction);
  const auto conv = planet().read("isostasy", field::convergent_deformation);
  const auto div = planet().read("isostasy", field::divergent_deformation);
  const auto trans = planet().read("isostasy", field::transform_deformation);
  const Noise first(planet().seed, "isostasy.crust"), second(planet().seed, "isostasy.crust_again");
  std::vector<float> expected(grid.size());
  double least = 1e9, most = -1e9;
  for (Index c = 0; c < grid.size(); ++c) {
    const auto at = test::place(grid, c);
    const double noise_var = test::octave(first, at, 3) * 10 + test::octave(second, at, 6) * 5;
    least = std::min(least, noise_var);
    most = std::max(most, noise_var);
    // (3.1), continent and ocean blended by the continental fraction.
    const double continent = 43 + noise_var + conv[c] * 22 - div[c] * 20 + trans[c] * 2;
    const double ocean = 7 + conv[c] * 13 - div[c] * 20 + trans[c] * 2;
    const double km = std::clamp(cf[c] * continent + (1 - cf[c]) * ocean, 5.0, 75.0);
    expected[c] = static_cast<float>(1e3 * km);
  }
  EXPECT_LT(least, -9.0);  // of +-15 km (3.1a)
  EXPECT_GT(most, 9.0);
  smooth(grid, expected, 70e3);  // 12 passes (3.2)
  const auto found = planet().read("isostasy", field::crust_thickness);
  for (Index c = 0; c < grid.size(); ++c) ASSERT_NEAR(found[c], expected[c], 1.0);
}

TEST(BlueprintCrust, FloatsByAiry) {
  const Grid& grid = planet().grid();
  const auto cf = planet().read("isostasy", field::continental_fraction);
  const auto heat = planet().read("plates", field::heat_anomaly);
  const auto density = planet().read("isostasy", field::crust_density);
  const auto thickness = planet().read("isostasy", field::crust_thickness);
  const auto z = planet().read("isostasy", field::elevation);
  const double level = planet().budget.at("isostasy").at("sea_level_shift_m");
  const Noise noise(planet().seed, "isostasy.overlay");
  for (Index c = 0; c < grid.size(); ++c) {
    const auto at = test::place(grid, c);
    const double rho = (cf[c] * 2800 + (1 - cf[c]) * 2900) * (1 - heat[c] * 0.02);  // (3.5)
    ASSERT_NEAR(density[c], rho, 0.01);
    const double h = thickness[c] * (3300 - rho) / 3300 +  // (3.3), (3.6)
                     60 * test::octave(noise, at, 3) + 35 * test::octave(noise, at, 6) +
                     18 * test::octave(noise, at, 12) + 7 * test::octave(noise, at, 24);
    ASSERT_NEAR(z[c] + level, h, 0.05);
  }
  EXPECT_NEAR(test::share_of(grid, [&](Index c) { return z[c] < 0.0F; }), 0.71, 2e-3);  // 4.7
}

TEST(BlueprintCrust, RocksAreThoseOfTheirTable) {
  const Grid& grid = planet().grid();
  const auto cf = planet().read("isostasy", field::continental_fraction);
  const auto conv = planet().read("isostasy", field::convergent_deformation);
  const auto div = planet().read("isostasy", field::divergent_deformation);
  const auto trans = planet().read("isostasy", field::transform_deformation);
  const auto rock = planet().read("isostasy", field::rock_type);
  const auto types = planet().read("plates", field::boundary_type);
  const std::map<RockType, float> millionths{
      {RockType::basalt, 1.0F},    {RockType::schist, 1.2F},    {RockType::granite, 0.5F},
      {RockType::quartzite, 0.8F}, {RockType::sandstone, 2.0F}, {RockType::limestone, 3.0F}};
  std::vector<float> expected(grid.size());
  std::set<RockType> interior;
  for (Index c = 0; c < grid.size(); ++c) {
    const auto found = static_cast<RockType>(rock[c]);
    const bool is_interior =
        cf[c] >= 0.5F && !(conv[c] > 0.15F) && !(div[c] > 0.3F) && !(trans[c] > 0.2F);
    if (is_interior) {
      interior.insert(found);
    } else {
      const RockType wanted = cf[c] < 0.5F && conv[c] > 0.3F ? RockType::schist
                              : cf[c] < 0.5F                 ? RockType::basalt
                              : conv[c] > 0.5F               ? RockType::granite
                              : conv[c] > 0.15F              ? RockType::quartzite
                              : div[c] > 0.3F                ? RockType::sandstone
                                                             : RockType::schist;
      ASSERT_EQ(found, wanted) << "cell " << c;
    }
    expected[c] = millionths.at(found) * (types[c] != 0 ? 1.5F : 1.0F);
  }
  EXPECT_EQ(interior, (std::set{RockType::granite, RockType::sandstone, RockType::limestone}));
  smooth(grid, expected, 26e3);  // 3 passes
  const auto erodibility = planet().read("isostasy", field::erodibility);
  for (Index c = 0; c < grid.size(); ++c) ASSERT_NEAR(1e6 * erodibility[c], expected[c], 1e-4);
}

}  // namespace
}  // namespace geo
