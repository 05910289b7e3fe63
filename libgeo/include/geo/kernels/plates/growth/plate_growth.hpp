#pragma once

#include <cstdint>
#include <vector>

#include "geo/core/vector3.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"

namespace geo {

/// How plates are drawn from a seed (Tectonica blueprint, section 2.2).
struct PlateGrowth {
  std::int64_t count = 22;
  double speed_cm_yr = 5.7;        ///< middle of the plates' speeds
  double mantle_heat = 0.5;        ///< 0 to 1
  double size_spread = 1.6;        ///< standard deviation of ln(size bias)
  double roughness = 1.0;          ///< of the growth's cost
  double structure_km = 1200.0;    ///< wavelength of weak and strong zones
  double polar_resistance = 0.0;   ///< extra cost at the poles; the blueprint's is 0.1
  double smallest_part_km2 = 8e4;  ///< smaller pieces join a neighbour at once
  double radius_km = 6371.0;
  /// Places drawn for each centre, of which the one farthest from those already placed is taken; 1:
  /// anywhere.
  std::int64_t centre_candidates = 6;
};

/// One plate: where it began, how it turns, what it is made of.
struct Plate {
  Vector3 centre;
  Vector3 rotation_rad_myr;
  double size_bias;
  double buoyancy;  ///< -1 (oceanic) to 1 (continental)
  double heat;      ///< 0.5 + mantle_heat u 2.5
};

/// Plates of a seed: centres apart from each other (by `centre_candidates`), poles uniform on the
/// sphere, speeds speed_cm_yr U(0.5, 1.5) U(0.82, 1.24).
std::vector<Plate> draw_plates(const PlateGrowth& model, std::uint64_t seed);

/// Which plate each cell of the mesh belongs to. Plates grow from a primary, 2 to 7 secondary and 6
/// to 18 path nuclei, the cheapest cell first (Dijkstra 1959), at the cost per length of eq. 2.2:
///   spread f_rough f_drift f_structure f_polar.
/// Pieces smaller than smallest_part_km2 then join the neighbour with the longest common border.
/// Larger ones, between whose nuclei other plates grew, stay (see connect_plates).
std::vector<std::int16_t> grow_plates(const PlateGrowth& model, const CubedSphere& mesh,
                                      const std::vector<Plate>& plates, std::uint64_t seed);

}  // namespace geo
