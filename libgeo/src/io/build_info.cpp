#include "geo/io/build_info.hpp"

#include <GeographicLib/Config.h>
#include <cairo.h>
#include <fmt/core.h>
#include <netcdf.h>
#include <proj.h>
#include <spdlog/version.h>
#include <vtkVersion.h>
#include <xxhash.h>

#include <nlohmann/json.hpp>
// Only the version numbers of toml++, which need these in this order.
#include <toml++/impl/preprocessor.h>

#include "terrane_commit.hpp"

namespace geo::io {
namespace {

std::string triple(int major, int minor, int patch) {
  return fmt::format("{}.{}.{}", major, minor, patch);
}

std::string netcdf_version() {
  const std::string text = nc_inq_libvers();
  return text.substr(0, text.find(' '));
}

}  // namespace

const BuildInfo& build_info() {
  static const BuildInfo kInfo{
      TERRANE_VERSION,
      TERRANE_COMMIT,
      TERRANE_COMPILER,
      {{"netCDF", netcdf_version()},
       {"VTK", vtkVersion::GetVTKVersion()},
       {"PROJ", proj_info().version},
       {"GeographicLib", GEOGRAPHICLIB_VERSION_STRING},
       {"cairo", cairo_version_string()},
       {"xxHash", triple(XXH_VERSION_MAJOR, XXH_VERSION_MINOR, XXH_VERSION_RELEASE)},
       {"toml++", triple(TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
       {"nlohmann-json", triple(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                NLOHMANN_JSON_VERSION_PATCH)},
       {"spdlog", triple(SPDLOG_VER_MAJOR, SPDLOG_VER_MINOR, SPDLOG_VER_PATCH)},
       {"fmt", triple(FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)}}};
  return kInfo;
}

}  // namespace geo::io
