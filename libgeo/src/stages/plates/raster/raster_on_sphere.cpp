#include "raster_on_sphere.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geo/core/field.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "raster.hpp"
#include "stages/plates/sphere/sphere_on_grid.hpp"

namespace geo {
namespace {

/// The model's world in the vocabulary of the planet, one value for each of its samples.
struct World {
  std::vector<float> height, age_myr, orogeny_age_myr;
  std::vector<std::int8_t> orogeny;
  std::vector<std::int16_t> plate;
  std::vector<std::array<float, 3>> fold, ridge;  // along contours of land and of the floor's age
};

/// Unit vectors across the gradient of a field about each sample, or zero.
std::vector<std::array<float, 3>> along_contours(const SphereMesh& mesh,
                                                 const std::vector<float>& field) {
  std::vector<Vector3> slope(mesh.size());
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    for (const std::int32_t j : mesh.neighbours(i)) {
      slope[i] = add(slope[i], add(mesh.samples().position(j), mesh.samples().position(i), -1.0),
                     field[j] - field[i]);
    }
  }
  std::vector<std::array<float, 3>> along(mesh.size());
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    Vector3 mean = slope[i];  // over the ring, as one cell's is rough
    for (const std::int32_t j : mesh.neighbours(i)) mean = add(mean, slope[j]);
    const Vector3 way = normalised(cross(mesh.samples().position(i), mean));
    for (int c = 0; c < 3; ++c) along[i][c] = static_cast<float>(way[c]);
  }
  return along;
}

World world_of(const RasterSphere& model, RasterMap map, const RasterScale& scale) {
  const std::size_t n = map.crust.size();
  const auto now = static_cast<double>(model.steps());
  World world;
  world.plate = std::move(map.plate);
  world.height.resize(n);
  world.age_myr.resize(n);
  world.orogeny_age_myr.resize(n);
  world.orogeny.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const RasterCrust& crust = map.crust[k];
    world.height[k] = crust.height;
    world.age_myr[k] = static_cast<float>(raster_age_myr(now - crust.born, scale));
    const RasterOrogeny orogeny = raster_orogeny(crust, now, scale);
    world.orogeny[k] = static_cast<std::int8_t>(orogeny.type);
    world.orogeny_age_myr[k] = static_cast<float>(orogeny.age_myr);
  }
  world.fold = along_contours(model.mesh(), world.height);
  world.ridge = along_contours(model.mesh(), world.age_myr);
  return world;
}

/// Values about a place as smooth as a cubic spline through cells: the samples within two spacings,
/// weighted with (1 - (r / 2)^2)^3.
class Smooth {
 public:
  Smooth(const SphereMesh& mesh, const Vector3& place, std::int32_t nearest) {
    add_sample(mesh, place, nearest);
    for (const std::int32_t ring : mesh.neighbours(nearest)) {
      add_sample(mesh, place, ring);
      for (const std::int32_t beyond : mesh.neighbours(ring)) add_sample(mesh, place, beyond);
    }
  }
  [[nodiscard]] double of(const std::vector<float>& values) const {
    double sum = 0.0, all = 0.0;
    for (int k = 0; k < count_; ++k) {
      sum += weight_[k] * values[sample_[k]];
      all += weight_[k];
    }
    return sum / all;
  }

 private:
  void add_sample(const SphereMesh& mesh, const Vector3& place, std::int32_t sample) {
    if (count_ == kMost ||
        std::find(sample_.begin(), sample_.begin() + count_, sample) != sample_.begin() + count_) {
      return;
    }
    constexpr double kReach = 2.0;
    const double far =
        length(add(mesh.samples().position(sample), place, -1.0)) / mesh.samples().spacing();
    const double left = 1.0 - far * far / (kReach * kReach);
    if (left <= 0.0) return;
    sample_[count_] = sample;
    weight_[count_++] = left * left * left;
  }
  static constexpr int kMost = 40;
  std::array<std::int32_t, kMost> sample_{};
  std::array<double, kMost> weight_{};
  int count_ = 0;
};

