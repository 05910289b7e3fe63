#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "geo/core/grid.hpp"

namespace geo {

enum class FlowMethod : std::uint8_t {
  steepest,    ///< everything to the receiver of the single-flow forest (D8)
  multiple,    ///< over all lower neighbours by slope (Freeman 1991; Quinn et al. 1991)
  d_infinity,  ///< to the two neighbours that enclose the steepest facet (Tarboton 1997)
};

struct FlowPartition {
  FlowMethod method = FlowMethod::multiple;
  /// `multiple`: the share of neighbour k goes as slope_k^exponent. 1.1 makes round cones
  /// (Freeman), large exponents approach `steepest`.
  double exponent = 1.1;
  /// `multiple`: times the length of contour that faces the neighbour, half the width of the cell
  /// to a side, a quarter of its diagonal to a corner (Quinn et al. 1991: 0.5 and 0.354).
  bool contour_weights = false;
};

/// Accumulates a source down a routed surface: `values` holds what each cell supplies before and
/// what arrives in it afterwards, its own supply included. Cell areas become drainage areas.
///
/// surface_m: elevation with depressions filled; receiver: single-flow forest that never climbs it
/// (as route_water gives both); one value per cell each. A root of the forest keeps what it gets.
/// Any other cell gives to neighbours whose surface is strictly lower; one without (flats, lakes)
/// passes everything to its receiver. So water never climbs, no cycle can form, and Σ over roots =
/// Σ of sources. Poles are crossed and edges wrapped.
///
/// Cells are visited when the last donor has given: linear, no sort. Weights are computed before
/// that, by all threads; 2 bytes per cell of memory and a stack, and 32 where water parts. Results
/// do not depend on the number of threads. The walk from donor to receiver is one thread's work;
/// another runs `meanwhile`, if given, beside it. Throws InputError if shapes do not fit or the
/// exponent is not positive, Bug if a receiver climbs.
void accumulate_flow(const Grid& grid, std::span<const float> surface_m,
                     std::span<const Index> receiver, const FlowPartition& partition,
                     std::span<double> values, const std::function<void()>& meanwhile = {});

/// Specific catchment area, drainage area per length of contour, m: A (D·n) / cell area, where D =
/// Σ w_k d_k is the mean displacement of the water that leaves the cell and n the direction of
/// steepest descent by central differences. The usual A / cell width takes a cell as wide from
/// every side; measuring the width by the way that the water really takes removes most of its bias.
/// 0 at roots, which water leaves by no known way.
void specific_catchment_area(const Grid& grid, std::span<const float> surface_m,
                             std::span<const Index> receiver, const FlowPartition& partition,
                             std::span<const double> drainage_area_m2, std::span<float> area_m);

}  // namespace geo
