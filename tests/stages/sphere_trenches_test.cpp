// Trenches of drifting plates, in the relief that frames show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "drifted.hpp"
#include "geo/core/field.hpp"
#include "geo/kernels/plates/growth/convergent_margins.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {
namespace {

constexpr double kSlab_m = 4000.0;
constexpr double kReach_km = 450.0, kSpacing_km = 206.0;  // of 12 000 samples

const State& planet(double slab_m) {
  static const State kWith = [] {
    PlatesParameters parameters = quick();
    parameters.slab_trench_m = kSlab_m;
    return drifted(360, 4, parameters).state;
  }();
  static const State kWithout = drifted(360, 4, quick()).state;
  return slab_m > 0.0 ? kWith : kWithout;
}

/// What trenches add to the elevation of each cell, m.
std::vector<double> added_m() {
  const auto with = planet(kSlab_m).read(field::crust_elevation);
  const auto without = planet(0.0).read(field::crust_elevation);
  std::vector<double> added(with.size());
  for (std::size_t c = 0; c < added.size(); ++c) added[c] = with[c] - without[c];
  return added;
}

TEST(SphereTrenches, ChangeElevationAlone) {
  for (const auto* spec : {&field::crust_age, &field::crust_thickness, &field::boundary_strength,
                           &field::continental_fraction}) {
    const auto with = planet(kSlab_m).read(*spec), without = planet(0.0).read(*spec);
    EXPECT_TRUE(std::equal(with.begin(), with.end(), without.begin())) << spec->name;
  }
}

TEST(SphereTrenches, LieWhereFloorSubductsAndNowhereElse) {
  const State& state = planet(kSlab_m);
  const Grid& grid = state.grid();
  const auto polarity = state.read(field::subduction_polarity);
  const auto fraction = state.read(field::continental_fraction);
  const std::vector<double> added = added_m();
  std::vector<Index> converges;
  for (Index c = 0; c < grid.size(); ++c) {
    if (polarity[c] != 0) converges.push_back(c);
  }
  double at_slabs = 0.0, deepest = 0.0, bulge = 0.0;
  int slabs = 0, changed = 0, astray = 0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (fraction[c] >= 1.0F) EXPECT_EQ(added[c], 0.0);
    deepest = std::min(deepest, added[c]);
    bulge = std::max(bulge, added[c]);
    if (polarity[c] == 2 && fraction[c] <= 0.0F) at_slabs += added[c], ++slabs;
    if (std::abs(added[c]) < 30.0) continue;
    double nearest_km = std::numeric_limits<double>::infinity();
    const auto here = grid.unit_vector(grid.column(c), grid.row(c));
    for (const Index s : converges) {
      const auto there = grid.unit_vector(grid.column(s), grid.row(s));
      nearest_km = std::min(
          nearest_km, 1e-3 * grid.figure().radius_m *
                          std::hypot(here[0] - there[0], here[1] - there[1], here[2] - there[2]));
    }
    ++changed;
    if (nearest_km > kReach_km + kSpacing_km) ++astray;
  }
  ASSERT_GT(slabs, 50);
  // The two sides of a boundary need not agree that it is convergent.
  EXPECT_LT(astray, 0.01 * changed);
  EXPECT_LT(at_slabs / slabs, -0.1 * kSlab_m);
  // Slabs of 120 Myr that go down at 120 mm/yr at most.
  EXPECT_GE(deepest, -1.2 * kSlab_m);
  EXPECT_LT(deepest, -0.5 * kSlab_m);
  // The forebulge of a plate is a tenth of its trench.
  EXPECT_GT(bulge, 0.03 * kSlab_m);
  EXPECT_LE(bulge, 0.125 * kSlab_m);
}

TEST(SphereTrenches, AreAsDeepAsAgeAndRateHaveThem) {
  // At the axis of the trench, between a subducting cell and an overriding one.
  const State& state = planet(kSlab_m);
  const Grid& grid = state.grid();
  const auto polarity = state.read(field::subduction_polarity);
  const auto age = state.read(field::crust_age);
  const auto east = state.read(field::plate_velocity_east);
  const auto north = state.read(field::plate_velocity_north);
  const std::vector<double> added = added_m();
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (int j = grid.ny() / 4; j < 3 * grid.ny() / 4; ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index below = grid.cell(i, j);
      if (polarity[below] != 2) continue;
      for (const int k : {kNorth, kEast, kSouth, kWest}) {
        const Index above = grid.neighbour(i, j, k);
        if (polarity[above] != 1) continue;
        const double closing = std::hypot(east[below] - east[above], north[below] - north[above]);
        const double wanted = -kSlab_m * trench_share(age[below], closing);
        const double found = std::min(added[below], added[above]);
        n += 1, x += wanted, y += found;
        xx += wanted * wanted, yy += found * found, xy += wanted * found;
      }
    }
  }
  ASSERT_GT(n, 100);
  const double r = (n * xy - x * y) / std::sqrt((n * xx - x * x) * (n * yy - y * y));
  EXPECT_GT(r, 0.6);
}

}  // namespace
}  // namespace geo
