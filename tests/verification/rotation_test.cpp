// One planet in two frames: as it is, and turned until the middle of a continent stands on the
// north pole. What differs between the two is what rows and columns do to a planet.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "geo/core/vector3.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/isostasy/isostasy.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi, kDegree = kPi / 180.0;

struct Relief {
  std::shared_ptr<const Grid> grid;
  std::map<std::string, std::vector<float>> fields;
};

void run(const Stage& stage, State& state, std::uint64_t seed) {
  Context context;
  context.seed = seed;
  StageIo io(state, stage.info());
  stage.run(io, context);
}

Relief planet(std::uint64_t seed, int columns, const Vector3& turn) {
  auto grid = std::make_shared<const Grid>(Grid::sphere(columns, columns / 2, {}, turn));
  State state(grid);
  run(*make_plates_stage(), state, seed);
  run(*make_isostasy_stage(), state, seed);
  Relief relief{grid, {}};
  const auto keep = [&](const Field<float>& spec, const std::string& name) {
    const auto values = state.read(spec);
    relief.fields[name] = {values.begin(), values.end()};
  };
  for (const auto* spec : {&field::crust_age, &field::crust_thickness, &field::continental_fraction,
                           &field::convergent_deformation, &field::elevation}) {
    keep(*spec, std::string(spec->name));
  }
  run(*make_erosion_stage(), state, seed);
  keep(field::elevation, "eroded");
  return relief;
}

/// Between the four centres around a place of the planet's own frame.
double value_at(const Relief& relief, const std::string& name, const Vector3& place) {
  const Grid& grid = *relief.grid;
  const Vector3 at = grid.to_axis(place);
  const double x = (std::atan2(at[1], at[0]) / (2.0 * kPi) + 0.5) * grid.nx() - 0.5;
  const double y = (std::asin(std::clamp(at[2], -1.0, 1.0)) / kPi + 0.5) * grid.ny() - 0.5;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const auto& values = relief.fields.at(name);
  const auto value = [&](int column, int row) {
    const bool over = row < 0 || row >= grid.ny();
    column = (column + (over ? grid.nx() / 2 : 0) + grid.nx()) % grid.nx();
    return static_cast<double>(values[grid.cell(column, std::clamp(row, 0, grid.ny() - 1))]);
  };
  const double u = x - i, v = y - j;
  return (1 - v) * ((1 - u) * value(i, j) + u * value(i + 1, j)) +
         v * ((1 - u) * value(i, j + 1) + u * value(i + 1, j + 1));
}

/// The place farthest inside the continents.
Vector3 middle_of_a_continent(const Relief& relief) {
  const Grid& grid = *relief.grid;
  std::vector<float> smoothed = relief.fields.at("continental_fraction");
  smooth(grid, smoothed, 1200e3);
  const auto most =
      static_cast<Index>(std::max_element(smoothed.begin(), smoothed.end()) - smoothed.begin());
  return grid.unit_vector(grid.column(most), grid.row(most));
}

struct Pair {
  Relief plain, turned;
};

Pair planets(std::uint64_t seed, int columns) {
  Relief plain = planet(seed, columns, {});
  const Vector3 middle = middle_of_a_continent(plain), pole{0, 0, 1};
  const Vector3 turn = scaled(normalised(cross(pole, middle)), angle_between(pole, middle));
  Relief turned = planet(seed, columns, turn);
  return {std::move(plain), std::move(turned)};
}

constexpr std::array kFields{"elevation", "eroded", "crust_age", "crust_thickness"};

/// A field of both planets between two latitudes of the turned one, weighed by areas. As
/// interpolation smooths, each planet is read at its own cells and between them, at the other's.
struct Both {
  std::vector<double> turned, plain, area;

  Both(const Pair& pair, const std::string& name, double south_deg, double north_deg) {
    const Grid& frame = *pair.turned.grid;
    const auto read = [&](const Relief& at_cells, std::vector<double>& own, const Relief& between,
                          std::vector<double>& interpolated) {
      const Grid& grid = *at_cells.grid;
      for (Index cell = 0; cell < grid.size(); ++cell) {
        const Vector3 place = grid.unit_vector(grid.column(cell), grid.row(cell));
        const double latitude = std::asin(std::clamp(frame.to_axis(place)[2], -1.0, 1.0)) / kDegree;
        if (latitude < south_deg || latitude > north_deg) continue;
        own.push_back(at_cells.fields.at(name)[cell]);
        interpolated.push_back(value_at(between, name, place));
        area.push_back(grid.area_m2(grid.row(cell)));
      }
    };
    read(pair.turned, turned, pair.plain, plain);
    read(pair.plain, plain, pair.turned, turned);
  }
  /// Share of the area where both are on the same side of a level.
  [[nodiscard]] double agreement(double level) const {
    double same = 0.0, all = 0.0;
    for (std::size_t k = 0; k < area.size(); ++k) {
      same += area[k] * ((turned[k] >= level) == (plain[k] >= level));
      all += area[k];
    }
    return same / all;
  }
  /// Mean difference between values of the same rank: the area between the two distributions.
  [[nodiscard]] double distance_of_distributions() const {
    std::vector<std::array<double, 2>> steps;  // a value and by how much the two then differ
    for (std::size_t k = 0; k < area.size(); ++k) {
      steps.push_back({turned[k], area[k]});
      steps.push_back({plain[k], -area[k]});
    }
    std::sort(steps.begin(), steps.end());
    double ahead = 0.0, between = 0.0;
    for (std::size_t k = 0; k + 1 < steps.size(); ++k) {
      ahead += steps[k][1];
      between += std::abs(ahead) * (steps[k + 1][0] - steps[k][0]);
    }
    return between / std::accumulate(area.begin(), area.end(), 0.0);
  }
  [[nodiscard]] double deviation(const std::vector<double>& values) const {
    double sum = 0.0, squares = 0.0, all = 0.0;
    for (std::size_t k = 0; k < area.size(); ++k) {
      sum += area[k] * values[k];
      squares += area[k] * values[k] * values[k];
      all += area[k];
    }
    return std::sqrt(std::max(0.0, squares / all - (sum / all) * (sum / all)));
  }
};

