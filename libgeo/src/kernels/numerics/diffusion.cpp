#include "geo/kernels/numerics/diffusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "tridiagonal.hpp"
#include "zonal_waves.hpp"

namespace geo {
namespace {

constexpr int kLanes = TridiagonalBlock::kLanes;  // rows or columns solved side by side
constexpr int kPanel = 2 * kLanes;                // columns read side by side: a line of the cache
constexpr int kBand = 64;                         // columns that exchange side by side
constexpr double kGamma = 1.0 - 1.0 / std::numbers::sqrt2;
// Exchange per step with one neighbour below which forward Euler does what backward Euler does:
// they differ by its square, and neither leaves the range of the field.
constexpr double kWeak = 0.01;

// Rows and columns of one diffusion problem, cut into directions.
template <class Real>
class SplitDiffusion {
 public:
  SplitDiffusion(const Grid& grid, std::span<Real> field, double diffusivity_m2_yr,
                 const DiffusionOptions& options)
      : grid_(grid), field_(field), diffusivity_m2_yr_(diffusivity_m2_yr), options_(options) {}

  void solve_rows(double dt_yr) {
    const int nx = grid_.nx();
    const bool periodic = grid_.topology() != Topology::plane;
    const double strength = stage_strength(dt_yr);
    std::vector<int> weak, strong;
    for (int row = 0; row < grid_.ny(); ++row) {
      (is_weak_along_row(row, strength) ? weak : strong).push_back(row);
    }
    const int count = static_cast<int>(strong.size());
    ParallelErrors errors;
#pragma omp parallel if (worth_threads())
    {
#pragma omp for schedule(static) nowait
      for (std::size_t r = 0; r < weak.size(); ++r) exchange_along_row(weak[r], strength);
      const bool uniform = periodic && !has_marks();
      auto made =
          errors.make<TridiagonalBlock>(nx, periodic, uniform ? Couplings::lanes : Couplings::all);
      auto value = errors.make<std::vector<double>>(std::size_t(nx) * kLanes);
      auto stage = errors.make<std::vector<double>>(value.size());
#pragma omp for schedule(static)
      for (int first = 0; first < count; first += kLanes) {
        if (errors.any()) continue;
        TridiagonalBlock& system = *made;
        std::array<int, kLanes> row;  // behind the last it is written again, alike
        std::array<Real*, kLanes> z;
        for (int k = 0; k < kLanes; ++k) {
          row[k] = strong[std::min(first + k, count - 1)];
          z[k] = &field_[std::size_t(row[k]) * nx];
        }
        couple_rows(system, row, strength);
        for (int i = 0; i < nx; ++i) {
          for (int k = 0; k < kLanes; ++k) value[i * kLanes + k] = z[k][i];
        }
        step(system, value, stage);
        for (int i = 0; i < nx; ++i) {
          for (int k = 0; k < kLanes; ++k) z[k][i] = static_cast<Real>(value[i * kLanes + k]);
        }
      }
    }
    errors.rethrow();
  }

  void solve_columns(double dt_yr) {
    const int nx = grid_.nx(), ny = grid_.ny(), panels = (nx + kPanel - 1) / kPanel;
    const bool periodic = grid_.topology() == Topology::torus;
    const double strength = stage_strength(dt_yr);
    if (is_weak_along_columns(strength)) return exchange_along_columns(strength);
    ParallelErrors errors;
#pragma omp parallel if (worth_threads())
    {
      const bool alike = !periodic && !has_marks();
      auto made =
          errors.make<TridiagonalBlock>(ny, periodic, alike ? Couplings::unknowns : Couplings::all);
      const std::size_t block = std::size_t(ny) * kLanes;
      auto values = errors.make<std::vector<double>>(kPanel / kLanes * block);
      auto stage = errors.make<std::vector<double>>(block);
      const auto value = [&](int k) { return &values[k / kLanes * block + k % kLanes]; };
      // Without marked cells all columns are one and the same system.
      errors.guard([&] {
        if (!has_marks()) couple_columns(*made, 0, strength);
      });
#pragma omp for schedule(static)
      for (int p = 0; p < panels; ++p) {
        if (errors.any()) continue;
        TridiagonalBlock& system = *made;
        const int column = p * kPanel, width = std::min(kPanel, nx - column);
        for (int j = 0; j < ny; ++j) {
          const Real* from = &field_[std::size_t(j) * nx + column];
          for (int k = 0; k < width; ++k) value(k)[std::size_t(j) * kLanes] = from[k];
        }
        for (int k = 0; k < width; k += kLanes) {
          if (has_marks()) couple_columns(system, column + k, strength);
          step(system, {value(k), block}, stage);
        }
        for (int j = 0; j < ny; ++j) {
          Real* to = &field_[std::size_t(j) * nx + column];
          for (int k = 0; k < width; ++k) {
            to[k] = static_cast<Real>(value(k)[std::size_t(j) * kLanes]);
          }
        }
      }
    }
    errors.rethrow();
  }

