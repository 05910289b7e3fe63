#include "geo/io/export/export.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "export_source.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/recorded_file.hpp"
#include "geo/io/run/run_folder.hpp"
#include "geo/io/run/run_pictures.hpp"
#include "geo/kernels/remapping/healpix.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

struct FormatRow {
  std::string_view name;
  ExportFormat format;
  const char* extension;
};
constexpr std::array<FormatRow, 7> kFormats{{{"png16", ExportFormat::png16, ".png"},
                                             {"r16", ExportFormat::r16, ".r16"},
                                             {"geotiff", ExportFormat::geotiff, ".tif"},
                                             {"zarr", ExportFormat::zarr, ".zarr"},
                                             {"healpix", ExportFormat::healpix, ".nc"},
                                             {"glb", ExportFormat::glb, ".glb"},
                                             {"gplates", ExportFormat::gplates, ""}}};

const FormatRow& row_of(ExportFormat format) {
  return *std::find_if(kFormats.begin(), kFormats.end(),
                       [&](const FormatRow& row) { return row.format == format; });
}

bool is_height_map(ExportFormat format) {
  return format == ExportFormat::png16 || format == ExportFormat::r16;
}

bool takes_all_fields(const ExportRequest& request) {
  return request.field.empty() &&
         (request.format == ExportFormat::zarr || request.format == ExportFormat::healpix);
}

void check_goes_together(const ExportRequest& request) {
  const auto refuse = [&](std::string_view option, std::string_view with) {
    throw ConfigurationError(fmt::format("{} goes with --format {}, not with {}", option, with,
                                         row_of(request.format).name));
  };
  if (!is_height_map(request.format)) {
    if (request.tile_samples != 0) refuse("--tiles", "png16 or r16");
    if (request.cube) refuse("--layout cube", "png16 or r16");
    if (!request.masks.empty()) refuse("--masks", "png16 or r16");
    if (request.range) refuse("--range", "png16 or r16");
  }
  if (request.format == ExportFormat::gplates) {
    constexpr std::string_view kOfFields = "png16, r16, geotiff, zarr, healpix or glb";
    if (!request.field.empty()) refuse("--field", kOfFields);
    if (!request.stage.empty()) refuse("--stage", kOfFields);
  }
  if (request.nside != 0) {
    if (request.format != ExportFormat::healpix) refuse("--nside", "healpix");
    static_cast<void>(Healpix(request.nside));
  }
  constexpr int kLeastTile = 3;
  if (request.tile_samples != 0 && request.tile_samples < kLeastTile) {
    throw ConfigurationError(
        fmt::format("--tiles {}: must be {} samples at least", request.tile_samples, kLeastTile));
  }
  if (request.range && !(request.range->first < request.range->second)) {
    throw ConfigurationError(
        fmt::format("--range {:g},{:g}: the first must be less than the second",
                    request.range->first, request.range->second));
  }
}

}  // namespace

std::vector<std::string_view> export_format_names() {
  std::vector<std::string_view> names;
  for (const FormatRow& row : kFormats) names.push_back(row.name);
  return names;
}

ExportFormat parse_export_format(const std::string& name) {
  for (const FormatRow& row : kFormats) {
    if (row.name == name) return row.format;
  }
  const auto names = export_format_names();
  throw ConfigurationError(fmt::format("--format {}: must be one of {}{}", name,
                                       fmt::join(names, ", "), suggestion(name, names)));
}

bool ExportSource::has(const FieldSpec& spec) const {
  return std::any_of(snapshot.fields.begin(), snapshot.fields.end(),
                     [&](const auto& held) { return held.first == &spec; });
}

std::shared_ptr<const Values> shared_values(const ExportSource& source, const FieldSpec& spec) {
  for (const auto& [held, values] : source.snapshot.fields) {
    if (held == &spec) return values;
  }
  throw Bug(fmt::format("field {} is not there to be exported", spec.name));
}

const Values& ExportSource::of(const FieldSpec& spec) const { return *shared_values(*this, spec); }

