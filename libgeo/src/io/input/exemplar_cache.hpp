#pragma once

#include <filesystem>
#include <optional>

#include "geo/kernels/exemplars/exemplar.hpp"

namespace geo::io {

/// Where the user's cache keeps the library of a size that this build grows; empty when there is no
/// place.
std::filesystem::path exemplar_cache(const GrownSize& size);
/// The library in a file, bit for bit as it was grown; nothing when it is not there or not whole.
std::optional<ExemplarLibrary> read_cached(const std::filesystem::path& path);
/// Keeps a library for later; failing to is no error.
void write_cached(const std::filesystem::path& path, const ExemplarLibrary& library);

}  // namespace geo::io
