#include "island_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/remapping/catmull_rom.hpp"
#include "island_cells.hpp"
#include "island_detail.hpp"
#include "island_plains.hpp"

namespace geo {
namespace {

/// The planet's surface at a place from Catmull-Rom, whose swings make no land between cells of
/// sea, and no sea between cells of land: where all four cells round the place are on one side of
/// the level of the sea, the cubic is bent where it has come half-way to that level from the
/// nearest of them, so that it never gets there. With h the height half-way, h^2 / (2 h - z) joins
/// z smoothly.
double planet_height_m(const Grid& planet, std::span<const float> elevation_m, Centre place) {
  const CatmullRom cubic(planet, place);
  const double height_m = cubic.of(elevation_m);
  const auto [least_m, most_m] = cubic.range(elevation_m);
  const auto bent_m = [&](double half_way_m) {
    return half_way_m * half_way_m / (2.0 * half_way_m - height_m);
  };
  if (most_m < 0.0F && height_m > 0.5 * most_m) return bent_m(0.5 * most_m);
  if (least_m > 0.0F && height_m < 0.5 * least_m) return bent_m(0.5 * least_m);
  return height_m;
}

/// Next to a shore, which would follow the sides of the planet's cells, the surface is read from a
/// place nearby: bays and headlands shorter than two cells, with as much land in each and nearly
/// the same mean elevation over each of the planet's cells.
void wind_coasts(const PlanetCells& cells, std::span<const float> planet_elevation_m,
                 const IslandParameters& p, std::uint64_t seed, std::span<const float> dry,
                 std::span<const float> wet, std::span<const float> planet_m, std::span<float> z) {
  const Grid& fine = cells.fine();
  const double spacing_m = cells.planet().face_east_m(cells.first_row());
  const DetailLaw law = detail_law(cells, p.cell_m);
  std::vector<float> east(fine.size()), north(fine.size());
  unit_detail(fine, law, seed, "island.coast_east", east);
  unit_detail(fine, law, seed, "island.coast_north", north);
  const std::vector<float> mean_east = cells.means(east, {}, 0.0F);
  const std::vector<float> mean_north = cells.means(north, {}, 0.0F);
  const double degrees_per_m = 180.0 / (std::numbers::pi * fine.figure().radius_m);
  on_cells(fine, [&](int i, int j, Index c) {
    const double far = cells.interpolate(dry, i, j) + cells.interpolate(wet, i, j);
    const double near = std::clamp(1.0 - far, 0.0, 1.0);
    if (near <= 0.0) return;
    const double reach = p.coast_fray * spacing_m * degrees_per_m * near *
                         edge_ramp(fine, i, j, p.coast_fray * spacing_m);
    const Centre here = fine.position(i, j);
    const double across = std::cos(here.latitude_deg * std::numbers::pi / 180.0);
    const double up = reach * (north[c] - cells.interpolate(mean_north, i, j));
    const double right = reach * (east[c] - cells.interpolate(mean_east, i, j));
    const Centre there{std::clamp(here.latitude_deg + up, -90.0, 90.0),
                       here.longitude_deg + right / std::max(across, 1e-3)};
    z[c] = static_cast<float>(planet_height_m(cells.planet(), planet_elevation_m, there));
  });
  const std::vector<float> planets = cells.means(planet_m, {}, 0.0F),
                           own = cells.means(z, {}, 0.0F);
  std::vector<float> lost(own.size());
  for (std::size_t k = 0; k < own.size(); ++k) lost[k] = planets[k] - own[k];
  on_cells(fine, [&](int i, int j, Index c) {
    const double far = cells.interpolate(dry, i, j) + cells.interpolate(wet, i, j);
    const double near = std::clamp(1.0 - far, 0.0, 1.0) * edge_ramp(fine, i, j, seam_m(cells));
    z[c] += static_cast<float>(near * cells.interpolate(lost, i, j));
  });
}

/// The planet's surface from Catmull-Rom, with winding coasts.
void read_planet(const PlanetCells& cells, std::span<const float> planet_elevation_m,
                 const IslandParameters& p, std::uint64_t seed, std::span<const float> planet_m,
                 std::span<float> z) {
  std::copy(planet_m.begin(), planet_m.end(), z.begin());
  if (p.coast_fray <= 0.0) return;
  const std::vector<float> dry = all_round(cells, planet_elevation_m, /*land=*/true);
  const std::vector<float> wet = all_round(cells, planet_elevation_m, /*land=*/false);
  wind_coasts(cells, planet_elevation_m, p, seed, dry, wet, planet_m, z);
}

/// Detail on low ground rises as far as it likes, and dips no deeper than the sea: gives the ground
/// over each planet cell its mean again. Heights above the level of the sea are multiplied by 1 +
/// a, depths below it by 1 - a, so that the coast stays where it is, with
///   a = (wanted mean - mean) / mean of |z|, from -1/2 to 1/2: ground keeps half of its relief.
/// What is as the planet has it stays so.
void restore_planets_means(const PlanetCells& cells, std::span<const float> planet_m,
                           std::span<float> z) {
  constexpr int kRounds = 3;  // what is restored in one cell changes the cells beside it
  constexpr float kMost = 0.5F;
  const Grid& fine = cells.fine();
  const double seam = seam_m(cells);
  const std::vector<float> wanted_m = cells.means(planet_m, {}, 0.0F);
  std::vector<float> relief_m(z.size());
  for (int round = 0; round < kRounds; ++round) {
    std::transform(z.begin(), z.end(), relief_m.begin(), [](float h) { return std::abs(h); });
    const std::vector<float> mean_m = cells.means(z, {}, 0.0F);
    const std::vector<float> mean_relief_m = cells.means(relief_m, {}, 0.0F);
    std::vector<float> share(mean_m.size(), 0.0F);
    for (std::size_t k = 0; k < share.size(); ++k) {
      if (!(mean_relief_m[k] > 0.0F)) continue;
      share[k] = std::clamp((wanted_m[k] - mean_m[k]) / mean_relief_m[k], -kMost, kMost);
    }
    on_cells(fine, [&](int i, int j, Index c) {
      if (z[c] == planet_m[c]) return;
      const double a = edge_ramp(fine, i, j, seam) *
                       std::clamp<double>(cells.interpolate(share, i, j), -kMost, kMost);
      z[c] *= static_cast<float>(z[c] > 0.0F ? 1.0 + a : 1.0 - a);
    });
  }
}

/// Blueprint 9.4: the edges sink below the sea, over a margin that noise frays.
void sink_edges(const Grid& fine, const IslandParameters& p, std::uint64_t seed,
                std::span<float> z) {
  constexpr double kSunk_m = -500.0, kFray = 0.5;
  const Noise noise(seed, "island.edge");
  const double width_m = fine.nx() * fine.spacing_east_m(0);
  const double height_m = fine.ny() * fine.step_north_m();
  const double frequency = fine.figure().radius_m / (0.1 * width_m);
  on_cells(fine, [&](int i, int j, Index c) {
    const double shore = noise.fbm(fine.unit_vector(i, j), frequency, 4);
    const double margin_m = std::min(width_m, height_m) * p.edge_margin * (1.0 + kFray * shore);
    const double fade = edge_ramp(fine, i, j, margin_m);
    z[c] = static_cast<float>(z[c] * fade + kSunk_m * (1.0 - fade));
  });
}

}  // namespace

void raise_island(const PlanetCells& cells, const PlanetTerrain& planet, const IslandParameters& p,
                  const ExemplarLibrary* exemplars, std::uint64_t seed, std::span<float> planet_m,
                  std::span<float> elevation_m) {
  on_cells(cells.fine(), [&](int i, int j, Index c) {
    planet_m[c] = static_cast<float>(
        planet_height_m(cells.planet(), planet.elevation_m, cells.fine().position(i, j)));
  });
  if (p.detail == "height") {
    std::copy(planet_m.begin(), planet_m.end(), elevation_m.begin());
    add_height_detail(cells, p, seed, elevation_m);
  } else {
    read_planet(cells, planet.elevation_m, p, seed, planet_m, elevation_m);
    add_rough_detail(cells, planet, p, exemplars, seed, planet_m, elevation_m);
  }
  dry_inland_dips(cells, planet.elevation_m, p, seed, elevation_m);
  if (p.detail != "height") restore_planets_means(cells, planet_m, elevation_m);
  if (p.edge_fade) sink_edges(cells.fine(), p, seed, elevation_m);
}

}  // namespace geo
