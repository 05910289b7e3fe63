// Earth's own DEM (ETOPO5 as 20' means, Debian package ferret-datasets) from DEM to rivers.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <vector>

#include "geo/io/input/dem.hpp"
#include "geo/io/score/scorecard.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "geo/kernels/water/water_balance.hpp"
#include "geo/stages/stages.hpp"

namespace geo {
namespace {

constexpr const char* kRelief = "/usr/share/ferret-vis/data/etopo20.cdf";

/// Everything that the tests look at, computed once.
class Earth : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!std::filesystem::exists(kRelief)) return;
    const Planet planet;
    const io::Dem dem = io::read_dem(kRelief, planet);
    auto grid = std::make_shared<const Grid>(Grid::sphere(1080, 540, planet.figure()));
    state_.emplace(grid);
    state_->set(field::elevation, io::resample(dem, *grid));
    Pipeline pipeline = make_pipeline();
    const auto parameters = pipeline.parameters();
    find_parameter(parameters, "erosion.steps")->set_text("0");
    find_parameter(parameters, "hydrology.carving")->set_text("0");
    // The DEM takes the place of the stages before erosion; the island is another matter.
    for (int at = pipeline.find("erosion"); at <= pipeline.find("biomes"); ++at) {
      const auto& stage = pipeline.stages()[at];
      Context context;
      StageIo io(*state_, stage->info());
      stage->run(io, context);
    }
  }
  static void TearDownTestSuite() { state_.reset(); }
  void SetUp() override {
    ASSERT_TRUE(state_.has_value()) << kRelief << " is missing: scripts/install-deps installs it";
  }
  [[nodiscard]] static const Grid& grid() { return state_->grid(); }
  template <class T>
  [[nodiscard]] static std::span<const T> values(const Field<T>& spec) {
    return state_->read(spec);
  }
  [[nodiscard]] static Index cell_at(double latitude, double longitude) {
    const int row = static_cast<int>((latitude + 90.0) * grid().ny() / 180.0);
    const int column = static_cast<int>((longitude + 180.0) * grid().nx() / 360.0);
    return grid().cell(column, row);
  }
  /// Area-weighted mean of a field in ten-degree bands from the south.
  [[nodiscard]] static std::array<double, 18> zonal_means(std::span<const float> field) {
    std::array<double, 18> sum{}, area{};
    for (int j = 0; j < grid().ny(); ++j) {
      const int band = j * 18 / grid().ny();
      for (int i = 0; i < grid().nx(); ++i) {
        sum[band] += grid().area_m2(j) * field[grid().cell(i, j)];
        area[band] += grid().area_m2(j);
      }
    }
    for (int band = 0; band < 18; ++band) sum[band] /= area[band];
    return sum;
  }
  static std::optional<State> state_;
};
std::optional<State> Earth::state_;

TEST_F(Earth, LandCoversItsShareOfTheArea) {
  const auto z = values(field::elevation);
  double land = 0.0;
  for (Index c = 0; c < grid().size(); ++c) {
    if (z[c] >= 0.0F) land += grid().area_m2(grid().row(c));
  }
  EXPECT_GT(land / grid().total_area_m2(), 0.28);
  EXPECT_LT(land / grid().total_area_m2(), 0.295);
}

TEST_F(Earth, WaterNeverClimbsAndAllOfItArrives) {
  const auto z = values(field::elevation);
  const auto outlets = find_outlets(grid(), z);
  const Routing routing = route_water(grid(), z, outlets, true);
  std::vector<double> area(z.size());
  for (Index c = 0; c < grid().size(); ++c) area[c] = grid().area_m2(grid().row(c));
  routing.graph.accumulate(area);
  double arrived = 0.0;
  for (Index c = 0; c < grid().size(); ++c) {
    const Index to = routing.graph.receiver[c];
    ASSERT_LE(routing.filled_m[to], routing.filled_m[c]);
    if (to != c) continue;
    ASSERT_NE(outlets[c], 0);
    arrived += area[c];
  }
  EXPECT_NEAR(arrived / grid().total_area_m2(), 1.0, 1e-12);
}

/// Cells as high as one that touch it or each other.
std::set<Index> flat_at(const Grid& grid, std::span<const float> z, Index bottom) {
  std::set<Index> flat{bottom};
  std::vector<Index> next{bottom};
  while (!next.empty()) {
    const Index cell = next.back();
    next.pop_back();
    for (int k = 0; k < kDirections; ++k) {
      const Index to = grid.neighbour(grid.column(cell), grid.row(cell), k);
      if (to != kNoCell && z[to] == z[bottom] && flat.insert(to).second) next.push_back(to);
    }
  }
  return flat;
}

TEST_F(Earth, EveryLandCellReachesTheSeaOrAnEndorheicLake) {
  const auto z = values(field::elevation);
  const auto receiver = values(field::flow_receiver);
  downstream_order(receiver);  // throws on a cycle
  const auto lake = values(field::lake_id);
  const auto discharge = values(field::discharge);
  const auto rain_mm = values(field::precipitation);
  const auto lost_mm = values(field::potential_evapotranspiration);
  const auto from_outside = [&](Index cell, const std::set<Index>& flat) {
    double sum_m3_s = 0.0;
    for (int k = 0; k < kDirections; ++k) {
      const Index from = grid().neighbour(grid().column(cell), grid().row(cell), k);
      if (from != kNoCell && receiver[from] == cell && !flat.contains(from)) {
        sum_m3_s += discharge[from];
      }
    }
    return sum_m3_s;
  };
  for (Index c = 0; c < grid().size(); ++c) {
    if (receiver[c] != c || z[c] < 0.0F || lake[c] != 0) continue;
    // The bottom of an endorheic basin without a lake: ice, or open water on its flat ground would
    // lose more than rain and rivers bring.
    double would_lose_m3_s = 0.0, arrives_m3_s = 0.0;
    const std::set<Index> flat = flat_at(grid(), z, c);
    for (const Index cell : flat) {
      would_lose_m3_s += 1e-3 / kSecondsPerYear * (lost_mm[cell] - rain_mm[cell]) *
                         grid().area_m2(grid().row(cell));
      arrives_m3_s += from_outside(cell, flat);
    }
    ASSERT_TRUE(arrives_m3_s < would_lose_m3_s || values(field::temperature)[c] < 0.0F)
        << "row " << grid().row(c) << " column " << grid().column(c);
  }
}

