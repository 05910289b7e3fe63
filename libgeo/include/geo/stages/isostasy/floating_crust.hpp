#pragma once

#include "geo/stages/isostasy/cross_sections.hpp"
#include "geo/stages/isostasy/margins_crust.hpp"
#include "geo/stages/isostasy/stiffness.hpp"

namespace geo {

/// crust = "margins", from what the plates gave to the height of every column above the datum, m.
template <class V>
void float_margins_crust(const Crust<V>& crust, const CoarseGrid& coarse,
                         const TectonicFrame& frame) {
  Tectonics<V> tectonics = deform(crust, coarse, frame);
  cut_sections(crust, coarse, frame, tectonics);
  tectonics.flexure_m = flexure_of_belts_m(crust, coarse, tectonics);
  draw_margins_crust(crust, coarse, frame, tectonics);
}

/// The sea stands at `level_m` from now on; sediment builds its margins up towards it. It sinks
/// in as far as it weighs on them.
template <class V>
void fill_sea(const Crust<V>& crust, const V& level_m) {
  using Number = Arithmetic<V>;
  using std::log;
  const IsostasyParameters& p = crust.parameters;
  const bool shelves = p.crust != "blueprint" && p.crust != "given" && p.shelf_depth_m > 0.0;
  const Number edge = crust.active(p.shelf_edge);
  const Number whole_shelf = edge + 0.8 * (1.0 - edge);
  const Number shelf_depth_m = crust.active(p.shelf_depth_m);
  const double rise_per_sediment = value_of(crust.datum().rise_per_sediment());
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < crust.grid.size(); ++cell) {
    V& z = crust.elevation_m[cell];
    z -= level_m;
    if (!shelves || value_of(z) >= 0.0) continue;
    const Number share(static_cast<double>(crust.fraction[cell]));
    const Number on_shelf = smooth_step(edge, whole_shelf, share);
    if (value_of(on_shelf) <= 0.0) continue;
    const Number deep_m(z);
    const Number filled = -shelf_depth_m * log(Number(1.0 - deep_m / shelf_depth_m));
    const Number built_up_m = on_shelf * (filled - deep_m);
    z = lesser(V(-1e-3F), V(deep_m + built_up_m));
    if (crust.sediment_m.empty()) continue;
    const double laid_m = value_of(built_up_m) / rise_per_sediment;
    crust.sediment_m[cell] += static_cast<float>(solid_thickness_m(laid_m));
  }
}

}  // namespace geo
