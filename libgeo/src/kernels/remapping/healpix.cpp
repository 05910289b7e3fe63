#include "geo/kernels/remapping/healpix.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"

namespace geo {
namespace {

constexpr double kQuarter = 0.25 * std::numbers::pi;
/// Of the twelve base pixels: where their southern corner lies, in rings and in eighths of a turn.
constexpr std::array kFaceRing{2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4};
constexpr std::array kFaceEighth{1, 3, 5, 7, 0, 2, 4, 6, 1, 3, 5, 7};

/// Every other bit of a number, put together.
int even_bits(std::uint32_t number) {
  number &= 0x55555555U;
  number = (number | (number >> 1U)) & 0x33333333U;
  number = (number | (number >> 2U)) & 0x0f0f0f0fU;
  number = (number | (number >> 4U)) & 0x00ff00ffU;
  return static_cast<int>((number | (number >> 8U)) & 0x0000ffffU);
}

struct Place {
  int face, x, y;  ///< base pixel, steps to the north-east and to the north-west in it
};

Place place_of(std::int32_t pixel, int nside) {
  const int per_face = nside * nside;
  const auto inside = static_cast<std::uint32_t>(pixel % per_face);
  return {pixel / per_face, even_bits(inside), even_bits(inside >> 1U)};
}

enum class Zone { north, equator, south };

/// A side of a pixel between two latitudes: longitude = a + b u, where u is the sine of latitude in
/// the equatorial zone and 1 / sqrt(3 (1 - |sine|)) in the polar ones. Monotone in the sine.
struct Side {
  Zone zone;
  double a, b;

  [[nodiscard]] static double ring(double sine) {
    return std::sqrt(std::max(0.0, 3.0 * (1.0 - std::abs(sine))));
  }
  [[nodiscard]] double longitude(double sine) const {
    if (zone == Zone::equator) return a + b * sine;
    return b == 0.0 ? a : a + b / ring(sine);
  }
  /// Sine of latitude where it has that longitude, which it must reach.
  [[nodiscard]] double sine_at(double longitude) const {
    if (zone == Zone::equator) return (longitude - a) / b;
    const double n = b / (longitude - a);
    return zone == Zone::north ? 1.0 - n * n / 3.0 : n * n / 3.0 - 1.0;
  }
  /// Integral of the longitude over the sine from `low` to `high`.
  [[nodiscard]] double integral(double low, double high) const {
    if (zone == Zone::equator) return (a + 0.5 * b * (low + high)) * (high - low);
    const double sign = zone == Zone::north ? -1.0 : 1.0;
    return a * (high - low) + sign * (2.0 / 3.0) * b * (ring(high) - ring(low));
  }
};

/// The same of the longitude held within `west` and `east`.
double integral_within(const Side& side, double low, double high, double west, double east) {
  const double at_low = side.longitude(low), at_high = side.longitude(high);
  // Where it crosses a border, else the end.
  const auto crossing = [&](double border) {
    const bool crosses = (at_low - border) * (at_high - border) < 0.0;
    return crosses ? std::clamp(side.sine_at(border), low, high) : high;
  };
  const auto [first, second] = std::minmax({crossing(west), crossing(east)});
  const std::array<double, 4> cuts{low, first, second, high};
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double from = cuts[k], to = cuts[k + 1];
    if (!(from < to)) continue;
    const double middle = side.longitude(0.5 * (from + to));
    sum += middle <= west   ? west * (to - from)
           : middle >= east ? east * (to - from)
                            : side.integral(from, to);
  }
  return sum;
}

/// The lower or upper half of a pixel: between two latitudes, and between two sides.
struct Half {
  double low, high;  ///< sines of latitude
  Side left, right;
};

Half half_of(const Place& at, int nside, bool upper) {
  const double n = nside;
  const int ring_of_face = kFaceRing[at.face];
  const double from = (at.x + at.y + (upper ? 1 : 0)) / n, to = (at.x + at.y + (upper ? 2 : 1)) / n;
  const double middle_ring = ring_of_face - 0.5 * (from + to);
  const Zone zone = middle_ring < 1.0   ? Zone::north
                    : middle_ring > 3.0 ? Zone::south
                                        : Zone::equator;
  const auto sine = [&](double sum) {
    const double ring = ring_of_face - sum;
    if (zone == Zone::north) return 1.0 - ring * ring / 3.0;
    if (zone == Zone::south) return (4.0 - ring) * (4.0 - ring) / 3.0 - 1.0;
    return (2.0 - ring) * 2.0 / 3.0;
  };
  // In the base pixel, x - y = c + sign * (x + y) along a side.
  const auto side = [&](double c, double sign) -> Side {
    const double eighth = kFaceEighth[at.face];
    if (zone == Zone::equator) {  // x + y = ring - 2 + 1.5 sine
      return {zone, kQuarter * (eighth + c + sign * (ring_of_face - 2.0)), kQuarter * sign * 1.5};
    }
    if (zone == Zone::north) {  // x + y = ring - n
      return {zone, kQuarter * (eighth - sign), kQuarter * (c + sign * ring_of_face)};
    }
    return {zone, kQuarter * (eighth + sign), kQuarter * (c - sign * (4.0 - ring_of_face))};
  };
  if (upper) {
    return {sine(from), sine(to), side(-2.0 * (at.y + 1) / n, 1.0),
            side(2.0 * (at.x + 1) / n, -1.0)};
  }
  return {sine(from), sine(to), side(2.0 * at.x / n, -1.0), side(-2.0 * at.y / n, 1.0)};
}

}  // namespace

