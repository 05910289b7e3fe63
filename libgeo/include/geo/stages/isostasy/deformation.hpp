#pragma once

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/stages/isostasy/tectonics.hpp"

namespace geo {

template <class V>
void blur(const Grid& grid, std::vector<V>& field, const Arithmetic<V>& length_m) {
  apply_linear<V, 1>(field, {length_m}, [&](auto values, const std::array<double, 1>& length) {
    smooth(grid, values, length[0]);
  });
}

/// Deformation that dies away from boundaries (blueprint 3.2).
template <class V>
Tectonics<V> deform(const Crust<V>& crust, const CoarseGrid& coarse, const TectonicFrame& frame) {
  using Number = Arithmetic<V>;
  using std::exp;
  const IsostasyParameters& p = crust.parameters;
  const Grid& grid = coarse.grid();
  const Number smoothing_m = 1e3 * crust.active(p.deformation_smoothing_km);
  const auto spread = [&](const DeformationSources& from, const double& length_member) {
    const Number length_km = crust.active(length_member);
    std::vector<V> field(grid.size());
    for (Index cell = 0; cell < grid.size(); ++cell) {
      field[cell] = V(from.strength[cell]) * V(exp(-from.distance_km[cell] / length_km));
    }
    blur(grid, field, smoothing_m);
    return field;
  };
  Tectonics<V> t;
  ParallelErrors errors;
#pragma omp parallel sections
  {
#pragma omp section
    errors.guard([&] {
      if (p.crust == "blueprint") t.convergent = spread(frame.convergent, p.convergent_length_km);
    });
#pragma omp section
    errors.guard([&] { t.divergent = spread(frame.divergent, p.divergent_length_km); });
#pragma omp section
    errors.guard([&] { t.transform = spread(frame.transform, p.transform_length_km); });
#pragma omp section
    errors.guard([&] {
      const Number length_km = crust.active(p.weakness_length_km);
      t.weakness.resize(grid.size());
      for (Index cell = 0; cell < grid.size(); ++cell) {
        t.weakness[cell] = V(exp(-static_cast<double>(frame.boundary_km[cell]) / length_km));
      }
    });
  }
  errors.rethrow();
  return t;
}

}  // namespace geo
