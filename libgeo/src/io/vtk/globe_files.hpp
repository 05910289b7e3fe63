#pragma once

#include "geo/io/run/manifest.hpp"
#include "geo/io/run/run_folder.hpp"

namespace geo::io {

/// The planet's stages as closed surfaces, 01-plates.vtp and so on, from their NetCDF files, and
/// globe.pvd, which lists them; adds them to the entries of the manifest. Heights are those after
/// each stage, multiplied by `times`; compression as of write_vti. False, and nothing is written,
/// where the grid is no whole planet.
bool write_globe_files(const RunFolder& folder, Manifest& manifest, double times, int compression);

}  // namespace geo::io
