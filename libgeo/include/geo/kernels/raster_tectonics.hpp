#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/random.hpp"
#include "geo/kernels/raster_plate.hpp"

namespace geo {

/// What one plate has of its own; NaN where it follows RasterSettings.
struct RasterPlateSettings {
  double folding_ratio = std::numeric_limits<double>::quiet_NaN();
  double overlap_relative = std::numeric_limits<double>::quiet_NaN();
  double erosion_steps = std::numeric_limits<double>::quiet_NaN();
  double speed = std::numeric_limits<double>::quiet_NaN();  ///< over the common one
};

/// Settings of plates on a torus (Viitanen 2012, 7.3). Lengths in cells, times in steps, crust in
/// heights: 1 is sea level.
struct RasterSettings {
  RasterWorld world;
  int plates = 10;
  double sea_share = 0.65;         ///< of the first map
  double continents_across = 4.0;  ///< lattice cells of the first map's noise along x
  int cycles = 2;                  ///< times that the world is divided into plates
  int cycle_steps = 600;           ///< most steps of a cycle
  double folding_ratio = 0.02;     ///< of the crust of the smaller continent, each step
  double overlap_cells = 1e6;      ///< overlap from which continents become one
  double overlap_relative = 0.33;  ///< the same as a share of the smaller continent
  int erosion_steps = 60;          ///< between erosions; 0: none
  double erosion = 0.8;            ///< share of a step down to four lower neighbours
  int continent_steps = 4;         ///< for which outlines of continents are remembered
  double ocean_crust = 0.1;        ///< height of new ocean floor, and what a step subducts
  double melting_ratio = 0.5;      ///< of subducted crust at depth 1 that rises as magma
  double speed = 1.0;              ///< of a new plate, cells per step
  double speed_spread = 0.5;       ///< relative, uniform
  double arc_cells = 10.0;         ///< from where crust goes down to where its magma rises
  double arc_scatter_cells = 3.0;
  double friction = 2.0;           ///< of folded crust over a plate's mass, in new plates' speed
  double spin = 0.0;               ///< fastest turn of a new plate, radians per step
  double curve = 0.0;              ///< fastest turn of a new plate's direction, radians per step
  double restart_speed = 0.2;      ///< mean speed, over that of new plates, that ends a cycle
  double restart_momentum = 0.15;  ///< sum of momenta over its peak that ends a cycle
  int restart_quiet = 10;          ///< steps without continents meeting that end a cycle
  double buoyancy = 3.0;           ///< of new floor, in ocean_crust
  int buoyant_steps = 20;          ///< until that has gone
  double trench = 0.0;             ///< depth of trenches that show, height
  int trench_steps = 20;           ///< for which they show after crust went down there
  std::vector<RasterPlateSettings> own;  ///< of plate 0, 1, ...; may be shorter
};

/// Books of crust, sums of heights over cells since the start.
struct RasterBudget {
  double start = 0.0;      ///< crust of the first map
  double created = 0.0;    ///< new floor where plates part
  double subducted = 0.0;  ///< taken from plates that go down
  double melted = 0.0;     ///< of that, what came up again
  double folded = 0.0;     ///< moved from smaller to larger continents
  double merged = 0.0;     ///< moved with continents from plate to plate
  std::int64_t steps = 0;
  int cycles = 0, mergers = 0;
};

/// The world's map: one value for each cell.
struct RasterMap {
  std::vector<RasterCrust> crust;    ///< of all plates at a place together
  std::vector<std::int16_t> plate;   ///< the one on top
  std::vector<std::int32_t> trench;  ///< step at which crust last went down there, or -1
};

/// Plates as height maps on a torus: the model of "Physically Based Terrain Generation: Procedural
/// Heightmap Generation Using Plate Tectonics" (Viitanen 2012), chapter 7.
///
/// A step moves the plates, looks where they meet, and fills what they leave:
///  - Of two plates at a cell, ocean floor (height < 1) that is lower, or as low and older, loses
///    `ocean_crust`; `melting_ratio` (1 - h) of it rises some way inland along the relative motion.
///  - What cannot go down meets as continents do: the larger of both continents takes
///    `folding_ratio` of the smaller one's crust there, and both plates lose speed,
///    friction * crust / mass.
///  - Continents that overlap by `overlap_cells` or by `overlap_relative` of the smaller one's area
///    become one: the smaller moves to the larger one's plate, with its momentum.
///  - Empty cells get new floor, of the plate that was there before.
/// A cycle ends when plates have slowed down, nothing meets any more, or after `cycle_steps`; then
/// all crust is divided into new plates.
///
/// Mass is conserved but for new floor and what is subducted and does not rise: `budget()` has
/// both.
///
/// Where plates meet is looked for row by row of the world, on all threads; rows touch no cell in
/// common. What reaches farther is done afterwards in the order of rows. Results do not depend on
/// the number of threads. Cost: linear in cells and steps.
class RasterTectonics {
 public:
  /// Throws ConfigurationError on sides below 16 cells, more than 32 767 plates or 32 000 steps.
  RasterTectonics(const RasterSettings& settings, std::uint64_t seed);

