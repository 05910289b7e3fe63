#include "growth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/continents.hpp"
#include "geo/kernels/crust_age.hpp"
#include "geo/kernels/cubed_sphere.hpp"
#include "geo/kernels/cubic_rows.hpp"
#include "geo/kernels/distance_to_coast.hpp"
#include "geo/kernels/mesh_sampling.hpp"
#include "geo/kernels/noise.hpp"
#include "geo/kernels/plate_boundaries.hpp"
#include "geo/kernels/plate_evolution.hpp"
#include "geo/kernels/plate_growth.hpp"
#include "geo/kernels/plate_motion.hpp"
#include "geo/kernels/quantiles.hpp"
#include "geo/kernels/smoothing.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kMeshEdge = 160;  // about 58 km on Earth

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// The planet's plates on the mesh.
class GrownPlates {
 public:
  GrownPlates(const PlatesParameters& parameters, double radius_km, std::uint64_t seed)
      : p_(parameters), radius_km_(radius_km), seed_(seed), mesh_(kMeshEdge) {
    PlateGrowth growth = p_.growth;
    growth.radius_km = radius_km;
    plates_ = draw_plates(growth, seed);
    plate_ = grow_plates(growth, mesh_, plates_, seed);
    evolve(growth);
    boundaries_ = find_boundaries(mesh_, plate_, rotations(), growth.speed_cm_yr,
                                  p_.boundary_smoothing_km, radius_km);
    std::vector<std::int32_t> all, convergent;
    for (std::size_t k = 0; k < boundaries_.size(); ++k) {
      all.push_back(boundaries_[k].cell);
      if (boundaries_[k].type != BoundaryType::convergent) continue;
      convergent.push_back(boundaries_[k].cell);
      convergent_.push_back(static_cast<std::int32_t>(k));
    }
    nearest_ = nearest_cells(mesh_, all, 6.0 * mesh_.spacing());
    nearest_convergent_ = nearest_cells(mesh_, convergent, 2000.0 / radius_km);
    for (float& angle : nearest_convergent_.angle) angle = std::min(angle, 1.0F);
    age_myr_ =
        ocean_age_myr(mesh_, plate_, boundaries_, rotations(), p_.oldest_floor_myr, radius_km);
    heat_ = heat();
    if (p_.continents == "cratons") {
      Cratons cratons = p_.cratons;
      cratons.radius_km = radius_km;
      potential_ = craton_potential(cratons, mesh_, plate_, plates_, boundaries_, seed);
    }
  }

  [[nodiscard]] const CubedSphere& mesh() const { return mesh_; }
  [[nodiscard]] const std::vector<Plate>& plates() const { return plates_; }
  [[nodiscard]] std::span<const std::int16_t> plate() const { return plate_; }
  [[nodiscard]] const std::vector<BoundaryPoint>& boundaries() const { return boundaries_; }
  [[nodiscard]] std::span<const float> potential() const { return potential_; }
  [[nodiscard]] std::span<const float> heat_anomaly() const { return heat_; }

  [[nodiscard]] bool near_boundary(std::int32_t cell) const { return nearest_.source[cell] >= 0; }

  /// The plate with the largest share of a stencil.
  [[nodiscard]] std::int16_t plate_at(const MeshStencil& stencil) const {
    std::int16_t best = plate_[stencil.cell[0]];
    double most = -1.0;
    for (std::size_t k = 0; k < stencil.cell.size(); ++k) {
      const std::int16_t candidate = plate_[stencil.cell[k]];
      double votes = 0.0;
      for (std::size_t other = 0; other < stencil.cell.size(); ++other) {
        if (plate_[stencil.cell[other]] == candidate) votes += stencil.weight[other];
      }
      if (votes > most || (votes == most && candidate < best)) {
        most = votes;
        best = candidate;
      }
    }
    return best;
  }

  /// The boundary nearest to a place on plate `own` and how far it is. Boundary cells of the own
  /// side lie half a cell before the line, those of the other side half a cell behind it.
  struct Near {
    const BoundaryPoint* point = nullptr;
    double distance_km = 1e9;
  };
  [[nodiscard]] Near boundary_near(const MeshStencil& stencil, const Vector3& at,
                                   std::int16_t own) const {
    const double half = 0.5 * mesh_.spacing();
    Near near;
    for (const std::int32_t cell : stencil.cell) {
      const std::int32_t source = nearest_.source[cell];
      if (source < 0) continue;
      const BoundaryPoint& point = boundaries_[source];
      const double far = length(add(mesh_.position(point.cell), at, -1.0));
      const double distance = radius_km_ * std::max(0.0, far + (point.plate == own ? half : -half));
      if (distance < near.distance_km) near = {&point, distance};
    }
    return near;
  }

