#include "erosion_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "climate_of_land.hpp"
#include "finish_surface.hpp"
#include "geo/core/error.hpp"
#include "geo/core/release.hpp"
#include "geo/stages/erosion/finishing.hpp"
#include "geo/stages/erosion/ground.hpp"
#include "geo/stages/erosion/seas.hpp"
#include "geo/stages/erosion/wear_down.hpp"
#include "icy_climate.hpp"

namespace geo {
namespace {

/// Rock uplift by plates (Tectonica blueprint 4.5).
void add_tectonic_uplift(const ErosionParameters& p, const StageIo& io, double faster,
                         std::span<float> uplift_m_yr) {
  if (p.uplift_from == "deformation" || p.uplift_from == "shortening") {
    const auto closing = io.read_optional(field::convergent_deformation);
    const auto opening = io.read_optional(field::divergent_deformation);
    const auto shear = io.read_optional(field::transform_deformation);
    if (closing.empty() || opening.empty() || shear.empty()) return;
    add_belt_uplift<float>(p, {}, closing, opening, shear, faster, uplift_m_yr);
  } else if (p.uplift_from == "boundaries") {
    const auto type = io.read_optional(field::boundary_type);
    const auto strength = io.read_optional(field::boundary_strength);
    if (type.empty() || strength.empty()) return;
    add_boundary_uplift<float>(p, {}, type, strength, faster, uplift_m_yr);
  }
}

/// Crust that belts gain while the landscape runs; empty where they do not grow.
std::span<const float> thickening_of(const ErosionParameters& p, const StageIo& io) {
  if (!(growth_of_belts_myr<float>(p, {}) > 0.0)) return {};
  return io.read_optional(field::thickening_rate);
}

std::span<float> uplift_of(const ErosionParameters& p, StageIo& io, const Context& context,
                           std::span<const float> thickening_m_yr) {
  const std::span<float> uplift = io.write(field::uplift_rate);
  add_tectonic_uplift(p, io, speed_factor(p, context.configuration), uplift);
  if (!thickening_m_yr.empty()) {
    add_thickening_uplift<float>(p, {}, io.grid(), thickening_m_yr, uplift);
  }
  return uplift;
}

std::vector<float> erodibility_of(const ErosionParameters& p, const StageIo& io,
                                  std::span<const float> thickening_m_yr) {
  std::vector<float> erodibility =
      resolved_erodibility<float>(p, {}, io.grid(), io.read_optional(field::erodibility));
  if (!thickening_m_yr.empty()) break_rock<float>(p, {}, thickening_m_yr, erodibility);
  return erodibility;
}

std::span<float> unscoured(const ErosionParameters& p, StageIo& io) {
  if (!p.freezes()) return {};
  const std::span<float> scoured = io.write(field::glacial_erosion);
  std::fill(scoured.begin(), scoured.end(), 0.0F);
  return scoured;
}

/// The climates stand at even distances, the first at the beginning.
bool is_turn_of_climate(const ErosionParameters& p, std::int64_t step) {
  return step * p.climates / p.steps != (step - 1) * p.climates / p.steps || step == 0;
}

}  // namespace

const ErosionParameters& checked(const ErosionParameters& p) {
  if (p.flow_routing == "mfd" && !(p.flow_exponent > 0.0)) {
    throw ConfigurationError(fmt::format(
        "erosion.flow_exponent = {:g}: must be positive where erosion.flow_routing = \"mfd\"",
        p.flow_exponent));
  }
  return p;
}

ErosionRun::ErosionRun(const ErosionParameters& parameters, StageIo& io, Context& context)
    : p_(checked(parameters)),
      io_(io),
      context_(context),
      grid_(io.grid()),
      elevation_m_(io.write(field::elevation)),
      grows_(!thickening_of(p_, io).empty()),
      uplift_m_yr_(uplift_of(p_, io, context, thickening_of(p_, io))),
      erodibility_(erodibility_of(p_, io, thickening_of(p_, io))),
      landscape_(p_, {}, grid_, elevation_m_, uplift_m_yr_, thickening_of(p_, io), erodibility_,
                 find_outlets(grid_, elevation_m_)),
      events_(grid_, context, p_.steps, p_.time_step_yr),
      follows_rain_(p_.discharge == "rain" && has_climate(grid_, context)),
      scoured_m_(unscoured(p_, io)),
      sea_share_(share_of_sea(grid_, elevation_m_)) {
  if (p_.freezes() && follows_rain_) ice_.emplace(p_, grid_, context.planet);
  if (p_.deposits()) landscape_.begin_with(io.read_optional(field::sediment_thickness));
  // What rates and resistance were made from is needed no more.
  for (const FieldSpec* spec : std::initializer_list<const FieldSpec*>{
           &field::erodibility, &field::boundary_type, &field::boundary_strength,
           &field::convergent_deformation, &field::divergent_deformation,
           &field::transform_deformation}) {
    io.release(*spec);
  }
  if (!grows_) io.release(field::thickening_rate);
}

/// Changes elevation at will; land and sea are then told apart again.
template <class Change>
bool ErosionRun::reshape(Change&& change) {
  const bool did = landscape_.reshape(change);
  if (did) landscape_.set_outlets(find_outlets(grid_, elevation_m_));
  return did;
}

void ErosionRun::wear() {
  if (p_.steps == 0) return;
  reshape([&] { return join_seas(p_, grid_, elevation_m_); });
  landscape_.set_landlocked(landlocked_cells(p_, grid_, elevation_m_));
  wear_down(
      p_,
      {.route = [&](std::int64_t) -> const Drainage& { return route(); },
       .strike =
           [&](std::int64_t step) {
             const bool struck = strike(step);
             turn_climate(step);
             return struck;
           },
       .coast = [&](std::int64_t) { return move_coast(); },
       .ice = [&](std::int64_t step) { return ice_of(step); },
       .after =
           [&](std::int64_t step) {
             context_.advance(static_cast<double>(step + 1) / static_cast<double>(p_.steps + 1));
           },
       .done = {.area = [&] { release(drainage_.area_m2); },
                .flooded = [&] { release(drainage_.flooded); },
                .graph = [&] { drainage_.graph = {}; }}},
      landscape_);
  landscape_.dry_filled_seas();
  landscape_.set_outlets(find_outlets(grid_, elevation_m_));
  // Only steps read what lifts land and how rock resists.
  if (grows_) io_.release(field::thickening_rate);
  release(erodibility_);
  reshape([&] { return join_seas(p_, grid_, elevation_m_); });
}

const Drainage& ErosionRun::route() {
  drain(p_, grid_, elevation_m_, landscape_.outlets(), drainage_, climate_ ? &*climate_ : nullptr);
  return drainage_;
}

bool ErosionRun::strike(std::int64_t step) {
  if (context_.events.empty()) return false;
  return reshape([&] { return events_.strike(step, elevation_m_); });
}

/// Floor of the sea that belts have lifted out of it is land, and what it cuts off is landlocked.
bool ErosionRun::move_coast() {
  if (!grows_) return false;
  std::vector<std::uint8_t> outlets = find_outlets(grid_, elevation_m_);
  if (outlets == landscape_.outlets()) return false;
  landscape_.set_outlets(std::move(outlets));
  landscape_.set_landlocked(landlocked_cells(p_, grid_, elevation_m_));
  return true;
}

void ErosionRun::turn_climate(std::int64_t step) {
  if (!follows_rain_ || !is_turn_of_climate(p_, step)) return;
  climate_ = climate_of_land(grid_, elevation_m_, context_);
}

IceWork ErosionRun::ice_of(std::int64_t step) {
  if (!ice_) return {};
  const double before_today_yr = static_cast<double>(p_.steps - step - 1) * p_.time_step_yr;
  const double years_yr = ice_->years_of_step(before_today_yr);
  if (years_yr <= 0.0) return {};
  return [this, years_yr](std::span<float> bed_m, std::span<const float> before_m) {
    auto let_out_m3 = ice_->work(*climate_, years_yr, bed_m);
#pragma omp parallel for schedule(static)
    for (std::size_t c = 0; c < bed_m.size(); ++c) scoured_m_[c] += before_m[c] - bed_m[c];
    return let_out_m3;
  };
}

void ErosionRun::finish() {
  reshape([&] { return inject_noise<float>(p_, {}, grid_, context_.seed, elevation_m_); });
  reshape([&] { return warp<float>(p_, {}, grid_, context_.seed, elevation_m_); });
  landscape_.relax();
  reshape([&] { return SurfaceFinish(p_, grid_, context_).reshape(elevation_m_); });
  if (p_.steps > 0) {
    reshape([&] { return settle_seas(p_, grid_, elevation_m_, sea_share_); });
  }
  strike(p_.steps);
  climate_.reset();  // files have the area
  if (ice_) {
    ice_->settle_today(icy_climate(p_, grid_, elevation_m_, context_), elevation_m_);
    landscape_.sink(ice_->sunk_m());
  }
  cut_last_sills();
}

void ErosionRun::cut_last_sills() {
  if (!landscape_.breaches()) return;
  landscape_.breach(route());
  is_routed_ = true;
}

/// What a field is made from leaves memory with it: all of both would be the most that a run takes.
void ErosionRun::write() {
  report();
  LandscapeRecords<float> records = landscape_.take_records();
  if (grows_) write_rock_uplift(records.raised_m);
  write_crust(records.crust_change_m);
  if (p_.deposits()) write_sediment(records.sediment);
  if (p_.steps > 0) write_erosion_rate(records.lowered_m);
  drain_surface(/*iced=*/lay_ice());
  if (p_.deposits()) write_sediment_flux(records.sediment.released_m3_yr);
  write_drainage();
  if (!grows_) add_uniform_uplift();
}

/// The elevation that others see is the surface of the ice. Returns whether any lies.
bool ErosionRun::lay_ice() {
  if (!p_.freezes()) return false;
  if (!ice_) {
    io_.write(field::ice_thickness, std::vector<float>(elevation_m_.size()));
    return false;
  }
  ice_->report(context_.budget);
  std::vector<float> thickness_m = ice_->take_thickness_m();
#pragma omp parallel for schedule(static)
  for (std::size_t c = 0; c < elevation_m_.size(); ++c) elevation_m_[c] += thickness_m[c];
  io_.write(field::ice_thickness, std::move(thickness_m));
  return context_.budget["ice_m3"] != 0.0;
}

/// Water flows over the surface of the ice.
void ErosionRun::drain_surface(bool iced) {
  if (iced) {
    drain(p_, grid_, elevation_m_, find_outlets(grid_, elevation_m_), drainage_);
  } else if (!is_routed_) {
    route();
  }
}

/// Sediment goes down the rivers of the finished surface: what were valleys when it was taken may
/// be arms of the sea now, which it reaches once.
void ErosionRun::write_sediment_flux(std::vector<float>& carried_m3_yr) const {
  carried_m3_yr.resize(grid_.size(), 0.0F);
  walk_downstream(drainage_.graph, [&](Index cell) {
    carried_m3_yr[cell] = std::max(0.0F, carried_m3_yr[cell]);
    const Index to = drainage_.graph.receiver[cell];
    if (to != cell) carried_m3_yr[to] += carried_m3_yr[cell];
  });
  io_.write(field::sediment_flux, std::move(carried_m3_yr));
}

void ErosionRun::write_drainage() {
  if (p_.steps == 0) write_incision_rate();
  release(drainage_.graph.order);
  io_.write(field::flow_receiver, std::move(drainage_.graph.receiver));
  io_.write(field::drainage_area, std::move(drainage_.area_m2));
}

void ErosionRun::write_incision_rate() const {
  incision_rate(grid_, drainage_.graph, drainage_.area_m2, erodibility_, landscape_.law(),
                io_.read(field::elevation), io_.write(field::erosion_rate));
}

void ErosionRun::write_erosion_rate(std::vector<float>& lowered_m) const {
  const double time_yr = p_.steps * p_.time_step_yr;
#pragma omp parallel for schedule(static)
  for (float& value : lowered_m) value = static_cast<float>(value / time_yr);
  io_.write(field::erosion_rate, std::move(lowered_m));
}

void ErosionRun::write_crust(std::vector<double>& change_m) const {
  const std::span<float> values = io_.write(field::crust_thickness_change);
  std::copy(change_m.begin(), change_m.end(), values.begin());
  release(change_m);
}

void ErosionRun::write_sediment(SedimentRecord& sediment) const {
  const auto write = [&](std::vector<float>& values, const Field<float>& to) {
    values.resize(grid_.size(), 0.0F);
    io_.write(to, std::move(values));
  };
  const double per_yr = 1.0 / std::max(1.0, p_.steps * p_.time_step_yr);
#pragma omp parallel for schedule(static)
  for (float& value : sediment.laid_m) value = static_cast<float>(per_yr * value);
  write(sediment.thickness_m, field::sediment_thickness);
  write(sediment.laid_m, field::deposition_rate);
}

/// Where crust thickens, the file reports how fast rock came up, rebound included.
void ErosionRun::write_rock_uplift(const std::vector<float>& raised_m) const {
  const double time_yr = 1e6 * growth_of_belts_myr<float>(p_, {});
#pragma omp parallel for schedule(static)
  for (std::size_t cell = 0; cell < uplift_m_yr_.size(); ++cell) {
    uplift_m_yr_[cell] = static_cast<float>(raised_m[cell] / time_yr);
  }
}

/// What the file reports is the whole uplift of the land.
void ErosionRun::add_uniform_uplift() const {
  const auto everywhere = static_cast<float>(1e-3 * p_.uplift_mm_yr);
  if (everywhere == 0.0F) return;
#pragma omp parallel for schedule(static)
  for (std::size_t cell = 0; cell < uplift_m_yr_.size(); ++cell) {
    if (elevation_m_[cell] >= 0.0F) uplift_m_yr_[cell] += everywhere;
  }
}

void ErosionRun::report() const {
  Budget& budget = context_.budget;
  const RockVolumes<double>& rock = landscape_.rock();
  const double stored = landscape_.stored_m3();
  const double scale =
      std::max({std::abs(rock.uplifted), std::abs(rock.eroded), std::abs(rock.reshaped), 1.0});
  budget["rock_uplifted_m3"] = rock.uplifted;
  budget["rock_rebound_m3"] = rock.rebound;
  budget["rock_eroded_m3"] = rock.eroded + rock.laid_on_land;
  budget["rock_reshaped_m3"] = rock.reshaped;
  budget["rock_stored_m3"] = stored;
  budget["rock_rounded_m3"] = rock.rounded;
  if (growth_of_belts_myr<float>(p_, {}) > 0.0) {
    const double grown = area_sum<double>(
        landscape_.grid(), [&](Index c) { return landscape_.records().crust_change_m[c]; });
    budget["crust_shortened_m3"] = rock.shortened;
    budget["crust_stored_m3"] = grown;
    budget["crust_closing_error"] =
        (rock.shortened + rock.laid_at_sea - rock.eroded - grown) / scale;
  }
  budget["rock_closing_error"] = (rock.uplifted + rock.rebound + rock.reshaped + rock.laid_at_sea +
                                  rock.rounded - rock.eroded - stored) /
                                 scale;
  if (landscape_.deposits()) {
    const double unsettled = landscape_.unsettled_m3();
    budget["sediment_laid_on_land_m3"] = rock.laid_on_land;
    budget["sediment_laid_at_sea_m3"] = rock.laid_at_sea;
    budget["sediment_unsettled_m3"] = unsettled;
    budget["rock_exported_m3"] = rock.over_edges;
    budget["sediment_closing_error"] =
        (rock.eroded - rock.laid_at_sea - unsettled - rock.over_edges) / scale;
  } else {
    budget["rock_exported_m3"] = rock.eroded;
  }
  budget["time_yr"] = p_.steps * p_.time_step_yr;
}

}  // namespace geo
