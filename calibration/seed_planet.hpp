#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "calibration/model.hpp"
#include "calibration/ranking.hpp"
#include "geo/core/state.hpp"
#include "geo/kernels/landscape/sea_level.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "geo/stages/erosion/drainage.hpp"
#include "geo/stages/erosion/finishing.hpp"
#include "geo/stages/erosion/ground.hpp"
#include "geo/stages/erosion/landscape.hpp"
#include "geo/stages/erosion/seas.hpp"
#include "geo/stages/erosion/wear_down.hpp"
#include "geo/stages/isostasy/floating_crust.hpp"
#include "geo/stages/isostasy/freeboard.hpp"
#include "geo/stages/isostasy/rocks.hpp"

namespace geo::calibration {

/// What the forward model gives for one planet.
template <class V>
struct PlanetSurface {
  std::vector<V> elevation_m, thickness_m;
  V erosion_rate_m_yr{0.0};  ///< mean over the land
  /// Sum of -elevation over the sea times the area, m3.
  V water_m3{0.0};
};

/// What is frozen between two routings: where sections, rocks, sea and rivers lie.
struct FrozenDrainage {
  std::optional<TectonicFrame> frame;
  double divergent_length_km = 0.0, transform_length_km = 0.0;  ///< that the frame was made with
  std::vector<float> erodibility;
  std::vector<std::uint8_t> outlets, landlocked;
  /// Cells that straits have drowned before the first step, after the last, and once the sea has
  /// moved, and their heights, m.
  using Straits = std::vector<std::pair<Index, float>>;
  Straits straits, late_straits, last_straits;
  /// The level of the sea after them, which follows the mean of the cells next to it, and flats at
  /// that level that become sea.
  struct MovedSea {
    float level_m = 0.0F;
    Straits flats{};
    std::optional<Ranking> ranking{};
    Ranking::Window window{};
    double mean_m = 0.0;
  } late_sea, last_sea;
  /// Where belts have lifted floor out of the sea: told apart anew before each step.
  struct Coast {
    bool has_moved = false;
    std::vector<std::uint8_t> outlets, landlocked;
  };
  std::vector<Coast> coasts;
  std::vector<Drainage> drainage;  ///< one for each routing of the erosion stage
  /// Sea level as a mean over cells next to it (by share) or over the sea (by volume), and how it
  /// follows the share or volume that is asked for.
  struct Sea {
    bool at_shore = false;  ///< shelves end there: a bend, where no cell may stand
    std::optional<Ranking> ranking{};
    Ranking::Window window{};
    std::vector<std::uint8_t> wet{};
    double level_m = 0.0, mean_m = 0.0, asked = 0.0, rate = 0.0;
  } sea{.at_shore = true};
  /// The sea before continents settle, each time they do, and the cells below it.
  struct Settling {
    Sea sea;
    std::vector<std::uint8_t> wet;
  };
  bool settles = false;
  std::array<Settling, kSettlings> settlings;
};

/// What isostasy makes of a planet, with what erosion needs of it.
template <class V>
struct Ground {
  explicit Ground(std::size_t cells)
      : convergent(cells),
        divergent(cells),
        transform(cells),
        weakness(cells),
        density(cells),
        thickening(cells, V(0.0)) {
    surface.elevation_m.resize(cells);
    surface.thickness_m.resize(cells);
  }
  PlanetSurface<V> surface;
  std::vector<V> convergent, divergent, transform, weakness, density, thickening;
};

/// Plates of one seed, and the surface that isostasy and erosion make of them.
class SeedPlanet {
 public:
  /// Grows the plates, with the settings of the configuration. `sea_in_gap`: the sea stands between
  /// the heights of cells, where nothing bends, by up to half a gap lower than in a run.
  SeedPlanet(std::span<const Parameter> configuration, std::uint64_t seed, int nx, int ny,
             bool sea_in_gap = true);

  [[nodiscard]] std::uint64_t seed() const { return seed_; }
  [[nodiscard]] const Grid& grid() const { return state_.grid(); }
  [[nodiscard]] std::span<const float> continental_fraction() const {
    return state_.read(field::continental_fraction);
  }
  [[nodiscard]] const FrozenDrainage& held() const { return held_; }

