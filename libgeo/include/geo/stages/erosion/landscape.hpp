#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "geo/core/cell_set.hpp"
#include "geo/core/numeric.hpp"
#include "geo/core/release.hpp"
#include "geo/kernels/landscape/deltas.hpp"
#include "geo/kernels/landscape/marine_deposition.hpp"
#include "geo/kernels/landscape/river_sediment.hpp"
#include "geo/kernels/landscape/stream_power.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/numerics/diffusion.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "geo/kernels/water/valley_width.hpp"
#include "geo/stages/erosion/drainage.hpp"
#include "geo/stages/erosion/seas.hpp"

namespace geo {

/// Rock volumes that pass through a landscape, m3. Uplift and rebound are summed from rates and
/// loads, the rest from what processes did to the surface: with `stored_m3`, which is the surface
/// at the end less that at the beginning, they close to the rounding of sums in double precision.
template <class Number>
struct RockVolumes {
  Number uplifted{0.0}, eroded{0.0}, rebound{0.0}, reshaped{0.0};
  Number shortened{0.0};     ///< crust that convergence has added
  Number laid_on_land{0.0};  ///< of what was eroded
  Number laid_at_sea{0.0};
  Number over_edges{0.0};  ///< by rivers, out of the world
  Number rounded{0.0};     ///< what heights in single precision differ from those sums
};

/// What rivers have laid down: thickness now and what was laid in all; and what each cell of land
/// gave to its river in the last step, by ice too, less what it kept of the river's.
struct SedimentRecord {
  std::vector<float> thickness_m, laid_m;
  std::vector<float> released_m3_yr;
};

/// What a landscape remembers of its steps, one value per cell.
template <class V>
struct LandscapeRecords {
  std::vector<V> lowered_m;  ///< by how much each cell was lowered
  // Empty where numbers carry derivatives:
  std::vector<double> crust_change_m;  ///< shortening and deposition less erosion
  std::vector<float> raised_m;         ///< by uplift and rebound in all; empty without shortening
  SedimentRecord sediment;             ///< empty where rivers lay nothing down
};

/// Ice that changes elevation, m, from what it was `before_m`, which stays: returns the rock that
/// it lets out to the water of cells, m3, in parts that add up.
using IceWork = std::function<std::vector<SparseValues<double>>(std::span<float> elevation_m,
                                                                std::span<const float> before_m)>;

/// Called within a step that water is routed after, as soon as the step reads no more of that part
/// of its drainage: who holds it may let it go. All may be empty.
struct DrainageDone {
  std::function<void()> area{};     ///< drained area
  std::function<void()> flooded{};  ///< what is flooded
  std::function<void()> graph{};    ///< receivers and their order
};

/// One run of the landscape: rivers, hillslopes and rebound work on a surface, step by step, along
/// the drainage that each step is given. V as in core/numeric.hpp; derivatives are those with the
/// frozen drainage. Without deposition what rivers take is gone, and the sea floor stays.
template <class V>
class Landscape {
 public:
  using Number = Arithmetic<V>;

  /// `thickening_m_yr`: crust that shortening adds, whose uplift `uplift_m_yr` holds; or empty.
  /// `outlets`: cells that keep their height: find_outlets of the surface, and where rivers enter.
  /// `erodibility`: resolved for this grid, one per cell or a single one.
  Landscape(const ErosionParameters& parameters, const ActiveVariables<V>& active, const Grid& grid,
            std::span<V> elevation_m, std::span<const V> uplift_m_yr,
            std::span<const V> thickening_m_yr, std::span<const V> erodibility,
            std::vector<std::uint8_t> outlets)
      : p_(parameters),
        active_(active),
        grid_(grid),
        z_(elevation_m),
        uplift_m_yr_(uplift_m_yr),
        thickening_m_yr_(thickening_m_yr),
        erodibility_(erodibility),
        initial_m3_(volume_m3()),
        outlets_(std::move(outlets)) {
    if (p_.relaxation_fraction > 0.0) initial_.assign(z_.begin(), z_.end());
    records_.lowered_m.assign(grid.size(), V(0.0F));
    if constexpr (kRecords) {
      records_.crust_change_m.assign(grid.size(), 0.0);
      if (!thickening_m_yr_.empty()) records_.raised_m.assign(grid.size(), 0.0F);
    }
    if (!deposits()) return;
    unsettled_m_.assign(grid.size(), Number(0.0));
    if constexpr (kRecords) {
      records_.sediment.thickness_m.assign(grid.size(), 0.0F);
      records_.sediment.laid_m.assign(grid.size(), 0.0F);
    }
  }

