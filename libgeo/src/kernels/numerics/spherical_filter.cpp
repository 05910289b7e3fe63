#include "geo/kernels/numerics/spherical_filter.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "legendre.hpp"

namespace geo {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;

/// Weights of Fejér's first rule at the mid-points of ny equal steps of colatitude; they sum to 2.
std::vector<double> fejer_weights(int ny) {
  std::vector<double> weight(ny);
  for (int j = 0; j < ny; ++j) {
    const double theta = (j + 0.5) * kPi / ny;
    double sum = 1.0;
    for (int k = 1; 2 * k < ny; ++k) {
      sum -= 2.0 * std::cos(2.0 * k * theta) / (4.0 * k * k - 1.0);
    }
    weight[j] = 2.0 / ny * sum;
  }
  return weight;
}

/// Parts of one order along the meridian that are even and odd about the equator, and back.
struct Meridian {
  std::vector<double> even_re, even_im, odd_re, odd_im;
  explicit Meridian(std::size_t half) : even_re(half), even_im(half), odd_re(half), odd_im(half) {}
};

void filter_order(int order, std::span<Complex> column, std::span<const double> gain,
                  const std::vector<double>& weight, const std::vector<double>& sine,
                  const std::vector<double>& cosine) {
  const std::size_t ny = column.size(), half = sine.size();
  Meridian in(half), out(half);
  for (std::size_t j = 0; j < half; ++j) {
    const std::size_t mirror = ny - 1 - j;
    // The equator's own row, where there is one, is its own mirror image.
    const double w = 0.5 * weight[j] * (mirror == j ? 0.5 : 1.0);
    const Complex even = w * (column[j] + column[mirror]), odd = w * (column[j] - column[mirror]);
    in.even_re[j] = even.real(), in.even_im[j] = even.imag();
    in.odd_re[j] = odd.real(), in.odd_im[j] = odd.imag();
  }
  LegendreOrder legendre(order, sine, cosine);
  for (int l = order; l < static_cast<int>(gain.size()); ++l) {
    if (l > order) legendre.next();
    const std::vector<double>& p = legendre.values();
    const bool even = (l - order) % 2 == 0;
    const auto& re = even ? in.even_re : in.odd_re;
    const auto& im = even ? in.even_im : in.odd_im;
    double a = 0.0, b = 0.0;
    for (std::size_t j = 0; j < half; ++j) {
      a += p[j] * re[j];
      b += p[j] * im[j];
    }
    a *= gain[l], b *= gain[l];
    auto& to_re = even ? out.even_re : out.odd_re;
    auto& to_im = even ? out.even_im : out.odd_im;
    for (std::size_t j = 0; j < half; ++j) {
      to_re[j] += a * p[j];
      to_im[j] += b * p[j];
    }
  }
  for (std::size_t j = 0; j < half; ++j) {
    const Complex even{out.even_re[j], out.even_im[j]}, odd{out.odd_re[j], out.odd_im[j]};
    column[ny - 1 - j] = even - odd;
    column[j] = even + odd;
  }
}

template <class Real>
void filter_degrees_in(const Grid& grid, std::span<Real> field, std::span<const double> gain) {
  const int nx = grid.nx(), ny = grid.ny(), orders = static_cast<int>(gain.size());
  if (grid.topology() != Topology::sphere) {
    throw InputError("spherical filter: the grid must be a whole sphere");
  }
  if (field.size() != static_cast<std::size_t>(grid.size())) {
    throw InputError("spherical filter: the field must have one value per cell");
  }
  if (orders > ny || orders > nx / 2) {
    throw InputError("spherical filter: " + std::to_string(orders) +
                     " degrees need a grid of as many rows and twice as many columns");
  }
  const int half = (ny + 1) / 2;
  std::vector<double> sine(half), cosine(half);
  for (int j = 0; j < half; ++j) {
    sine[j] = -std::cos((j + 0.5) * kPi / ny);
    cosine[j] = std::sin((j + 0.5) * kPi / ny);
  }
  const std::vector<double> weight = fejer_weights(ny);
  std::vector<Complex> spectrum(static_cast<std::size_t>(orders) * ny);
  ParallelErrors errors;
#pragma omp parallel
  {
    Eigen::FFT<double> fourier;
    fourier.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    auto row = errors.make<std::vector<double>>(nx);
    auto waves = errors.make<std::vector<Complex>>(nx / 2 + 1);
#pragma omp for schedule(static)
    for (int j = 0; j < ny; ++j) {
      errors.guard([&] {
        for (int i = 0; i < nx; ++i) row[i] = field[grid.cell(i, j)];
        fourier.fwd(waves.data(), row.data(), nx);
        for (int m = 0; m < orders; ++m) spectrum[static_cast<std::size_t>(m) * ny + j] = waves[m];
      });
    }
#pragma omp for schedule(dynamic, 1)
    for (int m = 0; m < orders; ++m) {
      errors.guard([&] {
        filter_order(m, std::span(spectrum).subspan(static_cast<std::size_t>(m) * ny, ny), gain,
                     weight, sine, cosine);
      });
    }
#pragma omp for schedule(static)
    for (int j = 0; j < ny; ++j) {
      errors.guard([&] {
        std::fill(waves.begin(), waves.end(), Complex{});
        for (int m = 0; m < orders; ++m) waves[m] = spectrum[static_cast<std::size_t>(m) * ny + j];
        fourier.inv(row.data(), waves.data(), nx);
        for (int i = 0; i < nx; ++i) field[grid.cell(i, j)] = static_cast<Real>(row[i]);
      });
    }
  }
  errors.rethrow();
}

}  // namespace

void filter_degrees(const Grid& grid, std::span<float> field, std::span<const double> gain) {
  filter_degrees_in(grid, field, gain);
}
void filter_degrees(const Grid& grid, std::span<double> field, std::span<const double> gain) {
  filter_degrees_in(grid, field, gain);
}

}  // namespace geo
