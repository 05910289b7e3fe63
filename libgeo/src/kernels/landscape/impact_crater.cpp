#include "geo/kernels/landscape/impact_crater.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geo {
namespace {

constexpr double kEarthGravity_m_s2 = 9.81, kMoonGravity_m_s2 = 1.62;
constexpr double kSimpleOnEarth_m = 3200.0;  // largest bowl
constexpr double kPeakRingOnMoon_m = 140e3;
constexpr double kFloor = 0.6, kPeak = 0.22, kRing = 0.5, kRingHalfWidth = 0.1;  // of the radius
constexpr double kUplift = 0.35;                                                 // of the depth

double square(double x) { return x * x; }

/// Height of the rim over the lens of breccia in a bowl.
double bowl_depth_m(double transient_m, double diameter_m, double rim_m) {
  const double transient_depth = transient_m / (2.0 * std::numbers::sqrt2);
  const double breccia_m3 = 0.032 * diameter_m * square(diameter_m);
  const double open_depth = transient_depth + rim_m;
  const double lens = 2.8 * breccia_m3 * open_depth / (transient_depth * square(diameter_m));
  return open_depth - lens;
}

double complex_depth_m(double diameter_m, double simple_m) {
  const double as_on_earth_km = 1e-3 * diameter_m * kSimpleOnEarth_m / simple_m;
  return 400.0 * std::pow(as_on_earth_km, 0.3) * simple_m / kSimpleOnEarth_m;
}

double uplift_m(const Crater& crater, double of_radius) {
  const double offset =
      crater.has_peak_ring ? (of_radius - kRing) / kRingHalfWidth : of_radius / kPeak;
  return std::abs(offset) < 1.0 ? crater.uplift_m * square(1.0 - square(offset)) : 0.0;
}

}  // namespace

Crater crater_of(const ImpactScene& scene) {
  const double sine = std::sin(scene.angle_deg * std::numbers::pi / 180.0);
  constexpr double kWater_kg_m3 = 1000.0, kDrag = 0.877;
  const double slowed = std::exp(-1.5 * kWater_kg_m3 * kDrag * scene.water_depth_m /
                                 (scene.density_kg_m3 * scene.diameter_m * sine));
  const double simple_m = kSimpleOnEarth_m * kEarthGravity_m_s2 / scene.gravity_m_s2;

  Crater crater{};
  const double mass_kg =
      std::numbers::pi / 6.0 * scene.density_kg_m3 * scene.diameter_m * square(scene.diameter_m);
  crater.energy_j = 0.5 * mass_kg * square(scene.velocity_m_s);
  crater.transient_m = 1.161 * std::cbrt(scene.density_kg_m3 / scene.ground_density_kg_m3) *
                       std::pow(scene.diameter_m, 0.78) *
                       std::pow(scene.velocity_m_s * slowed, 0.44) *
                       std::pow(scene.gravity_m_s2, -0.22) * std::cbrt(sine);
  crater.diameter_m = 1.25 * crater.transient_m;
  crater.complex = crater.diameter_m > simple_m;
  if (crater.complex) {
    crater.diameter_m = 1.17 * std::pow(crater.transient_m, 1.13) * std::pow(simple_m, -0.13);
  }
  crater.rim_m =
      0.07 * square(square(crater.transient_m)) / (crater.diameter_m * square(crater.diameter_m));
  crater.depth_m = crater.complex
                       ? complex_depth_m(crater.diameter_m, simple_m)
                       : bowl_depth_m(crater.transient_m, crater.diameter_m, crater.rim_m);
  crater.uplift_m = crater.complex ? kUplift * crater.depth_m : 0.0;
  crater.has_peak_ring =
      crater.diameter_m > kPeakRingOnMoon_m * kMoonGravity_m_s2 / scene.gravity_m_s2;
  return crater;
}

double crater_profile_m(const Crater& crater, double distance_m) {
  const double of_radius = distance_m / (0.5 * crater.diameter_m);
  if (of_radius >= 1.0) return crater.rim_m / (of_radius * square(of_radius));
  const double floor = crater.complex ? kFloor : 0.0;
  const double wall = std::max(0.0, (of_radius - floor) / (1.0 - floor));
  return crater.rim_m + crater.depth_m * (square(wall) - 1.0) + uplift_m(crater, of_radius);
}

double crater_erasure(const Crater& crater, double distance_m) {
  constexpr double kWhole = 0.8, kGone = 1.2;
  const double of_radius = distance_m / (0.5 * crater.diameter_m);
  const double x = std::clamp((kGone - of_radius) / (kGone - kWhole), 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

}  // namespace geo
