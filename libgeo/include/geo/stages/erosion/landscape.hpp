#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/numeric.hpp"
#include "geo/kernels/landscape/stream_power.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/numerics/diffusion.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/kernels/water/valley_width.hpp"
#include "geo/stages/erosion/drainage.hpp"

namespace geo {

/// Rock volumes that pass through a landscape, m3.
template <class Number>
struct RockVolumes {
  Number uplifted{0.0}, eroded{0.0}, rebound{0.0}, reshaped{0.0};
};

/// One run of the landscape: rivers, hillslopes and rebound work on a relief, step by step, along
/// the drainage that each step is given. V as in core/numeric.hpp; derivatives are those with the
/// drainage held fast.
template <class V>
class Landscape {
 public:
  using Number = Arithmetic<V>;

  /// `outlets`: find_outlets of the relief. `erodibility`: resolved for this grid, one per cell.
  Landscape(const ErosionParameters& parameters, const ActiveVariables<V>& active, const Grid& grid,
            std::span<V> elevation_m, std::span<const V> uplift_m_yr,
            std::span<const V> erodibility, std::vector<std::uint8_t> outlets)
      : p_(parameters),
        lift_(active),
        grid_(grid),
        z_(elevation_m),
        uplift_m_yr_(uplift_m_yr),
        erodibility_(erodibility),
        initial_(elevation_m.begin(), elevation_m.end()),
        outlets_(std::move(outlets)),
        lowered_(grid.size(), V(0.0F)) {}

  /// Where the water leaves the land.
  [[nodiscard]] const std::vector<std::uint8_t>& outlets() const { return outlets_; }

  /// Cuts down the sills that the water crosses, where depressions are breached.
  void breach(const Drainage& drainage) {
    if (p_.depressions != "breach" || p_.steps == 0) return;
    before_.assign(z_.begin(), z_.end());
    breach_sills(grid_, drainage.graph, z_);
    book_lowering();
  }

  void step(const Drainage& drainage) {
    raise();
    before_.assign(z_.begin(), z_.end());
    incise(grid_, drainage.graph, std::span<const double>(drainage.area_m2), erodibility_, law(),
           z_);
    creep();
    widen_valleys<V>(grid_, before_, outlets_, z_);
    book_lowering();
    if (p_.rebound_fraction > 0.0) rebound();
  }

  /// Blueprint 4.6: part of the way back to the isostatic elevation.
  void relax() {
    if (p_.relaxation_fraction <= 0.0) return;
    before_.assign(z_.begin(), z_.end());
    const V share(lift_(p_.relaxation_fraction));
    on_land([&](Index cell) { z_[cell] += share * (initial_[cell] - z_[cell]); });
    rock_.rebound += volume_since_before();
  }

  /// Lets `reshape` change the relief at will. Returns whether it did; land and sea are then to be
  /// told apart again.
  template <class Reshape>
  bool book_reshaping(Reshape&& reshape) {
    before_.assign(z_.begin(), z_.end());
    if (!reshape()) return false;
    rock_.reshaped += volume_since_before();
    return true;
  }
  void set_outlets(std::vector<std::uint8_t> outlets) { outlets_ = std::move(outlets); }

  [[nodiscard]] BasicStreamPower<Number> law() const {
    return {lift_(p_.area_exponent), lift_(p_.slope_exponent), lift_(p_.time_step_yr), 0.0};
  }
  [[nodiscard]] const RockVolumes<Number>& rock() const { return rock_; }
  /// By how much each cell was lowered, m.
  [[nodiscard]] std::span<const V> lowered_m() const { return lowered_; }
  /// Volume above the initial relief, m3.
  [[nodiscard]] Number stored_m3() const {
    return area_sum<Number>(grid_, [&](Index c) { return Number(z_[c]) - Number(initial_[c]); });
  }

 private:
  template <class Change>
  void on_land(Change&& change) {
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      if (outlets_[cell] == 0) change(cell);
    }
  }
  [[nodiscard]] Number volume_since_before() const {
    return area_sum<Number>(grid_, [&](Index c) { return Number(z_[c]) - Number(before_[c]); });
  }
  void raise() {
    before_.assign(z_.begin(), z_.end());
    const Number dt = lift_(p_.time_step_yr), everywhere = 1e-3 * lift_(p_.uplift_mm_yr);
    on_land([&](Index cell) {
      const Number field = uplift_m_yr_.empty() ? Number(0.0) : Number(uplift_m_yr_[cell]);
      // Subsidence ends at the sea: a step that drowned land would move the coast without a
      // routing.
      z_[cell] = greater(V(0.0F), V(Number(z_[cell]) + (field + everywhere) * dt));
    });
    rock_.uplifted += volume_since_before();
  }
  /// Hillslopes end at the shore: what moves down them does not see the depth of the sea.
  void creep() {
    if (p_.diffusivity_m2_yr <= 0.0) return;
    std::vector<V> surface(z_.size());
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      surface[cell] = greater(z_[cell], V(0.0F));
    }
    apply_linear<V, 2>(surface, {lift_(p_.diffusivity_m2_yr), lift_(p_.time_step_yr)},
                       [&](auto values, const std::array<double, 2>& at) {
                         diffuse(grid_, values, at[0], at[1],
                                 {.fixed = outlets_, .scheme = DiffusionScheme::positive});
                       });
    on_land([&](Index cell) { z_[cell] = surface[cell]; });
  }
  void book_lowering() {
    rock_.eroded -= volume_since_before();
    on_land([&](Index cell) { lowered_[cell] += before_[cell] - z_[cell]; });
  }
  /// Airy rebound of the eroded load, spread by the plate and delayed by the mantle:
  /// the part 1 - exp(-dt / tau) of what is still owed comes back in each step.
  void rebound() {
    owed_m_.resize(grid_.size(), V(0.0F));
    const V share(lift_(p_.rebound_fraction));
    on_land([&](Index cell) { owed_m_[cell] += share * (before_[cell] - z_[cell]); });
    const Number part = -expm1_of(Number(-lift_(p_.time_step_yr) / lift_(p_.rebound_time_yr)));
    std::vector<V> response(owed_m_);
    if (p_.rebound_length_km > 0.0) {
      apply_linear<V, 1>(response, {1000.0 * lift_(p_.rebound_length_km)},
                         [&](auto values, const std::array<double, 1>& length_m) {
                           smooth_broadly(grid_, values, length_m[0]);
                         });
    }
    before_.assign(z_.begin(), z_.end());
    on_land([&](Index cell) {
      z_[cell] = greater(V(0.0F), V(z_[cell] + V(part * Number(response[cell]))));
      owed_m_[cell] -= V(part) * owed_m_[cell];
    });
    rock_.rebound += volume_since_before();
  }

  const ErosionParameters& p_;
  ActiveVariables<V> lift_;
  const Grid& grid_;
  std::span<V> z_;
  std::span<const V> uplift_m_yr_;
  std::span<const V> erodibility_;
  std::vector<V> initial_;
  std::vector<std::uint8_t> outlets_;
  std::vector<V> lowered_, before_, owed_m_;
  RockVolumes<Number> rock_;
};

}  // namespace geo
