#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geo/core/field.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/run_folder.hpp"

namespace geo::io {

/// How the NetCDF file of a stage stands to its record in the manifest.
struct Standing {
  /// Why it cannot be read: "missing", "truncated". Empty if it can.
  std::string fault;
  /// Which values are not those of the record: "elevation: digest differs". Empty if all are.
  std::string difference;
};

/// Compares all values of a stage's file with its record.
Standing standing_of(const std::filesystem::path& folder, const StageRecord& record);

/// The fields of a stage's file that `wanted` accepts, held against the record. Throws
/// InputError that names the file and the field whose values are not those of the record, or that
/// cannot be read; IoError.
Snapshot read_recorded(const std::filesystem::path& folder, const StageRecord& record,
                       const std::function<bool(const FieldSpec&)>& wanted);
/// The same of a file that may be a stage's of the run in whose folder it lies: one that no
/// manifest lists is read as it is.
Snapshot read_perhaps_recorded(const std::filesystem::path& file,
                               const std::function<bool(const FieldSpec&)>& wanted);

/// Digests of the bytes of all files that a run leaves beside those of its stages: configuration,
/// report, pictures, collections; by their paths in the folder.
std::map<std::string, std::string> digests_of_summaries(const RunFolder& folder);

/// Writes them into the manifest anew, after pictures were drawn again. The folder must be locked.
void record_summaries(const RunFolder& folder);

/// What the files of a run are against its manifest.
struct Verification {
  int files = 0, fields = 0;             ///< compared
  std::vector<std::string> differences;  ///< "04-climate.nc: temperature: digest differs"
};
/// Recomputes the digests of all files and of all values that the manifest lists. Throws
/// ConfigurationError when the folder holds no manifest, InputError when it cannot be understood.
Verification verify_run(const std::filesystem::path& folder);

}  // namespace geo::io