 private:
  // Waking threads takes longer than a small grid.
  [[nodiscard]] bool worth_threads() const { return grid_.size() > 16384; }

  [[nodiscard]] bool has_marks() const {
    return !options_.fixed.empty() || !options_.excluded.empty();
  }

  [[nodiscard]] double stage_strength(double dt_yr) const {
    const bool second = options_.scheme == DiffusionScheme::second_order;
    return (second ? kGamma : 1.0) * diffusivity_m2_yr_ * dt_yr;
  }

  [[nodiscard]] double coupling_east(int row, double strength) const {
    return strength * grid_.face_east_m(row) / (grid_.spacing_east_m(row) * grid_.area_m2(row));
  }
  /// Couplings of a row to those south and north of it.
  [[nodiscard]] std::array<double, 2> couplings_north(int row, double strength) const {
    const int south = row > 0 ? row - 1 : grid_.ny() - 1;
    const double per_area = strength / grid_.area_m2(row);
    return {per_area * grid_.face_north_m(row - 1) / grid_.spacing_north_m(south),
            per_area * grid_.face_north_m(row) / grid_.spacing_north_m(row)};
  }

  [[nodiscard]] bool may_be_explicit() const {
    return options_.scheme == DiffusionScheme::positive && grid_.topology() != Topology::torus &&
           options_.excluded.empty();
  }
  [[nodiscard]] bool is_weak_along_row(int row, double strength) const {
    constexpr double kTimes = 2.0;  // that rows exchange in a step: before the columns and after
    return may_be_explicit() && kTimes * coupling_east(row, strength) < kWeak;
  }
  [[nodiscard]] bool is_weak_along_columns(double strength) const {
    if (!may_be_explicit()) return false;
    double most = 0.0;
    for (int row = 0; row < grid_.ny(); ++row) {
      const auto [down, up] = couplings_north(row, strength);
      most = std::max({most, down, up});
    }
    return most < kWeak;
  }
  [[nodiscard]] bool is_fixed(std::size_t cell) const {
    return !options_.fixed.empty() && options_.fixed[cell] != 0;
  }

  void exchange_along_row(int row, double strength) {
    const int nx = grid_.nx();
    const bool periodic = grid_.topology() == Topology::sphere;
    const double coupling = coupling_east(row, strength);
    const std::size_t begin = std::size_t(row) * nx;
    Real* z = &field_[begin];
    const double first = z[0];
    double west = periodic ? z[nx - 1] : z[0];
    for (int i = 0; i < nx; ++i) {
      const double here = z[i];
      const double east = i + 1 < nx ? z[i + 1] : (periodic ? first : here);
      if (!is_fixed(begin + i))
        z[i] = static_cast<Real>(here + coupling * (west + east - 2.0 * here));
      west = here;
    }
  }

