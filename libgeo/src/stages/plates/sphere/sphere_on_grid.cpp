#include "sphere_on_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/noise/noise_row.hpp"
#include "geo/kernels/plates/plate_motion.hpp"

namespace geo {
namespace {

/// None in floor; in continents at least half, so that no stretched margin counts as floor.
double continental_share(const SphereCrust& crust, std::int32_t sample, double whole_m) {
  constexpr double kOceanic_m = 8e3;
  if (crust.continental[sample] == 0) return 0.0;
  const double whole = (crust.thickness_m[sample] - kOceanic_m) / (whole_m - kOceanic_m);
  return 0.5 + 0.5 * std::clamp(whole, 0.0, 1.0);
}

}  // namespace

/// Places on the lattice for cells along a row: near plate boundaries and coasts, outlines bend at
/// scales below the lattice's.
class SphereOnGrid::Bends {
 public:
  explicit Bends(const SphereOnGrid& on)
      : on_(on),
        noise_{Noise(on.seed_, "plates.bend_x"), Noise(on.seed_, "plates.bend_y"),
               Noise(on.seed_, "plates.bend_z")},
        row_(on.grid_),
        sample_(on.grid_.nx()) {
    for (auto& along : along_) along.resize(on.grid_.nx());
  }
  void read(int row) {
    const FibonacciSphere& samples = on_.mesh_.samples();
    for (int i = 0; i < on_.grid_.nx(); ++i) {
      sample_[i] = samples.nearest(on_.grid_.unit_vector(i, row));
    }
    row_.choose(row, [&](int i) { return is_bent(i); });
    constexpr double kWavelength = 9.0;  // spacings of the lattice
    for (int c = 0; c < 3; ++c) {
      row_.fbm(noise_[c], 1.0 / (kWavelength * samples.spacing()), 6, 0.55, along_[c]);
    }
  }
  [[nodiscard]] bool is_bent(int column) const { return on_.is_edge_[sample_[column]] != 0; }
  [[nodiscard]] std::int32_t sample(int column) const { return sample_[column]; }
  [[nodiscard]] Vector3 bent(int column, const Vector3& at) const {
    constexpr double kMost = 2.2;  // spacings, at the noise's rare extremes
    const double most = kMost * on_.mesh_.samples().spacing();
    return normalised({at[0] + most * along_[0][column], at[1] + most * along_[1][column],
                       at[2] + most * along_[2][column]});
  }

 private:
  const SphereOnGrid& on_;
  std::array<Noise, 3> noise_;
  NoiseRow row_;
  std::vector<std::int32_t> sample_;
  std::array<std::vector<float>, 3> along_;
};

SphereOnGrid::SphereOnGrid(const PlatesParameters& parameters, const SphereTectonics& model,
                           StageIo& io, const Context& context, double whole_m)
    : p_(parameters),
      model_(model),
      mesh_(*model.mesh),
      grid_(io.grid()),
      radius_km_(1e-3 * io.grid().figure().radius_m),
      whole_m_(whole_m),
      cell_km_(1e-3 * io.grid().spacing_north_m(io.grid().ny() / 2)),
      seed_(context.seed) {
  const SphereCrust& crust = model.state.crust;
  boundaries_ = find_sphere_boundaries(mesh_, crust.plate, model.rotation, p_.growth.speed_cm_yr,
                                       p_.boundary_smoothing_km, radius_km_);
  std::vector<std::int32_t> samples;
  for (const SphereBoundary& point : boundaries_) samples.push_back(point.sample);
  nearest_boundary_ = nearest_samples(
      mesh_, samples, 3.0 * mesh_.samples().spacing() + p_.boundary_width_km / radius_km_);

  if (p_.model == "sphere") {
    find_polarity();
    trenches_.emplace(model, boundaries_, overrides_, p_.slab_trench_m, radius_km_);
  }

  std::vector<std::uint8_t> edge(mesh_.size(), 0);
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < mesh_.size(); ++i) {
    for (const std::int32_t j : mesh_.neighbours(i)) {
      if (crust.plate[j] != crust.plate[i] || crust.continental[j] != crust.continental[i]) {
        edge[i] = 1;
      }
    }
  }
  // One ring more, so that what bends reaches nobody who does not.
  is_edge_ = edge;
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<std::uint8_t> inner = is_edge_;
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      for (const std::int32_t j : mesh_.neighbours(i)) is_edge_[i] |= inner[j];
    }
  }
}

