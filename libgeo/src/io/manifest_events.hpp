#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace geo::io {

/// What struck the planet, a line for each entry of the lists `events` of a manifest and of its
/// stages; empty when there are none. Throws InputError when the file is no JSON.
std::vector<std::string> read_events(const std::filesystem::path& manifest);

}  // namespace geo::io
