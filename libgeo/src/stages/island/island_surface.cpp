#include "island_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/kernels/exemplars/exemplar_detail.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/numerics/shapes.hpp"
#include "geo/kernels/remapping/catmull_rom.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/receiver_distance.hpp"
#include "geo/stages/erosion/drainage.hpp"
#include "geo/stages/erosion/ground.hpp"
#include "geo/stages/erosion/landscape.hpp"
#include "geo/stages/erosion/wear_down.hpp"

namespace geo {
namespace {

template <class Change>
void on_cells(const Grid& grid, Change&& change) {
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) change(i, j, grid.cell(i, j));
  }
}

/// Width over which detail and corrections fade in from the edge, where heights are the planet's: a
/// quarter of a planet cell, as long as that is little of the island.
double seam_m(const PlanetCells& cells) {
  const Grid& fine = cells.fine();
  const double extent_m =
      std::min(fine.nx() * fine.spacing_east_m(0), fine.ny() * fine.step_north_m());
  return std::min(0.25 * cells.planet().face_east_m(cells.first_row()), 0.05 * extent_m);
}

/// 1 in the planet's cells with nothing but land, or nothing but sea, in and around them; one value
/// per covered cell.
std::vector<float> all_round(const PlanetCells& cells, std::span<const float> planet_elevation_m,
                             bool land) {
  const Grid& planet = cells.planet();
  const auto fits = [&](Index c) { return (planet_elevation_m[c] >= 0.0F) == land; };
  std::vector<float> share(cells.size());
  for (int j = cells.first_row(); j < cells.first_row() + cells.rows(); ++j) {
    for (int i = 0; i < planet.nx(); ++i) {
      bool all = fits(planet.cell(i, j));
      for (int k = 0; k < kDirections; ++k) {
        const Index next = planet.neighbour(planet.cell(i, j), k);
        all = all && (next == kNoCell || fits(next));
      }
      share[cells.at(i, j)] = all ? 1.0F : 0.0F;
    }
  }
  return share;
}

int octaves_down_to(double cell_m, double wavelength_m) {
  return std::clamp(static_cast<int>(std::lround(std::log2(wavelength_m / (2.0 * cell_m)))) + 1, 1,
                    16);
}

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
  DetailLaw law;
  law.wavelength_m = 2.0 * spacing_m;
  law.octaves = octaves_down_to(p.cell_m, law.wavelength_m);
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

/// Unit detail of exemplars. Waves that they do not hold, too long for a piece of them or too short
/// for their cells, are noise of the same law.
std::vector<float> exemplary_detail(const PlanetCells& cells, const PlanetTerrain& planet,
                                    const IslandParameters& p, const DetailLaw& law,
                                    const ExemplarLibrary& library, std::uint64_t seed) {
  const Grid& fine = cells.fine();
  const ExemplarBand band =
      exemplar_band(library, 0.5 * law.wavelength_m, p.cell_m, p.detail_hurst);
  const auto octave_of = [&](double wavelength_m) {
    const double octave = std::log2(law.wavelength_m / wavelength_m);
    return std::clamp(static_cast<int>(std::lround(octave)), 0, law.octaves);
  };
  const int first = octave_of(band.longest_m);
  const int last = std::max(first, octave_of(0.5 * band.shortest_m));
  const auto deviation = [&](int begin, int end) {
    const auto variance = [&](int from, int to) {
      double sum = 0.0;
      for (int k = from; k < to; ++k) sum += std::exp2(-2.0 * p.detail_hurst * k);
      return sum;
    };
    return static_cast<float>(std::sqrt(variance(begin, end) / variance(0, law.octaves)));
  };
  std::vector<float> detail(fine.size()), part(fine.size());
  exemplar_detail(cells.planet(),
                  {planet.elevation_m, planet.orogeny_type, planet.orogeny_age_myr,
                   planet.fold_east, planet.fold_north, p.old_orogeny_myr, p.plain_slope},
                  fine, library, band, seed, detail);
  for (float& value : detail) value *= deviation(first, last);
  const auto add_octaves = [&](int begin, int end) {
    if (begin >= end) return;
    unit_detail(fine, {law.wavelength_m * std::exp2(-begin), end - begin, law.gain}, seed,
                "island.detail", part);
    const float factor = deviation(begin, end);
    for (std::size_t c = 0; c < detail.size(); ++c) detail[c] += factor * part[c];
  };
  add_octaves(0, first);
  add_octaves(last, law.octaves);
  return detail;
}

