#pragma once

#include <string>

#include "geo/core/checkpoint.hpp"

namespace geo::io {

/// Scalar variable of a stage file that holds the configuration, and the global attribute with its
/// digest. Older files hold the text as an attribute of the variable's name.
inline constexpr const char* kConfig = "terrane_config";
inline constexpr const char* kConfigDigest = "terrane_config_digest";

/// Dimension and coordinate of a frame, Myr.
inline constexpr const char* kFrameTime = "drift_time";
/// Group of a frame's file that holds the arrays to go on from, and its attribute with their
/// digest.
inline constexpr const char* kCheckpointGroup = "checkpoint";
inline constexpr const char* kCheckpointDigest = "digest";

/// Of the names, types and values of all arrays, and the time.
std::string digest_of(const Checkpoint& checkpoint);

}  // namespace geo::io
