#include "geo/stages/erosion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "finish_relief.hpp"
#include "geo/kernels/depressions.hpp"
#include "geo/kernels/diffusion.hpp"
#include "geo/kernels/flow_graph.hpp"
#include "geo/kernels/multiple_flow.hpp"
#include "geo/kernels/smoothing.hpp"
#include "geo/kernels/stream_power.hpp"
#include "relief_events.hpp"

namespace geo {

std::vector<Parameter> ErosionParameters::declarations() {
  return {
      integer("erosion.steps", steps, "1", 0, 1'000'000,
              "number of steps; 0 leaves the relief as it is and reports the present incision",
              "design"),
      real("erosion.time_step_yr", time_step_yr, "yr", 1.0, 1e9, "length of a step", "braun2013"),
      integer("erosion.route_every", route_every, "1", 1, 1000,
              "steps between two routings of the water", "salles2023"),
      real("erosion.area_exponent", area_exponent, "1", 0.0, 3.0,
           "exponent m of drainage area in the stream-power law", "whipple1999"),
      real("erosion.slope_exponent", slope_exponent, "1", 0.1, 10.0,
           "exponent n of slope in the stream-power law", "whipple1999"),
      real("erosion.erodibility_yr", erodibility_yr, "yr-1", 0.0, 1.0,
           "erodibility K where no field gives it; in m^(1-2m) yr-1 for another m than 0.5",
           "harel2016"),
      real("erosion.diffusivity_m2_yr", diffusivity_m2_yr, "m2 yr-1", 0.0, 1e6,
           "hillslope diffusivity kappa", "salles2023"),
      choice("erosion.flow_routing", flow_routing, {"d8", "mfd"},
             "whether drainage area follows the steepest descent or spreads over all lower "
             "neighbours; the implicit solve takes the steepest one in both",
             "freeman1991"),
      real("erosion.flow_exponent", flow_exponent, "1", 0.0, 20.0,
           "exponent p of slope by which multiple flow is shared", "freeman1991"),
      choice("erosion.depressions", depressions, {"fill", "breach"},
             "whether water crosses depressions at their spill level or cuts their sills at once",
             "cordonnier2019"),
      real("erosion.uplift_mm_yr", uplift_mm_yr, "mm yr-1", -100.0, 100.0,
           "rock uplift of all land, on top of a field of uplift", "design"),
      choice("erosion.uplift_from", uplift_from, {"deformation", "boundaries", "none"},
             "where plates raise the ground: over the belts of deformation, on the cells of their "
             "boundaries, or nowhere",
             "tectonica2026"),
      real("erosion.convergent_uplift_mm_yr", convergent_uplift_mm_yr, "mm yr-1", -100.0, 100.0,
           "rock uplift where plates converge, at full strength", "tectonica2026"),
      real("erosion.divergent_uplift_mm_yr", divergent_uplift_mm_yr, "mm yr-1", -100.0, 100.0,
           "rock uplift where plates part", "tectonica2026"),
      real("erosion.transform_uplift_mm_yr", transform_uplift_mm_yr, "mm yr-1", -100.0, 100.0,
           "rock uplift where plates shear", "tectonica2026"),
      real("erosion.erodibility_factor", erodibility_factor, "1", 0.0, 1000.0,
           "factor of the erodibilities that a field gives", "harel2016"),
      real("erosion.reference_cell_km", reference_cell_km, "km", 0.01, 1000.0,
           "cell size at which the erodibilities hold", "design"),
      real("erosion.subgrid_exponent", subgrid_exponent, "1", 0.0, 2.0,
           "erodibility falls with the cell size to this power, for the relief that larger cells "
           "do not resolve",
           "hack1957"),
      real("erosion.rebound_fraction", rebound_fraction, "1", 0.0, 1.0,
           "share of the eroded thickness that the crust rises again, density of crust over mantle",
           "turcotte2002"),
      real("erosion.rebound_length_km", rebound_length_km, "km", 0.0, 2000.0,
           "length over which the plate's stiffness spreads the rebound", "watts2001"),
      real("erosion.rebound_time_yr", rebound_time_yr, "yr", 1.0, 1e9,
           "relaxation time of the mantle", "turcotte2002"),
      real("erosion.warping_m", warping_m, "m", 0.0, 5000.0,
           "standard deviation of the latest warping of the land, which rivers have not yet cut "
           "through",
           "turcotte2002"),
      real("erosion.warping_km", warping_km, "km", 1.0, 20000.0,
           "longest wavelength of the warping", "turcotte2002"),
      real("erosion.noise_injection_m", noise_injection_m, "m", 0.0, 1000.0,
           "noise added to the land after erosion", "tectonica2026"),
      real("erosion.relaxation_fraction", relaxation_fraction, "1", 0.0, 1.0,
           "share by which the land returns to its initial, isostatic elevation at the end",
           "tectonica2026"),
      real("erosion.land_smoothing_km", land_smoothing_km, "km", 0.0, 1000.0,
           "length over which the land is smoothed after that", "tectonica2026"),
      choice("erosion.hypsometry", hypsometry, {"none", "power-law", "rank"},
             "whether the relief keeps its own hypsometric curve, has its land bent to a median "
             "height, or takes over a given curve by rank",
             "tectonica2026"),
      real("erosion.hypsometry_median_m", hypsometry_median_m, "m", 1.0, 20000.0,
           "median height of land, with power-law", "cogley1984"),
      real("erosion.hypsometry_smoothing_km", hypsometry_smoothing_km, "km", 0.0, 1000.0,
           "length over which the bending is smoothed", "tectonica2026"),
      real("erosion.detail_noise", detail_noise, "1", 0.0, 100.0,
           "factor of the blueprint's terrain noise", "tectonica2026"),
  };
}

namespace {

/// Sum over rows of area * value(cell), the same for any number of threads.
template <class Value>
double area_sum(const Grid& grid, Value&& value) {
  std::vector<double> rows(grid.ny(), 0.0);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    double sum = 0.0;
    for (Index cell = grid.cell(0, j); cell < grid.cell(0, j) + grid.nx(); ++cell) {
      sum += value(cell);
    }
    rows[j] = sum * grid.area_m2(j);
  }
  double total = 0.0;
  for (const double row : rows) total += row;
  return total;
}

/// One run of the landscape.
class Landscape {
 public:
  Landscape(const ErosionParameters& parameters, const Grid& grid, std::span<float> elevation_m,
            std::span<const float> uplift_m_yr, std::span<const float> erodibility)
      : p_(parameters),
        grid_(grid),
        z_(elevation_m),
        uplift_m_yr_(uplift_m_yr),
        erodibility_(erodibility),
        initial_(elevation_m.begin(), elevation_m.end()),
        outlets_(find_outlets(grid, elevation_m)),
        lowered_(grid.size(), 0.0F) {}

