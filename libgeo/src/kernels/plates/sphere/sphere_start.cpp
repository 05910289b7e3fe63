#include "geo/kernels/plates/sphere/sphere_start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "geo/core/random.hpp"
#include "geo/kernels/crust/crust_columns.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/plates/sphere/sphere_boundaries.hpp"
#include "sphere_flood.hpp"

namespace geo {
namespace {

/// Age at which floor of GDH1 lies at a depth once sediment has filled it up. The load takes half
/// of its thickness back. Sediment outgrows subsidence at 123 Myr: older floor cannot be told.
double age_below_sediment_myr(double depth_m, double oldest_myr) {
  constexpr double kShallower = 0.5, kNoApron_km = 1e4, kTold_myr = 120.0;
  double low = 0.0, high = std::min(oldest_myr, kTold_myr);
  for (int k = 0; k < 30; ++k) {
    const double age = 0.5 * (low + high);
    const double sediment_m = deep_sediment_m(DeepSediment{}, age, kNoApron_km);
    (ocean_depth_m(age) - kShallower * sediment_m < depth_m ? low : high) = age;
  }
  return low;
}

class InitialConditions {
 public:
  InitialConditions(const SphereMesh& mesh, const SphereStart& start,
                    const SphereSettings& settings, std::uint64_t seed)
      : mesh_(mesh), start_(start), settings_(settings), seed_(seed) {
    state_.crust.resize(mesh.size());
  }

  SphereState make() {
    cut_plates();
    draw_continents();
    if (start_.supercontinent && start_.plate.empty()) join_continental_plates();
    draw_elevation();
    return std::move(state_);
  }

 private:
  void take_plates() {
    for (std::size_t p = 0; p < start_.rotation_rad_myr.size(); ++p) {
      const Vector3& rotation = start_.rotation_rad_myr[p];
      SpherePlate plate;
      plate.chances.descent = p;
      if (!start_.driver.empty()) plate.driver = start_.driver[p];
      plate.speed_rad_myr = length(rotation);
      if (plate.speed_rad_myr > 0.0) plate.axis = normalised(rotation);
      state_.add_plate(plate);
    }
    state_.crust.plate = start_.plate;
  }

  /// Voronoi cells of centroids that keep apart, as warped distances see them.
  void cut_plates() {
    if (!start_.plate.empty()) return take_plates();
    const RandomStream random(seed_, "plates.sphere");
    std::vector<Vector3> centroids;
    for (std::int64_t k = 0; k < start_.plates; ++k) {
      // The farthest of three candidates from those before: cells of unequal size, none tiny.
      Vector3 best{};
      double most = -1.0;
      for (std::uint64_t c = 0; c < 3; ++c) {
        const Vector3 at = random.direction(3 * static_cast<std::uint64_t>(k) + c);
        double least = 9.0;
        for (const Vector3& other : centroids) {
          least = std::min(least, length(add(at, other, -1.0)));
        }
        if (least > most) {
          most = least;
          best = at;
        }
      }
      centroids.push_back(best);
      SpherePlate plate;
      plate.chances.descent = static_cast<std::uint64_t>(k);
      plate.axis = random.direction(100000 + static_cast<std::uint64_t>(k));
      plate.speed_rad_myr = settings_.law.speed_mm_yr / settings_.radius_km *
                            random.uniform(200000 + static_cast<std::uint64_t>(k), 0, 0.2, 1.0);
      state_.add_plate(plate);
    }
    const std::array<Noise, 3> warp{Noise(seed_, "plates.warp_x"), Noise(seed_, "plates.warp_y"),
                                    Noise(seed_, "plates.warp_z")};
    const double amplitude = 2.2 * start_.warp_km / settings_.radius_km;
    constexpr double kWavelength_km = 3000.0;
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      const Vector3& straight = mesh_.samples().position(i);
      Vector3 at = straight;
      for (int c = 0; c < 3; ++c) {
        at[c] += amplitude * warp[c].fbm(straight, settings_.radius_km / kWavelength_km, 6, 0.5);
      }
      // A small planet's places are moved far off it.
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < centroids.size(); ++k) {
        const double far = length(add(at, centroids[k], -1.0));
        if (far >= least) continue;
        least = far;
        state_.crust.plate[i] = static_cast<std::int16_t>(k);
      }
    }
  }

