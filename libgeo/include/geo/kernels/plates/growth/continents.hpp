#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geo/kernels/plates/growth/plate_growth.hpp"
#include "geo/kernels/plates/plate_boundaries.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"

namespace geo {

/// Whole plates as continents: the most buoyant first, without those that are too large to bring
/// their area nearer to `share` of the sphere. One entry per plate. Throws Bug unless `plate` has
/// one value per cell of the mesh, as all below.
std::vector<std::uint8_t> continental_plates(const CubedSphere& mesh,
                                             std::span<const std::int16_t> plate,
                                             const std::vector<Plate>& plates, double share);

/// The same as the Tectonica blueprint has it (3.1b): the most buoyant plates until their area
/// reaches the share.
std::vector<std::uint8_t> continental_plates_reaching(const CubedSphere& mesh,
                                                      std::span<const std::int16_t> plate,
                                                      const std::vector<Plate>& plates,
                                                      double share);

/// How continents are put together from cratons.
struct Cratons {
  double share = 0.395;        ///< of the sphere that is continental crust
  double plate_share = 0.62;   ///< of the sphere whose plates carry cratons
  double per_sphere = 28.0;    ///< cratons, if they covered all of it
  double smallest_km = 830.0;  ///< radii
  double largest_km = 1900.0;
  double warp = 0.30;  ///< bending of their outlines, in radii of the planet
  double ridge_clearance_km = 900.0;
  double trench_clearance_km = 350.0;
  double radius_km = 6371.0;
};

/// What a seed decides about continents before there are plates: noise, one value per cell of the
/// mesh. Whoever has a thread to spare makes it while plates grow.
struct CratonNoise {
  std::array<std::vector<float>, 3> bend;  ///< of outlines
  std::vector<float> rifting;              ///< how far ridges have torn what was there
};
CratonNoise craton_noise(const CubedSphere& mesh, std::uint64_t seed);

/// Where oceans are: beside ridges, and before trenches on the subducting plate.
struct Oceans {
  NearestCells to_ridge;                 ///< as far as ridges matter to cratons
  NearestCells to_trench;                ///< to cells of the plate that subducts there
  std::vector<std::int16_t> subducting;  ///< per source of `to_trench`, the plate
};

/// Oceans of the boundaries of plates. Of two plates that carry continents and converge, the faster
/// subducts: what has drawn it is its own sea floor (Forsyth and Uyeda, 1975).
Oceans find_oceans(const Cratons& model, const CubedSphere& mesh,
                   std::span<const BoundaryPoint> boundaries, const std::vector<Plate>& plates);

/// A potential that is high in continents: the logarithm of a sum of bells about the cratons of
/// each continental plate, bent by noise, lowered where a ridge has made ocean floor and where
/// floor is left that a trench still consumes. Some ridges only begin to tear a continent, and
/// some trenches have closed their ocean. Continents are where the potential exceeds a level; finer
/// noise may be added first. One value per cell of the mesh.
std::vector<float> craton_potential(const Cratons& model, const CubedSphere& mesh,
                                    std::span<const std::int16_t> plate,
                                    const std::vector<Plate>& plates, const Oceans& oceans,
                                    const CratonNoise& noise, std::uint64_t seed);

}  // namespace geo
