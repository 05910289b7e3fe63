#pragma once

namespace geo::io {

/// Group of a frame's NetCDF file that holds the arrays to go on from.
inline constexpr const char* kCheckpointGroup = "checkpoint";

}  // namespace geo::io
