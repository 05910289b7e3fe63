#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/checkpoint.hpp"
#include "geo/io/config/run_settings.hpp"
#include "geo/io/files/background_writer.hpp"
#include "geo/io/netcdf/stage_file.hpp"

namespace geo::io {

/// Frames of a stage that runs through time: frames/STAGE-0050.00.nc and .vti, and STAGE.pvd, which
/// lists them with their times.
class FrameFiles {
 public:
  FrameFiles(const std::filesystem::path& folder, const RunSettings& settings)
      : folder_(folder), settings_(settings) {}

  /// Queues the files of one frame of a stage. Must outlive the queue.
  void write(BackgroundWriter& writer, std::string_view stage, Frame frame, Provenance provenance);
  /// Names of what was written since the last call, below the folder of the run. For jobs of the
  /// queue.
  [[nodiscard]] std::vector<std::string> take_written();

 private:
  std::filesystem::path folder_;
  const RunSettings& settings_;
  std::vector<std::filesystem::path> listed_;
  std::vector<double> times_;
  std::vector<std::string> written_;
  std::string collection_;  ///< name of the file that lists them
};

}  // namespace geo::io