  void route() {
    const bool spread = p_.flow_routing == "mfd";
    Routing routing;  // release the old one first: two would not fit the memory budget
    graph_ = {};
    routing = route_water(grid_, z_, outlets_, spread);
    graph_ = std::move(routing.graph);
    area_m2_.resize(grid_.size());
#pragma omp parallel for schedule(static)
    for (int j = 0; j < grid_.ny(); ++j) {
      std::fill_n(area_m2_.begin() + grid_.cell(0, j), grid_.nx(), grid_.area_m2(j));
    }
    if (spread) {
      accumulate_flow(grid_, routing.filled_m, graph_.receiver,
                      {FlowMethod::multiple, p_.flow_exponent}, area_m2_);
    } else {
      graph_.accumulate(area_m2_);
    }
    if (p_.depressions == "breach" && p_.steps > 0) {
      before_.assign(z_.begin(), z_.end());
      breach_sills(grid_, graph_, z_);
      book_lowering();
    }
  }

  void step() {
    raise();
    before_.assign(z_.begin(), z_.end());
    incise<float>(grid_, graph_, area_m2_, erodibility_, law(), z_);
    creep();
    // Near a pole a river would cut a valley as narrow as its cells are there.
    smooth_slivers(grid_, z_, outlets_);
    book_lowering();
    if (p_.rebound_fraction > 0.0) rebound();
  }