TEST_F(Earth, LargestBasinsAreThoseOfTheAtlas) {
  struct Basin {
    const char* river;
    double latitude, longitude, area_m2;
  };
  // The Mississippi is left out: at 20' the DEM has the Missouri fall into the Red River.
  const Basin atlas[] = {{"Amazon", -3.1, -60.0, 6.1e12},
                         {"Congo", 0.0, 18.3, 3.7e12},
                         {"Nile", 15.6, 32.5, 3.3e12},
                         {"Ob", 61.0, 69.0, 3.0e12},
                         {"La Plata", -33.0, -60.6, 3.2e12}};
  const auto basin = values(field::basin_id);
  const auto upstream = values(field::drainage_area);
  const auto z = values(field::elevation);
  for (const Basin& real : atlas) {
    const Index town = cell_at(real.latitude, real.longitude);
    Index river = town;
    for (int dj = -3; dj <= 3; ++dj) {
      for (int di = -3; di <= 3; ++di) {
        const Index near = town + dj * grid().nx() + di;
        if (z[near] >= 0.0F && upstream[near] > upstream[river]) river = near;
      }
    }
    double area = 0.0;
    for (Index c = 0; c < grid().size(); ++c) {
      if (basin[c] == basin[river]) area += grid().area_m2(grid().row(c));
    }
    EXPECT_NEAR(area / real.area_m2, 1.0, 0.25) << real.river;
  }
}

TEST_F(Earth, HypsometryAndSpectrumLieWithinTheScorecardsTolerances) {
  const auto card = io::score_planet(*state_);
  int lines = 0;
  for (const auto& line : card.lines) {
    if (line.group != "hypsometry" && line.group != "share of the globe" &&
        line.group != "spectrum") {
      continue;
    }
    ++lines;
    EXPECT_TRUE(line.within()) << line.name << " is " << line.value << " must be " << line.earth
                               << " +- " << line.tolerance;
  }
  EXPECT_EQ(lines, 34);
}

TEST_F(Earth, ProfilesOfItsRiversLieWithinTheirLines) {
  const auto card = io::score_planet(*state_);
  int lines = 0;
  for (const char* name :
       {"river_slope", "hypsometric_integral", "concavity", "steepness_q50", "steepness_q90"}) {
    for (const auto& line : card.lines) {
      if (line.name != name) continue;
      ++lines;
      EXPECT_TRUE(line.within()) << name << " is " << line.value;
    }
  }
  EXPECT_EQ(lines, 5);
}

// Area-weighted means of NCEP/NCAR air temperature and of CMAP precipitation, 1981-2010, in bands
// of ten degrees from the south, interpolated between their nodes.
constexpr std::array<double, 18> kTemperature{-36.2, -27.3, -7.3, 2.9,  9.5,   16.3,
                                              21.0,  24.0,  25.4, 26.0, 26.0,  22.7,
                                              15.4,  8.6,   2.4,  -4.8, -11.7, -16.2};
constexpr std::array<double, 18> kPrecipitation_mm_d{.588,  .737,  .765,  1.386, 2.321, 2.655,
                                                     2.197, 2.719, 4.265, 5.724, 3.052, 1.888,
                                                     2.388, 2.113, 1.713, 1.131, .517,  .416};

TEST_F(Earth, ZonalTemperatureIsWithinFourKelvin) {
  const auto model = zonal_means(values(field::temperature));
  for (int band = 0; band < 18; ++band) {
    EXPECT_NEAR(model[band], kTemperature[band], 4.0) << "band from " << 10 * band - 90;
  }
}

TEST_F(Earth, ZonalPrecipitationIsWithin35PercentRms) {
  const auto model = zonal_means(values(field::precipitation));
  double squares = 0.0, mean = 0.0, weight = 0.0;
  for (int band = 0; band < 18; ++band) {
    const double radians = 3.14159265358979 / 180.0;
    const double share =
        std::sin((10 * band - 80) * radians) - std::sin((10 * band - 90) * radians);
    const double real = kPrecipitation_mm_d[band] * 365.25;
    squares += share * (model[band] - real) * (model[band] - real);
    mean += share * real;
    weight += share;
  }
  EXPECT_LT(std::sqrt(squares / weight) / (mean / weight), 0.35);
}

TEST_F(Earth, DesertsAndRainforestsAreWhereEarthHasThem) {
  const auto rain = values(field::precipitation);
  const std::pair<double, double> deserts[] = {{24, 10},   {21, 48},  {-25, 125},
                                               {-23, -69}, {-24, 15}, {40, 85}};
  for (const auto& [latitude, longitude] : deserts) {
    EXPECT_LT(rain[cell_at(latitude, longitude)], 300.0F) << latitude << " " << longitude;
  }
  const std::pair<double, double> forests[] = {{-3, -62}, {0, 22}, {-2, 112}, {5, -75}};
  for (const auto& [latitude, longitude] : forests) {
    EXPECT_GT(rain[cell_at(latitude, longitude)], 1200.0F) << latitude << " " << longitude;
  }
}

}  // namespace
}  // namespace geo
