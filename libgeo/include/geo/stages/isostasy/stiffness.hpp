#pragma once

#include <array>
#include <vector>

#include "geo/kernels/flexure.hpp"
#include "geo/stages/isostasy/tectonics.hpp"

namespace geo {

[[nodiscard]] inline bool is_stiff(const IsostasyParameters& p) {
  return p.compensation == "flexural" && p.elastic_thickness_km > 0.0;
}

/// What the plate's stiffness holds up of deflections of local balance, m: w - F w.
template <class V>
std::vector<V> held_up_m(const Crust<V>& crust, const Grid& coarse, const std::vector<V>& local_m) {
  const IsostasyParameters& p = crust.parameters;
  ElasticPlate plate = p.plate;
  plate.infill_kg_m3 = 0.0;
  plate.gravity_m_s2 = crust.planet.gravity_m_s2;
  plate.radius_m = 1e3 * crust.radius_km();
  std::vector<V> held(local_m), flexed(local_m);
  apply_linear<V, 2>(flexed, {crust.lift(p.elastic_thickness_km), crust.lift(p.density.mantle)},
                     [&](auto values, const std::array<double, 2>& of_plate) {
                       plate.thickness_m = 1e3 * of_plate[0];
                       plate.mantle_kg_m3 = of_plate[1];
                       flex(coarse, values, plate);
                     });
  for (std::size_t cell = 0; cell < held.size(); ++cell) held[cell] -= flexed[cell];
  return held;
}

/// What the plate's stiffness changes under a margins crust (Turcotte et al. 1981), m: w - F w for
/// the deflection w of local balance under belts and arcs. Margins were cut and filled while the
/// plate was warm and weak: they stay in local balance.
template <class V>
std::vector<V> flexure_of_belts_m(const Crust<V>& crust, const Grid& coarse,
                                  const Tectonics<V>& t) {
  using Number = Arithmetic<V>;
  const IsostasyParameters& p = crust.parameters;
  std::vector<V> local(coarse.size(), V(0.0F));
  if (!is_stiff(p)) return local;
  const Number share = crust.lift(p.density.continental_crust) / crust.lift(p.density.mantle);
  const Number collision_km = crust.lift(p.collision_km), relict_km = crust.lift(p.relict_km),
               arc_km = crust.lift(p.arc_km);
  for (Index cell = 0; cell < coarse.size(); ++cell) {
    local[cell] =
        V(1e3 * share *
          (collision_km * Number(t.thickening[cell]) +
           relict_km * static_cast<double>(t.relict[cell]) + arc_km * Number(t.arc[cell])));
  }
  return held_up_m(crust, coarse, local);
}

}  // namespace geo
