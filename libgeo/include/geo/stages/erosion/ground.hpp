#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/numeric.hpp"
#include "geo/core/parameter.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/kernels/water/valley_width.hpp"
#include "geo/stages/erosion/erosion.hpp"

namespace geo {

/// By how much faster than the rates of uplift say plates of this run raise the ground
/// (speed_factor of Tectonica blueprint 4.5): their speed over `uplift_speed_cm_yr`; 1 without one,
/// and where no plates stand in the run's configuration.
[[nodiscard]] inline double speed_factor(const ErosionParameters& p,
                                         std::span<const Parameter> run) {
  const Parameter* speed = find_parameter(run, "plates.speed_cm_yr");
  if (p.uplift_speed_cm_yr <= 0.0 || speed == nullptr) return 1.0;
  return std::get<double>(speed->value()) / p.uplift_speed_cm_yr;
}

/// Rock uplift over the belts of deformation (Tectonica blueprint 4.5), m yr-1, added to a field.
/// `faster`: speed_factor.
template <class V>
void add_belt_uplift(const ErosionParameters& p, const ActiveVariables<V>& active,
                     std::span<const V> convergent, std::span<const V> divergent,
                     std::span<const V> transform, double faster, std::span<V> uplift_m_yr) {
  // Where belts grow by shortening, that raises them.
  const V closing(p.uplift_from == "shortening"
                      ? Arithmetic<V>(0.0)
                      : Arithmetic<V>(1e-3 * faster * active(p.convergent_uplift_mm_yr)));
  const V opening(1e-3 * faster * active(p.divergent_uplift_mm_yr));
  const V shearing(1e-3 * faster * active(p.transform_uplift_mm_yr));
#pragma omp parallel for schedule(static)
  for (std::size_t cell = 0; cell < uplift_m_yr.size(); ++cell) {
    uplift_m_yr[cell] +=
        closing * convergent[cell] + opening * divergent[cell] + shearing * transform[cell];
  }
}

/// Rock uplift on the cells of plate boundaries alone, m yr-1, added to a field. `faster`:
/// speed_factor.
template <class V>
void add_boundary_uplift(const ErosionParameters& p, const ActiveVariables<V>& active,
                         std::span<const std::int8_t> type, std::span<const float> strength,
                         double faster, std::span<V> uplift_m_yr) {
  const std::array<V, 4> rate{V(0.0F), V(1e-3 * faster * active(p.convergent_uplift_mm_yr)),
                              V(1e-3 * faster * active(p.divergent_uplift_mm_yr)),
                              V(1e-3 * faster * active(p.transform_uplift_mm_yr))};
#pragma omp parallel for schedule(static)
  for (std::size_t cell = 0; cell < uplift_m_yr.size(); ++cell) {
    uplift_m_yr[cell] += rate[type[cell]] * V(strength[cell]);
  }
}

/// How long belts grow by shortening while the landscape runs, Myr.
template <class V>
Arithmetic<V> growth_of_belts_myr(const ErosionParameters& p, const ActiveVariables<V>& active) {
  if (p.uplift_from != "shortening") return Arithmetic<V>(0.0);
  return (1e-6 * static_cast<double>(p.steps)) * active(p.time_step_yr);
}

/// Surface uplift by crust that shortening thickens, m yr-1, added to a field: what is added stands
/// on top, and its weight sinks as that of any load does (`rebound_fraction`), over the width in
/// which the plate spreads it: dz/dt = dh/dt - (rho_c / rho_m) F dh/dt. In front of a belt that is
/// negative: a foredeep.
template <class V>
void add_thickening_uplift(const ErosionParameters& p, const ActiveVariables<V>& active,
                           const Grid& grid, std::span<const V> thickening_m_yr,
                           std::span<V> uplift_m_yr) {
  std::vector<V> sinking(thickening_m_yr.begin(), thickening_m_yr.end());
  if (p.rebound_length_km > 0.0) {
    apply_linear<V, 1>(std::span<V>(sinking), {1000.0 * active(p.rebound_length_km)},
                       [&](auto values, const std::array<double, 1>& length_m) {
                         smooth_broadly(grid, values, length_m[0]);
                       });
  }
  const V share(active(p.rebound_fraction));
#pragma omp parallel for schedule(static)
  for (std::size_t cell = 0; cell < uplift_m_yr.size(); ++cell) {
    uplift_m_yr[cell] += thickening_m_yr[cell] - share * sinking[cell];
  }
}

/// Rock that shortening has folded and broken is more erodible (Molnar et al. 2007):
/// K = K0 (1 + damage e), e the strain of the run, thickening over the crust of `kWhole_m`.
template <class V>
void break_rock(const ErosionParameters& p, const ActiveVariables<V>& active,
                std::span<const V> thickening_m_yr, std::span<V> erodibility) {
  constexpr double kWhole_m = 35e3;
  const V per_rate(active(p.damage) * (1e6 / kWhole_m) * growth_of_belts_myr<V>(p, active));
#pragma omp parallel for schedule(static)
  for (std::size_t cell = 0; cell < erodibility.size(); ++cell) {
    erodibility[cell] *= V(1.0F) + per_rate * thickening_m_yr[cell];
  }
}

/// Erodibility for the cells of this grid; `given` has one value per cell or none at all. A cell's
/// own hillslopes and headwaters rise above its outlet by a height that grows with its size; a grid
/// of larger cells lacks it, so its rivers must be steeper by as much for the mean height of the
/// land to be the same.
template <class V>
std::vector<V> resolved_erodibility(const ErosionParameters& p, const ActiveVariables<V>& active,
                                    const Grid& grid, std::span<const float> given) {
  using std::pow;
  const V scale(active(p.erodibility_factor)), everywhere(active(p.erodibility_yr));
  std::vector<V> resolved(grid.size());
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    const double cell_km = 1e-3 * valley_width_m(grid, j);
    const V factor(pow(Arithmetic<V>(cell_km / active(p.reference_cell_km)),
                       Arithmetic<V>(-active(p.subgrid_exponent))));
    for (Index cell = grid.cell(0, j); cell < grid.cell(0, j) + grid.nx(); ++cell) {
      resolved[cell] = factor * (given.empty() ? everywhere : V(scale * V(given[cell])));
    }
  }
  return resolved;
}

}  // namespace geo