/// Which of the two plates at each boundary sample stays up, as the drift itself would decide.
void SphereOnGrid::find_polarity() {
  const auto& plate = model_.state.crust.plate;
  overrides_.assign(boundaries_.size(), 0);
  for (std::size_t k = 0; k < boundaries_.size(); ++k) {
    const SphereBoundary& point = boundaries_[k];
    for (const std::int32_t j : mesh_.neighbours(point.sample)) {
      if (plate[j] != point.other) continue;
      overrides_[k] = is_on_top(model_, point.sample, j) ? 1 : 0;
      break;
    }
  }
}

void SphereOnGrid::draw(StageIo& io) const {
  const DriftedFields out(io, p_.model == "sphere");
  ParallelErrors errors;
#pragma omp parallel
  {
    auto made = errors.make<Bends>(*this);
#pragma omp for schedule(dynamic, 4)
    for (int j = 0; j < grid_.ny(); ++j) {
      errors.guard([&] {
        Bends& bends = *made;
        bends.read(j);
        for (int i = 0; i < grid_.nx(); ++i) {
          const Index cell = grid_.cell(i, j);
          const Vector3 unit = grid_.unit_vector(i, j);
          const Vector3 place = bends.is_bent(i) ? bends.bent(i, unit) : unit;
          const std::int32_t nearest =
              bends.is_bent(i) ? mesh_.samples().nearest(place) : bends.sample(i);
          const Cell at{mesh_.locate(place, nearest), nearest};
          draw_crust(at, cell, unit, out);
          draw_boundary(at, cell, place, out);
        }
      });
    }
  }
  errors.rethrow();
}

void SphereOnGrid::draw_crust(const Cell& at, Index cell, const Vector3& unit,
                              const DriftedFields& out) const {
  const SphereCrust& crust = model_.state.crust;
  const std::int16_t plate = crust.plate[at.nearest];
  out.plate[cell] = model_.state.plates[plate].id;
  const Vector3 up = grid_.to_axis(unit);
  const auto velocity =
      east_north(grid_.to_axis(velocity_mm_yr(model_.rotation[plate], unit, radius_km_)), up);
  out.east[cell] = static_cast<float>(velocity.east);
  out.north[cell] = static_cast<float>(velocity.north);
  double fraction = 0.0, elevation = 0.0, thickness = 0.0;
  Vector3 fold{}, ridge{};
  for (int k = 0; k < 3; ++k) {
    const std::int32_t i = at.place.corner[k];
    const double weight = at.place.weight[k];
    fraction += weight * continental_share(crust, i, whole_m_);
    elevation += weight * crust.elevation_m[i];
    thickness += weight * crust.thickness_m[i];
    for (int c = 0; c < 3; ++c) {
      fold[c] += weight * crust.fold[i][c];
      ridge[c] += weight * crust.ridge[i][c];
    }
  }
  if (trenches_) {
    elevation += (1.0 - fraction) * trenches_->elevation_m(at.place, cell_km_);
  }
  const bool land = fraction >= 0.5;
  const double own_age = age(at, plate, land);
  out.fraction[cell] = static_cast<float>(std::clamp(fraction, 0.0, 1.0));
  out.elevation[cell] = static_cast<float>(elevation);
  out.thickness[cell] = static_cast<float>(thickness);
  out.age[cell] = static_cast<float>(own_age);
  out.orogeny_age[cell] = land ? static_cast<float>(own_age) : 0.0F;
  out.orogeny[cell] = crust.orogeny[at.nearest];
  out.heat[cell] = heat(unit);
  // Drifting plates know which way the ground was shortened: folds lie across it.
  const Vector3 way = grid_.to_axis(fold);
  const auto folds = east_north(p_.model == "sphere" ? cross(up, way) : way, up);
  const auto ridges = east_north(grid_.to_axis(ridge), up);
  out.fold_east[cell] = static_cast<float>(folds.east);
  out.fold_north[cell] = static_cast<float>(folds.north);
  out.ridge_east[cell] = static_cast<float>(ridges.east);
  out.ridge_north[cell] = static_cast<float>(ridges.north);
}

