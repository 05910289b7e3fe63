#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geo/kernels/plates/raster/raster_plate.hpp"

namespace geo {

/// The rules of plates as height maps (Viitanen 2012, chapter 7), which do not depend on the map:
/// the same on a torus and on a sphere. Heights: 1 is sea level.

/// Which of two plates at a place subducts, or that both are too thick for it: the one with less
/// crust, if that is below sea level; of equals the older, and of twins the second.
enum class RasterMeeting { first_sinks, second_sinks, both_stay };
[[nodiscard]] inline RasterMeeting raster_meeting(const RasterCrust& first,
                                                  const RasterCrust& second) {
  constexpr float kSame = 1e-6F;
  const bool first_floats = std::abs(first.height - second.height) < kSame
                                ? first.born >= second.born
                                : first.height > second.height;
  if (first_floats) {
    return second.height < 1.0F ? RasterMeeting::second_sinks : RasterMeeting::both_stay;
  }
  return first.height < 1.0F ? RasterMeeting::first_sinks : RasterMeeting::both_stay;
}

/// What a step takes from subducting crust: `floor` at most. Of it r (1 - h) melts: water on
/// top is what melts the mantle, so that the deeper the subducting crust, the more magma.
struct RasterSinking {
  float after, melt;
};
[[nodiscard]] inline RasterSinking raster_sinking(float height, double floor,
                                                  double melting_ratio) {
  const float after = std::max(0.0F, height - static_cast<float>(floor));
  return {after, static_cast<float>(melting_ratio) * (height - after) * (1.0F - height)};
}

/// How far from the trench its magma rises, along the lower plate's motion as the upper
/// one sees it: `reach` steps of that motion, plus a scatter of up to `scatter` to all sides, most
/// of it near the middle. Vectors of two (torus) or three components (sphere); two words are noise.
template <std::size_t n>
[[nodiscard]] std::array<double, n> raster_arc_offset(const std::array<double, n>& below,
                                                      const std::array<double, n>& above,
                                                      double reach) {
  double along = 0.0;
  for (std::size_t c = 0; c < n; ++c) along += below[c] * above[c];
  std::array<double, n> offset{};
  for (std::size_t c = 0; c < n; ++c) {
    offset[c] = reach * (below[c] - (along > 0.0 ? above[c] : 0.0));
  }
  return offset;
}
[[nodiscard]] inline double raster_scatter(std::uint32_t word) {
  const double u = 2.0 * word * 0x1.0p-32 - 1.0;
  return u * u * u;
}

/// Continents that meet: the larger one takes a share of what the smaller one has there, and that
/// is an orogeny of two continents where it stands above the sea.
inline void raster_fold(RasterCrust& smaller, RasterCrust& larger, double ratio,
                        std::int64_t step) {
  const float before = smaller.height, moved = static_cast<float>(ratio) * before;
  larger.add({moved, smaller.born, 0});
  smaller.height = before - moved;
  if (larger.height >= 1.0F) larger.folded = static_cast<std::uint16_t>(2 * step + 1);
}

/// Share of its speed that a plate keeps when it has folded so much crust: the loss is
/// `friction` `new_speed` folded / mass.
[[nodiscard]] inline double raster_speed_left(double speed, double folded, double mass,
                                              double friction, double new_speed) {
  if (!(mass > 0.0) || speed == 0.0) return 1.0;
  return std::max(0.0, 1.0 - friction * new_speed * folded / mass / speed);
}

/// When plates are done and all crust is divided anew.
class RasterCycle {
 public:
  struct Limits {
    double speed;     ///< mean speed that is too little
    double momentum;  ///< share of the peak of the sum of momenta that is too little
    int quiet;        ///< steps without continents meeting that are too many
    int steps;        ///< most
  };
  struct Motion {
    double speed = 0.0, momentum = 0.0;  ///< sums over plates
    int plates = 0;
  };
  /// Looks at the plates as they are before a step.
  [[nodiscard]] bool is_over(const Limits& limits, const Motion& now) {
    peak_momentum_ = std::max(peak_momentum_, now.momentum);
    return now.plates < 2 || now.speed < limits.speed * now.plates ||
           now.momentum < limits.momentum * peak_momentum_ || quiet_ > limits.quiet ||
           steps_ >= limits.steps;
  }
  /// The motion of all plates that live; `speed_of(plate)` in cells a step.
  template <class Plates, class Speed>
  [[nodiscard]] static Motion motion_of(const Plates& plates, Speed&& speed_of) {
    Motion motion;
    for (const auto& plate : plates) {
      if (!plate.alive) continue;
      const double speed = speed_of(plate);
      motion.speed += speed;
      motion.momentum += speed * plate.mass;
      ++motion.plates;
    }
    return motion;
  }
  void begin_step() { ++steps_; }
  void note(bool continents_met) { quiet_ = continents_met ? 0 : quiet_ + 1; }
  [[nodiscard]] int steps() const { return steps_; }

