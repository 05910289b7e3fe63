#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "export_source.hpp"
#include "geo/core/error.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "geo/kernels/remapping/healpix.hpp"
#include "io/netcdf/grid_description.hpp"
#include "io/netcdf/netcdf_file.hpp"
#include "zarr_store.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Geographic latitude of a sine of authalic latitude, by the planet's own rows: they know both.
class GeographicLatitude {
 public:
  explicit GeographicLatitude(const Ellipsoid& figure) : figure_(figure) {
    const double f = figure.flattening;
    eccentricity_ = std::sqrt(f * (2.0 - f));
    pole_ = q(1.0);
  }
  /// Newton's method on q (Snyder 1987, eq. 3-12), which is nearly linear in the sine.
  [[nodiscard]] double degrees(double authalic_sine) const {
    if (eccentricity_ == 0.0) return std::asin(authalic_sine) * kDegrees;
    double sine = authalic_sine;
    constexpr int kSteps = 6;
    for (int k = 0; k < kSteps; ++k) {
      const double e2 = eccentricity_ * eccentricity_;
      const double part = 1.0 - e2 * sine * sine;
      const double slope = 2.0 * (1.0 - e2) / (part * part);
      sine = std::min(1.0, std::max(-1.0, sine - (q(sine) - authalic_sine * pole_) / slope));
    }
    return std::asin(sine) * kDegrees;
  }

 private:
  [[nodiscard]] double q(double sine) const {
    const double e = eccentricity_;
    if (e == 0.0) return 2.0 * sine;
    return (1.0 - e * e) * (sine / (1.0 - e * e * sine * sine) + std::atanh(e * sine) / e);
  }
  Ellipsoid figure_;
  double eccentricity_ = 0.0, pole_ = 2.0;
};

constexpr const char* kCell = "cell";

/// A field whose numbers are only names takes the class of the largest area; others are means.
bool is_name(const FieldSpec& spec) {
  return spec.type != Type::float32 && spec.type != Type::float64;
}

struct Columns {
  int dimension;
  std::size_t chunk;
};

int define_pixels(const nc::File& file, const Columns& columns, std::string_view name, nc_type type,
                  int level) {
  const int variable = file.define_variable(name, type, std::array{columns.dimension});
  nc::check(nc_def_var_chunking(file.id(), variable, NC_CHUNKED, &columns.chunk));
  nc::check(nc_def_var_deflate(file.id(), variable, 1, 1, level));
  return variable;
}

void define_field(const nc::File& file, const Columns& columns, const FieldSpec& spec) {
  const bool name = is_name(spec);
  const int variable = define_pixels(file, columns, spec.name, name ? NC_INT : NC_FLOAT, 1);
  const float gap = std::numeric_limits<float>::quiet_NaN();
  const int none = spec.missing;
  nc::check(
      nc_def_var_fill(file.id(), variable, NC_FILL,
                      name ? static_cast<const void*>(&none) : static_cast<const void*>(&gap)));
  file.put(variable, "standard_name", spec.standard_name);
  file.put(variable, "long_name", spec.doc);
  if (spec.flags.empty()) file.put(variable, "units", spec.units);
  file.put(variable, "cell_methods", name ? "area: mode" : "area: mean");
  file.put(variable, "grid_mapping", "crs");
  file.put(variable, "coordinates", "lat lon");
  if (spec.flags.empty()) return;
  std::vector<int> values;
  std::string meanings;
  for (const Flag& flag : spec.flags) {
    values.push_back(flag.value);
    meanings += fmt::format("{}{}", meanings.empty() ? "" : " ", flag.meaning);
  }
  nc::check(
      nc_put_att_int(file.id(), variable, "flag_values", NC_INT, values.size(), values.data()));
  file.put(variable, "flag_meanings", meanings);
}

void define_mapping(const nc::File& file, const Healpix& pixels, const Ellipsoid& figure) {
  const int crs = file.define_variable("crs", NC_INT, {});
  file.put(crs, "grid_mapping_name", "healpix");
  const auto put = [&](const char* name, int value) {
    nc::check(nc_put_att_int(file.id(), crs, name, NC_INT, 1, &value));
  };
  put("refinement_level", std::countr_zero(static_cast<unsigned>(pixels.nside())));
  file.put(crs, "indexing_scheme", "nested");
  // The names that tools used before the convention had any.
  put("healpix_nside", pixels.nside());
  file.put(crs, "healpix_order", "nest");
  put_figure(file, crs, figure);
}

