#include "flow_weights.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "kernels/numerics/wide.hpp"

namespace geo {
namespace {

// Ratios in (0, 1] to a power without a call, so that loops over them run several at once: log2 by
// the series of atanh, 2^x by that of the exponential, each within 2e-7. The same bits everywhere.
[[gnu::always_inline]] inline float raise_ratio(float ratio, float exponent) {
  const auto bits = std::bit_cast<std::int32_t>(std::max(ratio, 1e-30F));
  // Mantissa within [√½, √2).
  const std::int32_t power = (bits - 0x3f3504f3) >> 23;
  const float mantissa = std::bit_cast<float>(bits - power * (1 << 23));
  const float t = (mantissa - 1.0F) / (mantissa + 1.0F), t2 = t * t;
  const float series =
      t * (2.88539008F + t2 * (0.961796694F + t2 * (0.577078016F + t2 * 0.4121986F)));
  const float log2 = static_cast<float>(power) + series;

  const float x = std::max(exponent * log2, -126.0F);
  const auto whole = static_cast<std::int32_t>(x - 0.5F);  // nearest, as x <= 0
  const float f = x - static_cast<float>(whole);
  const float exp2 =
      1.0F + f * (0.693147181F +
                  f * (0.240226507F +
                       f * (0.0555041087F +
                            f * (0.00961812911F + f * (0.00133335581F + f * 1.5403530e-4F)))));
  return exp2 * std::bit_cast<float>((whole + 127) << 23);
}

/// Cells that are weighed together: few enough for the nearest cache.
constexpr int kRun = 64;
struct Run {
  std::array<std::array<float, kRun>, kDirections> weight;
  std::array<std::int32_t, kRun> lower;  ///< bit k: neighbour k is lower
};

/// Which neighbours of n cells in a row are lower, bit k for neighbour k.
TERRANE_WIDE void find_lower(const float* surface_m, const std::array<Index, kDirections>& offset,
                             int n, std::array<std::int32_t, kRun>& lower) {
  for (int k = 0; k < kDirections; ++k) {
    const float* beside = surface_m + offset[k];
    for (int c = 0; c < n; ++c) lower[c] |= (beside[c] < surface_m[c] ? 1 : 0) << k;
  }
}

/// Weights of n cells in a row, before those of contours.
TERRANE_WIDE void weigh(const float* surface_m, const std::array<Index, kDirections>& offset,
                        const std::array<double, kDirections>& distance_m, float exponent, int n,
                        Run& run) {
  std::array<float, kRun> steepest;
  steepest.fill(std::numeric_limits<float>::min());
  run.lower.fill(0);
  for (int k = 0; k < kDirections; ++k) {
    const float* beside = surface_m + offset[k];
    const auto distance = static_cast<float>(distance_m[k]);
    for (int c = 0; c < n; ++c) {
      const float slope = std::max((surface_m[c] - beside[c]) / distance, 0.0F);
      run.weight[k][c] = slope;
      steepest[c] = std::max(steepest[c], slope);
      run.lower[c] |= (beside[c] < surface_m[c] ? 1 : 0) << k;
    }
  }
  if (exponent == 1.0F) return;
  for (int k = 0; k < kDirections; ++k) {
    // Masked by bits: a choice would keep the loop from running several at once.
    for (int c = 0; c < n; ++c) {
      const float raised = raise_ratio(run.weight[k][c] / steepest[c], exponent);
      const std::int32_t is_lower = -(run.lower[c] >> k & 1);
      run.weight[k][c] = std::bit_cast<float>(std::bit_cast<std::int32_t>(raised) & is_lower);
    }
  }
}

}  // namespace

std::uint8_t FlowWeights::receivers(int column, int row) const {
  const Index cell = grid_.cell(column, row), to = receiver_[cell];
  if (to == cell) return 0;
  const Neighbours cells = neighbours(column, row);
  std::uint8_t lower = 0;
  if (partition_.method == FlowMethod::multiple) {
    for (int k = 0; k < kDirections; ++k) {
      if (cells[k] != kNoCell && surface_[cells[k]] < surface_[cell]) lower |= 1U << k;
    }
  } else if (partition_.method == FlowMethod::d_infinity) {
    const Weights weight = facet_weights(row, cell, cells);
    for (int k = 0; k < kDirections; ++k) {
      if (weight[k] > 0.0F) lower |= 1U << k;
    }
  }
  if (lower != 0) return lower;
  const auto at = std::find(cells.begin(), cells.end(), to);
  return static_cast<std::uint8_t>(at == cells.end() ? 0 : 1U << (at - cells.begin()));
}

Weights FlowWeights::weights(int row, Index cell, const Neighbours& cells,
                             std::uint8_t receivers) const {
  if (std::has_single_bit(receivers)) {
    Weights only{};
    only[std::countr_zero(receivers)] = 1.0F;
    return only;
  }
  return partition_.method == FlowMethod::multiple ? slope_weights(row, cell, cells, receivers)
                                                   : facet_weights(row, cell, cells);
}

Weights FlowWeights::slope_weights(int row, Index cell, const Neighbours& cells,
                                   std::uint8_t receivers) const {
  const auto& distance = grid_.distances_m(row);
  Weights weight{};
  float steepest = 0.0F;
  for (int k = 0; k < kDirections; ++k) {
    if ((receivers >> k & 1U) == 0) continue;
    weight[k] = (surface_[cell] - surface_[cells[k]]) / static_cast<float>(distance[k]);
    steepest = std::max(steepest, weight[k]);
  }
  if (partition_.exponent != 1.0) {
    const auto exponent = static_cast<float>(partition_.exponent);
    for (float& w : weight) w = raise_ratio(w / steepest, exponent);
  }
  for (int k = 0; k < kDirections; ++k) {
    if ((receivers >> k & 1U) == 0) weight[k] = 0.0F;
  }
  if (partition_.contour_weights) face_contours(row, weight);
  return weight;
}

void FlowWeights::face_contours(int row, Weights& weight) const {
  const auto& distance = grid_.distances_m(row);
  const auto width = static_cast<float>(distance[kEast]),
             height = static_cast<float>(distance[kNorth]);
  const float corner = 0.25F * std::sqrt(width * width + height * height);
  const Weights contour{0.5F * width, corner, 0.5F * height, corner,
                        0.5F * width, corner, 0.5F * height, corner};
  for (int k = 0; k < kDirections; ++k) weight[k] *= contour[k];
}

int FlowWeights::receivers_of_run(int column, int row, std::uint8_t* receivers) const {
  const Index cell = grid_.cell(column, row);
  const bool together = begins_run(column, row);
  const int n = together ? std::min(kRun, grid_.nx() - 1 - column) : 1;
  const auto is_root = [&](int c) { return receiver_[cell + c] == cell + c; };
  int first = 0;
  while (first < n && is_root(first)) ++first;
  std::fill_n(receivers, first, std::uint8_t{0});
  if (first == n) return n;
  std::array<std::int32_t, kRun> lower{};
  if (together) find_lower(surface_.data() + cell, offset_, n, lower);
  for (int c = first; c < n; ++c) {
    receivers[c] = static_cast<std::uint8_t>(is_root(c) ? 0 : lower[c]);
    if (receivers[c] == 0) receivers[c] = this->receivers(column + c, row);
  }
  return n;
}

int FlowWeights::weights_of_run(int column, int row, const std::uint8_t* receivers,
                                float* weights) const {
  const Index cell = grid_.cell(column, row);
  const bool together = begins_run(column, row);
  const int n = together ? std::min(kRun, grid_.nx() - 1 - column) : 1;
  const auto has_several = [](std::uint8_t to) { return (to & (to - 1)) != 0; };
  Run run;
  if (together && std::any_of(receivers, receivers + n, has_several)) {
    weigh(surface_.data() + cell, offset_, grid_.distances_m(row),
          static_cast<float>(partition_.exponent), n, run);
  }
  for (int c = 0; c < n; ++c) {
    const std::uint8_t to = receivers[c];
    if (!has_several(to)) {
      if (to != 0) *weights++ = 1.0F;
      continue;
    }
    Weights of_cell{};
    if (together) {
      for (int k = 0; k < kDirections; ++k) of_cell[k] = run.weight[k][c];
      if (partition_.contour_weights) face_contours(row, of_cell);
    } else {
      of_cell = this->weights(row, cell + c, neighbours(column + c, row), to);
    }
    for (unsigned rest = to; rest != 0; rest &= rest - 1) {
      *weights++ = of_cell[std::countr_zero(rest)];
    }
  }
  return n;
}

Weights FlowWeights::facet_weights(int row, Index cell, const Neighbours& cells) const {
  const auto& distance = grid_.distances_m(row);
  float steepest = 0.0F, to_side = 0.0F, to_corner = 0.0F;
  int best_side = -1, best_corner = -1;
  float best_ahead = 0.0F, best_aside = 0.0F;
  for (int side = 0; side < kDirections; side += 2) {
    if (cells[side] == kNoCell) continue;
    const auto ahead = static_cast<float>(distance[side]);
    const auto aside = static_cast<float>(distance[(side + 2) % kDirections]);
    const float down = (surface_[cell] - surface_[cells[side]]) / ahead;
    for (const int corner : {(side + 7) % kDirections, side + 1}) {
      if (cells[corner] == kNoCell) continue;
      const float across = (surface_[cells[side]] - surface_[cells[corner]]) / aside;
      float slope = 0.0F, side_part = down, corner_part = across;
      if (across <= 0.0F) {
        slope = down;
        corner_part = 0.0F;
      } else if (across * ahead >= down * aside) {
        slope = (surface_[cell] - surface_[cells[corner]]) / static_cast<float>(distance[corner]);
        side_part = 0.0F;
      } else {
        slope = std::sqrt(down * down + across * across);
      }
      if (slope > steepest) {
        steepest = slope;
        best_side = side;
        best_corner = corner;
        to_side = side_part;
        to_corner = corner_part;
        best_ahead = ahead;
        best_aside = aside;
      }
    }
  }
  Weights weight{};
  if (best_side < 0) return weight;
  if (to_corner <= 0.0F) {
    weight[best_side] = 1.0F;
  } else if (to_side <= 0.0F) {
    weight[best_corner] = 1.0F;
  } else {
    // In proportion to the angles between the flow and either neighbour.
    const float angle = std::atan2(to_corner, to_side), whole = std::atan2(best_aside, best_ahead);
    weight[best_corner] = angle / whole;
    weight[best_side] = std::max(0.0F, 1.0F - angle / whole);
  }
  return weight;
}

}  // namespace geo
