#include "geo/io/input/reconstruction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "geo/core/error.hpp"
#include "geo/io/input/plate_outlines.hpp"
#include "geo/io/input/rotation_file.hpp"

namespace geo::io {
namespace {

constexpr std::size_t kMostDrivenPlates = 1000;
constexpr double kSameTime_myr = 1e-6;

class Reconstruction {
 public:
  Reconstruction(const std::string& polygons, const std::string& rotations)
      : polygons_(polygons), outlines_(read_dated_outlines(polygons)) {
    motion_.source = rotations;
    motion_.rotations = read_rotations(rotations);
  }

  GivenReconstruction between(double start_ma, double drift_myr) {
    set_time(start_ma, drift_myr);
    take_first_plates();
    take_later_plates(motion_.start_ma - drift_myr);
    return {std::move(plates_), std::move(motion_)};
  }

 private:
  void set_time(double start_ma, double drift_myr) {
    double youngest = std::numeric_limits<double>::infinity(), oldest = -youngest;
    for (const RotationSequence& sequence : motion_.rotations.sequences()) {
      youngest = std::min(youngest, sequence.rotations.front().time_ma);
      oldest = std::max(oldest, sequence.rotations.back().time_ma);
    }
    motion_.youngest_ma = youngest;
    motion_.start_ma = start_ma > 0.0 ? start_ma : youngest + drift_myr;
    const double end_ma = motion_.start_ma - drift_myr;
    if (motion_.start_ma <= oldest + kSameTime_myr && end_ma >= youngest - kSameTime_myr) return;
    throw InputError(
        fmt::format("{}: rotations are from {:g} to {:g} Ma: must reach over the drift, from {:g} "
                    "to {:g} Ma (fields.rotations_age_myr, plates.sphere.time_myr)",
                    motion_.source, oldest, youngest, motion_.start_ma, end_ma));
  }

  /// Refuses polygons of a plate that no circuit leads to.
  void check_rotations(const DatedOutline& outline, double time_ma) const {
    if (motion_.rotations.at(outline.plate, time_ma)) return;
    const auto known = motion_.rotations.plates();
    const bool has_some = std::binary_search(known.begin(), known.end(), outline.plate);
    throw InputError(
        fmt::format("{}: plate {} has no rotation {}in {}", outline.where, outline.plate,
                    has_some ? fmt::format("that leads to plate 000 at {:g} Ma ", time_ma) : "",
                    motion_.source));
  }

  /// Rings of all polygons of a plate that are valid at a time, under the name of the first.
  [[nodiscard]] PlateOutline outline_of(int plate, double time_ma) const {
    PlateOutline whole;
    for (const DatedOutline& part : outlines_) {
      if (part.plate != plate || !part.is_valid_at(time_ma)) continue;
      if (whole.rings.empty()) whole.name = part.outline.name;
      whole.rings.insert(whole.rings.end(), part.outline.rings.begin(), part.outline.rings.end());
    }
    return whole;
  }

  void take_first_plates() {
    const double start_ma = motion_.start_ma;
    for (const DatedOutline& outline : outlines_) {
      if (!outline.is_valid_at(start_ma) || !taken_.insert(outline.plate).second) continue;
      check_rotations(outline, start_ma);
      plates_.push_back(outline_of(outline.plate, start_ma));
      motion_.first.push_back(outline.plate);
    }
    if (plates_.size() >= 2 && plates_.size() <= kMostDrivenPlates) return;
    throw InputError(fmt::format("{}: has polygons of {} plate{} at {:g} Ma: must have 2 to {}",
                                 polygons_, plates_.size(), plates_.size() == 1 ? "" : "s",
                                 start_ma, kMostDrivenPlates));
  }

  void take_later_plates(double end_ma) {
    std::vector<const DatedOutline*> later;
    for (const DatedOutline& outline : outlines_) {
      if (outline.from_ma < motion_.start_ma && outline.from_ma > end_ma) later.push_back(&outline);
    }
    std::stable_sort(later.begin(), later.end(),
                     [](const auto* a, const auto* b) { return a->from_ma > b->from_ma; });
    for (const DatedOutline* outline : later) {
      if (!taken_.insert(outline->plate).second) continue;
      check_rotations(*outline, outline->from_ma);
      motion_.later.push_back(
          {outline->plate, outline->from_ma, outline_of(outline->plate, outline->from_ma)});
    }
    if (taken_.size() <= kMostDrivenPlates) return;
    throw InputError(fmt::format("{}: has polygons of {} plates: must have 2 to {}", polygons_,
                                 taken_.size(), kMostDrivenPlates));
  }

  const std::string& polygons_;
  std::vector<DatedOutline> outlines_;
  std::set<int> taken_;
  std::vector<PlateOutline> plates_;
  PlateReconstruction motion_;
};

}  // namespace

GivenReconstruction read_reconstruction(const std::string& polygons, const std::string& rotations,
                                        double start_ma, double drift_myr) {
  return Reconstruction(polygons, rotations).between(start_ma, drift_myr);
}

}  // namespace geo::io
