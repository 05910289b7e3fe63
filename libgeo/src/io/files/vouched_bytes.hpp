#pragma once

#include <filesystem>

namespace geo::io {

/// Whether a file of a run has the very bytes that the manifest beside it says, so that no library
/// can stumble over it. Files without a manifest have not.
bool is_as_recorded(const std::filesystem::path& path);

}  // namespace geo::io
