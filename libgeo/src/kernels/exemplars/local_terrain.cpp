#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geo/core/field.hpp"
#include "geo/core/tangent_frame.hpp"
#include "geo/kernels/exemplars/exemplar_detail.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegrees = 180.0 / kPi;

Centre position_of(const Vector3& unit) {
  return {kDegrees * std::asin(std::clamp(unit[2], -1.0, 1.0)),
          kDegrees * std::atan2(unit[1], unit[0])};
}

Index cell_at(const Grid& planet, const Vector3& unit) {
  const Centre at = position_of(unit);
  const auto column = static_cast<int>((at.longitude_deg / 360.0 + 0.5) * planet.nx());
  const auto row = static_cast<int>((at.latitude_deg / 180.0 + 0.5) * planet.ny());
  return planet.cell(std::clamp(column, 0, planet.nx() - 1), std::clamp(row, 0, planet.ny() - 1));
}

/// 5 x 5 places a cell apart about one, and what weight each has.
constexpr int kAcross = 5, kPlaces = kAcross * kAcross;
constexpr double weight_of(int place) {
  constexpr std::array<double, kAcross> kBinomial{1.0, 4.0, 6.0, 4.0, 1.0};
  return kBinomial[place % kAcross] * kBinomial[place / kAcross] / 256.0;
}

Terrain terrain_of(const TerrainGuide& guide, Index cell, double slope) {
  if (slope < guide.plain_slope) return Terrain::plain;
  const auto type = guide.orogeny_type.empty() ? OrogenyType::none
                                               : static_cast<OrogenyType>(guide.orogeny_type[cell]);
  if (type == OrogenyType::none) return Terrain::old_mountains;
  // Not a number where nothing was ever folded.
  if (!guide.orogeny_age_myr.empty() && !(guide.orogeny_age_myr[cell] < guide.old_myr)) {
    return Terrain::old_mountains;
  }
  return type == OrogenyType::andean ? Terrain::andean : Terrain::himalayan;
}

/// Sums of cos and sin of twice an angle, and of the weights.
struct Doubled {
  double cosine = 0.0, sine = 0.0, weight = 0.0;
  void add(double east, double north, double w) {
    cosine += w * (east * east - north * north);
    sine += w * 2.0 * east * north;
    weight += w * (east * east + north * north);
  }
  [[nodiscard]] double strength() const {
    return weight > 0.0 ? std::hypot(cosine, sine) / weight : 0.0;
  }
  [[nodiscard]] double angle() const { return 0.5 * std::atan2(sine, cosine); }
};

}  // namespace

LocalTerrain look_around(const Grid& planet, const TerrainGuide& guide, const Vector3& unit,
                         double spacing_m) {
  const TangentFrame frame = tangent_frame(unit);
  const double step = spacing_m / planet.figure().radius_m;
  std::array<Index, kPlaces> cell;
  std::array<double, kPlaces> z;
  for (int k = 0; k < kPlaces; ++k) {
    const double east = step * (k % kAcross - kAcross / 2);
    const double north = step * (k / kAcross - kAcross / 2);
    cell[k] = cell_at(planet, normalised(add(add(unit, frame.east, east), frame.north, north)));
    z[k] = std::max(0.0, static_cast<double>(guide.elevation_m[cell[k]]));
  }
  Doubled level, folds;
  double bumps = 0.0, slopes = 0.0, weights = 0.0;
  for (int j = 1; j + 1 < kAcross; ++j) {
    for (int i = 1; i + 1 < kAcross; ++i) {
      const int k = j * kAcross + i;
      const double w = weight_of(k);
      const double gx = (z[k + 1] - z[k - 1]) / (2.0 * spacing_m);
      const double gy = (z[k + kAcross] - z[k - kAcross]) / (2.0 * spacing_m);
      const double bump_x = z[k] - 0.5 * (z[k + 1] + z[k - 1]);
      const double bump_y = z[k] - 0.5 * (z[k + kAcross] + z[k - kAcross]);
      level.add(-gy, gx, w);
      slopes += w * (gx * gx + gy * gy);
      bumps += w * 0.5 * (bump_x * bump_x + bump_y * bump_y);
      weights += w;
    }
  }
  LocalTerrain local;
  local.roughness_m = std::sqrt(bumps / weights);
  const double slope = std::sqrt(slopes / weights);
  const bool given = !guide.fold_east.empty() && !guide.fold_north.empty();
  for (int k = 0; k < kPlaces; ++k) {
    const double w = weight_of(k);
    local.share[static_cast<std::size_t>(terrain_of(guide, cell[k], slope))] += w;
    if (!given) continue;
    const double east = guide.fold_east[cell[k]], north = guide.fold_north[cell[k]];
    // East and north of the cell, seen from here: they turn near the poles.
    const Centre there = planet.position(planet.column(cell[k]), planet.row(cell[k]));
    const double longitude = there.longitude_deg / kDegrees,
                 latitude = there.latitude_deg / kDegrees;
    const TangentFrame other =
        tangent_frame({std::cos(latitude) * std::cos(longitude),
                       std::cos(latitude) * std::sin(longitude), std::sin(latitude)});
    const Vector3 fold = add(scaled(other.east, east), other.north, north);
    folds.add(dot(fold, frame.east), dot(fold, frame.north), w);
  }
  constexpr double kSure = 0.3, kFolded = 0.05;
  const bool sure = folds.weight > kFolded && folds.strength() > kSure;
  if (!sure) {
    local.fold_rad = level.angle();
  } else if (guide.level_weight > 0.0 && level.weight > 0.0) {
    Doubled both = folds;
    const double weight = guide.level_weight * folds.weight / level.weight;
    both.cosine += weight * level.cosine;
    both.sine += weight * level.sine;
    local.fold_rad = both.angle();
  } else {
    local.fold_rad = folds.angle();
  }
  return local;
}

}  // namespace geo
