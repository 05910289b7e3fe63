#pragma once

#include <algorithm>
#include <array>

namespace geo {

/// A column of crust.
struct CrustColumn {
  double elevation_m, thickness_m, density_kg_m3;
};

/// What crust is like under ground of a height (tectonics.js): abyss, deep ocean, shallow
/// ocean, shelf, land, mountains.
inline constexpr std::array<CrustColumn, 6> kCrustColumns{{{-11000.0, 3000.0, 3000.0},
                                                           {-6000.0, 6300.0, 3000.0},
                                                           {-3680.0, 7900.0, 2890.0},
                                                           {-200.0, 17000.0, 2700.0},
                                                           {840.0, 36900.0, 2700.0},
                                                           {8848.0, 70000.0, 2700.0}}};

/// The column at an elevation, linear between the points above and constant beyond them.
[[nodiscard]] inline CrustColumn crust_column(double elevation_m) {
  if (elevation_m <= kCrustColumns.front().elevation_m) return kCrustColumns.front();
  for (std::size_t k = 1; k < kCrustColumns.size(); ++k) {
    const CrustColumn &low = kCrustColumns[k - 1], &high = kCrustColumns[k];
    if (elevation_m > high.elevation_m) continue;
    const double t = (elevation_m - low.elevation_m) / (high.elevation_m - low.elevation_m);
    return {elevation_m, low.thickness_m + t * (high.thickness_m - low.thickness_m),
            low.density_kg_m3 + t * (high.density_kg_m3 - low.density_kg_m3)};
  }
  return kCrustColumns.back();
}

/// How much of a continent that column is, 0 to 1: all of it from the shelf up, nothing from the
/// shallow ocean down, as its density between them has it.
[[nodiscard]] inline double continental_share_of(const CrustColumn& column) {
  constexpr double kOcean = kCrustColumns[2].density_kg_m3, kShelf = kCrustColumns[3].density_kg_m3;
  return std::clamp((kOcean - column.density_kg_m3) / (kOcean - kShelf), 0.0, 1.0);
}

}  // namespace geo