/// Makes unit detail on land that of exemplars, and likewise what of it is there near the edge.
void take_exemplars(const PlanetCells& cells, const PlanetTerrain& planet,
                    const IslandParameters& p, const DetailLaw& law, const ExemplarLibrary& library,
                    std::uint64_t seed, std::span<const float> planet_m, std::span<float> detail,
                    std::span<float> near_edge) {
  constexpr double kShallow_m = -200.0;
  const std::vector<float> exemplary = exemplary_detail(cells, planet, p, law, library, seed);
  on_cells(cells.fine(), [&](int i, int j, Index c) {
    const double land = smooth_step(kShallow_m, 0.0, static_cast<double>(planet_m[c]));
    const double ramp = edge_ramp(cells.fine(), i, j, seam_m(cells));
    detail[c] =
        static_cast<float>(std::sqrt(land) * exemplary[c] + std::sqrt(1.0 - land) * detail[c]);
    near_edge[c] = static_cast<float>(std::sqrt(land) * ramp * exemplary[c] +
                                      std::sqrt(1.0 - land) * near_edge[c]);
  });
}

/// Detail that continues the planet's roughness, its mean over each planet cell taken out.
void add_rough_detail(const PlanetCells& cells, const PlanetTerrain& planet,
                      const IslandParameters& p, const ExemplarLibrary* exemplars,
                      std::uint64_t seed, std::span<const float> planet_m, std::span<float> z) {
  const Grid& fine = cells.fine();
  const double spacing_m = cells.planet().face_east_m(cells.first_row());
  DetailLaw law;
  law.wavelength_m = 2.0 * spacing_m;
  law.octaves = octaves_down_to(p.cell_m, law.wavelength_m);
  law.gain = std::exp2(-p.detail_hurst);
  std::vector<float> detail(fine.size()), roughness(cells.size());
  unit_detail(fine, law, seed, "island.detail", detail);
  std::vector<float> near_edge = detail;
  unit_detail_near_edge(fine, law, seam_m(cells), seed, "island.detail", near_edge);
  if (exemplars != nullptr) {
    take_exemplars(cells, planet, p, law, *exemplars, seed, planet_m, detail, near_edge);
  }
  local_roughness(cells, planet.elevation_m, roughness);
  for (float& rough_m : roughness) {
    rough_m = std::max(rough_m, static_cast<float>(p.least_roughness_m));
  }
  on_cells(fine, [&](int i, int j, Index c) {
    const double rough_m = std::max(0.0, cells.interpolate(roughness, i, j));
    detail[c] *= static_cast<float>(p.detail_amplitude * rough_m);
    near_edge[c] *= static_cast<float>(p.detail_amplitude * rough_m);
  });
  const std::vector<float> mean = cells.means(detail, {}, 0.0F);
  const std::vector<float> dry = all_round(cells, planet.elevation_m, /*land=*/true);
  on_cells(fine, [&](int i, int j, Index c) {
    const double mean_m = cells.interpolate(mean, i, j),
                 ramp = edge_ramp(fine, i, j, seam_m(cells));
    // The edge keeps the planet's heights: hollows close behind it would have no way out.
    const double detail_m = std::max(near_edge[c] - ramp * mean_m, ramp * (detail[c] - mean_m));
    z[c] = static_cast<float>(
        with_detail(z[c], detail_m, std::clamp(cells.interpolate(dry, i, j), 0.0, 1.0)));
  });
}

