#include "geo/io/input/exemplar_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "exemplar_cache.hpp"
#include "geo/core/error.hpp"
#include "geo/io/input/dem.hpp"
#include "geo/kernels/exemplars/exemplar_detail.hpp"
#include "geotiff.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
  for (char& letter : text)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

bool is_netcdf(const fs::path& path) {
  const std::string end = lower(path.extension().string());
  return end == ".nc" || end == ".nc4" || end == ".cdf" || end == ".grd";
}

bool is_tiff(const fs::path& path) {
  const std::string end = lower(path.extension().string());
  return end == ".tif" || end == ".tiff";
}

std::vector<fs::path> dems_in(const fs::path& folder) {
  std::vector<fs::path> paths;
  try {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (is_netcdf(entry.path()) || is_tiff(entry.path())) paths.push_back(entry.path());
    }
  } catch (const fs::filesystem_error& error) {
    throw IoError(
        fmt::format("exemplars: {}: cannot be read: {}", folder.string(), error.code().message()));
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// The terrain that a file's name says.
std::optional<Terrain> named_terrain(const fs::path& path) {
  const std::string name = lower(path.stem().string());
  std::string word;
  for (std::size_t at = 0; at <= name.size(); ++at) {
    if (at < name.size() && std::isalpha(static_cast<unsigned char>(name[at])) != 0) {
      word += name[at];
      continue;
    }
    if (word == "andean") return Terrain::andean;
    if (word == "himalayan") return Terrain::himalayan;
    if (word == "old") return Terrain::old_mountains;
    if (word == "plain") return Terrain::plain;
    word.clear();
  }
  return {};
}

/// Square cells as small as the smaller side of those of a DEM.
Exemplar squared(const Dem& dem) {
  const Grid& from = dem.grid;
  const int middle = from.ny() / 2;
  const double dx = from.spacing_east_m(middle), dy = from.spacing_north_m(middle - 1);
  Exemplar e;
  e.cell_m = std::min(dx, dy);
  constexpr double kSame = 0.01;
  if (std::abs(dx - dy) <= kSame * e.cell_m) {
    e.nx = from.nx();
    e.ny = from.ny();
    e.elevation_m = dem.elevation_m;
    return e;
  }
  e.nx = static_cast<int>(from.nx() * dx / e.cell_m);
  e.ny = static_cast<int>(from.ny() * dy / e.cell_m);
  e.elevation_m.resize(static_cast<std::size_t>(e.nx) * e.ny);
  for (int j = 0; j < e.ny; ++j) {
    const double y = std::clamp((j + 0.5) * e.cell_m / dy - 0.5, 0.0, from.ny() - 1.0);
    const int row = std::min(static_cast<int>(y), from.ny() - 2);
    for (int i = 0; i < e.nx; ++i) {
      const double x = std::clamp((i + 0.5) * e.cell_m / dx - 0.5, 0.0, from.nx() - 1.0);
      const int column = std::min(static_cast<int>(x), from.nx() - 2);
      const auto at = [&](int a, int b) {
        return static_cast<double>(dem.elevation_m[from.cell(column + a, row + b)]);
      };
      const double south = std::lerp(at(0, 0), at(1, 0), x - column);
      const double north = std::lerp(at(0, 1), at(1, 1), x - column);
      e.elevation_m[static_cast<std::size_t>(j) * e.nx + i] =
          static_cast<float>(std::lerp(south, north, y - row));
    }
  }
  return e;
}

/// The largest rectangle of an exemplar without missing cells, large and square alike: on each row
/// cells stand on columns of whole ones, and each column is widened as far as its neighbours are as
/// high.
void cut_to_whole(Exemplar& e) {
  const auto missing = [&](int column, int row) {
    return !std::isfinite(e.elevation_m[static_cast<std::size_t>(row) * e.nx + column]);
  };
  struct Column {
    int left, height;
  };
  std::int64_t best = 0;
  int left = 0, bottom = 0, nx = 0, ny = 0;
  std::vector<int> height(e.nx + 1, 0);  // the last stays 0 and closes all
  std::vector<Column> open;
  for (int j = 0; j < e.ny; ++j) {
    for (int i = 0; i <= e.nx; ++i) {
      if (i < e.nx) height[i] = missing(i, j) ? 0 : height[i] + 1;
      int from = i;
      while (!open.empty() && open.back().height >= height[i]) {
        const auto [begin, tall] = open.back();
        open.pop_back();
        from = begin;
        const std::int64_t wide = i - begin,
                           worth = std::min<std::int64_t>(wide, tall) * (wide + tall);
        if (worth <= best) continue;
        best = worth;
        left = begin;
        bottom = j + 1 - tall;
        nx = static_cast<int>(wide);
        ny = tall;
      }
      open.push_back({from, height[i]});
    }
    open.clear();
  }
  if (nx == e.nx && ny == e.ny) return;
  std::vector<float> cut;
  for (int j = bottom; j < bottom + ny; ++j) {
    const auto row = e.elevation_m.begin() + static_cast<std::ptrdiff_t>(j) * e.nx + left;
    cut.insert(cut.end(), row, row + nx);
  }
  e.elevation_m = std::move(cut);
  e.nx = nx;
  e.ny = ny;
}

double shorter_side_km(const Exemplar& e) { return 1e-3 * std::min(e.nx, e.ny) * e.cell_m; }

/// With grown ones for the terrains that a library has none of.
std::shared_ptr<const ExemplarLibrary> completed(ExemplarLibrary library, const GrownSize& size) {
  std::array<bool, kTerrains> there{};
  for (const Exemplar& e : library.exemplars) there[static_cast<std::size_t>(e.terrain)] = true;
  if (std::find(there.begin(), there.end(), false) != there.end()) {
    for (Exemplar& grown : grown_exemplars(size).exemplars) {
      if (there[static_cast<std::size_t>(grown.terrain)]) continue;
      library.exemplars.push_back(std::move(grown));
    }
  }
  return std::make_shared<const ExemplarLibrary>(std::move(library));
}

}  // namespace

