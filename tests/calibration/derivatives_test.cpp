// Derivatives of the forward model with everything that jumps frozen.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <set>

#include "small_planets.hpp"

namespace geo::calibration {
namespace {

using Jet = ceres::Jet<double, 1>;
using Complex = std::complex<double>;

/// Parameters of formulas; those of smoothing lengths and plates are differences of a kernel.
const std::vector<std::string> kExact{"isostasy.collision_km",
                                      "isostasy.continental_km",
                                      "isostasy.lithosphere",
                                      "isostasy.swell_m",
                                      "isostasy.thickness_noise_km",
                                      "isostasy.craton_compensation",
                                      "isostasy.ocean_swell_m",
                                      "isostasy.margin_tilt_m",
                                      "isostasy.margin_tilt_km",
                                      "isostasy.relict_km",
                                      "isostasy.arc_km",
                                      "isostasy.heat_m",
                                      "isostasy.shelf_depth_m",
                                      "isostasy.slab_trench_m",
                                      "isostasy.pelagic_rate_m_myr",
                                      "isostasy.apron_length_km",
                                      "isostasy.water_density_kg_m3",
                                      "isostasy.seafloor_roughness_m",
                                      "erosion.erodibility_factor",
                                      "erosion.area_exponent",
                                      "erosion.slope_exponent",
                                      "isostasy.collision_shortening",
                                      "isostasy.subduction_shortening",
                                      "isostasy.front_shortening",
                                      "erosion.damage",
                                      "erosion.uplift_mm_yr",
                                      "erosion.rebound_fraction",
                                      "erosion.rebound_time_yr",
                                      "erosion.warping_m",
                                      "erosion.subgrid_exponent",
                                      "planet.ocean_fraction"};
const std::vector<std::string> kDifferenced{
    "isostasy.deformation_smoothing_km", "isostasy.elastic_thickness_km",
    "isostasy.mantle_density_kg_m3",     "erosion.rebound_length_km",
    "erosion.diffusivity_m2_yr",         "erosion.time_step_yr"};

/// The planet of seed 1, routed.
struct Planet1 {
  explicit Planet1(int rows = 48, const std::string& assignment = "isostasy.ocean_depth_m=0",
                   const std::vector<std::string>& more = {})
      // Hillslopes enough to be seen on cells of 400 km.
      : run("erosion.diffusivity_m2_yr=500", assignment, more),
        planet(run.parameters, 1, 2 * rows, rows) {
    (void)planet.reroute(model);
  }
  double* member(const std::string& name) const {
    return std::get<double*>(model.find(name).storage);
  }
  template <class V>
  PlanetSurface<V> follow(const std::string& name, const V& unit) {
    double* const at = member(name);
    return planet.with_frozen_drainage<V>(model, ActiveVariables<V>({{at, V(*at) + unit}}));
  }

