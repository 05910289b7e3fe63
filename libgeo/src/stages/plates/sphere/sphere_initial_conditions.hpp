#pragma once

#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {

/// Where the drift begins: plates and elevation drawn from the seed, or those that the context
/// holds. Warns of given plates that are too small for a sample. Throws InputError when an
/// elevation is asked for and none is there.
[[nodiscard]] SphereStart sphere_start(const PlatesParameters& parameters, const SphereMesh& mesh,
                                       const StageIo& io, Context& context);

/// The plumes of a seed.
[[nodiscard]] std::vector<SpherePlume> first_plumes(const PlatesParameters& parameters,
                                                    std::uint64_t seed);

/// How many plates there are to begin with.
[[nodiscard]] std::int64_t first_plates(const PlatesParameters& parameters, const Context& context);

/// A place given by latitude and longitude in the frame of plates, which the grid may have turned,
/// and back.
[[nodiscard]] Centre position_of(const Grid& grid, const Vector3& place);
[[nodiscard]] Vector3 place_on(const Grid& grid, const Centre& place);

}  // namespace geo