  [[nodiscard]] const Grid& grid() const { return grid_; }
  /// Where the water leaves the land.
  [[nodiscard]] const std::vector<std::uint8_t>& outlets() const { return outlets_; }

  /// Sediment that lies there before the first step, m as rock without pores, one value per cell:
  /// the records go on from it. Empty: none is known.
  void begin_with(std::span<const float> sediment_m) {
    if (sediment_m.empty()) return;
    records_.sediment.thickness_m.assign(sediment_m.begin(), sediment_m.end());
  }

  /// Whether water cuts down the sills that it crosses.
  [[nodiscard]] bool breaches() const { return p_.depressions == "breach" && p_.steps > 0; }
  /// Lets it do so.
  void breach(const Drainage& drainage);

  /// Uplift of one step. Floor of the sea may come up out of it: the coast is then to be told anew.
  void raise();
  /// What works on the surface in a step once it has been raised.
  /// `builds_deltas`: the step ends at a time when the sea has stood still for a while. `ice`, if
  /// any, works after the rivers; where it lets the sea in, the coast moves. `done`: see there.
  void step(const Drainage& drainage, bool builds_deltas = false, const IceWork& ice = {},
            const DrainageDone& done = {});

  /// Rock that sinks under a load that is none of its own, m per cell, as a part of the rebound.
  void sink(std::span<const float> by_m);

  /// Blueprint 4.6: part of the way back to the isostatic elevation.
  void relax();

  /// Lets `change` change elevation at will. Returns whether it did; land and sea are then to be
  /// told apart again.
  template <class Change>
  bool reshape(Change&& change) {
    before_.assign(z_.begin(), z_.end());
    const bool did = change();
    if (did) rock_.reshaped += volume_since_before();
    release(before_);
    return did;
  }
  /// Seas that land cuts off (landlocked_cells): rivers fill them to the brim.
  void set_landlocked(std::vector<std::uint8_t> cells) { landlocked_ = std::move(cells); }
  /// Those that are full are land.
  void dry_filled_seas() {
    if (landlocked_.empty()) return;
    reshape([&] {
#pragma omp parallel for schedule(static)
      for (Index cell = 0; cell < grid_.size(); ++cell) {
        if (landlocked_[cell] != 0 && value_of(z_[cell]) >= -1.5F * kShallowest_m) {
          z_[cell] = greater(z_[cell], V(0.0F));
        }
      }
      return true;
    });
  }
  void set_outlets(std::vector<std::uint8_t> outlets) { outlets_ = std::move(outlets); }

  [[nodiscard]] BasicStreamPower<Number> law() const {
    return {active_(p_.area_exponent), active_(p_.slope_exponent), active_(p_.time_step_yr), 0.0};
  }
  [[nodiscard]] const RockVolumes<Number>& rock() const { return rock_; }
  /// Whether rivers deposit what they cannot carry.
  [[nodiscard]] bool deposits() const { return p_.deposits() && p_.steps > 0; }
  /// Volume that has reached the sea but is not laid: what heights round away, and what a sea has
  /// no room for, m3.
  [[nodiscard]] Number unsettled_m3() const {
    if (unsettled_m_.empty()) return Number(0.0);
    return area_sum<Number>(grid_, [&](Index c) { return unsettled_m_[c]; });
  }
  [[nodiscard]] const LandscapeRecords<V>& records() const { return records_; }
  /// The same to keep: once rock has ceased to move, and its volumes have been read.
  [[nodiscard]] LandscapeRecords<V> take_records() {
    release(unsettled_m_), release(owed_m_), release(initial_), release(landlocked_);
    return std::move(records_);
  }
  /// Volume above the initial surface, m3.
  [[nodiscard]] Number stored_m3() const { return volume_m3() - initial_m3_; }

 private:
  static constexpr bool kRecords = std::is_same_v<V, float>;
  static constexpr float kShallowest_m = 1e-3F;  // what is sea stays sea

