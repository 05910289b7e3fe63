#include "io/maps/sample_planet.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

#include "geo/core/field.hpp"

namespace geo::io {

std::shared_ptr<const Grid> small_sphere() {
  return std::make_shared<Grid>(Grid::sphere(360, 180));
}

std::vector<float> one_continent(const Grid& grid) {
  std::vector<float> elevation(grid.size());
  for (Index i = 0; i < grid.size(); ++i) {
    const double longitude = grid.longitude_deg(grid.column(i));
    const double hills = std::sin(0.2 * longitude) * std::sin(0.15 * grid.row(i));
    elevation[i] = static_cast<float>(std::abs(longitude) < 60.0 ? 900.0 + 800.0 * hills
                                                                 : -3500.0 + 1500.0 * hills);
  }
  return elevation;
}

State full_state() {
  State state(small_sphere());
  const Grid& grid = state.grid();
  const auto n = static_cast<std::size_t>(grid.size());
  state.set(field::elevation, one_continent(grid));
  std::vector<float> temperature(n), rain(n), east(n), north(n), discharge(n, 0.0F);
  std::vector<Index> receiver(n);
  std::vector<std::int8_t> biome(n), koppen(n);
  for (Index i = 0; i < grid.size(); ++i) {
    const double latitude = grid.latitude_deg(grid.row(i)) * std::numbers::pi / 180.0;
    temperature[i] = static_cast<float>(28.0 - 50.0 * std::pow(std::sin(latitude), 2));
    rain[i] = static_cast<float>(2000.0 * std::pow(std::cos(latitude), 4));
    east[i] = static_cast<float>(8.0 * std::cos(3.0 * latitude));
    north[i] = static_cast<float>(2.0 * std::sin(4.0 * latitude));
    const bool land = state.read(field::elevation)[i] >= 0.0F;
    biome[i] = static_cast<std::int8_t>(land ? 1 + grid.row(i) / 20 : 0);
    koppen[i] = static_cast<std::int8_t>(land ? 1 + grid.row(i) / 7 : 0);
    receiver[i] = land ? grid.neighbour(i, kEast) : i;
    if (land) discharge[i] = static_cast<float>(grid.column(i));
  }
  state.set(field::temperature, temperature);
  state.set(field::precipitation, rain);
  state.set(field::wind_east, east);
  state.set(field::wind_north, north);
  state.set(field::flow_receiver, receiver);
  state.set(field::discharge, discharge);
  state.set(field::lake_depth, std::vector<float>(n, 0.0F));
  state.set(field::biome, biome);
  state.set(field::koppen_class, koppen);
  state.set(field::net_primary_productivity, rain);
  state.set(field::settlement_suitability, std::vector<float>(n, 0.5F));
  std::vector<std::int16_t> plate(n);
  std::vector<std::int8_t> boundary(n, 0), rock(n);
  std::vector<float> age(n), thickness(n), continent(n);
  for (Index i = 0; i < grid.size(); ++i) {
    const double longitude = grid.longitude_deg(grid.column(i));
    plate[i] = static_cast<std::int16_t>(longitude < 90.0 ? grid.row(i) / 60 : 7);
    if (std::abs(longitude - 90.0) < 3.0) boundary[i] = 2;
    rock[i] = static_cast<std::int8_t>(grid.row(i) % 6);
    continent[i] = std::abs(longitude) < 70.0 ? 1.0F : 0.0F;
    age[i] = static_cast<float>(std::abs(longitude - 90.0));
    thickness[i] = continent[i] > 0.0F ? 38000.0F : 7000.0F;
  }
  state.set(field::plate_id, plate);
  state.set(field::boundary_type, boundary);
  state.set(field::plate_velocity_east, std::vector<float>(n, 40.0F));
  state.set(field::plate_velocity_north, std::vector<float>(n, -20.0F));
  state.set(field::continental_fraction, continent);
  state.set(field::crust_age, age);
  state.set(field::crust_thickness, thickness);
  state.set(field::rock_type, rock);
  return state;
}

}  // namespace geo::io