  /// Age of the floor between cells of one plate alone, so that it jumps where plates meet.
  [[nodiscard]] double age_myr(const MeshStencil& stencil, std::int16_t own) const {
    double sum = 0.0, weights = 0.0;
    for (std::size_t k = 0; k < stencil.cell.size(); ++k) {
      if (plate_[stencil.cell[k]] != own) continue;
      sum += stencil.weight[k] * age_myr_[stencil.cell[k]];
      weights += stencil.weight[k];
    }
    return weights > 0.0 ? sum / weights : age_myr_[stencil.cell[0]];
  }

  [[nodiscard]] double convergent_km(const MeshStencil& stencil) const {
    return radius_km_ * read(stencil, nearest_convergent_.angle);
  }
  /// Number in boundaries() of the nearest convergent point, or -1.
  [[nodiscard]] std::int32_t convergent_point(std::int32_t cell) const {
    const std::int32_t source = nearest_convergent_.source[cell];
    return source < 0 ? -1 : convergent_[source];
  }

  [[nodiscard]] std::vector<Vector3> rotations() const {
    std::vector<Vector3> all;
    for (const Plate& plate : plates_) all.push_back(plate.rotation_rad_myr);
    return all;
  }

 private:
  /// Section 2.3: the plates move for a while; the last thing taken away is their common rotation.
  void evolve(const PlateGrowth& growth) {
    const RandomStream random(seed_, "plates.evolution");
    const double smallest_sr = growth.smallest_part_km2 / (radius_km_ * radius_km_);
    for (std::int64_t step = 0; step < p_.evolution_steps; ++step) {
      if (p_.no_net_rotation) subtract_net_rotation();
      const double age = static_cast<double>(step) / static_cast<double>(p_.evolution_steps);
      const double time_myr =
          random.uniform(static_cast<std::uint64_t>(step), 0, 0.9, 3.4) * (0.92 + 0.32 * age);
      move_plates(mesh_, plates_, time_myr, plate_);
      merge_small_pieces(mesh_, smallest_sr, plate_);
    }
    if (p_.no_net_rotation) subtract_net_rotation();
  }
  void subtract_net_rotation() {
    std::vector<Vector3> unit(mesh_.size());
    std::vector<double> area_sr(mesh_.size());
    for (std::int32_t cell = 0; cell < mesh_.size(); ++cell) {
      unit[cell] = mesh_.position(cell);
      area_sr[cell] = mesh_.area_sr(cell);
    }
    const Vector3 net = net_rotation(plate_, unit, area_sr, rotations());
    for (Plate& plate : plates_) plate.rotation_rad_myr = add(plate.rotation_rad_myr, net, -1.0);
  }
  /// Heat of the plates' mantle, blended over some hundred kilometres, with plumes on top; 0 to 1.
  [[nodiscard]] std::vector<float> heat() const {
    constexpr double kBlend_m = 500e3, kPlume_km = 260.0, kPlumeHeat = 0.5, kMost = 2.5;
    const Grid coarse = Grid::sphere(256, 128, {1000.0 * radius_km_, 0.0});
    std::vector<float> blended(coarse.size());
    for (int j = 0; j < coarse.ny(); ++j) {
      for (int i = 0; i < coarse.nx(); ++i) {
        const Plate& plate = plates_[plate_[mesh_.locate(coarse.unit_vector(i, j))]];
        blended[coarse.cell(i, j)] = static_cast<float>((plate.heat - 0.5) / kMost);
      }
    }
    smooth(coarse, blended, kBlend_m);
    const RandomStream random(seed_, "plates.plumes");
    std::vector<Vector3> plumes(static_cast<std::size_t>(std::lround(p_.plumes)));
    for (std::size_t k = 0; k < plumes.size(); ++k) plumes[k] = random.direction(k);
    std::vector<float> values(mesh_.size());
#pragma omp parallel for schedule(static)
    for (std::int32_t cell = 0; cell < mesh_.size(); ++cell) {
      const Vector3& at = mesh_.position(cell);
      double value = bilinear(coarse, blended, at);
      for (const Vector3& plume : plumes) {
        const double far = radius_km_ * length(add(plume, at, -1.0)) / kPlume_km;
        if (far < 5.0) value += kPlumeHeat * std::exp(-0.5 * far * far);
      }
      values[cell] = static_cast<float>(std::clamp(value, 0.0, 1.0));
    }
    return values;
  }
  static double bilinear(const Grid& grid, std::span<const float> values, const Vector3& at) {
    const double x = (std::atan2(at[1], at[0]) / (2.0 * kPi) + 0.5) * grid.nx() - 0.5;
    const double y = (std::asin(std::clamp(at[2], -1.0, 1.0)) / kPi + 0.5) * grid.ny() - 0.5;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const auto value = [&](int column, int row) {
      const bool over = row < 0 || row >= grid.ny();
      row = std::clamp(row, 0, grid.ny() - 1);
      column = (column + (over ? grid.nx() / 2 : 0) + grid.nx()) % grid.nx();
      return static_cast<double>(values[grid.cell(column, row)]);
    };
    const double u = x - i, v = y - j;
    return (1 - v) * ((1 - u) * value(i, j) + u * value(i + 1, j)) +
           v * ((1 - u) * value(i, j + 1) + u * value(i + 1, j + 1));
  }

