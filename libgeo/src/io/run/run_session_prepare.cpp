// The half of a run session that only looks: names, folder, relief, wiring, room.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/build_info.hpp"
#include "geo/io/files/source_date.hpp"
#include "geo/io/input/dem.hpp"
#include "geo/io/input/exemplar_files.hpp"
#include "geo/io/input/hypsography.hpp"
#include "geo/io/input/plate_outlines.hpp"
#include "geo/io/run/recorded_file.hpp"
#include "geo/io/run/run_session.hpp"
#include "geo/kernels/landscape/impact_crater.hpp"
#include "geo/kernels/numerics/quantiles.hpp"

namespace geo::io {
namespace {

// What may differ between a run and its continuation: how far it goes and what else is written.
constexpr std::string_view kFreeOnResume[] = {"run.to",
                                              "output.vtk",
                                              "output.globe",
                                              "output.globe_exaggeration",
                                              "output.maps",
                                              "output.map_width_px",
                                              "output.map_projection",
                                              "output.map_center",
                                              "output.compression"};
// The same where stages are computed again behind others that stay.
constexpr std::string_view kFreeOnPartialOverwrite[] = {"run.from", "run.to"};

bool lists(const std::vector<const FieldSpec*>& specs, const FieldSpec& spec) {
  return std::any_of(specs.begin(), specs.end(),
                     [&](const FieldSpec* listed) { return listed->name == spec.name; });
}

bool has_choice(Stage& stage, std::string_view key, std::string_view value) {
  for (const Parameter& row : stage.parameters()) {
    if (row.name == key) return row.value() == ParameterValue(std::string(value));
  }
  return false;
}

bool takes_hypsography(Stage& stage) {
  return lists(stage.info().optional, field::ranking) ||
         has_choice(stage, "erosion.hypsometry", "rank");
}

/// The keys of [fields] that a stage reads something by.
std::vector<std::string> given_fields_of(Stage& stage) {
  const StageInfo& info = stage.info();
  std::vector<std::string> keys;
  const auto takes = [&](const FieldSpec& spec) {
    return lists(info.reads, spec) || lists(info.optional, spec);
  };
  if (takes(field::erodibility)) keys.emplace_back("fields.erodibility");
  if (takes(field::uplift_rate)) keys.emplace_back("fields.uplift_rate");
  if (takes(field::ranking)) keys.emplace_back("fields.ranking");
  if (takes_hypsography(stage)) {
    keys.insert(keys.end(), {"fields.hypsography", "fields.hypsography_ocean"});
  }
  if (info.name == "plates") {
    keys.insert(keys.end(), {"fields.plates", "fields.initial_elevation", "fields.initial_age",
                             "fields.start_frame"});
  }
  if (has_choice(stage, fmt::format("{}.detail", info.name), "exemplars")) {
    keys.emplace_back("fields.exemplars");
  }
  return keys;
}

/// The grid that a relief is put on.
Grid grid_for(const Relief& relief, const RunSettings& settings, const Planet& planet) {
  if (settings.grid_is_automatic()) return relief.grid;
  const auto [nx, ny] = parse_grid_size(settings.grid);
  const Grid& source = relief.grid;
  if (source.topology() == Topology::sphere) return Grid::sphere(nx, ny, planet.figure());
  if (source.is_latitude_longitude()) {
    return Grid::window(nx, ny, source.window(), planet.figure(), source.edges());
  }
  const double width_m = source.spacing_east_m(0) * source.nx();
  const double height_m = source.step_north_m() * source.ny();
  return Grid::plane(nx, ny, width_m / nx, height_m / ny, source.edges(), source.centre(),
                     planet.figure());
}

/// Refuses a relief of a part of a planet where a whole one is needed.
void check_whole_planet(const Relief& relief, std::string_view key) {
  if (relief.grid.topology() == Topology::sphere) return;
  throw InputError(fmt::format("{}: {}: must cover the whole planet", key, relief.source));
}

/// Refuses events that this planet has no place for.
void check_events(const std::vector<Event>& events, const Grid& grid, const Planet& planet) {
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (!std::holds_alternative<OceanShift>(events[i].what) && !grid.is_geographic()) {
      throw ConfigurationError(fmt::format(
          "event {} ({}) needs a relief with latitudes and longitudes", i + 1, events[i].kind()));
    }
    if (const auto* shift = std::get_if<OceanShift>(&events[i].what)) {
      constexpr double kDeepest_km = 20.0;
      const double most_km3 = 1e-6 * grid.total_area_m2() * kDeepest_km;
      if (std::abs(shift->water_km3) > most_km3) {
        throw ConfigurationError(fmt::format(
            "event {} (ocean-shift): water_km3 = {:g}: must be within {:.3g}, {:g} km of water "
            "everywhere",
            i + 1, shift->water_km3, most_km3, kDeepest_km));
      }
    }
    const auto* impact = std::get_if<Impact>(&events[i].what);
    if (impact == nullptr) continue;
    const double crater_km = 1e-3 * crater_of({.diameter_m = 1e3 * impact->diameter_km,
                                               .density_kg_m3 = impact->density_kg_m3,
                                               .velocity_m_s = 1e3 * impact->velocity_km_s,
                                               .angle_deg = impact->angle_deg,
                                               .ground_density_kg_m3 = impact->ground_density_kg_m3,
                                               .gravity_m_s2 = planet.gravity_m_s2})
                                        .diameter_m;
    if (crater_km > planet.radius_km) {
      throw ConfigurationError(
          fmt::format("event {} (impact): its crater of {:.0f} km is wider than the planet's "
                      "radius of {:g} km: must be a smaller or slower body",
                      i + 1, crater_km, planet.radius_km));
    }
  }
}

/// Heights that no solid planet holds up are a wrong unit or a damaged file.
void check_heights(const Relief& relief) {
  constexpr float kMost_m = 100e3F;
  for (const float height_m : relief.elevation_m) {
    if (std::abs(height_m) <= kMost_m) continue;
    throw InputError(fmt::format("{}: holds an elevation of {:g} m: must lie within {:g} m",
                                 relief.source, height_m, kMost_m));
  }
}

}  // namespace

