#include <algorithm>
#include <cmath>

#include "geo/core/field.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/crust/volcanoes.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/stages/isostasy/tectonics.hpp"

namespace geo {
namespace {

constexpr auto kConvergent = static_cast<std::int8_t>(BoundaryType::convergent);
constexpr auto kDivergent = static_cast<std::int8_t>(BoundaryType::divergent);
constexpr auto kTransform = static_cast<std::int8_t>(BoundaryType::transform);

void limit(std::vector<float>& values, float most) {
  for (float& value : values) value = std::min(value, most);
}

/// Volcanoes of arcs, 50 to 80 km from one to the next [bremond1995], above the middle of the arc
/// and smaller beside it; trails of plumes; and lone seamounts, fewer the higher [wessel2010].
/// Sizes are design beside Earth's: Kuril and Mariana volcanoes rise 2 to 4 km from their ridge,
/// Emperor seamounts 3 to 5 km from the floor; flanks fall by about a tenth.
void raise_volcanoes(const CoarseGrid& coarse, const CrustInputs& in,
                     const std::vector<float>& fraction, std::uint64_t seed, TectonicFrame& frame) {
  const Grid& grid = coarse.grid();
  const Grid& fine = coarse.fine();
  // Some 125 km of an arc's breadth carry volcanoes: 65 km from one to the next along it.
  constexpr double kArcSpacing_km = 90.0, kLoneSpacing_km = 100.0;
  constexpr double kArcFrom_km = 20.0, kArcTo_km = 330.0;
  constexpr VolcanoSizes kArc{3000.0, 0.45, 6000.0, 3.5}, kPlume{4200.0, 0.3, 8000.0, 5.0},
      kLone{600.0, 0.8, 4000.0, 2.0};
  const auto& margins = frame.margins;
  const auto in_arc = [&](Index cell) {
    return margins.kind[cell] == Convergence::oceans && margins.across_km[cell] > kArcFrom_km &&
           margins.across_km[cell] < kArcTo_km;
  };
  const auto at_sea = [&](Index cell) { return fraction[cell] < 0.5F; };
  frame.arc_volcanoes.assign(fine.size(), 0.0F);
  pile_volcanoes(fine, scatter_volcanoes(grid, kArcSpacing_km, kArc, seed, "isostasy.arc", in_arc),
                 frame.arc_volcanoes);
  for (float& height : frame.arc_volcanoes) height /= static_cast<float>(kArc.median_m);
  const auto plate = coarse.middle(in.plate);
  const auto east = coarse.middle(in.velocity_east), north = coarse.middle(in.velocity_north);
  const auto age = coarse.middle(in.age_myr), heat = coarse.middle(in.heat);
  std::vector<Volcano> mounts =
      plume_trails(grid, {plate, east, north, age, fraction, heat}, kPlume, seed);
  const auto lone =
      scatter_volcanoes(grid, kLoneSpacing_km, kLone, seed, "isostasy.lone_mounts", at_sea);
  mounts.insert(mounts.end(), lone.begin(), lone.end());
  frame.seamounts_m.assign(fine.size(), 0.0F);
  pile_volcanoes(fine, mounts, frame.seamounts_m);
}

}  // namespace

TectonicFrame tectonic_frame(const IsostasyParameters& p, const CoarseGrid& coarse,
                             const CrustInputs& in, std::span<const float> fine_fraction,
                             std::uint64_t seed) {
  const Grid& grid = coarse.grid();
  const auto [type, strength] = coarse.strongest(in.boundary_type, in.boundary_strength);
  const auto fraction = coarse.middle(fine_fraction);
  const auto sources = [&, &type = type, &strength = strength](std::int8_t which,
                                                               double length_km) {
    return deformation_sources(grid, type, strength, which, length_km);
  };
  std::vector<std::uint8_t> boundary(grid.size()), ridge(grid.size()), continent(grid.size()),
      ocean(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    boundary[cell] = type[cell] != 0;
    ridge[cell] = type[cell] == kDivergent;
    continent[cell] = fraction[cell] > 0.5F;
    ocean[cell] = fraction[cell] < 0.5F;
  }
  const bool is_blueprint = p.crust == "blueprint";
  TectonicFrame frame;
  ParallelErrors errors;
#pragma omp parallel sections
  {
#pragma omp section
    errors.guard([&] {
      if (is_blueprint) frame.convergent = sources(kConvergent, p.convergent_length_km);
    });
#pragma omp section
    errors.guard([&] { frame.divergent = sources(kDivergent, p.divergent_length_km); });
#pragma omp section
    errors.guard([&] { frame.transform = sources(kTransform, p.transform_length_km); });
#pragma omp section
    errors.guard([&] { frame.rift_km = distance_to_marked_km(grid, ridge); });
#pragma omp section
    errors.guard([&] { frame.offshore_km = distance_to_marked_km(grid, continent); });
#pragma omp section
    errors.guard([&] { frame.inland_km = distance_to_marked_km(grid, ocean); });
#pragma omp section
    errors.guard([&] { frame.boundary_km = distance_to_marked_km(grid, boundary); });
  }
  errors.rethrow();
  limit(frame.rift_km, 5000.0F);
  limit(frame.offshore_km, 20000.0F);
  limit(frame.inland_km, 20000.0F);
  smooth(grid, std::span<float>(frame.inland_km), 80e3);
  if (is_blueprint) return frame;
  frame.margins = convergent_margins(grid, coarse.middle(in.plate), type, strength, fraction,
                                     coarse.middle(in.age_myr), coarse.middle(in.velocity_east),
                                     coarse.middle(in.velocity_north),
                                     p.crust == "margins" ? Polarity::of_pair : Polarity::of_place);
  if (p.crust == "margins") raise_volcanoes(coarse, in, fraction, seed, frame);
  return frame;
}

}  // namespace geo
