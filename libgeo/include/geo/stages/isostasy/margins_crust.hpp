#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/numerics/shapes.hpp"
#include "geo/kernels/remapping/cubic_rows.hpp"
#include "geo/stages/isostasy/tectonics.hpp"
#include "geo/stages/isostasy/unit_noise.hpp"

namespace geo {

/// Columns of continent and of ocean floor, and what stands where they blend.
template <class V>
class Columns {
 public:
  using Number = Arithmetic<V>;

  explicit Columns(const Crust<V>& crust)
      : crust_(crust),
        p_(crust.active, crust.parameters),
        density_(crust.densities()),
        datum_(crust.datum()),
        is_dry_(crust.parameters.compensation == "airy-dry"),
        craton_slope_((1.0 - density_.continental_crust / density_.mantle) /
                      (1e-3 * AiryDatum::kColdLithosphereM)),
        land_(crust.unit_noise("isostasy.land", 420.0, 7, 0.52)),
        ranges_(crust.unit_noise("isostasy.ranges", 230.0, 4, 0.55)),
        hills_(crust.unit_noise("isostasy.hills", 260.0, 6, 0.6)),
        mounts_(crust.unit_noise("isostasy.seamounts", 330.0, 3, 0.6)) {}

  /// Scratch of one thread: what the coarse grid and the noise say along a row.
  class Row {
   public:
    explicit Row(const Columns& columns)
        : nx(columns.crust_.grid.nx()),
          land(columns.land_, nx),
          ranges(columns.ranges_, nx),
          hills(columns.hills_, nx),
          mounts(columns.mounts_, nx),
          noise_(columns.crust_.grid) {}
    void read(const Crust<V>& crust, const CubicRows& rows, const TectonicFrame& frame,
              const Tectonics<V>& tectonics, int j) {
      const auto see = [&](const auto& field, auto& line, auto& scratch) {
        line.resize(nx);
        rows.read(field, j, std::span(line), scratch);
      };
      for (const auto seen :
           {&Tectonics<V>::thickening, &Tectonics<V>::shortening_km_myr, &Tectonics<V>::arc,
            &Tectonics<V>::trench_m, &Tectonics<V>::divergent, &Tectonics<V>::transform,
            &Tectonics<V>::weakness, &Tectonics<V>::swell_m, &Tectonics<V>::thickness_noise_km,
            &Tectonics<V>::flexure_m}) {
        see(tectonics.*seen, from_afar.*seen, scratch_);
      }
      see(tectonics.relict, from_afar.relict, plain_scratch_);
      see(tectonics.ocean_swell, from_afar.ocean_swell, plain_scratch_);
      see(frame.rift_km, rift_km, plain_scratch_);
      see(frame.offshore_km, offshore_km, plain_scratch_);
      see(frame.inland_km, inland_km, plain_scratch_);
      const std::span<const float> share = crust.fraction.subspan(crust.grid.cell(0, j), nx);
      const auto& t = from_afar;
      noise_.choose(j, [&](int i) { return is_rough(share[i], value_of(t.arc[i])); });
      land.read(noise_);
      noise_.choose(j, [&](int i) {
        return share[i] > 0.0F && is_folded(value_of(t.thickening[i]), t.relict[i]);
      });
      ranges.read(noise_);
      noise_.choose(j, [&](int i) { return share[i] < 1.0F; });
      hills.read(noise_);
      if (frame.seamounts_m.empty()) {
        mounts.read(noise_);
      } else {
        const auto first = static_cast<std::size_t>(crust.grid.cell(0, j));
        seamounts_m = std::span(frame.seamounts_m).subspan(first, nx);
        arc_volcanoes = std::span(frame.arc_volcanoes).subspan(first, nx);
      }
    }

    int nx;
    Tectonics<V> from_afar;
    std::vector<float> rift_km, offshore_km, inland_km;
    UnitNoise::Line land, ranges, hills, mounts;
    std::span<const float> seamounts_m, arc_volcanoes;  // of a margins crust alone

   private:
    NoiseRow noise_;
    std::vector<V> scratch_;
    std::vector<float> plain_scratch_;
  };

  void draw(int j, const Row& row) const {
    for (int i = 0; i < row.nx; ++i) draw(i, j, row);
  }

