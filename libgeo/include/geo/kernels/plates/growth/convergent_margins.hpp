#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Cross sections of convergent margins. `across_km` is the distance from the boundary, positive on
/// the overriding plate and negative on the subducting one; `strength` is that of the boundary,
/// 0 to 1. Heights are shares of the largest unless they carry a unit. The shapes are drawn after
/// the Andes, Tibet and the western Pacific arcs (Turcotte & Schubert 2002, chapter 2).

/// Thickening of a continent above a subducting ocean: nothing up to the fore-arc, a range some
/// 200 km from the trench, a plateau behind it that is wider where plates close faster.
[[nodiscard]] double andean_thickening(double across_km, double strength);
/// Thickening where continents meet: a steep deformation front on the lower plate, a broad plateau.
[[nodiscard]] double himalayan_thickening(double across_km, double strength);
/// A volcanic arc where ocean subducts below ocean.
[[nodiscard]] double island_arc(double across_km, double strength);
/// Trench and outer rise, m, negative down; kDeepestTrench_m at full strength.
inline constexpr double kDeepestTrench_m = 3000.0;
[[nodiscard]] double trench_m(double across_km, double strength);

/// Depth of a trench below the floor in front of it, as a share of that where floor of 100 Myr
/// subducts at 100 mm/yr: sqrt(age / 100 Myr * closing / 100 mm yr-1), both 120 at most. Trenches
/// deepen with the age of their floor and the rate of subduction (Grellet & Dubois 1982;
/// Hilde & Uyeda 1983). The form goes with the steps of PB2002 (Bird 2003) at ages of Müller et al.
/// (2008) on ETOPO5, those with thick sediment left out: in sixths of that root from 0.2 to 1.2, a
/// half of 500 steps lies 0.8, 1.3, 1.7, 2.3 and 2.0 km below the floor at 200 to 400 km, a quarter
/// more than 1.6, 1.8, 2.5, 3.1 and 2.9 km.
[[nodiscard]] double trench_share(double floor_myr, double closing_mm_yr);

/// Trench and forebulge of a plate that bends down, as a share of the trench's depth, negative
/// down. In front of it the elastic plate of Turcotte & Schubert (2002, 3.17),
///   w = w_b sqrt(2) e^(pi/4) exp(-t) sin t,   t = pi/4 (x - x_0) / (x_b - x_0),
/// x from the trench outwards, x_0 = 58 km and x_b - x_0 = 55 km, that of the Mariana trench. The
/// bulge of an elastic plate would be 0.19 of the trench's depth; plates yield before, and it is
/// 0.1 (medians of the Earth's steps with floor older than 100 Myr: 175 m before 1750 m on ETOPO5),
/// which it has here. Behind, the wall of the overriding plate.
[[nodiscard]] double bent_plate(double across_km);

/// Where crust is shortened across a convergent margin, km-1: densities whose integrals over
/// `across_km` are 1. `sheet` lies under the whole width of the belt, that of the sections above (a
/// thin viscous sheet, England & McKenzie 1982); `wedge` under the ranges behind its deformation
/// front, where what arrives is stacked first (Dahlen 1990).
struct ShorteningDensity {
  double sheet, wedge;
};
[[nodiscard]] ShorteningDensity andean_shortening(double across_km, double strength);
[[nodiscard]] ShorteningDensity himalayan_shortening(double across_km, double strength);

/// What meets at a convergent boundary.
enum class Convergence : std::uint8_t { none, oceans, ocean_continent, continents };

/// The convergent margin that governs each cell.
struct ConvergentMargins {
  std::vector<float> across_km;  ///< signed distance; far away where there is none
  std::vector<float> strength;
  std::vector<Convergence> kind;
  std::vector<float> closing_mm_yr;  ///< how fast the two plates approach across the boundary
  std::vector<float> floor_myr;      ///< age of the subducting floor; 0 where none does
  std::vector<float> from_end_km;    ///< from there along it to where plates no longer converge
};

/// Which of two sea floors subducts: the older one at each place, or that which is older along
/// most of the boundary of two plates. A slab hangs together: arcs do not change sides from place
/// to place.
enum class Polarity : std::uint8_t { of_place, of_pair };

/// Which plate subducts at each convergent boundary, and how far each cell is from it. The less
/// continental plate subducts; of two oceans the older; of two continents the faster.
/// @param plate, boundary_type, boundary_strength, continental_fraction, age_myr, velocities of
///        plates, mm yr-1  per cell of a sphere grid
/// Throws Bug where sizes differ.
ConvergentMargins convergent_margins(const Grid& grid, std::span<const std::int16_t> plate,
                                     std::span<const std::int8_t> boundary_type,
                                     std::span<const float> boundary_strength,
                                     std::span<const float> continental_fraction,
                                     std::span<const float> age_myr,
                                     std::span<const float> east_mm_yr,
                                     std::span<const float> north_mm_yr,
                                     Polarity polarity = Polarity::of_place);

/// The boundary of one type that deforms each cell most, where deformation dies away as
/// strength exp(-distance / length).
struct DeformationSources {
  std::vector<float> strength;  ///< 0 where there is none at all
  std::vector<double> distance_km;
};
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
DeformationSources deformation_sources(const Grid& grid, std::span<const std::int8_t> boundary_type,
                                       std::span<const float> boundary_strength, std::int8_t type,
                                       double length_km);

/// Deformation that boundaries of one type spread around them (England & McKenzie 1982): the
/// largest over all of strength exp(-distance / length). Sphere grids; linear cost.
std::vector<float> propagated_deformation(const Grid& grid,
                                          std::span<const std::int8_t> boundary_type,
                                          std::span<const float> boundary_strength,
                                          std::int8_t type, double length_km);

/// Distance of each cell to the nearest cell whose byte is not zero, km; 1e9 without any.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
std::vector<float> distance_to_marked_km(const Grid& grid, std::span<const std::uint8_t> marked);

}  // namespace geo
