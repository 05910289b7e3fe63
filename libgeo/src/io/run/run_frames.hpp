#pragma once

#include <filesystem>
#include <vector>

#include "geo/core/state.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/run_folder.hpp"
#include "io/report/report_globe.hpp"

namespace geo::io {

/// The files of the frames of a run through time that are there, the earliest first; none where it
/// has none. Frames of an earlier run in the same folder are not among them.
[[nodiscard]] std::vector<std::filesystem::path> frame_files(const RunFolder& folder,
                                                             const Manifest& manifest);
/// The time in the name of one of them, as it is written there: "0050.00".
[[nodiscard]] std::string time_in_name(const std::filesystem::path& frame);
/// The elevation of some frames, the first and the last among them.
[[nodiscard]] std::vector<GlobeFrame> globe_frames(const RunFolder& folder,
                                                   const Manifest& manifest);

}  // namespace geo::io