  SmallRun run;
  Model model{run.parameters};
  SeedPlanet planet;
};

double norm(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum);
}

std::vector<double> rate_by_jet(Planet1& p, const std::string& name) {
  const auto relief = p.follow<Jet>(name, Jet(0.0, 0));
  std::vector<double> rate;
  for (const Jet& z : relief.elevation_m) rate.push_back(z.v[0]);
  return rate;
}

std::vector<double> rate_by_complex_step(Planet1& p, const std::string& name) {
  constexpr double kStep = 1e-30;
  const auto relief = p.follow<Complex>(name, Complex(0.0, kStep));
  std::vector<double> rate;
  for (const Complex& z : relief.elevation_m) rate.push_back(z.imag() / kStep);
  return rate;
}

std::vector<double> rate_by_difference(Planet1& p, const std::string& name, double relative) {
  double* const at = p.member(name);
  const double value = *at, step = relative * std::max(std::abs(value), 1e-3);
  *at = value + step;
  const auto above = p.planet.with_frozen_drainage<double>(p.model, {}).elevation_m;
  *at = value - step;
  const auto below = p.planet.with_frozen_drainage<double>(p.model, {}).elevation_m;
  *at = value;
  std::vector<double> rate;
  for (std::size_t c = 0; c < above.size(); ++c) rate.push_back((above[c] - below[c]) / (2 * step));
  return rate;
}

/// Of the difference, the share of cells left out that a bend of the model lies next to.
double distance(std::vector<double> a, const std::vector<double>& b, double share_left_out) {
  std::vector<double> difference;
  for (std::size_t c = 0; c < a.size(); ++c) difference.push_back(std::abs(a[c] - b[c]));
  std::sort(difference.begin(), difference.end());
  difference.resize(std::size_t((1.0 - share_left_out) * double(difference.size())));
  return norm(difference) / norm(b);
}

TEST(Derivatives, DualNumbersAgreeWithTheComplexStep) {
  Planet1 p;
  for (const std::string& name : kExact) {
    const auto rate = rate_by_complex_step(p, name);
    EXPECT_GT(norm(rate), 0.0) << name;
    EXPECT_LT(distance(rate_by_jet(p, name), rate, 0.0), 1e-10) << name;
  }
}

TEST(Derivatives, OfGivenRatesOfUplift) {
  Planet1 p(48, "erosion.uplift_from=deformation");
  const auto rate = rate_by_complex_step(p, "erosion.convergent_uplift_mm_yr");
  EXPECT_GT(norm(rate), 0.0);
  EXPECT_LT(distance(rate_by_jet(p, "erosion.convergent_uplift_mm_yr"), rate, 0.0), 1e-10);
}

TEST(Derivatives, FollowContinentsThatSettle) {
  Planet1 p(48, "isostasy.ocean_depth_m=3690");
  for (const std::string name :
       {"isostasy.ocean_depth_m", "isostasy.collision_km", "isostasy.heat_m"}) {
    const auto rate = rate_by_complex_step(p, name);
    EXPECT_GT(norm(rate), 0.0) << name;
    EXPECT_LT(distance(rate_by_jet(p, name), rate, 0.0), 1e-10) << name;
    EXPECT_LT(distance(rate, rate_by_difference(p, name, 1e-6), 0.002), 1e-6) << name;
  }
}

TEST(Derivatives, AgreeWithCentralDifferencesOfTheFrozenModel) {
  Planet1 p;
  for (const auto* names : {&kExact, &kDifferenced}) {
    for (const std::string& name : *names) {
      const auto rate = rate_by_difference(p, name, 1e-6);
      EXPECT_GT(norm(rate), 0.0) << name;
      // A few cells stand at a bend (a shore, a shelf) within the step.
      EXPECT_LT(distance(rate_by_jet(p, name), rate, 0.002), 1e-6) << name;
    }
  }
}

/// Parameters that a calibration reads but that no figure follows smoothly, and why: freed, each is
/// refused.
const std::map<std::string, std::string> kSilent{
    {"planet.radius_km", "cells and plates are laid with it"},
    {"planet.flattening", "cells are laid with it"},
    {"planet.obliquity_deg", "climate alone"},
    {"planet.eccentricity", "climate alone"},
    {"planet.perihelion_deg", "climate alone"},
    {"isostasy.basin_fill", "heights are what is seen"},
    {"erosion.reference_runoff_mm_yr", "rain alone"},
    {"erosion.least_runoff_mm_yr", "rain alone"},
    {"erosion.strait_sill_m", "straits are frozen"},
    {"erosion.strait_drawdown", "straits are frozen"},
    {"erosion.strait_land_km", "straits are frozen"},
    {"erosion.strait_depth_m", "straits are frozen"},
    {"erosion.strait_width_km", "straits are frozen"},
    {"erosion.strait_sea_km2", "straits are frozen"},
    {"erosion.sediment.highstand_yr", "deltas are left out"},
    {"erosion.ice.stress_kpa", "climate alone"},
    {"erosion.ice.ice_melt_mm_k_d", "climate alone"},
    {"erosion.ice.snow_melt_mm_k_d", "climate alone"},
    {"erosion.ice.glacial_time_yr", "climate alone"},
    {"erosion.ice.glacial_share", "climate alone"},
    {"erosion.ice.glacial_cooling_k", "climate alone"},
    {"erosion.ice.abrasion", "climate alone"},
    {"erosion.ice.overdeepening", "climate alone"},
    {"erosion.ice.till_share", "climate alone"},
    {"erosion.ice.grounding_m", "climate alone"},
    {"planet.pressure_bar", "climate alone"},
    {"isostasy.convergent_length_km", "blueprint crust alone"},
    {"isostasy.crust_smoothing_km", "blueprint crust alone"},
    {"isostasy.coast_smoothing_km", "blueprint crust alone"},
    {"isostasy.thermal_coefficient", "blueprint crust alone"},
    {"isostasy.noise_factor", "blueprint crust alone"},
    {"isostasy.weakness_length_km", "weakness moves no elevation"},
    {"isostasy.trench_depth_m", "simulated crust alone"},
    {"isostasy.fracture_m", "simulated crust alone"},
    {"isostasy.fracture_spacing_km", "simulated crust alone"},
    {"isostasy.abyssal_hills_m", "simulated crust alone"},
    {"isostasy.fabric_age_myr", "simulated crust alone"},
    {"isostasy.detail_longest_km", "exemplars alone"},
    {"isostasy.detail_amplitude", "exemplars alone"},
    {"isostasy.old_orogeny_myr", "exemplars alone"},
    {"isostasy.plain_slope", "exemplars alone"},
    {"erosion.erodibility_yr", "the rocks' own takes its place"},
    {"erosion.uplift_speed_cm_yr", "0: rates hold for any speed of plates"},
    {"erosion.flow_exponent", "drainage is frozen"},
    {"erosion.land_smoothing_km", "must be 0 in a calibration"},
    {"erosion.hypsometry_median_m", "remaps of heights are refused"},
    {"erosion.hypsometry_smoothing_km", "remaps of heights are refused"},
    {"erosion.detail_noise", "must be 0 in a calibration"}};

/// All that the forward model gives, in one scale each: elevations, thicknesses, the rate of
/// erosion and the water.
template <class V, class Part>
std::vector<std::vector<double>> figures_of(const PlanetSurface<V>& relief, Part&& part) {
  std::vector<std::vector<double>> all(4);
  for (const V& z : relief.elevation_m) all[0].push_back(part(z));
  for (const V& h : relief.thickness_m) all[1].push_back(part(h));
  all[2].push_back(part(relief.erosion_rate_m_yr));
  all[3].push_back(part(relief.water_m3));
  return all;
}

/// Central differences over a step and half of it, extrapolated (Richardson).
std::vector<std::vector<double>> extrapolated_rate(Planet1& p, const std::string& name,
                                                   double relative) {
  double* const at = p.member(name);
  const double value = *at, step = relative * std::max(std::abs(value), 1e-3);
  const auto figures_at = [&](double moved) {
    *at = moved;
    auto figures =
        figures_of(p.planet.with_frozen_drainage<double>(p.model, {}), [](double x) { return x; });
    *at = value;
    return figures;
  };
  auto rate = figures_at(value + step);
  const auto below = figures_at(value - step), half_above = figures_at(value + 0.5 * step),
             half_below = figures_at(value - 0.5 * step);
  for (std::size_t f = 0; f < rate.size(); ++f) {
    for (std::size_t c = 0; c < rate[f].size(); ++c) {
      const double whole = (rate[f][c] - below[f][c]) / (2.0 * step);
      const double half = (half_above[f][c] - half_below[f][c]) / step;
      rate[f][c] = (4.0 * half - whole) / 3.0;
    }
  }
  return rate;
}

/// Every real parameter of planet, isostasy and erosion, on planets on which one or the other has a
/// say: either no figure follows it, whatever is done, or all derivatives are those of differences.
TEST(Derivatives, OfEveryParameterAreThoseOfDifferences) {
  constexpr int kRows = 20;
  const std::vector<std::vector<std::string>> worlds{
      {"isostasy.ocean_depth_m=0", "erosion.noise_injection_m=5",
       "erosion.relaxation_fraction=0.1"},
      {"isostasy.ocean_depth_m=3690", "erosion.model=detachment", "erosion.slope_exponent=1.3",
       "erosion.area_exponent=0.45"},
      {"planet.sea_level=volume", "erosion.uplift_from=boundaries", "isostasy.compensation=airy",
       "erosion.depressions=breach"},
      {"planet.ocean_fraction=0.5", "erosion.uplift_from=deformation", "erosion.model=detachment",
       "isostasy.compensation=airy-dry", "erosion.uplift_mm_yr=0.02",
       "erosion.rebound_length_km=0"}};
  std::set<std::string> heard;
  std::vector<std::string> names;
  for (const auto& assignments : worlds) {
    Planet1 p(kRows, assignments.front(), {assignments.begin() + 1, assignments.end()});
    names.clear();
    for (const Parameter& declaration : p.model.declarations()) {
      const std::string name(declaration.name);
      SCOPED_TRACE(name + " with " + assignments.front());
      names.push_back(name);
      const auto jets =
          figures_of(p.follow<Jet>(name, Jet(0.0, 0)), [](const Jet& x) { return x.v[0]; });
      double size = 0.0;
      for (const auto& jet : jets) size += norm(jet);
      ASSERT_TRUE(std::isfinite(size));
      // A process that is left out where its amount is 0 begins with a bend: refused as well.
      if (*p.member(name) == 0.0 && declaration.min == 0.0 && size == 0.0) continue;
      double best = std::numeric_limits<double>::infinity();
      // Noise is a float: its differences are rough. Elsewhere a bend may lie within a wide step,
      // and a narrow one lose digits, the more the less a figure follows: water where the sea keeps
      // its mean depth.
      for (const double step : {1e-4, 1e-3, 3e-3, 1e-5, 1e-6, 1e-2}) {
        const auto rates = extrapolated_rate(p, name, step);
        double worst = 0.0;
        bool moves = false;
        for (std::size_t f = 0; f < rates.size(); ++f) {
          if (norm(rates[f]) == 0.0) {
            worst = std::max(worst, norm(jets[f]));
            continue;
          }
          moves = true;
          worst = std::max(worst, distance(jets[f], rates[f], f < 2 ? 0.005 : 0.0));
        }
        if (moves) heard.insert(name);
        best = std::min(best, worst);
        if (best < 1e-5) break;
      }
      EXPECT_LT(best, name == "erosion.warping_km" ? 1e-3 : 1e-5);
    }
  }
  for (const std::string& name : names) {
    EXPECT_NE(heard.contains(name), kSilent.contains(name)) << name;
  }
}

/// Terms and quantiles of the objective follow as their figures do.
TEST(Derivatives, OfTermsAndQuantilesAreThoseOfDifferences) {
  SmallRun run("erosion.diffusivity_m2_yr=500", "isostasy.ocean_depth_m=0");
  run.settings.free =
      "isostasy.continental_km, isostasy.collision_km, planet.ocean_fraction, "
      "erosion.erodibility_factor, erosion.time_step_yr, isostasy.mantle_density_kg_m3";
  run.settings.terms =
      "land_fraction = 0.3 +- 0.01, water_volume_km3 = 1.3e9 +- 1e7, erosion_rate_mm_yr = 0.05 +- "
      "0.01, concavity = 0.4 +- 0.1, crust_thickness_q50_km = 35 +- 1";
  run.settings.priors = "isostasy.collision_km = 15 +- 2";
  Problem problem(run.parameters, run.settings, run.earth());
  Objective objective(problem, run.parameters, std::vector<std::int64_t>{1, 2}, 96, 48);
  const Eigen::VectorXd x = problem.present();
  objective.evaluate(x);
  Eigen::MatrixXd rates;
  objective.linearise(x, &rates);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    constexpr double kStep = 1e-6;
    Eigen::VectorXd above = x, below = x;
    above[i] += kStep;
    below[i] -= kStep;
    const Eigen::VectorXd difference =
        (objective.linearise(above) - objective.linearise(below)) / (2.0 * kStep);
    for (Eigen::Index r = 0; r < rates.rows(); ++r) {
      // A bend in one of the cells of a quantile is a small part of it.
      EXPECT_NEAR(rates(r, i), difference[r], 0.02 * std::abs(difference[r]) + 1e-4)
          << problem.free[i].declaration.name << ", residual " << r;
    }
    EXPECT_LT((rates.col(i) - difference).norm(), 2e-3 * difference.norm() + 1e-9)
        << problem.free[i].declaration.name;
  }
}

