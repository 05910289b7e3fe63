#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "geo/io/files/atomic_file.hpp"
#include "gplates_features.hpp"

namespace geo::io {
namespace {

/// "1003 24.0 -31.05… 108.91… 7.68… 000": as exact as positions to a micrometre.
std::string line_of(const RotationSequence& sequence, const FiniteRotation& sample,
                    const std::string& comment) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const Vector3 r = rotation_vector(sample.rotation);
  const double latitude_deg = kDegrees * std::atan2(r[2], std::hypot(r[0], r[1]));
  const double longitude_deg = kDegrees * std::atan2(r[1], r[0]);
  return fmt::format("{:03d} {} {:.13f} {:.13f} {:.13f} {:03d} !{}\n", sequence.moving,
                     sample.time_ma, latitude_deg, longitude_deg, kDegrees * length(r),
                     sequence.fixed, comment);
}

}  // namespace

void write_rotations(const std::filesystem::path& path, const RotationModel& model,
                     const std::vector<std::string>& comment_of) {
  std::string text;
  for (std::size_t k = 0; k < model.sequences().size(); ++k) {
    const RotationSequence& sequence = model.sequences()[k];
    for (const FiniteRotation& sample : sequence.rotations) {
      text += line_of(sequence, sample, comment_of[k]);
    }
  }
  write_text_file(path, text);
}

}  // namespace geo::io
