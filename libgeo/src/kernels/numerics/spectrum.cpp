#include "geo/kernels/numerics/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/numerics/regression.hpp"
#include "legendre.hpp"

namespace geo {
namespace {

/// Fourier coefficients of every row up to an order, as means over the row.
std::vector<std::complex<double>> row_transforms(const Grid& grid, std::span<const float> field,
                                                 int orders) {
  const int nx = grid.nx(), ny = grid.ny();
  std::vector<std::complex<double>> transforms(static_cast<std::size_t>(ny) * orders);
  ParallelErrors errors;
#pragma omp parallel
  {
    Eigen::FFT<double> fft;
    std::vector<double> row;
    std::vector<std::complex<double>> transform;
#pragma omp for schedule(static)
    for (int j = 0; j < ny; ++j) {
      errors.guard([&] {
        const auto values = field.subspan(grid.cell(0, j), nx);
        row.assign(values.begin(), values.end());
        fft.fwd(transform, row);
        for (int m = 0; m < orders; ++m) {
          transforms[static_cast<std::size_t>(j) * orders + m] =
              transform[m % nx] / static_cast<double>(nx);
        }
      });
    }
  }
  errors.rethrow();
  return transforms;
}

}  // namespace

std::vector<double> harmonic_power(const Grid& grid, std::span<const float> field, int max_degree) {
  if (grid.topology() != Topology::sphere || max_degree < 0 || grid.ny() < 2 * max_degree ||
      field.size() != static_cast<std::size_t>(grid.size())) {
    throw InputError("spectrum: needs a whole planet with at least two rows per degree, got " +
                     std::to_string(grid.ny()) + " rows and " + std::to_string(field.size()) +
                     " values for degree " + std::to_string(max_degree));
  }
  const int orders = max_degree + 1, ny = grid.ny();
  const auto transforms = row_transforms(grid, field, orders);
  std::vector<double> sine(ny), cosine(ny), weight(ny);
  for (int j = 0; j < ny; ++j) {
    const double latitude = grid.latitude_deg(j) * std::numbers::pi / 180.0;
    sine[j] = std::sin(latitude);
    cosine[j] = std::cos(latitude);
    weight[j] = grid.area_m2(j) * grid.nx() / grid.total_area_m2();
  }
  std::vector<double> power(orders, 0.0);
  for (int m = 0; m < orders; ++m) {
    LegendreOrder legendre(m, sine, cosine);
    for (int l = m; l < orders; ++l) {
      if (l > m) legendre.next();
      const std::vector<double>& p = legendre.values();
      std::complex<double> coefficient = 0.0;
      for (int j = 0; j < ny; ++j) {
        coefficient += weight[j] * p[j] * transforms[static_cast<std::size_t>(j) * orders + m];
      }
      // Orders m and -m.
      power[l] += (m == 0 ? 1.0 : 2.0) * std::norm(coefficient);
    }
  }
  return power;
}

double spectral_slope(std::span<const double> power, int first_degree, int last_degree) {
  std::vector<double> degrees, powers;
  for (int low = first_degree; low <= last_degree;) {
    const int high = std::min({2 * low, last_degree + 1, static_cast<int>(power.size())});
    if (high <= low) break;
    double sum = 0.0, degree = 0.0;
    for (int l = low; l < high; ++l) {
      if (!(power[l] > 0.0)) return std::numeric_limits<double>::quiet_NaN();
      sum += std::log(power[l]);
      degree += std::log(static_cast<double>(l));
    }
    powers.push_back(sum / (high - low));
    degrees.push_back(degree / (high - low));
    low = high;
  }
  return regression_slope(degrees, powers);
}

}  // namespace geo