/// Mean squares of what a field changes by over two rows' distance each way, eastwards and
/// northwards in the turned frame, poleward of a latitude.
struct Steepness {
  double east = 0.0, north = 0.0;

  Steepness(const Relief& relief, const std::string& name, const Grid& frame, double latitude_deg) {
    const double angle = 2.0 * kPi / frame.ny();
    const Vector3 pole = rotated({0, 0, 1}, frame.turn());
    for (int j = 0; j < frame.ny(); ++j) {
      if (std::abs(frame.latitude_deg(j)) < latitude_deg) continue;
      for (int i = 0; i < frame.nx(); ++i) {
        const Vector3 at = frame.unit_vector(i, j);
        const Vector3 eastwards = normalised(cross(pole, at)), northwards = cross(at, eastwards);
        const auto change = [&](const Vector3& way) {
          const auto there = [&](double side) {
            return value_at(relief, name,
                            add(scaled(at, std::cos(angle)), way, side * std::sin(angle)));
          };
          const double both = there(1.0) - there(-1.0);
          return frame.area_m2(j) * both * both;
        };
        east += change(eastwards);
        north += change(northwards);
      }
    }
  }
  [[nodiscard]] double ratio() const { return std::sqrt(east / north); }
};

void expect_the_same_land(const Pair& pair) {
  for (const auto* name : {"elevation", "eroded"}) {
    EXPECT_GT(Both(pair, name, 60.0, 90.0).agreement(0.0), 0.97) << name << ", north";
    EXPECT_GT(Both(pair, name, -90.0, -60.0).agreement(0.0), 0.97) << name << ", south";
    EXPECT_GT(Both(pair, name, -60.0, 60.0).agreement(0.0), 0.97) << name << ", between";
  }
  EXPECT_GT(Both(pair, "continental_fraction", 60.0, 90.0).agreement(0.5), 0.985);
}

void expect_the_same_distribution(const Pair& pair) {
  for (const auto* name : kFields) {
    const Both cap(pair, name, 60.0, 90.0);
    const double spread = cap.deviation(cap.plain);
    EXPECT_NEAR(cap.deviation(cap.turned), spread, 0.05 * spread) << name;
    // A place of a boundary may fall to another margin, and rivers find other ways on other cells.
    const double most = std::string(name) == "eroded" ? 0.03 : 0.015;
    EXPECT_LT(cap.distance_of_distributions(), most * spread) << name;
  }
}

/// How much steeper each field is eastwards than northwards on the turned planet, as logarithms.
using Grain = std::map<std::string, double>;

void expect_the_same_slopes(const Pair& pair, Grain& grain) {
  for (const auto* name : kFields) {
    const Grid& frame = *pair.turned.grid;
    const Steepness turned(pair.turned, name, frame, 75.0), plain(pair.plain, name, frame, 75.0);
    // A continent has a grain of its own, a belt that runs across the cap: what the frame adds to
    // it is what counts.
    EXPECT_NEAR(turned.ratio() / plain.ratio(), 1.0, 0.08) << name;
    EXPECT_NEAR(std::sqrt(turned.east / plain.east), 1.0, 0.15) << name;
    grain[name] += std::log(turned.ratio());
  }
}

// Cells of 40 km: a continental slope is a few of them wide.
TEST(TurnedPlanet, LooksTheSameWithAContinentOnThePole) {
  constexpr std::array<std::uint64_t, 4> kSeeds{2, 3, 4, 5};
  Grain grain;
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Pair pair = planets(seed, 1024);
    expect_the_same_land(pair);
    expect_the_same_distribution(pair);
    expect_the_same_slopes(pair, grain);
  }
  // Belts lie any way on their planets: a grain that all of them share would be the frame's.
  for (const auto& [name, sum] : grain) {
    const double mean = std::exp(sum / kSeeds.size());
    EXPECT_GT(mean, 0.85) << name;
    EXPECT_LT(mean, 1.0 / 0.85) << name;
  }
}

// A band next to the pole holds a river or two of a planet: only the mean over planets tells what
// rows do from what these rivers happen to.
TEST(TurnedPlanet, IsAsRoughInTheRowsNextToThePole) {
  constexpr int kSeeds = 24;
  struct Mean {
    double sum = 0.0;
    int count = 0;
  };
  std::map<std::string, std::map<double, Mean>> added;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Pair pair = planets(seed, 512);
    for (const auto* name : kFields) {
      for (const double from : {86.0, 80.0, 74.0, 68.0}) {
        const Both band(pair, name, from, from + 6.0);
        const double plain = band.deviation(band.plain);
        if (plain == 0.0) continue;  // of the age of the sea floor, where there is none
        Mean& mean = added[name][from];
        mean.sum += band.deviation(band.turned) / plain;
        ++mean.count;
      }
    }
  }
  for (const auto& [name, of_band] : added) {
    for (const auto& [from, mean] : of_band) {
      EXPECT_GE(mean.count, kSeeds / 2) << name << ", from latitude " << from;
      EXPECT_NEAR(mean.sum / mean.count, 1.0, 0.08) << name << ", from latitude " << from;
    }
  }
}

}  // namespace
}  // namespace geo
