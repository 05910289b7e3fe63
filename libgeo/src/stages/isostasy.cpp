#include "geo/stages/isostasy.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/convergent_margins.hpp"
#include "geo/kernels/cubic_rows.hpp"
#include "geo/kernels/noise.hpp"
#include "geo/kernels/smoothing.hpp"
#include "geo/stages/sea_level.hpp"

namespace geo {
namespace {

constexpr auto kConvergent = static_cast<std::int8_t>(BoundaryType::convergent);
constexpr auto kDivergent = static_cast<std::int8_t>(BoundaryType::divergent);
constexpr auto kTransform = static_cast<std::int8_t>(BoundaryType::transform);

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

double bell(double x, double middle, double width) {
  const double t = (x - middle) / width;
  return std::exp(-0.5 * t * t);
}

/// Gradient noise of several octaves scaled to unit standard deviation.
class Swell {
 public:
  Swell(std::uint64_t seed, std::string_view stream, double radius_km, double wavelength_km,
        int octaves, double gain)
      : noise_(seed, stream),
        frequency_(radius_km / wavelength_km),
        octaves_(octaves),
        gain_(gain) {
    double sum = 0.0, squares = 0.0, amplitude = 1.0;
    for (int k = 0; k < octaves; ++k, amplitude *= gain) {
      sum += amplitude;
      squares += amplitude * amplitude;
    }
    constexpr double kDeviation = 0.29;  // of one octave
    scale_ = sum / (kDeviation * std::sqrt(squares));
  }
  double operator()(const std::array<double, 3>& at) const {
    return scale_ * noise_.fbm(at, frequency_, octaves_, gain_);
  }

 private:
  Noise noise_;
  double frequency_;
  int octaves_;
  double gain_, scale_;
};

/// The planet as far as plates shape it from afar: nothing here is sharper than some tens of
/// kilometres, so a grid of that spacing holds it, the same for all finer ones.
class Coarse {
 public:
  static constexpr int kColumns = 1024;

  explicit Coarse(const Grid& fine)
      : fine_(fine),
        grid_(fine.nx() <= kColumns
                  ? fine
                  : Grid::sphere(kColumns, kColumns / 2, fine.figure(), fine.turn())) {}

  [[nodiscard]] const Grid& grid() const { return grid_; }

  /// The value at the middle of each cell.
  template <class T>
  [[nodiscard]] std::vector<T> middle(std::span<const T> values) const {
    std::vector<T> out(grid_.size());
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      const auto [i, j] = first(grid_.column(cell), grid_.row(cell), 0.5);
      out[cell] = values[fine_.cell(i, j)];
    }
    return out;
  }
  /// The strongest boundary within each cell.
  void strongest(std::span<const std::int8_t> type, std::span<const float> strength,
                 std::vector<std::int8_t>& coarse_type, std::vector<float>& coarse_strength) const {
    coarse_type.assign(grid_.size(), 0);
    coarse_strength.assign(grid_.size(), 0.0F);
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      const int column = grid_.column(cell), row = grid_.row(cell);
      const auto [i0, j0] = first(column, row, 0.0);
      const auto [i1, j1] = first(column + 1, row + 1, 0.0);
      for (int j = j0; j < std::max(j1, j0 + 1); ++j) {
        for (int i = i0; i < std::max(i1, i0 + 1); ++i) {
          const Index at = fine_.cell(i, j);
          if (type[at] == 0 || strength[at] <= coarse_strength[cell]) continue;
          coarse_type[cell] = type[at];
          coarse_strength[cell] = strength[at];
        }
      }
    }
  }

 private:
  [[nodiscard]] std::pair<int, int> first(int column, int row, double within) const {
    return {std::min(fine_.nx(), static_cast<int>((column + within) * fine_.nx() / grid_.nx())),
            std::min(fine_.ny(), static_cast<int>((row + within) * fine_.ny() / grid_.ny()))};
  }
  const Grid& fine_;
  Grid grid_;
};

/// Everything the stage knows on the coarse grid.
struct Tectonics {
  std::vector<float> convergent, divergent, transform, weakness;  // 0 to 1
  std::vector<float> thickening, arc, trench_m;                   // cross sections of margins
  std::vector<float> rift_km;                 // distance to divergent boundaries
  std::vector<float> offshore_km, inland_km;  // distance to continental crust, to the ocean's
  std::vector<float> thickness_noise_km, swell_m, ocean_swell, relict;
  std::vector<float> flexure_m;
};

