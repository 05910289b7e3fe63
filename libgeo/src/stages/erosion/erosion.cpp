#include "geo/stages/erosion/erosion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "geo/kernels/water/flow_graph.hpp"
#include "geo/stages/erosion/finishing.hpp"
#include "geo/stages/erosion/ground.hpp"
#include "geo/stages/erosion/landscape.hpp"
#include "geo/stages/erosion/seas.hpp"
#include "ice_age.hpp"
#include "stages/relief/climate_of_land.hpp"
#include "stages/relief/finish_relief.hpp"
#include "stages/relief/relief_events.hpp"

namespace geo {

std::vector<Parameter> ErosionParameters::declarations() {
  return {
      integer("erosion.steps", steps, "1", 0, 1'000'000,
              "number of steps; 0 leaves elevation as it is and reports the present incision",
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
      choice(
          "erosion.model", model, {"detachment", "sediment"},
          "what becomes of what rivers take: it leaves the world, or they lay it down where they "
          "cannot carry it, on plains, in lakes and at sea",
          "davy2009"),
      choice("erosion.discharge", discharge, {"rain", "area"},
             "what makes rivers large: the runoff of the climate of the surface as it stands, or "
             "the area that they drain",
             "fekete2002"),
      real("erosion.reference_runoff_mm_yr", reference_runoff_mm_yr, "mm yr-1", 1.0, 10000.0,
           "runoff at which the erodibilities hold, with discharge = rain", "fekete2002"),
      real("erosion.least_runoff_mm_yr", least_runoff_mm_yr, "mm yr-1", 0.0, 10000.0,
           "runoff of the driest land, which flows in floods", "fekete2002"),
      integer("erosion.climates", climates, "1", 1, 1000,
              "times that the climate is computed again while elevation changes, with discharge = "
              "rain",
              "design"),
      choice("erosion.ice.model", ice_model, {"none", "plastic"},
             "whether ice forms where more snow falls than melts, as perfectly plastic ice, and "
             "works on its bed, with discharge = rain",
             "nye1951"),
      real("erosion.ice.stress_kpa", ice_stress_kpa, "kPa", 1.0, 1000.0,
           "stress at the base of the ice", "reeh1982"),
      real("erosion.ice.ice_melt_mm_k_d", ice_melt_mm_k_d, "mm K-1 day-1", 0.1, 100.0,
           "melt of ice per degree-day above freezing, as water", "braithwaite1995"),
      real("erosion.ice.snow_melt_mm_k_d", snow_melt_mm_k_d, "mm K-1 day-1", 0.1, 100.0,
           "melt of snow per degree-day above freezing, as water", "braithwaite1995"),
      real("erosion.ice.glacial_time_yr", glacial_time_yr, "yr", 0.0, 1e9,
           "last part of the run in which cold and warm times take turns and ice works on its bed",
           "lisiecki2005"),
      real("erosion.ice.glacial_share", glacial_share, "1", 0.0, 1.0,
           "share of the cold times in that", "lisiecki2005"),
      real("erosion.ice.glacial_cooling_k", glacial_cooling_k, "K", 0.0, 100.0,
           "by how much the mean of the planet is colder in the cold times than today",
           "tierney2020"),
      integer("erosion.ice.glacial_cycles", glacial_cycles, "1", 1, 100,
              "times in all that cold and warm ice are computed again", "design"),
      real("erosion.ice.abrasion", abrasion, "1", 0.0, 1.0,
           "lowering of the bed over the way that ice has moved on it", "humphrey1994"),
      real("erosion.ice.overdeepening", overdeepening, "1", 0.0, 100.0,
           "steepest climb of a bed over the slope of the ice above", "alley2003"),
      real("erosion.ice.till_share", till_share, "1", 0.0, 1.0,
           "share of the debris that stays on land where the ice around it melts", "design"),
      real("erosion.ice.grounding_m", grounding_m, "m", 0.0, 5000.0,
           "depth of today's sea in which ice stands in the cold times", "design"),
      real("erosion.strait_sill_m", strait_sill_m, "m", 0.0, 10000.0,
           "highest land over which high stands of the sea join a sea to the ocean of a whole "
           "planet "
           "and cut a strait; 0: seas stay as they are",
           "haq1987"),
      real("erosion.strait_land_km", strait_land_km, "km", 0.0, 1e5,
           "longest way of a strait over land", "design"),
      real("erosion.strait_depth_m", strait_depth_m, "m", 0.01, 5000.0, "depth of straits",
           "garciacastellanos2009"),
      real("erosion.strait_width_km", strait_width_km, "km", 0.1, 5000.0,
           "width of straits, at least a cell", "design"),
      real("erosion.strait_sea_km2", strait_sea_km2, "km2", 0.0, 1e9,
           "area of the smallest sea that is joined to the ocean", "design"),
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
      choice("erosion.uplift_from", uplift_from,
             {"shortening", "deformation", "boundaries", "none"},
             "what raises the ground: crust that convergence thickens, at the pace of the plates; "
             "given rates over the belts of deformation, or on the cells of boundaries; or nothing",
             "tectonica2026"),
      real("erosion.convergent_uplift_mm_yr", convergent_uplift_mm_yr, "mm yr-1", -100.0, 100.0,
           "rock uplift where plates converge, at full strength", "tectonica2026"),
      real("erosion.divergent_uplift_mm_yr", divergent_uplift_mm_yr, "mm yr-1", -100.0, 100.0,
           "rock uplift where plates part", "tectonica2026"),
      real("erosion.transform_uplift_mm_yr", transform_uplift_mm_yr, "mm yr-1", -100.0, 100.0,
           "rock uplift where plates shear", "tectonica2026"),
      real("erosion.uplift_speed_cm_yr", uplift_speed_cm_yr, "cm yr-1", 0.0, 50.0,
           "speed of plates (plates.speed_cm_yr) at which these rates hold, in proportion to which "
           "they grow; 0: the same at any speed",
           "tectonica2026"),
      real("erosion.damage", damage, "1", 0.0, 1000.0,
           "by how many times more rock is erodible where shortening doubles its thickness",
           "molnar2007"),
      real("erosion.erodibility_factor", erodibility_factor, "1", 0.0, 1000.0,
           "factor of the erodibilities that a field gives", "harel2016"),
      real("erosion.reference_cell_km", reference_cell_km, "km", 0.01, 1000.0,
           "cell size at which the erodibilities hold", "design"),
      real("erosion.subgrid_exponent", subgrid_exponent, "1", 0.0, 2.0,
           "erodibility falls with the cell size to this power, for the local relief that larger "
           "cells do not resolve",
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
      choice("erosion.hypsometry", hypsometry, {"none", "power-law", "blueprint", "rank"},
             "whether the surface keeps its own hypsometric curve, has its land bent to a median "
             "height, is bent once by the blueprint's 4.7 to 4.9, or takes over a given curve by "
             "quantile mapping",
             "tectonica2026"),
      real("erosion.hypsometry_median_m", hypsometry_median_m, "m", 1.0, 20000.0,
           "median height of land, with power-law and blueprint", "cogley1984"),
      real("erosion.hypsometry_smoothing_km", hypsometry_smoothing_km, "km", 0.0, 1000.0,
           "length over which the bending is smoothed", "tectonica2026"),
      real("erosion.detail_noise", detail_noise, "1", 0.0, 100.0,
           "factor of the blueprint's terrain noise", "tectonica2026"),
      real("erosion.sediment.deposition", deposition, "1", 0.0, 1000.0,
           "deposition G: what rivers lay down, over the mean loss of the land upstream",
           "guerit2019"),
      real("erosion.sediment.dispersal_km", dispersal_km, "km", 0.0, 5000.0,
           "length over which the sea spreads what rivers bring", "design"),
      real("erosion.sediment.wave_base_m", wave_base_m, "m", 0.0, 1000.0,
           "depth down to which waves let no sediment lie, at the lowest stands of the sea",
           "design"),
      real("erosion.sediment.highstand_yr", highstand_yr, "yr", 0.0, 1e9,
           "time for which the sea has stood where it does and rivers have built deltas",
           "stanley1994"),
  };
}

namespace {

void report(const ErosionParameters& p, const Landscape<float>& landscape, Budget& budget) {
  const RockVolumes<double>& rock = landscape.rock();
  const double stored = landscape.stored_m3();
  const double scale =
      std::max({std::abs(rock.uplifted), std::abs(rock.eroded), std::abs(rock.reshaped), 1.0});
  budget["rock_uplifted_m3"] = rock.uplifted;
  budget["rock_rebound_m3"] = rock.rebound;
  budget["rock_eroded_m3"] = rock.eroded + rock.laid_on_land;
  budget["rock_reshaped_m3"] = rock.reshaped;
  budget["rock_stored_m3"] = stored;
  if (growth_of_belts_myr<float>(p, {}) > 0.0) {
    const double grown =
        area_sum<double>(landscape.grid(), [&](Index c) { return landscape.crust_change_m()[c]; });
    budget["crust_shortened_m3"] = rock.shortened;
    budget["crust_stored_m3"] = grown;
    budget["crust_closing_error"] =
        (rock.shortened + rock.laid_at_sea - rock.eroded - grown) / scale;
  }
  budget["rock_closing_error"] =
      (rock.uplifted + rock.rebound + rock.reshaped + rock.laid_at_sea - rock.eroded - stored) /
      scale;
  if (landscape.deposits()) {
    const double unsettled = landscape.unsettled_m3();
    budget["sediment_laid_on_land_m3"] = rock.laid_on_land;
    budget["sediment_laid_at_sea_m3"] = rock.laid_at_sea;
    budget["sediment_unsettled_m3"] = unsettled;
    budget["rock_exported_m3"] = rock.over_edges;
    budget["sediment_closing_error"] =
        (rock.eroded - rock.laid_at_sea - unsettled - rock.over_edges) / scale;
  } else {
    budget["rock_exported_m3"] = rock.eroded;
  }
  budget["time_yr"] = p.steps * p.time_step_yr;
}

class ErosionStage final : public Stage {
 public:
  [[nodiscard]] const StageInfo& info() const override {
    static const std::array<StageInfo, 4> kInfo = [] {
      std::array<StageInfo, 4> info;
      for (int kind = 0; kind < 4; ++kind) {
        info[kind] = described(/*deposits=*/kind % 2 != 0, /*freezes=*/kind / 2 != 0);
      }
      return info;
    }();
    return kInfo[(parameters_.deposits() ? 1 : 0) + (parameters_.freezes() ? 2 : 0)];
  }
  [[nodiscard]] std::vector<Parameter> parameters() override { return parameters_.declarations(); }
  [[nodiscard]] StageCost cost(std::span<const Parameter> configuration) const override {
    constexpr double kStep_ns = 259.0, kIce_ns = 2000.0;  // cold and warm times, and today
    const auto steps = static_cast<double>(parameters_.steps);
    const bool follows_rain = parameters_.discharge == "rain" && parameters_.steps > 0;
    const double climates =
        follows_rain ? std::min(static_cast<double>(parameters_.climates), steps) : 0.0;
    const double ice_ns = follows_rain && parameters_.freezes() ? kIce_ns : 0.0;
    return {.per_cell_ns = kStep_ns * steps + ice_ns,
            .fixed_s = climates * climate_of_land_seconds(configuration),
            .cell_bytes = 170.0};
  }

  void run(StageIo& io, Context& context) const override {
    const Grid& grid = io.grid();
    const std::span<float> elevation = io.write(field::elevation);
    const std::span<float> uplift = io.write(field::uplift_rate);
    add_tectonic_uplift(io, speed_factor(parameters_, context.configuration), uplift);
    std::vector<float> erodibility =
        resolved_erodibility<float>(parameters_, {}, grid, io.read_optional(field::erodibility));
    const std::span<const float> thickening = growth_of_belts_myr<float>(parameters_, {}) > 0.0
                                                  ? io.read_optional(field::thickening_rate)
                                                  : std::span<const float>{};
    if (!thickening.empty()) {
      add_thickening_uplift<float>(parameters_, {}, grid, thickening, uplift);
      break_rock<float>(parameters_, {}, thickening, erodibility);
    }

    Landscape<float> landscape(parameters_, {}, grid, elevation, uplift, thickening, erodibility,
                               find_outlets(grid, elevation));
    Drainage drainage;
    std::optional<LandClimate> climate;
    const auto route = [&] {
      drain(parameters_, grid, elevation, landscape.outlets(), drainage,
            climate ? &*climate : nullptr);
      landscape.breach(drainage);
    };
    const auto reshape = [&](auto&& change) {
      const bool did = landscape.book_reshaping(change);
      if (did) landscape.set_outlets(find_outlets(grid, elevation));
      return did;
    };
    const std::int64_t steps = parameters_.steps;
    const double sea_share = share_of_sea(grid, elevation);
    if (steps > 0) {
      reshape([&] { return join_seas(parameters_, grid, elevation); });
      landscape.set_landlocked(landlocked_cells(parameters_, grid, elevation));
    }
    ReliefEvents events(grid, context, steps, parameters_.time_step_yr);
    const auto strike = [&](std::int64_t step) {
      if (context.events.empty()) return false;
      return reshape([&] { return events.strike(step, elevation); });
    };
    const bool follows_rain = parameters_.discharge == "rain" && has_climate(grid, context);
    std::optional<IceAge> ice;
    if (parameters_.freezes() && follows_rain) {
      ice.emplace(parameters_, grid, context.planet);
    }
    const std::span<float> scoured =
        parameters_.freezes() ? io.write(field::glacial_erosion) : std::span<float>{};
    std::fill(scoured.begin(), scoured.end(), 0.0F);
    bool coast_moved = false;
    for (std::int64_t step = 0; step < steps; ++step) {
      const bool struck = strike(step) || std::exchange(coast_moved, false);
      if (follows_rain && is_turn_of_climate(step)) {
        climate = climate_of_land(grid, elevation, context);
      }
      if (struck || step % parameters_.route_every == 0) route();
      const double ice_yr =
          ice ? ice->years_of_step(static_cast<double>(steps - step - 1) * parameters_.time_step_yr)
              : 0.0;
      IceWork ice_work;
      if (ice_yr > 0.0) {
        ice_work = [&](std::span<float> relief) {
          std::vector<float> before(relief.begin(), relief.end());
          std::vector<double> let_out = ice->work(*climate, ice_yr, relief);
#pragma omp parallel for schedule(static)
          for (std::size_t c = 0; c < relief.size(); ++c) scoured[c] += before[c] - relief[c];
          return let_out;
        };
        coast_moved = true;
      }
      landscape.step(drainage, /*builds_deltas=*/step + 1 == steps, ice_work);
      context.advance(static_cast<double>(step + 1) / static_cast<double>(steps + 1));
    }
    if (steps > 0) {
      landscape.dry_filled_seas();
      landscape.set_outlets(find_outlets(grid, elevation));
      reshape([&] { return join_seas(parameters_, grid, elevation); });
    }
    if (!thickening.empty()) write_rock_uplift(landscape, uplift);
    reshape([&] { return inject_noise<float>(parameters_, {}, grid, context.seed, elevation); });
    reshape([&] { return warp<float>(parameters_, {}, grid, context.seed, elevation); });
    landscape.relax();
    reshape([&] { return ReliefFinish(parameters_, grid, context).reshape(elevation); });
    if (steps > 0) {
      reshape([&] { return keep_sea_share(parameters_, grid, elevation, sea_share); });
    }
    strike(steps);
    if (ice) ice->settle_today(*climate, elevation);
    climate.reset();  // files have the area
    if (ice) landscape.sink(ice->sunk_m());
    route();
    write_rates(io, landscape, drainage, erodibility);
    if (parameters_.deposits()) write_sediment(io, landscape.sediment());
    write_crust(io, landscape);
    report(parameters_, landscape, context.budget);
    if (parameters_.freezes()) lay_ice(io, ice ? &*ice : nullptr, context.budget);
    if (thickening.empty()) add_uniform_uplift(elevation, uplift);
  }

 private:
  /// The climates stand at even distances, the first at the beginning.
  [[nodiscard]] bool is_turn_of_climate(std::int64_t step) const {
    const std::int64_t climates = parameters_.climates, steps = parameters_.steps;
    return step * climates / steps != (step - 1) * climates / steps || step == 0;
  }
  static StageInfo described(bool deposits, bool freezes) {
    StageInfo info{
        "erosion",
        "rivers and hillslopes wear the land down",
        {&field::elevation},
        {&field::erodibility, &field::thickening_rate, &field::uplift_rate, &field::boundary_type,
         &field::boundary_strength, &field::convergent_deformation, &field::divergent_deformation,
         &field::transform_deformation},
        {&field::elevation, &field::uplift_rate, &field::erosion_rate, &field::drainage_area,
         &field::flow_receiver, &field::crust_thickness_change},
        /*own_grid=*/false,
        /*feels_events=*/true};
    const auto also = [&](std::initializer_list<const FieldSpec*> fields) {
      info.writes.insert(info.writes.end(), fields);
    };
    if (deposits) {
      also({&field::sediment_thickness, &field::deposition_rate, &field::sediment_flux});
    }
    if (freezes) also({&field::ice_thickness, &field::glacial_erosion});
    return info;
  }
  void write_rates(StageIo& io, const Landscape<float>& landscape, const Drainage& drainage,
                   std::span<const float> erodibility) const {
    const Grid& grid = io.grid();
    std::copy(drainage.area_m2.begin(), drainage.area_m2.end(),
              io.write(field::drainage_area).begin());
    std::copy(drainage.graph.receiver.begin(), drainage.graph.receiver.end(),
              io.write(field::flow_receiver).begin());
    const std::span<float> rate_m_yr = io.write(field::erosion_rate);
    if (parameters_.steps == 0) {
      return incision_rate(grid, drainage.graph, drainage.area_m2, erodibility, landscape.law(),
                           io.read(field::elevation), rate_m_yr);
    }
    const double time_yr = parameters_.steps * parameters_.time_step_yr;
    const std::span<const float> lowered_m = landscape.lowered_m();
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid.size(); ++cell) {
      rate_m_yr[cell] = static_cast<float>(lowered_m[cell] / time_yr);
    }
  }
  void write_crust(StageIo& io, const Landscape<float>& landscape) const {
    const std::span<float> change_m = io.write(field::crust_thickness_change);
#pragma omp parallel for schedule(static)
    for (std::size_t cell = 0; cell < change_m.size(); ++cell) {
      change_m[cell] = static_cast<float>(landscape.crust_change_m()[cell]);
    }
  }
  /// The relief that others see is the surface of the ice, and water flows over that.
  void lay_ice(StageIo& io, const IceAge* ice, Budget& budget) const {
    const Grid& grid = io.grid();
    const std::span<float> elevation = io.write(field::elevation);
    const std::span<float> thickness = io.write(field::ice_thickness);
    if (ice == nullptr) return std::fill(thickness.begin(), thickness.end(), 0.0F);
    std::copy(ice->thickness_m().begin(), ice->thickness_m().end(), thickness.begin());
#pragma omp parallel for schedule(static)
    for (std::size_t c = 0; c < elevation.size(); ++c) elevation[c] += thickness[c];
    ice->report(budget);
    if (budget["ice_m3"] == 0.0) return;
    Drainage drainage;
    drain(parameters_, grid, elevation, find_outlets(grid, elevation), drainage);
    std::copy(drainage.area_m2.begin(), drainage.area_m2.end(),
              io.write(field::drainage_area).begin());
    std::copy(drainage.graph.receiver.begin(), drainage.graph.receiver.end(),
              io.write(field::flow_receiver).begin());
  }
  void write_sediment(StageIo& io, const SedimentRecord& sediment) const {
    const auto copy = [&](const std::vector<float>& from, const Field<float>& to, double factor) {
      const std::span<float> values = io.write(to);
      if (from.empty()) return std::fill(values.begin(), values.end(), 0.0F);
#pragma omp parallel for schedule(static)
      for (std::size_t cell = 0; cell < values.size(); ++cell) {
        values[cell] = static_cast<float>(factor * from[cell]);
      }
    };
    const double time_yr = std::max(1.0, parameters_.steps * parameters_.time_step_yr);
    copy(sediment.thickness_m, field::sediment_thickness, 1.0);
    copy(sediment.laid_m, field::deposition_rate, 1.0 / time_yr);
    copy(sediment.carried_m3_yr, field::sediment_flux, 1.0);
  }
  /// Rock uplift by plates (Tectonica blueprint 4.5).
  void add_tectonic_uplift(StageIo& io, double faster, std::span<float> uplift_m_yr) const {
    if (parameters_.uplift_from == "deformation" || parameters_.uplift_from == "shortening") {
      const auto closing = io.read_optional(field::convergent_deformation);
      const auto opening = io.read_optional(field::divergent_deformation);
      const auto shear = io.read_optional(field::transform_deformation);
      if (closing.empty() || opening.empty() || shear.empty()) return;
      add_belt_uplift<float>(parameters_, {}, closing, opening, shear, faster, uplift_m_yr);
    } else if (parameters_.uplift_from == "boundaries") {
      const auto type = io.read_optional(field::boundary_type);
      const auto strength = io.read_optional(field::boundary_strength);
      if (type.empty() || strength.empty()) return;
      add_boundary_uplift<float>(parameters_, {}, type, strength, faster, uplift_m_yr);
    }
  }
  /// Where crust thickens, the file reports how fast rock came up, rebound included.
  void write_rock_uplift(const Landscape<float>& landscape, std::span<float> uplift) const {
    const double time_yr = 1e6 * growth_of_belts_myr<float>(parameters_, {});
#pragma omp parallel for schedule(static)
    for (std::size_t cell = 0; cell < uplift.size(); ++cell) {
      uplift[cell] = static_cast<float>(landscape.raised_m()[cell] / time_yr);
    }
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
