#include "margins_crust.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/kernels/cubic_rows.hpp"
#include "geo/kernels/shapes.hpp"
#include "swell.hpp"

namespace geo {
namespace {

/// What the columns of a row see of the coarse grid.
constexpr std::array kSeen{
    &Tectonics::thickening,  &Tectonics::arc,         &Tectonics::trench_m,
    &Tectonics::divergent,   &Tectonics::transform,   &Tectonics::weakness,
    &Tectonics::rift_km,     &Tectonics::offshore_km, &Tectonics::inland_km,
    &Tectonics::swell_m,     &Tectonics::relict,      &Tectonics::thickness_noise_km,
    &Tectonics::ocean_swell, &Tectonics::flexure_m};

/// Columns of continent and of ocean floor, and what stands where they blend.
class Columns {
 public:
  explicit Columns(const Crust& crust)
      : crust_(crust),
        p_(crust.parameters),
        is_dry_(p_.compensation == "airy-dry"),
        craton_slope_((1.0 - p_.density.continental_crust / p_.density.mantle) /
                      (1e-3 * AiryDatum::kColdLithosphereM)),
        land_(crust.seed, "isostasy.land", crust.radius_km, 420.0, 7, 0.52),
        ranges_(crust.seed, "isostasy.ranges", crust.radius_km, 230.0, 4, 0.55),
        hills_(crust.seed, "isostasy.hills", crust.radius_km, 260.0, 6, 0.6),
        mounts_(crust.seed, "isostasy.seamounts", crust.radius_km, 330.0, 3, 0.6) {}

  /// Scratch of one thread: what the coarse grid and the noise say along a row.
  class Row {
   public:
    explicit Row(const Columns& columns)
        : nx(columns.crust_.grid.nx()),
          land(columns.land_, nx),
          ranges(columns.ranges_, nx),
          hills(columns.hills_, nx),
          mounts(columns.mounts_, nx),
          noise_(columns.crust_.grid) {
      for (const auto seen : kSeen) (from_afar.*seen).resize(nx);
    }
    void read(const Crust& crust, const CubicRows& rows, const Tectonics& tectonics, int j) {
      for (const auto seen : kSeen) rows.read(tectonics.*seen, j, from_afar.*seen, scratch_);
      const std::span<const float> share = crust.fraction.subspan(crust.grid.cell(0, j), nx);
      const auto& t = from_afar;
      noise_.choose(j, [&](int i) { return is_rough(share[i], t.arc[i]); });
      land.read(noise_);
      noise_.choose(
          j, [&](int i) { return share[i] > 0.0F && is_folded(t.thickening[i], t.relict[i]); });
      ranges.read(noise_);
      noise_.choose(j, [&](int i) { return share[i] < 1.0F; });
      hills.read(noise_);
      mounts.read(noise_);
    }

    int nx;
    Tectonics from_afar;
    Swell::Line land, ranges, hills, mounts;

   private:
    NoiseRow noise_;
    std::vector<float> scratch_;
  };

  void draw(int j, const Row& row) const {
    for (int i = 0; i < row.nx; ++i) draw(i, j, row);
  }

 private:
  static bool is_rough(double share, double island) { return share > 0.0 || island > 0.02; }
  static bool is_folded(double belt, double relict) { return belt > 0.01 || relict > 0.02; }

  struct Continent {
    double thickness_km = 0.0, elevation_m = 0.0;
  };

  void draw(int i, int j, const Row& along) const {
    const Tectonics& row = along.from_afar;
    const Index cell = crust_.grid.cell(i, j);
    const double share = crust_.fraction[cell];
    const double belt = std::clamp(static_cast<double>(row.thickening[i]), 0.0, 1.3);
    const double island = std::max(0.0F, row.arc[i]);
    const double hot = p_.heat_m * crust_.heat[cell];
    crust_.convergent[cell] =
        static_cast<float>(std::clamp(share * belt + (1 - share) * island, 0.0, 1.0));
    crust_.divergent[cell] = std::clamp(row.divergent[i], 0.0F, 1.0F);
    crust_.transform[cell] = std::clamp(row.transform[i], 0.0F, 1.0F);
    crust_.weakness[cell] = std::clamp(row.weakness[i], 0.0F, 1.0F);

    const double rough = is_rough(share, island) ? along.land[i] : 0.0;
    Continent land{p_.continental_km, 0.0};
    if (share > 0.0) land = continent(i, along, belt, hot, rough);
    const bool made = !crust_.made_elevation_m.empty();
    if (made) {
      draw_made(i, cell, along, {share, belt, island, hot, rough});
      return;
    }
    double floor_m = 0.0;
    if (share < 1.0) {
      floor_m = sea_floor_m(i, along, crust_.age_myr[cell], island, rough) +
                hot * (1.0 - 0.3 * share) - 0.25 * p_.heat_m;
    }
    crust_.thickness_m[cell] = static_cast<float>(
        1e3 * std::clamp(p_.oceanic_km + (land.thickness_km - p_.oceanic_km) * share +
                             p_.arc_km * island * (1.0 - share),
                         3.0, 80.0));
    crust_.density[cell] =
        static_cast<float>(p_.density.oceanic_crust +
                           (p_.density.continental_crust - p_.density.oceanic_crust) * share);
    const double trench_m = share > 0.0 ? row.trench_m[i] * 0.5 * share : 0.0;
    crust_.elevation_m[cell] = static_cast<float>(floor_m + (land.elevation_m - floor_m) * share +
                                                  trench_m + row.flexure_m[i]);
  }

