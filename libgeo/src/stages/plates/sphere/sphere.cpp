#include "sphere.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "geo/core/error.hpp"
#include "geo/kernels/plates/plate_reconstruction.hpp"
#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "sphere_checkpoint.hpp"
#include "sphere_history.hpp"
#include "sphere_initial_conditions.hpp"
#include "sphere_landscape.hpp"
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

/// Columns for the areas of all plates there have been.
void name_plates(StepTable& steps) {
  std::size_t most = 0;
  for (const auto& row : steps.rows) most = std::max(most, row.size());
  for (std::size_t k = 0; steps.columns.size() < most; ++k) {
    steps.columns.push_back("plate_" + std::to_string(k) + "_km2");
  }
}

/// Sums over the whole drift.
class MassBalance {
 public:
  void enter(const SphereBudget& step) {
    created_ += step.created_km2;
    consumed_ += step.consumed_km2;
    buried_ += step.buried_km2;
    emerged_ += step.emerged_km2;
    raised_ += step.raised_km3;
    eroded_ += step.eroded_km3;
    deposited_ += step.deposited_km3;
    sea_floor_ += step.sea_floor_km3;
    scraped_ += step.scraped_km3;
    laid_ += step.sediment_laid_km3;
    reworked_ += step.sediment_reworked_km3;
    subducted_ += step.sediment_subducted_km3;
    sediment_resampling_ += step.sediment_resampling_km3;
    emerged_km3_ += step.emerged_km3;
    changed_ += step.changed_km3;
    lost_ += step.lost_km3;
    resampling_ += step.resampling_km3;
    collisions_ += step.collisions;
    rifts_ += step.rifts;
    subduction_initiations_ += step.subduction_initiations;
    if (first_km3_ < 0.0) {
      first_km3_ = step.continental_km3 - change(step);
      first_sediment_km3_ = step.sediment_km3 - sediment_change(step);
    }
    last_ = step;
  }
  /// What a step is told by, before the areas of its plates.
  static std::vector<std::string> columns() {
    return {"time_myr",
            "plates",
            "resampled",
            "collisions",
            "rifts",
            "created_km2",
            "consumed_km2",
            "buried_km2",
            "emerged_km2",
            "stretched_km2",
            "accreted_km3",
            "continental_km3",
            "raised_km3",
            "eroded_km3",
            "emerged_km3",
            "swallowed_km3",
            "changed_km3",
            "lost_km3",
            "resampling_km3",
            "deposited_km3",
            "sea_floor_km3",
            "erupted_km3",
            "subduction_initiations",
            "scraped_km3",
            "sediment_km3",
            "sediment_laid_km3",
            "sediment_reworked_km3",
            "sediment_subducted_km3",
            "sediment_resampling_km3",
            "sea_level_m",
            "water_km3"};
  }
  static std::vector<double> row(const SphereTectonics& model) {
    const SphereBudget& b = model.budget;
    std::vector<double> row{b.time_myr,
                            static_cast<double>(b.plates),
                            b.resampled ? 1.0 : 0.0,
                            static_cast<double>(b.collisions),
                            static_cast<double>(b.rifts),
                            b.created_km2,
                            b.consumed_km2,
                            b.buried_km2,
                            b.emerged_km2,
                            b.stretched_km2,
                            b.accreted_km3,
                            b.continental_km3,
                            b.raised_km3,
                            b.eroded_km3,
                            b.emerged_km3,
                            b.swallowed_km3,
                            b.changed_km3,
                            b.lost_km3,
                            b.resampling_km3,
                            b.deposited_km3,
                            b.sea_floor_km3,
                            b.erupted_km3,
                            static_cast<double>(b.subduction_initiations),
                            b.scraped_km3,
                            b.sediment_km3,
                            b.sediment_laid_km3,
                            b.sediment_reworked_km3,
                            b.sediment_subducted_km3,
                            b.sediment_resampling_km3,
                            model.state.sea_level_m,
                            model.state.water_km3};
    // By the numbers of plates, which outlast the places where the model keeps them.
    const SphereState& state = model.state;
    const std::vector<double> area_km2 = plate_areas_km2(model);
    const std::size_t before = row.size();
    row.resize(before + state.lives.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t p = 0; p < area_km2.size(); ++p) {
      if (area_km2[p] > 0.0) row[before + state.plates[p].id] = area_km2[p];
    }
    return row;
  }
  void close(Budget& budget) const {
    budget["plates"] = last_.plates;
    budget["plates_area_error"] = last_.area_error;
    budget["crust_created_km2"] = created_;
    budget["crust_consumed_km2"] = consumed_;
    budget["crust_buried_km2"] = buried_;
    budget["crust_emerged_km2"] = emerged_;
    budget["collisions"] = collisions_;
    budget["rifts"] = rifts_;
    budget["subduction_initiations"] = subduction_initiations_;
    budget["continental_start_km3"] = first_km3_;
    budget["continental_end_km3"] = last_.continental_km3;
    budget["continental_raised_km3"] = raised_;
    budget["continental_eroded_km3"] = eroded_;
    budget["continental_deposited_km3"] = deposited_;
    budget["sea_floor_deposited_km3"] = sea_floor_;
    budget["continental_scraped_km3"] = scraped_;
    budget["continental_emerged_km3"] = emerged_km3_;
    budget["continental_changed_km3"] = changed_;
    budget["continental_lost_km3"] = lost_;
    budget["continental_resampling_km3"] = resampling_;
    budget["continental_closing_error"] =
        (last_.continental_km3 - first_km3_ - raised_ + eroded_ - deposited_ - scraped_ -
         emerged_km3_ - changed_ + lost_ - resampling_) /
        std::max(1.0, last_.continental_km3);
    if (laid_ <= 0.0) return;
    budget["sediment_start_km3"] = first_sediment_km3_;
    budget["sediment_end_km3"] = last_.sediment_km3;
    budget["sediment_laid_km3"] = laid_;
    budget["sediment_reworked_km3"] = reworked_;
    budget["sediment_subducted_km3"] = subducted_;
    budget["sediment_resampling_km3"] = sediment_resampling_;
    budget["sediment_drift_closing_error"] = (last_.sediment_km3 - first_sediment_km3_ - laid_ +
                                              reworked_ + subducted_ - sediment_resampling_) /
                                             laid_;
  }

