#include "growth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/distance_to_coast.hpp"
#include "geo/kernels/noise/noise_row.hpp"
#include "geo/kernels/numerics/quantiles.hpp"
#include "geo/kernels/numerics/shapes.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/kernels/plates/growth/continents.hpp"
#include "geo/kernels/plates/growth/plate_pieces.hpp"
#include "geo/kernels/plates/plate_boundaries.hpp"
#include "geo/kernels/plates/plate_motion.hpp"
#include "geo/kernels/remapping/mesh_sampling.hpp"
#include "grown_plates.hpp"
#include "smooth_fields.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

/// The plates as the cells of the grid see them.
class PlatesOnGrid {
 public:
  PlatesOnGrid(const PlatesParameters& parameters, const GrownPlates& grown, StageIo& io,
               const Context& context)
      : p_(parameters),
        grown_(grown),
        grid_(io.grid()),
        smooth_fields_(grown, io.grid()),
        radius_km_(1e-3 * io.grid().figure().radius_m),
        bend_{Noise(context.seed, "plates.bend_x"), Noise(context.seed, "plates.bend_y"),
              Noise(context.seed, "plates.bend_z")},
        coast_(context.seed, "plates.coast"),
        thermal_(context.seed, "plates.thermal_age"),
        fraction_(io.write(field::continental_fraction)),
        age_(io.write(field::crust_age)),
        orogeny_(io.write(field::orogeny_type)) {}

  /// Plates, velocities, boundaries, ages of the floor, heat.
  void draw(StageIo& io) const {
    const Drawn to{io.write(field::plate_id), io.write(field::boundary_type),
                   io.write(field::boundary_strength), io.write(field::plate_velocity_east),
                   io.write(field::plate_velocity_north)};
    const auto heat = io.write(field::heat_anomaly);
    ParallelErrors errors;
#pragma omp parallel
    {
      std::vector<float> scratch;
      auto made = errors.make<Bends>(*this);
#pragma omp for schedule(dynamic, 4)
      for (int j = 0; j < grid_.ny(); ++j) {
        errors.guard([&] {
          smooth_fields_.heat(j, heat.subspan(grid_.cell(0, j), grid_.nx()), scratch);
          made->read(j);
          for (int i = 0; i < grid_.nx(); ++i) draw_cell(i, j, *made, kAsItLies, to);
        });
      }
    }
    errors.rethrow();
    // Bent outlines fold over here and there; what they cut off is its neighbours'.
    const std::vector<Index> handed_over = connect_plates(grid_, to.plate);
    Bends bends(*this);
    for (std::size_t k = 0; k < handed_over.size(); ++k) {
      const int i = grid_.column(handed_over[k]), j = grid_.row(handed_over[k]);
      if (k == 0 || j != grid_.row(handed_over[k - 1])) bends.read(j);
      draw_cell(i, j, bends, to.plate[handed_over[k]], to);
    }
  }

  /// Continents that grew from cratons: their edge is where the potential with its noise covers the
  /// wanted share; their margin falls off with the distance from it.
  void draw_cratons() const {
    std::vector<float> potential(grid_.size());
    const double frequency = radius_km_ / p_.coast_wavelength_km;
    constexpr double kNormal = 6.2, kSea = -9.0;  // fbm to unit deviation; no noise lifts that
    ParallelErrors errors;
#pragma omp parallel
    {
      NoiseRow row(grid_);
      auto noise = errors.make<std::vector<float>>(grid_.nx());
      std::vector<float> scratch;
#pragma omp for schedule(dynamic, 4)
      for (int j = 0; j < grid_.ny(); ++j) {
        errors.guard([&] {
          const auto along = std::span(potential).subspan(grid_.cell(0, j), grid_.nx());
          smooth_fields_.potential(j, along, scratch);
          row.choose(j, [&](int i) { return along[i] > kSea; });
          row.fbm(coast_, frequency, 9, 0.55, noise);
          for (int i = 0; i < grid_.nx(); ++i) {
            if (!(along[i] > kSea)) continue;
            along[i] = static_cast<float>(along[i] + kNormal * p_.coast_roughness * 0.5 * noise[i]);
          }
        });
      }
    }
    errors.rethrow();
    const float edge = level_for_fraction(grid_, potential, 1.0 - p_.cratons.share);
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) potential[cell] -= edge;
    std::vector<float> distance_m(grid_.size());
    distance_to_coast(grid_, potential, distance_m);
    const auto draw_row = [&](int j) {
      std::vector<float> scratch, convergent_km(grid_.nx());
      smooth_fields_.convergent_km(j, convergent_km, scratch);
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index cell = grid_.cell(i, j);
        const double passive = smooth_step(250.0, 900.0, convergent_km[i]);
        const double width_km =
            p_.active_margin_km + passive * (p_.passive_margin_km - p_.active_margin_km);
        const double inland_km = (potential[cell] >= 0.0F ? 1e-3 : -1e-3) * distance_m[cell];
        fraction_[cell] = static_cast<float>(std::clamp(0.5 + inland_km / width_km, 0.0, 1.0));
      }
    };
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < grid_.ny(); ++j) errors.guard([&] { draw_row(j); });
    errors.rethrow();
    // Distances to a frayed edge are creased; margins are not.
    constexpr double kCreases_m = 30e3;
    smooth(grid_, fraction_, kCreases_m);
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      fraction_[cell] = std::clamp(fraction_[cell], 0.0F, 1.0F);
    }
  }

  /// Continents that are whole plates (blueprint 3.1b).
  void draw_plates(std::span<const std::int16_t> plate, double land_share) const {
    const double share = std::min(land_share + p_.land_buffer, 0.85);
    const auto continental =
        continental_plates_reaching(grown_.mesh(), grown_.plate(), grown_.plates(), share);
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      fraction_[cell] = continental[plate[cell]] != 0 ? 1.0F : 0.0F;
    }
  }

  /// Which convergent boundaries raise mountains, and what they reach; ages of continents.
  void draw_continental_history() const {
    const auto& points = grown_.boundaries();
    std::vector<OrogenyType> orogeny(points.size(), OrogenyType::none);
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (points[k].type == BoundaryType::convergent) orogeny[k] = orogeny_of(points[k]);
    }
    const auto& mesh = grown_.mesh();
    constexpr double kYoungest_myr = 200.0, kOldest_myr = 3200.0;
    const double frequency = radius_km_ / 3500.0;
    ParallelErrors errors;
