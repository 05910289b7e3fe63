#include <GeographicLib/Config.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <isa-l.h>
#include <libdeflate.h>
#include <netcdf.h>
#include <proj.h>
#include <vtkVersion.h>
#include <xxhash.h>

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "geo/io/run/manifest.hpp"
#include "io/netcdf/netcdf_file.hpp"

namespace geo::io {

std::map<std::string, std::string> library_versions() {
  const auto lock = nc::lock_library();
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  // "4.9.0 of Jan 1 2023 ..." begins with the number.
  const std::string netcdf = nc_inq_libvers();
  const unsigned xxhash = XXH_versionNumber();
  return {{"GeographicLib", GEOGRAPHICLIB_VERSION_STRING},
          {"HDF5", fmt::format("{}.{}.{}", major, minor, release)},
          {"VTK", vtkVersion::GetVTKVersion()},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                              FMT_VERSION % 100)},
          {"ISA-L",
           fmt::format("{}.{}.{}", ISAL_MAJOR_VERSION, ISAL_MINOR_VERSION, ISAL_PATCH_VERSION)},
          {"libdeflate", LIBDEFLATE_VERSION_STRING},
          {"netCDF", netcdf.substr(0, netcdf.find(' '))},
          {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                        NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
          {"PROJ", proj_info().version},
          {"xxHash", fmt::format("{}.{}.{}", xxhash / 10000, xxhash / 100 % 100, xxhash % 100)}};
}

}  // namespace geo::io
