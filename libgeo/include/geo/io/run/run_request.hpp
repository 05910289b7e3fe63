#pragma once

#include <filesystem>
#include <string>

namespace geo::io {

/// What a command line asks of a run besides its configuration.
struct RunRequest {
  std::filesystem::path folder;
  /// First stage to compute. In a new folder the run starts there, from the DEM itself. With
  /// `overwrite` on a folder that holds a run, earlier stages keep their files.
  std::string from;
  std::string to;                  ///< last stage; empty: as configured
  bool resume = false;             ///< go on after the last complete stage
  bool allow_other_build = false;  ///< go on behind stages that another build wrote
  /// The configuration is the one that the folder holds. A run that reached its own `run.to` is
  /// then resumed to the last stage there is.
  bool folders_configuration = false;
  bool overwrite = false;  ///< replace what the folder holds
  int threads = 1;
};

}  // namespace geo::io
