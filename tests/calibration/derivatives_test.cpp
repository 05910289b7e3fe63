// Derivatives of the forward model with everything that jumps held fast.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>

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
                                      "isostasy.trench_depth_m",
                                      "isostasy.pelagic_rate_m_myr",
                                      "isostasy.apron_length_km",
                                      "isostasy.water_density_kg_m3",
                                      "isostasy.seafloor_roughness_m",
                                      "erosion.erodibility_factor",
                                      "erosion.area_exponent",
                                      "erosion.slope_exponent",
                                      "erosion.convergent_uplift_mm_yr",
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
  explicit Planet1(int rows = 48, const std::string& assignment = "isostasy.ocean_depth_m=0")
      // Hillslopes enough to be seen on cells of 400 km.
      : run("erosion.diffusivity_m2_yr=500", assignment),
        planet(run.parameters, 1, 2 * rows, rows) {
    (void)planet.route(model);
  }
  double* member(const std::string& name) const {
    return std::get<double*>(model.find(name).storage);
  }
  template <class V>
  Relief<V> follow(const std::string& name, const V& unit) {
    double* const at = member(name);
    return planet.follow<V>(model, Lift<V>({{at, V(*at) + unit}}));
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
  const auto above = p.planet.follow<double>(p.model, {}).elevation_m;
  *at = value - step;
  const auto below = p.planet.follow<double>(p.model, {}).elevation_m;
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

TEST(Derivatives, AgreeWithCentralDifferencesOfTheHeldFastModel) {
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

TEST(Derivatives, HeldFastModelIsTheRoutedOneWhereItWasRouted) {
  Planet1 p;
  const auto routed = p.planet.route(p.model).elevation_m;
  const auto held = p.planet.follow<double>(p.model, {}).elevation_m;
  EXPECT_EQ(routed, held);
}

TEST(Derivatives, ValuesAreThoseOfARun) {
  Planet1 p;
  const auto relief = p.planet.route(p.model);
  State state(std::make_shared<const Grid>(p.run.grid()));
  Context context;
  context.planet = p.run.planet;
  context.seed = 1;
  std::vector<float> z;
  p.run.pipeline.run(state, context, 0, p.run.pipeline.find("erosion"),
                     {.before = [](int) {},
                      .after =
                          [&](int, const State& after, const Context&) {
                            if (!after.has(field::elevation)) return;
                            const auto now = after.read(field::elevation);
                            z.assign(now.begin(), now.end());
                          }});
  double sum = 0.0;
  int others = 0;
  for (std::size_t c = 0; c < z.size(); ++c) {
    const double off = std::abs(relief.elevation_m[c] - z[c]);
    sum += off;
    others += off > 1.0;
  }
  // The sea stands some centimetres lower, and rounding to float may turn a brook into another
  // valley.
  EXPECT_LT(sum / double(z.size()), 0.5);
  EXPECT_LT(others, 0.005 * double(z.size()));
}

/// dq / dtheta by the mean over the cells about a quantile, against what really becomes of the
/// curve of the held-fast relief when a parameter moves: over fiftieths of the area, 0.1 to 0.9.
TEST(Derivatives, QuantilesFollowTheMeanOfTheCellsThere) {
  constexpr int kParts = 50;
  Planet1 p(96);
  const Grid& grid = p.planet.grid();
  const Ranking ranking(grid, p.planet.follow<double>(p.model, {}).elevation_m);
  for (const std::string name :
       {"isostasy.lithosphere", "isostasy.collision_km", "isostasy.swell_m"}) {
    double* const at = p.member(name);
    const double value = *at, step = 0.005 * value;
    *at = value + step;
    const auto above =
        Ranking(grid, p.planet.follow<double>(p.model, {}).elevation_m).bin_means(kParts);
    *at = value - step;
    const auto below =
        Ranking(grid, p.planet.follow<double>(p.model, {}).elevation_m).bin_means(kParts);
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
