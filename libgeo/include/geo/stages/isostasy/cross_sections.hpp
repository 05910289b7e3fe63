#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/numerics/shapes.hpp"
#include "geo/stages/isostasy/deformation.hpp"
#include "geo/stages/isostasy/unit_noise.hpp"

namespace geo {

// How sections vary along a boundary and beside it: design, chosen beside the Earth's topography
// for belts that wind and swell.

/// How much a deviation of the noise along a boundary makes it stronger or weaker, and the bounds
/// of that for shortening (a share) and for the strength of a section, which nowhere ends abruptly.
inline constexpr double kAlongBoundary = 0.35;
inline constexpr double kLeastClosing = 0.2, kMostClosing = 2.0;
inline constexpr double kLeastStrength = 0.05, kMostStrength = 1.3;
/// How far a deviation of the noise shifts a section across its boundary, km, and the distances
/// between which that begins: trenches stay where plates meet.
inline constexpr double kShift_km = 55.0, kStraight_km = 40.0, kShifted_km = 200.0;
/// Farther than this from a boundary no section reaches, and its noise is not read.
inline constexpr double kSections_km = 2500.0;
/// Plateaus by a log-normal of the noise: its deviation, half its square (the logarithm of its
/// mean, so that swells have the mean 0), and about the deviation of what comes of it, by which it
/// is divided.
inline constexpr double kSkew = 0.6, kLogMean = 0.18, kSkewed = 0.8;
/// Deviations of the noise between which old belts pass from worn down to whole, and how near to 0
/// the noise is along their sutures: narrow lines.
inline constexpr double kWornDown = -0.4, kWhole = 1.2, kSuture = 0.16;
/// Over which arcs and trenches are smoothed, in the length for shortening, and plateaus: narrow
/// features less, broad ones more.
inline constexpr double kArcSmoothing = 0.7, kTrenchSmoothing = 0.6, kBeltSmoothing = 2.0;

/// Towards the ends of a boundary, where plates begin to slide past each other, arcs and trenches
/// of a margins crust fade over this, km: sections are cut by the distance from a boundary, and
/// would close in a half circle round its end.
inline constexpr double kFadesFrom_km = 300.0;

/// How convergence shortens crust.
template <class V>
struct Shortening {
  Arithmetic<V> collision, subduction, crust_km, front;
};

/// Crust that shortening adds in a belt, km Myr-1. Plates close at v, of which a share shortens
/// crust of thickness h0; the densities w say where across the margin:
///   dh/dt = share v h0 [(1 - front) w_sheet + front w_wedge],   integral of each w over x = 1.
/// A belt so begins as high as it was when the landscape began to run, its thickening less what is
/// still to come, and floats, wears and comes up again while it grows: how high it stands follows
/// from rate, time, isostasy, rock and rivers (England & McKenzie 1982; Oncken et al. 2006).
template <class V>
Arithmetic<V> shortening_km_myr(const ConvergentMargins& margins, Index cell, double along,
                                double across, double strength, const Shortening<V>& s) {
  const bool collides = margins.kind[cell] == Convergence::continents;
  const ShorteningDensity density =
      collides ? himalayan_shortening(across, strength) : andean_shortening(across, strength);
  const double closing_km_myr =
      margins.closing_mm_yr[cell] *
      std::clamp(1.0 + kAlongBoundary * along, kLeastClosing, kMostClosing);
  return (collides ? s.collision : s.subduction) * s.crust_km *
         (closing_km_myr * (density.sheet + s.front * (density.wedge - density.sheet)));
}

/// How deep trenches are: of a margins crust by the age and the speed of the subducting floor,
/// else by the strength of the boundary.
template <class V>
struct Trenches {
  bool by_floor;
  double cell_km;
  Arithmetic<V> slab_m, strong;
};

inline double fading(const ConvergentMargins& margins, Index cell) {
  return smooth_step(0.0, kFadesFrom_km, static_cast<double>(margins.from_end_km[cell]));
}

/// Mean of a trench's profile over a cell: plates meet at the edge of the cells at their boundary,
/// which count as 0 km from it, and a trench is narrower than a cell.
inline double profile_over_cell(double from_cell_km, double cell_km) {
  constexpr double kReach_km = 600.0;
  constexpr int kParts = 8;
  if (std::abs(from_cell_km) > kReach_km) return 0.0;
  double sum = 0.0;
  for (int k = 0; k < kParts; ++k) {
    sum += bent_plate(from_cell_km + std::copysign((k + 0.5) / kParts * cell_km, from_cell_km));
  }
  return sum / kParts;
}

/// The depth of a trench and its forebulge, m, negative down.
template <class V>
Arithmetic<V> depth_of_trench_m(const ConvergentMargins& margins, Index cell, double strength,
                                const Trenches<V>& trenches) {
  const double from_cell_km = margins.across_km[cell];
  if (!trenches.by_floor) return trenches.strong * trench_m(from_cell_km, strength);
  return trenches.slab_m * (fading(margins, cell) *
                            trench_share(margins.floor_myr[cell], margins.closing_mm_yr[cell]) *
                            profile_over_cell(from_cell_km, trenches.cell_km));
}

/// What a convergent margin does to one cell; noise makes its belts wind and swell.
template <class V>
void cut_section(const ConvergentMargins& margins, Index cell, double along, double shift,
                 const Trenches<V>& trenches, const Shortening<V>& shortening, Tectonics<V>& t) {
  const double straight_km = margins.across_km[cell];
  const double across =
      straight_km +
      kShift_km * shift * smooth_step(kStraight_km, kShifted_km, std::abs(straight_km));
  const double strength = std::clamp(margins.strength[cell] * (1.0 + kAlongBoundary * along),
                                     kLeastStrength, kMostStrength);
  switch (margins.kind[cell]) {
    case Convergence::oceans:
      t.arc[cell] =
          V((trenches.by_floor ? fading(margins, cell) : 1.0) * island_arc(across, strength));
      t.trench_m[cell] = V(depth_of_trench_m(margins, cell, strength, trenches));
      break;
    case Convergence::ocean_continent:
      t.thickening[cell] = V(andean_thickening(across, strength));
      t.shortening_km_myr[cell] =
          V(shortening_km_myr(margins, cell, along, across, strength, shortening));
      t.trench_m[cell] = V(depth_of_trench_m(margins, cell, strength, trenches));
      break;
    case Convergence::continents:
      t.thickening[cell] = V(himalayan_thickening(across, strength));
      t.shortening_km_myr[cell] =
          V(shortening_km_myr(margins, cell, along, across, strength, shortening));
      break;
    default:
      break;
  }
}

/// Where two stretches of boundary are equally near, sections meet in a straight line. Far from the
/// boundary plateaus pass into each other, and end, over a broader slope than belts have near it.
template <class V>
void soften_far_edges(const Grid& grid, const ConvergentMargins& margins,
                      const Arithmetic<V>& length_m, std::vector<V>& thickening) {
  constexpr double kBroader = 3.5, kNear_km = 250.0, kFar_km = 700.0;
  std::vector<V> broad = thickening;
  blur(grid, thickening, length_m);
  blur(grid, broad, kBroader * length_m);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const double far = smooth_step(kNear_km, kFar_km, std::abs(margins.across_km[cell]));
    thickening[cell] += V(static_cast<float>(far)) * (broad[cell] - thickening[cell]);
  }
}