RunSession::RunSession(const Pipeline& pipeline, std::vector<int> numbers, RunSettings& settings,
                       const Planet& planet, std::span<const Parameter> parameters,
                       RunRequest request)
    : pipeline_(pipeline),
      numbers_(std::move(numbers)),
      settings_(settings),
      planet_(planet),
      parameters_(parameters),
      request_(std::move(request)),
      folder_(request_.folder) {}

std::string_view RunSession::name_of(int position) const {
  return pipeline_.stages()[position]->info().name;
}

std::filesystem::path RunSession::file_of(int position, std::string_view extension) const {
  return folder_.stage_file(numbers_[position], name_of(position), extension);
}

int RunSession::position_of(const std::string& stage, std::string_view asked_by) const {
  const int position = pipeline_.find(stage);
  if (position >= 0) return position;
  std::vector<std::string_view> names;
  for (const auto& known : pipeline_.stages()) names.push_back(known->info().name);
  throw ConfigurationError(fmt::format("{}: unknown stage {}: must be one of {}{}", asked_by, stage,
                                       fmt::join(names, ", "), suggestion(stage, names)));
}

std::string RunSession::resolved_config() const {
  return write_config(parameters_,
                      fmt::format("terrane {}: every parameter as it was used. Runs again with: "
                                  "terrane run config.toml",
                                  build_info().version),
                      settings_.events);
}

void RunSession::prepare() {
  now_or_given();  // refuses a bad SOURCE_DATE_EPOCH
  if (!settings_.grid_is_automatic()) parse_grid_size(settings_.grid);
  (void)settings_.map_view();  // refuses a centre that the projection cannot have
  choose_stages();
  look_at_folder();
  load_complete_stages();
  if (needs_relief()) {
    read_initial_relief();
  } else if (!state_) {
    begin_with_bare_planet();
  }
  leave_out_island();
  check_events(settings_.events, grid(), planet_);
  read_given_fields();
  read_initial_conditions();
  read_given_exemplars();
  if (!settings_.start_frame.empty()) (void)read_checkpoint(settings_.start_frame);
  (void)hypsography();  // refuses a bad one before anything is computed
  pipeline_.check(state_->present(), first_, last_);
  config_ = resolved_config();
}

