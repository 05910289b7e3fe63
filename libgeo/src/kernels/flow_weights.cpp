#include "flow_weights.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace geo {
namespace {

// Ratios in (0, 1] to a power, eight at once without a call: log2 by the series of atanh, 2^x by
// that of the exponential, each within 2e-7. The same bits on every machine.
void raise_ratios(Weights& ratio, float exponent) {
  for (float& value : ratio) {
    const auto bits = std::bit_cast<std::int32_t>(std::max(value, 1e-30F));
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
    value = exp2 * std::bit_cast<float>((whole + 127) << 23);
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
    for (float& w : weight) w /= steepest;
    raise_ratios(weight, static_cast<float>(partition_.exponent));
  }
  for (int k = 0; k < kDirections; ++k) {
    if ((receivers >> k & 1U) == 0) weight[k] = 0.0F;
  }
  if (partition_.contour_weights) {
    const auto width = static_cast<float>(distance[kEast]),
               height = static_cast<float>(distance[kNorth]);
    const float corner = 0.25F * std::sqrt(width * width + height * height);
    const Weights contour{0.5F * width, corner, 0.5F * height, corner,
                          0.5F * width, corner, 0.5F * height, corner};
    for (int k = 0; k < kDirections; ++k) weight[k] *= contour[k];
  }
  return weight;
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