class Isostasy {
 public:
  Isostasy(const IsostasyParameters& parameters, StageIo& io, Context& context)
      : p_(parameters),
        context_(context),
        grid_(io.grid()),
        radius_km_(1e-3 * io.grid().figure().radius_m),
        coarse_(io.grid()),
        datum_(parameters.density),
        plate_(io.read(field::plate_id)),
        type_(io.read(field::boundary_type)),
        strength_(io.read(field::boundary_strength)),
        age_myr_(io.read(field::crust_age)),
        heat_(io.read(field::heat_anomaly)),
        east_(io.read(field::plate_velocity_east)),
        north_(io.read(field::plate_velocity_north)),
        fraction_(io.write(field::continental_fraction)),
        convergent_(io.write(field::convergent_deformation)),
        divergent_(io.write(field::divergent_deformation)),
        transform_(io.write(field::transform_deformation)),
        weakness_(io.write(field::lithospheric_weakness)),
        thickness_m_(io.write(field::crust_thickness)),
        density_(io.write(field::crust_density)),
        rock_(io.write(field::rock_type)),
        erodibility_(io.write(field::erodibility)),
        elevation_m_(io.write(field::elevation)) {}

  void run() {
    deform();
    context_.advance(0.3);
    if (p_.crust == "blueprint") {
      blueprint_crust();
      stiffen_blueprint();
    } else {
      thicken();
      bend_plate();
      context_.advance(0.4);
      margins_crust();
    }
    context_.advance(0.8);
    set_sea_level();
    classify_rock();
    report();
  }

