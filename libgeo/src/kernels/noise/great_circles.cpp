#include "geo/kernels/noise/great_circles.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/core/random.hpp"
#include "kernels/numerics/wide.hpp"

namespace geo {
namespace {

constexpr int kBlock = 512;
constexpr float kUnit = 4194304.0F;  // 2^22: what one circle adds at most
constexpr int kBatch = 256;          // circles whose sum fits 32 bits
constexpr float kSaturated = 25.0F;  // powers of two beyond which H is 0 or 1 in those units

struct Block {
  alignas(64) std::array<float, kBlock> x, y, z;
  alignas(64) std::array<std::int32_t, kBlock> sum;
};

/// Adds H = 1 / (1 + 2^s) for one circle; s is linear in the place. Without branches, so that the
/// compiler vectorises it.
TERRANE_WIDE void add_circle(Block& block, int count, float x, float y, float z, float shift) {
  constexpr float kWhole = 12582912.0F;  // 2^23 + 2^22: a sum with it is rounded to a whole number
  for (int k = 0; k < count; ++k) {
    const float far = x * block.x[k] + y * block.y[k] + z * block.z[k] + shift;
    const float s = 0.5F * (std::abs(far + kSaturated) - std::abs(far - kSaturated));
    const float moved = s + kWhole;
    const float f = s - (moved - kWhole);
    // 2^f on [-1/2, 1/2]: its series, within 2e-7.
    const float power =
        1.0F + f * (0.69314718F +
                    f * (0.24022651F +
                         f * (0.055504109F +
                              f * (0.0096181291F + f * (0.0013333558F + f * 0.00015403530F)))));
    const auto exponent = (std::bit_cast<std::uint32_t>(moved) << 23) + 0x3f800000U;
    const float h = 1.0F / (1.0F + power * std::bit_cast<float>(exponent));
    block.sum[k] += static_cast<std::int32_t>(h * kUnit + 0.5F);
  }
}

/// Rows and columns of a grid that lie near each other.
struct Tile {
  int column, row, columns, rows;
};

}  // namespace

GreatCircles::GreatCircles(const CircleCuts& cuts, std::uint64_t seed, std::string_view stream) {
  if (cuts.circles < 1 || !(cuts.steepness > 0.0)) {
    throw ConfigurationError("great circles: " + std::to_string(cuts.circles) +
                             " circles of steepness " + std::to_string(cuts.steepness) +
                             ": both must be positive");
  }
  const RandomStream random(seed, stream);
  const double scale = -2.0 * cuts.steepness * std::numbers::log2e;
  width_ = kSaturated / std::abs(scale);
  for (std::int64_t k = 0; k < cuts.circles; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    const Circle circle{random.direction(number),
                        random.uniform(number, 1, -cuts.offset, cuts.offset)};
    circles_.push_back(circle);
    scaled_.push_back(
        {static_cast<float>(scale * circle.axis[0]), static_cast<float>(scale * circle.axis[1]),
         static_cast<float>(scale * circle.axis[2]), static_cast<float>(scale * circle.offset)});
  }
}

void GreatCircles::read(std::span<const Vector3> places, std::span<float> values) const {
  Block block;
  std::array<std::int64_t, kBlock> total{};
  const double half = 0.5 * static_cast<double>(circles_.size());
  const double scale = 2.0 / std::sqrt(static_cast<double>(circles_.size()));
  for (std::size_t first = 0; first < places.size(); first += kBlock) {
    const int count = static_cast<int>(std::min<std::size_t>(kBlock, places.size() - first));
    Vector3 middle{};
    for (int k = 0; k < count; ++k) {
      const Vector3& at = places[first + k];
      middle = add(middle, at);
      block.x[k] = static_cast<float>(at[0]);
      block.y[k] = static_cast<float>(at[1]);
      block.z[k] = static_cast<float>(at[2]);
    }
    middle = normalised(middle);
    double reach = 0.0;
    for (int k = 0; k < count; ++k) {
      reach = std::max(reach, length(add(places[first + k], middle, -1.0)));
    }
    constexpr double kRoundOff = 1e-6;
    reach += width_ + kRoundOff;

    std::fill_n(total.begin(), count, 0);
    std::fill_n(block.sum.begin(), count, 0);
    std::int64_t above = 0;
    int in_batch = 0;
    const auto flush = [&] {
      for (int k = 0; k < count; ++k) total[k] += block.sum[k];
      std::fill_n(block.sum.begin(), count, 0);
      in_batch = 0;
    };
    for (std::size_t c = 0; c < circles_.size(); ++c) {
      const double from_circle = dot(circles_[c].axis, middle) + circles_[c].offset;
      if (from_circle < -reach) continue;
      if (from_circle > reach) {
        ++above;
        continue;
      }
      const Scaled& circle = scaled_[c];
      add_circle(block, count, circle.x, circle.y, circle.z, circle.shift);
      if (++in_batch == kBatch) flush();
    }
    flush();
    for (int k = 0; k < count; ++k) {
      const double sum = static_cast<double>(above) + static_cast<double>(total[k]) / kUnit;
      values[first + k] = static_cast<float>(scale * (sum - half));
    }
  }
}

void great_circle_noise(const Grid& grid, const GreatCircles& circles, std::span<float> values) {
  if (values.size() != static_cast<std::size_t>(grid.size())) {
    throw InputError("great circles: " + std::to_string(values.size()) + " values on a grid of " +
                     std::to_string(grid.size()) + " cells");
  }
  constexpr int kRows = 16, kMostColumns = kBlock / kRows;
  std::vector<Tile> tiles;
  for (int row = 0; row < grid.ny(); row += kRows) {
    const int rows = std::min(kRows, grid.ny() - row);
    const double widest_m = std::max(grid.spacing_east_m(row), grid.spacing_east_m(row + rows - 1));
    const int columns =
        std::clamp(static_cast<int>(kRows * grid.spacing_north_m(row) / std::max(1.0, widest_m)), 1,
                   kMostColumns);
    for (int column = 0; column < grid.nx(); column += columns) {
      tiles.push_back({column, row, std::min(columns, grid.nx() - column), rows});
    }
  }
  ParallelErrors errors;
#pragma omp parallel
  {
    std::vector<Vector3> places;
    auto in_tile = errors.make<std::vector<float>>(kBlock);
#pragma omp for schedule(dynamic, 16)
    for (std::size_t t = 0; t < tiles.size(); ++t) {
      errors.guard([&] {
        const Tile& tile = tiles[t];
        places.clear();
        for (int j = tile.row; j < tile.row + tile.rows; ++j) {
          for (int i = tile.column; i < tile.column + tile.columns; ++i) {
            places.push_back(grid.unit_vector(i, j));
          }
        }
        circles.read(places, std::span(in_tile).first(places.size()));
        for (int j = 0; j < tile.rows; ++j) {
          std::copy_n(in_tile.begin() + static_cast<std::ptrdiff_t>(j) * tile.columns, tile.columns,
                      values.begin() + grid.cell(tile.column, tile.row + j));
        }
      });
    }
  }
  errors.rethrow();
}

std::vector<float> great_circle_noise_at(const GreatCircles& circles,
                                         std::span<const Vector3> places) {
  std::vector<float> values(places.size());
#pragma omp parallel for schedule(dynamic, 4)
  for (std::size_t first = 0; first < places.size(); first += kBlock) {
    const std::size_t count = std::min<std::size_t>(kBlock, places.size() - first);
    circles.read(places.subspan(first, count), std::span(values).subspan(first, count));
  }
  return values;
}

}  // namespace geo
