#pragma once

#include <vector>

#include "geo/core/parameter.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {

/// plates.model = "raster": plates as height maps on a torus (Viitanen 2012), laid on the planet,
/// or taken as they are where the grid is a torus itself.
void collide_rasters(const PlatesParameters& parameters, StageIo& io, Context& context);

/// Throws ConfigurationError where these parameters are not such as the model can begin with on
/// this grid: lists of plates that are no numbers, a map that is not in the proportions of a torus.
void check_rasters(const PlatesParameters& parameters, const Grid& grid);

/// Share of the planet that is to be ocean; 1 where sea level follows from elsewhere.
[[nodiscard]] double wanted_ocean(const Context& context);

/// Declarations of the model's own parameters.
[[nodiscard]] std::vector<Parameter> raster_declarations(RasterParameters& parameters);

}  // namespace geo
