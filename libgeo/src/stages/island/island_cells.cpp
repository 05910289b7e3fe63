#include "island_cells.hpp"

#include <algorithm>
#include <cmath>

namespace geo {
namespace {

constexpr double kPlainHurst = 0.5;

}  // namespace

double seam_m(const PlanetCells& cells) {
  const Grid& fine = cells.fine();
  const double extent_m =
      std::min(fine.nx() * fine.spacing_east_m(0), fine.ny() * fine.step_north_m());
  return std::min(0.25 * cells.planet().face_east_m(cells.first_row()), 0.025 * extent_m);
}

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

DetailLaw detail_law(const PlanetCells& cells, double cell_m) {
  DetailLaw law;
  law.wavelength_m = 2.0 * cells.planet().face_east_m(cells.first_row());
  law.octaves = std::clamp(
      static_cast<int>(std::lround(std::log2(law.wavelength_m / (2.0 * cell_m)))) + 1, 1, 16);
  return law;
}

DetailLaw plain_law(const PlanetCells& cells, double cell_m, double longest_m) {
  DetailLaw law;
  law.wavelength_m = std::min(longest_m, detail_law(cells, cell_m).wavelength_m);
  law.octaves = std::max(1, static_cast<int>(std::log2(0.5 * law.wavelength_m / cell_m)) + 1);
  law.gain = std::exp2(-kPlainHurst);
  return law;
}

double plain_roughness_m(const IslandParameters& p, const DetailLaw& law) {
  if (p.detail == "height") return 0.0;
  const double share = std::pow(std::min(1.0, law.wavelength_m / kPlain_m), kPlainHurst);
  return p.detail_amplitude * p.least_roughness_m * share;
}

}  // namespace geo