  template <class Change>
  void on_land(Change&& change) {
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      if (outlets_[cell] == 0) change(cell);
    }
  }
  template <class Change>
  void at_sea_floor(Change&& change) {
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      if (outlets_[cell] != 0 && value_of(z_[cell]) < 0.0) change(cell);
    }
  }
  /// Adds to a volume of the budget what a process has added to the land since `before_`, m per
  /// cell.
  template <class Height>
  void account_land(Number& volume, Height&& rise_m) {
    account(volume, rise_m, [&](Index c) { return outlets_[c] == 0; });
  }
  /// And to the floor of the sea.
  template <class Height>
  void account_sea_floor(Number& volume, Height&& rise_m) {
    account(volume, rise_m,
            [&](Index c) { return outlets_[c] != 0 && value_of(before_[c]) < 0.0; });
  }
  template <class Height, class Where>
  void account(Number& volume, Height&& rise_m, Where&& where) {
    volume += area_sum<Number>(grid_, [&](Index c) { return where(c) ? rise_m(c) : Number(0.0); });
    if constexpr (kRecords) {
      rock_.rounded += area_sum<double>(
          grid_, [&](Index c) { return where(c) ? rounding_m(c, rise_m(c)) : 0.0; });
    }
  }
  /// What the height of a cell misses of the sum of the one before and a rise: nothing if that is
  /// more than a few roundings of single precision, so that a process that does something else than
  /// what is accounted for shows as an error in the budget.
  [[nodiscard]] double rounding_m(Index cell, double rise_m) const {
    constexpr double kFew = 0x1p-21;
    const double now_m = z_[cell], before_m = before_[cell], missed_m = now_m - before_m - rise_m;
    return std::abs(missed_m) <= kFew * std::max(std::abs(now_m), std::abs(before_m)) ? missed_m
                                                                                      : 0.0;
  }
  /// Where the coast is told anew in each step, crust that sinks takes land below the sea. Else
  /// subsidence ends at the shore.
  [[nodiscard]] bool coast_moves() const { return !thickening_m_yr_.empty(); }
  [[nodiscard]] V as_land(const Number& height_m) const {
    return coast_moves() ? V(height_m) : greater(V(0.0F), V(height_m));
  }
  /// How far land rises that is to rise so far.
  [[nodiscard]] Number rise_of_land(Index cell, const Number& by_m) const {
    return coast_moves() ? by_m : greater(by_m, Number(-Number(before_[cell])));
  }
  /// The same of the floor of the sea, which stays below it.
  [[nodiscard]] Number rise_of_sea_floor(Index cell, const Number& by_m) const {
    const Number before_m(before_[cell]);
    return lesser(by_m, Number(greater(Number(-kShallowest_m), before_m) - before_m));
  }
  /// Above the level of the sea, below it negative.
  [[nodiscard]] Number volume_m3() const {
    return area_sum<Number>(grid_, [&](Index c) { return Number(z_[c]); });
  }
  [[nodiscard]] Number volume_since_before() const {
    return area_sum<Number>(grid_, [&](Index c) { return Number(z_[c]) - Number(before_[c]); });
  }
  void record_raising();
  /// Crust grows also where the sea stands on it.
  void thicken(const Number& dt);
  /// Hillslopes end at the shore: what moves down them does not see the depth of the sea.
  void creep();
  /// Where rivers pass through outlets, as they do where they enter a part of a planet.
  void hold_outlets();
  void account_lowering();
  /// Takes what this step lowered down the rivers and lays it at sea. `graph_done`: as in
  /// DrainageDone.
  void carry(const FlowGraph& graph, const IceWork& ice = {},
             const std::function<void()>& graph_done = {});
  [[nodiscard]] std::vector<Number> outflow(const FlowGraph& graph, std::span<const V> before_m,
                                            std::span<const V> after_m) const {
    return sediment_outflow<V>(grid_, graph, before_m, after_m);
  }
  /// What rivers bring, what ice takes and what it lays down; what it lets out goes down the rivers
  /// with theirs.
  void let_ice_work(const FlowGraph& graph, const IceWork& ice,
                    const std::function<void()>& graph_done);
  /// Lays at sea what has come to its shores.
  void spread_at_sea(std::vector<Number>& volume_m3);
  [[nodiscard]] bool is_landlocked(Index cell) const {
    return !landlocked_.empty() && landlocked_[cell] != 0;
  }
  /// What rivers bring while the sea stands where it does builds land at their mouths; `volume_m3`
  /// keeps what is left. Not where numbers carry derivatives: a cell is filled or it is not.
  void build_at_mouths(std::span<const std::uint8_t> sea, std::vector<Number>& volume_m3);
  /// What has been laid on land and taken from it since `before_`.
  void record_layers();
  void record_released(const FlowGraph& graph, const std::vector<Number>& volume_m3);
  void record_at_sea(std::span<const V> laid_m);
  /// Airy rebound of the eroded load, and subsidence under what is laid, spread by the plate and
  /// delayed by the mantle: the part 1 - exp(-dt / tau) of what is still owed comes in each step.
  /// At sea rock takes the place of water.
  void rebound();

  const ErosionParameters& p_;
  ActiveVariables<V> active_;
  const Grid& grid_;
  std::span<V> z_;
  std::span<const V> uplift_m_yr_, thickening_m_yr_;
  std::span<const V> erodibility_;
  std::vector<V> initial_;  ///< the surface that it may be brought back to, or empty
  Number initial_m3_;
  std::vector<std::uint8_t> outlets_;
  std::vector<std::uint8_t> landlocked_;  ///< or empty
  bool builds_deltas_ = false;
  std::vector<V> before_, owed_m_;
  std::vector<Number> unsettled_m_;
  LandscapeRecords<V> records_;
  RockVolumes<Number> rock_;
};

