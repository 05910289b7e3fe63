#include "planet_months.hpp"

#include "geo/core/field.hpp"
#include "geo/io/netcdf/stage_file.hpp"

namespace geo::io {
std::optional<PlanetMonths> read_planet_months(const std::filesystem::path& file, const Grid& grid,
                                               int most_columns) {
  PlanetMonths months{Thinning(grid, most_columns), {}, {}};
  for (int m = 0; m < Climatology::kMonths; ++m) {
    const std::vector<float> temperature = read_month(file, field::temperature_monthly, m);
    const std::vector<float> rain = read_month(file, field::precipitation_monthly, m);
    const auto size = static_cast<std::size_t>(grid.size());
    if (temperature.size() != size || rain.size() != size) return {};
    months.temperature_c[m] = thinned(std::span<const float>(temperature), grid, months.cells);
    months.precipitation_mm[m] = thinned(std::span<const float>(rain), grid, months.cells);
  }
  return months;
}

}  // namespace geo::io
