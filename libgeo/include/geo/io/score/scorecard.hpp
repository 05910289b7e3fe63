#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
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

/// A scorecard that is measured in parts, so that not all fields need be in memory at a time. Those
/// figures that depend on resolution are taken at that of Earth's data: elevation at 0.2 degrees,
/// crust at 1 degree, or at the planet's own where it is coarser.
class ScoreInParts {
 public:
  enum class Part { crust, surface };
  /// The fields that a part looks at.
  [[nodiscard]] static std::vector<const FieldSpec*> fields(Part part);

  /// Measures all figures of a part that the fields of a whole planet allow. Throws InputError when
  /// the grid is not the whole planet.
  void measure(Part part, const State& state);
  /// Of the parts measured so far.
  [[nodiscard]] Scorecard card() const;

 private:
  std::map<std::string, double> figures_;
  std::set<std::string_view> present_;  ///< fields that were there
};

/// All parts of a planet in memory. Throws as `ScoreInParts::measure`.
Scorecard score_planet(const State& state);

/// The fields that `score_planet` looks at.
std::vector<const FieldSpec*> scorecard_fields();

}  // namespace geo::io