 private:
  double peak_momentum_ = 0.0;
  int steps_ = 0, quiet_ = 0;
};

/// What one plate has of its own; NaN where it follows the common settings.
struct RasterPlateSettings {
  double folding_ratio = std::numeric_limits<double>::quiet_NaN();
  double overlap_relative = std::numeric_limits<double>::quiet_NaN();
  double erosion_steps = std::numeric_limits<double>::quiet_NaN();
  double speed = std::numeric_limits<double>::quiet_NaN();  ///< over the common one
};

/// Settings of plates as height maps (Viitanen 2012, 7.3). Lengths in cells, of which
/// `world.columns` go once round the torus or the sphere's equator; times in steps, crust in
/// heights: 1 is sea level.
struct RasterSettings {
  RasterWorld world;
  int plates = 10;
  double sea_share = 0.65;         ///< of the first map
  double continents_across = 4.0;  ///< waves of the first map's noise along x
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
  double arc_cells = 10.0;         ///< from the trench to where magma rises
  double arc_scatter_cells = 3.0;
  double friction = 2.0;           ///< of folded crust over a plate's mass, in new plates' speed
  double spin = 0.0;               ///< fastest turn of a new plate, radians per step
  double curve = 0.0;              ///< fastest turn of a new plate's direction, radians per step
  double restart_speed = 0.2;      ///< mean speed, over that of new plates, that ends a cycle
  double restart_momentum = 0.15;  ///< sum of momenta over its peak that ends a cycle
  int restart_quiet = 10;          ///< steps without continents meeting that end a cycle
  std::vector<RasterPlateSettings> own;  ///< of plate 0, 1, ...; may be shorter

  /// A plate's own value, or the common one.
  [[nodiscard]] double of(int plate, double RasterPlateSettings::*value, double common) const {
    if (plate >= static_cast<int>(own.size()) || std::isnan(own[plate].*value)) return common;
    return own[plate].*value;
  }
  [[nodiscard]] RasterCycle::Limits limits() const {
    return {restart_speed * speed, restart_momentum, restart_quiet, cycle_steps};
  }
};

/// Budget of crust, sums of heights over cells since the start.
struct RasterBudget {
  double start = 0.0;      ///< crust of the first map
  double created = 0.0;    ///< new floor where plates part
  double subducted = 0.0;  ///< taken from subducting plates
  double melted = 0.0;     ///< of that, what came up again
  double folded = 0.0;     ///< moved from smaller to larger continents
  double merged = 0.0;     ///< moved with continents from plate to plate
  double resampled = 0.0;  ///< on a sphere: added when all crust is read at the lattice's places
  double rounded = 0.0;    ///< added where crust moves between cells, which hold single precision
  std::int64_t steps = 0;
  int cycles = 0, mergers = 0;

  /// What the crust should be now.
  [[nodiscard]] double balance() const {
    return start + created - subducted + melted + resampled + rounded;
  }
};

/// The world's map: one value for each cell.
struct RasterMap {
  std::vector<RasterCrust> crust;   ///< of all plates at a place together
  std::vector<std::int16_t> plate;  ///< the one on top
};

}  // namespace geo
