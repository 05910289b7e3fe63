// Margins of continents that break while plates drift.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/core/random.hpp"
#include "geo/kernels/plates/sphere/sphere_boundaries.hpp"
#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::kKmPerDegree;
using test::latitude_deg;
using test::longitude_deg;
using test::SampledSphere;

/// Two plates that have parted along longitude 0, once one continent of 40 by 60 degrees, whose
/// samples are each as thick and as high as chance has it.
class BrokenContinent : public testing::Test {
 protected:
  static constexpr double kThick_m = 36000.0, kRough_m = 4000.0, kHigh_m = 700.0;

  explicit BrokenContinent(double necking = 1.0, double thinning = 0.18)
      : world_(120000), model_(world_.mesh, settings(necking, thinning), beginning(), 1) {
    for (int k = 0; k < 5; ++k) advance(model_);
    before_ = model_.state.crust;
    volume_km3_ = model_.budget.continental_km3;
    resample(model_);
  }
  static SphereSettings settings(double necking, double thinning) {
    SphereSettings s;
    s.margin_necking = necking;
    s.margin_thinning = thinning;
    s.rift_per_myr = 0.0;
    s.slab_pull = 0.0;
    s.no_net_rotation = false;
    s.floor_by_age = true;
    s.law.erosion_mm_yr = s.law.uplift_mm_yr = 0.0;
    s.margin_km = 250.0;  // four samples
    s.margin_source_km = 1500.0;
    return s;
  }
  SphereState beginning() const {
    SphereState state;
    state.crust.resize(world_.mesh.size());
    for (const double sign : {-1.0, 1.0}) {
      SpherePlate plate;
      plate.axis = {0.0, 0.0, sign};
      plate.speed_rad_myr = 50.0 / 6370.0;
      state.add_plate(plate);
    }
    const RandomStream random(7, "rough");
    for (std::int32_t i = 0; i < world_.mesh.size(); ++i) {
      const Vector3& at = world_.samples.position(i);
      const bool land = std::abs(longitude_deg(at)) < 30.0 && std::abs(latitude_deg(at)) < 20.0;
      const double rough =
          land ? random.uniform(static_cast<std::uint64_t>(i), 0, -kRough_m, kRough_m) : 0.0;
      state.crust.plate[i] = longitude_deg(at) < 0.0 ? 0 : 1;
      state.crust.continental[i] = land ? 1 : 0;
      state.crust.thickness_m[i] = static_cast<float>(land ? kThick_m + rough : 7000.0);
      state.crust.elevation_m[i] = static_cast<float>(land ? kHigh_m + rough / 6.6 : -5000.0);
      state.crust.age_myr[i] = 60.0F;
    }
    return state;
  }
  /// Calls at_sample(i, km seaward of the break) for the continent's crust far from its corners.
  template <class AtSample>
  void along_break(AtSample&& at_sample) const {
    const SphereCrust& crust = model_.state.crust;
    const double parted_deg = 500.0 / kKmPerDegree;
    for (std::int32_t i = 0; i < crust.size(); ++i) {
      const Vector3& at = world_.samples.position(i);
      if (crust.continental[i] == 0 || std::abs(latitude_deg(at)) > 8.0) continue;
      const double off_deg = parted_deg - std::abs(longitude_deg(at));
      at_sample(i, off_deg * kKmPerDegree * std::cos(std::asin(at[2])));
    }
  }

  SampledSphere world_;
  SphereTectonics model_;
  SphereCrust before_;
  double volume_km3_ = 0.0;
};

class NeckedContinent : public BrokenContinent {
 protected:
  NeckedContinent() : BrokenContinent(2.0, 0.5) {}
};

/// Moving the lattice costs little beside what has flown into the margins.
void expect_same_volume(const SphereBudget& budget, double before_km3) {
  EXPECT_GT(budget.stretched_km2, 2.0 * 0.8 * 250.0 * 40.0 * kKmPerDegree);
  const double margins_km3 = 8.0 * budget.stretched_km2;
  EXPECT_LT(std::abs(budget.continental_km3 - before_km3), 0.05 * margins_km3);
  EXPECT_DOUBLE_EQ(budget.continental_km3 - before_km3, budget.resampling_km3);
}

TEST_F(BrokenContinent, KeepsItsVolume) { expect_same_volume(model_.budget, volume_km3_); }

TEST_F(NeckedContinent, KeepsItsVolume) { expect_same_volume(model_.budget, volume_km3_); }

TEST_F(NeckedContinent, IsThinHalfWayOut) {
  double edge_m = 0.0, middle_m = 0.0;
  int edges = 0, middles = 0;
  along_break([&](std::int32_t i, double off_km) {
    const double thick_m = model_.state.crust.thickness_m[i];
    if (off_km > -60.0 && off_km < 0.0) {
      edge_m += thick_m;
      ++edges;
    } else if (off_km > 110.0 && off_km < 140.0) {
      middle_m += thick_m;
      ++middles;
    }
  });
  ASSERT_GT(edges, 10);
  ASSERT_GT(middles, 10);
  // At most 1/4 + 3/4 (1/2)^2 of the crust at the break, where it would be 5/8 without necking;
  // means over samples and what the land cannot give make both a sixth less.
  const double kept = middle_m / middles / (edge_m / edges);
  EXPECT_GT(kept, 0.25);
  EXPECT_LT(kept, 0.4375);
}