ExportSource read_export_source(const ExportRequest& request) {
  const std::string name = request.field.empty() ? "elevation" : request.field;
  const bool all = takes_all_fields(request);
  const auto besides = [&](const FieldSpec& spec) {
    if (all) return false;
    if (&spec == &field::elevation) return true;
    constexpr std::array<const FieldSpec*, 6> kOfMasks{
        &field::biome, &field::river_intensity, &field::lake_depth,
        &field::slope, &field::drainage_area,   &field::elevation};
    return !request.masks.empty() &&
           std::find(kOfMasks.begin(), kOfMasks.end(), &spec) != kOfMasks.end();
  };
  const auto wanted = [&](const FieldSpec& spec) {
    return all || spec.name == name || besides(spec);
  };
  ExportSource source;
  std::error_code ignored;
  fs::path file;
  if (fs::is_directory(request.place, ignored)) {
    const RunFolder folder(request.place);
    if (!fs::exists(folder.manifest())) {
      throw ConfigurationError(fmt::format(
          "export: {} holds no run: give the folder of one, or a stage file", request.place));
    }
    FieldsOfRun found = read_fields_of_run(folder, {name, request.stage}, wanted, besides);
    file = found.file;
    source.snapshot = std::move(found.snapshot);
  } else {
    if (!request.stage.empty()) {
      throw ConfigurationError(fmt::format(
          "--stage {}: goes with the folder of a run; {} is a file", request.stage, request.place));
    }
    file = request.place;
    source.snapshot = read_perhaps_recorded(file, wanted);
  }
  source.provenance = read_provenance(file);
  source.field = field::find(name);
  if (source.field == nullptr || !source.has(*source.field)) {
    const Snapshot names = read_perhaps_recorded(file, [](const FieldSpec&) { return true; });
    std::vector<std::string_view> known;
    for (const auto& [spec, values] : names.fields) known.push_back(spec->name);
    throw ConfigurationError(fmt::format("{} has no field \"{}\"{}: it has {}", file.string(), name,
                                         suggestion(name, known), fmt::join(known, ", ")));
  }
  return source;
}

std::shared_ptr<const std::vector<float>> as_floats(const FieldSpec& spec,
                                                    std::shared_ptr<const Values> values) {
  if (const auto* floats = std::get_if<std::vector<float>>(values.get())) {
    return {std::move(values), floats};
  }
  auto converted = std::make_shared<std::vector<float>>();
  std::visit(
      [&]<class T>(const std::vector<T>& array) {
        converted->reserve(array.size());
        for (const T value : array) {
          const bool missing = std::is_integral_v<T> && value == static_cast<T>(spec.missing);
          converted->push_back(missing ? std::numeric_limits<float>::quiet_NaN()
                                       : static_cast<float>(value));
        }
      },
      *values);
  return converted;
}

std::string proj_words(const Grid& grid) {
  const Ellipsoid& figure = grid.figure();
  const std::string body = figure.flattening == 0.0 ? fmt::format("+R={}", figure.radius_m)
                                                    : fmt::format("+a={} +rf={}", figure.radius_m,
                                                                  1.0 / figure.flattening);
  if (grid.is_latitude_longitude()) {
    return fmt::format("+proj=longlat {} +no_defs +type=crs", body);
  }
  if (!grid.is_projected()) return {};
  return fmt::format("+proj=laea +lat_0={} +lon_0={} {} +units=m +no_defs +type=crs",
                     grid.centre()->latitude_deg, grid.centre()->longitude_deg, body);
}

std::vector<fs::path> export_field(const ExportRequest& request) {
  check_goes_together(request);
  if (request.format == ExportFormat::gplates) {
    return export_gplates(request.place, request.output.empty() ? "gplates" : request.output);
  }
  const ExportSource source = read_export_source(request);
  fs::path output = request.output;
  if (output.empty()) {
    output = (takes_all_fields(request) ? source.snapshot.stage : std::string(source.field->name)) +
             row_of(request.format).extension;
  }
  const bool all = takes_all_fields(request);
  switch (request.format) {
    case ExportFormat::png16:
    case ExportFormat::r16:
      return export_height_map(request, source, output);
    case ExportFormat::geotiff:
      write_geotiff(output, source);
      break;
    case ExportFormat::zarr:
      write_zarr(output, source, all);
      break;
    case ExportFormat::healpix:
      write_healpix(output, source, all, request.nside);
      break;
    case ExportFormat::glb:
      write_glb(output, source, request.exaggeration);
      break;
    case ExportFormat::gplates:
      throw Bug("an export for GPlates is of a run, not of a field");
  }
  return {output};
}

}  // namespace geo::io