  /// One step, or the division into new plates. False when the last cycle is over.
  bool advance();

  /// All plates' crust in one map; with `visible`, young ocean floor stands higher and trenches
  /// lower, as RasterSettings says.
  [[nodiscard]] RasterMap map(bool visible) const;

  [[nodiscard]] const RasterSettings& settings() const { return settings_; }
  [[nodiscard]] const std::vector<RasterPlate>& plates() const { return plates_; }
  [[nodiscard]] const RasterBudget& budget() const { return budget_; }
  [[nodiscard]] std::int64_t steps() const { return budget_.steps; }
  /// Sum of all heights now, counted cell by cell.
  [[nodiscard]] double mass() const;
  /// Share of all steps that are over, if no cycle ends early.
  [[nodiscard]] double progress() const;

 private:
  struct Subduction {
    std::int32_t column;
    std::int16_t below, above;
    float before, after, melt;
    std::int32_t target;  ///< in the upper plate's map, of what rises
  };
  struct Fold {
    std::int32_t column;
    std::int16_t from, to;
    float before, after, other_before, other_after;
    std::int32_t continent, other;
  };
  struct Meeting {
    std::int32_t column, place, other_place;
    std::int16_t plate, other;
  };
  /// What happened along a row of the world.
  struct Row {
    std::vector<Meeting> meetings;
    std::vector<Subduction> subductions;
    std::vector<Fold> folds;
    std::vector<std::int32_t> gaps;
  };
  struct Overlap {
    std::int16_t a, b;
    std::int32_t continent_a, continent_b;
    std::int64_t cells;
  };

  [[nodiscard]] double own(int plate, double RasterPlateSettings::*value, double common) const;
  void divide(std::vector<RasterCrust> crust);
  void move();
  [[nodiscard]] bool is_over();
  void meet_along(int world_row);
  void meet(const Meeting& meeting, int world_row, Row& events);
  void subduct(int below, int above, std::int32_t place, int column, int row, Row& events);
  void fold(int a, std::int32_t place_a, int b, std::int32_t place_b, int column, int row,
            Row& events);
  [[nodiscard]] std::int32_t arc_place(const Subduction& event, int row,
                                       const RandomStream& random) const;
  void raise_arcs();
  void slow_down();
  void merge_continents(std::span<const Overlap> overlaps);
  void merge(const Overlap& overlap);
  void fill_gaps();

  RasterSettings settings_;
  std::uint64_t seed_;
  std::vector<RasterPlate> plates_;
  std::vector<std::int16_t> owner_, previous_;
  std::vector<std::int32_t> trench_;
  std::vector<Row> rows_;
  RasterBudget budget_;
  double peak_momentum_ = 0.0;
  int cycle_step_ = 0, quiet_ = 0;
  bool over_ = false;
  bool pays_ = true;  // to wait for other threads in each step: not on small maps
};

}  // namespace geo
