#pragma once

#include <string>
#include <vector>

#include "geo/core/state.hpp"

namespace geo::io {

/// One figure of a planet beside Earth's.
struct ScoreLine {
  std::string group;   ///< "hypsometry"
  std::string name;    ///< "land_mean"
  std::string words;   ///< "mean height of land"
  std::string unit;    ///< "m"; empty for pure numbers
  std::string source;  ///< key in docs/references.bib of Earth's value
  double value = 0.0, earth = 0.0, tolerance = 0.0;
  bool judged = false;  ///< the tolerance is our judgement

  /// |value - earth| <= tolerance.
  [[nodiscard]] bool within() const;
};

/// A planet's figures, in the order of the table `data/targets/earth_scorecard.csv`.
struct Scorecard {
  std::vector<ScoreLine> lines;
  /// Which figures are missing and why, one sentence per reason.
  std::vector<std::string> left_out;

  [[nodiscard]] int count_within() const;
};

/// Measures all figures that the fields of a whole planet allow. Those that depend on resolution
/// are taken at that of Earth's data: elevation at 0.2 degrees, crust at 1 degree, or at the
/// planet's own where it is coarser. Throws InputError when the grid is not the whole planet.
Scorecard score_planet(const State& state);

/// The fields that `score_planet` looks at.
std::vector<const FieldSpec*> scorecard_fields();

}  // namespace geo::io
