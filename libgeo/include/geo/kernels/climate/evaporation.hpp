#pragma once

namespace geo {

/// Share of the water supply that evaporates, E/P at dryness phi = PET/P (Budyko 1974):
///   E/P = sqrt(phi tanh(1/phi) (1 - exp(-phi))).
[[nodiscard]] double budyko_evaporated_share(double dryness);

/// Potential evapotranspiration of Oudin et al. (2005), mm d-1: Q (T + 5) / 100 over the heat that
/// a millimetre of water takes up, 0 below -5 degC.
/// @param insolation_w_m2  at the top of the atmosphere
[[nodiscard]] double oudin_evaporation_mm_d(double insolation_w_m2, double temperature_c);

}  // namespace geo