/// What varies convergent margins along their length, and crust and mantle from place to place.
struct SectionNoise {
  template <class V>
  SectionNoise(const Crust<V>& crust, const Grid& grid)
      : along(grid, crust.seed, "isostasy.belts", 1100.0, 3, 0.6, crust.noise),
        shift(grid, crust.seed, "isostasy.belt_shift", 700.0, 3, 0.6, crust.noise),
        thickness(grid, crust.seed, "isostasy.thickness", 3200.0, 4, 0.55, crust.noise),
        mantle_swell(grid, crust.seed, "isostasy.swells", 2600.0, 5, 0.6, crust.noise),
        ocean_floor(grid, crust.seed, "isostasy.ocean_swells", 2800.0, 4, 0.55, crust.noise),
        suture(grid, crust.seed, "isostasy.sutures", 4200.0, 4, 0.5, crust.noise),
        worn(grid, crust.seed, "isostasy.worn", 2000.0, 3, 0.6, crust.noise) {}

  UnitNoise along, shift, thickness, mantle_swell, ocean_floor, suture, worn;
};

/// That noise along one row of the grid, and what is done with it there.
template <class V>
class SectionRow {
 public:
  SectionRow(const Crust<V>& crust, const Grid& grid, const SectionNoise& noise,
             const ConvergentMargins& margins, Tectonics<V>& t)
      : grid_(grid),
        margins_(margins),
        t_(t),
        row_(grid),
        along_(noise.along, grid.nx()),
        shift_(noise.shift, grid.nx()),
        thickness_(noise.thickness, grid.nx()),
        mantle_swell_(noise.mantle_swell, grid.nx()),
        ocean_floor_(noise.ocean_floor, grid.nx()),
        suture_(noise.suture, grid.nx()),
        worn_(noise.worn, grid.nx()),
        thickness_noise_km_(crust.active(crust.parameters.thickness_noise_km)),
        swell_m_(crust.active(crust.parameters.swell_m)),
        trenches_{crust.parameters.crust == "margins", 1e-3 * grid.spacing_north_m(grid.ny() / 2),
                  crust.active(crust.parameters.slab_trench_m),
                  crust.active(crust.parameters.trench_depth_m) / kDeepestTrench_m},
        shortening_{crust.active(crust.parameters.collision_shortening),
                    crust.active(crust.parameters.subduction_shortening),
                    crust.active(crust.parameters.continental_km),
                    crust.active(crust.parameters.front_shortening)} {}