void RunSession::choose_stages() {
  if (!request_.to.empty()) settings_.to = request_.to;
  const int most = static_cast<int>(pipeline_.stages().size()) - 1;
  last_ = settings_.to.empty() ? most : position_of(settings_.to, "run.to");
  const std::string& from = request_.from.empty() ? settings_.from : request_.from;
  begin_ = from.empty() ? first_stage_of_input() : position_of(from, "run.from");
  first_ = begin_;
  if (first_ > last_) {
    throw ConfigurationError(fmt::format("run.from = {} comes after run.to = {}: must not",
                                         name_of(first_), name_of(last_)));
  }
}

/// A real relief takes the place of the stages that would make one.
int RunSession::first_stage_of_input() const {
  if (settings_.dem_file.empty()) return 0;
  const auto& stages = pipeline_.stages();
  const auto reader = std::find_if(stages.begin(), stages.end(), [](const auto& stage) {
    return lists(stage->info().reads, field::elevation);
  });
  return static_cast<int>(reader - stages.begin());
}

void RunSession::look_at_folder() {
  if (folder_.path().empty()) throw ConfigurationError("-o \"\": must name a folder");
  const std::string shown = folder_.path().string();
  if (request_.resume && request_.overwrite) {
    throw ConfigurationError("--resume and --overwrite exclude each other: choose one");
  }
  const bool held = folder_.holds_run();
  if (held && !request_.resume && !request_.overwrite) {
    throw ConfigurationError(fmt::format(
        "{} already holds a run: --resume goes on with it, --overwrite replaces it", shown));
  }
  const bool known = held && std::filesystem::exists(folder_.config());
  if (request_.resume && !known) {
    throw ConfigurationError(fmt::format("--resume: {} holds no run to go on with", shown));
  }
  if (known && (request_.resume || !request_.from.empty())) {
    const std::string before = read_text(folder_.config());
    if (std::filesystem::exists(folder_.manifest())) {
      manifest_ = read_manifest(folder_.manifest());
    }
    if (request_.resume) return go_on_from(before);
    const std::string old_from = configured_text(before, "run.from");
    const int old_begin = old_from.empty() ? first_stage_of_input() : pipeline_.find(old_from);
    if (old_begin >= 0 && old_begin < first_) return keep_earlier_stages(before, old_begin);
    manifest_ = {};
  }
  if (!request_.from.empty()) settings_.from = request_.from;
}

void RunSession::take_open_settings(const std::string& before) {
  if (settings_.grid_is_automatic()) settings_.grid = configured_text(before, "run.grid");
  if (settings_.dem_variable.empty()) {
    settings_.dem_variable = configured_text(before, "dem.variable");
  }
}

void RunSession::go_on_from(const std::string& before) {
  manifest_.check_builders("--resume", folder_.path(), request_.allow_other_build,
                           "--overwrite computes all again");
  take_open_settings(before);
  const std::string old_to = configured_text(before, "run.to");
  const bool as_far_as_before = request_.to.empty() && settings_.to == old_to;
  if (request_.folders_configuration && manifest_.complete && as_far_as_before) {
    settings_.to.clear();
    last_ = static_cast<int>(pipeline_.stages().size()) - 1;
  }
  if (!request_.from.empty()) settings_.from = request_.from;
  const auto difference = first_difference(before, resolved_config(), {}, kFreeOnResume);
  if (!difference.empty()) {
    throw ConfigurationError(
        fmt::format("--resume: the configuration changed: {}; --overwrite computes {} again",
                    difference, folder_.path().string()));
  }
  first_ = begin_ + count_complete_stages();
  if (first_ > last_ + 1) settings_.to = old_to;  // the stages behind it stay
}

