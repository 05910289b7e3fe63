#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geo/core/state.hpp"
#include "geo/io/drawing/map_view.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/io/run/run_folder.hpp"

namespace geo::io {

/// Fields of a run that are still in memory, so that its pictures need not read them back.
class FieldsAtHand {
 public:
  /// Keeps those of these fields of the planet that pictures and scorecard are made from.
  void keep_planet(const State& state, std::span<const FieldSpec* const> fields);
  /// The same of an island's.
  void keep_island(const std::string& name, const State& state);

  /// What is kept of the planet, to be let go by who has it.
  [[nodiscard]] std::optional<State> take_planet() { return std::exchange(planet_, {}); }
  /// Null when nothing is kept of that island.
  [[nodiscard]] const State* island(const std::string& name) const;

 private:
  std::optional<State> planet_;
  std::map<std::string, State> islands_;
};

/// Draws the maps and the report of a run from its files, by its manifest, and from what is at hand
/// of them. The view is that of a planet of latitudes and longitudes; other grids and islands are
/// drawn as they lie. With the name of an island ("island-2") only its maps are drawn, and the
/// report lists those that are there. Pictures are drawn at the same time on as many threads as
/// OpenMP has. Returns the paths of the report and its pictures. Throws InputError or IoError when
/// the folder holds no such run.
std::vector<std::filesystem::path> draw_run(const RunFolder& folder, const MapView& view,
                                            std::string_view only_island = {},
                                            FieldsAtHand at_hand = {});

/// Draws the maps of a run's planet alone in some view, beside those of the run; no report.
std::vector<std::filesystem::path> draw_view(const RunFolder& folder, const MapView& view,
                                             const std::filesystem::path& pictures);

/// Draws the maps of each frame of a run through time, THEME/0050.00.png below `pictures`: films of
/// elevation, plates, ages and, where frames have a landscape, rain and warmth. Returns their
/// paths. Throws ConfigurationError where the run has no frames, InputError, IoError.
std::vector<std::filesystem::path> draw_frames(const RunFolder& folder, const MapView& view,
                                               const std::filesystem::path& pictures);

/// A field of a run, and of which stage.
struct FieldOfRun {
  std::string field;
  std::string stage;  ///< "hydrology", "island-2"; empty: the last of the planet that wrote it
};

/// Fields of one stage of a run, and the file that they are of.
struct FieldsOfRun {
  Snapshot snapshot;
  std::filesystem::path file;
};

/// Reads the stage that holds a field of a run: of that stage the field and what else `also` says
/// yes to, of a planet's other stages what of `besides` it lacks (where several have it, the last).
/// Throws ConfigurationError that names what is near where the run has no such stage or
/// field, InputError, IoError.
FieldsOfRun read_fields_of_run(const RunFolder& folder, const FieldOfRun& wanted,
                               const std::function<bool(const FieldSpec&)>& also,
                               const std::function<bool(const FieldSpec&)>& besides);

/// Draws one field of a run into `pictures`/FIELD.png, or STAGE-FIELD.png where a stage is named,
/// over the coast and the hillshading. Throws ConfigurationError that names what is near
/// where the run has no such stage or field, InputError, IoError.
std::filesystem::path draw_field(const RunFolder& folder, const MapView& view,
                                 const FieldOfRun& wanted, const std::filesystem::path& pictures);

}  // namespace geo::io