ExemplarLibrary read_exemplars(const fs::path& folder, const Planet& planet) {
  ExemplarLibrary library;
  for (const fs::path& path : dems_in(folder)) {
    try {
      const Dem dem =
          is_tiff(path) ? read_geotiff(path, planet) : read_dem_with_gaps(path.string(), planet);
      try {
        Exemplar exemplar = squared(dem);
        cut_to_whole(exemplar);
        exemplar.name = path.stem().string();
        measure_exemplar(exemplar, named_terrain(path));
        library.exemplars.push_back(std::move(exemplar));
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", path.string(), error.what()));
      }
    } catch (const Error& error) {
      throw Error(error.kind(), fmt::format("exemplars: {}", error.what()));
    }
  }
  if (library.exemplars.empty()) {
    throw InputError(fmt::format(
        "exemplars: {} holds no elevation model: must hold NetCDF (.nc) or GeoTIFF (.tif) files of "
        "elevations in metres",
        folder.string()));
  }
  return library;
}

ExemplarLibrary grown_exemplars(const GrownSize& size) {
  const fs::path cache = exemplar_cache(size);
  if (auto library = read_cached(cache)) return std::move(*library);
  ExemplarLibrary library = grow_exemplars(size);
  write_cached(cache, library);
  return library;
}

bool asks_for_exemplars(std::span<const Parameter> parameters, std::string_view key) {
  const Parameter* detail = find_parameter(parameters, key);
  return detail != nullptr && detail->value() == ParameterValue("exemplars");
}

std::shared_ptr<const ExemplarLibrary> exemplars_of(const fs::path& folder, const Planet& planet) {
  ExemplarLibrary library;
  if (!folder.empty()) library = read_exemplars(folder, planet);
  return completed(std::move(library), kGrownForIslands);
}

std::shared_ptr<const ExemplarLibrary> planet_exemplars_of(const fs::path& folder,
                                                           const Planet& planet, double longest_m,
                                                           std::vector<std::string>& warnings) {
  ExemplarLibrary library;
  if (!folder.empty()) library = read_exemplars(folder, planet);
  std::vector<std::string> left_out;
  std::erase_if(library.exemplars, [&](const Exemplar& e) {
    const bool serves = holds_waves(e, longest_m);
    if (!serves) left_out.push_back(fmt::format("{} ({:.0f} km)", e.name, shorter_side_km(e)));
    return !serves;
  });
  if (!left_out.empty()) {
    warnings.push_back(fmt::format(
        "exemplars: too small or coarse for a planet's waves of {:.0f} km: {}; grown ones stand in "
        "(must be {:.0f} km a side, or isostasy.detail_longest_km less)",
        1e-3 * longest_m, fmt::join(left_out, ", "), 1e-3 * least_side_m(longest_m)));
  }
  return completed(std::move(library), kGrownForPlanets);
}

}  // namespace geo::io
