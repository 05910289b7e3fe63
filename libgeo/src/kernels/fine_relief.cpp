#include "geo/kernels/fine_relief.hpp"

#include <algorithm>
#include <cmath>

#include "geo/core/error.hpp"
#include "geo/kernels/catmull_rom.hpp"
#include "geo/kernels/noise_row.hpp"

namespace geo {

PlanetCells::PlanetCells(const Grid& planet, const Grid& fine) : planet_(planet), fine_(fine) {
  if (!fine.is_geographic()) throw InputError("a closer look needs a grid that knows its place");
  cell_.resize(fine.size());
  std::vector<int> lowest(fine.ny(), planet.ny()), highest(fine.ny(), 0);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < fine.ny(); ++j) {
    for (int i = 0; i < fine.nx(); ++i) {
      const Index cell = CatmullRom(planet, fine.position(i, j)).nearest();
      cell_[fine.cell(i, j)] = cell;
      lowest[j] = std::min(lowest[j], planet.row(cell));
      highest[j] = std::max(highest[j], planet.row(cell));
    }
  }
  constexpr int kMargin = 2;
  first_row_ = std::max(0, *std::min_element(lowest.begin(), lowest.end()) - kMargin);
  const int last =
      std::min(planet.ny() - 1, *std::max_element(highest.begin(), highest.end()) + kMargin);
  rows_ = last - first_row_ + 1;
}

std::vector<float> PlanetCells::means(std::span<const float> values,
                                      std::span<const std::uint8_t> wanted, float otherwise) const {
  // In the order of the cells, on one thread: a pass over memory, and the same bits always.
  std::vector<double> sum(size());
  std::vector<std::int32_t> count(size());
  const std::size_t first = static_cast<std::size_t>(first_row_) * planet_.nx();
  for (std::size_t c = 0; c < values.size(); ++c) {
    if (!wanted.empty() && wanted[c] == 0) continue;
    sum[cell_[c] - first] += values[c];
    ++count[cell_[c] - first];
  }
  std::vector<float> mean(size(), otherwise);
  for (std::size_t k = 0; k < mean.size(); ++k) {
    if (count[k] > 0) mean[k] = static_cast<float>(sum[k] / count[k]);
  }
  return mean;
}

double PlanetCells::interpolate(std::span<const float> covered, int column, int row) const {
  return CatmullRom(planet_, fine_.position(column, row)).of([&](int i, int j) {
    return covered[at(i, std::clamp(j, first_row_, first_row_ + rows_ - 1))];
  });
}

void local_roughness(const PlanetCells& cells, std::span<const float> planet_elevation_m,
                     std::span<float> covered) {
  const Grid& planet = cells.planet();
  std::vector<float> variance(cells.size());
  const int end = cells.first_row() + cells.rows();
#pragma omp parallel for schedule(static)
  for (int j = cells.first_row(); j < end; ++j) {
    for (int i = 0; i < planet.nx(); ++i) {
      const float here = planet_elevation_m[planet.cell(i, j)];
      const auto seen = [&](int k) {
        const float there = planet_elevation_m[planet.neighbour(i, j, k)];
        return here < 0.0F ? std::min(there, 0.0F) : std::max(there, 0.0F);
      };
      double sum = 0.0;
      for (int k = 0; k < 4; ++k) {
        const double bump = here - 0.5 * (seen(k) + seen(k + 4));
        sum += bump * bump;
      }
      variance[cells.at(i, j)] = static_cast<float>(0.25 * sum);
    }
  }
#pragma omp parallel for schedule(static)
  for (int j = cells.first_row(); j < end; ++j) {
    for (int i = 0; i < planet.nx(); ++i) {
      double sum = variance[cells.at(i, j)];
      int count = 1;
      for (int k = 0; k < kDirections; ++k) {
        const Index next = planet.neighbour(i, j, k);
        const int row = planet.row(next);
        if (row < cells.first_row() || row >= end) continue;
        sum += variance[cells.at(planet.column(next), row)];
        ++count;
      }
      covered[cells.at(i, j)] = static_cast<float>(std::sqrt(sum / count));
    }
  }
}

void unit_detail(const Grid& fine, const DetailLaw& law, std::uint64_t seed,
                 std::string_view stream, std::span<float> detail) {
  const Noise noise(seed, stream);
  double sum = 0.0, squares = 0.0, amplitude = 1.0;
  for (int octave = 0; octave < law.octaves; ++octave) {
    sum += amplitude;
    squares += amplitude * amplitude;
    amplitude *= law.gain;
  }
  constexpr double kDeviation = 0.29;  // of gradient noise
  const double scale = squares > 0.0 ? sum / (kDeviation * std::sqrt(squares)) : 0.0;
  const double frequency = fine.figure().radius_m / law.wavelength_m;
#pragma omp parallel
  {
    NoiseRow row(fine);
#pragma omp for schedule(static)
    for (int j = 0; j < fine.ny(); ++j) {
      const auto line = detail.subspan(fine.cell(0, j), fine.nx());
      row.choose_all(j);
      row.fbm(noise, frequency, law.octaves, law.gain, line);
      for (float& value : line) value = static_cast<float>(scale * value);
    }
  }
}

double with_detail(double height_m, double detail_m, double inland) {
  const double plainly = height_m + detail_m;
  if (!(detail_m < 0.0 && height_m > 0.0 && inland > 0.0)) return plainly;
  return plainly + inland * (height_m * std::exp(detail_m / height_m) - plainly);
}

double edge_ramp(const Grid& fine, int column, int row, double width_m) {
  const double east = std::min(column, fine.nx() - 1 - column) * fine.spacing_east_m(row);
  const double north = std::min(row, fine.ny() - 1 - row) * fine.step_north_m();
  const double t = width_m > 0.0 ? std::clamp(std::min(east, north) / width_m, 0.0, 1.0) : 1.0;
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace geo
