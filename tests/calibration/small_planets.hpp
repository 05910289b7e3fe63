#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/objective.hpp"
#include "geo/io/config/config.hpp"
#include "geo/stages/stages.hpp"

namespace geo::calibration {

/// The configuration of a run, with everything small.
class SmallRun {
 public:
  explicit SmallRun(const std::string& assignment = "erosion.steps=4",
                    const std::string& another = "erosion.steps=4",
                    const std::vector<std::string>& more = {}) {
    for (auto declarations : {planet.parameters(), pipeline.parameters()}) {
      parameters.insert(parameters.end(), declarations.begin(), declarations.end());
    }
    set("erosion.steps=4");
    set(assignment);
    set(another);
    for (const std::string& further : more) set(further);
    settings.seeds = "1-2";
    settings.grid = "96x48";
  }
  void set(const std::string& assignment) { io::apply_assignment(assignment, parameters); }
  [[nodiscard]] Grid grid() const { return Grid::sphere(96, 48, planet.figure()); }
  [[nodiscard]] Target earth() const { return read_target("earth", planet, grid(), {}); }

  Planet planet;
  Pipeline pipeline = make_pipeline();
  std::vector<Parameter> parameters;
  Settings settings;
};

/// What planets of the present configuration themselves are, as rows of a table.
inline Target own_target(const SmallRun& run, const std::vector<std::int64_t>& seeds, int rows) {
  Target target;
  target.name = "twin";
  for (int k = 0; k < 99; ++k) target.share.push_back((k + 1) / 100.0);
  target.elevation_m.assign(target.share.size(), 0.0);
  target.deviation_m.assign(target.share.size(), run.settings.deviation_m);
  target.fine_bin_m.assign(kFineBins, 0.0);
  Problem problem(run.parameters, run.settings, target);
  Objective objective(problem, run.parameters, seeds, 2 * rows, rows);
  objective.evaluate(problem.present());
  for (std::size_t s = 0; s < seeds.size(); ++s) {
    for (std::size_t k = 0; k < target.share.size(); ++k) {
      target.elevation_m[k] += objective.statistics()[s][k] / double(seeds.size());
    }
    for (int k = 0; k < kFineBins; ++k) {
      target.fine_bin_m[k] += objective.fine_bins()[s][k] / double(seeds.size());
    }
  }
  return target;
}

}  // namespace geo::calibration
