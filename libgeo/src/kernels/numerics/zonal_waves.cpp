#include "zonal_waves.hpp"

#include <cmath>
#include <numbers>

namespace geo {

ZonalWaves::ZonalWaves(const Grid& grid)
    : grid_(grid),
      basis_(std::size_t(grid.nx()) * kSeries),
      amplitude_(std::size_t(grid.ny()) * kSeries, 0.0) {
  const int nx = grid.nx();
  for (int m = 1; m <= kWaves; ++m) {
    for (int i = 0; i < nx; ++i) {
      const double angle = 2.0 * std::numbers::pi * m * i / nx;
      basis_[std::size_t(2 * m - 2) * nx + i] = std::cos(angle);
      basis_[std::size_t(2 * m - 1) * nx + i] = std::sin(angle);
    }
  }
}

template <class Real>
void ZonalWaves::take_from(std::span<Real> field) {
  const int nx = grid_.nx();
#pragma omp parallel for schedule(static) if (grid_.size() > 16384)
  for (int j = 0; j < grid_.ny(); ++j) {
    Real* row = &field[std::size_t(j) * nx];
    double sum[kSeries] = {};
    for (int i = 0; i < nx; ++i) {
      for (int s = 0; s < kSeries; ++s) sum[s] += row[i] * basis_[std::size_t(s) * nx + i];
    }
    double* amplitude = &amplitude_[std::size_t(j) * kSeries];
    for (int s = 0; s < kSeries; ++s) {
      // Rows of few cells do not resolve every wave.
      const bool resolved = 2 * (s / 2 + 1) < nx;
      amplitude[s] = resolved ? 2.0 * sum[s] / nx : 0.0;
    }
    for (int i = 0; i < nx; ++i) {
      double wave = 0.0;
      for (int s = 0; s < kSeries; ++s) wave += amplitude[s] * basis_[std::size_t(s) * nx + i];
      row[i] = static_cast<Real>(row[i] - wave);
    }
  }
}

void ZonalWaves::solve(double strength_m2) {
  const int ny = grid_.ny();
  std::vector<double> factor(ny);
  for (int s = 0; s < kSeries; ++s) {
    const double angle = 2.0 * std::numbers::pi * (s / 2 + 1) / grid_.nx();
    const double curvature = 2.0 - 2.0 * std::cos(angle);  // of the difference along a row
    for (int j = 0; j < ny; ++j) {
      const double per_area = strength_m2 / grid_.area_m2(j);
      const double south = grid_.face_north_m(j - 1) / (j > 0 ? grid_.spacing_north_m(j - 1) : 1.0);
      const double north = grid_.face_north_m(j) / grid_.spacing_north_m(j);
      const double along = grid_.face_east_m(j) / grid_.spacing_east_m(j) * curvature;
      double diagonal = 1.0 + per_area * (south + north + along);
      double& here = amplitude_[std::size_t(j) * kSeries + s];
      if (j > 0) {
        diagonal -= per_area * south * factor[j - 1];
        here += per_area * south * amplitude_[std::size_t(j - 1) * kSeries + s];
      }
      here /= diagonal;
      factor[j] = per_area * north / diagonal;
    }
    for (int j = ny - 2; j >= 0; --j) {
      amplitude_[std::size_t(j) * kSeries + s] +=
          factor[j] * amplitude_[std::size_t(j + 1) * kSeries + s];
    }
  }
}

void ZonalWaves::solve_second_order(double strength_m2) {
  solve(strength_m2);
  const std::vector<double> first = amplitude_;
  solve(strength_m2);
  for (std::size_t i = 0; i < first.size(); ++i) {
    amplitude_[i] += std::numbers::sqrt2 * (amplitude_[i] - first[i]);
  }
}

template <class Real>
void ZonalWaves::return_to(std::span<Real> field) const {
  const int nx = grid_.nx();
#pragma omp parallel for schedule(static) if (grid_.size() > 16384)
  for (int j = 0; j < grid_.ny(); ++j) {
    Real* row = &field[std::size_t(j) * nx];
    const double* amplitude = &amplitude_[std::size_t(j) * kSeries];
    for (int i = 0; i < nx; ++i) {
      double wave = 0.0;
      for (int s = 0; s < kSeries; ++s) wave += amplitude[s] * basis_[std::size_t(s) * nx + i];
      row[i] = static_cast<Real>(row[i] + wave);
    }
  }
}

template void ZonalWaves::take_from<float>(std::span<float>);
template void ZonalWaves::take_from<double>(std::span<double>);
template void ZonalWaves::return_to<float>(std::span<float>) const;
template void ZonalWaves::return_to<double>(std::span<double>) const;

}  // namespace geo
