#include "geo/kernels/numerics/quantiles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"

namespace geo {
namespace {

using Share = std::uint64_t;  // of the grid's area, in units of 2^-62 of the total
constexpr std::uint32_t kBuckets = 1U << 16;

// Bits that sort as the floats do; -0 and +0 are one value.
std::uint32_t to_key(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value + 0.0F);
  return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

float to_value(std::uint32_t key) {
  return std::bit_cast<float>((key & 0x80000000U) != 0 ? key & 0x7fffffffU : ~key);
}

struct Cells {
  const Grid& grid;
  std::span<const float> field;
  std::span<const std::uint8_t> mask;

  // Calls visit(value) for every cell of a row that takes part.
  template <class Visit>
  void for_row(int row, Visit visit) const {
    const std::size_t begin = std::size_t(row) * grid.nx(), end = begin + grid.nx();
    for (std::size_t cell = begin; cell < end; ++cell) {
      if (!mask.empty() && mask[cell] == 0) continue;
      if (std::isnan(field[cell])) continue;
      visit(field[cell]);
    }
  }
};

Cells checked(const Grid& grid, std::span<const float> field, std::span<const std::uint8_t> mask) {
  const auto cells = static_cast<std::size_t>(grid.size());
  if (field.size() != cells || (!mask.empty() && mask.size() != cells)) {
    throw InputError("quantiles: field of " + std::to_string(field.size()) + " and mask of " +
                     std::to_string(mask.size()) + " values on a grid of " + std::to_string(cells) +
                     " cells");
  }
  return {grid, field, mask};
}

std::vector<Share> row_shares(const Grid& grid) {
  std::vector<Share> share(grid.ny());
  for (int j = 0; j < grid.ny(); ++j) {
    share[j] = static_cast<Share>(std::ldexp(grid.area_m2(j) / grid.total_area_m2(), 62));
  }
  return share;
}

// Weighted histograms over the upper halves of the keys, then over the lower halves within the
// buckets that were asked for. Integer sums do not depend on their order.
class Histogram {
 public:
  explicit Histogram(const Cells& cells)
      : cells_(cells), share_(row_shares(cells.grid)), upper_(kBuckets, 0) {
    count(upper_, [](std::uint32_t key) { return key >> 16; });
    for (const Share s : upper_) total_ += s;
    if (total_ == 0) throw InputError("quantiles: no cell has a value");
  }

  [[nodiscard]] Share total() const { return total_; }

  struct Rank {
    std::uint32_t key = 0;
    Share below = 0, up_to = 0;  // area of smaller keys, and with this key
  };

  // First key at which the cumulative area reaches each target (1 .. total).
  [[nodiscard]] std::vector<Rank> find(const std::vector<Share>& targets) const {
    std::vector<std::uint32_t> bucket;
    std::vector<Share> below;
    for (const Share target : targets) {
      Share sum = 0;
      std::uint32_t b = 0;
      while (sum + upper_[b] < target) sum += upper_[b++];
      bucket.push_back(b);
      below.push_back(sum);
    }
    std::vector<std::uint32_t> distinct = bucket;
    std::sort(distinct.begin(), distinct.end());
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    const std::vector<Share> lower = refine(distinct);
    std::vector<Rank> ranks;
    for (std::size_t t = 0; t < targets.size(); ++t) {
      const Share* bins = lower.data() + slot_of(distinct, bucket[t]) * kBuckets;
      Share sum = below[t];
      std::uint32_t b = 0;
      while (sum + bins[b] < targets[t]) sum += bins[b++];
      ranks.push_back({bucket[t] << 16 | b, sum, sum + bins[b]});
    }
    return ranks;
  }

 private:
  static std::size_t slot_of(const std::vector<std::uint32_t>& distinct, std::uint32_t bucket) {
    return std::lower_bound(distinct.begin(), distinct.end(), bucket) - distinct.begin();
  }

  [[nodiscard]] std::vector<Share> refine(const std::vector<std::uint32_t>& distinct) const {
    constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> slot(kBuckets, kNowhere);
    for (const std::uint32_t b : distinct) {
      slot[b] = static_cast<std::uint32_t>(slot_of(distinct, b)) * kBuckets;
    }
    std::vector<Share> lower(distinct.size() * kBuckets, 0);
    count(lower, [&](std::uint32_t key) {
      const std::uint32_t base = slot[key >> 16];
      return base == kNowhere ? kNowhere : base + (key & 0xffffU);
    });
    return lower;
  }