  /// The surface with everything rerouted, which is then frozen.
  [[nodiscard]] PlanetSurface<double> reroute(const Model& model) {
    return evaluate<double>(model, {}, /*routes=*/true);
  }
  /// The surface with all frozen as `reroute` left it: a smooth function of the parameters. V is
  /// double, a dual number, or std::complex<double>.
  template <class V>
  [[nodiscard]] PlanetSurface<V> with_frozen_drainage(const Model& model,
                                                      const ActiveVariables<V>& active) {
    return evaluate<V>(model, active, /*routes=*/false);
  }

 private:
  template <class V>
  PlanetSurface<V> evaluate(const Model& model, const ActiveVariables<V>& active, bool routes);
  [[nodiscard]] CrustInputs crust_inputs() const;
  /// Stage isostasy: the crust floats, continents settle, the sea fills.
  template <class V>
  void float_crust(const Model& model, const ActiveVariables<V>& active, bool routes,
                   Ground<V>& ground);
  /// The erodibility of rock, to be held.
  template <class V>
  void freeze_rock(const Model& model, const Ground<V>& ground);
  /// Cells that straits drown in a surface, to be held, and the surface with them.
  std::vector<float> find_straits(const ErosionParameters& p, const std::vector<float>& before,
                                  FrozenDrainage::Straits& straits) const;
  /// Land and sea of a surface, where that is not as it was.
  [[nodiscard]] FrozenDrainage::Coast find_coast(const ErosionParameters& p,
                                                 const std::vector<float>& elevation_m,
                                                 const std::vector<std::uint8_t>& before) const;
  /// Where the sea moves to cover its share of a surface.
  FrozenDrainage::MovedSea find_moved_sea(const ErosionParameters& p,
                                          const std::vector<float>& before, double share) const;
  template <class V>
  [[nodiscard]] std::vector<V> uplift_of(const Model& model, const ActiveVariables<V>& active,
                                         const Ground<V>& ground) const;
  /// The steps of stage erosion, along routes and coasts that are found or held; `grows`: belts
  /// thicken.
  template <class V>
  void wear_along_routes(const ErosionParameters& p, std::span<const V> z, bool routes, bool grows,
                         Landscape<V>& landscape);
  /// Rates and volumes over land and sea.
  template <class V>
  void sum_up(const ErosionParameters& p, const ActiveVariables<V>& active,
              const Landscape<V>& landscape, PlanetSurface<V>& surface) const;
  template <class V>
  static std::vector<float> as_floats(std::span<const V> field) {
    std::vector<float> values(field.size());
    for (std::size_t c = 0; c < values.size(); ++c) {
      values[c] = static_cast<float>(value_of(field[c]));
    }
    return values;
  }
  template <class V>
  V sea_level(const Model& model, const ActiveVariables<V>& active, std::span<const V> elevation_m,
              FrozenDrainage::Sea& sea, bool finds);
  /// Boundaries and distances from them: costly, and other only when a length of deformation is.
  void hold_frame(const IsostasyParameters& parameters, const CrustInputs& in);
  void find_sea(const Model& model, std::span<const double> elevation_m,
                FrozenDrainage::Sea& sea) const;

