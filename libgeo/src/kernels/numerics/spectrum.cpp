#include "geo/kernels/numerics/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/kernels/numerics/regression.hpp"

namespace geo {
namespace {

/// Fourier coefficients of every row up to an order, as means over the row.
std::vector<std::complex<double>> row_transforms(const Grid& grid, std::span<const float> field,
                                                 int orders) {
  const int nx = grid.nx(), ny = grid.ny();
  std::vector<std::complex<double>> turn(nx);
  for (int i = 0; i < nx; ++i) turn[i] = std::polar(1.0 / nx, -2.0 * std::numbers::pi * i / nx);
  std::vector<std::complex<double>> transforms(static_cast<std::size_t>(ny) * orders);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < ny; ++j) {
    for (int m = 0; m < orders; ++m) {
      double real = 0.0, imaginary = 0.0;
      for (int i = 0, angle = 0; i < nx; ++i) {
        const double value = field[grid.cell(i, j)];
        real += value * turn[angle].real();
        imaginary += value * turn[angle].imag();
        angle += m;
        if (angle >= nx) angle -= nx;
      }
      transforms[static_cast<std::size_t>(j) * orders + m] = {real, imaginary};
    }
  }
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
  // Harmonics of order m from P_mm upwards in degree (Holmes & Featherstone 2002), mean square 1.
  std::vector<double> sectoral(ny, 1.0), below(ny), here(ny);
  for (int m = 0; m < orders; ++m) {
    if (m > 0) {
      const double factor = m == 1 ? std::sqrt(3.0) : std::sqrt((2.0 * m + 1.0) / (2.0 * m));
      for (int j = 0; j < ny; ++j) sectoral[j] *= factor * cosine[j];
    }
    here = sectoral;
    std::fill(below.begin(), below.end(), 0.0);
    for (int l = m; l < orders; ++l) {
      std::complex<double> coefficient = 0.0;
      for (int j = 0; j < ny; ++j) {
        coefficient += weight[j] * here[j] * transforms[static_cast<std::size_t>(j) * orders + m];
      }
      // The real harmonics' sqrt(2) is in P_lm: cosine and sine parts add up to |c|^2.
      power[l] += std::norm(coefficient);
      const double a =
          std::sqrt((2.0 * l + 1.0) * (2.0 * l + 3.0) / ((l + 1.0 - m) * (l + 1.0 + m)));
      const double b = l == m ? 0.0
                              : std::sqrt((2.0 * l + 3.0) * (l + m) * (l - m) /
                                          ((2.0 * l - 1.0) * (l + 1.0 - m) * (l + 1.0 + m)));
      for (int j = 0; j < ny; ++j) {
        const double next = a * sine[j] * here[j] - b * below[j];
        below[j] = here[j];
        here[j] = next;
      }
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