#pragma omp parallel
    {
      NoiseRow row(grid_);
      auto noise = errors.make<std::vector<float>>(grid_.nx());
      auto convergent_km = errors.make<std::vector<float>>(grid_.nx());
      std::vector<float> scratch;
#pragma omp for schedule(dynamic, 4)
      for (int j = 0; j < grid_.ny(); ++j) {
        errors.guard([&] {
          smooth_fields_.convergent_km(j, convergent_km, scratch);
          row.choose(j, [&](int i) { return fraction_[grid_.cell(i, j)] > 0.0F; });
          row.fbm(thermal_, frequency, 3, 0.5, noise);
          for (int i = 0; i < grid_.nx(); ++i) {
            const Index cell = grid_.cell(i, j);
            orogeny_[cell] = static_cast<std::int8_t>(OrogenyType::none);
            if (fraction_[cell] <= 0.0F) continue;
            const double reached_km = convergent_km[i];
            const bool reached = reached_km < p_.orogeny_reach_km && fraction_[cell] > 0.3F;
            const std::int32_t point =
                reached ? grown_.convergent_point(mesh.locate(grid_.unit_vector(i, j))) : -1;
            if (point >= 0) {
              orogeny_[cell] = static_cast<std::int8_t>(orogeny[point]);
            }
            const double old = std::clamp(0.5 + 2.0 * noise[i], 0.0, 1.0);
            const double far = smooth_step(0.0, 1500.0, reached_km);
            const double thermal_myr = kYoungest_myr + (kOldest_myr - kYoungest_myr) * old * far;
            if (fraction_[cell] >= 0.5F) age_[cell] = static_cast<float>(thermal_myr);
          }
        });
      }
    }
    errors.rethrow();
  }

 private:
  /// Places on the mesh for places on the planet along a row: near boundaries, outlines bend at
  /// scales below the mesh's.
  class Bends {
   public:
    explicit Bends(const PlatesOnGrid& on) : on_(on), noise_(on.grid_), cell_(on.grid_.nx()) {
      for (auto& along : along_) along.resize(on.grid_.nx());
    }
    void read(int row) {
      for (int i = 0; i < on_.grid_.nx(); ++i) {
        cell_[i] = on_.grown_.mesh().locate(on_.grid_.unit_vector(i, row));
      }
      noise_.choose(row, [&](int i) { return near(i); });
      constexpr double kWavelength_km = 420.0;
      for (int c = 0; c < 3; ++c) {
        noise_.fbm(on_.bend_[c], on_.radius_km_ / kWavelength_km, 6, 0.55, along_[c]);
      }
    }
    /// The cell of the mesh that holds the place as it is.
    [[nodiscard]] std::int32_t cell(int column) const { return cell_[column]; }
    [[nodiscard]] bool near(int column) const { return on_.grown_.near_boundary(cell_[column]); }
    [[nodiscard]] Vector3 bent(int column, const Vector3& at) const {
      constexpr double kNormal = 2.2;
      const double most = kNormal * on_.p_.outline_bending_km / on_.radius_km_;
      return normalised({at[0] + most * along_[0][column], at[1] + most * along_[1][column],
                         at[2] + most * along_[2][column]});
    }

   private:
    const PlatesOnGrid& on_;
    NoiseRow noise_;
    std::vector<std::int32_t> cell_;
    std::array<std::vector<float>, 3> along_;
  };

  /// What is drawn of plates alone.
  struct Drawn {
    std::span<std::int16_t> plate;
    std::span<std::int8_t> type;
    std::span<float> strength, east, north;
  };
  static constexpr std::int16_t kAsItLies = -1;
  /// A cell of plate `own`, or of the one that it lies on.
  void draw_cell(int i, int j, const Bends& bends, std::int16_t own, const Drawn& to) const {
    const double half_width_km =
        std::max(0.5 * p_.boundary_width_km, 0.6e-3 * grid_.spacing_north_m(0));
    const auto& mesh = grown_.mesh();
    const Index cell = grid_.cell(i, j);
    const Vector3 at = grid_.unit_vector(i, j);
    const bool near = bends.near(i);
    const Vector3 place = near ? bends.bent(i, at) : at;
    const MeshStencil stencil = stencil_at(mesh, near ? mesh.locate(place) : bends.cell(i), place);
    if (own == kAsItLies) {
      own = near ? grown_.plate_at(stencil) : grown_.plate()[stencil.cell[0]];
    }
    to.plate[cell] = own;
    const Vector3 motion = velocity_mm_yr(grown_.plates()[own].rotation_rad_myr, at, radius_km_);
    const auto velocity = east_north(grid_.to_axis(motion), grid_.to_axis(at));
    to.east[cell] = static_cast<float>(velocity.east);
    to.north[cell] = static_cast<float>(velocity.north);
    age_[cell] = static_cast<float>(grown_.age_myr(stencil, own));
    to.type[cell] = static_cast<std::int8_t>(BoundaryType::interior);
    to.strength[cell] = 0.0F;
    if (!near) return;
    const auto boundary = grown_.boundary_near(stencil, place, own);
    if (boundary.point == nullptr || boundary.distance_km > half_width_km) return;
    to.type[cell] = static_cast<std::int8_t>(boundary.point->type);
    to.strength[cell] = static_cast<float>(boundary.point->strength);
  }

  [[nodiscard]] double fraction_at(const Vector3& place) const {
    const Vector3 at = grid_.to_axis(place);
    const double x = (std::atan2(at[1], at[0]) / (2.0 * kPi) + 0.5) * grid_.nx();
    const double y = (std::asin(std::clamp(at[2], -1.0, 1.0)) / kPi + 0.5) * grid_.ny();
    return fraction_[grid_.cell(std::clamp(static_cast<int>(x), 0, grid_.nx() - 1),
                                std::clamp(static_cast<int>(y), 0, grid_.ny() - 1))];
  }
  /// Continental crust on one side or on both, within some distance of the trench.
  [[nodiscard]] OrogenyType orogeny_of(const BoundaryPoint& point) const {
    const Vector3& here = grown_.mesh().position(point.cell);
    const auto continental = [&](double side) {
      double most = 0.0;
      for (const double far_km : {60.0, 130.0, 220.0}) {
        most = std::max(
            most, fraction_at(normalised(add(here, point.towards, side * far_km / radius_km_))));
      }
      return most > 0.5;
    };
    const int sides = (continental(1.0) ? 1 : 0) + (continental(-1.0) ? 1 : 0);
    return sides == 2   ? OrogenyType::himalayan
           : sides == 1 ? OrogenyType::andean
                        : OrogenyType::none;
  }

  const PlatesParameters& p_;
  const GrownPlates& grown_;
  const Grid& grid_;
  SmoothFields smooth_fields_;
  double radius_km_;
  std::array<Noise, 3> bend_;
  Noise coast_, thermal_;
  std::span<float> fraction_, age_;
  std::span<std::int8_t> orogeny_;
};

