#include "raster_on_sphere.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geo/kernels/noise.hpp"
#include "geo/kernels/sphere_tectonics.hpp"
#include "raster.hpp"
#include "sphere_on_grid.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
enum Chart : int { kBelt, kNorth, kSouth };
constexpr int kCharts = 3;

/// A place of the tile and the directions of its x and y on the planet.
struct ChartPlace {
  double column, row;
  Vector3 x, y;
};

class Charts {
 public:
  Charts(const RasterWorld& world, double polar_circle_deg, std::uint64_t seed)
      : world_(world),
        per_radian_(world.columns / (2.0 * kPi)),
        circle_rad_(polar_circle_deg * kPi / 180.0),
        bend_(seed, "raster.polar_circle") {}

  /// The row of the tile that lies on the equator.
  void shift(double row) { middle_ = row; }

  /// How much of a place is the cap's, 0 to 1.
  [[nodiscard]] double cap_share(const Vector3& at) const {
    constexpr double kBend_rad = 0.16, kHalfWidth_rad = 0.06;
    const double latitude = std::asin(std::clamp(at[2], -1.0, 1.0));
    const double circle = circle_rad_ + kBend_rad * bend_.fbm(at, 2.5, 5, 0.55) / 0.35;
    const double s =
        std::clamp(0.5 + 0.5 * (std::abs(latitude) - circle) / kHalfWidth_rad, 0.0, 1.0);
    return s * s * (3.0 - 2.0 * s);
  }

  [[nodiscard]] ChartPlace place(int chart, const Vector3& at) const {
    const double longitude = std::atan2(at[1], at[0]);
    const double c = std::cos(longitude), s = std::sin(longitude);
    const Vector3 east{-s, c, 0.0}, north = cross(at, east);
    if (chart == kBelt) {
      return {0.5 * world_.columns + longitude * per_radian_,
              middle_ + std::asin(std::clamp(at[2], -1.0, 1.0)) * per_radian_, east, north};
    }
    // Seen from above the pole; turned about at the south, so that the tile is not mirrored.
    const double side = chart == kNorth ? 1.0 : -1.0;
    const double far = std::sqrt(2.0 * std::max(0.0, 1.0 - side * at[2])) * per_radian_;
    const Vector3 out = scaled(north, -side), around = scaled(east, side);
    return {(chart == kNorth ? 0.25 : 0.75) * world_.columns + far * c,
            middle_ + 0.5 * world_.rows + side * far * s, add(scaled(out, c), around, -side * s),
            add(scaled(out, side * s), around, c)};
  }

 private:
  RasterWorld world_;
  double per_radian_, circle_rad_, middle_ = 0.0;
  Noise bend_;
};

/// Rotation, rad/Myr, whose velocities come nearest to some tangent vectors.
class RotationFit {
 public:
  void add_velocity(const Vector3& at, const Vector3& velocity) {
    const Vector3 moment = cross(at, velocity);
    for (int a = 0; a < 3; ++a) {
      moment_[a] += moment[a];
      for (int b = 0; b < 3; ++b) matrix_[a][b] += (a == b ? 1.0 : 0.0) - at[a] * at[b];
    }
    ++count_;
  }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] Vector3 rotation() const {
    // A plate of a few samples says little about turns about itself.
    auto m = matrix_;
    for (int a = 0; a < 3; ++a) m[a][a] += 1e-6 * count_;
    const double determinant = dot(m[0], cross(m[1], m[2]));
    const Vector3 a = cross(m[1], m[2]), b = cross(m[2], m[0]), c = cross(m[0], m[1]);
    return scaled(add(add(scaled(a, moment_[0]), b, moment_[1]), c, moment_[2]), 1.0 / determinant);
  }

 private:
  std::array<Vector3, 3> matrix_{};
  Vector3 moment_{};
  int count_ = 0;
};

class Laying {
 public:
  Laying(const PlatesParameters& p, const RasterTectonics& model, const RasterScale& scale,
         const Grid& grid, const SphereMesh& mesh, const Context& context)
      : model_(model),
        scale_(scale),
        grid_(grid),
        mesh_(mesh),
        charts_(model.settings().world, p.raster.polar_circle_deg, context.seed) {
    relief_ = raster_relief(model, scale_);
    shift_tile(wanted_ocean(context));
    fit_scale(heights(1), wanted_ocean(context), p.raster.median_land_m, scale_);
    relief_ = raster_relief(model, scale_);
  }