TEST(Derivatives, FrozenModelIsTheRoutedOneWhereItWasRouted) {
  Planet1 p;
  const auto routed = p.planet.reroute(p.model).elevation_m;
  const auto held = p.planet.with_frozen_drainage<double>(p.model, {}).elevation_m;
  EXPECT_EQ(routed, held);
}

/// By how much each cell of the model differs from a run's, m, ascending. The sea stands where it
/// does in the run.
std::vector<double> differences_from_run(SmallRun& run) {
  const Model model{run.parameters};
  SeedPlanet planet(run.parameters, 1, 96, 48, /*sea_in_gap=*/false);
  const auto relief = planet.reroute(model);
  State state(std::make_shared<const Grid>(run.grid()));
  Context context;
  context.planet = run.planet;
  context.seed = 1;
  std::vector<double> off_m;
  run.pipeline.run(state, context, 0, run.pipeline.find("erosion"),
                   {.before = [](int) {},
                    .after =
                        [&](int, const State& after, const Context&) {
                          if (!after.has(field::elevation)) return;
                          const auto now = after.read(field::elevation);
                          off_m.assign(now.begin(), now.end());
                        }});
  for (std::size_t c = 0; c < off_m.size(); ++c) {
    off_m[c] = std::abs(relief.elevation_m[c] - off_m[c]);
  }
  std::sort(off_m.begin(), off_m.end());
  return off_m;
}

