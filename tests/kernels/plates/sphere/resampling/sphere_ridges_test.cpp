// Ridges in segments at right angles to the motion of their plates, offset along transforms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo {
namespace {

using test::kRadius_km;
using test::latitude_deg;
using test::longitude_deg;
using test::SampledSphere;

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Two plates of ocean floor that part about the pole at 100 mm/yr, along a line that crosses the
/// equator at longitude 0 and runs `east_per_north` degrees east for each degree north.
SphereTectonics parting(const SampledSphere& world, double east_per_north, double segment_km) {
  SphereState state;
  state.crust.resize(world.mesh.size());
  for (const double sign : {-1.0, 1.0}) {
    SpherePlate plate;
    plate.axis = {0.0, 0.0, sign};
    plate.speed_rad_myr = 50.0 / kRadius_km;
    state.add_plate(plate);
  }
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    const double line = std::clamp(east_per_north * latitude_deg(at), -80.0, 80.0);
    state.crust.plate[i] = longitude_deg(at) < line ? 0 : 1;
    state.crust.thickness_m[i] = 7000.0F;
    state.crust.elevation_m[i] = -5000.0F;
    state.crust.age_myr[i] = 50.0F;
  }
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.initiation_per_myr = 0.0;
  settings.slab_pull = 0.0;
  settings.no_net_rotation = false;
  settings.floor_by_age = true;
  settings.ridge_segment_km = segment_km;
  settings.least_steps = settings.most_steps = 10;
  return {world.mesh, settings, std::move(state), 1};
}

/// Longitude of the border between both plates at each degree of latitude within 30.
std::vector<double> ridge_deg(const SphereTectonics& model) {
  std::vector<double> ridge;
  for (int latitude = -30; latitude <= 30; ++latitude) {
    const double phi = latitude / kDegrees;
    const auto plate = [&](double longitude) {
      const double lambda = longitude / kDegrees;
      return model.state.crust.plate[model.mesh->samples().nearest(
          {std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda), std::sin(phi)})];
    };
    double west = -60.0;
    while (west < 60.0 && plate(west) == 0) west += 0.25;
    ridge.push_back(west);
  }
  return ridge;
}

/// Steps of more than `least_deg` from one degree of latitude to the next.
int offsets(const std::vector<double>& ridge, double least_deg) {
  int count = 0;
  for (std::size_t k = 1; k < ridge.size(); ++k) {
    count += std::abs(ridge[k] - ridge[k - 1]) > least_deg ? 1 : 0;
  }
  return count;
}

TEST(Ridges, OfAnObliqueRiftBreakIntoSegmentsAndTransforms) {
  const SampledSphere world(60000);
  SphereTectonics model = parting(world, 1.0, 1000.0);
  for (int k = 0; k < 10; ++k) advance(model);
  ASSERT_TRUE(model.budget.resampled);
  const std::vector<double> ridge = ridge_deg(model);
  // 60 degrees of latitude, 6670 km, in segments of some 1000 km.
  const int transforms = offsets(ridge, 4.0);
  EXPECT_GE(transforms, 5);
  EXPECT_LE(transforms, 8);
  // Between them the ridge follows meridians, to the spacing of samples.
  int along = 0;
  for (std::size_t k = 1; k < ridge.size(); ++k) along += std::abs(ridge[k] - ridge[k - 1]) < 1.1;
  EXPECT_GE(along, 42);
  // On the mean it lies where the rift was, and as a whole it goes as far.
  double mean = 0.0;
  for (const double east : ridge) mean += east / static_cast<double>(ridge.size());
  EXPECT_NEAR(mean, 0.0, 1.5);
  EXPECT_NEAR(ridge.back() - ridge.front(), 60.0, 10.0);

  // Without segments the ridge runs as the rift did.
  SphereTectonics straight = parting(world, 1.0, 0.0);
  for (int k = 0; k < 10; ++k) advance(straight);
  EXPECT_EQ(offsets(ridge_deg(straight), 4.0), 0);
}

TEST(Ridges, AtRightAnglesToTheMotionStayWhole) {
  const SampledSphere world(60000);
  SphereTectonics model = parting(world, 0.0, 1000.0);
  for (int k = 0; k < 10; ++k) advance(model);
  const std::vector<double> ridge = ridge_deg(model);
  EXPECT_EQ(offsets(ridge, 1.6), 0);
  for (const double east : ridge) EXPECT_NEAR(east, 0.0, 1.0);
}

TEST(Ridges, KeepTheirOffsetsAsTheOceanOpens) {
  const SampledSphere world(60000);
  SphereTectonics model = parting(world, 1.0, 1000.0);
  for (int k = 0; k < 10; ++k) advance(model);
  const std::vector<double> first = ridge_deg(model);
  for (int k = 0; k < 20; ++k) advance(model);
  const std::vector<double> later = ridge_deg(model);
  EXPECT_NEAR(offsets(first, 4.0), offsets(later, 4.0), 1);
  double apart = 0.0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    apart += std::abs(later[k] - first[k]) / static_cast<double>(first.size());
  }
  // The mean of an oblique line's segments would lie up to a half of 9 degrees off.
  EXPECT_LT(apart, 1.2);
}

TEST(Ridges, FloorAgesFromTheRidgeToThePlatesEdge) {
  const SampledSphere world(60000);
  SphereTectonics model = parting(world, 1.0, 1000.0);
  for (int k = 0; k < 10; ++k) advance(model);
  const SphereCrust& crust = model.state.crust;
  const std::vector<double> ridge = ridge_deg(model);
  double worst = 0.0, oldest = 0.0;
  int seen = 0;
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const Vector3& at = world.samples.position(i);
    const double latitude = latitude_deg(at);
    if (crust.age_myr[i] > 20.5F || std::abs(latitude) > 29.0) continue;
    oldest = std::max<double>(oldest, crust.age_myr[i]);
    const double off_km = std::abs(longitude_deg(at) -
                                   ridge[static_cast<std::size_t>(std::lround(latitude + 30.0))]) /
                          kDegrees * kRadius_km * std::cos(latitude / kDegrees);
    // Near the ridge of a segment, the floor is young; ridges lie on meridians, fabric follows
    // them.
    if (off_km < 150.0) worst = std::max<double>(worst, crust.age_myr[i]);
    ++seen;
    EXPECT_GT(std::abs(crust.ridge[i][2]), 0.85F) << latitude;
  }
  EXPECT_GT(seen, 500);
  EXPECT_LE(oldest, 20.0);
  EXPECT_GT(oldest, 15.0);
  // Half way up the gap at a segment's end, where the rift is half a segment off, floor is as old
  // as the gap is narrow on one side.
  EXPECT_LT(worst, 18.0);
}

}  // namespace
}  // namespace geo
