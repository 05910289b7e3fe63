#include "geo/kernels/remapping/fibonacci_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/error.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGolden = std::numbers::phi;
/// Samples at a pole that a place there may be nearest to, twice what its ring needs.
constexpr std::int32_t kCap = FibonacciSphere::kPolar / 2;

/// Fractional part of n / golden, within [-0.5, 0.5), for a whole number n.
double turn_of(double n) {
  const double turns = n * (kGolden - 1.0);
  return turns - std::floor(turns + 0.5);
}

/// atan2 to 1e-5, which is far less than what parts samples.
double rough_angle(double y, double x) {
  const double ax = std::abs(x), ay = std::abs(y);
  const double most = std::max(ax, ay);
  if (most == 0.0) return 0.0;
  const double a = std::min(ax, ay) / most, s = a * a;
  double r =
      a * (0.9998660 + s * (-0.3302995 + s * (0.1801410 + s * (-0.0851330 + s * 0.0208351))));
  if (ay > ax) r = 0.5 * kPi - r;
  if (x < 0.0) r = kPi - r;
  return y < 0.0 ? -r : r;
}

double square_distance(const Vector3& a, const Vector3& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

}  // namespace

FibonacciSphere::FibonacciSphere(std::int32_t samples) {
  constexpr std::int32_t kLeast = 32, kMost = 16'000'000;
  if (samples < kLeast || samples > kMost) {
    throw ConfigurationError("samples of the sphere: must be within [32, 16000000], not " +
                             std::to_string(samples));
  }
  const double n = samples;
  area_sr_ = 4.0 * kPi / n;
  spacing_ = std::sqrt(2.0 / std::sqrt(3.0) * area_sr_);
  position_.resize(samples);
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < samples; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n;
    const double r = std::sqrt((1.0 - z) * (1.0 + z)), longitude = 2.0 * kPi * turn_of(i);
    position_[i] = {r * std::cos(longitude), r * std::sin(longitude), z};
  }
  std::vector<std::int32_t> fibonacci{1, 2};
  while (fibonacci.back() < 4 * samples / 3) {
    fibonacci.push_back(fibonacci.back() + fibonacci[fibonacci.size() - 2]);
  }
  for (std::size_t k = 0; k + 1 < fibonacci.size(); ++k) {
    Zone zone{};
    zone.first = fibonacci[k];
    zone.second = fibonacci[k + 1];
    zone.longitude_1 = 2.0 * kPi * turn_of(zone.first);
    zone.longitude_2 = 2.0 * kPi * turn_of(zone.second);
    zone.z_1 = -2.0 * zone.first / n;
    zone.z_2 = -2.0 * zone.second / n;
    // The step of the Fibonacci number F is as long along the parallel as along the meridian where
    // F^2 is about n pi sqrt(5) (1 - z^2) / 5.
    zone.least_s2 =
        std::pow(kGolden, 2.0 * static_cast<double>(k + 2)) / (n * kPi * std::sqrt(5.0));
    for (int s = 0; s < 5; ++s) {
      const auto at = static_cast<std::ptrdiff_t>(k) + s - 1;
      const auto last = static_cast<std::ptrdiff_t>(fibonacci.size()) - 1;
      zone.steps[s] = fibonacci[std::clamp<std::ptrdiff_t>(at, 0, last)];
    }
    zones_.push_back(zone);
  }
  // Half of the least distance between samples, 3.09 / sqrt(n): nobody else is nearer within.
  inner2_ = 1.54 * 1.54 / n;
  cap_z_ = samples > 2 * kPolar ? position_[kCap / 2][2] : -1.0;
}

int FibonacciSphere::zone(double z) const {
  const double s2 = 1.0 - z * z;
  int k = static_cast<int>(zones_.size()) - 1;
  while (k > 0 && s2 < zones_[k].least_s2) --k;
  return k;
}

std::span<const std::int32_t> FibonacciSphere::steps(std::int32_t sample) const {
  if (sample < kPolar || sample >= size() - kPolar) return {};
  return zones_[zone(position_[sample][2])].steps;
}

std::int32_t FibonacciSphere::nearest_polar(const Vector3& unit) const {
  const std::int32_t count = std::min(kPolar, size());
  const std::int32_t from = unit[2] > 0.0 || size() <= 2 * kPolar ? 0 : size() - count;
  const std::int32_t to = size() <= 2 * kPolar ? size() : from + count;
  std::int32_t best = from;
  double least = 8.0;
  for (std::int32_t i = from; i < to; ++i) {
    const double far = square_distance(position_[i], unit);
    if (far < least) {
      least = far;
      best = i;
    }
  }
  return best;
}

std::int32_t FibonacciSphere::nearest(const Vector3& unit) const {
  if (std::abs(unit[2]) >= cap_z_) return nearest_polar(unit);
  const Zone& lattice = zones_[zone(unit[2])];
  // Position within the lattice: unit = i * first + j * second from sample 0.
  const double longitude = rough_angle(unit[1], unit[0]);
  const double z = unit[2] - (1.0 - 1.0 / size());
  const double determinant = lattice.longitude_1 * lattice.z_2 - lattice.longitude_2 * lattice.z_1;
  const double a = (longitude * lattice.z_2 - z * lattice.longitude_2) / determinant;
  const double b = (z * lattice.longitude_1 - longitude * lattice.z_1) / determinant;
  const double index = std::round(a) * lattice.first + std::round(b) * lattice.second;
  const auto start = static_cast<std::int32_t>(std::clamp(index, 0.0, size() - 1.0));
  return nearest_by_descent(unit, start);
}

std::int32_t FibonacciSphere::nearest_by_descent(const Vector3& unit, std::int32_t start) const {
  std::int32_t best = start;
  double least = square_distance(position_[best], unit);
  if (least < inner2_) return best;
  const Zone* lattice = &zones_[zone(position_[best][2])];
  for (bool nearer = true; nearer;) {
    nearer = false;
    const std::int32_t centre = best;
    for (const std::int32_t step : lattice->steps) {
      for (const std::int32_t i : {centre - step, centre + step}) {
        if (i < 0 || i >= size()) continue;
        const double far = square_distance(position_[i], unit);
        if (far < least || (far == least && i < best)) {
          least = far;
          best = i;
          nearer = true;
        }
      }
    }
  }
  return best;
}

}  // namespace geo