/// Blueprint 9.3: amplitude in proportion to height.
void add_height_detail(const PlanetCells& cells, const IslandParameters& p, std::uint64_t seed,
                       std::span<float> z) {
  const Grid& fine = cells.fine();
  const Noise noise(seed, "island.detail");
  const double width_m = fine.nx() * fine.spacing_east_m(0);
  const double frequency = p.height_frequency * fine.figure().radius_m / width_m;
  on_cells(fine, [&](int i, int j, Index c) {
    const double wave =
        noise.fbm(fine.unit_vector(i, j), frequency, static_cast<int>(p.height_octaves));
    const double ramp = p.edge_fade ? 1.0 : edge_ramp(fine, i, j, seam_m(cells));
    z[c] += static_cast<float>(ramp * wave * p.height_amplitude * std::abs(z[c]));
  });
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

/// Hollows about dips that the window's edge, which keeps the planet's heights, would hold closed:
/// all that water would stand over whose sill lies within `seam_m` of the edge.
std::vector<std::uint8_t> closed_by_edge(const Grid& fine, const FlowGraph& graph, double seam_m,
                                         std::span<const std::uint8_t> dips,
                                         std::span<const float> z) {
  std::vector<Index> sill(z.size());
  for (auto at = graph.order.rbegin(); at != graph.order.rend(); ++at) {  // downstream first
    const Index c = *at, to = graph.receiver[c];
    sill[c] = to == c || z[c] >= z[sill[to]] ? c : sill[to];
  }
  const auto closed = [&](Index c) {
    const Index at = sill[c];
    return z[c] < z[at] && edge_ramp(fine, fine.column(at), fine.row(at), seam_m) < 1.0;
  };
  std::vector<std::uint8_t> hollow(z.size());
  for (const Index c : graph.order) {
    const Index to = graph.receiver[c];
    if (dips[c] != 0 && closed(c)) hollow[c] = 1;
    if (hollow[c] != 0 && closed(to)) hollow[to] = 1;
  }
  for (auto at = graph.order.rbegin(); at != graph.order.rend(); ++at) {
    if (hollow[graph.receiver[*at]] != 0 && closed(*at)) hollow[*at] = 1;
  }
  return hollow;
}

/// Makes plains of dips: they rise from where their water leaves them, along its ways over the
/// ground as it dips, as graded rivers do, S = S1 (A / 1 km2)^-1/2. On an even plain rivers would
/// run straight along the grid. Where the window's edge holds a hollow closed, its plain rises from
/// there.
void grade_plains(const Grid& fine, double seam_m, std::span<const std::uint8_t> dips,
                  std::span<const std::uint8_t> sea, std::span<float> z) {
  constexpr double kSlope = 2e-4, kArea_m2 = 1e6;
  std::vector<std::uint8_t> outlets(sea.begin(), sea.end());
  for (Index c = 0; c < fine.size(); ++c) {
    if (fine.is_open_edge(fine.column(c), fine.row(c))) outlets[c] = 1;
  }
  const FlowGraph graph = route_water(fine, z, outlets).graph;
  const std::vector<std::uint8_t> hollow = closed_by_edge(fine, graph, seam_m, dips, z);
  std::vector<double> area_m2(fine.size(), fine.area_m2(0));
  graph.accumulate(area_m2);
  for (auto at = graph.order.rbegin(); at != graph.order.rend(); ++at) {  // downstream first
    const Index c = *at, to = graph.receiver[c];
    if (dips[c] == 0 && hollow[c] == 0) continue;
    z[c] = std::max(z[c], 0.0F);
    if (to == c || (hollow[c] == 0 && dips[to] == 0)) continue;
    const ReceiverDistance distance(fine, fine.row(c));
    const double slope = kSlope * std::sqrt(kArea_m2 / area_m2[c]);
    const auto graded = static_cast<float>(z[to] + slope * distance(c, fine.column(c), to));
    z[c] = std::max(z[c], graded);
  }
}

/// Land that detail or the interpolation dipped below the sea level stays land unless the sea, as
/// the planet has it, reaches it.
void dry_inland_dips(const PlanetCells& cells, std::span<const float> planet_elevation_m,
                     std::span<float> z) {
  const Grid& fine = cells.fine();
  std::vector<std::uint8_t> wet(fine.size());
  std::vector<Index> front;
  for (Index c = 0; c < fine.size(); ++c) {
    if (z[c] >= 0.0F || planet_elevation_m[cells.cell_of()[c]] >= 0.0F) continue;
    wet[c] = 1;
    front.push_back(c);
  }
  while (!front.empty()) {
    const Index c = front.back();
    front.pop_back();
    for (int k = 0; k < kDirections; ++k) {
      const Index next = fine.neighbour(c, k);
      if (next == kNoCell || wet[next] != 0 || z[next] >= 0.0F) continue;
      wet[next] = 1;
      front.push_back(next);
    }
  }
  std::vector<std::uint8_t> dips(fine.size());
  for (Index c = 0; c < fine.size(); ++c) dips[c] = z[c] < 0.0F && wet[c] == 0 ? 1 : 0;
  if (std::find(dips.begin(), dips.end(), 1) == dips.end()) return;
  grade_plains(fine, seam_m(cells), dips, wet, z);
}

/// Raises land so that its mean over each planet cell is `target` again.
void restore_means(const PlanetCells& cells, std::span<const float> target,
                   std::span<const std::uint8_t> land, std::span<const std::uint8_t> held,
                   std::span<float> z, std::span<float> raised_m) {
  constexpr float kLow_m = 1.0F, kMost = 1.1F;
  std::vector<float> factor = cells.means(z, land, 0.0F);
  for (std::size_t k = 0; k < factor.size(); ++k) {
    factor[k] = factor[k] > kLow_m ? std::clamp(target[k] / factor[k], 1.0F, kMost) : 1.0F;
  }
  on_cells(cells.fine(), [&](int i, int j, Index c) {
    if (land[c] == 0 || held[c] != 0) return;
    const double ramp = edge_ramp(cells.fine(), i, j, seam_m(cells));
    const double rise = std::max(0.0, cells.interpolate(factor, i, j) - 1.0);
    const auto higher = static_cast<float>(z[c] * ramp * rise);
    z[c] += higher;
    raised_m[c] += higher;
  });
}

/// The planet's law of rivers and hillslopes for the steps of an island: what rivers take is gone,
/// and what the crust gives back is what `keep_means` says.
ErosionParameters fine_law(const IslandParameters& p, ErosionParameters law) {
  law.steps = p.erosion_steps;
  law.time_step_yr = p.time_step_yr;
  law.route_every = 1;
  law.model = "detachment";
  law.flow_routing = "d8";
  law.depressions = "fill";
  law.uplift_mm_yr = 0.0;
  law.rebound_fraction = 0.0;
  return law;
}

}  // namespace

