#pragma once

#include <filesystem>

namespace geo::io {

/// Throws InputError if a classic (NetCDF-3) file is shorter than its header says; the netCDF
/// library would read the missing end as zeros. Other formats pass: they notice it themselves.
void check_classic_size(const std::filesystem::path& path);

}  // namespace geo::io
