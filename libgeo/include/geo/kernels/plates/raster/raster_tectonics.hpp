#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/random.hpp"
#include "geo/kernels/plates/raster/raster_rules.hpp"

namespace geo {

/// Plates as height maps on a torus: the model of "Physically Based Terrain Generation: Procedural
/// Heightmap Generation Using Plate Tectonics" (Viitanen 2012), chapter 7.
///
/// A step moves the plates, looks where they meet, and fills what they leave:
///  - Of two plates at a cell, ocean floor (height < 1) that is lower, or as low and older, loses
///    `ocean_crust`; `melting_ratio` (1 - h) of it rises some way inland along the relative motion.
///  - What cannot subduct collides as continents do: the larger of both continents takes
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

  /// All plates' crust in one map.
  [[nodiscard]] RasterMap map() const;

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

  void divide(std::vector<RasterCrust> crust);
  void move();
  [[nodiscard]] RasterCycle::Motion motion() const;
  void meet_along(int world_row);
  void meet(const Meeting& meeting, int world_row, Row& events);
  void subduct(int below, int above, std::int32_t place, int column, Row& events);
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
  std::vector<Row> rows_;
  RasterBudget budget_;
  RasterCycle cycle_;
  bool over_ = false;
  bool pays_ = true;  // to wait for other threads in each step: not on small maps
};

}  // namespace geo