template <class V>
void Landscape<V>::breach(const Drainage& drainage) {
  if (!breaches()) return;
  before_.assign(z_.begin(), z_.end());
  breach_sills(grid_, drainage.graph, z_);
  account_lowering();
  carry(drainage.graph);
  release(before_);
}

template <class V>
void Landscape<V>::step(const Drainage& drainage, bool builds_deltas, const IceWork& ice,
                        const DrainageDone& done) {
  builds_deltas_ = builds_deltas;
  release(records_.sediment.released_m3_yr);
  before_.assign(z_.begin(), z_.end());
  const std::span<const double> area_m2(drainage.area_m2);
  if (deposits()) {
    incise_and_deposit<V, V>(grid_, drainage.graph, area_m2, erodibility_, law(),
                             active_(p_.deposition), drainage.flooded, z_, done.area);
  } else {
    incise(grid_, drainage.graph, area_m2, erodibility_, law(), z_);
    if (done.area) done.area();
  }
  if (done.flooded) done.flooded();
  creep();
  hold_outlets();
  widen_valleys<V>(grid_, before_, outlets_, z_);
  account_lowering();
  carry(drainage.graph, ice, done.graph);
  if (p_.rebound_fraction > 0.0) rebound();
  release(before_);
}

template <class V>
void Landscape<V>::creep() {
  if (p_.diffusivity_m2_yr <= 0.0) return;
  std::vector<V> surface(z_.size());
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid_.size(); ++cell) {
    surface[cell] = greater(z_[cell], V(0.0F));
  }
  apply_linear<V, 2>(surface, {active_(p_.diffusivity_m2_yr), active_(p_.time_step_yr)},
                     [&](auto values, const std::array<double, 2>& at) {
                       diffuse(grid_, values, at[0], at[1],
                               {.fixed = outlets_, .scheme = DiffusionScheme::positive});
                     });
  on_land([&](Index cell) { z_[cell] = surface[cell]; });
}

template <class V>
void Landscape<V>::hold_outlets() {
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid_.size(); ++cell) {
    if (outlets_[cell] != 0) z_[cell] = before_[cell];
  }
}

template <class V>
void Landscape<V>::account_lowering() {
  rock_.eroded -= volume_since_before();
  on_land([&](Index cell) { records_.lowered_m[cell] += before_[cell] - z_[cell]; });
  if constexpr (kRecords) {
    on_land([&](Index cell) { records_.crust_change_m[cell] += Number(z_[cell]) - before_[cell]; });
  }
}

}  // namespace geo

#include "geo/stages/erosion/landscape_sediment.hpp"
#include "geo/stages/erosion/landscape_uplift.hpp"