void add_ways_out(const Grid& fine, std::span<const float> z, std::span<std::uint8_t> outlets) {
  const std::vector<std::uint8_t> edges(outlets.begin(), outlets.end());
  for (Index c = 0; c < fine.size(); ++c) {
    const int i = fine.column(c), j = fine.row(c);
    if (std::min({i, fine.nx() - 1 - i, j, fine.ny() - 1 - j}) != 1) continue;
    const std::array<Index, kDirections> offsets = fine.offsets();
    const Index lowest =
        c + *std::min_element(offsets.begin(), offsets.end(),
                              [&](Index a, Index b) { return z[c + a] < z[c + b]; });
    if (edges[lowest] != 0 && fine.is_open_edge(fine.column(lowest), fine.row(lowest)) &&
        z[lowest] < z[c]) {
      outlets[c] = 1;
    }
  }
}

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
  dry_inland_dips(cells, planet.elevation_m, elevation_m);
  if (p.edge_fade) sink_edges(cells.fine(), p, seed, elevation_m);
}

std::vector<float> island_erodibility(const PlanetCells& cells, const PlanetTerrain& planet,
                                      const IslandParameters& p, const ErosionParameters& law) {
  const bool by_boundary = p.erodibility == "boundary";
  if (by_boundary && planet.boundary_type.empty()) {
    return {static_cast<float>(p.interior_erodibility_yr)};
  }
  if (!by_boundary && planet.erodibility.empty()) {
    return resolved_erodibility<float>(law, {}, cells.fine(), {});
  }
  const auto of_type = [&](std::int8_t type) {
    switch (static_cast<BoundaryType>(type)) {
      case BoundaryType::interior:
        return p.interior_erodibility_yr;
      case BoundaryType::divergent:
        return p.divergent_erodibility_yr;
      default:
        return p.convergent_erodibility_yr;
    }
  };
  // Cubics swing beyond what they pass through; nothing is weaker or stronger than the table has
  // it.
  const auto range = std::minmax(
      {p.convergent_erodibility_yr, p.divergent_erodibility_yr, p.interior_erodibility_yr});
  std::vector<float> erodibility(cells.fine().size());
  on_cells(cells.fine(), [&](int i, int j, Index c) {
    const CatmullRom stencil(cells.planet(), cells.fine().position(i, j));
    const auto at = [&](int column, int row) {
      const Index cell = cells.planet().cell(column, row);
      return by_boundary ? of_type(planet.boundary_type[cell])
                         : static_cast<double>(planet.erodibility[cell]);
    };
    const double worn = std::max(0.0, stencil.of(at));
    erodibility[c] =
        static_cast<float>(by_boundary ? std::clamp(worn, range.first, range.second) : worn);
  });
  if (by_boundary) return erodibility;
  return resolved_erodibility<float>(law, {}, cells.fine(), erodibility);
}

IslandErosion wear_island(const PlanetCells& cells, const IslandParameters& p,
                          const ErosionParameters& planets, const IslandGround& ground,
                          const std::function<void(double)>& advance,
                          std::span<float> elevation_m) {
  const Grid& fine = cells.fine();
  const ErosionParameters law = fine_law(p, planets);
  IslandErosion done{{}, std::vector<float>(fine.size())};
  std::vector<std::uint8_t> land(fine.size());
  std::transform(elevation_m.begin(), elevation_m.end(), land.begin(),
                 [](float z) { return static_cast<std::uint8_t>(z >= 0.0F); });
  const std::vector<float> target = cells.means(elevation_m, land, 0.0F);
  Landscape<float> landscape(law, {}, fine, elevation_m, {}, {}, ground.erodibility,
                             {ground.held.begin(), ground.held.end()});
  Drainage drainage;
  const auto route = [&](std::int64_t) -> const Drainage& {
    drain(law, fine, elevation_m, ground.outlets, drainage, nullptr, ground.inflow_area_m2);
    return drainage;
  };
  const auto restore = [&](std::int64_t step) {
    if (p.keep_means) {
      landscape.book_reshaping([&] {
        restore_means(cells, target, land, ground.held, elevation_m, done.raised_m);
        return true;
      });
    }
    advance(static_cast<double>(step + 1) / static_cast<double>(law.steps));
  };
  wear_down(law, {.route = route, .after = restore}, landscape);
  done.lowered_m.assign(landscape.lowered_m().begin(), landscape.lowered_m().end());
  return done;
}

}  // namespace geo
