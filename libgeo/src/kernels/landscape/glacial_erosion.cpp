#include "geo/kernels/landscape/glacial_erosion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geo/core/error.hpp"
#include "geo/kernels/water/valley_width.hpp"
#include "ice_regions.hpp"

namespace geo {
namespace {

constexpr float kBesideSea_m = 1.0F;

class Bed {
 public:
  Bed(const Grid& grid, const GlacialErosion& law, const IceSurface& surface,
      std::span<const float> sunk_m, std::span<float> elevation_m)
      : grid_(grid),
        law_(law),
        surface_(surface),
        outflow_(grid, surface),
        sunk_m_(sunk_m),
        z_(elevation_m) {}

  [[nodiscard]] double sunk(Index cell) const { return sunk_m_.empty() ? 0.0 : sunk_m_[cell]; }

  /// Lowest bed that the ice can cut here, given those downstream.
  [[nodiscard]] double floor_m(Index cell) const {
    const double s = surface_.height_m.of(cell);
    double floor = -1e9;
    bool meets_sea = false;
    outflow_.visit(cell, [&](Index to, double) {
      meets_sea = meets_sea || z_[to] < 0.0F;
      const double fall = std::max(0.0, s - surface_.height_m.of(to));
      floor = std::max(floor, z_[to] - sunk(to) - law_.overdeepening * fall + sunk(cell));
    });
    // Ice floats where (s - b) rho_i = -b rho_w, b the bed as it is sunk.
    const double afloat = -s * law_.density_ratio / (1.0 - law_.density_ratio);
    floor = std::max(floor, afloat + sunk(cell));
    return meets_sea ? floor : std::max(floor, double{kBesideSea_m});
  }

  /// Returns the height that was taken.
  double cut(Index cell, double through_m3_yr, double share, double time_yr) {
    const float before = z_[cell];
    const double h = surface_.height_m.of(cell) - (before - sunk(cell));
    if (!(h > 0.0)) return 0.0;
    const double room = before - floor_m(cell);
    if (!(room > 0.0)) return 0.0;
    const double valley_m = valley_width_m(grid_, grid_.row(cell));
    const double width_m =
        std::min(valley_m, law_.trough_m * std::pow(through_m3_yr, law_.trough_exponent));
    const double q = through_m3_yr / width_m;
    const double deeper = std::sqrt(h * h + 2.0 * law_.abrasion * q * time_yr) - h;
    z_[cell] = static_cast<float>(before - std::min(room, share * deeper));
    return static_cast<double>(before) - z_[cell];
  }

 private:
  const Grid& grid_;
  const GlacialErosion& law_;
  const IceSurface& surface_;
  IceOutflow outflow_;
  std::span<const float> sunk_m_;
  std::span<float> z_;
};

/// Down the ice of a region. In its cells stays what melts out beyond its till; returns what leaves
/// it.
MarginInflow carry_debris(const Grid& grid, const GlacialErosion& law, const IceSurface& surface,
                          const IceFlux& flux, std::span<const IceGround> ground,
                          std::span<const Index> cells, std::span<float> elevation_m,
                          SparseValues<double>& debris_m3) {
  MarginInflow out;
  const IceOutflow outflow(grid, surface);
  for (auto at = cells.rbegin(); at != cells.rend(); ++at) {
    const Index cell = *at;
    const double carried = debris_m3.of(cell);
    if (!(carried > 0.0)) continue;
    double let_out = flux.melted.of(cell) * carried;
    if (!(flux.through_m3_yr.of(cell) > 0.0)) let_out = carried;
    const double goes_on = carried - let_out;
    if (elevation_m[cell] >= 0.0F) {
      const double area_m2 = grid.area_m2(grid.row(cell));
      const float before = elevation_m[cell];
      elevation_m[cell] +=
          static_cast<float>(std::min(law.most_till_m, law.till_share * let_out / area_m2));
      let_out -= area_m2 * (static_cast<double>(elevation_m[cell]) - before);
    }
    debris_m3.of(cell) = let_out;
    if (goes_on <= 0.0) continue;
    outflow.visit(cell, [&](Index to, double part) {
      if (ground[to] == IceGround::away) {
        out.emplace_back(to, part * goes_on);
      } else {
        debris_m3.of(to) += part * goes_on;
      }
    });
  }
  return out;
}

}  // namespace

SparseValues<double> erode_under_ice(const Grid& grid, const GlacialErosion& law, double time_yr,
                                     const IceSurface& surface, const IceFlux& flux,
                                     std::span<const IceGround> ground,
                                     std::span<const float> sunk_m, std::span<float> elevation_m) {
  const auto size = static_cast<std::size_t>(grid.size());
  if (elevation_m.size() != size || ground.size() != size || flux.share.cells() != grid.size() ||
      surface.height_m.cells() != grid.size() || (!sunk_m.empty() && sunk_m.size() != size)) {
    throw InputError(fmt::format("glacial erosion: fields must have {} values each", size));
  }
  SparseValues<double> debris_m3(surface.height_m.set());
  Bed bed(grid, law, surface, sunk_m, elevation_m);
  std::vector<MarginInflow> out(surface.region_begins.size());
  visit_regions(surface.region_begins, [&](std::size_t region) {
    const std::span<const Index> cells = cells_of(surface, region);
    for (const Index cell : cells) {
      const float share = flux.share.of(cell);
      if (ground[cell] != IceGround::iced || !(share > 0.0F)) continue;
      debris_m3.of(cell) =
          grid.area_m2(grid.row(cell)) * bed.cut(cell, flux.through_m3_yr.of(cell), share, time_yr);
    }
    out[region] = carry_debris(grid, law, surface, flux, ground, cells, elevation_m, debris_m3);
  });
  for (const MarginInflow& inflow : out) {
    for (const auto& [to, part_m3] : inflow) debris_m3.of(to) += part_m3;
  }
  return debris_m3;
}

}  // namespace geo