 private:
  // Where no source is named, values are design, chosen beside the Earth's topography.

  /// Oldest sea floor but for a few remnants [muller2008].
  static constexpr double kOldestFloor_myr = 200.0;
  /// Shares of a column's continent between which its floor passes into the oldest there is.
  static constexpr double kFloor = 0.3, kStretched = 0.5;
  /// Bounds of the thickness of crust, km, somewhat beyond those of the Earth's [laske2013].
  static constexpr double kThinnest_km = 3.0, kThickest_km = 80.0;

  /// Strength of arcs, belts and old belts below which their noise would not show, and is not read.
  static constexpr double kFaintArc = 0.02, kFaintBelt = 0.01, kFaintRelict = 0.02;
  static bool is_rough(double share, double island) { return share > 0.0 || island > kFaintArc; }
  static bool is_folded(double belt, double relict) {
    return belt > kFaintBelt || relict > kFaintRelict;
  }

  /// Share by which ranges and basins within a belt, and within the relict of one, vary its
  /// thickening for each deviation of their noise.
  static constexpr double kRanges = 0.16, kRelictRanges = 0.3;
  /// How much rougher land is in a belt of full strength, and in the relict of one.
  static constexpr double kBeltRoughness = 3.0, kRelictRoughness = 1.5;
  /// What a belt of full strength lacks in lithosphere, over the thickness of a cold one: belts are
  /// warm.
  static constexpr double kWarmBelt = 0.12;
  /// Share of isostasy.rift_km by which crust about a rift of full strength is thinner.
  static constexpr double kYoungRift = 0.35;
  /// The valley of a continental rift of full strength: its depth, and the distance from its axis
  /// in which that falls off; its shoulders, which rise by the load that is taken away
  /// [weissel1989]: their height, distance from the axis and breadth.
  static constexpr double kValley_m = 1500.0, kValley_km = 38.0;
  static constexpr double kShoulder_m = 900.0, kShoulderAway_km = 95.0, kShoulder_km = 55.0;

  /// Share of swells that continents show where plates have made their height, some of it for the
  /// same reason.
  static constexpr double kMadeSwell = 0.6;
  /// Share of the height over warm mantle that thick lithosphere lets through below a continent,
  /// and the share that floor loses as it passes into one.
  static constexpr double kHotLand = 0.6, kHotLost = 0.3;
  /// About the mean of that height, over its largest: taken off floor, whose mean depth by age so
  /// stays.
  static constexpr double kMeanHeat = 0.25;

  /// Height of the ridge of an island arc of full strength above its floor [christensen1995], how
  /// that varies, and the height of one of its volcanoes of middling size, m.
  static constexpr double kArc_m = 3000.0, kArcRoughness_m = 700.0, kVolcanoes_m = 3000.0;
  /// Share of a trench's depth that a continent beside it feels.
  static constexpr double kTrenchOnLand = 0.5;
  /// Depth from which on a trench is as empty of sediment as any, and the share that it lacks: what
  /// comes there goes down with the plate.
  static constexpr double kEmptyTrench_m = 1500.0, kTrenchLacks = 0.6;
  /// Thickness of sediment under which abyssal hills are half as high.
  static constexpr double kBurying_m = 700.0;
  /// Deviations of the noise from which on a seamount stands, so that they are few, and above that
  /// the most that one counts.
  static constexpr double kSeamount = 1.9, kHighestSeamount = 1.5;
  /// Value of isostasy.seamount_m at which volcanoes have their own height.
  static constexpr double kHighestMount_m = 1800.0;

  struct Continent {
    Number thickness_km, elevation_m;
  };

