#pragma once

#include <vector>

#include "geo/core/vector3.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {

/// Declarations of what orders places by height.
[[nodiscard]] std::vector<Parameter> hypsography_parameters(PlatesParameters& parameters);

/// plates.model = "hypsography": a surface that has a given distribution of heights, by the order
/// that a scalar field gives (tectonics.js), and the crust that belongs to such heights.
/// One plate that does not move.
void draw_hypsography(const PlatesParameters& parameters, StageIo& io, Context& context);

/// Heights of places that stand for equal areas, by the same order and the same distribution, m.
[[nodiscard]] std::vector<float> hypsographic_heights_m(const PlatesParameters& parameters,
                                                        const StageIo& io, const Context& context,
                                                        std::span<const Vector3> places);

}  // namespace geo
