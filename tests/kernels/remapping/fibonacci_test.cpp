// The Fibonacci lattice and its triangulation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/plates/sphere/sphere_mesh.hpp"

namespace geo {
namespace {

std::int32_t nearest_of_all(const FibonacciSphere& samples, const Vector3& place) {
  std::int32_t best = 0;
  for (std::int32_t i = 1; i < samples.size(); ++i) {
    if (length(add(samples.position(i), place, -1.0)) <
        length(add(samples.position(best), place, -1.0))) {
      best = i;
    }
  }
  return best;
}

/// Places all over the sphere, most of them close to the poles.
std::vector<Vector3> places(int count) {
  const RandomStream random(7, "places");
  std::vector<Vector3> all{{0, 0, 1}, {0, 0, -1}, {-1, 0, 0}, {1, 0, 0}, {-1, -1e-17, 0}};
  for (int k = 0; k < count; ++k) {
    Vector3 at = random.direction(k);
    if (k % 2 == 0) {
      const double closer = std::pow(10.0, -4.0 * random.uniform(k, 1));
      at = normalised({at[0] * closer, at[1] * closer, at[2]});
    }
    all.push_back(at);
  }
  return all;
}

TEST(FibonacciSphere, HasPositionsOfTheSpiral) {
  const FibonacciSphere samples(1000);
  // Sample 1: longitude 2 pi (golden - 1) = 3.883222, z = 1 - 3 / 1000.
  const double longitude = 2.0 * std::numbers::pi * 0.6180339887498949, r = std::sqrt(1 - 0.994009);
  EXPECT_NEAR(samples.position(1)[0], r * std::cos(longitude), 1e-12);
  EXPECT_NEAR(samples.position(1)[1], r * std::sin(longitude), 1e-12);
  EXPECT_NEAR(samples.position(1)[2], 0.997, 1e-15);
  EXPECT_NEAR(samples.area_sr() * 1000, 4.0 * std::numbers::pi, 1e-12);
}

TEST(FibonacciSphere, FindsTheNearestSampleEverywhere) {
  for (const std::int32_t n : {32, 33, 100, 191, 192, 193, 1000, 5000, 20000}) {
    const FibonacciSphere samples(n);
    for (const Vector3& place : places(600)) {
      const std::int32_t found = samples.nearest(place), best = nearest_of_all(samples, place);
      ASSERT_NEAR(length(add(samples.position(found), place, -1.0)),
                  length(add(samples.position(best), place, -1.0)), 1e-14)
          << n << " samples, place " << place[0] << ' ' << place[1] << ' ' << place[2];
    }
  }
}

TEST(FibonacciSphere, FindsItsOwnSamples) {
  const FibonacciSphere samples(300000);
  std::int32_t lost = 0;
  for (std::int32_t i = 0; i < samples.size(); ++i)
    lost += samples.nearest(samples.position(i)) != i;
  EXPECT_EQ(lost, 0);
}

TEST(FibonacciSphere, RefusesNumbersItCannotHave) {
  EXPECT_THROW(FibonacciSphere(31), ConfigurationError);
  EXPECT_THROW(FibonacciSphere(-5), ConfigurationError);
  EXPECT_THROW(FibonacciSphere(16'000'001), ConfigurationError);
}

/// Whether a triangulation is convex along each edge: then it is the convex hull of the samples,
/// which is what Delaunay's is on a sphere.
void expect_delaunay(const SphereMesh& mesh) {
  const auto at = mesh.samples().positions();
  std::int64_t triangles = 0, flat = 0, clockwise = 0;
  for (std::int32_t a = 0; a < mesh.size(); ++a) {
    const auto star = mesh.neighbours(a);
    for (std::size_t k = 0; k < star.size(); ++k) {
      const std::int32_t b = star[k], c = star[(k + 1) % star.size()];
      ++triangles;
      const Vector3 normal = cross(add(at[b], at[a], -1.0), add(at[c], at[a], -1.0));
      clockwise += dot(normal, at[a]) <= 0.0;
      const auto other = mesh.neighbours(b);
      const auto here = std::find(other.begin(), other.end(), c) - other.begin();
      const std::int32_t d = other[(here + static_cast<std::ptrdiff_t>(other.size()) - 1) %
                                   static_cast<std::ptrdiff_t>(other.size())];
      flat += d != a && dot(normal, add(at[d], at[a], -1.0)) > 0.0;
    }
  }
  EXPECT_EQ(triangles, 3 * (2LL * mesh.size() - 4));
  EXPECT_EQ(clockwise, 0);
  EXPECT_EQ(flat, 0);
}

TEST(SphereMesh, IsDelaunay) {
  for (const std::int32_t n : {32, 50, 191, 193, 577, 1000, 10000, 200000}) {
    SCOPED_TRACE(n);
    const FibonacciSphere samples(n);
    expect_delaunay(SphereMesh(samples));
  }
}

TEST(SphereMesh, WeightsGiveThePlaceBack) {
  for (const std::int32_t n : {40, 700, 50000}) {
    const FibonacciSphere samples(n);
    const SphereMesh mesh(samples);
    for (const Vector3& place : places(2000)) {
      const auto [corner, weight] = mesh.locate(place);
      Vector3 sum{};
      double least = 1.0;
      for (int k = 0; k < 3; ++k) {
        sum = add(sum, samples.position(corner[k]), weight[k]);
        least = std::min(least, weight[k]);
      }
      EXPECT_GE(least, 0.0);
      EXPECT_NEAR(weight[0] + weight[1] + weight[2], 1.0, 1e-12);
      ASSERT_LT(length(add(normalised(sum), place, -1.0)), 1e-12) << n;
    }
  }
}

}  // namespace
}  // namespace geo
