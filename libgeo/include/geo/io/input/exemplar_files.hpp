#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/parameter.hpp"
#include "geo/core/planet.hpp"
#include "geo/kernels/exemplars/exemplar.hpp"

namespace geo::io {

/// Every DEM that a folder holds, in the order of the file names: NetCDF (.nc, .nc4, .cdf, .grd)
/// as read_dem reads it, and GeoTIFF (.tif, .tiff). A file whose name has the word andean,
/// himalayan, old or plain is of that terrain, any other of what it looks like. Cells that
/// are not square are made so; of a DEM with gaps, the largest part without one is taken. Throws
/// IoError when the folder cannot be read, InputError when it holds no DEM or one that cannot be
/// used (names the file and why).
[[nodiscard]] ExemplarLibrary read_exemplars(const std::filesystem::path& folder,
                                             const Planet& planet);

/// The library that terrane grows itself (grow_exemplars), from the user's cache when an earlier
/// run of the same build left it there: `$XDG_CACHE_HOME/terrane` or `~/.cache/terrane`. A cache
/// that is damaged or cannot be written does no harm.
[[nodiscard]] ExemplarLibrary grown_exemplars(const GrownSize& size = kGrownForIslands);

/// Whether a run's configuration makes its island ("island.detail") or its continents
/// ("isostasy.detail") like exemplars.
[[nodiscard]] bool asks_for_exemplars(std::span<const Parameter> parameters, std::string_view key);

/// What an island's terrain is made like: the exemplars of a folder, or with no folder those that
/// terrane grows itself, which also stand in for terrains that the folder has none of.
[[nodiscard]] std::shared_ptr<const ExemplarLibrary> exemplars_of(
    const std::filesystem::path& folder, const Planet& planet);

/// What a planet's terrain is made like, in waves of up to `longest_m`. Exemplars of the folder
/// that do not hold such waves (holds_waves) are left out, and `warnings` gets one line that says
/// so.
[[nodiscard]] std::shared_ptr<const ExemplarLibrary> planet_exemplars_of(
    const std::filesystem::path& folder, const Planet& planet, double longest_m,
    std::vector<std::string>& warnings);

}  // namespace geo::io