void RunSession::keep_earlier_stages(const std::string& before, int old_begin) {
  manifest_.check_builders("--from " + std::string(name_of(first_)), folder_.path(),
                           request_.allow_other_build, "--overwrite computes all again");
  begin_ = old_begin;
  settings_.from = configured_text(before, "run.from");
  take_open_settings(before);
  std::vector<std::string> sections{"run", "dem", "planet"};
  for (int at = begin_; at < first_; ++at) {
    sections.emplace_back(name_of(at));
    for (std::string& key : given_fields_of(*pipeline_.stages()[at])) {
      sections.push_back(std::move(key));
    }
    if (pipeline_.stages()[at]->info().feels_events) sections.emplace_back("event");
  }
  // The sea of all stages may be the hypsography's, whichever of them follows it.
  if (follows_hypsography()) {
    sections.insert(sections.end(), {"fields.hypsography", "fields.hypsography_ocean"});
  }
  const auto difference =
      first_difference(before, resolved_config(), sections, kFreeOnPartialOverwrite);
  if (!difference.empty()) {
    throw ConfigurationError(
        fmt::format("--from {}: the stages before it would not be the same: {}; --overwrite "
                    "without --from computes all again",
                    name_of(first_), difference));
  }
  const int complete = count_complete_stages();
  if (begin_ + complete < first_) {
    throw ConfigurationError(fmt::format("--from {}: {} holds no complete {} to start from",
                                         name_of(first_), folder_.path().string(),
                                         name_of(begin_ + complete)));
  }
}

int RunSession::count_complete_stages() const {
  const int most = static_cast<int>(pipeline_.stages().size());
  int at = begin_;
  while (at < most && is_complete(at)) ++at;
  return at - begin_;
}

/// A file that is not there or cannot be read is computed again; one whose values somebody changed
/// is refused.
bool RunSession::is_complete(int position) const {
  const auto record = std::find_if(
      manifest_.stages.begin(), manifest_.stages.end(),
      [&](const StageRecord& candidate) { return candidate.name == name_of(position); });
  if (record == manifest_.stages.end()) return false;
  const Standing standing = standing_of(folder_.path(), *record);
  if (!standing.difference.empty()) {
    throw InputError(
        fmt::format("{}: is not what manifest.json says: {}; without the file it is computed anew",
                    file_of(position, ".nc").string(), standing.difference));
  }
  return standing.fault.empty();
}

bool RunSession::is_still_read(const FieldSpec& spec) const {
  for (int at = first_; at <= last_; ++at) {
    const StageInfo& info = pipeline_.stages()[at]->info();
    if (lists(info.reads, spec) || lists(info.optional, spec)) return true;
  }
  return false;
}

void RunSession::load_complete_stages() {
  for (int at = begin_; at < first_; ++at) {
    if (pipeline_.stages()[at]->info().own_grid) continue;
    const Snapshot snapshot = read_netcdf(file_of(at, ".nc"));
    if (!state_) state_.emplace(snapshot.grid);
    for (const auto& [spec, values] : snapshot.fields) {
      if (is_still_read(*spec)) state_->set(*spec, *values);
    }
  }
  if (state_) folder_.check_writable(prediction({}).disk_bytes);
}

/// Whether a stage to be run reads an elevation that none before it writes.
bool RunSession::needs_relief() const {
  if (state_ && state_->has(field::elevation)) return false;
  for (int at = first_; at <= last_; ++at) {
    const StageInfo& info = pipeline_.stages()[at]->info();
    if (lists(info.reads, field::elevation)) return true;
    if (lists(info.writes, field::elevation)) return false;
  }
  return false;
}

/// The sphere, or the torus of square cells, on which the first stage starts from the seed alone.
void RunSession::begin_with_bare_planet() {
  const bool is_torus = settings_.topology == "torus";
  const GridSize usual = is_torus ? GridSize{1024, 1024} : GridSize{4096, 2048};
  const auto [nx, ny] = settings_.grid_is_automatic() ? usual : parse_grid_size(settings_.grid);
  settings_.grid = fmt::format("{}x{}", nx, ny);
  const double cell_m = 2.0 * std::numbers::pi * planet_.figure().radius_m / std::max(1, nx);
  state_.emplace(std::make_shared<const Grid>(is_torus ? Grid::torus(nx, ny, cell_m, cell_m)
                                                       : Grid::sphere(nx, ny, planet_.figure())));
  folder_.check_writable(prediction({}).disk_bytes);
}