void write_positions(const nc::File& file, const Healpix& pixels, const Ellipsoid& figure) {
  const GeographicLatitude latitude(figure);
  std::vector<double> latitudes, longitudes;
  std::vector<std::int32_t> numbers;
  for (std::int32_t pixel = 0; pixel < pixels.size(); ++pixel) {
    const auto [sine, longitude] = pixels.centre(pixel);
    latitudes.push_back(latitude.degrees(sine));
    longitudes.push_back(longitude * kDegrees);
    numbers.push_back(pixel);
  }
  nc::check(nc_put_var_int(file.id(), *file.find_variable(kCell), numbers.data()));
  nc::check(nc_put_var_double(file.id(), *file.find_variable("lat"), latitudes.data()));
  nc::check(nc_put_var_double(file.id(), *file.find_variable("lon"), longitudes.data()));
  constexpr int kNoMeaning = 0;
  nc::check(nc_put_var_int(file.id(), *file.find_variable("crs"), &kNoMeaning));
}

void write_field(const nc::File& file, const ExportSource& source, const FieldSpec& spec,
                 const HealpixRemapping& remapping, const Healpix& pixels) {
  const auto values = shared_values(source, spec);
  const int variable = *file.find_variable(spec.name);
  if (is_name(spec)) {
    std::vector<std::int32_t> names, result(pixels.size());
    std::visit(
        [&](const auto& array) {
          for (const auto value : array) names.push_back(static_cast<std::int32_t>(value));
        },
        *values);
    remapping.dominant(names, result);
    nc::check(nc_put_var_int(file.id(), variable, result.data()));
    return;
  }
  std::vector<float> mean(pixels.size());
  remapping.mean(*as_floats(spec, values), mean);
  nc::check(nc_put_var_float(file.id(), variable, mean.data()));
}

void write_file(const fs::path& path, const ExportSource& source, bool all_fields, int nside) {
  const Grid& grid = source.grid();
  const Healpix pixels(nside != 0 ? nside : Healpix::side_like(grid));
  const HealpixRemapping remapping(grid, pixels);
  std::vector<const FieldSpec*> specs;
  for (const auto& [spec, values] : source.snapshot.fields) {
    // Numbers of cells mean nothing on other cells.
    const bool points_at_cells = spec == &field::flow_receiver || spec == &field::flow_direction;
    if (spec == source.field || (all_fields && !points_at_cells)) specs.push_back(spec);
  }
  auto file = nc::File::create(path);
  file.put(NC_GLOBAL, "Conventions", "CF-1.13");
  file.put(NC_GLOBAL, "title", source.provenance.title);
  file.put(NC_GLOBAL, "source", "terrane " + source.provenance.version);
  file.put(NC_GLOBAL, "history", source.provenance.history);
  file.put(NC_GLOBAL, "references", source.provenance.references);
  file.put(NC_GLOBAL, "terrane_seed", std::to_string(source.provenance.seed));
  constexpr int kMostChunk = 1 << 18;
  const Columns columns{file.define_dimension(kCell, pixels.size()),
                        static_cast<std::size_t>(std::min(pixels.size(), kMostChunk))};
  const int cell = define_pixels(file, columns, kCell, NC_INT, 1);
  file.put(cell, "standard_name", "healpix_index");
  file.put(cell, "long_name", "number of the pixel in nested order");
  file.put(cell, "units", "1");
  const int lat = define_pixels(file, columns, "lat", NC_DOUBLE, 1);
  file.put(lat, "standard_name", "latitude");
  file.put(lat, "units", "degrees_north");
  const int lon = define_pixels(file, columns, "lon", NC_DOUBLE, 1);
  file.put(lon, "standard_name", "longitude");
  file.put(lon, "units", "degrees_east");
  define_mapping(file, pixels, grid.figure());
  for (const FieldSpec* spec : specs) define_field(file, columns, *spec);
  nc::check(nc_enddef(file.id()));
  write_positions(file, pixels, grid.figure());
  for (const FieldSpec* spec : specs) write_field(file, source, *spec, remapping, pixels);
  file.close();
}

}  // namespace

void write_healpix(const fs::path& output, const ExportSource& source, bool all_fields, int nside) {
  const bool zarr = output.extension() == ".zarr" || !output.has_filename();
  const fs::path store = output.has_filename() ? output : output.parent_path();
  if (zarr) {
    const Scratch netcdf(store, "nc");
    try {
      write_file(netcdf.path(), source, all_fields, nside);
    } catch (const nc::Failure& failure) {
      throw IoError(fmt::format("cannot write {}: {}", store.string(), failure.what()));
    }
    write_zarr_store(netcdf.path(), store);
    return;
  }
  AtomicFile whole(output);
  try {
    write_file(whole.temporary(), source, all_fields, nside);
  } catch (const nc::Failure& failure) {
    whole.fail(failure.what());
  }
  whole.commit();
}

}  // namespace geo::io