  const PlatesParameters& p_;
  double radius_km_;
  std::uint64_t seed_;
  CubedSphere mesh_;
  std::vector<Plate> plates_;
  std::vector<std::int16_t> plate_;
  std::vector<BoundaryPoint> boundaries_;
  std::vector<std::int32_t> convergent_;  // numbers of convergent boundary points
  NearestCells nearest_, nearest_convergent_;
  std::vector<float> age_myr_, heat_, potential_;
};

/// Fields of the mesh that are smooth, on a grid of rows and columns: reading them row by row is
/// cheaper than asking the mesh for every cell. The same coarse grid serves all finer ones.
class SmoothFields {
 public:
  SmoothFields(const GrownPlates& grown, const Grid& grid)
      : coarse_(grid.nx() <= kColumns
                    ? grid
                    : Grid::sphere(kColumns, kColumns / 2, grid.figure(), grid.turn())),
        rows_(coarse_, grid) {
    for (auto* field : {&potential_, &heat_, &convergent_km_}) field->resize(coarse_.size());
    const bool cratons = !grown.potential().empty();
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < coarse_.ny(); ++j) {
      for (int i = 0; i < coarse_.nx(); ++i) {
        const Index cell = coarse_.cell(i, j);
        const auto stencil = stencil_at(grown.mesh(), coarse_.unit_vector(i, j));
        if (cratons) potential_[cell] = static_cast<float>(read(stencil, grown.potential()));
        heat_[cell] = static_cast<float>(read(stencil, grown.heat_anomaly()));
        convergent_km_[cell] = static_cast<float>(grown.convergent_km(stencil));
      }
    }
  }
  /// One row of the grid; `line` has one value per column.
  void potential(int row, std::span<float> line, std::vector<float>& scratch) const {
    rows_.read(potential_, row, line, scratch);
  }
  void heat(int row, std::span<float> line, std::vector<float>& scratch) const {
    rows_.read(heat_, row, line, scratch);
    for (float& value : line) value = std::clamp(value, 0.0F, 1.0F);
  }
  void convergent_km(int row, std::span<float> line, std::vector<float>& scratch) const {
    rows_.read(convergent_km_, row, line, scratch);
  }

 private:
  static constexpr int kColumns = 1024;
  Grid coarse_;
  CubicRows rows_;
  std::vector<float> potential_, heat_, convergent_km_;
};

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

  /// A place on the mesh for a place on the planet: outlines bend at scales below the mesh's.
  [[nodiscard]] Vector3 bent(const Vector3& at) const {
    constexpr double kWavelength_km = 420.0, kNormal = 2.2;
    const double frequency = radius_km_ / kWavelength_km;
    Vector3 to = at;
    for (int c = 0; c < 3; ++c) {
      to[c] += kNormal * p_.outline_bending_km / radius_km_ * bend_[c].fbm(at, frequency, 6, 0.55);
    }
    return normalised(to);
  }

  /// Plates, velocities, boundaries, ages of the floor, heat.
  void draw(StageIo& io) const {
    const auto plate = io.write(field::plate_id);
    const auto east = io.write(field::plate_velocity_east);
    const auto north = io.write(field::plate_velocity_north);
    const auto type = io.write(field::boundary_type);
    const auto strength = io.write(field::boundary_strength);
    const auto heat = io.write(field::heat_anomaly);
    const auto& mesh = grown_.mesh();
    const double half_width_km =
        std::max(0.5 * p_.boundary_width_km, 0.6e-3 * grid_.spacing_north_m(0));
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < grid_.ny(); ++j) {
      std::vector<float> scratch;
      smooth_fields_.heat(j, heat.subspan(grid_.cell(0, j), grid_.nx()), scratch);
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index cell = grid_.cell(i, j);
        const Vector3 at = grid_.unit_vector(i, j);
        const bool near = grown_.near_boundary(mesh.locate(at));
        const Vector3 place = near ? bent(at) : at;
        const MeshStencil stencil = stencil_at(mesh, place);
        const std::int16_t own = near ? grown_.plate_at(stencil) : grown_.plate()[stencil.cell[0]];
        plate[cell] = own;
        const Vector3 motion =
            velocity_mm_yr(grown_.plates()[own].rotation_rad_myr, at, radius_km_);
        const auto velocity = east_north(grid_.to_axis(motion), grid_.to_axis(at));
        east[cell] = static_cast<float>(velocity.east);
        north[cell] = static_cast<float>(velocity.north);
        age_[cell] = static_cast<float>(grown_.age_myr(stencil, own));
        type[cell] = static_cast<std::int8_t>(BoundaryType::interior);
        strength[cell] = 0.0F;
        if (!near) continue;
        const auto boundary = grown_.boundary_near(stencil, place, own);
        if (boundary.point == nullptr || boundary.distance_km > half_width_km) continue;
        type[cell] = static_cast<std::int8_t>(boundary.point->type);
        strength[cell] = static_cast<float>(boundary.point->strength);
      }
    }
  }

  /// Continents that grew from cratons: their edge is where the potential with its noise covers the
  /// wanted share; their margin falls off with the distance from it.
  void draw_cratons() const {
    std::vector<float> potential(grid_.size());
    const double frequency = radius_km_ / p_.coast_wavelength_km;
    constexpr double kNormal = 6.2, kSea = -9.0;  // fbm to unit deviation; no noise lifts that
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < grid_.ny(); ++j) {
      std::vector<float> scratch;
      smooth_fields_.potential(j, std::span(potential).subspan(grid_.cell(0, j), grid_.nx()),
                               scratch);
      for (int i = 0; i < grid_.nx(); ++i) {
        const Vector3 at = grid_.unit_vector(i, j);
        double value = potential[grid_.cell(i, j)];
        if (value > kSea) {
          value += kNormal * p_.coast_roughness * 0.5 * coast_.fbm(at, frequency, 9, 0.55);
        }
        potential[grid_.cell(i, j)] = static_cast<float>(value);
      }
    }
    const float edge = level_for_fraction(grid_, potential, 1.0 - p_.cratons.share);
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) potential[cell] -= edge;
    std::vector<float> distance_m(grid_.size());
    distance_to_coast(grid_, potential, distance_m);
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < grid_.ny(); ++j) {
      std::vector<float> scratch, convergent_km(grid_.nx());
      smooth_fields_.convergent_km(j, convergent_km, scratch);
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index cell = grid_.cell(i, j);
        const double passive = smooth_step(250.0, 900.0, convergent_km[i]);
        const double width_km =
            p_.active_margin_km + passive * (p_.passive_margin_km - p_.active_margin_km);
        const double inland_km = (potential[cell] >= 0.0F ? 1e-3 : -1e-3) * distance_m[cell];
        fraction_[cell] =
            static_cast<float>(smooth_step(-0.5 * width_km, 0.5 * width_km, inland_km));
      }
    }
    // Distances to a frayed edge are creased; margins are not.
    constexpr double kCreases_m = 30e3;
    smooth(grid_, fraction_, kCreases_m);
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      fraction_[cell] = std::clamp(fraction_[cell], 0.0F, 1.0F);
    }
  }

  /// Continents that are whole plates.
  void draw_plates(std::span<const std::int16_t> plate, double land_share) const {
    const double share = std::min(land_share + p_.land_buffer, 0.85);
    const auto continental =
        continental_plates(grown_.mesh(), grown_.plate(), grown_.plates(), share);
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
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < grid_.ny(); ++j) {
      std::vector<float> scratch, convergent_km(grid_.nx());
      smooth_fields_.convergent_km(j, convergent_km, scratch);
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index cell = grid_.cell(i, j);
        orogeny_[cell] = static_cast<std::int8_t>(OrogenyType::none);
        if (fraction_[cell] <= 0.0F) continue;
        const Vector3 at = grid_.unit_vector(i, j);
        const double reached_km = convergent_km[i];
        const bool reached = reached_km < p_.orogeny_reach_km && fraction_[cell] > 0.3F;
        const std::int32_t point = reached ? grown_.convergent_point(mesh.locate(at)) : -1;
        if (point >= 0) {
          orogeny_[cell] = static_cast<std::int8_t>(orogeny[point]);
        }
        const double old = std::clamp(0.5 + 2.0 * thermal_.fbm(at, frequency, 3), 0.0, 1.0);
        const double far = smooth_step(0.0, 1500.0, reached_km);
        const double thermal_myr = kYoungest_myr + (kOldest_myr - kYoungest_myr) * old * far;
        const double continental = smooth_step(0.3, 0.7, fraction_[cell]);
        age_[cell] += static_cast<float>(continental * (thermal_myr - age_[cell]));
      }
    }
  }

 private:
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