TEST_F(BrokenContinent, ThinsEvenlyAlongTheBreakAndLessInland) {
  double low = 1e9, high = 0.0, edge = 0.0, inland = 0.0;
  int at_edge = 0, far = 0;
  const SphereCrust& crust = model_.state.crust;
  along_break([&](std::int32_t i, double off_km) {
    if (off_km > -100.0 || off_km < -2600.0) return;
    // A plate has turned as a whole: what was here lies where its plate has come from.
    const double turn = (crust.plate[i] == 0 ? 1.0 : -1.0) * 500.0 / 6370.0;
    const Vector3& at = world_.samples.position(i);
    const Vector3 from{at[0] * std::cos(turn) - at[1] * std::sin(turn),
                       at[0] * std::sin(turn) + at[1] * std::cos(turn), at[2]};
    const auto was = world_.mesh.locate(from);
    double thick_m = 0.0;
    for (int k = 0; k < 3; ++k) thick_m += was.weight[k] * before_.thickness_m[was.corner[k]];
    const double thinned = 1.0 - crust.thickness_m[i] / thick_m;
    if (off_km > -300.0 && off_km < -200.0) {
      low = std::min(low, thinned);
      high = std::max(high, thinned);
      edge += thinned;
      ++at_edge;
    } else if (off_km < -1800.0) {
      inland += std::abs(thinned);
      ++far;
    }
  });
  ASSERT_GT(at_edge, 50);
  ASSERT_GT(far, 200);
  EXPECT_GT(edge / at_edge, 0.05);
  EXPECT_LT(high - low, 0.25 * edge / at_edge);
  EXPECT_LT(inland / far, 1e-3);
}

TEST_F(BrokenContinent, SlopesWithoutTeeth) {
  // The samples of the break lie up to 1200 m apart; places of the margin as far from it do not.
  std::vector<std::pair<double, double>> points;
  double mean_km = 0.0, mean_m = 0.0;
  along_break([&](std::int32_t i, double off_km) {
    if (off_km < 20.0 || off_km > 100.0) return;
    points.emplace_back(off_km, model_.state.crust.elevation_m[i]);
    mean_km += off_km;
    mean_m += model_.state.crust.elevation_m[i];
  });
  ASSERT_GT(points.size(), 40U);
  mean_km /= std::ssize(points);
  mean_m /= std::ssize(points);
  double across = 0.0, squares = 0.0, left = 0.0;
  for (const auto& [km, m] : points) {
    across += (km - mean_km) * (m - mean_m);
    squares += (km - mean_km) * (km - mean_km);
  }
  const double slope = across / squares;
  for (const auto& [km, m] : points) left += std::pow(m - mean_m - slope * (km - mean_km), 2);
  EXPECT_LT(slope, -10.0);  // m per km
  EXPECT_GT(mean_m, -2500.0);
  EXPECT_LT(std::sqrt(left / std::ssize(points)), 270.0);
}

TEST(FirstContinents, EndInMarginsAsDeepAsTheirCrustIsThin) {
  const SampledSphere world(60000);
  SphereSettings settings;
  settings.margin_km = 400.0;  // four samples
  const SphereState state = start_sphere(world.mesh, {}, settings, 5);
  const SphereCrust& crust = state.crust;
  std::vector<std::int32_t> floor;
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    if (crust.continental[i] == 0) floor.push_back(i);
  }
  const auto nearest = nearest_samples(world.mesh, floor, 1.0);
  int edges = 0, whole = 0;
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    if (crust.continental[i] == 0 || nearest[i] < 0) continue;
    const double inland_km = 6370.0 * angle_between(world.samples.position(i),
                                                    world.samples.position(floor[nearest[i]]));
    // Airy about crust of 36 km at 350 m, under water that adds 45 %.
    const double dry_m = 350.0 + (crust.thickness_m[i] - 36000.0) / 6.6;
    ASSERT_NEAR(crust.elevation_m[i], dry_m < 0.0 ? 1.45 * dry_m : dry_m, 1.0);
    if (inland_km < 110.0) {
      EXPECT_LT(crust.thickness_m[i], 17000.0F);
      EXPECT_GT(crust.thickness_m[i], 8000.0F);
      ++edges;
    } else if (inland_km > 460.0) {
      EXPECT_GT(crust.elevation_m[i], 0.0F);
      ++whole;
    }
  }
  EXPECT_GT(edges, 500);
  EXPECT_GT(whole, 1000);
}

}  // namespace
}  // namespace geo
