#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// What kind of terrain a place has (Cortial et al. 2019, section 5): mountains above subduction,
/// of a collision, long worn down, or none.
enum class Terrain : std::uint8_t { andean, himalayan, old_mountains, plain };
inline constexpr int kTerrains = 4;
/// "andean", "himalayan", "old_mountains", "plain".
[[nodiscard]] std::string_view name_of(Terrain terrain);

/// A piece of a DEM that terrain is made like: square cells, row 0 the southernmost.
struct Exemplar {
  std::string name;
  Terrain terrain = Terrain::plain;
  int nx = 0, ny = 0;
  double cell_m = 0.0;
  bool periodic = false;  ///< opposite edges meet
  std::vector<float> elevation_m;
  /// Measured (measure_exemplar):
  double fold_rad = 0.0;       ///< direction of its ridges, from east, without sign
  double fold_strength = 0.0;  ///< 0 where they run any way, 1 where all run one way
  float lowest_m = 0.0F, highest_m = 0.0F;
  double local_relief_m = 0.0;  ///< mean range of heights within squares of 10 km

  [[nodiscard]] Grid grid() const;
};

struct ExemplarLibrary {
  std::vector<Exemplar> exemplars;
};

/// Main direction of ridges by the structure tensor, and how strongly it is the main one:
///   tan 2 a = 2 J_xy / (J_xx - J_yy),  ridges across a,
///   strength = |(J_xx - J_yy, 2 J_xy)| / (J_xx + J_yy),
/// J_ij the mean of g_i g_j, g the gradient (central differences within the plane or torus).
/// Returns {angle from east within [0, pi), strength}. Bigün & Granlund (1987).
[[nodiscard]] std::array<double, 2> ridge_direction(const Grid& grid,
                                                    std::span<const float> elevation_m);

/// Fills what is measured: the fold direction of the elevation smoothed over 3 % of its shorter
/// side, the range of elevations and the local relief. With no `terrain` that of its local relief:
/// himalayan from 1500 m, andean from 600 m, old mountains from 150 m. Throws InputError when it
/// has fewer than 32 cells a side, cells of no size, more than 2000 km, heights that are not
/// numbers, or no relief.
void measure_exemplar(Exemplar& exemplar, std::optional<Terrain> terrain = {});

/// How large terrain is that is grown, on a torus of 256 cells a side.
struct GrownSize {
  double cell_m = 300.0;
  double folds = 1.0;   ///< factor of their number across the torus
  double ranges = 1.0;  ///< how far folds stand out as ranges, and how straight they run
};
/// For what is finer than a planet's cells: 77 km a side.
inline constexpr GrownSize kGrownForIslands{};
/// For what is finer than a planet's plates: 1024 km a side, ranges and basins some 85 km apart.
inline constexpr GrownSize kGrownForPlanets{.cell_m = 4000.0, .folds = 1.75, .ranges = 3.0};

/// A library grown with the erosion kernels of planets: for each terrain, stream power and creep
/// against uplift on a torus, over beds of hard and soft rock and folds that run east. Uplift is
/// one-sided (andean), broad and fast (himalayan), slow over strongly banded rock with much creep
/// (old mountains), or next to none (plain). With exponents 1/2 and 1 of area and slope, steady
/// terrain is as high on a torus of any size. A function of its size alone: the same library
/// always. Takes some seconds.
[[nodiscard]] ExemplarLibrary grow_exemplars(const GrownSize& size = kGrownForIslands);
[[nodiscard]] Exemplar grow_exemplar(Terrain terrain, const GrownSize& size = kGrownForIslands);

}  // namespace geo