  template <class BinOf>
  void count(std::vector<Share>& bins, BinOf bin_of) const {
    ParallelErrors errors;
#pragma omp parallel if (cells_.grid.size() > 16384)
    {
      auto own = errors.make<std::vector<Share>>(bins.size(), 0);
#pragma omp for schedule(static) nowait
      for (int j = 0; j < cells_.grid.ny(); ++j) {
        if (errors.any()) continue;
        cells_.for_row(j, [&](float value) {
          const std::uint32_t bin = bin_of(to_key(value));
          if (bin < own.size()) own[bin] += share_[j];
        });
      }
#pragma omp critical(geo_quantiles)
      for (std::size_t b = 0; b < own.size(); ++b) bins[b] += own[b];
    }
    errors.rethrow();
  }

  Cells cells_;
  std::vector<Share> share_, upper_;
  Share total_ = 0;
};

// Area of a fraction; at least the smallest possible, so that fraction 0 asks for the minimum.
Share target_of(double fraction, Share total) {
  if (!(fraction >= 0.0 && fraction <= 1.0)) {
    throw InputError("quantiles: fraction " + std::to_string(fraction) + " is not within [0, 1]");
  }
  const auto wanted = static_cast<Share>(std::ceil(static_cast<long double>(fraction) * total));
  return std::clamp<Share>(wanted, 1, total);
}

}  // namespace

std::vector<float> quantiles(const Grid& grid, std::span<const float> field,
                             std::span<const double> fractions,
                             std::span<const std::uint8_t> mask) {
  const Histogram histogram(checked(grid, field, mask));
  std::vector<Share> targets;
  for (const double fraction : fractions) targets.push_back(target_of(fraction, histogram.total()));
  std::vector<float> values;
  for (const auto& rank : histogram.find(targets)) values.push_back(to_value(rank.key));
  return values;
}

float quantile(const Grid& grid, std::span<const float> field, double fraction,
               std::span<const std::uint8_t> mask) {
  return quantiles(grid, field, {&fraction, 1}, mask).front();
}

float level_for_fraction(const Grid& grid, std::span<const float> field, double fraction,
                         std::span<const std::uint8_t> mask) {
  const Histogram histogram(checked(grid, field, mask));
  const Share target = target_of(fraction, histogram.total());
  const auto rank = histogram.find({target}).front();
  const float value = to_value(rank.key);
  const bool above_is_nearer = rank.up_to - target < target - rank.below;
  return above_is_nearer ? std::nextafter(value, std::numeric_limits<float>::infinity()) : value;
}

double fraction_below(const Grid& grid, std::span<const float> field, float level,
                      std::span<const std::uint8_t> mask) {
  const Cells cells = checked(grid, field, mask);
  std::vector<std::int64_t> below(grid.ny(), 0), all(grid.ny(), 0);
#pragma omp parallel for schedule(static) if (grid.size() > 16384)
  for (int j = 0; j < grid.ny(); ++j) {
    cells.for_row(j, [&](float value) {
      ++all[j];
      if (value < level) ++below[j];
    });
  }
  double area_below = 0.0, area = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    area_below += below[j] * grid.area_m2(j);
    area += all[j] * grid.area_m2(j);
  }
  if (area == 0.0) throw InputError("quantiles: no cell has a value");
  return area_below / area;
}

double area_mean(const Grid& grid, std::span<const float> field,
                 std::span<const std::uint8_t> mask) {
  const Cells cells = checked(grid, field, mask);
  std::vector<double> sum(grid.ny(), 0.0);
  std::vector<std::int64_t> count(grid.ny(), 0);
#pragma omp parallel for schedule(static) if (grid.size() > 16384)
  for (int j = 0; j < grid.ny(); ++j) {
    cells.for_row(j, [&](float value) {
      sum[j] += value;
      ++count[j];
    });
  }
  double weighted = 0.0, area = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    weighted += sum[j] * grid.area_m2(j);
    area += count[j] * grid.area_m2(j);
  }
  if (area == 0.0) throw InputError("quantiles: no cell has a value");
  return weighted / area;
}

}  // namespace geo
