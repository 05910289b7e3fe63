#include <algorithm>
#include <cmath>

#include "geo/core/field.hpp"
#include "geo/core/parallel_errors.hpp"
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

}  // namespace

TectonicFrame tectonic_frame(const IsostasyParameters& p, const CoarseGrid& coarse,
                             const CrustInputs& in, std::span<const float> fine_fraction) {
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
                                     coarse.middle(in.velocity_north));
  return frame;
}

}  // namespace geo
