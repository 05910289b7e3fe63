#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/fit.hpp"
#include "calibration/result.hpp"
#include "geo/io/run/manifest.hpp"

namespace geo::calibration {

/// All that an interrupted calibration needs to go on.
struct Checkpoint {
  std::string question;       ///< configuration and target: another one cannot be gone on with
  std::vector<Start> starts;  ///< that have ended
  std::vector<Iteration> iterations;
  FitState state;  ///< of the one under way
  double seconds = 0.0;
  std::vector<io::Builder> builders;  ///< of terrane, that have worked on it, the last one last
};

/// Throws IoError.
void write_checkpoint(const Checkpoint& checkpoint, const std::filesystem::path& file);
/// Throws InputError when the file is none of ours.
Checkpoint read_checkpoint(const std::filesystem::path& file);

}  // namespace geo::calibration
