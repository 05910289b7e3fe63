#include "geo/kernels/numerics/quantile_mapping.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "geo/core/error.hpp"

namespace geo {
namespace {

struct Entry {
  std::uint32_t key;  // bits that sort as the floats do
  Index cell;
};

std::uint32_t to_key(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value + 0.0F);
  return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

void check(const Grid& grid, const TargetDistribution& target, std::span<const float> field) {
  if (field.size() != static_cast<std::size_t>(grid.size())) {
    throw InputError("quantile mapping: field of " + std::to_string(field.size()) +
                     " values on a grid of " + std::to_string(grid.size()) + " cells");
  }
  const auto f = target.fraction, v = target.value;
  if (f.size() < 2 || f.size() != v.size() || f.front() != 0.0 || f.back() != 1.0) {
    throw InputError("quantile mapping: a target needs as many values as fractions, from 0 to 1");
  }
  for (std::size_t i = 1; i < f.size(); ++i) {
    if (!(f[i] > f[i - 1] && v[i] >= v[i - 1])) {
      throw InputError("quantile mapping: the target does not ascend at entry " +
                       std::to_string(i));
    }
  }
}

// Least significant digit first: two passes of 16 bits.
std::vector<Entry> sorted(std::span<const float> field) {
  std::vector<Entry> from(field.size()), to(field.size());
  for (std::size_t c = 0; c < field.size(); ++c) {
    if (std::isnan(field[c]))
      throw InputError("quantile mapping: cell " + std::to_string(c) + " is NaN");
    from[c] = {to_key(field[c]), static_cast<Index>(c)};
  }
  for (const int shift : {0, 16}) {
    std::vector<std::size_t> start((1U << 16) + 1, 0);
    for (const Entry& e : from) ++start[((e.key >> shift) & 0xffffU) + 1];
    for (std::size_t b = 1; b < start.size(); ++b) start[b] += start[b - 1];
    for (const Entry& e : from) to[start[(e.key >> shift) & 0xffffU]++] = e;
    from.swap(to);
  }
  return from;
}

}  // namespace

void map_quantiles(const Grid& grid, const TargetDistribution& target, std::span<float> field) {
  check(grid, target, field);
  const std::vector<Entry> order = sorted(field);
  double total_m2 = 0.0;
  for (const Entry& e : order) total_m2 += grid.area_m2(grid.row(e.cell));
  double below_m2 = 0.0;
  std::size_t segment = 1;
  for (std::size_t i = 0; i < order.size();) {
    double here_m2 = 0.0;
    std::size_t end = i;
    for (; end < order.size() && order[end].key == order[i].key; ++end) {
      here_m2 += grid.area_m2(grid.row(order[end].cell));
    }
    const double rank = (below_m2 + 0.5 * here_m2) / total_m2;
    while (segment + 1 < target.fraction.size() && target.fraction[segment] < rank) ++segment;
    const double f0 = target.fraction[segment - 1], f1 = target.fraction[segment];
    const double value =
        std::lerp(target.value[segment - 1], target.value[segment], (rank - f0) / (f1 - f0));
    for (; i < end; ++i) field[order[i].cell] = static_cast<float>(value);
    below_m2 += here_m2;
  }
}

}  // namespace geo