/// A run keeps heights as floats, which are half a millimetre apart in the deep sea.
constexpr double kRounding_m = 0.005;

TEST(Derivatives, CrustFloatsAsInARun) {
  SmallRun run("isostasy.ocean_depth_m=0", "erosion.steps=0");
  EXPECT_LT(differences_from_run(run).back(), kRounding_m);
}

TEST(Derivatives, ValuesAreThoseOfARun) {
  SmallRun run("isostasy.ocean_depth_m=0", "erosion.diffusivity_m2_yr=500",
               {"erosion.discharge=area", "erosion.sediment.highstand_yr=0"});
  EXPECT_LT(differences_from_run(run).back(), kRounding_m);
}

/// dq / dtheta by the mean over the cells about a quantile, against what really becomes of the
/// curve of the frozen elevation when a parameter moves: over fiftieths of the area, 0.1 to 0.9.
TEST(Derivatives, QuantilesFollowTheMeanOfTheCellsThere) {
  constexpr int kParts = 50;
  // Where rivers lay down, many cells stand at one height, that of wave base: a step then changes
  // which cells a quantile is taken from. A sea that moves follows cells at the shore, which bend.
  Planet1 p(192, "isostasy.ocean_depth_m=0",
            {"erosion.model=detachment", "erosion.strait_sill_m=0"});
  const Grid& grid = p.planet.grid();
  const Ranking ranking(grid, p.planet.with_frozen_drainage<double>(p.model, {}).elevation_m);
  for (const std::string name :
       {"isostasy.lithosphere", "isostasy.collision_km", "isostasy.swell_m"}) {
    double* const at = p.member(name);
    const double value = *at, step = 0.005 * value;
    *at = value + step;
    const auto above = Ranking(grid, p.planet.with_frozen_drainage<double>(p.model, {}).elevation_m)
                           .bin_means(kParts);
    *at = value - step;
    const auto below = Ranking(grid, p.planet.with_frozen_drainage<double>(p.model, {}).elevation_m)
                           .bin_means(kParts);
    *at = value;
    const auto jets = p.follow<Jet>(name, Jet(0.0, 0));
    double error = 0.0, size = 0.0;
    for (int k = kParts / 10; k < kParts - kParts / 10; ++k) {
      const auto window = ranking.window((k + 0.5) / kParts, 0.5 / kParts);
      const double by_mean = ranking.mean(window, std::span<const Jet>(jets.elevation_m)).v[0];
      const double by_difference = (above[k] - below[k]) / (2 * step);
      error += std::abs(by_mean - by_difference);
      size += std::abs(by_difference);
    }
    EXPECT_LT(error, 0.05 * size) << name;
  }
}

}  // namespace
}  // namespace geo::calibration
