#include "geo/kernels/crust/flexure.hpp"

#include <algorithm>
#include <cmath>

#include "geo/core/error.hpp"
#include "geo/kernels/numerics/spherical_filter.hpp"

namespace geo {

double ElasticPlate::rigidity_n_m() const {
  return youngs_modulus_pa * std::pow(thickness_m, 3) /
         (12.0 * (1.0 - poisson_ratio * poisson_ratio));
}

std::vector<double> compensation_degrees(const ElasticPlate& plate, int degrees) {
  const double restoring = (plate.mantle_kg_m3 - plate.infill_kg_m3) * plate.gravity_m_s2;
  if (!(restoring > 0.0 && plate.thickness_m >= 0.0 && plate.youngs_modulus_pa > 0.0 &&
        plate.radius_m > 0.0 && plate.mean_density_kg_m3 > 0.0)) {
    throw InputError(
        "flexure: the plate's numbers must be positive and its infill lighter than the mantle");
  }
  const double r2 = plate.radius_m * plate.radius_m;
  const double sigma = plate.rigidity_n_m() / (r2 * r2 * restoring);
  const double tau = plate.youngs_modulus_pa * plate.thickness_m / (r2 * restoring);
  std::vector<double> share(degrees, 1.0);
  for (int l = 2; l < degrees; ++l) {
    const double lambda = l * (l + 1.0);
    const double gravity =
        1.0 - 3.0 * plate.mantle_kg_m3 / ((2.0 * l + 1.0) * plate.mean_density_kg_m3);
    const double stiffness = (sigma * lambda * lambda * (lambda - 4.0) + tau * (lambda - 2.0)) /
                             (lambda - 1.0 + plate.poisson_ratio);
    share[l] = gravity / (stiffness + gravity);
  }
  return share;
}

namespace {

template <class Real>
void flex_in(const Grid& grid, std::span<Real> deflection_m, const ElasticPlate& plate) {
  // All that a small grid can hold; on larger ones what bends, within the reach of the quadrature.
  const int degrees = std::min({grid.ny(), grid.nx() / 2, std::max(384, 2 * grid.ny() / 3)});
  filter_degrees(grid, deflection_m, compensation_degrees(plate, degrees));
}

}  // namespace

void flex(const Grid& grid, std::span<float> deflection_m, const ElasticPlate& plate) {
  flex_in(grid, deflection_m, plate);
}
void flex(const Grid& grid, std::span<double> deflection_m, const ElasticPlate& plate) {
  flex_in(grid, deflection_m, plate);
}

}  // namespace geo
