#include "exemplar_cache.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <system_error>

#include "geo/core/error.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "geo/io/files/digest.hpp"
#include "io/netcdf/netcdf_file.hpp"
#include "questions.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

std::string digest_of_elevation(const std::vector<float>& elevation_m) {
  return digest_of(Values(elevation_m));
}

}  // namespace

fs::path exemplar_cache(const GrownSize& size, const BuildInfo& build) {
  const auto folder = [](const char* variable) {
    const char* const value = std::getenv(variable);
    return fs::path(value == nullptr ? "" : value);
  };
  fs::path cache = folder("XDG_CACHE_HOME");
  if (!cache.is_absolute()) {
    const fs::path home = folder("HOME");
    if (!home.is_absolute()) return {};
    cache = home / ".cache";
  }
  const std::string key =
      digest_of(fmt::format("{} {} {} {}", build.version, build.commit, build.compiler, build.id));
  return cache / "terrane" / fmt::format("exemplars-{:.0f}m-{}.nc", size.cell_m, key.substr(0, 16));
}

std::optional<ExemplarLibrary> read_cached(const fs::path& path) {
  std::error_code error;
  if (path.empty() || !fs::exists(path, error)) return {};
  try {
    ExemplarLibrary library{answer_to(CacheQuestion{path.string()})};
    if (library.exemplars.size() != kTerrains) return {};
    for (int t = 0; t < kTerrains; ++t) {
      measure_exemplar(library.exemplars[t], static_cast<Terrain>(t));
    }
    return library;
  } catch (const Interrupted&) {
    throw;
  } catch (const Error&) {
    return {};
  }
}

std::vector<Exemplar> CacheQuestion::here() const {
  std::vector<Exemplar> exemplars;
  try {
    const auto cache = nc::File::open(file);
    for (int t = 0; t < kTerrains; ++t) {
      const auto name = name_of(static_cast<Terrain>(t));
      const auto variable = cache.find_variable(name);
      if (!variable) return {};
      const auto dimensions = cache.dimensions_of(*variable);
      const auto cell_m = cache.numbers(*variable, "cell_m");
      if (dimensions.size() != 2 || cell_m.size() != 1) return {};
      Exemplar e{.name = std::string(name),
                 .nx = cache.length_of(dimensions[1]),
                 .ny = cache.length_of(dimensions[0]),
                 .cell_m = cell_m[0],
                 .periodic = true,
                 .elevation_m = {}};
      cache.check_size(*variable);
      e.elevation_m.resize(static_cast<std::size_t>(e.nx) * e.ny);
      nc::check(nc_get_var_float(cache.id(), *variable, e.elevation_m.data()));
      if (cache.text(*variable, "digest") != digest_of_elevation(e.elevation_m)) return {};
      exemplars.push_back(std::move(e));
    }
    return exemplars;
  } catch (const nc::Failure&) {
    return {};
  }
}

void write_cached(const fs::path& path, const ExemplarLibrary& library) {
  if (path.empty()) return;
  try {
    fs::create_directories(path.parent_path());
    AtomicFile target(path);
    auto file = nc::File::create(target.temporary());
    file.put(NC_GLOBAL, "title", "terrane: exemplars grown by this build; safe to delete");
    const Exemplar& first = library.exemplars.front();
    const std::array dimensions{file.define_dimension("y", first.ny),
                                file.define_dimension("x", first.nx)};
    std::vector<int> variables;
    for (const Exemplar& e : library.exemplars) {
      variables.push_back(file.define_variable(e.name, NC_FLOAT, dimensions));
      file.put(variables.back(), "units", "m");
      file.put(variables.back(), "long_name", "elevation");
      file.put(variables.back(), "cell_m", e.cell_m);
      file.put(variables.back(), "digest", digest_of_elevation(e.elevation_m));
    }
    nc::check(nc_enddef(file.id()));
    for (std::size_t k = 0; k < variables.size(); ++k) {
      nc::check(nc_put_var_float(file.id(), variables[k], library.exemplars[k].elevation_m.data()));
    }
    file.close();
    target.commit();
  } catch (const std::exception&) {
    // A run does not need its cache.
  }
}

}  // namespace geo::io