  void exchange_along_columns(double strength) {
    const int nx = grid_.nx(), ny = grid_.ny(), blocks = (nx + kBand - 1) / kBand;
#pragma omp parallel for schedule(static) if (worth_threads())
    for (int b = 0; b < blocks; ++b) {
      const int column = b * kBand, width = std::min(kBand, nx - column);
      double south[kBand];  // as it was
      std::copy_n(&field_[column], width, south);
      for (int j = 0; j < ny; ++j) {
        const auto [down, up] = couplings_north(j, strength);
        const std::size_t begin = std::size_t(j) * nx + column;
        const std::size_t above = j + 1 < ny ? begin + nx : begin;
        for (int k = 0; k < width; ++k) {
          const double here = field_[begin + k], north = field_[above + k];
          const double change = down * (south[k] - here) + up * (north - here);
          if (!is_fixed(begin + k)) field_[begin + k] = static_cast<Real>(here + change);
          south[k] = here;
        }
      }
    }
  }

  // Whether `cell` reacts to `neighbour`.
  [[nodiscard]] bool coupled(std::size_t cell, std::size_t neighbour) const {
    if (!options_.fixed.empty() && options_.fixed[cell] != 0) return false;
    if (options_.excluded.empty()) return true;
    return options_.excluded[cell] == 0 && options_.excluded[neighbour] == 0;
  }

  void couple_rows(TridiagonalBlock& system, const std::array<int, kLanes>& row,
                   double strength) const {
    const int nx = grid_.nx();
    const bool periodic = grid_.topology() != Topology::plane;
    double coupling[kLanes];
    for (int k = 0; k < kLanes; ++k) coupling[k] = coupling_east(row[k], strength);
    const bool uniform = periodic && !has_marks();
    for (int i = 0; i < (uniform ? 1 : nx); ++i) {
      const int west = i > 0 ? i - 1 : nx - 1, east = i < nx - 1 ? i + 1 : 0;
      double* lower = system.lower(i);
      double* upper = system.upper(i);
      for (int k = 0; k < kLanes; ++k) lower[k] = upper[k] = coupling[k];
      if (has_marks()) {
        for (int k = 0; k < kLanes; ++k) {
          const std::size_t begin = std::size_t(row[k]) * nx;
          if (!coupled(begin + i, begin + west)) lower[k] = 0.0;
          if (!coupled(begin + i, begin + east)) upper[k] = 0.0;
        }
      }
    }
    if (!periodic) {
      std::fill_n(system.lower(0), kLanes, 0.0);
      std::fill_n(system.upper(nx - 1), kLanes, 0.0);
    }
    system.factorise();
  }

  void couple_columns(TridiagonalBlock& system, int first_column, double strength) const {
    const int nx = grid_.nx(), ny = grid_.ny();
    const bool periodic = grid_.topology() == Topology::torus;
    const int lanes = periodic || has_marks() ? kLanes : 1;
    for (int j = 0; j < ny; ++j) {
      const int south = j > 0 ? j - 1 : ny - 1, north = j < ny - 1 ? j + 1 : 0;
      const auto [down, up] = couplings_north(j, strength);
      double* lower = system.lower(j);
      double* upper = system.upper(j);
      for (int k = 0; k < lanes; ++k) {
        lower[k] = down;
        upper[k] = up;
      }
      if (has_marks()) {
        for (int k = 0; k < kLanes; ++k) {
          const std::size_t i = std::min(first_column + k, nx - 1);
          const std::size_t here = std::size_t(j) * nx + i;
          if (!coupled(here, std::size_t(south) * nx + i)) lower[k] = 0.0;
          if (!coupled(here, std::size_t(north) * nx + i)) upper[k] = 0.0;
        }
      }
    }
    if (!periodic) {
      std::fill_n(system.lower(0), lanes, 0.0);
      std::fill_n(system.upper(ny - 1), lanes, 0.0);
    }
    system.factorise();
  }

  void step(const TridiagonalBlock& system, std::span<double> value,
            std::vector<double>& stage) const {
    system.solve(value.data());
    if (options_.scheme == DiffusionScheme::positive) return;
    system.solve(value.data(), stage.data());
    // The weights sum to 1, which keeps constants and mass.
    for (std::size_t i = 0; i < value.size(); ++i) {
      value[i] = stage[i] + std::numbers::sqrt2 * (stage[i] - value[i]);
    }
  }

