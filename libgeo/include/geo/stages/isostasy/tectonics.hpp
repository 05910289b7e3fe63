#pragma once

#include <cstdint>
#include <vector>

#include "geo/kernels/plates/growth/convergent_margins.hpp"
#include "geo/stages/isostasy/coarse_grid.hpp"
#include "geo/stages/isostasy/crust.hpp"

namespace geo {

/// Where cells of the coarse grid lie with regard to plate boundaries and coasts of continental
/// crust. Of the settings it depends on the lengths alone over which deformation dies away.
struct TectonicFrame {
  DeformationSources convergent, divergent, transform;
  std::vector<float> boundary_km;             // distance to any boundary
  std::vector<float> rift_km;                 // distance to divergent boundaries
  std::vector<float> offshore_km, inland_km;  // distance to continental crust, to the ocean's
  ConvergentMargins margins;                  // of a crust with cross sections
  // Volcanoes on the floor of a margins crust, on the full grid: those of arcs as shares of the
  // height of one of middling size, plumes' and lone ones in m.
  std::vector<float> arc_volcanoes, seamounts_m;
};
TectonicFrame tectonic_frame(const IsostasyParameters& parameters, const CoarseGrid& coarse,
                             const CrustInputs& in, std::span<const float> fraction,
                             std::uint64_t seed);

/// What plate boundaries do to the crust, and its broad variation, on the coarse grid.
template <class V>
struct Tectonics {
  std::vector<V> convergent, divergent, transform, weakness;  // 0 to 1
  std::vector<V> thickening, arc, trench_m;                   // cross sections of margins
  std::vector<V> shortening_km_myr;                           // crust that it adds
  std::vector<V> thickness_noise_km, swell_m, flexure_m;
  std::vector<float> ocean_swell, relict;
};

/// How much of a belt's thickening was not yet there when the landscape begins to run, km.
template <class Number>
[[nodiscard]] Number to_come_km(const Number& belt_km, const Number& added_km_myr,
                                const Number& run_myr) {
  return lesser(belt_km, Number(added_km_myr * run_myr));
}

/// Thickening and arc as columns have them.
template <class V>
[[nodiscard]] Arithmetic<V> thickened(const V& thickening) {
  return limited(Arithmetic<V>(thickening), 0.0, 1.3);
}
template <class V>
[[nodiscard]] Arithmetic<V> raised_arc(const V& arc) {
  return greater(V(0.0F), arc);
}

}  // namespace geo
