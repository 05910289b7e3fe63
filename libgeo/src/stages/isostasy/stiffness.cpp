#include "stiffness.hpp"

#include "geo/kernels/cubic_rows.hpp"
#include "geo/kernels/flexure.hpp"

namespace geo {
namespace {

bool is_stiff(const IsostasyParameters& p) {
  return p.compensation == "flexural" && p.elastic_thickness_km > 0.0;
}

/// What the plate's stiffness holds up of deflections of local balance, m.
std::vector<float> held_up_m(const Crust& crust, const Grid& coarse,
                             const std::vector<float>& local_m) {
  ElasticPlate plate = crust.parameters.plate;
  plate.thickness_m = 1e3 * crust.parameters.elastic_thickness_km;
  plate.mantle_kg_m3 = crust.parameters.density.mantle;
  plate.infill_kg_m3 = 0.0;
  plate.gravity_m_s2 = crust.planet.gravity_m_s2;
  plate.radius_m = 1e3 * crust.radius_km;
  std::vector<float> held(local_m), flexed(local_m);
  flex(coarse, flexed, plate);
  for (std::size_t cell = 0; cell < held.size(); ++cell) held[cell] -= flexed[cell];
  return held;
}

}  // namespace

std::vector<float> flexure_of_belts_m(const Crust& crust, const Grid& coarse, const Tectonics& t) {
  const IsostasyParameters& p = crust.parameters;
  std::vector<float> local(coarse.size(), 0.0F);
  if (!is_stiff(p)) return local;
  const double share = p.density.continental_crust / p.density.mantle;
  for (Index cell = 0; cell < coarse.size(); ++cell) {
    local[cell] = static_cast<float>(1e3 * share *
                                     (p.collision_km * t.thickening[cell] +
                                      p.relict_km * t.relict[cell] + p.arc_km * t.arc[cell]));
  }
  return held_up_m(crust, coarse, local);
}

void stiffen_blueprint(const Crust& crust, const CoarseGrid& coarse) {
  if (!is_stiff(crust.parameters)) return;
  auto local = coarse.middle(std::span<const float>(crust.thickness_m));
  const auto density = coarse.middle(std::span<const float>(crust.density));
  for (std::size_t cell = 0; cell < local.size(); ++cell) {
    local[cell] *= density[cell] / static_cast<float>(crust.parameters.density.mantle);
  }
  const std::vector<float> held = held_up_m(crust, coarse.grid(), local);
  const Grid& grid = crust.grid;
  const CubicRows rows(coarse.grid(), grid);
  std::vector<float> line(grid.nx()), scratch;
  for (int j = 0; j < grid.ny(); ++j) {
    rows.read(held, j, line, scratch);
    for (int i = 0; i < grid.nx(); ++i) crust.elevation_m[grid.cell(i, j)] += line[i];
  }
}

}  // namespace geo
