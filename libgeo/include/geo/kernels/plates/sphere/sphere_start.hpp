#pragma once

#include <cstdint>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_mesh.hpp"
#include "geo/kernels/plates/sphere/sphere_settings.hpp"
#include "geo/kernels/plates/sphere/sphere_state.hpp"

namespace geo {

/// How a planet's plates and crust begin (Cortial et al. 2019, section 3): plates are the spherical
/// Voronoi cells of random centroids, with distances warped by noise.
struct SphereStart {
  std::int64_t plates = 40;
  double continental_share = 0.3;   ///< of the area
  bool whole_plates = false;        ///< continents are whole plates; else they lie across plates
  bool supercontinent = false;      ///< all land about one place, on a plate of its own
  double warp_km = 700.0;           ///< of the plates' borders
  double continent_km = 4500.0;     ///< wavelength of continents
  double smallest_sea_km2 = 0.0;    ///< less than that, enclosed by land, is land; 0 closes none
  double continental_km = 36.0;     ///< thickness of their crust
  double oldest_floor_myr = 130.0;  ///< of the first sea floor, far from boundaries
  /// Heights of the samples, m: the highest are the continents, thick as such ground is; the floor
  /// is as old as it is deep. Empty: low continents from noise, a floor that ages from boundaries.
  std::vector<float> elevation_m;
  /// Ages of the sea floor beside such heights, Myr, NaN where unknown; empty: all by depth.
  std::vector<float> age_myr;
  /// The heights are a planet's own, with slopes, aprons, trenches, plateaus and seamounts, whose
  /// depth does not tell the age of the floor: there it is that of the plain floor around.
  bool real_floor = false;
  /// Plate of each sample, where plates are given, and the rotation of each, rad/Myr; empty: drawn.
  std::vector<std::int16_t> plate;
  std::vector<Vector3> rotation_rad_myr;
  /// Number of each such plate in a reconstruction that drives it; empty: none does.
  std::vector<std::int32_t> driver;
};

/// Plates, motion and crust of a seed. Axes are uniform on the sphere, speeds uniform from a fifth
/// of the fastest to it.
SphereState start_sphere(const SphereMesh& mesh, const SphereStart& start,
                         const SphereSettings& settings, std::uint64_t seed);

}  // namespace geo
