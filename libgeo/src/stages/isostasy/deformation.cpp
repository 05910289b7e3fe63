#include <algorithm>
#include <cmath>

#include "geo/kernels/smoothing.hpp"
#include "tectonics.hpp"

namespace geo {
namespace {

constexpr auto kConvergent = static_cast<std::int8_t>(BoundaryType::convergent);
constexpr auto kDivergent = static_cast<std::int8_t>(BoundaryType::divergent);
constexpr auto kTransform = static_cast<std::int8_t>(BoundaryType::transform);

std::vector<float> speed_mm_yr(const Crust& crust, const CoarseGrid& coarse) {
  std::vector<float> speed = coarse.middle(crust.velocity_east);
  const std::vector<float> north = coarse.middle(crust.velocity_north);
  for (std::size_t cell = 0; cell < speed.size(); ++cell) {
    speed[cell] = std::hypot(speed[cell], north[cell]);
  }
  return speed;
}

void limit(std::vector<float>& values, float most) {
  for (float& value : values) value = std::min(value, most);
}

}  // namespace

Tectonics deform(const Crust& crust, const CoarseGrid& coarse) {
  const IsostasyParameters& p = crust.parameters;
  const Grid& grid = coarse.grid();
  const auto [type, strength] = coarse.strongest(crust.boundary_type, crust.boundary_strength);
  const auto fraction = coarse.middle(std::span<const float>(crust.fraction));
  const auto spread = [&, &type = type, &strength = strength](std::int8_t which, double length_km) {
    auto field = propagated_deformation(grid, type, strength, which, length_km);
    smooth(grid, field, 1e3 * p.deformation_smoothing_km);
    return field;
  };
  std::vector<std::uint8_t> boundary(grid.size()), ridge(grid.size()), continent(grid.size()),
      ocean(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    boundary[cell] = type[cell] != 0;
    ridge[cell] = type[cell] == kDivergent;
    continent[cell] = fraction[cell] > 0.5F;
    ocean[cell] = fraction[cell] < 0.5F;
  }
  Tectonics t;
#pragma omp parallel sections
  {
#pragma omp section
    t.convergent = spread(kConvergent, p.convergent_length_km);
#pragma omp section
    t.divergent = spread(kDivergent, p.divergent_length_km);
#pragma omp section
    t.transform = spread(kTransform, p.transform_length_km);
#pragma omp section
    t.rift_km = distance_to_marked_km(grid, ridge);
#pragma omp section
    t.offshore_km = distance_to_marked_km(grid, continent);
#pragma omp section
    t.inland_km = distance_to_marked_km(grid, ocean);
#pragma omp section
    {
      t.weakness = distance_to_marked_km(grid, boundary);
      for (float& value : t.weakness) {
        value = static_cast<float>(std::exp(-value / p.weakness_length_km));
      }
    }
  }
  limit(t.rift_km, 5000.0F);
  limit(t.offshore_km, 20000.0F);
  limit(t.inland_km, 20000.0F);
  smooth(grid, t.inland_km, 80e3);
  if (p.crust == "blueprint") return t;
  t.margins = convergent_margins(grid, coarse.middle(crust.plate), type, strength, fraction,
                                 coarse.middle(crust.age_myr), speed_mm_yr(crust, coarse));
  return t;
}

}  // namespace geo