  std::uint64_t seed_;
  State state_;
  CoarseGrid coarse_;
  NoiseStore noise_;
  FrozenDrainage held_;
};

template <class V>
V SeedPlanet::sea_level(const Model& model, const ActiveVariables<V>& active,
                        std::span<const V> elevation_m, FrozenDrainage::Sea& sea, bool finds) {
  if (finds) {
    std::vector<double> values(elevation_m.size());
    for (std::size_t c = 0; c < values.size(); ++c) values[c] = value_of(elevation_m[c]);
    find_sea(model, values, sea);
  }
  V mean(0.0), asked(0.0);
  if (sea.ranking) {
    mean = sea.ranking->mean(sea.window, elevation_m);
    asked = active(model.planet.ocean_fraction);
  } else {
    double area = 0.0;
    const Grid& grid = this->grid();
    mean = area_sum<V>(grid, [&](Index c) { return sea.wet[c] != 0 ? elevation_m[c] : V(0.0); });
    area = area_sum<double>(grid, [&](Index c) { return static_cast<double>(sea.wet[c]); });
    mean /= area;
    asked = active(model.planet.water_volume_km3);
  }
  return sea.level_m + (mean - sea.mean_m) + sea.rate * (asked - sea.asked);
}

template <class V>
void SeedPlanet::float_crust(const Model& model, const ActiveVariables<V>& active, bool routes,
                             Ground<V>& ground) {
  const Grid& grid = this->grid();
  const auto cells = static_cast<std::size_t>(grid.size());
  std::vector<float> fraction(continental_fraction().begin(), continental_fraction().end());
  const CrustInputs in = crust_inputs();
  const Crust<V> crust{.parameters = model.isostasy,
                       .planet = model.planet,
                       .seed = seed_,
                       .grid = grid,
                       .in = in,
                       .fraction = fraction,
                       .convergent = ground.convergent,
                       .divergent = ground.divergent,
                       .transform = ground.transform,
                       .weakness = ground.weakness,
                       .thickness_m = ground.surface.thickness_m,
                       .density = ground.density,
                       .rock = {},
                       .erodibility = {},
                       .elevation_m = ground.surface.elevation_m,
                       .thickening_m_yr = ground.thickening,
                       .run_myr = growth_of_belts_myr<V>(model.erosion, active),
                       .active = active,
                       .noise = &noise_};
  if (routes) hold_frame(model.isostasy, in);
  float_margins_crust(crust, coarse_, *held_.frame);
  const std::span<V> z(ground.surface.elevation_m);
  if (routes) held_.settles = settles_continents(model.isostasy, model.planet);
  if (held_.settles) {
    for (FrozenDrainage::Settling& at : held_.settlings) {
      const V level_m = sea_level<V>(model, active, z, at.sea, routes);
      if (routes) {
        at.wet.resize(cells);
        for (std::size_t c = 0; c < cells; ++c) at.wet[c] = value_of(z[c]) < value_of(level_m);
      }
      settle_continents(crust, level_m, at.wet);
    }
  }
  fill_sea(crust, sea_level<V>(model, active, z, held_.sea, routes));
}

template <class V>
void SeedPlanet::freeze_rock(const Model& model, const Ground<V>& ground) {
  const std::size_t cells = ground.convergent.size();
  std::vector<float> fraction(continental_fraction().begin(), continental_fraction().end()),
      closing = as_floats<V>(ground.convergent), opening = as_floats<V>(ground.divergent),
      shear = as_floats<V>(ground.transform), none;
  std::vector<std::int8_t> rock(cells);
  held_.erodibility.assign(cells, 0.0F);
  classify_rock({.parameters = model.isostasy,
                 .planet = model.planet,
                 .seed = seed_,
                 .grid = grid(),
                 .in = crust_inputs(),
                 .fraction = fraction,
                 .convergent = closing,
                 .divergent = opening,
                 .transform = shear,
                 .weakness = none,
                 .thickness_m = none,
                 .density = none,
                 .rock = rock,
                 .erodibility = held_.erodibility,
                 .elevation_m = none,
                 .thickening_m_yr = {}});
}

template <class V>
std::vector<V> SeedPlanet::uplift_of(const Model& model, const ActiveVariables<V>& active,
                                     const Ground<V>& ground) const {
  const ErosionParameters& p = model.erosion;
  std::vector<V> uplift(ground.convergent.size(), V(0.0));
  if (p.uplift_from == "deformation" || p.uplift_from == "shortening") {
    add_belt_uplift<V>(p, active, ground.convergent, ground.divergent, ground.transform,
                       model.uplift_factor, uplift);
  } else if (p.uplift_from == "boundaries") {
    const CrustInputs in = crust_inputs();
    add_boundary_uplift<V>(p, active, in.boundary_type, in.boundary_strength, model.uplift_factor,
                           uplift);
  }
  return uplift;
}

template <class V>
void SeedPlanet::wear_along_routes(const ErosionParameters& p, std::span<const V> z, bool routes,
                                   bool grows, Landscape<V>& landscape) {
  std::size_t routings = 0;
  if (routes) held_.drainage.clear();
  const auto route = [&](std::int64_t) -> const Drainage& {
    const std::size_t at = routings++;
    if (!routes) return held_.drainage[at];
    drain(p, grid(), as_floats<V>(z), landscape.outlets(), held_.drainage.emplace_back());
    return held_.drainage.back();
  };
  if (routes) held_.coasts.assign(static_cast<std::size_t>(p.steps), {});
  const auto coast = [&](std::int64_t step) {
    FrozenDrainage::Coast& held = held_.coasts[static_cast<std::size_t>(step)];
    if (routes) held = find_coast(p, as_floats<V>(z), landscape.outlets());
    if (!held.has_moved) return false;
    landscape.set_outlets(held.outlets);
    landscape.set_landlocked(held.landlocked);
    return true;
  };
  wear_down(p, {.route = route, .coast = grows ? coast : std::function<bool(std::int64_t)>{}},
            landscape);
  if (p.steps > 0) landscape.dry_filled_seas();
}

template <class V>
void SeedPlanet::sum_up(const ErosionParameters& p, const ActiveVariables<V>& active,
                        const Landscape<V>& landscape, PlanetSurface<V>& surface) const {
  const Grid& grid = this->grid();
  const std::span<const V> z(surface.elevation_m);
  const auto is_land = [&](Index c) { return held_.outlets[c] == 0; };
  const double land_m2 = area_sum<double>(grid, [&](Index c) { return is_land(c) ? 1.0 : 0.0; });
  if (p.steps > 0 && land_m2 > 0.0) {
    const V time_yr = static_cast<double>(p.steps) * active(p.time_step_yr);
    surface.erosion_rate_m_yr = landscape.rock().eroded / (land_m2 * time_yr);
  }
  surface.water_m3 = area_sum<V>(grid, [&](Index c) { return is_land(c) ? V(0.0) : V(-z[c]); });
}

template <class V>
PlanetSurface<V> SeedPlanet::evaluate(const Model& model, const ActiveVariables<V>& active,
                                      bool routes) {
  const Grid& grid = this->grid();
  const ErosionParameters& p = model.erosion;
  Ground<V> ground(static_cast<std::size_t>(grid.size()));
  float_crust<V>(model, active, routes, ground);
  const std::span<V> z(ground.surface.elevation_m);
  double sea_share = 0.0;
  if (routes) {
    freeze_rock<V>(model, ground);
    sea_share = share_of_sea(grid, as_floats<V>(z));
    const std::vector<float> after = find_straits(p, as_floats<V>(z), held_.straits);
    held_.outlets = find_outlets(grid, after);
    held_.landlocked = landlocked_cells(p, grid, after);
  }
  for (const auto& [cell, height_m] : held_.straits) z[cell] = V(height_m);
  std::vector<V> uplift = uplift_of<V>(model, active, ground);
  std::vector<V> erodibility = resolved_erodibility<V>(p, active, grid, held_.erodibility);
  if (value_of(growth_of_belts_myr<V>(p, active)) > 0.0) {
    add_thickening_uplift<V>(p, active, grid, ground.thickening, uplift);
    break_rock<V>(p, active, ground.thickening, erodibility);
  } else {
    ground.thickening.clear();
  }
  Landscape<V> landscape(p, active, grid, z, uplift, ground.thickening, erodibility, held_.outlets);
  landscape.set_landlocked(held_.landlocked);
  wear_along_routes<V>(p, z, routes, !ground.thickening.empty(), landscape);
  if (routes) find_straits(p, as_floats<V>(z), held_.late_straits);
  for (const auto& [cell, height_m] : held_.late_straits) z[cell] = V(height_m);
  inject_noise(p, active, grid, seed_, z);
  warp(p, active, grid, seed_, z);
  landscape.relax();
  const auto move_sea = [&](FrozenDrainage::MovedSea& sea) {
    if (routes) sea = find_moved_sea(p, as_floats<V>(z), sea_share);
    V level_m(sea.level_m);
    if (sea.ranking) {
      level_m += V(sea.ranking->mean(sea.window, std::span<const V>(z)) - sea.mean_m);
    }
    for (V& height_m : z) height_m -= level_m;
    for (const auto& [cell, height_m] : sea.flats) z[cell] = V(height_m);
  };
  move_sea(held_.late_sea);
  // Where the sea has sunk, straits may have fallen dry.
  if (routes) find_straits(p, as_floats<V>(z), held_.last_straits);
  for (const auto& [cell, height_m] : held_.last_straits) z[cell] = V(height_m);
  if (!held_.last_straits.empty()) move_sea(held_.last_sea);
  sum_up<V>(p, active, landscape, ground.surface);
  return std::move(ground.surface);
}

}  // namespace geo::calibration
