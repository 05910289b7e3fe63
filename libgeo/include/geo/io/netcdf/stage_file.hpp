#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geo/core/checkpoint.hpp"
#include "geo/core/climatology.hpp"
#include "geo/core/state.hpp"

namespace geo::io {

/// Where the values of a file come from: global attributes of every file of a run.
struct Provenance {
  std::string title;        ///< "terrane: climate"
  std::string config_toml;  ///< the resolved configuration
  std::uint64_t seed = 1;
  std::string version;  ///< "0.1.0"
  std::string history;  ///< one line: time stamp (SOURCE_DATE_EPOCH respected) and command
  std::string references;
};

/// Fields of one stage, held together with their grid while a writer streams them to disk.
struct Snapshot {
  std::string stage;
  std::shared_ptr<const Grid> grid;
  std::vector<std::pair<const FieldSpec*, std::shared_ptr<const Values>>> fields;
  /// Of a frame of a stage that runs through time: a scalar time coordinate and the arrays to go on
  /// from, in a group of their own.
  std::shared_ptr<const Checkpoint> checkpoint = {};
  /// Makes the fields of months, which are written beside the others; empty: none.
  MonthlyFields months = {};
};

/// Writes a snapshot as NetCDF-4 with CF-1.10 metadata: temporary name, flush, rename. Shuffled,
/// chunked, deflated; at level 1, elevation hardly shrinks further however long one tries, level 0
/// stores. Calls `written`, if any, as soon as a field of the snapshot is read no more, which may
/// then leave memory. Throws IoError (which names the path and the reason).
void write_netcdf(const std::filesystem::path& path, const Snapshot& snapshot,
                  const Provenance& provenance, int compression = 1,
                  const std::function<void(const FieldSpec&)>& written = {});
/// Writes a snapshot as VTK XML ImageData: cell data, appended raw; deflated at levels 1 to 9, as
/// it lies in memory at 0. Temporary name, flush, rename.
void write_vti(const std::filesystem::path& path, const Snapshot& snapshot,
               const Provenance& provenance, int compression = 0);
/// Writes a snapshot of a whole planet as a closed surface, VTK XML PolyData: a face for each cell
/// in the order of the cells, quadrilaterals and at the poles triangles, that share their corners,
/// so that there is no seam and no hole. Fields are cell data. Corners lie on the ellipsoid, raised
/// by `times` the mean elevation around them (m, point data `topography`); an empty `elevation_m`
/// is flat. 32 bytes a cell besides the fields. Compression as of write_vti. Temporary name, flush,
/// rename.
void write_globe(const std::filesystem::path& path, const Snapshot& snapshot,
                 const Provenance& provenance, std::span<const float> elevation_m, double times,
                 int compression = 0);
/// A ParaView collection that lists files with a time step each, in order: 0, 1, 2 and so on, or
/// the times given.
void write_pvd(const std::filesystem::path& path, const std::vector<std::filesystem::path>& files,
               const std::vector<double>& times = {});

/// Reads back the grid and the vocabulary fields of a stage file, bit for bit. InputError when it
/// is not one (names path and what is missing), IoError when it cannot be read.
Snapshot read_netcdf(const std::filesystem::path& path);
/// The same with those fields alone that `wanted` accepts; perhaps none.
Snapshot read_netcdf(const std::filesystem::path& path,
                     const std::function<bool(const FieldSpec&)>& wanted);
/// One month, from 0 for January, of a field of months that a stage file has beside those of the
/// year (`field::monthly()`), cell by cell; empty where it has none. For files of one's own: the
/// netCDF library reads it here. Throws as read_netcdf.
std::vector<float> read_month(const std::filesystem::path& path, const FieldSpec& spec, int month);
/// What a frame holds to go on from. InputError when the file is no frame.
Checkpoint read_checkpoint(const std::filesystem::path& path);
/// Provenance of a stage file.
Provenance read_provenance(const std::filesystem::path& path);

}  // namespace geo::io
