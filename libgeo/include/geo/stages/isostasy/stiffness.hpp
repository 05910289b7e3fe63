#pragma once

#include <array>
#include <vector>

#include "geo/kernels/crust/flexure.hpp"
#include "geo/stages/isostasy/tectonics.hpp"

namespace geo {

[[nodiscard]] inline bool is_stiff(const IsostasyParameters& p) {
  return p.compensation == "flexural" && p.elastic_thickness_km > 0.0;
}

/// What the plate's stiffness holds up of deflections of local balance, m: w - F w. `infill` is
/// the density of what fills the hollow, kg m-3: that of air or of the sea.
template <class V>
std::vector<V> held_up_m(const Crust<V>& crust, const Grid& coarse, const std::vector<V>& local_m,
                         const Arithmetic<V>& infill) {
  const IsostasyParameters& p = crust.parameters;
  ElasticPlate plate = p.plate;
  plate.radius_m = 1e3 * crust.radius_km();
  std::vector<V> held(local_m), flexed(local_m);
  apply_linear<V, 4>(flexed,
                     {crust.active(p.elastic_thickness_km), crust.active(p.density.mantle), infill,
                      crust.active(crust.planet.gravity_m_s2)},
                     [&](auto values, const std::array<double, 4>& of_plate) {
                       plate.thickness_m = 1e3 * of_plate[0];
                       plate.mantle_kg_m3 = of_plate[1];
                       plate.infill_kg_m3 = of_plate[2];
                       plate.gravity_m_s2 = of_plate[3];
                       flex(coarse, values, plate);
                     });
  for (std::size_t cell = 0; cell < held.size(); ++cell) held[cell] -= flexed[cell];
  return held;
}

/// How far crust that plates have laid on their stiff neighbours presses the mantle down in local
/// balance, m.
template <class V>
struct BeltLoads {
  std::vector<V> on_land, at_sea;
  bool any_at_sea = false;
};

/// The thickening of active belts and arcs that columns of a margins crust have, each by its share
/// of a cell: of continents in air, rho_c / rho_m of it; of arcs in the sea,
/// (rho_o - rho_w) / (rho_m - rho_w) of it. Ranges within a belt fold while it is hot: no load.
template <class V>
BeltLoads<V> belt_loads_m(const Crust<V>& crust, const CoarseGrid& coarse, const Tectonics<V>& t) {
  using Number = Arithmetic<V>;
  const IsostasyParameters& p = crust.parameters;
  const auto density = crust.densities();
  const Number belt_km = crust.active(p.collision_km);
  const Number sinks = 1e3 * density.continental_crust / density.mantle;
  const Number arc_m = 1e3 * crust.active(p.arc_km) * (density.oceanic_crust - density.water) /
                       (density.mantle - density.water);
  const auto share = coarse.middle(std::span<const float>(crust.fraction));
  BeltLoads<V> loads{std::vector<V>(share.size()), std::vector<V>(share.size())};
  for (std::size_t cell = 0; cell < share.size(); ++cell) {
    const double continental = share[cell];
    Number there_km = belt_km * thickened(t.thickening[cell]);
    there_km -= to_come_km(there_km, Number(t.shortening_km_myr[cell]), crust.run_myr);
    loads.on_land[cell] = V(continental * (sinks * there_km));
    loads.at_sea[cell] = V((1.0 - continental) * (arc_m * raised_arc(t.arc[cell])));
    loads.any_at_sea = loads.any_at_sea || value_of(loads.at_sea[cell]) > 0.0;
  }
  return loads;
}

/// What the plate's stiffness changes under a margins crust (Turcotte et al. 1981), m: w - F w for
/// the deflection w of local balance under belts and arcs that plates raise today. What was made
/// or worn down while the plate was warm and weak stays in local balance: margins, and the roots
/// of old belts, which are narrower than a stiff plate could have let sink.
template <class V>
std::vector<V> flexure_of_belts_m(const Crust<V>& crust, const CoarseGrid& coarse,
                                  const Tectonics<V>& t) {
  const IsostasyParameters& p = crust.parameters;
  if (!is_stiff(p)) return std::vector<V>(coarse.grid().size(), V(0.0F));
  const BeltLoads<V> loads = belt_loads_m(crust, coarse, t);
  std::vector<V> held = held_up_m(crust, coarse.grid(), loads.on_land, Arithmetic<V>(0.0));
  if (!loads.any_at_sea) return held;
  const std::vector<V> under_arcs =
      held_up_m(crust, coarse.grid(), loads.at_sea, crust.active(p.density.water));
  for (std::size_t cell = 0; cell < held.size(); ++cell) held[cell] += under_arcs[cell];
  return held;
}

}  // namespace geo