void RunSession::read_initial_relief() {
  if (settings_.topology != "sphere") {
    throw ConfigurationError(
        fmt::format("run.topology = {}: {} starts from a relief here, which brings its own grid: "
                    "must be sphere, or the run must start with {}",
                    settings_.topology, name_of(first_), name_of(0)));
  }
  if (settings_.dem_file.empty()) {
    throw ConfigurationError(
        fmt::format("{} needs a relief to start from: give one with --dem FILE[:VARIABLE], a file "
                    "of elevations, "
                    "or start with {}",
                    name_of(first_), name_of(0)));
  }
  Relief relief = read_relief(settings_.dem_variable.empty()
                                  ? settings_.dem_file
                                  : settings_.dem_file + ":" + settings_.dem_variable,
                              planet_, {settings_.dem_range, settings_.dem_window});
  check_heights(relief);
  auto grid = state_ ? state_->shared_grid()
                     : std::make_shared<const Grid>(grid_for(relief, settings_, planet_));
  settings_.grid = fmt::format("{}x{}", grid->nx(), grid->ny());
  settings_.dem_variable = relief.variable;
  if (!state_) state_.emplace(grid);
  folder_.check_writable(prediction({}).disk_bytes);
  std::vector<float> elevation_m = resample(relief, *grid);
  if (settings_.dem_sea_level == "fraction") {
    const float sea_level_m =
        level_for_fraction(*grid, elevation_m, planet_with_sea().ocean_fraction);
    for (float& height_m : elevation_m) height_m -= sea_level_m;
  }
  state_->set(field::elevation, std::move(elevation_m));
}

/// A part of a planet has no island of its own: the run ends before it unless it is asked for.
void RunSession::leave_out_island() {
  if (last_ < begin_ || !pipeline_.stages()[last_]->info().own_grid) return;
  if (grid().topology() == Topology::sphere) return;
  const std::string name(name_of(last_));
  const std::string_view what =
      grid().topology() == Topology::torus ? "a torus is none" : "the relief covers a part of one";
  if (settings_.to == name || last_ == begin_) {
    throw ConfigurationError(fmt::format("stage {} needs a whole planet: {}", name, what));
  }
  --last_;
  note_ = fmt::format("no {}: it needs a whole planet, {}", name, what);
}

/// Whether the run as a whole has the stage in which events change the relief.
bool RunSession::events_are_felt() const {
  const auto& events = settings_.events;
  if (std::all_of(events.begin(), events.end(), [](const Event& e) { return e.is_of_plates(); })) {
    return true;
  }
  const auto& stages = pipeline_.stages();
  for (int at = begin_; at <= last_; ++at) {
    const StageInfo& info = stages[at]->info();
    if (info.feels_events && lists(info.writes, field::elevation)) return true;
  }
  return false;
}

Hypsography RunSession::hypsography() const {
  Hypsography curve = read_hypsography(settings_.hypsography);
  if (settings_.hypsography_ocean == "curve" || planet_.sea_level != "fraction") return curve;
  return with_ocean_share(std::move(curve), planet_.ocean_fraction);
}

/// Whether a stage of the run as a whole takes its heights from the hypsography.
bool RunSession::follows_hypsography() const {
  const auto& stages = pipeline_.stages();
  for (int at = begin_; at <= last_; ++at) {
    if (takes_hypsography(*stages[at])) return true;
  }
  return false;
}

/// The planet as stages see it: where the hypsography says which part of it lies below the sea, all
/// of them have that sea.
Planet RunSession::planet_with_sea() const {
  Planet planet = planet_;
  if (settings_.hypsography_ocean != "curve" || !follows_hypsography()) return planet;
  planet.sea_level = "fraction";
  planet.ocean_fraction = ocean_share_of(read_hypsography(settings_.hypsography));
  return planet;
}

void RunSession::read_given_fields() {
  const auto read = [&](const Field<float>& spec, const std::string& given) {
    if (given.empty() || state_->has(spec) || !is_still_read(spec)) return;
    FieldSpec read_as = spec;
    if (&spec == &field::ranking) read_as.units = "";  // an order has no unit
    state_->set(spec, resample(read_field(given, read_as, planet_), state_->grid()));
  };
  read(field::erodibility, settings_.erodibility);
  read(field::uplift_rate, settings_.uplift_rate);
  read(field::ranking, settings_.ranking);
}

