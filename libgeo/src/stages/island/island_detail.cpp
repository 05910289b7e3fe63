#include "island_detail.hpp"

#include <algorithm>
#include <cmath>

#include "geo/kernels/exemplars/exemplar_detail.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/numerics/shapes.hpp"
#include "island_cells.hpp"

namespace geo {
namespace {

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

/// Width of the strip along the edge in which detail fades, per cell: behind one of even width
/// rivers would run straight along its foot.
std::vector<float> strip_widths_m(const PlanetCells& cells, std::uint64_t seed) {
  constexpr double kWavelength = 3.0, kGain = 0.5;  // of the mean width
  constexpr int kOctaves = 3;
  constexpr float kDeviation = 0.4F, kNarrowest = 0.4F, kWidest = 1.8F;
  const double mean_m = seam_m(cells);
  std::vector<float> width_m(cells.fine().size());
  unit_detail(cells.fine(), {kWavelength * mean_m, kOctaves, kGain}, seed, "island.strip", width_m);
  for (float& width : width_m) {
    width = static_cast<float>(mean_m) * std::clamp(1.0F + kDeviation * width, kNarrowest, kWidest);
  }
  return width_m;
}

/// Detail of a surface in m, and what of it is there near the edge.
struct Detail {
  std::vector<float> inside_m, near_edge_m;
};

/// No ground is quite even: terraces, levees and dunes are there below 10 km on the flattest plain.
/// Adds as much of them as makes the roughness at that length the least; on a plain that is even
/// rivers would run straight along the grid. `roughness_m`: of each planet cell, at the length of
/// `law`.
void add_least_roughness(const PlanetCells& cells, const IslandParameters& p, const DetailLaw& law,
                         std::uint64_t seed, std::span<const float> roughness_m, Detail& detail) {
  const Grid& fine = cells.fine();
  const DetailLaw plain = plain_law(cells, p.cell_m);
  const double share_there = std::pow(plain.wavelength_m / law.wavelength_m, p.detail_hurst);
  std::vector<float> inside(fine.size());
  unit_detail(fine, plain, seed, "island.plain", inside);
  std::vector<float> near_edge = inside;
  unit_detail_near_edge(fine, plain, seam_m(cells), seed, "island.plain", near_edge);
  on_cells(fine, [&](int i, int j, Index c) {
    const double there_m = share_there * std::max(0.0, cells.interpolate(roughness_m, i, j));
    const double lacks_m2 = p.least_roughness_m * p.least_roughness_m - there_m * there_m;
    const auto more_m = static_cast<float>(p.detail_amplitude * std::sqrt(std::max(0.0, lacks_m2)));
    detail.inside_m[c] += more_m * inside[c];
    detail.near_edge_m[c] += more_m * near_edge[c];
  });
}

}  // namespace

void add_rough_detail(const PlanetCells& cells, const PlanetTerrain& planet,
                      const IslandParameters& p, const ExemplarLibrary* exemplars,
                      std::uint64_t seed, std::span<const float> planet_m, std::span<float> z) {
  const Grid& fine = cells.fine();
  DetailLaw law = detail_law(cells, p.cell_m);
  law.gain = std::exp2(-p.detail_hurst);
  std::vector<float> roughness_m(cells.size());
  Detail detail{std::vector<float>(fine.size()), {}};
  unit_detail(fine, law, seed, "island.detail", detail.inside_m);
  detail.near_edge_m = detail.inside_m;
  unit_detail_near_edge(fine, law, seam_m(cells), seed, "island.detail", detail.near_edge_m);
  if (exemplars != nullptr) {
    take_exemplars(cells, planet, p, law, *exemplars, seed, planet_m, detail.inside_m,
                   detail.near_edge_m);
  }
  local_roughness(cells, planet.elevation_m, roughness_m);
  on_cells(fine, [&](int i, int j, Index c) {
    const double rough_m = std::max(0.0, cells.interpolate(roughness_m, i, j));
    detail.inside_m[c] *= static_cast<float>(p.detail_amplitude * rough_m);
    detail.near_edge_m[c] *= static_cast<float>(p.detail_amplitude * rough_m);
  });
  add_least_roughness(cells, p, law, seed, roughness_m, detail);
  const std::vector<float> mean = cells.means(detail.inside_m, {}, 0.0F);
  const std::vector<float> dry = all_round(cells, planet.elevation_m, /*land=*/true);
  const std::vector<float> strip_m = strip_widths_m(cells, seed);
  on_cells(fine, [&](int i, int j, Index c) {
    const double mean_m = cells.interpolate(mean, i, j), ramp = edge_ramp(fine, i, j, strip_m[c]);
    // The edge keeps the planet's heights: hollows close behind it would have no way out.
    const double detail_m =
        std::max(detail.near_edge_m[c] - ramp * mean_m, ramp * (detail.inside_m[c] - mean_m));
    z[c] = static_cast<float>(
        with_detail(z[c], detail_m, std::clamp(cells.interpolate(dry, i, j), 0.0, 1.0)));
  });
}

void add_height_detail(const PlanetCells& cells, const IslandParameters& p, std::uint64_t seed,
                       std::span<float> z) {
  const Grid& fine = cells.fine();
  const Noise noise(seed, "island.detail");
  const double width_m = static_cast<double>(p.nx) * p.cell_m;  // the island's own
  const double frequency = p.height_frequency * fine.figure().radius_m / width_m;
  on_cells(fine, [&](int i, int j, Index c) {
    const double wave =
        noise.fbm(fine.unit_vector(i, j), frequency, static_cast<int>(p.height_octaves));
    const double ramp = p.edge_fade ? 1.0 : edge_ramp(fine, i, j, seam_m(cells));
    z[c] += static_cast<float>(ramp * wave * p.height_amplitude * std::abs(z[c]));
  });
}

}  // namespace geo