Healpix::Healpix(int nside) : nside_(nside) {
  if (nside < 1 || nside > kLargestSide || !std::has_single_bit(static_cast<unsigned>(nside))) {
    throw ConfigurationError("nside " + std::to_string(nside) +
                             ": must be a power of two, at most " + std::to_string(kLargestSide));
  }
}

Healpix::Position Healpix::centre(std::int32_t pixel) const {
  const Place at = place_of(pixel, nside_);
  const double n = nside_;
  const double ring = kFaceRing[at.face] - (at.x + at.y + 1) / n;
  const double width = ring < 1.0 ? ring : ring > 3.0 ? 4.0 - ring : 1.0;
  const double sine = ring < 1.0   ? 1.0 - width * width / 3.0
                      : ring > 3.0 ? width * width / 3.0 - 1.0
                                   : (2.0 - ring) * 2.0 / 3.0;
  double longitude = kQuarter * (kFaceEighth[at.face] + (at.x - at.y) / n / width);
  if (longitude < 0.0) longitude += 8.0 * kQuarter;
  return {sine, longitude};
}

int Healpix::side_like(const Grid& planet) {
  // Pixels of 4 pi / 12 nside² sr, cells of (2 pi / nx)².
  const double like = planet.nx() / std::sqrt(12.0 * std::numbers::pi);
  int nside = 1;
  while (nside < kLargestSide && 2 * nside <= like) nside *= 2;
  return nside;
}

HealpixRemapping::HealpixRemapping(const Grid& planet, const Healpix& pixels)
    : pixels_(pixels), nx_(planet.nx()), ny_(planet.ny()) {
  if (planet.topology() != Topology::sphere) {
    throw InputError("HEALPix covers a whole planet, this grid is a part of one");
  }
  double below = 0.0;
  row_edge_.push_back(-1.0);
  for (int row = 0; row < ny_; ++row) {
    below += planet.area_m2(row) * nx_;
    row_edge_.push_back(row + 1 == ny_ ? 1.0 : 2.0 * below / planet.total_area_m2() - 1.0);
  }
}

/// Calls visit(cell, overlap) for all cells under a pixel; overlaps are in radians of longitude
/// times sine of latitude and add up to 4 pi over the count of pixels.
template <class Visit>
void HealpixRemapping::for_overlaps(std::int32_t pixel, const Visit& visit) const {
  const Place at = place_of(pixel, pixels_.nside());
  const double step = 8.0 * kQuarter / nx_;
  for (const bool upper : {false, true}) {
    const Half half = half_of(at, pixels_.nside(), upper);
    const auto above = std::upper_bound(row_edge_.begin(), row_edge_.end(), half.low);
    int row = std::clamp(static_cast<int>(above - row_edge_.begin()) - 1, 0, ny_ - 1);
    for (; row < ny_ && row_edge_[row] < half.high; ++row) {
      const double low = std::max(half.low, row_edge_[row]);
      const double high = std::min(half.high, row_edge_[row + 1]);
      if (!(low < high)) continue;
      const double west = std::min(half.left.longitude(low), half.left.longitude(high));
      const double east = std::max(half.right.longitude(low), half.right.longitude(high));
      // Columns begin at -180 degrees.
      const int first = static_cast<int>(std::floor((west + 4.0 * kQuarter) / step));
      const int last = static_cast<int>(std::ceil((east + 4.0 * kQuarter) / step));
      for (int k = first; k < last; ++k) {
        const double from = k * step - 4.0 * kQuarter, to = (k + 1) * step - 4.0 * kQuarter;
        const double overlap = integral_within(half.right, low, high, from, to) -
                               integral_within(half.left, low, high, from, to);
        if (overlap > 0.0) visit(row * nx_ + ((k % nx_) + nx_) % nx_, overlap);
      }
    }
  }
}

void HealpixRemapping::mean(std::span<const float> values, std::span<float> mean) const {
  check_sizes("HealpixRemapping", static_cast<std::size_t>(nx_) * ny_, {{"values", values.size()}});
  check_sizes("HealpixRemapping", pixels_.size(), {{"mean", mean.size()}});
#pragma omp parallel for schedule(dynamic, 4096)
  for (std::int32_t pixel = 0; pixel < pixels_.size(); ++pixel) {
    double sum = 0.0, weight = 0.0;
    for_overlaps(pixel, [&](Index cell, double overlap) {
      if (std::isnan(values[cell])) return;
      sum += overlap * values[cell];
      weight += overlap;
    });
    mean[pixel] =
        weight > 0.0 ? static_cast<float>(sum / weight) : std::numeric_limits<float>::quiet_NaN();
  }
}

void HealpixRemapping::dominant(std::span<const std::int32_t> values,
                                std::span<std::int32_t> result) const {
  check_sizes("HealpixRemapping", static_cast<std::size_t>(nx_) * ny_, {{"values", values.size()}});
  check_sizes("HealpixRemapping", pixels_.size(), {{"result", result.size()}});
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 4096)
  for (std::int32_t pixel = 0; pixel < pixels_.size(); ++pixel) {
    errors.guard([&] {
      std::vector<std::pair<std::int32_t, double>> shares;
      for_overlaps(pixel, [&](Index cell, double overlap) {
        for (auto& [value, share] : shares) {
          if (value == values[cell]) {
            share += overlap;
            return;
          }
        }
        shares.emplace_back(values[cell], overlap);
      });
      std::sort(shares.begin(), shares.end());
      const auto most =
          std::max_element(shares.begin(), shares.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      result[pixel] = most->first;
    });
  }
  errors.rethrow();
}

}  // namespace geo