  /// Broad variation of continents and sea floor, and old belts.
  void vary(int j) {
    row_.choose_all(j);
    for (auto* line : {&thickness_, &mantle_swell_, &ocean_floor_, &suture_, &worn_}) {
      line->read(row_);
    }
    for (int i = 0; i < grid_.nx(); ++i) {
      const Index cell = grid_.cell(i, j);
      t_.ocean_swell[cell] = static_cast<float>(ocean_floor_[i]);
      t_.thickness_noise_km[cell] = V(thickness_noise_km_ * thickness_[i]);
      // Plateaus stand further above the middle of continents than basins lie below it.
      const double up = std::exp(kSkew * mantle_swell_[i]) - std::exp(kLogMean);
      t_.swell_m[cell] = V(swell_m_ * up / kSkewed);
      const double age = smooth_step(kWornDown, kWhole, worn_[i]);
      t_.relict[cell] = static_cast<float>(age * bell(suture_[i], 0.0, kSuture));
    }
  }
  /// Sections across the convergent margins that are near.
  void cut(int j) {
    const auto is_near = [&](int i) {
      return std::abs(margins_.across_km[grid_.cell(i, j)]) <= kSections_km;
    };
    row_.choose(j, is_near);
    for (auto* line : {&along_, &shift_}) line->read(row_);
    for (int i = 0; i < grid_.nx(); ++i) {
      if (!is_near(i)) continue;
      cut_section(margins_, grid_.cell(i, j), along_[i], shift_[i], trenches_, shortening_, t_);
    }
  }

 private:
  const Grid& grid_;
  const ConvergentMargins& margins_;
  Tectonics<V>& t_;
  NoiseRow row_;
  UnitNoise::Line along_, shift_, thickness_, mantle_swell_, ocean_floor_, suture_, worn_;
  Arithmetic<V> thickness_noise_km_, swell_m_;
  Trenches<V> trenches_;
  Shortening<V> shortening_;
};

template <class V>
void clear_sections(const Grid& grid, Tectonics<V>& t) {
  for (auto* field : {&t.thickening, &t.shortening_km_myr, &t.arc, &t.trench_m,
                      &t.thickness_noise_km, &t.swell_m}) {
    field->assign(grid.size(), V(0.0F));
  }
  t.ocean_swell.resize(grid.size());
  t.relict.resize(grid.size());
}

template <class V>
void smooth_sections(const Crust<V>& crust, const Grid& grid, const ConvergentMargins& margins,
                     Tectonics<V>& t) {
  const Arithmetic<V> smoothing_km = crust.active(crust.parameters.deformation_smoothing_km);
  soften_far_edges<V>(grid, margins, 1e3 * kBeltSmoothing * smoothing_km, t.thickening);
  blur(grid, t.shortening_km_myr, 1e3 * smoothing_km);
  blur(grid, t.arc, 1e3 * kArcSmoothing * smoothing_km);
  blur(grid, t.trench_m, 1e3 * kTrenchSmoothing * smoothing_km);
}

/// Cross sections of convergent margins, old belts, broad variation of continents and sea floor.
template <class V>
void cut_sections(const Crust<V>& crust, const CoarseGrid& coarse, const TectonicFrame& frame,
                  Tectonics<V>& t) {
  const Grid& grid = coarse.grid();
  const SectionNoise noise(crust, grid);
  clear_sections(grid, t);
  ParallelErrors errors;
#pragma omp parallel
  {
    std::optional<SectionRow<V>> row;
    errors.guard([&] { row.emplace(crust, grid, noise, frame.margins, t); });
#pragma omp for schedule(dynamic, 8)
    for (int j = 0; j < grid.ny(); ++j) {
      errors.guard([&] {
        row->vary(j);
        row->cut(j);
      });
    }
  }
  errors.rethrow();
  smooth_sections(crust, grid, frame.margins, t);
  t.convergent = t.thickening;
  for (Index cell = 0; cell < grid.size(); ++cell) t.convergent[cell] += t.arc[cell];
}

}  // namespace geo
