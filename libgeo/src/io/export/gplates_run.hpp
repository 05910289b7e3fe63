#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geo/io/netcdf/stage_file.hpp"
#include "geo/kernels/plates/rotation_model.hpp"
#include "gplates_features.hpp"

namespace geo::io {

/// Number of a plate in files for GPlates, of plate 0. GPlates keeps 0 for the absolute frame, and
/// 999 for comments.
inline constexpr int kFirstGplatesNumber = 1000;

/// What a planet was like at one time.
struct GplatesFrame {
  Snapshot fields;
  double from_ma = 0.0, to_ma = 0.0;  ///< while it stands for the planet
};

/// The plates of a run, through time where they drifted.
class GplatesRun {
 public:
  /// Reads what a run in this folder says of its plates: the tables of their lives and rotations,
  /// or, of a model without time, the rotations that its velocities tell, as of the last Myr.
  /// Throws ConfigurationError where it is no run, or one without plates that move; InputError,
  /// IoError.
  explicit GplatesRun(const std::filesystem::path& folder);

  [[nodiscard]] const RotationModel& rotations() const { return rotations_; }
  /// Of each sequence of the rotations.
  [[nodiscard]] const std::vector<std::string>& comments() const { return comments_; }
  /// From the first one on; the last one is the present.
  [[nodiscard]] std::size_t frames() const { return files_.size(); }
  [[nodiscard]] GplatesFrame frame(std::size_t k) const;
  /// When a plate, by its number in the run, ended; 0 where it is there today.
  [[nodiscard]] double ended_ma(int plate) const;

 private:
  struct FrameFile {
    std::filesystem::path path;
    double time_ma;
  };
  void read_history(const std::filesystem::path& folder, const std::filesystem::path& rotations,
                    const std::filesystem::path& lives);
  void find_frames(const std::filesystem::path& folder, const std::vector<std::string>& files);
  void read_velocities(const std::filesystem::path& present);

  RotationModel rotations_;
  std::vector<std::string> comments_;
  std::vector<FrameFile> files_;
  std::vector<PlateSpan> spans_;
  std::vector<double> times_myr_;  // ends of steps
  double end_myr_ = 0.0;
};

/// The features of a frame, in the place where its crust is today.
struct GplatesLayers {
  GplatesFeatures plates, boundaries, coastlines, continents, isochrons;
};
/// Adds those of one frame.
void add_layers(const GplatesRun& run, const GplatesFrame& frame, GplatesLayers& layers);

}  // namespace geo::io
