#include "raster_on_torus.hpp"

#include <algorithm>
#include <cmath>

#include "geo/kernels/plates/plate_boundaries.hpp"
#include "raster.hpp"
#include "stages/plates/drifted_fields.hpp"

namespace geo {
namespace {

/// Boundary of two plates at a cell of the map, or interior.
struct Contact {
  BoundaryType type = BoundaryType::interior;
  double strength = 0.0;
};

class TorusBoundaries {
 public:
  TorusBoundaries(const PlatesParameters& p, const RasterTectonics& model,
                  const RasterElevation& surface, const RasterScale& scale)
      : p_(p), model_(model), surface_(surface), mm_yr_(scale.cell_km / scale.step_myr) {
    reach_ = std::max(2, static_cast<int>(std::lround(p.boundary_smoothing_km / scale.cell_km)));
    contact_.resize(surface.plate.size());
    const RasterWorld& world = surface.world;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < world.rows; ++j) {
      for (int i = 0; i < world.columns; ++i) find(i, j);
    }
    double most = 1e-9;
    for (const Contact& contact : contact_) most = std::max(most, contact.strength);
    for (Contact& contact : contact_) contact.strength /= most;
  }
  [[nodiscard]] const Contact& at(std::size_t cell) const { return contact_[cell]; }

 private:
  [[nodiscard]] std::size_t cell(int i, int j) const {
    const RasterWorld& world = surface_.world;
    return static_cast<std::size_t>(world.row(j)) * world.columns + world.column(i);
  }
  void find(int i, int j) {
    const std::int16_t own = surface_.plate[cell(i, j)];
    std::int16_t other = own;
    for (int k = 1; k < kDirections && other == own; k += 2) {
      other = surface_.plate[cell(i + kColumnStep[k - 1], j + kRowStep[k - 1])];
    }
    if (other == own) return;
    Vector3 towards{};
    for (int dy = -reach_; dy <= reach_; ++dy) {
      for (int dx = -reach_; dx <= reach_; ++dx) {
        const std::int16_t plate = surface_.plate[cell(i + dx, j + dy)];
        const double side = plate == other ? 1.0 : plate == own ? -1.0 : 0.0;
        towards = add(towards, {static_cast<double>(dx), static_cast<double>(dy), 0.0}, side);
      }
    }
    towards = normalised(towards);
    const auto velocity = [&](std::int16_t plate) {
      const RasterVelocity v =
          raster_velocity(model_.plates()[plate], surface_.world, i + 0.5, j + 0.5);
      return Vector3{mm_yr_ * v.x, mm_yr_ * v.y, 0.0};
    };
    const RelativeMotion motion =
        relative_motion(velocity(own), velocity(other), towards, {0.0, 0.0, 1.0});
    Contact& contact = contact_[cell(i, j)];
    contact.type = classify(motion, p_.growth.speed_cm_yr);
    if (contact.type != BoundaryType::interior) {
      contact.strength = std::max({motion.closing, motion.opening, std::abs(motion.shear)});
    }
  }

  const PlatesParameters& p_;
  const RasterTectonics& model_;
  const RasterElevation& surface_;
  double mm_yr_;
  int reach_ = 2;
  std::vector<Contact> contact_;
};

}  // namespace

void lay_on_torus(const PlatesParameters& parameters, const RasterTectonics& model,
                  RasterScale scale, StageIo& io, const Context& context) {
  const Grid& grid = io.grid();
  std::vector<float> heights;
  for (const RasterCrust& crust : model.map().crust) heights.push_back(crust.height);
  fit_scale(std::move(heights), wanted_ocean(context), parameters.raster.median_land_m, scale);
  const RasterElevation surface = raster_elevation(model, scale);
  const RasterWorld& world = surface.world;
  const TorusBoundaries boundaries(parameters, model, surface, scale);
  const DriftedFields f(io);
  constexpr float kBackgroundHeat = 0.2F;
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    const double row = (j + 0.5) * world.rows / grid.ny();
    for (int i = 0; i < grid.nx(); ++i) {
      const double column = (i + 0.5) * world.columns / grid.nx();
      const std::size_t of =
          static_cast<std::size_t>(row) * world.columns + static_cast<std::size_t>(column);
      const Index cell = grid.cell(i, j);
      const auto value = [&](const std::vector<float>& values) {
        return static_cast<float>(smooth_value(world, values, column, row));
      };
      const RasterVelocity v =
          raster_velocity(model.plates()[surface.plate[of]], world, column, row);
      const double mm_yr = scale.cell_km / scale.step_myr;
      f.plate[cell] = surface.plate[of];
      f.east[cell] = static_cast<float>(mm_yr * v.x);
      f.north[cell] = static_cast<float>(mm_yr * v.y);
      f.type[cell] = static_cast<std::int8_t>(boundaries.at(of).type);
      f.strength[cell] = static_cast<float>(boundaries.at(of).strength);
      const double height = value(surface.height), floor = model.settings().ocean_crust;
      f.elevation[cell] =
          static_cast<float>(raster_elevation_m(height, value(surface.age_myr), floor, scale));
      f.thickness[cell] = static_cast<float>(raster_thickness_m(height, floor, scale));
      f.fraction[cell] = static_cast<float>(
          std::clamp((f.thickness[cell] - 1e3 * scale.oceanic_km) / 15e3, 0.0, 1.0));
      const bool land = f.fraction[cell] >= 0.5F;
      f.orogeny_age[cell] = land ? value(surface.orogeny_age_myr) : 0.0F;
      f.age[cell] = land ? f.orogeny_age[cell] : value(surface.age_myr);
      f.orogeny[cell] = land ? surface.orogeny[of] : std::int8_t{0};
      f.heat[cell] = kBackgroundHeat;
      f.fold_east[cell] = surface.fold_x[of];
      f.fold_north[cell] = surface.fold_y[of];
      f.ridge_east[cell] = surface.ridge_x[of];
      f.ridge_north[cell] = surface.ridge_y[of];
    }
  }
}

}  // namespace geo