  /// A column whose height and thickness plates have made: on top come what is finer than their
  /// samples, sediment, trenches and warped margins.
  struct Setting {
    double share, belt, island, hot, rough;
  };
  void draw_made(int i, Index cell, const Row& along, const Setting& at) const {
    const Tectonics& row = along.from_afar;
    const double land_m = 0.6 * row.swell_m[i];
    const double tilt_m = p_.margin_tilt_m * std::exp(-row.inland_km[i] / p_.margin_tilt_km);
    const double relief_m =
        p_.land_roughness_m * (1.0 + 3.0 * at.belt + 1.5 * row.relict[i]) * at.rough;
    const double on_land_m = land_m - tilt_m + relief_m + 0.6 * at.hot;
    const double at_sea_m =
        at.share < 1.0 ? floor_cover_m(i, along, crust_.age_myr[cell]) + at.hot - 0.25 * p_.heat_m
                       : 0.0;
    crust_.density[cell] =
        static_cast<float>(p_.density.oceanic_crust +
                           (p_.density.continental_crust - p_.density.oceanic_crust) * at.share);
    // Roots of cratons that their lithosphere weighs down: they do not show in the relief.
    const double root_m = 1e3 * p_.craton_compensation * row.thickness_noise_km[i] * at.share;
    crust_.thickness_m[cell] =
        std::clamp(crust_.thickness_m[cell] + static_cast<float>(root_m), 3000.0F, 80000.0F);
    crust_.elevation_m[cell] =
        static_cast<float>(crust_.made_elevation_m[cell] + on_land_m * at.share +
                           at_sea_m * (1.0 - at.share) + row.trench_m[i] * (1.0 - 0.5 * at.share));
  }

  [[nodiscard]] Continent continent(int i, const Row& along, double belt, double hot,
                                    double rough) const {
    const Tectonics& row = along.from_afar;
    const double noise_km = row.thickness_noise_km[i], relict = row.relict[i];
    const double fabric = is_folded(belt, relict) ? along.ranges[i] : 0.0;
    const double thickness_km =
        p_.continental_km + noise_km + p_.collision_km * (belt * (1.0 + 0.16 * fabric)) +
        p_.relict_km * (relict * (1.0 + 0.3 * fabric)) + p_.transpression_km * row.transform[i] -
        p_.rift_km * 0.35 * row.divergent[i];
    // Thick cratons have thick, heavy roots; belts are warm.
    const double lithosphere =
        p_.lithosphere + p_.craton_compensation * craton_slope_ * noise_km - 0.12 * belt;
    const double valley_m = row.divergent[i] * (-1500.0 * bell(row.rift_km[i], 0.0, 38.0) +
                                                900.0 * bell(row.rift_km[i], 95.0, 55.0));
    const double relief_m = p_.land_roughness_m * (1.0 + 3.0 * belt + 1.5 * relict);
    const double elevation_m = balanced(crust_.datum.dry_elevation_m(
                                   1e3 * thickness_km, p_.density.continental_crust, lithosphere)) +
                               row.swell_m[i] + valley_m + relief_m * rough + hot * 0.6 -
                               p_.margin_tilt_m * std::exp(-row.inland_km[i] / p_.margin_tilt_km);
    return {thickness_km, elevation_m};
  }

  /// Floor as deep as it is old, under its sediment, with hills, seamounts, arcs and trenches.
  [[nodiscard]] double sea_floor_m(int i, const Row& along, double age_myr, double island,
                                   double rough) const {
    const Tectonics& row = along.from_afar;
    return -ocean_depth_m(std::min(age_myr, 200.0)) + floor_cover_m(i, along, age_myr) +
           island * (2600.0 + 1500.0 * rough) + row.trench_m[i];
  }
  /// Sediment, swells, hills and seamounts on a floor.
  [[nodiscard]] double floor_cover_m(int i, const Row& along, double age_myr) const {
    const Tectonics& row = along.from_afar;
    const double in_trench = std::clamp(-row.trench_m[i] / 1500.0, 0.0, 1.0);
    const double sediment_m =
        deep_sediment_m(p_.sediment, age_myr, row.offshore_km[i]) * (1.0 - 0.6 * in_trench);
    const double buried = 1.0 / (1.0 + sediment_m / 700.0);
    const double mount = std::max(0.0, along.mounts[i] - 1.9);
    return crust_.datum.rise_per_sediment() * sediment_m + p_.ocean_swell_m * row.ocean_swell[i] +
           p_.seafloor_roughness_m * buried * along.hills[i] + p_.seamount_m * std::min(1.5, mount);
  }

  /// A dry column under the sea, whose water loads it unless the compensation is dry.
  [[nodiscard]] double balanced(double dry_m) const {
    return is_dry_ ? dry_m : crust_.datum.loaded(dry_m);
  }

  const Crust& crust_;
  const IsostasyParameters& p_;
  bool is_dry_;
  double craton_slope_;
  Swell land_, ranges_, hills_, mounts_;
};

}  // namespace

void draw_margins_crust(const Crust& crust, const CoarseGrid& coarse, const Tectonics& tectonics) {
  const CubicRows rows(coarse.grid(), crust.grid);
  const Columns columns(crust);
#pragma omp parallel
  {
    Columns::Row row(columns);
#pragma omp for schedule(dynamic, 4)
    for (int j = 0; j < crust.grid.ny(); ++j) {
      row.read(crust, rows, tectonics, j);
      columns.draw(j, row);
    }
  }
}

}  // namespace geo
