#include "planet_months.hpp"

#include "geo/core/field.hpp"
#include "geo/io/netcdf/stage_file.hpp"

namespace geo::io {
namespace {

std::vector<float> thinned(const std::vector<float>& values, const Grid& grid,
                           const Thinning& cells) {
  std::vector<float> out;
  out.reserve(cells.size());
  for (int j = 0; j < cells.ny; ++j) {
    for (int i = 0; i < cells.nx; ++i) {
      out.push_back(values[grid.cell(cells.column(i), cells.row(j))]);
    }
  }
  return out;
}

}  // namespace

std::optional<PlanetMonths> read_planet_months(const std::filesystem::path& file, const Grid& grid,
                                               int most_columns) {
  PlanetMonths months{Thinning(grid, most_columns), {}, {}};
  for (int m = 0; m < Climatology::kMonths; ++m) {
    const auto temperature = read_month(file, field::temperature_monthly, m);
    const auto rain = read_month(file, field::precipitation_monthly, m);
    const auto size = static_cast<std::size_t>(grid.size());
    if (temperature.size() != size || rain.size() != size) return {};
    months.temperature_c[m] = thinned(temperature, grid, months.cells);
    months.precipitation_mm[m] = thinned(rain, grid, months.cells);
  }
  return months;
}

}  // namespace geo::io