 private:
  // Step 1: what boundaries do to the crust around them (blueprint 3.2).
  void deform() {
    const Grid& grid = coarse_.grid();
    std::vector<std::int8_t> type;
    std::vector<float> strength;
    coarse_.strongest(type_, strength_, type, strength);
    const auto fraction = coarse_.middle(std::span<const float>(fraction_));
    const auto spread = [&](std::int8_t which, double length_km) {
      auto field = propagated_deformation(grid, type, strength, which, length_km);
      smooth(grid, field, 1e3 * p_.deformation_smoothing_km);
      return field;
    };
    std::vector<std::uint8_t> boundary(grid.size()), ridge(grid.size()), continent(grid.size()),
        ocean(grid.size());
    for (Index cell = 0; cell < grid.size(); ++cell) {
      boundary[cell] = type[cell] != 0;
      ridge[cell] = type[cell] == kDivergent;
      continent[cell] = fraction[cell] > 0.5F;
      ocean[cell] = fraction[cell] < 0.5F;
    }
#pragma omp parallel sections
    {
#pragma omp section
      t_.convergent = spread(kConvergent, p_.convergent_length_km);
#pragma omp section
      t_.divergent = spread(kDivergent, p_.divergent_length_km);
#pragma omp section
      t_.transform = spread(kTransform, p_.transform_length_km);
#pragma omp section
      t_.rift_km = distance_to_marked_km(grid, ridge);
#pragma omp section
      t_.offshore_km = distance_to_marked_km(grid, continent);
#pragma omp section
      t_.inland_km = distance_to_marked_km(grid, ocean);
#pragma omp section
      {
        t_.weakness = distance_to_marked_km(grid, boundary);
        for (float& value : t_.weakness) {
          value = static_cast<float>(std::exp(-value / p_.weakness_length_km));
        }
      }
    }
    for (float& km : t_.rift_km) km = std::min(km, 5000.0F);
    for (float& km : t_.offshore_km) km = std::min(km, 20000.0F);
    for (float& km : t_.inland_km) km = std::min(km, 20000.0F);
    smooth(grid, t_.inland_km, 80e3);
    margins_ = {};
    if (p_.crust == "blueprint") return;
    std::vector<float> speed(grid_.size());
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      speed[cell] = std::hypot(east_[cell], north_[cell]);
    }
    margins_ =
        convergent_margins(grid, coarse_.middle(plate_), type, strength, fraction,
                           coarse_.middle(age_myr_), coarse_.middle(std::span<const float>(speed)));
  }

  // Step 2: cross sections of margins, old belts, broad variation.
  void thicken() {
    const Grid& grid = coarse_.grid();
    const Swell along(context_.seed, "isostasy.belts", radius_km_, 1100.0, 3, 0.6);
    const Swell shift(context_.seed, "isostasy.belt_shift", radius_km_, 700.0, 3, 0.6);
    const Swell noise(context_.seed, "isostasy.thickness", radius_km_, 3200.0, 4, 0.55);
    const Swell swell(context_.seed, "isostasy.swells", radius_km_, 2600.0, 5, 0.6);
    const Swell floor(context_.seed, "isostasy.ocean_swells", radius_km_, 2800.0, 4, 0.55);
    const Swell suture(context_.seed, "isostasy.sutures", radius_km_, 4200.0, 4, 0.5);
    const Swell worn(context_.seed, "isostasy.worn", radius_km_, 2000.0, 3, 0.6);
    for (auto* field : {&t_.thickening, &t_.arc, &t_.trench_m, &t_.thickness_noise_km, &t_.swell_m,
                        &t_.ocean_swell, &t_.relict}) {
      field->assign(grid.size(), 0.0F);
    }
#pragma omp parallel for schedule(dynamic, 8)
    for (int j = 0; j < grid.ny(); ++j) {
      for (int i = 0; i < grid.nx(); ++i) {
        const Index cell = grid.cell(i, j);
        const auto at = grid.unit_vector(i, j);
        t_.ocean_swell[cell] = static_cast<float>(floor(at));
        t_.thickness_noise_km[cell] = static_cast<float>(p_.thickness_noise_km * noise(at));
        // Plateaus stand further above the middle of continents than basins lie below it.
        const double up = std::exp(0.6 * swell(at)) - std::exp(0.18);
        t_.swell_m[cell] = static_cast<float>(p_.swell_m * up / 0.8);
        const double age = smooth_step(-0.4, 1.2, worn(at));
        t_.relict[cell] = static_cast<float>(age * bell(suture(at), 0.0, 0.16));
        if (std::abs(margins_.across_km[cell]) > 2500.0F) continue;
        const double far = std::abs(margins_.across_km[cell]);
        const double across =
            margins_.across_km[cell] + 55.0 * shift(at) * smooth_step(40, 200, far);
        const double strength =
            std::clamp(margins_.strength[cell] * (1.0 + 0.35 * along(at)), 0.05, 1.3);
        switch (margins_.kind[cell]) {
          case Convergence::oceans:
            t_.arc[cell] = static_cast<float>(island_arc(across, strength));
            t_.trench_m[cell] = static_cast<float>(trench_m(margins_.across_km[cell], strength));
            break;
          case Convergence::ocean_continent:
            t_.thickening[cell] = static_cast<float>(andean_thickening(across, strength));
            t_.trench_m[cell] = static_cast<float>(trench_m(margins_.across_km[cell], strength));
            break;
          case Convergence::continents:
            t_.thickening[cell] = static_cast<float>(himalayan_thickening(across, strength));
            break;
          default:
            break;
        }
      }
    }
    smooth(grid, t_.thickening, 2e3 * p_.deformation_smoothing_km);
    smooth(grid, t_.arc, 0.7e3 * p_.deformation_smoothing_km);
    smooth(grid, t_.trench_m, 0.6e3 * p_.deformation_smoothing_km);
    t_.convergent = t_.thickening;
    for (Index cell = 0; cell < grid.size(); ++cell) t_.convergent[cell] += t_.arc[cell];
  }

  /// A dry column under the sea, whose water loads it unless the compensation is dry.
  [[nodiscard]] double balanced(double dry_m) const {
    return p_.compensation == "airy-dry" ? dry_m : datum_.loaded(dry_m);
  }

  /// Thickness of a column, km, from what the coarse grid says and its continental fraction.
  [[nodiscard]] double continental_km(double noise, double thickening, double relict,
                                      double divergent, double transform) const {
    return p_.continental_km + noise + p_.collision_km * thickening + p_.relict_km * relict +
           p_.transpression_km * transform - p_.rift_km * 0.35 * divergent;
  }

  // Step 3: what the plate's stiffness changes (Turcotte et al. 1981): w - F w for the deflection w
  // of local balance under belts and arcs. Margins were cut and filled while the plate was warm and
  // weak: they stay in local balance.
  void bend_plate() {
    const Grid& grid = coarse_.grid();
    t_.flexure_m.assign(grid.size(), 0.0F);
    if (p_.compensation != "flexural" || p_.elastic_thickness_km <= 0.0) return;
    const double share = p_.density.continental_crust / p_.density.mantle;
    std::vector<float> local(grid.size());
    for (Index cell = 0; cell < grid.size(); ++cell) {
      local[cell] = static_cast<float>(1e3 * share *
                                       (p_.collision_km * t_.thickening[cell] +
                                        p_.relict_km * t_.relict[cell] + p_.arc_km * t_.arc[cell]));
    }
    t_.flexure_m = held_up_m(local);
  }

  /// What the plate's stiffness holds up of deflections of local balance, on the coarse grid, m.
  [[nodiscard]] std::vector<float> held_up_m(const std::vector<float>& local_m) const {
    ElasticPlate plate = p_.plate;
    plate.thickness_m = 1e3 * p_.elastic_thickness_km;
    plate.mantle_kg_m3 = p_.density.mantle;
    plate.infill_kg_m3 = 0.0;
    plate.gravity_m_s2 = context_.planet.gravity_m_s2;
    plate.radius_m = 1e3 * radius_km_;
    std::vector<float> held(local_m), flexed(local_m);
    flex(coarse_.grid(), flexed, plate);
    for (std::size_t cell = 0; cell < held.size(); ++cell) held[cell] -= flexed[cell];
    return held;
  }

  // Step 4: columns on the full grid.
  void margins_crust() {
    const CubicRows rows(coarse_.grid(), grid_);
    const Swell land(context_.seed, "isostasy.land", radius_km_, 420.0, 7, 0.52);
    const Swell ranges(context_.seed, "isostasy.ranges", radius_km_, 230.0, 4, 0.55);
    const Swell hills(context_.seed, "isostasy.hills", radius_km_, 260.0, 6, 0.6);
    const Swell mounts(context_.seed, "isostasy.seamounts", radius_km_, 330.0, 3, 0.6);
    const double sinking = 1e-3 * AiryDatum::kColdLithosphereM;
    const double craton_slope = (1.0 - p_.density.continental_crust / p_.density.mantle) / sinking;
#pragma omp parallel
    {
      std::vector<float> scratch;
      std::vector<std::vector<float>> line(14, std::vector<float>(grid_.nx()));
#pragma omp for schedule(dynamic, 4)
      for (int j = 0; j < grid_.ny(); ++j) {
        int k = 0;
        const auto take = [&](const std::vector<float>& field) -> const std::vector<float>& {
          rows.read(field, j, line[k], scratch);
          return line[k++];
        };
        const auto& thickening = take(t_.thickening);
        const auto& arc = take(t_.arc);
        const auto& trench = take(t_.trench_m);
        const auto& divergent = take(t_.divergent);
        const auto& transform = take(t_.transform);
        const auto& weakness = take(t_.weakness);
        const auto& rift = take(t_.rift_km);
        const auto& offshore = take(t_.offshore_km);
        const auto& inland = take(t_.inland_km);
        const auto& noise = take(t_.thickness_noise_km);
        const auto& swell = take(t_.swell_m);
        const auto& relict = take(t_.relict);
        const auto& ocean = take(t_.ocean_swell);
        const auto& flexure = take(t_.flexure_m);
        for (int i = 0; i < grid_.nx(); ++i) {
          const Index cell = grid_.cell(i, j);
          const auto at = grid_.unit_vector(i, j);
          const double share = fraction_[cell];
          const double belt = std::clamp(static_cast<double>(thickening[i]), 0.0, 1.3);
          const double island = std::max(0.0F, arc[i]);
          const double hot = p_.heat_m * heat_[cell];
          convergent_[cell] =
              static_cast<float>(std::clamp(share * belt + (1 - share) * island, 0.0, 1.0));
          divergent_[cell] = std::clamp(divergent[i], 0.0F, 1.0F);
          transform_[cell] = std::clamp(transform[i], 0.0F, 1.0F);
          weakness_[cell] = std::clamp(weakness[i], 0.0F, 1.0F);

          double continent_m = 0.0, ocean_m = 0.0, continent_km = p_.oceanic_km;
          double rough = 0.0;
          if (share > 0.0 || island > 0.02) rough = land(at);
          if (share > 0.0) {
            const double fabric = belt > 0.01 || relict[i] > 0.02 ? ranges(at) : 0.0;
            continent_km =
                continental_km(noise[i], belt * (1.0 + 0.16 * fabric),
                               relict[i] * (1.0 + 0.3 * fabric), divergent[i], transform[i]);
            // Thick cratons have thick, heavy roots; belts are warm.
            const double lithosphere =
                p_.lithosphere + p_.craton_compensation * craton_slope * noise[i] - 0.12 * belt;
            const double valley = divergent[i] * (-1500.0 * bell(rift[i], 0.0, 38.0) +
                                                  900.0 * bell(rift[i], 95.0, 55.0));
            const double relief = p_.land_roughness_m * (1.0 + 3.0 * belt + 1.5 * relict[i]);
            continent_m = balanced(datum_.dry_elevation_m(
                              1e3 * continent_km, p_.density.continental_crust, lithosphere)) +
                          swell[i] + valley + relief * rough + hot * 0.6 -
                          p_.margin_tilt_m * std::exp(-inland[i] / p_.margin_tilt_km);
          }
          if (share < 1.0) {
            const double age = age_myr_[cell];
            const double in_trench = std::clamp(-trench[i] / 1500.0, 0.0, 1.0);
            const double sediment_m =
                deep_sediment_m(p_.sediment, age, offshore[i]) * (1.0 - 0.6 * in_trench);
            const double buried = 1.0 / (1.0 + sediment_m / 700.0);
            const double mount = std::max(0.0, mounts(at) - 1.9);
            ocean_m = -ocean_depth_m(std::min(age, 200.0)) +
                      datum_.rise_per_sediment() * sediment_m + p_.ocean_swell_m * ocean[i] +
                      p_.seafloor_roughness_m * buried * hills(at) +
                      p_.seamount_m * std::min(1.5, mount) + hot * (1.0 - 0.3 * share) -
                      0.25 * p_.heat_m + island * (2600.0 + 1500.0 * rough) + trench[i];
          }
          const double h = share;
          thickness_m_[cell] = static_cast<float>(
              1e3 * std::clamp(p_.oceanic_km + (continent_km - p_.oceanic_km) * h +
                                   p_.arc_km * island * (1.0 - h),
                               3.0, 80.0));
          density_[cell] =
              static_cast<float>(p_.density.oceanic_crust +
                                 (p_.density.continental_crust - p_.density.oceanic_crust) * h);
          elevation_m_[cell] =
              static_cast<float>(ocean_m + (continent_m - ocean_m) * h +
                                 (share > 0.0 ? trench[i] * 0.5 * h : 0.0) + flexure[i]);
        }
      }
    }
  }

  /// Blueprint 3.1 to 3.6 as written, with lengths in place of passes.
  void blueprint_crust() {
    const CubicRows rows(coarse_.grid(), grid_);
    smooth(grid_, fraction_, 1e3 * p_.coast_smoothing_km);
    const Noise coast(context_.seed, "isostasy.coast"), crust(context_.seed, "isostasy.crust"),
        crust_again(context_.seed, "isostasy.crust_again"),
        overlay(context_.seed, "isostasy.overlay");
    const auto octave = [](const Noise& noise, const std::array<double, 3>& at, double f) {
      return noise.value(static_cast<float>(at[0] * f), static_cast<float>(at[1] * f),
                         static_cast<float>(at[2] * f));
    };
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < grid_.ny(); ++j) {
      for (int i = 0; i < grid_.nx(); ++i) {
        float& share = fraction_[grid_.cell(i, j)];
        const auto at = grid_.unit_vector(i, j);
        const double n = 0.10 * octave(coast, at, 4) + 0.04 * octave(coast, at, 8) +
                         0.01 * octave(coast, at, 16);
        const double margin = 1.0 - std::abs(2.0 * share - 1.0);
        share = static_cast<float>(std::clamp(share + n * margin, 0.0, 1.0));
      }
    }
    constexpr double kThreePasses_m = 26e3;
    smooth(grid_, fraction_, kThreePasses_m);
    std::vector<float> scratch;
    for (int j = 0; j < grid_.ny(); ++j) {
      const auto row = [&](std::span<float> field) {
        return field.subspan(grid_.cell(0, j), grid_.nx());
      };
      rows.read(t_.convergent, j, row(convergent_), scratch);
      rows.read(t_.divergent, j, row(divergent_), scratch);
      rows.read(t_.transform, j, row(transform_), scratch);
      rows.read(t_.weakness, j, row(weakness_), scratch);
    }
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < grid_.ny(); ++j) {
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index cell = grid_.cell(i, j);
        const auto at = grid_.unit_vector(i, j);
        for (const auto& field : {fraction_, convergent_, divergent_, transform_, weakness_}) {
          field[cell] = std::clamp(field[cell], 0.0F, 1.0F);
        }
        const double share = fraction_[cell];
        if (share > 0.1) convergent_[cell] *= weakness_[cell];
        const double noise =
            p_.thickness_noise_km * (octave(crust, at, 3) + 0.5 * octave(crust_again, at, 6));
        const double base = p_.oceanic_km + (p_.continental_km + noise - p_.oceanic_km) * share;
        const double change =
            convergent_[cell] * (p_.arc_km + (p_.collision_km - p_.arc_km) * share) -
            divergent_[cell] * p_.rift_km + transform_[cell] * p_.transpression_km;
        thickness_m_[cell] = static_cast<float>(1e3 * std::clamp(base + change, 5.0, 75.0));
      }
    }
    smooth(grid_, thickness_m_, 1e3 * p_.crust_smoothing_km);
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < grid_.ny(); ++j) {
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index cell = grid_.cell(i, j);
        const auto at = grid_.unit_vector(i, j);
        const double share = fraction_[cell];
        const double density = p_.density.oceanic_crust +
                               (p_.density.continental_crust - p_.density.oceanic_crust) * share;
        density_[cell] = static_cast<float>(density * (1.0 - p_.thermal_coefficient * heat_[cell]));
        const double noise = 60.0 * octave(overlay, at, 3) + 35.0 * octave(overlay, at, 6) +
                             18.0 * octave(overlay, at, 12) + 7.0 * octave(overlay, at, 24);
        elevation_m_[cell] =
            static_cast<float>(blueprint_elevation_m(cell) + p_.noise_factor * noise);
      }
    }
  }

  /// Height of a blueprint column: dry as the blueprint has it (3.3), or on the ridge's datum with
  /// the sea's load and a lithosphere as cold as the floor is old.
  [[nodiscard]] double blueprint_elevation_m(Index cell) const {
    if (p_.compensation == "airy-dry") {
      return airy_freeboard_m(thickness_m_[cell], density_[cell], p_.density.mantle);
    }
    const double share = fraction_[cell];
    const double floor =
        datum_.lithosphere_of_depth(ocean_depth_m(std::min(age_myr_[cell], 200.0F)));
    const double lithosphere = share * p_.lithosphere + (1.0 - share) * floor;
    return datum_.loaded(datum_.dry_elevation_m(thickness_m_[cell], density_[cell], lithosphere));
  }

  /// Stiffness under a blueprint crust: what it holds up of the crust's own weight.
  void stiffen_blueprint() {
    if (p_.compensation != "flexural" || p_.elastic_thickness_km <= 0.0) return;
    auto local = coarse_.middle(std::span<const float>(thickness_m_));
    const auto density = coarse_.middle(std::span<const float>(density_));
    for (std::size_t cell = 0; cell < local.size(); ++cell) {
      local[cell] *= density[cell] / static_cast<float>(p_.density.mantle);
    }
    const std::vector<float> held = held_up_m(local);
    const CubicRows rows(coarse_.grid(), grid_);
    std::vector<float> line(grid_.nx()), scratch;
    for (int j = 0; j < grid_.ny(); ++j) {
      rows.read(held, j, line, scratch);
      for (int i = 0; i < grid_.nx(); ++i) elevation_m_[grid_.cell(i, j)] += line[i];
    }
  }

  // Step 5: the sea covers its share; sediment builds its margins up towards its level.
  void set_sea_level() {
    const auto level = static_cast<float>(sea_level_m(grid_, elevation_m_, context_.planet));
    shift_m_ = level;
    const bool shelves = p_.crust == "margins" && p_.shelf_depth_m > 0.0;
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      float& z = elevation_m_[cell];
      z -= level;
      if (!shelves || z >= 0.0F) continue;
      const double on_shelf = smooth_step(0.7, 0.95, fraction_[cell]);
      if (on_shelf <= 0.0) continue;
      const double filled = -p_.shelf_depth_m * -std::expm1(z / p_.shelf_depth_m);
      z = std::min(-1e-3F, static_cast<float>(z + on_shelf * (filled - z)));
    }
  }

  // Step 6: rock and erodibility (blueprint 3.5).
  void classify_rock() {
    const Noise strata(context_.seed, "isostasy.strata");
    static constexpr std::array<float, 6> kErodibility{1.0e-6F, 1.2e-6F, 0.5e-6F,
                                                       0.8e-6F, 2.0e-6F, 3.0e-6F};
    const double frequency = radius_km_ / 700.0;
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < grid_.ny(); ++j) {
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index cell = grid_.cell(i, j);
        RockType rock = RockType::basalt;
        if (fraction_[cell] < 0.5F) {
          if (convergent_[cell] > 0.3F) rock = RockType::schist;
        } else if (convergent_[cell] > 0.5F) {
          rock = RockType::granite;
        } else if (convergent_[cell] > 0.15F) {
          rock = RockType::quartzite;
        } else if (divergent_[cell] > 0.3F) {
          rock = RockType::sandstone;
        } else if (transform_[cell] > 0.2F) {
          rock = RockType::schist;
        } else {
          const float n = strata.fbm(grid_.unit_vector(i, j), frequency, 4);
          rock = n < -0.06F  ? RockType::limestone
                 : n < 0.06F ? RockType::sandstone
                             : RockType::granite;
        }
        rock_[cell] = static_cast<std::int8_t>(rock);
        const float fault = type_[cell] != 0 ? 1.5F : 1.0F;
        // Smoothing must not lose digits: millionths become ones.
        erodibility_[cell] = 1e6F * kErodibility[static_cast<int>(rock)] * fault;
      }
    }
    constexpr double kThreePasses_m = 26e3;
    smooth(grid_, erodibility_, kThreePasses_m);
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      erodibility_[cell] = 1e-6F * std::clamp(erodibility_[cell], 0.5F, 4.5F);
    }
  }

  void report() {
    double continental = 0.0, volume = 0.0, crust = 0.0;
    for (int j = 0; j < grid_.ny(); ++j) {
      double area = 0.0, cubic = 0.0, all = 0.0;
      for (Index cell = grid_.cell(0, j); cell < grid_.cell(0, j) + grid_.nx(); ++cell) {
        area += fraction_[cell];
        cubic += static_cast<double>(fraction_[cell]) * thickness_m_[cell];
        all += thickness_m_[cell];
      }
      continental += area * grid_.area_m2(j);
      volume += cubic * grid_.area_m2(j);
      crust += all * grid_.area_m2(j);
    }
    context_.budget["continental_area_m2"] = continental;
    context_.budget["continental_crust_m3"] = volume;
    context_.budget["crust_m3"] = crust;
    context_.budget["sea_level_shift_m"] = shift_m_;
  }

  const IsostasyParameters& p_;
  Context& context_;
  const Grid& grid_;
  double radius_km_;
  Coarse coarse_;
  AiryDatum datum_;
  std::span<const std::int16_t> plate_;
  std::span<const std::int8_t> type_;
  std::span<const float> strength_, age_myr_, heat_, east_, north_;
  std::span<float> fraction_, convergent_, divergent_, transform_, weakness_, thickness_m_,
      density_;
  std::span<std::int8_t> rock_;
  std::span<float> erodibility_, elevation_m_;
  Tectonics t_;
  ConvergentMargins margins_;
  double shift_m_ = 0.0;
};

