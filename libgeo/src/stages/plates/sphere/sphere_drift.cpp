#include "sphere_drift.hpp"

#include <cmath>

#include "geo/core/error.hpp"
#include "geo/kernels/plates/plate_reconstruction.hpp"
#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "sphere_checkpoint.hpp"
#include "sphere_initial_conditions.hpp"
#include "sphere_reconstruction.hpp"

namespace geo {
namespace {

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

bool needs_leader(const PlatesParameters& parameters, const Context& context) {
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

SphereState leading_state(const Checkpoint& from, const SphereMesh& mesh) {
  SphereState state = leader_of(from);
  if (state.crust.size() == mesh.size()) return state;
  throw InputError("plates: the frame to go on from has " + std::to_string(state.crust.size()) +
                   " samples of motion: plates.sphere.motion_samples must be that, not " +
                   std::to_string(mesh.size()));
}

/// Forgets what was before time 0.
void begin_history(SphereTectonics& model) {
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

}  // namespace

/// A lattice and the model on it.
struct SphereDrift::SampledModel {
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

SphereDrift::SphereDrift(const PlatesParameters& parameters, const SphereSettings& settings,
                         const StageIo& io, Context& context) {
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

SphereDrift::~SphereDrift() = default;

SphereTectonics& SphereDrift::crust() { return crust_->model; }

SphereTectonics& SphereDrift::plates() { return leader_ ? leader_->model : crust_->model; }

SphereTectonics* SphereDrift::leader() { return leader_ ? &leader_->model : nullptr; }

void SphereDrift::begin_step() {
  leader_ ? begin_step_of_both(crust(), plates()) : geo::begin_step(crust());
}

void SphereDrift::advance() { leader_ ? advance_both(crust(), plates()) : geo::advance(crust()); }

void SphereDrift::spin_up(const std::function<void(double)>& progress) {
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

}  // namespace geo
