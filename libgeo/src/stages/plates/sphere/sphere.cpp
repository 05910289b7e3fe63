#include "sphere.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "geo/core/error.hpp"
#include "geo/kernels/plates/plate_reconstruction.hpp"
#include "sphere_checkpoint.hpp"
#include "sphere_drift.hpp"
#include "sphere_history.hpp"
#include "sphere_initial_conditions.hpp"
#include "sphere_landscape.hpp"
#include "sphere_mass_balance.hpp"
#include "sphere_on_grid.hpp"
#include "sphere_reconstruction.hpp"
#include "sphere_timeline.hpp"

namespace geo {
namespace {

SphereSettings settings_of(const PlatesParameters& p, double radius_km, const Context& context) {
  SphereSettings settings = p.sphere;
  settings.radius_km = radius_km;
  settings.driftworld_uplift = p.uplift_profile == "driftworld";
  settings.rank_by_score = p.overlap == "score";
  settings.merge_plates = p.collisions == "plates";
  settings.add_uplifts = p.uplift_sources == "all";
  settings.fill_abyss = p.accretion == "abyss";
  settings.rift_largest = p.rifting == "largest";
  settings.by_rivers = p.erosion == "rivers" || p.landscape == "full";
  settings.wears_land_alone = p.erosion == "land";
  settings.force.gravity_m_s2 = context.planet.gravity_m_s2;
  settings.floor_by_age = p.ocean_floor == "age";
  if (p.sea_level == "ocean" && p.landscape == "none")
    settings.ocean_share = context.planet.ocean_fraction;
  settings.freeboard_ocean_share = context.planet.ocean_fraction;
  settings.no_net_rotation = p.no_net_rotation;
  settings.hold_motions = p.given_motions == "held";
  if (context.reconstruction) let_rotations_lead(settings);
  settings.mean_area_km2 =
      4.0 * std::acos(-1.0) * radius_km * radius_km / static_cast<double>(first_plates(p, context));
  return settings;
}

constexpr double kDegrees = 57.29577951308232;

std::string_view word_for(SphereEvent::Kind kind) {
  switch (kind) {
    case SphereEvent::Kind::collision:
      return "continental-collision";
    case SphereEvent::Kind::rift:
      return "plate-rifting";
    case SphereEvent::Kind::subduction_initiation:
      return "subduction-initiation";
    case SphereEvent::Kind::back_arc:
      return "back-arc-opening";
    case SphereEvent::Kind::indentation:
      return "continental-indentation";
    case SphereEvent::Kind::ridge_jump:
      return "ridge-jump";
  }
  return "";
}

/// What happened of itself and is large enough to be told, after the events that were asked for.
void tell(const SphereTectonics& model, const Grid& grid, Context& context) {
  constexpr double kTold_km2 = 2e5;
  auto number = static_cast<int>(context.events.size());
  for (const SphereEvent& event : model.events) {
    const bool is_jump = event.kind == SphereEvent::Kind::ridge_jump;  // of narrow strips
    if (event.area_km2 < kTold_km2 && !is_jump) continue;
    const Vector3 at = grid.to_axis(event.place);
    context.event_records.push_back(
        {.number = ++number,
         .kind = std::string(word_for(event.kind)),
         .name = "",
         .figures = {{"time_myr", event.time_myr},
                     {"latitude_deg", std::asin(std::clamp(at[2], -1.0, 1.0)) * kDegrees},
                     {"longitude_deg", std::atan2(at[1], at[0]) * kDegrees},
                     {"area_km2", event.area_km2}}});
  }
}

/// Resamples all crust to be seen. Plates that have come apart show one number still: their pieces
/// are plates once the drift itself resamples the crust, and ridges jump then.
void finish_to_be_seen(SphereTectonics& model) {
  const std::size_t lives = model.state.lives.size();
  const double jump_km = model.settings.ridge_jump_km;
  model.settings.ridge_jump_km = 0.0;
  finish(model);
  model.settings.ridge_jump_km = jump_km;
  for (SpherePlate& plate : model.state.plates) {
    while (plate.id >= static_cast<std::int64_t>(lives)) {
      plate.id = model.state.lives[plate.id].parent;
    }
  }
  model.state.lives.resize(lives);
}

/// Hands out a frame: the crust as a resampling would show it, and the state as it is.
void show(const PlatesParameters& parameters, SphereDrift& drift, const StageInfo& info,
          const Grid& grid, DriftLandscape* landscape, const Context& context) {
  SphereTectonics seen = drift.crust();
  finish_to_be_seen(seen);
  keep_water(seen);
  Frame frame{State(std::make_shared<const Grid>(grid)), checkpoint_of(drift.crust().state)};
  if (drift.leader() != nullptr) add_leader(drift.leader()->state, frame.checkpoint);
  StageInfo shown = info;
  if (landscape != nullptr) {
    const auto more = DriftLandscape::fields();
    shown.writes.insert(shown.writes.end(), more.begin(), more.end());
  }
  StageIo io(frame.fields, shown);
  SphereOnGrid(parameters, seen, io, context).draw(io);
  if (landscape != nullptr) landscape->draw(drift.crust(), seen, io);
  context.on_frame(std::move(frame));
}

}  // namespace

void drift(const PlatesParameters& parameters, const StageInfo& info, StageIo& io,
           Context& context) {
  if (io.grid().topology() != Topology::sphere) {
    throw InputError("plates: the grid must be a whole sphere");
  }
  context.advance(0.0);
  const SphereSettings settings =
      settings_of(parameters, 1e-3 * io.grid().figure().radius_m, context);
  SphereDrift drift(parameters, settings, io, context);
  SphereTectonics& model = drift.crust();
  if (context.reconstruction) drive_plates(*context.reconstruction, model, context);
  SphereMassBalance balance;
  SphereHistory history(io.grid());
  context.steps.columns = step_columns();
  const double first_myr = std::min(0.0, model.state.time_myr);
  const auto progress = [&](double time_myr) {
    context.advance(0.9 * (time_myr - first_myr) /
                    std::max(settings.law.step_myr, parameters.time_myr - first_myr));
  };
  drift.spin_up(progress);
  const auto steps = std::lround(parameters.time_myr / settings.law.step_myr);
  std::optional<DriftLandscape> landscape;
  if (parameters.landscape == "full") {
    landscape.emplace(parameters, io.grid(), context);
    if (model.state.runoff.empty()) landscape->turn_climate(model, drift.leader());
  }
  DriftLandscape* const seen_landscape = landscape ? &*landscape : nullptr;
  const bool shows = context.on_frame && parameters.frames_myr > 0.0;
  // Frames that are due after so many steps: each multiple of the interval is shown by the step
  // that reaches or passes it, however the two divide.
  const auto frames_due = [&](auto step_count) {
    const double time_myr = static_cast<double>(step_count) * settings.law.step_myr;
    return std::floor(time_myr / parameters.frames_myr + 1e-9);
  };
  for (auto k = model.state.steps; k < steps; ++k) {
    const double from_myr = model.state.time_myr;
    if (shows && k == 0) show(parameters, drift, info, io.grid(), seen_landscape, context);
    progress(from_myr);
    drift.begin_step();
    if (context.reconstruction) follow_reconstruction(*context.reconstruction, model, context);
    strike_plates(io.grid(), from_myr, from_myr + settings.law.step_myr, drift.plates(), model,
                  context);
    history.enter(drift.plates());
    drift.advance();
    if (landscape && landscape->is_due(k, k + 1, settings.law.step_myr)) {
      landscape->turn_climate(model, drift.leader());
    }
    balance.enter(model.budget);
    context.steps.rows.push_back(step_row(model));
    if (shows && frames_due(k + 1) > frames_due(k)) {
      show(parameters, drift, info, io.grid(), seen_landscape, context);
    }
  }
  context.advance(0.9);
  finish_to_be_seen(model);
  balance.enter(model.budget);
  name_plates(context.steps);
  context.tables.push_back(SphereHistory::lives(model.state));
  context.tables.push_back(history.rotations(model.state));
  warn_of_later_events(model.state.time_myr, context);
  balance.close(context.budget);
  tell(model, io.grid(), context);
  SphereOnGrid(parameters, model, io, context).draw(io);
}

}  // namespace geo
