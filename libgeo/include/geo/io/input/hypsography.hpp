#pragma once

#include <string>

#include "geo/core/stage.hpp"

namespace geo::io {

/// A distribution of elevations: "earth" (ETOPO5), "earth-statistical" (71 % normal about -4019 m,
/// deviation 1113 m, and 29 % about 797 m, deviation 1169 m), or a CSV file with a header line
/// `quantile,elevation_m` and rows that ascend from quantile 0 to 1. Errors name file and line.
/// Throws InputError, IoError.
[[nodiscard]] Hypsography read_hypsography(const std::string& name_or_file);

/// Share of the area below 0 m.
[[nodiscard]] double ocean_share_of(const Hypsography& curve);

/// The curve with its parts below and above 0 m stretched so that `share` of the area lies below.
/// 0 and 1 leave one of them. A curve that has but one part, and so no sea level of its own, is
/// moved as a whole until `share` lies below; it stays as it is where 0 or 1 asks for that part.
[[nodiscard]] Hypsography with_ocean_share(Hypsography curve, double share);

}  // namespace geo::io
