#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

namespace geo {

/// The samples of the two nearest plates to a place in a gap, the nearest first, or -1.
struct GapSides {
  std::array<std::int32_t, 2> source{-1, -1};
  std::array<float, 2> chord2{9.0F, 9.0F};
};

/// What has opened between plates.
struct OpenGaps {
  std::span<const std::int16_t> owner;       ///< plate of each sample, -1 in gaps
  std::span<const std::int8_t> continental;  ///< type of each sample that has a plate
  std::span<const std::int32_t> places;      ///< the samples in gaps
  std::span<const GapSides> sides;           ///< of each place
};

/// Where a place in a gap lies between the ridge and the edge of its plate.
struct RidgePlace {
  int side = 0;           ///< 0: of the nearest plate, 1: of the other one
  double ridge_km = 0.0;  ///< to the ridge
  double edge_km = 0.0;   ///< to the edge of its plate
  Vector3 along{};        ///< direction of the ridge, unit vector, or zero
};

/// Ridges as plates make them: segments at right angles to the motion, offset along transforms that
/// follow it [oldenburg1972].
///
/// About the pole of what two plates have moved since the crust was last resampled, a segment is
/// part of a meridian, a transform part of a parallel. At each distance v from the pole the middle
/// of the gap has a longitude u(v). The ridge is the piecewise constant longitude that minimises
/// the sum over segments of L^3/6 + int (u - mean)^2 sin^2 dv (lengths on the sphere; exact, by
/// dynamic programming [jackson2005]), L = settings.ridge_segment_km. A straight rift at 45
/// degrees to the segments breaks into segments of length L, a less oblique one, tan a < 1,
/// into longer ones, L tan^(-2/3) a. Offsets that are there stay. Nearer to the pole than L, beside
/// continents that have just broken, and with L = 0, the ridge runs half way between the plates.
///
/// Cost: linear in places, and quadratic in the rows of samples along a ridge. Throws Bug when
/// arrays do not fit.
std::vector<RidgePlace> place_ridges(const SphereTectonics& model, const OpenGaps& gaps);

}  // namespace geo
