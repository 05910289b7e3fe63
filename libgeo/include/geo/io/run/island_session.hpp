#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "geo/core/pipeline.hpp"
#include "geo/core/planet.hpp"
#include "geo/io/config/run_settings.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/run_folder.hpp"
#include "geo/io/run/run_session.hpp"

namespace geo::io {

/// ParaView collections of a run: planet.pvd with the stages of the planet, island.pvd with its
/// islands (none when there is none). Lists the VTK files of the manifest.
void write_collection_files(const RunFolder& folder, const Manifest& manifest);

/// One more island from the files of a finished planet: 07-island.nc and .vti if there is none yet,
/// then 07-island-2.nc and so on, each with an entry of its own in the manifest, in island.pvd, on
/// maps and in the report. The run's own configuration and files stay as they are. A run that has
/// not come to its end keeps the first name for itself.
class IslandSession {
 public:
  /// `parameters` are all declarations, set to the configuration of the folder and then to what is
  /// asked of the island; they are bound to `settings`, `planet` and the stages of `pipeline`.
  IslandSession(const Pipeline& pipeline, int stage_number, const RunSettings& settings,
                const Planet& planet, std::span<const Parameter> parameters,
                std::filesystem::path folder);

  /// Checks that the folder holds all that an island is made from, and that this build made it
  /// unless that need not be (Manifest::check_builders). Throws ConfigurationError, InputError,
  /// IoError.
  void prepare(bool allow_other_build = false);
  /// Computes and writes; returns the name of the island ("island-2").
  std::string execute(const RunEvents& events);

 private:
  [[nodiscard]] std::string_view stage_name() const;
  [[nodiscard]] State read_planet() const;
  [[nodiscard]] Provenance provenance_of(const std::string& name) const;
  [[nodiscard]] Context context_of(const RunEvents& events) const;
  [[nodiscard]] StageRecord write_island(const std::string& name, const State& island,
                                         const Context& told) const;

  const Pipeline& pipeline_;
  int stage_number_;
  const RunSettings& settings_;
  const Planet& planet_;
  std::span<const Parameter> parameters_;
  RunFolder folder_;
  Manifest manifest_;
  int stage_ = -1;
  std::shared_ptr<const ExemplarLibrary> exemplars_;
};

}  // namespace geo::io