/// Areas and lengths for the manifest: plates fill the sphere; crust made and consumed, km2 yr-1.
void report(const GrownPlates& grown, double radius_km, Budget& budget) {
  const auto& mesh = grown.mesh();
  const double r2 = radius_km * radius_km;
  double area = 0.0;
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) area += mesh.area_sr(cell) * r2;
  const CrustBudget crust =
      crust_budget(mesh, grown.plate(), grown.boundaries(), grown.rotations(), radius_km);
  budget["plates_area_km2"] = area;
  budget["plates_area_error"] = area / (4.0 * kPi * r2) - 1.0;
  budget["crust_created_km2_yr"] = crust.created;
  budget["crust_consumed_km2_yr"] = crust.consumed;
  budget["crust_closing_error"] =
      (crust.created - crust.consumed) / std::max(crust.created + crust.consumed, 1e-30);
}

}  // namespace

void grow(const PlatesParameters& parameters, StageIo& io, Context& context) {
  if (io.grid().topology() != Topology::sphere) {
    throw InputError("plates: the grid must be a whole sphere");
  }
  const double radius_km = 1e-3 * io.grid().figure().radius_m;
  const GrownPlates grown(parameters, radius_km, context.seed);
  context.advance(0.4);
  const PlatesOnGrid on_grid(parameters, grown, io, context);
  on_grid.draw(io);
  context.advance(0.7);
  if (parameters.continents == "cratons") {
    on_grid.draw_cratons();
  } else {
    on_grid.draw_plates(io.write(field::plate_id), 1.0 - context.planet.ocean_fraction);
  }
  on_grid.draw_continental_history();
  report(grown, radius_km, context.budget);
}

}  // namespace geo