  /// Blueprint 4.6: part of the way back to the isostatic elevation.
  void relax() {
    if (p_.relaxation_fraction <= 0.0) return;
    before_.assign(z_.begin(), z_.end());
    const auto share = static_cast<float>(p_.relaxation_fraction);
    on_land([&](Index cell) { z_[cell] += share * (initial_[cell] - z_[cell]); });
    rebound_m3_ += volume_since_before();
  }

  /// Lets `reshape` change the relief at will, and finds land and sea again if it did.
  template <class Reshape>
  bool book_reshaping(Reshape&& reshape) {
    before_.assign(z_.begin(), z_.end());
    if (!reshape()) return false;
    reshaped_m3_ += volume_since_before();
    outlets_ = find_outlets(grid_, z_);
    return true;
  }

  void report(std::span<double> area_m2, std::span<Index> receiver, std::span<float> rate_m_yr,
              Budget& budget) const {
    std::copy(area_m2_.begin(), area_m2_.end(), area_m2.begin());
    std::copy(graph_.receiver.begin(), graph_.receiver.end(), receiver.begin());
    const double time_yr = p_.steps * p_.time_step_yr;
    if (p_.steps == 0) {
      incision_rate(grid_, graph_, area_m2_, erodibility_, law(), z_, rate_m_yr);
    } else {
#pragma omp parallel for schedule(static)
      for (Index cell = 0; cell < grid_.size(); ++cell) {
        rate_m_yr[cell] = static_cast<float>(lowered_[cell] / time_yr);
      }
    }
    const double stored =
        area_sum(grid_, [&](Index c) { return static_cast<double>(z_[c]) - initial_[c]; });
    const double scale =
        std::max({std::abs(uplifted_m3_), std::abs(eroded_m3_), std::abs(reshaped_m3_), 1.0});
    budget["rock_uplifted_m3"] = uplifted_m3_;
    budget["rock_rebound_m3"] = rebound_m3_;
    budget["rock_eroded_m3"] = eroded_m3_;
    budget["rock_reshaped_m3"] = reshaped_m3_;
    budget["rock_stored_m3"] = stored;
    budget["rock_exported_m3"] = eroded_m3_;
    budget["rock_closing_error"] =
        (uplifted_m3_ + rebound_m3_ + reshaped_m3_ - eroded_m3_ - stored) / scale;
    budget["time_yr"] = time_yr;
  }