class IsostasyStage final : public Stage {
 public:
  explicit IsostasyStage(IsostasyParameters parameters) : parameters_(std::move(parameters)) {}

  [[nodiscard]] const StageInfo& info() const override {
    static const StageInfo kInfo{
        "isostasy",
        "crust, rock and the height at which they float",
        {&field::plate_id, &field::continental_fraction, &field::boundary_type,
         &field::boundary_strength, &field::crust_age, &field::heat_anomaly,
         &field::plate_velocity_east, &field::plate_velocity_north},
        {},
        {&field::convergent_deformation, &field::divergent_deformation,
         &field::transform_deformation, &field::lithospheric_weakness, &field::continental_fraction,
         &field::crust_thickness, &field::crust_density, &field::rock_type, &field::erodibility,
         &field::elevation}};
    return kInfo;
  }
  [[nodiscard]] std::vector<Parameter> parameters() override { return parameters_.declarations(); }

  void run(StageIo& io, Context& context) const override {
    if (io.grid().topology() != Topology::sphere) {
      throw InputError("isostasy: the grid must be a whole sphere");
    }
    Isostasy(parameters_, io, context).run();
  }

 private:
  IsostasyParameters parameters_;
};

}  // namespace

std::unique_ptr<Stage> make_isostasy_stage(IsostasyParameters parameters) {
  return std::make_unique<IsostasyStage>(std::move(parameters));
}

}  // namespace geo