 private:
  static double change(const SphereBudget& step) {
    return step.raised_km3 - step.eroded_km3 + step.deposited_km3 + step.scraped_km3 +
           step.emerged_km3 + step.changed_km3 - step.lost_km3 + step.resampling_km3;
  }
  static double sediment_change(const SphereBudget& step) {
    return step.sediment_laid_km3 - step.sediment_reworked_km3 - step.sediment_subducted_km3 +
           step.sediment_resampling_km3;
  }
  double created_ = 0.0, consumed_ = 0.0, buried_ = 0.0, emerged_ = 0.0;
  double deposited_ = 0.0, sea_floor_ = 0.0, scraped_ = 0.0;
  double laid_ = 0.0, reworked_ = 0.0, subducted_ = 0.0, sediment_resampling_ = 0.0;
  double raised_ = 0.0, eroded_ = 0.0, emerged_km3_ = 0.0, changed_ = 0.0, lost_ = 0.0;
  double resampling_ = 0.0;
  double first_km3_ = -1.0, first_sediment_km3_ = 0.0;
  int collisions_ = 0, rifts_ = 0, subduction_initiations_ = 0;
  SphereBudget last_;
};

}  // namespace

namespace {

constexpr double kDegrees = 57.29577951308232;

/// Plates and crust as they begin to drift, with a spin-up before time 0 where all is drawn.
SphereState drawn_state(const PlatesParameters& parameters, const SphereMesh& mesh,
                        const SphereSettings& settings, const StageIo& io, Context& context) {
  SphereState state =
      start_sphere(mesh, sphere_start(parameters, mesh, io, context), settings, context.seed);
  state.plumes = first_plumes(parameters, context.seed);
  if (context.plates.empty() && parameters.initial_elevation == "noise") {
    const double step_myr = settings.law.step_myr;
    const double before_myr = step_myr * std::round(parameters.spin_up_myr / step_myr);
    state.time_myr = before_myr > 0.0 ? -before_myr : 0.0;  // files are named by it: no -0
    state.resampled_myr = state.time_myr;
  }
  if (context.reconstruction) state.reconstruction_ma = context.reconstruction->start_ma;
  return state;
}

/// As a frame has them.
SphereState resumed_state(const PlatesParameters& parameters, const SphereMesh& mesh,
                          Context& context) {
  SphereState state = state_of(*context.checkpoint);
  if (!context.checkpoint->arrays.contains("plumes")) {
    state.plumes = first_plumes(parameters, context.seed);
  }
  if (state.crust.size() != mesh.size()) {
    throw InputError("plates: the frame to go on from has " + std::to_string(state.crust.size()) +
                     " samples: plates.sphere.samples must be that, not " +
                     std::to_string(mesh.size()));
  }
  if (context.reconstruction) check_reconstruction(*context.reconstruction, state);
  return state;
}

/// A lattice and the model on it.
struct SampledModel {
  template <class Begin>
  SampledModel(std::int64_t count, const SphereSettings& settings, std::uint64_t seed,
               Begin&& begin)
      : samples(static_cast<std::int32_t>(count)),
        mesh(samples),
        model(mesh, settings, begin(mesh), seed) {}

