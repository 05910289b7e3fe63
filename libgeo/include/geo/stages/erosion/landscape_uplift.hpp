#pragma once

// Landscape: what lifts the surface, and what lets it sink. Included by landscape.hpp.

#include <array>

#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/stages/erosion/landscape.hpp"

namespace geo {

template <class V>
void Landscape<V>::raise() {
  before_.assign(z_.begin(), z_.end());
  const Number dt = active_(p_.time_step_yr), everywhere = 1e-3 * active_(p_.uplift_mm_yr);
  const auto uplift_m = [&](Index cell) {
    const Number field = uplift_m_yr_.empty() ? Number(0.0) : Number(uplift_m_yr_[cell]);
    return Number((field + everywhere) * dt);
  };
  on_land([&](Index cell) { z_[cell] = as_land(Number(Number(z_[cell]) + uplift_m(cell))); });
  account_land(rock_.uplifted, [&](Index cell) { return rise_of_land(cell, uplift_m(cell)); });
  if (!thickening_m_yr_.empty()) thicken(dt);
  record_raising();
}

template <class V>
void Landscape<V>::record_raising() {
  if constexpr (kRecords) {
    if (records_.raised_m.empty()) return;
    on_land([&](Index cell) { records_.raised_m[cell] += z_[cell] - before_[cell]; });
  }
}

template <class V>
void Landscape<V>::thicken(const Number& dt) {
  at_sea_floor(
      [&](Index cell) { z_[cell] = V(Number(z_[cell]) + Number(uplift_m_yr_[cell]) * dt); });
  account_sea_floor(rock_.uplifted,
                    [&](Index cell) { return Number(Number(uplift_m_yr_[cell]) * dt); });
  rock_.shortened +=
      area_sum<Number>(grid_, [&](Index cell) { return Number(thickening_m_yr_[cell]) * dt; });
  if constexpr (kRecords) {
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      records_.crust_change_m[cell] += Number(thickening_m_yr_[cell]) * dt;
    }
  }
}

template <class V>
void Landscape<V>::rebound() {
  owed_m_.resize(grid_.size(), V(0.0F));
  const V share(active_(p_.rebound_fraction));
  on_land([&](Index cell) { owed_m_[cell] += share * (before_[cell] - z_[cell]); });
  if (deposits()) {
    constexpr double kWaterOverMantle = 1030.0 / 3300.0;
    const V at_sea(greater(
        Number((active_(p_.rebound_fraction) - kWaterOverMantle) / (1.0 - kWaterOverMantle)),
        Number(0.0)));
    at_sea_floor([&](Index cell) { owed_m_[cell] += at_sea * (before_[cell] - z_[cell]); });
  }
  const Number part = -expm1_of(Number(-active_(p_.time_step_yr) / active_(p_.rebound_time_yr)));
  std::vector<V> response(owed_m_);
  if (p_.rebound_length_km > 0.0) {
    apply_linear<V, 1>(response, {1000.0 * active_(p_.rebound_length_km)},
                       [&](auto values, const std::array<double, 1>& length_m) {
                         smooth_broadly(grid_, values, length_m[0]);
                       });
  }
  before_.assign(z_.begin(), z_.end());
  const auto comes_m = [&](Index cell) { return Number(part * Number(response[cell])); };
  on_land([&](Index cell) {
    z_[cell] = as_land(Number(z_[cell] + V(comes_m(cell))));
    owed_m_[cell] -= V(part) * owed_m_[cell];
  });
  account_land(rock_.rebound, [&](Index cell) { return rise_of_land(cell, comes_m(cell)); });
  if (deposits()) {
    at_sea_floor([&](Index cell) {
      z_[cell] = lesser(V(z_[cell] + V(comes_m(cell))), greater(z_[cell], V(-kShallowest_m)));
      owed_m_[cell] -= V(part) * owed_m_[cell];
    });
    account_sea_floor(rock_.rebound,
                      [&](Index cell) { return rise_of_sea_floor(cell, comes_m(cell)); });
  }
  record_raising();
}

template <class V>
void Landscape<V>::sink(std::span<const float> by_m) {
  before_.assign(z_.begin(), z_.end());
  on_land([&](Index cell) { z_[cell] -= V(by_m[cell]); });
  account_land(rock_.rebound, [&](Index cell) { return Number(-Number(by_m[cell])); });
  release(before_);
}

template <class V>
void Landscape<V>::relax() {
  if (p_.relaxation_fraction <= 0.0) return;
  const V share(active_(p_.relaxation_fraction));
  before_.assign(z_.begin(), z_.end());
  on_land([&](Index cell) { z_[cell] += share * (initial_[cell] - z_[cell]); });
  account_land(rock_.rebound, [&](Index cell) {
    return Number(Number(active_(p_.relaxation_fraction)) *
                  (Number(initial_[cell]) - Number(before_[cell])));
  });
  release(before_);
}

}  // namespace geo