  /// The settings as numbers to compute with.
  struct Settings {
    Settings(const ActiveVariables<V>& active, const IsostasyParameters& p)
        : continental_km(active(p.continental_km)),
          oceanic_km(active(p.oceanic_km)),
          collision_km(active(p.collision_km)),
          arc_km(active(p.arc_km)),
          rift_km(active(p.rift_km)),
          transpression_km(active(p.transpression_km)),
          lithosphere(active(p.lithosphere)),
          craton_compensation(active(p.craton_compensation)),
          ocean_swell_m(active(p.ocean_swell_m)),
          margin_tilt_m(active(p.margin_tilt_m)),
          margin_tilt_km(active(p.margin_tilt_km)),
          relict_km(active(p.relict_km)),
          heat_m(active(p.heat_m)),
          seamount_m(active(p.seamount_m)),
          seafloor_roughness_m(active(p.seafloor_roughness_m)),
          land_roughness_m(active(p.land_roughness_m)),
          sediment{active(p.sediment.early_m), p.sediment.early_time_myr,
                   active(p.sediment.rate_m_myr), active(p.sediment.apron_m),
                   active(p.sediment.apron_length_km)} {}
    Number continental_km, oceanic_km, collision_km, arc_km, rift_km, transpression_km, lithosphere,
        craton_compensation, ocean_swell_m, margin_tilt_m, margin_tilt_km, relict_km, heat_m,
        seamount_m, seafloor_roughness_m, land_roughness_m;
    BasicDeepSediment<Number> sediment;
  };

  void draw(int i, int j, const Row& along) const {
    const Tectonics<V>& row = along.from_afar;
    const Index cell = crust_.grid.cell(i, j);
    const double share = crust_.fraction[cell];
    const Number belt = thickened(row.thickening[i]);
    const Number island = raised_arc(row.arc[i]);
    const Number hot = p_.heat_m * static_cast<double>(crust_.in.heat[cell]);
    crust_.convergent[cell] = V(limited(Number(share * belt + (1 - share) * island), 0.0, 1.0));
    crust_.divergent[cell] = limited(row.divergent[i], 0.0, 1.0);
    crust_.transform[cell] = limited(row.transform[i], 0.0, 1.0);
    crust_.weakness[cell] = limited(row.weakness[i], 0.0, 1.0);
    const Number added_km_myr(greater(V(0.0F), row.shortening_km_myr[i]));
    if (value_of(crust_.run_myr) > 0.0) {
      crust_.thickening_m_yr[cell] = V(Number(1e-3 * share * added_km_myr));
    }

    const double rough = is_rough(share, value_of(island)) ? along.land[i] : 0.0;
    Continent land{p_.continental_km, Number(0.0)};
    if (share > 0.0) land = continent(i, along, belt, added_km_myr, hot, rough);
    if (!crust_.in.made_elevation_m.empty()) {
      return draw_made(i, cell, along, {share, belt, hot, rough});
    }
    Number floor_m(0.0);
    if (share < 1.0) {
      const double age_myr = floor_age_myr(crust_.in.age_myr[cell], share);
      floor_m = sea_floor_m(i, along, age_myr, island, rough) + hot * (1.0 - kHotLost * share) -
                kMeanHeat * p_.heat_m;
      record_sediment(i, along, cell, share, age_myr);
    }
    record_cover(cell, share, value_of(belt), value_of(row.swell_m[i]));
    crust_.thickness_m[cell] =
        V(1e3 * limited(Number(p_.oceanic_km + (land.thickness_km - p_.oceanic_km) * share +
                               p_.arc_km * island * (1.0 - share)),
                        kThinnest_km, kThickest_km));
    crust_.density[cell] =
        V(density_.oceanic_crust + (density_.continental_crust - density_.oceanic_crust) * share);
    Number trench_m(0.0);
    if (share > 0.0) trench_m = Number(row.trench_m[i]) * kTrenchOnLand * share;
    crust_.elevation_m[cell] =
        V(floor_m + (land.elevation_m - floor_m) * share + trench_m + Number(row.flexure_m[i]));
  }

