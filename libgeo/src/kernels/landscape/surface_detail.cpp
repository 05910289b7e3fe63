#include "geo/kernels/landscape/surface_detail.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/noise/noise_row.hpp"

namespace geo {
namespace {

constexpr double kDeviation = 0.29;  // of gradient noise

double edge_distance_m(const Grid& fine, int column, int row) {
  return std::min(std::min(column, fine.nx() - 1 - column) * fine.spacing_east_m(row),
                  std::min(row, fine.ny() - 1 - row) * fine.step_north_m());
}

}  // namespace

void local_roughness(const PlanetCells& cells, std::span<const float> planet_elevation_m,
                     std::span<float> covered) {
  check_sizes("local_roughness", cells.planet().size(),
              {{"planet_elevation_m", planet_elevation_m.size()}});
  check_sizes("local_roughness", cells.size(), {{"covered", covered.size()}});
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
      double weight = 4.0, sum = weight * variance[cells.at(i, j)];
      for (int k = 0; k < kDirections; ++k) {
        const Index next = planet.neighbour(i, j, k);
        const int row = planet.row(next);
        if (row < cells.first_row() || row >= end) continue;
        const double of_next = k % 2 == 0 ? 2.0 : 1.0;  // beside the cell, or at its corner
        sum += of_next * variance[cells.at(planet.column(next), row)];
        weight += of_next;
      }
      covered[cells.at(i, j)] = static_cast<float>(std::sqrt(sum / weight));
    }
  }
}

void unit_detail(const Grid& fine, const DetailLaw& law, std::uint64_t seed,
                 std::string_view stream, std::span<float> detail) {
  check_sizes("unit_detail", fine.size(), {{"detail", detail.size()}});
  const Noise noise(seed, stream);
  double sum = 0.0, squares = 0.0, amplitude = 1.0;
  for (int octave = 0; octave < law.octaves; ++octave) {
    sum += amplitude;
    squares += amplitude * amplitude;
    amplitude *= law.gain;
  }
  const double scale = squares > 0.0 ? sum / (kDeviation * std::sqrt(squares)) : 0.0;
  const double frequency = fine.figure().radius_m / law.wavelength_m;
  ParallelErrors errors;
#pragma omp parallel
  {
    NoiseRow row(fine);
#pragma omp for schedule(static)
    for (int j = 0; j < fine.ny(); ++j) {
      errors.guard([&] {
        const auto line = detail.subspan(fine.cell(0, j), fine.nx());
        row.choose_all(j);
        row.fbm(noise, frequency, law.octaves, law.gain, line);
        for (float& value : line) value = static_cast<float>(scale * value);
      });
    }
  }
  errors.rethrow();
}

void unit_detail_near_edge(const Grid& fine, const DetailLaw& law, double seam_m,
                           std::uint64_t seed, std::string_view stream, std::span<float> detail) {
  check_sizes("unit_detail_near_edge", fine.size(), {{"detail", detail.size()}});
  const Noise noise(seed, stream);
  const double frequency = fine.figure().radius_m / law.wavelength_m;
  double squares = 0.0;
  for (int k = 0; k < law.octaves; ++k) squares += std::pow(law.gain, 2 * k);
  const double scale = squares > 0.0 ? 1.0 / (kDeviation * std::sqrt(squares)) : 0.0;
  ParallelErrors errors;
#pragma omp parallel
  {
    NoiseRow row(fine);
    std::vector<float> mean;             // of the octaves so far
    std::vector<double> sum, whole_sum;  // of all octaves, faded in; of those so far
#pragma omp for schedule(dynamic, 4)
    for (int j = 0; j < fine.ny(); ++j) {
      errors.guard([&] {
        const auto is_near = [&](int i) { return edge_distance_m(fine, i, j) < seam_m; };
        row.choose(j, is_near);
        mean.assign(fine.nx(), 0.0F);
        sum.assign(fine.nx(), 0.0);
        whole_sum.assign(fine.nx(), 0.0);
        double total = 0.0, amplitude = 1.0, half_m = 0.5 * law.wavelength_m;
        for (int k = 0; k < law.octaves; ++k) {
          total += amplitude;
          row.fbm(noise, frequency, k + 1, law.gain, mean);
          for (int i = 0; i < fine.nx(); ++i) {
            if (!is_near(i)) continue;
            const double before = std::exchange(whole_sum[i], total * mean[i]);
            sum[i] += edge_ramp(fine, i, j, std::min(half_m, seam_m)) * (whole_sum[i] - before);
          }
          amplitude *= law.gain;
          half_m *= 0.5;
        }
        for (int i = 0; i < fine.nx(); ++i) {
          if (is_near(i)) detail[fine.cell(i, j)] = static_cast<float>(scale * sum[i]);
        }
      });
    }
  }
  errors.rethrow();
}

double with_detail(double height_m, double detail_m, double inland) {
  const double plainly = height_m + detail_m;
  if (!(detail_m < 0.0 && inland > 0.0)) return plainly;
  const double above = height_m > 0.0 ? height_m * std::exp(detail_m / height_m) : height_m;
  return plainly + inland * (above - plainly);
}

double edge_ramp(const Grid& fine, int column, int row, double width_m) {
  const double from_edge_m = edge_distance_m(fine, column, row);
  const double t = width_m > 0.0 ? std::clamp(from_edge_m / width_m, 0.0, 1.0) : 1.0;
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace geo