/// Lays the model's world on the lattice that the planet is drawn from.
class Laying {
 public:
  Laying(const PlatesParameters& p, const RasterSphere& model, const RasterScale& scale,
         const SphereMesh& mesh, const Context& context)
      : model_(model), scale_(scale), mesh_(mesh) {
    RasterMap map = model.map();
    std::vector<float> heights;
    for (const RasterCrust& crust : map.crust) heights.push_back(crust.height);
    height_.resize(mesh.size());
    nearest_.resize(mesh.size());
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      nearest_[i] = model_.mesh().samples().nearest(mesh_.samples().position(i));
      height_[i] = static_cast<float>(around(i).of(heights));
    }
    fit_scale(height_, wanted_ocean(context), p.raster.median_land_m, scale_);
    world_ = world_of(model, std::move(map), scale_);
  }

  [[nodiscard]] SphereState state() const {
    SphereState state;
    state.crust.resize(mesh_.size());
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < mesh_.size(); ++i) lay(i, state.crust);
    set_plates(state);
    return state;
  }

 private:
  [[nodiscard]] Smooth around(std::int32_t i) const {
    return {model_.mesh(), mesh_.samples().position(i), nearest_[i]};
  }

  void lay(std::int32_t i, SphereCrust& crust) const {
    constexpr double kContinental_m = 12e3;
    const Smooth about = around(i);
    const std::int32_t cell = nearest_[i];
    // Metres from the smooth height, not smooth metres: shores stay where the height is the sea's.
    const double height = height_[i], age = about.of(world_.age_myr);
    const double ocean_crust = model_.settings().ocean_crust;
    const double thickness = raster_thickness_m(height, ocean_crust, scale_);
    crust.plate[i] = world_.plate[cell];
    crust.elevation_m[i] = static_cast<float>(raster_elevation_m(height, age, ocean_crust, scale_));
    crust.thickness_m[i] = static_cast<float>(thickness);
    crust.continental[i] = thickness >= kContinental_m ? 1 : 0;
    crust.age_myr[i] = static_cast<float>(age);
    if (crust.continental[i] != 0) {
      crust.orogeny[i] = world_.orogeny[cell];
      crust.orogeny_age_myr[i] = static_cast<float>(about.of(world_.orogeny_age_myr));
      crust.fold[i] = world_.fold[cell];
    } else {
      crust.ridge[i] = world_.ridge[cell];
    }
  }

  void set_plates(SphereState& state) const {
    // Numbers without holes: plates may have gone.
    std::vector<std::int16_t> number(model_.plates().size(), -1);
    for (const std::int16_t plate : state.crust.plate) number[plate] = 0;
    for (std::size_t p = 0; p < number.size(); ++p) {
      if (number[p] < 0) continue;
      number[p] = static_cast<std::int16_t>(state.plates.size());
      const Vector3& rotation = model_.plates()[p].rotation;
      SpherePlate& rigid = state.plates.emplace_back();
      rigid.speed_rad_myr = length(rotation) / scale_.step_myr;
      if (rigid.speed_rad_myr > 0.0) rigid.axis = normalised(rotation);
    }
    for (std::int16_t& plate : state.crust.plate) plate = number[plate];
    state.pairs.assign(state.plates.size() * state.plates.size(), {});
  }

  const RasterSphere& model_;
  RasterScale scale_;
  const SphereMesh& mesh_;
  World world_;
  std::vector<float> height_;
  std::vector<std::int32_t> nearest_;
};

}  // namespace

void lay_on_sphere(const PlatesParameters& parameters, const RasterSphere& model, RasterScale scale,
                   StageIo& io, const Context& context) {
  const FibonacciSphere samples(static_cast<std::int32_t>(parameters.samples));
  const SphereMesh mesh(samples);
  SphereSettings settings = parameters.sphere;
  settings.radius_km = 1e-3 * io.grid().figure().radius_m;
  SphereTectonics planet(mesh, settings, Laying(parameters, model, scale, mesh, context).state(),
                         context.seed);
  // Pieces too small to be plates join their neighbours.
  finish(planet);
  constexpr double kWhole_m = 22e3;  // its plains are low and their crust thin
  SphereOnGrid(parameters, planet, io, context, kWhole_m).draw(io);
}

}  // namespace geo