/// A run that leaves the first stage out has no use for what it begins with.
void RunSession::refuse_initial_conditions() const {
  const std::pair<std::string_view, const std::string*> given[] = {
      {"fields.plates", &settings_.plates},
      {"fields.initial_elevation", &settings_.initial_elevation},
      {"fields.initial_age", &settings_.initial_age},
      {"fields.start_frame", &settings_.start_frame}};
  for (const auto& [key, value] : given) {
    if (value->empty()) continue;
    throw ConfigurationError(
        fmt::format("{} = {}: is for stage {}, and this run begins with {}{}: must be empty", key,
                    *value, name_of(0), name_of(begin_),
                    settings_.dem_file.empty() ? "" : ", with the relief of --dem"));
  }
}

/// The first plates and the first relief, as far as the first stage is still to come. Cells of the
/// relief are of one size whatever the grid of the run, so that the same planet comes of it.
void RunSession::read_initial_conditions() {
  if (begin_ != 0) refuse_initial_conditions();
  if (first_ != 0) return;
  if (!settings_.plates.empty()) plates_ = read_plate_outlines(settings_.plates);
  if (settings_.initial_elevation.empty()) {
    for (const Parameter& row : pipeline_.stages().front()->parameters()) {
      if (row.name != "plates.sphere.initial_elevation" ||
          row.value() != ParameterValue(std::string("given")))
        continue;
      throw ConfigurationError(
          "plates.sphere.initial_elevation = given needs fields.initial_elevation, a NetCDF file "
          "of a "
          "planet's "
          "relief");
    }
    return;
  }
  constexpr GridSize kCells{2160, 1080};
  GivenRelief given{Grid::sphere(kCells.nx, kCells.ny, planet_.figure()), {}, {}};
  const Relief relief = read_relief(settings_.initial_elevation, planet_);
  check_whole_planet(relief, "fields.initial_elevation");
  check_heights(relief);
  given.elevation_m = resample(relief, given.grid);
  if (!settings_.initial_age.empty()) {
    const Relief age = read_field_with_gaps(settings_.initial_age, field::crust_age, planet_);
    check_whole_planet(age, "fields.initial_age");
    given.age_myr = resample(age, given.grid);
  }
  initial_elevation_ = std::make_shared<const GivenRelief>(std::move(given));
}

/// Refuses bad ones before anything is computed; those that terrane grows can wait.
void RunSession::read_given_exemplars() {
  if (!settings_.exemplars.empty()) find_exemplars();
}

/// For the stages that are still to be made like them.
void RunSession::find_exemplars() {
  const auto is_ahead = [&](std::string_view stage) {
    const int at = pipeline_.find(stage);
    return at >= 0 && first_ <= at && at <= last_ &&
           asks_for_exemplars(parameters_, fmt::format("{}.detail", stage));
  };
  if (!exemplars_ && is_ahead("island")) exemplars_ = exemplars_of(settings_.exemplars, planet_);
  if (!planet_exemplars_ && is_ahead("isostasy")) {
    const Parameter* longest_km = find_parameter(parameters_, "isostasy.detail_longest_km");
    planet_exemplars_ = planet_exemplars_of(settings_.exemplars, planet_,
                                            1e3 * std::get<double>(longest_km->value()), warnings_);
  }
}

Prediction RunSession::prediction(const MachineSpeed& speed) const {
  const auto cells = static_cast<double>(grid().size());
  const double map_width_px = settings_.maps ? static_cast<double>(settings_.map_width_px) : 0.0;
  const auto predicted = [&](bool vtk) {
    return predict(pipeline_, first_, last_, cells, speed, vtk, map_width_px);
  };
  Prediction sum = predicted(settings_.vtk);
  if (settings_.globe) {
    constexpr double kSurface_bytes = 36.0;  // of a cell: corners and faces
    sum.disk_bytes += predicted(true).disk_bytes - predicted(false).disk_bytes +
                      kSurface_bytes * cells * (last_ - first_ + 1);
  }
  return sum;
}

std::vector<std::string_view> RunSession::stages_to_run() const {
  std::vector<std::string_view> names;
  for (int at = first_; at <= last_; ++at) names.push_back(name_of(at));
  return names;
}

}  // namespace geo::io