  [[nodiscard]] SphereState state() const {
    SphereState state;
    state.crust.resize(mesh_.size());
    const auto plates = static_cast<int>(model_.plates().size());
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < mesh_.size(); ++i) lay(i, state.crust);
    set_plates(kCharts * plates, state);
    return state;
  }

 private:
  /// The planet shows a part of the tile: the one, along y, whose share of land is nearest to what
  /// is wanted.
  void shift_tile(double ocean_share) {
    constexpr int kShifts = 32, kStride = 41;
    double best = 2.0;
    int choice = 0;
    for (int k = 0; k < kShifts; ++k) {
      charts_.shift(static_cast<double>(k) * model_.settings().world.rows / kShifts);
      const std::vector<float> some = heights(kStride);
      const auto sea = std::count_if(some.begin(), some.end(), [](float h) { return h < 1.0F; });
      const double off = std::abs(static_cast<double>(sea) / static_cast<double>(some.size()) -
                                  std::min(ocean_share, 0.71));
      if (off >= best) continue;
      best = off;
      choice = k;
    }
    charts_.shift(static_cast<double>(choice) * model_.settings().world.rows / kShifts);
  }
  /// Of the map, blended, at every so many samples.
  [[nodiscard]] std::vector<float> heights(int stride) const {
    std::vector<float> heights(mesh_.size() / stride);
#pragma omp parallel for schedule(static)
    for (std::size_t k = 0; k < heights.size(); ++k) {
      const Vector3 at =
          grid_.to_axis(mesh_.samples().position(static_cast<std::int32_t>(k) * stride));
      heights[k] = static_cast<float>(blended(relief_.height, at, charts_.cap_share(at)));
    }
    return heights;
  }
  [[nodiscard]] double blended(const std::vector<float>& values, const Vector3& at,
                               double cap) const {
    double sum = 0.0;
    for (const int chart :
         {static_cast<int>(kBelt), static_cast<int>(at[2] > 0.0 ? kNorth : kSouth)}) {
      const double weight = chart == kBelt ? 1.0 - cap : cap;
      if (weight <= 0.0) continue;
      const ChartPlace place = charts_.place(chart, at);
      sum += weight * smooth_value(model_.settings().world, values, place.column, place.row);
    }
    return sum;
  }

  void lay(std::int32_t i, SphereCrust& crust) const {
    constexpr double kContinental_m = 12e3;
    const Vector3 at = grid_.to_axis(mesh_.samples().position(i));
    const double cap = charts_.cap_share(at);
    const int polar = at[2] > 0.0 ? kNorth : kSouth;
    const int main = cap > 0.5 ? polar : kBelt;
    // Metres from the smooth height, not smooth metres: shores stay where the height is the sea's.
    const double height = blended(relief_.height, at, cap);
    const double age = blended(relief_.age_myr, at, cap);
    const double ocean_crust = model_.settings().ocean_crust;
    const double elevation = raster_elevation_m(height, age, ocean_crust, scale_);
    const double thickness = raster_thickness_m(height, ocean_crust, scale_);
    const ChartPlace place = charts_.place(main, at);
    const std::size_t cell = cell_of(place);
    crust.plate[i] = static_cast<std::int16_t>(main * static_cast<int>(model_.plates().size()) +
                                               relief_.plate[cell]);
    crust.elevation_m[i] = static_cast<float>(elevation);
    crust.thickness_m[i] = static_cast<float>(thickness);
    crust.continental[i] = thickness >= kContinental_m ? 1 : 0;
    crust.orogeny[i] = crust.continental[i] != 0 ? relief_.orogeny[cell] : std::int8_t{0};
    crust.age_myr[i] =
        static_cast<float>(smooth_value(relief_.world, relief_.age_myr, place.column, place.row));
    crust.orogeny_age_myr[i] =
        crust.continental[i] != 0
            ? static_cast<float>(
                  smooth_value(relief_.world, relief_.orogeny_age_myr, place.column, place.row))
            : 0.0F;
    const auto on_planet = [&](float x, float y) {
      const Vector3 way = add(scaled(place.x, x), place.y, y);
      return std::array<float, 3>{static_cast<float>(way[0]), static_cast<float>(way[1]),
                                  static_cast<float>(way[2])};
    };
    if (crust.continental[i] != 0) {
      crust.fold[i] = on_planet(relief_.fold_x[cell], relief_.fold_y[cell]);
    } else {
      crust.ridge[i] = on_planet(relief_.ridge_x[cell], relief_.ridge_y[cell]);
    }
  }

  void set_plates(int count, SphereState& state) const {
    const auto plates = static_cast<int>(model_.plates().size());
    const double rate = scale_.cell_km / scale_.step_myr / (1e-3 * grid_.figure().radius_m);
    std::vector<RotationFit> fits(count);
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      const int plate = state.crust.plate[i];
      const Vector3 at = grid_.to_axis(mesh_.samples().position(i));
      const ChartPlace place = charts_.place(plate / plates, at);
      const RasterVelocity v =
          raster_velocity(model_.plates()[plate % plates], relief_.world, place.column, place.row);
      fits[plate].add_velocity(at, scaled(add(scaled(place.x, v.x), place.y, v.y), rate));
    }
    // Numbers without holes; the frame of the samples, which may be turned against the axis.
    std::vector<std::int16_t> number(count, -1);
    for (int plate = 0; plate < count; ++plate) {
      if (fits[plate].empty()) continue;
      number[plate] = static_cast<std::int16_t>(state.plates.size());
      const Vector3 rotation = from_axis(fits[plate].rotation());
      SpherePlate& rigid = state.plates.emplace_back();
      rigid.speed_rad_myr = length(rotation);
      if (rigid.speed_rad_myr > 0.0) rigid.axis = normalised(rotation);
    }
    for (std::int16_t& plate : state.crust.plate) plate = number[plate];
    for (auto* field : {&state.crust.fold, &state.crust.ridge}) {
      for (auto& way : *field) {
        const Vector3 turned = from_axis({way[0], way[1], way[2]});
        for (int c = 0; c < 3; ++c) way[c] = static_cast<float>(turned[c]);
      }
    }
    state.pairs.assign(state.plates.size() * state.plates.size(), {});
  }

  /// The inverse of Grid::to_axis, whose rows are the images of the axes.
  [[nodiscard]] Vector3 from_axis(const Vector3& v) const {
    const Vector3 x = grid_.to_axis({1.0, 0.0, 0.0}), y = grid_.to_axis({0.0, 1.0, 0.0}),
                  z = grid_.to_axis({0.0, 0.0, 1.0});
    return {dot(x, v), dot(y, v), dot(z, v)};
  }

  [[nodiscard]] std::size_t cell_of(const ChartPlace& place) const {
    const RasterWorld& world = relief_.world;
    return static_cast<std::size_t>(world.row(static_cast<int>(std::floor(place.row)))) *
               world.columns +
           world.column(static_cast<int>(std::floor(place.column)));
  }

  const RasterTectonics& model_;
  RasterScale scale_;
  const Grid& grid_;
  const SphereMesh& mesh_;
  RasterRelief relief_;
  Charts charts_;
};

}  // namespace

void lay_on_sphere(const PlatesParameters& parameters, const RasterTectonics& model,
                   RasterScale scale, StageIo& io, const Context& context) {
  const FibonacciSphere samples(static_cast<std::int32_t>(parameters.samples));
  const SphereMesh mesh(samples);
  SphereSettings settings = parameters.sphere;
  settings.radius_km = 1e-3 * io.grid().figure().radius_m;
  SphereTectonics planet(mesh, settings,
                         Laying(parameters, model, scale, io.grid(), mesh, context).state(),
                         context.seed);
  // Small pieces that charts and grid cut off join their neighbours.
  planet.finish();
  constexpr double kWhole_m = 22e3;  // its plains are low and their crust thin
  SphereOnGrid(parameters, planet, io, context, kWhole_m).draw(io);
}

}  // namespace geo