 private:
  [[nodiscard]] StreamPower law() const {
    return {p_.area_exponent, p_.slope_exponent, p_.time_step_yr, 0.0};
  }
  template <class Change>
  void on_land(Change&& change) {
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      if (outlets_[cell] == 0) change(cell);
    }
  }
  [[nodiscard]] double volume_since_before() const {
    return area_sum(grid_, [&](Index c) { return static_cast<double>(z_[c]) - before_[c]; });
  }
  void raise() {
    before_.assign(z_.begin(), z_.end());
    const double dt = p_.time_step_yr, everywhere = 1e-3 * p_.uplift_mm_yr;
    on_land([&](Index cell) {
      const double field = uplift_m_yr_.empty() ? 0.0 : uplift_m_yr_[cell];
      // Subsidence ends at the sea: a step that drowned land would move the coast without a
      // routing.
      z_[cell] = std::max(0.0F, static_cast<float>(z_[cell] + (field + everywhere) * dt));
    });
    uplifted_m3_ += volume_since_before();
  }
  /// Hillslopes end at the shore: what moves down them does not see the depth of the sea.
  void creep() {
    if (p_.diffusivity_m2_yr <= 0.0) return;
    std::vector<float> surface(z_.size());
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) surface[cell] = std::max(z_[cell], 0.0F);
    diffuse(grid_, surface, p_.diffusivity_m2_yr, p_.time_step_yr,
            {.fixed = outlets_, .scheme = DiffusionScheme::positive});
    on_land([&](Index cell) { z_[cell] = surface[cell]; });
  }
  void book_lowering() {
    eroded_m3_ -= volume_since_before();
    on_land([&](Index cell) { lowered_[cell] += before_[cell] - z_[cell]; });
  }
  /// Airy rebound of the eroded load, spread by the plate and delayed by the mantle:
  /// the part 1 - exp(-dt / tau) of what is still owed comes back in each step.
  void rebound() {
    owed_m_.resize(grid_.size(), 0.0F);
    const auto share = static_cast<float>(p_.rebound_fraction);
    on_land([&](Index cell) { owed_m_[cell] += share * (before_[cell] - z_[cell]); });
    const double part = -std::expm1(-p_.time_step_yr / p_.rebound_time_yr);
    std::vector<float> response(owed_m_);
    if (p_.rebound_length_km > 0.0) {
      smooth_broadly(grid_, response, 1000.0 * p_.rebound_length_km);
    }
    before_.assign(z_.begin(), z_.end());
    on_land([&](Index cell) {
      z_[cell] = std::max(0.0F, z_[cell] + static_cast<float>(part * response[cell]));
      owed_m_[cell] -= static_cast<float>(part) * owed_m_[cell];
    });
    rebound_m3_ += volume_since_before();
  }

  const ErosionParameters& p_;
  const Grid& grid_;
  std::span<float> z_;
  std::span<const float> uplift_m_yr_;
  std::span<const float> erodibility_;
  std::vector<float> initial_;
  std::vector<std::uint8_t> outlets_;
  std::vector<float> lowered_, before_, owed_m_;
  FlowGraph graph_;
  std::vector<double> area_m2_;
  double uplifted_m3_ = 0.0, eroded_m3_ = 0.0, rebound_m3_ = 0.0, reshaped_m3_ = 0.0;
};

class ErosionStage final : public Stage {
 public:
  [[nodiscard]] const StageInfo& info() const override {
    static const StageInfo kInfo{"erosion",
                                 "rivers and hillslopes wear the land down",
                                 {&field::elevation},
                                 {&field::erodibility, &field::uplift_rate, &field::boundary_type,
                                  &field::boundary_strength, &field::convergent_deformation,
                                  &field::divergent_deformation, &field::transform_deformation},
                                 {&field::elevation, &field::uplift_rate, &field::erosion_rate,
                                  &field::drainage_area, &field::flow_receiver},
                                 /*own_grid=*/false,
                                 /*feels_events=*/true};
    return kInfo;
  }
  [[nodiscard]] std::vector<Parameter> parameters() override { return parameters_.declarations(); }

  void run(StageIo& io, Context& context) const override {
    const Grid& grid = io.grid();
    const std::span<float> elevation = io.write(field::elevation);
    const std::span<float> uplift = io.write(field::uplift_rate);
    add_tectonic_uplift(io, uplift);
    const std::vector<float> erodibility = resolved_erodibility(io);

    Landscape landscape(parameters_, grid, elevation, uplift, erodibility);
    const std::int64_t steps = parameters_.steps;
    ReliefEvents events(grid, context, steps, parameters_.time_step_yr);
    const auto strike = [&](std::int64_t step) {
      if (context.events.empty()) return false;
      return landscape.book_reshaping([&] { return events.strike(step, elevation); });
    };
    for (std::int64_t step = 0; step < steps; ++step) {
      const bool struck = strike(step);
      if (struck || step % parameters_.route_every == 0) landscape.route();
      landscape.step();
      context.advance(static_cast<double>(step + 1) / static_cast<double>(steps + 1));
    }
    const ReliefFinish finish(parameters_, grid, context);
    landscape.book_reshaping([&] { return finish.inject_noise(elevation); });
    landscape.book_reshaping([&] { return finish.warp(elevation); });
    landscape.relax();
    landscape.book_reshaping([&] { return finish.reshape(elevation); });
    strike(steps);
    landscape.route();
    landscape.report(io.write(field::drainage_area), io.write(field::flow_receiver),
                     io.write(field::erosion_rate), context.budget);
    add_uniform_uplift(elevation, uplift);
  }

