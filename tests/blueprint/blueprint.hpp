#pragma once

// A small planet of the preset "tectonica", stage by stage. The tests of this folder compute the
// equations of the Tectonica blueprint in their own words from the fields that stages read and
// compare what stages wrote; numbers in brackets are the document's.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "geo/core/field.hpp"
#include "geo/core/state.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/config/presets.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/stages/stages.hpp"

namespace geo::test {

inline constexpr double kRadius_km = 6371.0;
inline constexpr double kRadians = std::numbers::pi / 180.0;

using Settings = std::vector<std::string>;  // of --set

/// The preset's planet after each of its stages.
struct BlueprintPlanet {
  std::map<std::string, State> after;
  std::map<std::string, Budget> budget;
  std::uint64_t seed = 1;

  template <class T>
  [[nodiscard]] std::span<const T> read(const std::string& stage, const Field<T>& field) const {
    return after.at(stage).read(field);
  }
  [[nodiscard]] const Grid& grid() const { return after.begin()->second.grid(); }
};

/// Runs stages `first` to `last` on a state.
inline BlueprintPlanet go_on(State state, const std::string& first, const std::string& last,
                             const Settings& settings = {}, std::vector<Event> events = {}) {
  Pipeline pipeline = make_pipeline();
  Context context;
  std::vector<Parameter> all = context.planet.parameters();
  for (const Parameter& parameter : pipeline.parameters()) all.push_back(parameter);
  io::apply_toml(io::find_preset("tectonica").toml, "tectonica", all);
  // Seasons, which the blueprint leaves open, are the only thing that this coarsens.
  io::apply_assignment("climate.resolution_deg=6", all);
  for (const std::string& setting : settings) io::apply_assignment(setting, all);
  context.events = std::move(events);
  BlueprintPlanet planet;
  planet.seed = context.seed;
  Pipeline::Observer observer;
  observer.after = [&](int position, const State& made, const Context& told) {
    const std::string name(pipeline.stages()[position]->info().name);
    planet.after.emplace(name, made);
    planet.budget.emplace(name, told.budget);
  };
  pipeline.run(state, context, pipeline.find(first), pipeline.find(last), observer);
  return planet;
}

inline State bare(int nx) { return State(std::make_shared<Grid>(Grid::sphere(nx, nx / 2))); }

/// The planet of seed 1, up to the biomes; made once a program.
inline const BlueprintPlanet& planet() {
  static const BlueprintPlanet kPlanet = go_on(bare(128), "plates", "biomes");
  return kPlanet;
}

inline double octave(const Noise& noise, const std::array<double, 3>& at, double frequency) {
  return noise.value(static_cast<float>(at[0] * frequency), static_cast<float>(at[1] * frequency),
                     static_cast<float>(at[2] * frequency));
}
inline std::array<double, 3> place(const Grid& grid, Index cell) {
  return grid.unit_vector(grid.column(cell), grid.row(cell));
}
inline double arc_km(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const double chord = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  return 2.0 * kRadius_km * std::asin(std::min(1.0, 0.5 * chord));
}
inline double share_of(const Grid& grid, auto&& chosen) {
  double sum = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (chosen(c)) sum += grid.area_m2(grid.row(c));
  }
  return sum / grid.total_area_m2();
}

}  // namespace geo::test
