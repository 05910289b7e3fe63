// Stage files and frames of drift, as `info`, `score`, `maps` and --resume read them.
#include "geo/io/netcdf/stage_file.hpp"

#include "made_netcdf.hpp"

namespace {

using geo::fuzz::Bytes;
using geo::fuzz::MadeNetcdf;

constexpr const char* kTopologies[] = {"sphere", "window", "plane", "equal_area", "torus"};

nc_type type_of(geo::Type type) {
  constexpr nc_type kTypes[] = {NC_FLOAT, NC_DOUBLE, NC_BYTE, NC_SHORT, NC_INT};
  return kTypes[static_cast<int>(type)];
}

void make(const std::string& path, Bytes& bytes) {
  MadeNetcdf file(path, bytes);
  const int which = bytes.below(5);
  const bool degrees = which < 2;
  const int rows = file.dimension(degrees ? "lat" : "y", 3 + bytes.below(6));
  const int columns = file.dimension(degrees ? "lon" : "x", 2 * (2 + bytes.below(5)));
  file.text(NC_GLOBAL, "terrane_grid",
            bytes.one_in(16) ? bytes.word(kTopologies) : kTopologies[which]);
  file.text(NC_GLOBAL, "terrane_grid_edges", bytes.one_in(2) ? "open" : "closed");
  file.numbers(NC_GLOBAL, "terrane_grid_spacing_m", {1000.0, 1000.0});
  file.numbers(NC_GLOBAL, "terrane_grid_window_deg", {-10.0, 20.0, 5.0, 45.0});
  if (!bytes.one_in(3)) file.numbers(NC_GLOBAL, "terrane_grid_centre_deg", {10.0, 20.0});
  file.numbers(NC_GLOBAL, "terrane_grid_radius_m", {6371000.0});
  file.numbers(NC_GLOBAL, "terrane_grid_flattening", {bytes.one_in(2) ? 0.0 : 0.00335});
  file.text(NC_GLOBAL, "terrane_stage", "climate");
  file.text(NC_GLOBAL, "terrane_seed", bytes.one_in(8) ? bytes.text(24) : "42");
  file.text(NC_GLOBAL, "terrane_version", "0.1.0");
  file.text(NC_GLOBAL, "history", bytes.one_in(8) ? bytes.text(24) : "made");
  file.text(NC_GLOBAL, "terrane_config", bytes.one_in(8) ? bytes.text(24) : "[run]\nseed = 42\n");
  const auto& vocabulary = geo::field::all();
  for (int count = 1 + bytes.below(4); count > 0; --count) {
    const geo::FieldSpec& spec = *vocabulary[bytes.below(static_cast<int>(vocabulary.size()))];
    const int variable =
        file.variable(std::string(spec.name), type_of(spec.type), {rows, columns}, 0.0, 5.0);
    if (variable >= 0) file.text(variable, "units", std::string(spec.units));
  }
  if (!bytes.one_in(4)) return;
  file.variable("drift_time", NC_DOUBLE, {}, 12.5, 12.5);
  int group = 0;
  if (nc_def_grp(file.id(), "checkpoint", &group) != NC_NOERR) return;
  constexpr const char* kNames[] = {"plate", "age_myr", "elevation_m", "rotation"};
  for (int count = bytes.below(5); count > 0; --count) {
    const std::string name = bytes.word(kNames);
    int dimension = 0, variable = 0;
    const int dimensions = bytes.one_in(16) ? bytes.below(3) : 1;
    const std::size_t size = bytes.one_in(32) ? bytes.value<std::uint32_t>() : bytes.below(200);
    if (nc_def_dim(group, ("n_" + name).c_str(), size, &dimension) == NC_NOERR) {
      const int all[] = {dimension, dimension};
      nc_def_var(group, name.c_str(), 1 + bytes.below(NC_STRING), dimensions, all, &variable);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const geo::fuzz::InputFile file("input.nc");
  Bytes bytes(data, size);
  make(file.path(), bytes);
  geo::fuzz::expect_value_or_refusal([&] {
    const geo::io::Snapshot snapshot = geo::io::read_netcdf(file.path());
    for (const auto& [spec, values] : snapshot.fields) {
      const auto count = std::visit([](const auto& array) { return array.size(); }, *values);
      geo::fuzz::claim(count == static_cast<std::size_t>(snapshot.grid->size()),
                       "a field has a value for each cell");
    }
  });
  geo::fuzz::expect_value_or_refusal(
      [&] { static_cast<void>(geo::io::read_provenance(file.path())); });
  geo::fuzz::expect_value_or_refusal(
      [&] { static_cast<void>(geo::io::read_checkpoint(file.path())); });
  return 0;
}
