#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/plates/raster/raster_rules.hpp"

namespace geo {

/// Throws ConfigurationError on more steps than cells can count.
inline void check_steps(const RasterSettings& settings) {
  constexpr std::int64_t kMostSteps = 32'000;
  if (std::int64_t{settings.cycles} * settings.cycle_steps <= kMostSteps) return;
  throw ConfigurationError("raster plates: " + std::to_string(settings.cycles) + " cycles of " +
                           std::to_string(settings.cycle_steps) +
                           " steps; at most 32000 steps in all");
}

/// All crust of a world at the end of a cycle, from which new plates are cut. `added` gains what
/// that has more than the plates had, whose heights sum to `mass`.
[[nodiscard]] inline std::vector<RasterCrust> gathered(RasterMap map, double mass, double& added) {
  double all = 0.0;
  for (const RasterCrust& cell : map.crust) all += cell.height;
  added += all - mass;
  return std::move(map.crust);
}

/// Erodes a plate whenever its time has come, and draws its map in to its crust now and then.
/// Returns what rounding to single precision added to its crust.
template <class Plate>
double tend(Plate& plate, int number, const RasterSettings& settings, std::int64_t step) {
  constexpr int kTighten = 32;
  const auto period = static_cast<std::int64_t>(
      settings.of(number, &RasterPlateSettings::erosion_steps, settings.erosion_steps));
  const double rounded = period > 0 && step % period == 0 ? plate.erode(settings.erosion) : 0.0;
  if (step % kTighten == 0) plate.tighten();
  return rounded;
}

/// Share of all steps that are over, if no cycle ends early.
[[nodiscard]] inline double share_of_steps(const RasterSettings& settings, int cycles_begun,
                                           const RasterCycle& cycle) {
  const double steps = static_cast<double>(cycle.steps()) / std::max(1, settings.cycle_steps);
  return std::min(1.0, (cycles_begun - 1 + steps) / settings.cycles);
}

}  // namespace geo
