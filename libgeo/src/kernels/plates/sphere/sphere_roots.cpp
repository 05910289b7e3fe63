#include <algorithm>

#include "sample_sums.hpp"
#include "sphere_steps.hpp"

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
void spread_roots(SphereTectonics& model) {
  if (model.settings.thickest_km <= 0.0) return;
  SphereCrust& crust = model.state.crust;
  const std::int32_t n = crust.size();
  const double most_m = 1e3 * model.settings.thickest_km;
  std::vector<std::int32_t> reached;  // by what flows, in the order in which it comes
  std::vector<std::int16_t> land_of(n);
  std::vector<std::uint8_t> is_reached(n);
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) {
    const bool holds =
        crust.plate[i] >= 0 && crust.continental[i] != 0 && model.margins.hidden[i] == 0;
    land_of[i] = static_cast<std::int16_t>(holds ? crust.plate[i] : -1);
    is_reached[i] = holds && crust.thickness_m[i] > most_m ? 1 : 0;
  }
  for (std::int32_t i = 0; i < n; ++i) {
    if (is_reached[i] != 0) reached.push_back(i);
  }
  if (reached.empty()) return;
  std::vector<double> gain_m(n, 0.0), change_m(n, 0.0), excess_m(n, 0.0);
  const auto put_excess = [&](std::int32_t i) {
    excess_m[i] = std::max(0.0, crust.thickness_m[i] + gain_m[i] - most_m);
  };
  for (const std::int32_t i : reached) put_excess(i);
  for (int round = 0; round < kRounds; ++round) {
    double largest_m = 0.0;
    const std::size_t sources = reached.size();
    for (std::size_t k = 0; k < sources; ++k) {
      const std::int32_t i = reached[k];
      const double from_m = excess_m[i];
      largest_m = std::max(largest_m, from_m);
      if (from_m <= 0.0) continue;
      for (const std::int32_t j : model.mesh->neighbours(i)) {
        if (land_of[j] != land_of[i]) continue;
        const double flow_m = kFlow * std::max(0.0, from_m - excess_m[j]);
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
      put_excess(i);
    }
  }
  WholeGains gains;
  for (const std::int32_t i : reached) {
    gain_m[i] -= excess_m[i];
    model.budget.lost_km3 += 1e-3 * model.sample_km2() * excess_m[i];
    gains.put(crust.thickness_m[i], gain_m[i]);
    crust.elevation_m[i] =
        static_cast<float>(height_after(crust.elevation_m[i], gain_m[i], model.settings.rebound));
  }
  model.budget.lost_km3 += 1e-3 * model.sample_km2() * gains.left();
}

}  // namespace geo