  void draw_continents() {
    const std::int32_t n = mesh_.size();
    const auto wanted = static_cast<std::int32_t>(std::lround(start_.continental_share * n));
    SphereCrust& crust = state_.crust;
    if (start_.whole_plates) {
      // Plates in random order until the share is reached as nearly as may be.
      const RandomStream random(seed_, "plates.continental");
      std::vector<std::int32_t> size(state_.plates.size(), 0), order(state_.plates.size());
      for (const std::int16_t plate : crust.plate) ++size[plate];
      std::iota(order.begin(), order.end(), 0);
      std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
        return random.uniform(static_cast<std::uint64_t>(a)) <
               random.uniform(static_cast<std::uint64_t>(b));
      });
      std::vector<std::uint8_t> chosen(state_.plates.size(), 0);
      std::int32_t sum = 0;
      for (const std::int32_t p : order) {
        if (std::abs(sum + size[p] - wanted) >= std::abs(sum - wanted)) continue;
        sum += size[p];
        chosen[p] = 1;
      }
      for (std::int32_t i = 0; i < n; ++i) {
        crust.continental[i] = static_cast<std::int8_t>(chosen[crust.plate[i]]);
      }
      return;
    }
    const auto height = !start_.elevation_m.empty() ? start_.elevation_m : drawn_height();
    if (!start_.elevation_m.empty() || start_.smallest_sea_km2 <= 0.0) {
      return raise_highest(height, wanted);
    }
    // What is closed is land too: so much less of the noise is taken.
    constexpr int kRounds = 6;
    std::int32_t highest = wanted;
    for (int round = 0; round < kRounds && highest > 0; ++round) {
      raise_highest(height, highest);
      const std::int32_t excess = highest + close_small_seas() - wanted;
      if (std::abs(excess) <= n / 2000) return;
      highest -= excess;
    }
  }

  /// Noise whose highest places are continents: anywhere, or about one place.
  [[nodiscard]] std::vector<float> drawn_height() const {
    const Noise noise(seed_, "plates.continents");
    std::vector<float> height = fbm_at(noise, mesh_.samples().positions(),
                                       settings_.radius_km / start_.continent_km, 8, 0.55);
    if (!start_.supercontinent) return height;
    constexpr double kGathering = 2.0;  // over the noise's own range, of about 1
    const Vector3 middle = RandomStream(seed_, "plates.supercontinent").direction(0);
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      height[i] += static_cast<float>(kGathering * dot(middle, mesh_.samples().position(i)));
    }
    return height;
  }
  /// Plates that are mostly continent become one, which carries the supercontinent.
  void join_continental_plates() {
    std::vector<std::int32_t> size(state_.plates.size(), 0), land(size);
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      ++size[state_.crust.plate[i]];
      land[state_.crust.plate[i]] += state_.crust.continental[i];
    }
    std::vector<std::int16_t> joined(size.size());
    std::vector<SpherePlate> kept;
    std::int16_t carrier = -1;
    for (std::size_t p = 0; p < size.size(); ++p) {
      const bool is_land = 2 * land[p] > size[p];
      if (is_land && carrier >= 0) {
        joined[p] = carrier;
        continue;
      }
      joined[p] = static_cast<std::int16_t>(kept.size());
      if (is_land) carrier = joined[p];
      kept.push_back(state_.plates[p]);
    }
    state_.plates.clear();
    state_.pairs.clear();
    for (const SpherePlate& plate : kept) state_.add_plate(plate);
    for (std::int16_t& plate : state_.crust.plate) plate = joined[plate];
  }
  /// The highest samples are continents.
  void raise_highest(std::span<const float> height, std::int32_t count) {
    std::vector<float> sorted(height.begin(), height.end());
    const std::int32_t n = mesh_.size(), at = std::clamp(n - count, 0, n - 1);
    std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
    for (std::int32_t i = 0; i < n; ++i) {
      state_.crust.continental[i] = count > 0 && height[i] >= sorted[at] ? 1 : 0;
    }
  }

  /// Hollows of the noise within a continent are basins on it and not holes down to ocean floor,
  /// which nothing could ever take away: samples that became land. The largest sea stays.
  std::int32_t close_small_seas() {
    auto& continental = state_.crust.continental;
    const double sample_km2 =
        4.0 * std::numbers::pi * settings_.radius_km * settings_.radius_km / mesh_.size();
    std::vector<std::uint8_t> seen(mesh_.size(), 0);
    std::vector<std::vector<std::int32_t>> seas;
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      if (seen[i] != 0 || continental[i] != 0) continue;
      seas.push_back(
          flooded_from(mesh_, i, seen, [&](std::int32_t j) { return continental[j] == 0; }));
    }
    const auto largest =
        std::ranges::max_element(seas, {}, [](const auto& sea) { return sea.size(); });
    std::int32_t closed = 0;
    for (auto sea = seas.begin(); sea != seas.end(); ++sea) {
      const auto size = static_cast<std::int32_t>(sea->size());
      if (sea == largest || size * sample_km2 >= start_.smallest_sea_km2) continue;
      for (const std::int32_t i : *sea) continental[i] = 1;
      closed += size;
    }
    return closed;
  }

  /// Share of its thickness that crust of a continent keeps: the first edges are passive margins,
  /// as wide as those that breaks make.
  [[nodiscard]] std::vector<double> shares_kept_at_edges() const {
    std::vector<double> kept(mesh_.size(), 1.0);
    if (settings_.margin_km <= 0.0) return kept;
    std::vector<std::int32_t> floor;
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      if (state_.crust.continental[i] == 0) floor.push_back(i);
    }
    const auto nearest = nearest_samples(mesh_, floor, settings_.margin_km / settings_.radius_km);
    const double half_km = 0.5 * mesh_.samples().spacing() * settings_.radius_km;
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      if (state_.crust.continental[i] == 0 || nearest[i] < 0) continue;
      const double inland_km =
          settings_.radius_km * angle_between(mesh_.samples().position(i),
                                              mesh_.samples().position(floor[nearest[i]])) -
          half_km;
      kept[i] = stretched_share(1.0 - std::clamp(inland_km / settings_.margin_km, 0.0, 1.0),
                                settings_.margin_necking);
    }
    return kept;
  }

  /// Low, worn continents; floor that ages away from the borders of its plate.
  void draw_elevation() {
    if (!start_.elevation_m.empty()) return take_elevation();
    SphereCrust& crust = state_.crust;
    const std::vector<float> boundary_km = distance_to_boundary_km();
    const Noise noise(seed_, "plates.first_relief");
    const auto lift =
        fbm_at(noise, mesh_.samples().positions(), settings_.radius_km / 1800.0, 5, 0.5);
    const std::vector<double> kept = shares_kept_at_edges();
    constexpr double kHalfRate_mm_yr = 35.0, kLow_m = 350.0, kAmplitude_m = 900.0;
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      if (crust.continental[i] != 0) {
        const double lift_m = std::max(10.0, kLow_m + kAmplitude_m * lift[i]);
        const double whole_m = 1e3 * start_.continental_km + settings_.rebound * (lift_m - kLow_m);
        const double lost_m = (1.0 - kept[i]) * whole_m;
        crust.elevation_m[i] =
            static_cast<float>(water_loaded(lift_m - lost_m / settings_.rebound));
        crust.thickness_m[i] = static_cast<float>(whole_m - lost_m);
        crust.orogeny_age_myr[i] = 1000.0F;
        continue;
      }
      const double oldest = start_.oldest_floor_myr;
      const double age = oldest * std::tanh(boundary_km[i] / kHalfRate_mm_yr / oldest);
      crust.age_myr[i] = static_cast<float>(age);
      crust.thickness_m[i] = static_cast<float>(1e3 * settings_.oceanic_km);
      crust.elevation_m[i] = static_cast<float>(
          settings_.floor_by_age
              ? -ocean_depth_m(age)
              : 1e3 * ridge_profile_km(boundary_km[i],
                                       settings_.ridge_falloff * settings_.radius_km,
                                       settings_.law));
    }
  }

  /// An elevation that was given, and the crust under it.
  void take_elevation() {
    SphereCrust& crust = state_.crust;
    constexpr float kNotFolded_myr = 1000.0F;
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      const double elevation_m = start_.elevation_m[i];
      crust.elevation_m[i] = static_cast<float>(elevation_m);
      if (crust.continental[i] != 0) {
        crust.thickness_m[i] = static_cast<float>(crust_column(elevation_m).thickness_m);
        crust.orogeny_age_myr[i] = kNotFolded_myr;
        continue;
      }
      crust.thickness_m[i] = static_cast<float>(1e3 * settings_.oceanic_km);
      crust.age_myr[i] =
          static_cast<float>(ocean_age_of_depth_myr(-elevation_m, start_.oldest_floor_myr));
    }
    if (start_.real_floor) date_real_floor();
    // What stands higher or lower than floor of its age goes on doing so.
    if (!settings_.floor_by_age) return;
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      if (crust.continental[i] != 0) continue;
      crust.thickness_m[i] +=
          crust.elevation_m[i] + static_cast<float>(ocean_depth_m(crust.age_myr[i]));
    }
  }

  /// Ages by what is known of them, else by the depth of plain floor, away from what continents
  /// have put on it; the rest is as old as the nearest plain floor.
  void date_real_floor() {
    SphereCrust& crust = state_.crust;
    const std::int32_t n = mesh_.size();
    const auto is_known = [&](std::int32_t i) {
      return !start_.age_myr.empty() && std::isfinite(start_.age_myr[i]);
    };
    const double apron = kApron_km / settings_.radius_km;
    std::vector<std::int32_t> continental, plain;
    for (std::int32_t i = 0; i < n; ++i) {
      if (crust.continental[i] != 0) continental.push_back(i);
    }
    const auto shore = nearest_samples(mesh_, continental, apron);
    for (std::int32_t i = 0; i < n; ++i) {
      if (crust.continental[i] != 0) continue;
      if (is_known(i)) {
        crust.age_myr[i] = std::max(0.0F, start_.age_myr[i]);
      } else if (shore[i] < 0) {
        crust.age_myr[i] = static_cast<float>(
            age_below_sediment_myr(-crust.elevation_m[i], start_.oldest_floor_myr));
      } else {
        continue;
      }
      plain.push_back(i);
    }
    const auto nearest = nearest_samples(mesh_, plain, kFarthest_km / settings_.radius_km);
    for (std::int32_t i = 0; i < n; ++i) {
      if (crust.continental[i] != 0 || nearest[i] < 0) continue;
      crust.age_myr[i] = crust.age_myr[plain[nearest[i]]];
    }
  }

  static constexpr double kApron_km = 300.0;      // from continents, where depth says nothing
  static constexpr double kFarthest_km = 1500.0;  // from plain floor of the same sea

  [[nodiscard]] std::vector<float> distance_to_boundary_km() const {
    const FibonacciSphere& samples = mesh_.samples();
    const auto& plate = state_.crust.plate;
    std::vector<std::int32_t> edge;
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      for (const std::int32_t j : mesh_.neighbours(i)) {
        if (plate[j] == plate[i]) continue;
        edge.push_back(i);
        break;
      }
    }
    const auto nearest = nearest_samples(mesh_, edge, 4.0);
    std::vector<float> distance(mesh_.size(), 20000.0F);
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      if (nearest[i] < 0) continue;
      distance[i] = static_cast<float>(
          settings_.radius_km *
          angle_between(samples.position(i), samples.position(edge[nearest[i]])));
    }
    return distance;
  }

  const SphereMesh& mesh_;
  const SphereStart& start_;
  const SphereSettings& settings_;
  std::uint64_t seed_;
  SphereState state_;
};

}  // namespace

SphereState start_sphere(const SphereMesh& mesh, const SphereStart& start,
                         const SphereSettings& settings, std::uint64_t seed) {
  return InitialConditions(mesh, start, settings, seed).make();
}

}  // namespace geo