  FibonacciSphere samples;
  SphereMesh mesh;
  SphereTectonics model;
};

/// The crust that drifts, and the plates that lead it where they have samples of their own.
class Drift {
 public:
  Drift(const PlatesParameters& parameters, const SphereSettings& settings, const StageIo& io,
        Context& context) {
    const bool resumes = context.checkpoint != nullptr;
    crust_ = std::make_unique<SampledModel>(
        parameters.samples, settings, context.seed, [&](const SphereMesh& mesh) {
          return resumes ? resumed_state(parameters, mesh, context)
                         : drawn_state(parameters, mesh, settings, io, context);
        });
    if (needs_leader(parameters, context)) {
      const std::size_t warnings = context.warnings.size();  // of what both have in common
      leader_ = std::make_unique<SampledModel>(
          parameters.motion_samples, settings, context.seed, [&](const SphereMesh& mesh) {
            return resumes ? leading_state(*context.checkpoint, mesh)
                           : drawn_state(parameters, mesh, settings, io, context);
          });
      context.warnings.resize(warnings);
    }
    if (!resumes && !context.plates.empty()) {
      if (settings.no_net_rotation) subtract_net_rotation(plates());
      if (settings.hold_motions) hold_motions(plates());
    }
    if (!resumes && leader_) follow(crust(), plates());
  }
  [[nodiscard]] SphereTectonics& crust() { return crust_->model; }
  [[nodiscard]] SphereTectonics& plates() { return leader_ ? leader_->model : crust_->model; }
  [[nodiscard]] SphereTectonics* leader() { return leader_ ? &leader_->model : nullptr; }

  void begin_step() { leader_ ? begin_step_of_both(crust(), plates()) : geo::begin_step(crust()); }
  void advance() { leader_ ? advance_both(crust(), plates()) : geo::advance(crust()); }

  /// Lets plates drift up to time 0, from which on their history is told: those that are there then
  /// are the first.
  template <class Progress>
  void spin_up(Progress&& progress) {
    if (plates().state.time_myr >= 0.0) return;
    const double step_myr = plates().settings.law.step_myr;
    const double arcs_last_myr = plates().settings.back_arc_lasts_myr;
    const double blocks_last_myr = plates().settings.indentation_lasts_myr;
    while (plates().state.time_myr < -0.5 * step_myr) {
      progress(plates().state.time_myr);
      // Arcs that have left their plates, and blocks that have come to rest, are not among the
      // first plates.
      if (plates().state.time_myr > -1.5 * step_myr) {
        plates().settings.back_arc_lasts_myr = plates().settings.indentation_lasts_myr = 0.0;
      }
      advance();
    }
    // So that the first plates are those that the first frame shows.
    leader_ ? finish_both(crust(), plates()) : finish(crust());
    plates().settings.back_arc_lasts_myr = arcs_last_myr;
    plates().settings.indentation_lasts_myr = blocks_last_myr;
    begin_history(plates());
    if (!leader_) return;
    begin_history(crust());
    crust().state.plates = plates().state.plates;
    crust().state.lives = plates().state.lives;
  }

 private:
  static bool needs_leader(const PlatesParameters& parameters, const Context& context) {
    const bool leads = parameters.motion_samples > 0 &&
                       parameters.motion_samples != parameters.samples && !context.reconstruction;
    if (context.checkpoint != nullptr && leads != has_leader(*context.checkpoint)) {
      throw InputError(leads ? "plates: the frame to go on from has no samples of motion: "
                               "plates.sphere.motion_samples must be 0"
                             : "plates: the frame to go on from has samples of motion: "
                               "plates.sphere.motion_samples must be their number");
    }
    return leads;
  }
  static SphereState leading_state(const Checkpoint& from, const SphereMesh& mesh) {
    SphereState state = leader_of(from);
    if (state.crust.size() == mesh.size()) return state;
    throw InputError("plates: the frame to go on from has " + std::to_string(state.crust.size()) +
                     " samples of motion: plates.sphere.motion_samples must be that, not " +
                     std::to_string(mesh.size()));
  }
  static void begin_history(SphereTectonics& model) {
    SphereState& state = model.state;
    model.events.clear();
    state.time_myr = state.resampled_myr = 0.0;
    state.steps = 0;
    state.lives.clear();
    for (SpherePlate& plate : state.plates) {
      // Numbers of plates that are no more are those of lives that have been forgotten.
      const bool lives = plate.alive && plate.carrier < 0;
      plate.id =
          lives ? state.begin_life(PlateLife::Origin::first, -1) : static_cast<std::int16_t>(-1);
      plate.born_myr = 0.0;
    }
  }

  std::unique_ptr<SampledModel> crust_, leader_;
};

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
void show(const PlatesParameters& parameters, Drift& drift, const StageInfo& info, const Grid& grid,
          DriftLandscape* landscape, const Context& context) {
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
  Drift drift(parameters, settings, io, context);
  SphereTectonics& model = drift.crust();
  if (context.reconstruction) drive_plates(*context.reconstruction, model, context);
  MassBalance balance;
  SphereHistory history(io.grid());
  context.steps.columns = MassBalance::columns();
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
    context.steps.rows.push_back(MassBalance::row(model));
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