  /// A column whose height and thickness plates have made: on top come what is finer than their
  /// samples, sediment, trenches and warped margins.
  struct Setting {
    double share;
    Number belt, hot;
    double rough;
  };
  void draw_made(int i, Index cell, const Row& along, const Setting& at) const {
    using std::exp;
    const Tectonics<V>& row = along.from_afar;
    const Number tilt_m =
        p_.margin_tilt_m * exp(-static_cast<double>(along.inland_km[i]) / p_.margin_tilt_km);
    const Number bumps_m = p_.land_roughness_m *
                           (1.0 + kBeltRoughness * at.belt + kRelictRoughness * row.relict[i]) *
                           at.rough;
    const Number on_land_m =
        kMadeSwell * Number(row.swell_m[i]) - tilt_m + bumps_m + kHotLand * at.hot;
    Number at_sea_m(0.0);
    if (at.share < 1.0) {
      const double age_myr = crust_.in.age_myr[cell];
      at_sea_m = floor_cover_m(i, along, age_myr) + at.hot - kMeanHeat * p_.heat_m;
      record_sediment(i, along, cell, at.share, age_myr);
    }
    record_cover(cell, at.share, value_of(at.belt), kMadeSwell * value_of(row.swell_m[i]));
    crust_.density[cell] = V(density_.oceanic_crust +
                             (density_.continental_crust - density_.oceanic_crust) * at.share);
    // Roots of cratons that their lithosphere weighs down: they do not show at the surface.
    const Number root_m =
        1e3 * p_.craton_compensation * Number(row.thickness_noise_km[i]) * at.share;
    crust_.thickness_m[cell] =
        limited(V(crust_.thickness_m[cell] + V(root_m)), 1e3 * kThinnest_km, 1e3 * kThickest_km);
    crust_.elevation_m[cell] =
        V(static_cast<double>(crust_.in.made_elevation_m[cell]) + on_land_m * at.share +
          at_sea_m * (1.0 - at.share) + Number(row.trench_m[i]) * (1.0 - kTrenchOnLand * at.share));
  }

  [[nodiscard]] Continent continent(int i, const Row& along, const Number& belt,
                                    const Number& added_km_myr, const Number& hot,
                                    double rough) const {
    using std::exp;
    const Tectonics<V>& row = along.from_afar;
    const Number noise_km = row.thickness_noise_km[i];
    const double relict = row.relict[i];
    const double fabric = is_folded(value_of(belt), relict) ? along.ranges[i] : 0.0;
    const Number thickness_km = p_.continental_km + noise_km +
                                p_.collision_km * (belt * (1.0 + kRanges * fabric)) -
                                to_come_km(p_.collision_km * belt, added_km_myr, crust_.run_myr) +
                                p_.relict_km * (relict * (1.0 + kRelictRanges * fabric)) +
                                p_.transpression_km * Number(row.transform[i]) -
                                p_.rift_km * kYoungRift * Number(row.divergent[i]);
    // Thick cratons have thick, heavy roots; belts are warm.
    const Number lithosphere =
        p_.lithosphere + p_.craton_compensation * craton_slope_ * noise_km - kWarmBelt * belt;
    const Number valley_m = Number(row.divergent[i]) *
                            (-kValley_m * bell(along.rift_km[i], 0.0, kValley_km) +
                             kShoulder_m * bell(along.rift_km[i], kShoulderAway_km, kShoulder_km));
    const Number rise_m =
        p_.land_roughness_m * (1.0 + kBeltRoughness * belt + kRelictRoughness * relict);
    const Number elevation_m =
        balanced(
            datum_.dry_elevation_m(1e3 * thickness_km, density_.continental_crust, lithosphere)) +
        Number(row.swell_m[i]) + valley_m + rise_m * rough + hot * kHotLand -
        p_.margin_tilt_m * exp(-static_cast<double>(along.inland_km[i]) / p_.margin_tilt_km);
    return {thickness_km, elevation_m};
  }