void SphereOnGrid::draw_boundary(const Cell& at, Index cell, const Vector3& bent,
                                 const DriftedFields& out) const {
  out.type[cell] = static_cast<std::int8_t>(BoundaryType::interior);
  out.strength[cell] = 0.0F;
  if (!out.polarity.empty()) out.polarity[cell] = 0;
  const double half_width_km =
      std::max(0.5 * p_.boundary_width_km, 0.6e-3 * grid_.spacing_north_m(0));
  const double half = 0.5 * mesh_.samples().spacing();
  const std::int16_t own = model_.state.crust.plate[at.nearest];
  double least_km = half_width_km;
  for (const std::int32_t corner : at.place.corner) {
    if (nearest_boundary_[corner] < 0) continue;
    const SphereBoundary& point = boundaries_[nearest_boundary_[corner]];
    const double far = length(add(mesh_.samples().position(point.sample), bent, -1.0));
    const double far_km = radius_km_ * std::max(0.0, far + (point.plate == own ? half : -half));
    if (far_km > least_km) continue;
    least_km = far_km;
    out.type[cell] = static_cast<std::int8_t>(point.type);
    out.strength[cell] = static_cast<float>(point.strength);
    if (out.polarity.empty()) continue;
    constexpr std::int8_t kNone = 0, kOverriding = 1, kSubducting = 2;
    const bool is_above = (overrides_[nearest_boundary_[corner]] != 0) == (point.plate == own);
    out.polarity[cell] = point.type != BoundaryType::convergent ? kNone
                         : is_above                             ? kOverriding
                                                                : kSubducting;
  }
}

/// Age of the crust of one type about a place, on its own plate where that has some there: ages
/// jump where plates meet and crust changes.
double SphereOnGrid::age(const Cell& at, std::int16_t plate, bool land) const {
  const SphereCrust& crust = model_.state.crust;
  for (const bool any_plate : {false, true}) {
    double sum = 0.0, weights = 0.0;
    for (int k = 0; k < 3; ++k) {
      const std::int32_t i = at.place.corner[k];
      if ((crust.continental[i] != 0) != land) continue;
      if (!any_plate && crust.plate[i] != plate) continue;
      sum += at.place.weight[k] * (land ? crust.orogeny_age_myr[i] : crust.age_myr[i]);
      weights += at.place.weight[k];
    }
    if (weights > 0.0) return sum / weights;
  }
  return land ? crust.orogeny_age_myr[at.nearest] : crust.age_myr[at.nearest];
}

/// Warmth of the mantle: plumes on an even background.
float SphereOnGrid::heat(const Vector3& unit) const {
  constexpr double kPlume_km = 260.0, kPlumeHeat = 0.5, kBackground = 0.2;
  double value = kBackground;
  for (const SpherePlume& plume : model_.state.plumes) {
    const double far = radius_km_ * length(add(plume.place, unit, -1.0)) / kPlume_km;
    if (far < 5.0) value += kPlumeHeat * std::exp(-0.5 * far * far);
  }
  return static_cast<float>(std::min(value, 1.0));
}

}  // namespace geo
