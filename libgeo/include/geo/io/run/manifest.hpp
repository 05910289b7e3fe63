#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/event.hpp"
#include "geo/io/files/digest.hpp"
#include "geo/io/netcdf/stage_file.hpp"

namespace geo::io {

/// The build of terrane that wrote something; see BuildInfo.
struct Builder {
  std::string version, commit, id;
  bool operator==(const Builder&) const = default;
  /// "0.1.0", or if the other has that too "0.1.0 of commit 1f3c, build 8a2b".
  [[nodiscard]] std::string words_beside(const Builder& other) const;
};
/// This build.
Builder this_builder();

/// What the manifest keeps of one stage. It is written after the stage's files.
struct StageRecord {
  std::string name;
  double seconds = 0.0;
  std::map<std::string, double> budget;
  std::vector<EventRecord> events;  ///< what they did in this stage
  std::vector<std::string> warnings;
  std::vector<std::string> files;                   ///< relative to the folder of the run
  std::map<std::string, std::string> file_digests;  ///< of their bytes
  std::vector<FieldRecord> fields;
  Builder builder;
  bool own_grid = false;    ///< a part of the planet seen closer, StageInfo::own_grid: an island
  bool on_command = false;  ///< an island that `terrane island` made, not the run's own

  /// Adds a file of the run's folder with its digest, once. Throws IoError.
  void list(const std::filesystem::path& folder, const std::string& file);
};

/// manifest.json of a run.
struct Manifest {
  std::string version, commit, compiler, build;
  std::map<std::string, std::string> libraries;
  std::uint64_t seed = 1;
  int threads = 1;
  std::string config_digest;
  std::vector<StageRecord> stages;  ///< those that are done
  bool complete = false;            ///< the run went to its end
  /// What the user allowed: "other-build" that stages are of several builds.
  std::vector<std::string> allowed;
  /// Of what lies beside the stages' files: the digest of its bytes by its path in the folder.
  std::map<std::string, std::string> files;

  /// The build that wrote a stage: what its record says, else that of the run.
  [[nodiscard]] Builder builder_of(const StageRecord& record) const;
  /// The first of those that wrote the stages or the run itself and is not this one.
  [[nodiscard]] std::optional<Builder> other_builder() const;
  /// Another build may compute other values: what several have made makes a planet only where that
  /// is asked for, and `allowed` keeps it. What was allowed before holds for the build that did it.
  /// `asked_by` and `folder` begin the message, `otherwise` ends it with what helps without that
  /// word. Throws ConfigurationError.
  void check_builders(std::string_view asked_by, const std::filesystem::path& folder, bool allow,
                      std::string_view otherwise);
  /// The first name of an island that no record has, of this number or a higher one: that of the
  /// stage, then with "-2" behind it.
  [[nodiscard]] std::string free_name(std::string_view stage, int first) const;
};

/// Writes manifest.json whole or not at all. Throws IoError.
void write_manifest(const std::filesystem::path& path, const Manifest& manifest);
/// Throws IoError when there is none, InputError when it cannot be understood.
Manifest read_manifest(const std::filesystem::path& path);

/// Why a stage's file and its record disagree ("elevation: digest differs"), or empty: then the
/// stage is complete.
std::string disagreement(const StageRecord& record, const Snapshot& file);
/// The same of one field of the file.
std::string disagreement(const StageRecord& record, const FieldSpec& spec, const Values& values);

/// Name of the NetCDF file of a stage, relative to the folder. Throws InputError if it has none.
std::string netcdf_of(const StageRecord& record);

/// Versions of the libraries that this program runs with.
std::map<std::string, std::string> library_versions();

}  // namespace geo::io
