#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// An elastic shell about a planet.
struct ElasticPlate {
  double thickness_m = 25e3;  ///< elastic thickness Te
  double youngs_modulus_pa = 70e9;
  double poisson_ratio = 0.25;
  double mantle_kg_m3 = 3300.0;
  double infill_kg_m3 = 2800.0;  ///< what fills the hollow, so that rho_m - infill restores
  double gravity_m_s2 = 9.81;
  double radius_m = 6371000.0;
  double mean_density_kg_m3 = 5515.0;  ///< of the planet, for self-gravitation

  /// D = E Te^3 / (12 (1 - nu^2)), N m.
  [[nodiscard]] double rigidity_n_m() const;
};

/// Degree of compensation C(l): deflection of the shell over that of local (Airy) balance, for
/// l = 0 ... degrees - 1 (Turcotte et al. 1981), with Lambda = l (l + 1),
///   C = s / { [sigma (Lambda^3 - 4 Lambda^2) + tau (Lambda - 2)] / (Lambda - 1 + nu) + s },
///   sigma = D / (R^4 drho g), tau = E Te / (R^2 drho g), s = 1 - 3 rho_m / ((2 l + 1) rho_mean):
/// bending, membrane stress and self-gravitation. Degrees 0 and 1 cannot bend a shell: 1.
/// Throws InputError if the plate's numbers are not positive or the infill is not lighter than the
/// mantle.
std::vector<double> compensation_degrees(const ElasticPlate& plate, int degrees);

/// Replaces the deflection that local balance would give under every cell by that of the shell, in
/// place. Sphere grids (see spherical_filter.hpp); up to degree 383 or two thirds of ny, whichever
/// is more, as far as the grid holds them. What is finer does not bend the plate: an Earth's of 20
/// km under dry land is bent by 4 % of local balance at degree 384.
void flex(const Grid& grid, std::span<float> deflection_m, const ElasticPlate& plate);
void flex(const Grid& grid, std::span<double> deflection_m, const ElasticPlate& plate);

}  // namespace geo