  /// Age of the floor that a column's oceanic part is: towards continents, whose own age is that of
  /// another event, as old as any floor gets. They were stretched before the first floor was made.
  static double floor_age_myr(double crust_age_myr, double share) {
    if (share >= kStretched) return kOldestFloor_myr;
    const double age_myr = std::min(crust_age_myr, kOldestFloor_myr);
    return age_myr + smooth_step(kFloor, kStretched, share) * (kOldestFloor_myr - age_myr);
  }
  /// Floor as deep as it is old, under its sediment, with hills, seamounts, arcs and trenches.
  [[nodiscard]] Number sea_floor_m(int i, const Row& along, double age_myr, const Number& island,
                                   double rough) const {
    const Tectonics<V>& row = along.from_afar;
    return -ocean_depth_m(age_myr) + floor_cover_m(i, along, age_myr) +
           island * (kArc_m + kArcRoughness_m * rough + kVolcanoes_m * along.arc_volcanoes[i]) +
           Number(row.trench_m[i]);
  }
  [[nodiscard]] Number floor_sediment_m(int i, const Row& along, double crust_age_myr) const {
    const double age_myr = std::min(crust_age_myr, kOldestFloor_myr);
    return deep_sediment_m(p_.sediment, age_myr, along.offshore_km[i]) * left_by_trench(i, along);
  }
  [[nodiscard]] Number left_by_trench(int i, const Row& along) const {
    return 1.0 -
           kTrenchLacks *
               limited(Number(-Number(along.from_afar.trench_m[i]) / kEmptyTrench_m), 0.0, 1.0);
  }
  void record_sediment(int i, const Row& along, Index cell, double share,
                       double crust_age_myr) const {
    if (crust_.sediment_m.empty()) return;
    const double on_floor_m =
        deep_sediment_thickness_m(crust_.parameters.sediment,
                                  std::min(crust_age_myr, kOldestFloor_myr), along.offshore_km[i]) *
        value_of(left_by_trench(i, along));
    crust_.sediment_m[cell] += static_cast<float>(solid_thickness_m(on_floor_m) * (1.0 - share));
  }
  /// Sediment of old basins, as rock without pores: a sag of the continent that has subsided by
  /// w / (1 - f) is filled by the share f of that and seen to lie lower by w. Belts have thrust
  /// theirs up and lost it; the foot of continents has that of its apron.
  void record_cover(Index cell, double share, double belt, double swell_m) const {
    if (crust_.sediment_m.empty()) return;
    const double edge = crust_.parameters.shelf_edge, inland = smooth_step(edge, 1.0, share);
    const double fill = crust_.parameters.basin_fill, sag_m = std::max(0.0, -swell_m);
    const double rise = 1.0 - value_of(density_.sediment) / value_of(density_.mantle);
    const double cover_m = fill / (1.0 - fill) * sag_m / rise;
    crust_.sediment_m[cell] +=
        static_cast<float>(inland * (1.0 - belt) * solid_thickness_m(cover_m));
  }
  /// Sediment, swells, hills and seamounts on a floor.
  [[nodiscard]] Number floor_cover_m(int i, const Row& along, double crust_age_myr) const {
    const Tectonics<V>& row = along.from_afar;
    const Number sediment_m = floor_sediment_m(i, along, crust_age_myr);
    const Number buried = 1.0 / (1.0 + sediment_m / kBurying_m);
    return datum_.rise_per_sediment() * sediment_m +
           p_.ocean_swell_m * static_cast<double>(row.ocean_swell[i]) +
           p_.seafloor_roughness_m * buried * along.hills[i] + p_.seamount_m * seamount(i, along);
  }
  /// Seamounts over isostasy.seamount_m: volcanoes of a margins crust, else noise.
  static double seamount(int i, const Row& along) {
    if (!along.seamounts_m.empty()) return along.seamounts_m[i] / kHighestMount_m;
    return std::min(kHighestSeamount, std::max(0.0, along.mounts[i] - kSeamount));
  }

  /// A dry column under the sea, whose water loads it unless the compensation is dry.
  [[nodiscard]] Number balanced(const Number& dry_m) const {
    return is_dry_ ? dry_m : datum_.loaded(dry_m);
  }

  const Crust<V>& crust_;
  Settings p_;
  BasicColumnDensities<Number> density_;
  BasicAiryDatum<Number> datum_;
  bool is_dry_;
  Number craton_slope_;
  UnitNoise land_, ranges_, hills_, mounts_;
};

/// crust = "margins": thickness, density and height of every column of the full grid, from the
/// cross sections of margins and belts and the age of the floor.
template <class V>
void draw_margins_crust(const Crust<V>& crust, const CoarseGrid& coarse, const TectonicFrame& frame,
                        const Tectonics<V>& tectonics) {
  const CubicRows rows(coarse.grid(), crust.grid);
  const Columns<V> columns(crust);
  ParallelErrors errors;
#pragma omp parallel
  {
    auto row = errors.make<typename Columns<V>::Row>(columns);
#pragma omp for schedule(dynamic, 4)
    for (int j = 0; j < crust.grid.ny(); ++j) {
      errors.guard([&] {
        row->read(crust, rows, frame, tectonics, j);
        columns.draw(j, *row);
      });
    }
  }
  errors.rethrow();
}

}  // namespace geo
