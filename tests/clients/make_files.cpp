// Writes stage files on every kind of grid into the folder named by the only argument, for
// check_files.py and paraview_check.py.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "geo/core/checkpoint.hpp"
#include "geo/core/error.hpp"
#include "geo/core/random.hpp"
#include "geo/io/netcdf/stage_file.hpp"

namespace {

using namespace geo;

/// Smooth values within the bounds of their field, with gaps in every third field.
template <class T>
Values smooth_values(const FieldSpec& spec, const Grid& grid, bool gaps) {
  std::vector<T> values(grid.size());
  const double low = std::isfinite(spec.least) ? spec.least : -1000.0;
  const double high = std::isfinite(spec.most) ? spec.most : low + 2000.0;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const int i = grid.column(cell), j = grid.row(cell);
    const double wave = std::sin(0.31 * i) * std::cos(0.17 * j);
    if constexpr (std::is_floating_point_v<T>) {
      const double share = 0.45 * (1.0 + wave) + 0.1 * j / grid.ny();
      values[cell] = static_cast<T>(low + share * (high - low));
      if (gaps && wave > 0.9) values[cell] = std::numeric_limits<T>::quiet_NaN();
    } else {
      const double most = spec.flags.empty() ? 100.0 : static_cast<double>(spec.flags.size() - 1);
      values[cell] = static_cast<T>(std::lround(0.5 * most * (1.0 + wave)));
      if (gaps && wave > 0.9) values[cell] = static_cast<T>(spec.missing);
    }
  }
  return values;
}

Values values_for(const FieldSpec& spec, const Grid& grid, bool gaps) {
  switch (spec.type) {
    case Type::float32:
      return smooth_values<float>(spec, grid, gaps);
    case Type::float64:
      return smooth_values<double>(spec, grid, gaps);
    case Type::int8:
      return smooth_values<std::int8_t>(spec, grid, gaps);
    case Type::int16:
      return smooth_values<std::int16_t>(spec, grid, gaps);
    case Type::int32:
      return smooth_values<std::int32_t>(spec, grid, gaps);
  }
  throw Bug("unknown type of field");
}

void write(const std::filesystem::path& folder, const std::string& name, Grid grid,
           std::vector<std::filesystem::path>& images, std::optional<double> time_myr = {},
           const std::vector<const FieldSpec*>& wanted = {field::all().begin(),
                                                          field::all().end()}) {
  io::Snapshot snapshot{name, std::make_shared<const Grid>(std::move(grid)), {}};
  int number = 0;
  for (const FieldSpec* spec : wanted) {
    snapshot.fields.emplace_back(
        spec, std::make_shared<const Values>(values_for(*spec, *snapshot.grid, number++ % 3 == 2)));
  }
  if (time_myr) {
    const Checkpoint checkpoint{*time_myr, {{"plate", std::vector<std::int16_t>{0, 1, 2}}}};
    snapshot.checkpoint = std::make_shared<const Checkpoint>(checkpoint);
  }
  // As long as that of a run, so that it would be seen where it does not belong.
  std::string configuration = "# every parameter\n";
  for (int k = 0; k < 1000; ++k) configuration += "# unit 1, design\nkey = 7\n";
  const io::Provenance provenance{
      "terrane: " + name, configuration, 7, "0.1.0", "2026-01-01T00:00:00Z: make_files", "none"};
  io::write_netcdf(folder / (name + ".nc"), snapshot, provenance);
  images.push_back(folder / (name + ".vti"));
  io::write_vti(images.back(), snapshot, provenance);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 2) throw ConfigurationError("usage: make_client_files FOLDER");
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  const Ellipsoid earth{6378137.0, 1 / 298.257223563};
  std::vector<std::filesystem::path> images;
  write(folder, "sphere", Grid::sphere(180, 90), images);
  write(folder, "ellipsoid", Grid::sphere(90, 45, earth), images);
  write(folder, "window", Grid::window(60, 40, {30.0, 50.0, -10.0, 20.0}, earth), images);
  write(folder, "plane", Grid::plane(50, 40, 90.0, 80.0), images);
  write(folder, "island", Grid::plane(64, 32, 500.0, 500.0, Edges::open, Centre{-38.0, 176.0}),
        images);
  write(folder, "torus", Grid::torus(48, 24, 1000.0, 1000.0), images);
  for (const double time_myr : {0.0, 250.0}) {
    write(folder, fmt::format("frame-{:03.0f}", time_myr), Grid::sphere(60, 30), images, time_myr);
  }
  // For exports alone: one with overviews, one in a projection.
  const std::vector<const FieldSpec*> some{&field::elevation, &field::drainage_area,
                                           &field::crust_age, &field::plate_id,
                                           &field::lake_id,   &field::biome};
  std::filesystem::create_directories(folder / "exports");
  std::vector<std::filesystem::path> others;
  write(folder / "exports", "large", Grid::sphere(1300, 650), others, {}, some);
  write(folder / "exports", "projected",
        Grid::equal_area(64, 48, 700.0, Centre{-38.0, 176.0}, earth), others, {}, some);
  io::write_pvd(folder / "planet.pvd", {images[0]});
  return 0;
} catch (const geo::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return static_cast<int>(error.kind());
}