  const Grid& grid_;
  std::span<Real> field_;
  double diffusivity_m2_yr_;
  const DiffusionOptions& options_;
};

// One step reverses no wave of the grid while it carries less than about a cell, and four make a
// clean bell of a point. Where meridians converge, rows and columns do not commute: there a step
// should not carry further than the distance of the nearest row from the pole, which is half a cell
// on a sphere; with the longest zonal waves apart four steps do nevertheless.
int choose_substeps(const Grid& grid, double variance_m2, bool waves_apart) {
  const double spread_m = std::sqrt(variance_m2);
  const int middle = grid.ny() / 2;
  const double cell_m = std::min(grid.face_east_m(middle), grid.spacing_east_m(middle));
  const double wanted = std::clamp(std::ceil(spread_m / cell_m), 1.0, 4.0);
  if (!grid.is_latitude_longitude()) return static_cast<int>(wanted);
  const double dlon_deg = (grid.window().east_deg - grid.window().west_deg) / grid.nx();
  const double polar_radius_m =
      std::min(grid.spacing_east_m(0), grid.spacing_east_m(grid.ny() - 1)) /
      (dlon_deg * std::numbers::pi / 180.0);
  const double most = waves_apart ? 4.0 : 8.0;
  return static_cast<int>(std::clamp(std::ceil(spread_m / polar_radius_m), wanted, most));
}

void check(const Grid& grid, std::size_t field_size, double diffusivity_m2_yr, double dt_yr,
           const DiffusionOptions& options) {
  const auto cells = static_cast<std::size_t>(grid.size());
  const auto fits = [cells](std::size_t size) { return size == 0 || size == cells; };
  if (field_size != cells || !fits(options.fixed.size()) || !fits(options.excluded.size())) {
    throw InputError("diffusion: field and masks must have " + std::to_string(cells) + " cells");
  }
  const double product = diffusivity_m2_yr * dt_yr;
  if (!(diffusivity_m2_yr >= 0.0 && dt_yr >= 0.0 && std::isfinite(product))) {
    throw InputError("diffusion: diffusivity and time step must be finite and not negative");
  }
}

template <class Real>
void diffuse_in(const Grid& grid, std::span<Real> field, double diffusivity_m2_yr, double dt_yr,
                const DiffusionOptions& options) {
  check(grid, field.size(), diffusivity_m2_yr, dt_yr, options);
  if (diffusivity_m2_yr * dt_yr == 0.0) return;
  const bool waves_apart =
      grid.topology() == Topology::sphere && options.fixed.empty() && options.excluded.empty();
  const int steps = options.substeps > 0
                        ? options.substeps
                        : choose_substeps(grid, 2.0 * diffusivity_m2_yr * dt_yr, waves_apart);
  const double step_yr = dt_yr / steps;

  std::optional<ZonalWaves> waves;
  if (waves_apart) {
    waves.emplace(grid);
    waves->take_from(field);
    for (int s = 0; s < steps; ++s) {
      if (options.scheme == DiffusionScheme::positive) {
        waves->solve(diffusivity_m2_yr * step_yr);
      } else {
        waves->solve_second_order(kGamma * diffusivity_m2_yr * step_yr);
      }
    }
  }
  SplitDiffusion<Real> diffusion(grid, field, diffusivity_m2_yr, options);
  diffusion.solve_rows(0.5 * step_yr);
  for (int s = 0; s < steps; ++s) {
    diffusion.solve_columns(step_yr);
    // Half-steps of rows that follow each other are one.
    diffusion.solve_rows(s + 1 < steps ? step_yr : 0.5 * step_yr);
  }
  if (waves) waves->return_to(field);
}

}  // namespace

void diffuse(const Grid& grid, std::span<float> field, double diffusivity_m2_yr, double dt_yr,
             const DiffusionOptions& options) {
  diffuse_in(grid, field, diffusivity_m2_yr, dt_yr, options);
}
void diffuse(const Grid& grid, std::span<double> field, double diffusivity_m2_yr, double dt_yr,
             const DiffusionOptions& options) {
  diffuse_in(grid, field, diffusivity_m2_yr, dt_yr, options);
}

}  // namespace geo
