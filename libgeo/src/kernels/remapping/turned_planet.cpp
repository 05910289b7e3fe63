#include "geo/kernels/remapping/turned_planet.hpp"

#include <algorithm>
#include <cmath>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/core/place.hpp"
#include "geo/kernels/remapping/catmull_rom.hpp"

namespace geo {
namespace {

double sampled(const Grid& source, std::span<const float> values, const Centre& place) {
  const CatmullRom cubic(source, place);
  const auto [least, most] = cubic.range(values);
  if (std::isnan(least)) return NAN;
  const double value = cubic.of(values);  // NaN where a cell farther out has no value
  return std::isnan(value) ? 0.5 * (least + most) : std::clamp<double>(value, least, most);
}

}  // namespace

std::vector<float> laid_out_turned(const Grid& source, std::span<const float> values,
                                   const Grid& target) {
  check_sizes("laid_out_turned", source.size(), {{"values", values.size()}});
  if (source.topology() != Topology::sphere || target.topology() != Topology::sphere) {
    throw InputError("only a whole planet can be laid out with another pole");
  }
  const Grid places =
      Grid::sphere(2 * target.nx(), 2 * target.ny(), target.figure(), target.turn());
  std::vector<float> laid(target.size());
  ParallelErrors errors;
#pragma omp parallel for schedule(static)
  for (int j = 0; j < target.ny(); ++j) {
    errors.guard([&] {
      for (int i = 0; i < target.nx(); ++i) {
        double sum = 0.0;
        for (const int dj : {0, 1}) {
          for (const int di : {0, 1}) {
            sum += sampled(source, values, place_of(places.unit_vector(2 * i + di, 2 * j + dj)));
          }
        }
        laid[target.cell(i, j)] = static_cast<float>(0.25 * sum);
      }
    });
  }
  errors.rethrow();
  return laid;
}

}  // namespace geo
