#pragma once

#include <filesystem>
#include <optional>

#include "geo/io/files/build_info.hpp"
#include "geo/kernels/exemplars/exemplar.hpp"

namespace geo::io {

/// Where the user's cache keeps the library of a size that a build grows; empty when there is no
/// place. Builds of the same commit differ by their local changes and options.
std::filesystem::path exemplar_cache(const GrownSize& size, const BuildInfo& build = build_info());
/// The library in a file, bit for bit as it was grown; nothing when it is not there or not whole.
std::optional<ExemplarLibrary> read_cached(const std::filesystem::path& path);
/// Keeps a library for later; failing to is no error.
void write_cached(const std::filesystem::path& path, const ExemplarLibrary& library);

}  // namespace geo::io