 private:
  /// Rock uplift by plates (Tectonica blueprint 4.5).
  void add_tectonic_uplift(StageIo& io, std::span<float> uplift_m_yr) const {
    const auto convergent = static_cast<float>(1e-3 * parameters_.convergent_uplift_mm_yr);
    const auto divergent = static_cast<float>(1e-3 * parameters_.divergent_uplift_mm_yr);
    const auto transform = static_cast<float>(1e-3 * parameters_.transform_uplift_mm_yr);
    if (parameters_.uplift_from == "deformation") {
      const auto closing = io.read_optional(field::convergent_deformation);
      const auto opening = io.read_optional(field::divergent_deformation);
      const auto shear = io.read_optional(field::transform_deformation);
      if (closing.empty() || opening.empty() || shear.empty()) return;
#pragma omp parallel for schedule(static)
      for (std::size_t cell = 0; cell < uplift_m_yr.size(); ++cell) {
        uplift_m_yr[cell] +=
            convergent * closing[cell] + divergent * opening[cell] + transform * shear[cell];
      }
    } else if (parameters_.uplift_from == "boundaries") {
      const auto type = io.read_optional(field::boundary_type);
      const auto strength = io.read_optional(field::boundary_strength);
      if (type.empty() || strength.empty()) return;
      const std::array<float, 4> rate{0.0F, convergent, divergent, transform};
#pragma omp parallel for schedule(static)
      for (std::size_t cell = 0; cell < uplift_m_yr.size(); ++cell) {
        uplift_m_yr[cell] += rate[type[cell]] * strength[cell];
      }
    }
  }
  /// Erodibility for the cells of this grid. A cell's own hillslopes and brooks rise above its
  /// outlet by a height that grows with its size; a grid of larger cells lacks it, so its rivers
  /// must be steeper by as much for the mean height of the land to be the same.
  [[nodiscard]] std::vector<float> resolved_erodibility(StageIo& io) const {
    const Grid& grid = io.grid();
    const std::span<const float> given = io.read_optional(field::erodibility);
    const auto scale = static_cast<float>(parameters_.erodibility_factor);
    std::vector<float> resolved(grid.size());
#pragma omp parallel for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      const double cell_km = 1e-3 * std::sqrt(grid.area_m2(j));
      const auto factor = static_cast<float>(
          std::pow(cell_km / parameters_.reference_cell_km, -parameters_.subgrid_exponent));
      for (Index cell = grid.cell(0, j); cell < grid.cell(0, j) + grid.nx(); ++cell) {
        resolved[cell] = factor * (given.empty() ? static_cast<float>(parameters_.erodibility_yr)
                                                 : scale * given[cell]);
      }
    }
    return resolved;
  }
  /// What the file reports is the whole uplift of the land.
  void add_uniform_uplift(std::span<const float> elevation, std::span<float> uplift) const {
    const auto everywhere = static_cast<float>(1e-3 * parameters_.uplift_mm_yr);
    if (everywhere == 0.0F) return;
#pragma omp parallel for schedule(static)
    for (std::size_t cell = 0; cell < uplift.size(); ++cell) {
      if (elevation[cell] >= 0.0F) uplift[cell] += everywhere;
    }
  }
  ErosionParameters parameters_;
};

}  // namespace

std::unique_ptr<Stage> make_erosion_stage() { return std::make_unique<ErosionStage>(); }

}  // namespace geo
