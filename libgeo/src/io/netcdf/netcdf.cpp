#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "chunk_writer.hpp"
#include "geo/core/error.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "geo/io/files/digest.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "grid_description.hpp"
#include "netcdf_file.hpp"
#include "stage_names.hpp"

namespace geo::io {
namespace {

constexpr int kDeflateLevel = 1;  // what the header says; chunks come compressed
constexpr int kChunk = 512;
constexpr int kMonths = Climatology::kMonths;
constexpr const char *kMonth = "month", *kClimatologyBounds = "climatology_bounds";

/// Chunk length near `kChunk` that leaves the last chunk nearly full.
std::size_t chunk_length(int cells) {
  const int chunks = (cells + kChunk - 1) / kChunk;
  return static_cast<std::size_t>((cells + chunks - 1) / chunks);
}

ChunkShape chunk_shape(const Grid& grid) {
  return {chunk_length(grid.ny()), chunk_length(grid.nx())};
}

/// A raster over rows and columns, and over a time before them where there is one.
int define_raster(const nc::File& file, const Grid& grid, const GridVariables& ids,
                  std::string_view name, nc_type type, std::optional<int> time = {}) {
  std::vector<int> dimensions{ids.row_dimension, ids.column_dimension};
  const ChunkShape chunk = chunk_shape(grid);
  std::vector<std::size_t> chunks{chunk.rows, chunk.columns};
  if (time) {
    dimensions.insert(dimensions.begin(), *time);
    chunks.insert(chunks.begin(), 1);
  }
  const int variable = file.define_variable(name, type, dimensions);
  nc::check(nc_def_var_chunking(file.id(), variable, NC_CHUNKED, chunks.data()));
  nc::check(nc_def_var_deflate(file.id(), variable, 1, 1, kDeflateLevel));
  return variable;
}

void define_cell_area(const nc::File& file, const Grid& grid, const GridVariables& ids) {
  const int variable = define_raster(file, grid, ids, kCellArea, NC_DOUBLE);
  file.put(variable, "standard_name", "cell_area");
  file.put(variable, "long_name", "area of the cell");
  file.put(variable, "units", "m2");
  if (ids.has_coordinates) file.put(variable, "coordinates", "lat lon");
}

template <class T>
void put_integers(const nc::File& file, int variable, const char* name, nc_type type,
                  const std::vector<T>& values) {
  nc::check(nc_put_att(file.id(), variable, name, type, values.size(), values.data()));
}

/// `_FillValue`, and flags in the variable's own type.
template <class T>
void put_typed_attributes(const nc::File& file, int variable, const FieldSpec& spec) {
  T fill{};
  if constexpr (std::is_floating_point_v<T>) {
    fill = std::numeric_limits<T>::quiet_NaN();
  } else {
    fill = static_cast<T>(spec.missing);
  }
  nc::check(nc_def_var_fill(file.id(), variable, NC_FILL, &fill));
  for (const auto& [name, bound] :
       {std::pair{"valid_min", spec.least}, std::pair{"valid_max", spec.most}}) {
    if (std::isinf(bound)) continue;
    const T value = static_cast<T>(bound);
    nc::check(nc_put_att(file.id(), variable, name, nc::type_of(spec.type), 1, &value));
  }
  if (spec.flags.empty()) return;
  std::vector<T> values;
  std::string meanings;
  for (const Flag& flag : spec.flags) {
    values.push_back(static_cast<T>(flag.value));
    if (!meanings.empty()) meanings += ' ';
    meanings += flag.meaning;
  }
  put_integers(file, variable, "flag_values", nc::type_of(spec.type), values);
  file.put(variable, "flag_meanings", meanings);
}

/// The axis of a frame: a plain number, as there is no calendar of millions of years that clients
/// would read. Of one entry, so that frames put one behind another are a series. Returns the
/// dimension.
int define_time(const nc::File& file) {
  const int dimension = file.define_dimension(kFrameTime, 1);
  const int time = file.define_variable(kFrameTime, NC_DOUBLE, std::array{dimension});
  file.put(time, "long_name", "time since plates began to drift");
  file.put(time, "units", "Myr");
  file.put(time, "axis", "T");
  return dimension;
}

void define_field(const nc::File& file, const Grid& grid, const GridVariables& ids,
                  const FieldSpec& spec, const Values& values, std::optional<int> time,
                  const std::string& cell_methods) {
  const int variable = define_raster(file, grid, ids, spec.name, nc::type_of(spec.type), time);
  std::visit([&]<class T>(const std::vector<T>&) { put_typed_attributes<T>(file, variable, spec); },
             values);
  file.put(variable, "standard_name", spec.standard_name);
  file.put(variable, "long_name", spec.doc);
  if (spec.flags.empty()) file.put(variable, "units", spec.units);
  file.put(variable, "cell_methods", cell_methods);
  file.put(variable, "cell_measures", "area: cell_area");
  if (ids.has_mapping) file.put(variable, "grid_mapping", kMapping);
  if (ids.has_coordinates) file.put(variable, "coordinates", "lat lon");
}

/// A climatological year (CF 7.4): the middles of twelve equal months and their bounds, in days of
/// a year of 365. Returns the dimension.
int define_months(const nc::File& file) {
  const int dimension = file.define_dimension(kMonth, kMonths);
  const int bounds = file.define_dimension("month_bounds", 2);
  const int month = file.define_variable(kMonth, NC_DOUBLE, std::array{dimension});
  file.put(month, "standard_name", "time");
  file.put(month, "long_name", "month of the climatological year");
  file.put(month, "units", "days since 2001-01-01");
  file.put(month, "calendar", "365_day");
  file.put(month, "axis", "T");
  file.put(month, "climatology", kClimatologyBounds);
  file.define_variable(kClimatologyBounds, NC_DOUBLE, std::array{dimension, bounds});
  return dimension;
}

void write_months(const nc::File& file) {
  constexpr double kDays = 365.0 / kMonths;
  std::array<double, kMonths> middle{};
  std::array<double, 2 * kMonths> bounds{};
  for (int m = 0; m < kMonths; ++m) {
    middle[m] = (m + 0.5) * kDays;
    bounds[2 * m] = m * kDays;
    bounds[2 * m + 1] = (m + 1) * kDays;
  }
  nc::check(nc_put_var_double(file.id(), *file.find_variable(kMonth), middle.data()));
  nc::check(nc_put_var_double(file.id(), *file.find_variable(kClimatologyBounds), bounds.data()));
}

std::string monthly_cell_methods(const FieldSpec& spec) {
  const bool sum = &spec == &field::precipitation_monthly;
  return fmt::format("area: mean month: {} within years month: mean over years",
                     sum ? "sum" : "mean");
}

/// Annual values that a field of months belongs to; none for winds.
std::span<const float> annual_values(const Snapshot& snapshot, const FieldSpec& monthly) {
  const FieldSpec* annual = &monthly == &field::temperature_monthly ? &field::temperature
                            : &monthly == &field::precipitation_monthly
                                ? static_cast<const FieldSpec*>(&field::precipitation)
                                : nullptr;
  for (const auto& [spec, values] : snapshot.fields) {
    if (spec == annual) return std::get<std::vector<float>>(*values);
  }
  return {};
}

/// Arrays to go on from, each with a dimension of its own length.
void write_checkpoint(const nc::File& file, const Checkpoint& checkpoint) {
  nc::check(nc_put_var_double(file.id(), *file.find_variable(kFrameTime), &checkpoint.time_myr));
  int group = 0;
  nc::check(nc_redef(file.id()));
  nc::check(nc_def_grp(file.id(), kCheckpointGroup, &group));
  const std::string digest = digest_of(checkpoint);
  nc::check(nc_put_att_text(group, NC_GLOBAL, kCheckpointDigest, digest.size(), digest.data()));
  for (const auto& [name, values] : checkpoint.arrays) {
    std::visit(
        [&, &name = name]<class T>(const std::vector<T>& array) {
          int dimension = 0, variable = 0;
          nc::check(nc_def_dim(group, ("n_" + name).c_str(), array.size(), &dimension));
          nc::check(
              nc_def_var(group, name.c_str(), nc::type_of(type_of<T>()), 1, &dimension, &variable));
          if (array.size() > 4096) {
            nc::check(nc_def_var_deflate(group, variable, 1, 1, kDeflateLevel));
          }
          nc::check(nc_enddef(file.id()));
          nc::check(nc_put_var(group, variable, array.data()));
          nc::check(nc_redef(file.id()));
        },
        values);
  }
  nc::check(nc_enddef(file.id()));
}

void put_provenance(const nc::File& file, const Snapshot& snapshot, const Provenance& provenance) {
  file.put(NC_GLOBAL, "Conventions", "CF-1.10");
  file.put(NC_GLOBAL, "title", provenance.title);
  file.put(NC_GLOBAL, "source", "terrane " + provenance.version);
  file.put(NC_GLOBAL, "history", provenance.history);
  file.put(NC_GLOBAL, "references", provenance.references);
  file.put(NC_GLOBAL, "terrane_version", provenance.version);
  file.put(NC_GLOBAL, "terrane_stage", snapshot.stage);
  // As text: not every client reads unsigned 64-bit attributes.
  file.put(NC_GLOBAL, "terrane_seed", std::to_string(provenance.seed));
  // As an attribute the text, some 40 kB, would fill what every client prints and hands on.
  file.put(NC_GLOBAL, kConfigDigest, digest_of(provenance.config_toml));
  const int text = file.define_variable(kConfig, NC_STRING, {});
  file.put(text, "long_name", "resolved configuration of the run, TOML");
}

void check_snapshot(const Snapshot& snapshot) {
  for (const auto& [spec, values] : snapshot.fields) {
    const auto size = std::visit([](const auto& array) { return array.size(); }, *values);
    if (size != static_cast<std::size_t>(snapshot.grid->size()) ||
        values->index() != static_cast<std::size_t>(spec->type)) {
      throw Bug("field " + std::string(spec->name) + " does not fit its file");
    }
  }
}

/// Everything but the rasters' values.
void write_frame(const std::filesystem::path& path, const Snapshot& snapshot,
                 const Provenance& provenance) {
  const Grid& grid = *snapshot.grid;
  auto file = nc::File::create(path);
  put_provenance(file, snapshot, provenance);
  const GridVariables ids = define_grid(file, grid);
  define_cell_area(file, grid, ids);
  std::optional<int> time;
  if (snapshot.checkpoint) time = define_time(file);
  for (const auto& [spec, values] : snapshot.fields) {
    define_field(file, grid, ids, *spec, *values, time, std::string(spec->cell_methods));
  }
  if (snapshot.months) {
    const int months = define_months(file);
    for (const FieldSpec* spec : field::monthly()) {
      define_field(file, grid, ids, *spec, std::vector<float>(), months,
                   monthly_cell_methods(*spec));
    }
  }
  nc::check(nc_enddef(file.id()));
  write_coordinates(file, grid);
  if (snapshot.months) write_months(file);
  const char* text = provenance.config_toml.c_str();
  nc::check(nc_put_var_string(file.id(), *file.find_variable(kConfig), &text));
  if (snapshot.checkpoint) write_checkpoint(file, *snapshot.checkpoint);
  file.close();
}

void write_rasters(const std::filesystem::path& path, const Snapshot& snapshot, int level,
                   const std::function<void(const FieldSpec&)>& written) {
  const Grid& grid = *snapshot.grid;
  const ChunkShape chunk = chunk_shape(grid);
  ChunkWriter file(path, level);
  file.write_rows(kCellArea, row_areas(grid), grid.nx(), chunk);
  for (const auto& [spec, values] : snapshot.fields) {
    file.write(spec->name, *values, grid.ny(), grid.nx(), chunk);
    if (written && !snapshot.months) written(*spec);  // months are made from those of the year
  }
  if (snapshot.months) {
    Values month = std::vector<float>(static_cast<std::size_t>(grid.size()));
    for (const FieldSpec* spec : field::monthly()) {
      const auto annual = annual_values(snapshot, *spec);
      for (int m = 0; m < kMonths; ++m) {
        snapshot.months(*spec, m, annual, std::get<std::vector<float>>(month));
        file.write(spec->name, month, grid.ny(), grid.nx(), chunk, m);
      }
    }
  }
  file.close();
}

}  // namespace

void write_netcdf(const std::filesystem::path& path, const Snapshot& snapshot,
                  const Provenance& provenance, int compression,
                  const std::function<void(const FieldSpec&)>& written) {
  check_snapshot(snapshot);
  AtomicFile whole(path);
  try {
    write_frame(whole.temporary(), snapshot, provenance);
    write_rasters(whole.temporary(), snapshot, compression, written);
  } catch (const nc::Failure& failure) {
    whole.fail(failure.what());
  }
  whole.commit();
}

}  // namespace geo::io
