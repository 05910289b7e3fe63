#include <algorithm>

#include "geo/kernels/sphere_tectonics.hpp"

namespace geo {
namespace {

/// Share of the difference in excess that flows to each neighbour in a round: stable for up to
/// eight of them.
constexpr double kFlow = 0.125;
constexpr int kRounds = 200;
constexpr double kLevel_m = 1.0;

}  // namespace

/// Hot crust at the foot of thick roots flows towards thinner crust beside them, so that belts grow
/// into plateaus instead of growing thicker: what is above `thickest_km` diffuses over the
/// continent, dh/dt = div(D grad max(h - h_c, 0)), so fast that a step sees its end. What finds no
/// room, because the land is too small, sinks into the mantle and is lost.
void SphereTectonics::spread_roots() {
  if (settings_.thickest_km <= 0.0) return;
  SphereCrust& crust = state_.crust;
  const double most_m = 1e3 * settings_.thickest_km;
  const auto holds = [&](std::int32_t i) {
    return crust.plate[i] >= 0 && crust.continental[i] != 0 && hidden_[i] == 0;
  };
  std::vector<std::int32_t> thick;
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    if (holds(i) && crust.thickness_m[i] > most_m) thick.push_back(i);
  }
  if (thick.empty()) return;
  std::vector<double> gain_m(crust.size(), 0.0), change_m(crust.size(), 0.0);
  const auto excess_m = [&](std::int32_t i) {
    return std::max(0.0, crust.thickness_m[i] + gain_m[i] - most_m);
  };
  std::vector<std::uint8_t> is_reached(crust.size(), 0);
  std::vector<std::int32_t> reached(thick);
  for (const std::int32_t i : thick) is_reached[i] = 1;
  for (int round = 0; round < kRounds; ++round) {
    double largest_m = 0.0;
    const std::size_t sources = reached.size();
    for (std::size_t k = 0; k < sources; ++k) {
      const std::int32_t i = reached[k];
      const double from_m = excess_m(i);
      largest_m = std::max(largest_m, from_m);
      if (from_m <= 0.0) continue;
      for (const std::int32_t j : mesh_->neighbours(i)) {
        if (!holds(j) || crust.plate[j] != crust.plate[i]) continue;
        const double flow_m = kFlow * std::max(0.0, from_m - excess_m(j));
        change_m[i] -= flow_m;
        change_m[j] += flow_m;
        if (is_reached[j] != 0) continue;
        is_reached[j] = 1;
        reached.push_back(j);
      }
    }
    if (largest_m < kLevel_m) break;
    for (const std::int32_t i : reached) {
      gain_m[i] += change_m[i];
      change_m[i] = 0.0;
    }
  }
  for (const std::int32_t i : reached) {
    const double sunk_m = excess_m(i);
    gain_m[i] -= sunk_m;
    budget_.lost_km3 += 1e-3 * sample_km2() * sunk_m;
    crust.thickness_m[i] += static_cast<float>(gain_m[i]);
    crust.elevation_m[i] += static_cast<float>(gain_m[i] / settings_.rebound);
  }
}

}  // namespace geo
