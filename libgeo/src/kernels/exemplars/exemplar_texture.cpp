#include "exemplar_texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/kernels/remapping/cubic_weights.hpp"

namespace geo {
namespace {

/// Four cells round a place and their weights.
struct Taps {
  Taps(double place, int cells, bool periodic) {
    const double whole = std::floor(place), t = place - whole;
    weight = cubic_weights(t);
    const int first = static_cast<int>(whole) - 1;
    for (int k = 0; k < 4; ++k) {
      const int c = first + k;
      cell[k] = periodic ? ((c % cells) + cells) % cells : std::clamp(c, 0, cells - 1);
    }
  }
  std::array<double, 4> weight;
  std::array<int, 4> cell;
};

/// Means over squares of `times` cells; what is left over at the edges is dropped.
Exemplar coarser(const Exemplar& fine, int times) {
  Exemplar e = fine;
  e.nx = fine.nx / times;
  e.ny = fine.ny / times;
  e.cell_m = fine.cell_m * times;
  e.periodic = fine.periodic && fine.nx % times == 0 && fine.ny % times == 0;
  e.elevation_m.assign(static_cast<std::size_t>(e.nx) * e.ny, 0.0F);
  for (int j = 0; j < e.ny; ++j) {
    for (int i = 0; i < e.nx; ++i) {
      double sum = 0.0;
      for (int b = 0; b < times; ++b) {
        for (int a = 0; a < times; ++a) {
          sum +=
              fine.elevation_m[static_cast<std::size_t>(j * times + b) * fine.nx + i * times + a];
        }
      }
      e.elevation_m[static_cast<std::size_t>(j) * e.nx + i] =
          static_cast<float>(sum / (static_cast<double>(times) * times));
    }
  }
  return e;
}

double deviation_of(std::span<const float> values) {
  double sum = 0.0, squares = 0.0;
  for (const float value : values) {
    sum += value;
    squares += static_cast<double>(value) * value;
  }
  const auto count = static_cast<double>(values.size());
  return std::sqrt(std::max(1e-30, squares / count - sum * sum / (count * count)));
}

/// The octaves of a relief from the longest wave of the band to what its cells show, each the
/// difference of two Gaussian blurs; a blur halves the power of waves of four deviations.
std::vector<std::vector<float>> octaves_of(const Grid& grid, std::span<const float> z,
                                           double longest_m) {
  const double shortest_m = 2.5 * grid.spacing_east_m(0);
  std::vector<std::vector<float>> octaves;
  std::vector<float> low(z.begin(), z.end());
  smooth(grid, std::span<float>(low), 0.25 * longest_m);
  for (double wave_m = 0.5 * longest_m; !low.empty(); wave_m *= 0.5) {
    std::vector<float> higher(z.begin(), z.end());
    const bool last = wave_m < shortest_m;
    if (!last) smooth(grid, std::span<float>(higher), 0.25 * wave_m);
    std::vector<float> octave(z.size());
    for (std::size_t c = 0; c < z.size(); ++c) octave[c] = higher[c] - low[c];
    octaves.push_back(std::move(octave));
    low = last ? std::vector<float>{} : std::move(higher);
  }
  return octaves;
}

/// Sum of octaves whose deviations fall with the Hurst exponent.
std::vector<float> self_affine(const std::vector<std::vector<float>>& octaves, double hurst) {
  constexpr double kMost = 4.0;
  std::vector<double> excess;  // logarithms
  double mean = 0.0;
  for (std::size_t k = 0; k < octaves.size(); ++k) {
    excess.push_back(std::log(deviation_of(octaves[k])) +
                     hurst * static_cast<double>(k) * std::numbers::ln2);
    mean += excess.back() / static_cast<double>(octaves.size());
  }
  std::vector<float> sum(octaves.front().size());
  for (std::size_t k = 0; k < octaves.size(); ++k) {
    const auto factor =
        static_cast<float>(std::clamp(std::exp(mean - excess[k]), 1.0 / kMost, kMost));
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += factor * octaves[k][c];
  }
  return sum;
}

/// Forelands are not to leave holes in mountains: most of the variance is evened out.
void even_out(const Grid& grid, double longest_m, std::vector<float>& z) {
  constexpr double kEven = 0.75;
  const double variance = std::pow(deviation_of(z), 2.0);
  std::vector<float> local(z.size());
  for (std::size_t c = 0; c < z.size(); ++c) local[c] = z[c] * z[c];
  smooth(grid, std::span<float>(local), 0.4 * longest_m);
  double sum = 0.0;
  for (std::size_t c = 0; c < z.size(); ++c) {
    const double around = (1.0 - kEven) * variance + kEven * std::max(0.0F, local[c]);
    z[c] = static_cast<float>(z[c] / std::sqrt(around));
    sum += z[c];
  }
  const double mean = sum / static_cast<double>(z.size()), deviation = deviation_of(z);
  for (float& value : z) value = static_cast<float>((value - mean) / deviation);
}

}  // namespace

double Texture::sample(double x_m, double y_m) const {
  const Taps x(x_m / cell_m - 0.5, nx, periodic), y(y_m / cell_m - 0.5, ny, periodic);
  double sum = 0.0;
  for (int j = 0; j < 4; ++j) {
    const float* const row = values.data() + static_cast<std::size_t>(y.cell[j]) * nx;
    double along = 0.0;
    for (int i = 0; i < 4; ++i) along += x.weight[i] * row[x.cell[i]];
    sum += y.weight[j] * along;
  }
  return sum;
}

double disc_radius_m(const ExemplarLibrary& library) {
  double radius_m = 1e300;
  for (const Exemplar& e : library.exemplars) {
    radius_m = std::min(radius_m, kDiscShare * std::min(e.nx, e.ny) * e.cell_m);
  }
  return radius_m;
}

int times_coarser(const Exemplar& e, double fine_cell_m) {
  constexpr int kLeast = 8;  // cells that are left on the shorter side
  const int most = std::max(1, std::min(e.nx, e.ny) / kLeast);
  return std::clamp(static_cast<int>(fine_cell_m / e.cell_m + 0.05), 1, most);
}

Texture texture_of(const Exemplar& exemplar, const ExemplarBand& band, double fine_cell_m) {
  const int times = times_coarser(exemplar, fine_cell_m);
  const Exemplar e = times > 1 ? coarser(exemplar, times) : exemplar;
  const Grid grid = e.grid();
  const auto octaves = octaves_of(grid, e.elevation_m, band.longest_m);
  std::vector<float> all(e.elevation_m.size());
  for (const auto& octave : octaves) {
    for (std::size_t c = 0; c < all.size(); ++c) all[c] += octave[c];
  }
  Texture texture{e.terrain,
                  e.nx,
                  e.ny,
                  e.cell_m,
                  e.periodic,
                  std::cos(e.fold_rad),
                  std::sin(e.fold_rad),
                  deviation_of(all),
                  self_affine(octaves, band.hurst)};
  even_out(grid, band.longest_m, texture.values);
  return texture;
}

void blur_for(double cell_m, Texture& texture) {
  constexpr double kCells = 0.6;
  const Grid grid =
      texture.periodic
          ? Grid::torus(texture.nx, texture.ny, texture.cell_m, texture.cell_m)
          : Grid::plane(texture.nx, texture.ny, texture.cell_m, texture.cell_m, Edges::closed);
  smooth(grid, std::span<float>(texture.values), kCells * cell_m);
}

void rescale(double cell_m, Texture& texture) {
  Texture shown = texture;
  blur_for(cell_m, shown);
  const auto factor = static_cast<float>(1.0 / deviation_of(shown.values));
  for (float& value : texture.values) value *= factor;
}

const Texture& choose(std::span<const Texture> textures, const LocalTerrain& local,
                      double by_terrain, double by_likeness) {
  const auto has = [&](Terrain terrain) {
    return std::any_of(textures.begin(), textures.end(),
                       [&](const Texture& t) { return t.terrain == terrain; });
  };
  std::array<double, kTerrains> share = local.share;
  double whole = 0.0;
  for (int t = 0; t < kTerrains; ++t) {
    if (!has(static_cast<Terrain>(t))) share[t] = 0.0;
    whole += share[t];
  }
  double left = by_terrain * whole;
  int terrain = -1;
  for (int t = 0; t < kTerrains && whole > 0.0; ++t) {
    if (share[t] <= 0.0) continue;
    terrain = t;
    left -= share[t];
    if (left < 0.0) break;
  }
  // Twofold roughness is one deviation of likeness.
  constexpr double kAlike = 0.7;
  std::vector<double> chance(textures.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < textures.size(); ++k) {
    if (terrain >= 0 && textures[k].terrain != static_cast<Terrain>(terrain)) continue;
    const double ratio =
        std::log(std::max(1.0, local.roughness_m) / std::max(1.0, textures[k].roughness_m));
    chance[k] = 0.05 + std::exp(-0.5 * ratio * ratio / (kAlike * kAlike));
    sum += chance[k];
  }
  left = by_likeness * sum;
  std::size_t chosen = 0;
  for (std::size_t k = 0; k < textures.size(); ++k) {
    if (chance[k] <= 0.0) continue;
    chosen = k;
    left -= chance[k];
    if (left < 0.0) break;
  }
  return textures[chosen];
}

}  // namespace geo
