#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "geo/io/export/export.hpp"
#include "geo/io/netcdf/stage_file.hpp"

namespace geo::io {

/// What an export is made from.
struct ExportSource {
  Snapshot snapshot;                 ///< the stage with the fields needed
  const FieldSpec* field = nullptr;  ///< the one asked for
  Provenance provenance;

  [[nodiscard]] const Grid& grid() const { return *snapshot.grid; }
  [[nodiscard]] const Values& values() const { return of(*field); }
  [[nodiscard]] bool has(const FieldSpec& spec) const;
  /// Values of a field that is there.
  [[nodiscard]] const Values& of(const FieldSpec& spec) const;
};

/// Reads what a request asks for. Throws ConfigurationError that names what is near where there is
/// no such stage or field; InputError, IoError.
ExportSource read_export_source(const ExportRequest& request);

/// Values as numbers; NaN where the field does not exist. Floats are not copied.
std::shared_ptr<const std::vector<float>> as_floats(const FieldSpec& spec,
                                                    std::shared_ptr<const Values> values);
/// The shared values of a field that is there.
std::shared_ptr<const Values> shared_values(const ExportSource& source, const FieldSpec& spec);

/// Words for a coordinate system that PROJ reads; empty for a plane without a place.
std::string proj_words(const Grid& grid);

/// Files for GPlates of the plates of the run in a folder.
std::vector<std::filesystem::path> export_gplates(const std::filesystem::path& place,
                                                  const std::filesystem::path& folder);

// One per format; `output` is resolved.
std::vector<std::filesystem::path> export_height_map(const ExportRequest& request,
                                                     const ExportSource& source,
                                                     const std::filesystem::path& output);
void write_geotiff(const std::filesystem::path& output, const ExportSource& source);
void write_zarr(const std::filesystem::path& output, const ExportSource& source, bool all_fields);
void write_healpix(const std::filesystem::path& output, const ExportSource& source, bool all_fields,
                   int nside);
void write_glb(const std::filesystem::path& output, const ExportSource& source,
               double exaggeration);

}  // namespace geo::io
