// What spreading engraves in the floor of planets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "geo/stages/isostasy/isostasy.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {
namespace {

struct Floor {
  State plain, engraved;
};

/// A planet of grown plates without and with fracture zones that its cells of 110 km can show.
Floor floor_of(std::uint64_t seed) {
  State state(std::make_shared<Grid>(Grid::sphere(360, 180)));
  const auto run = [&](const Stage& stage, State& on) {
    Context context;
    context.seed = seed;
    StageIo io(on, stage.info());
    stage.run(io, context);
  };
  run(*make_plates_stage(), state);
  Floor out{state, state};
  IsostasyParameters parameters;
  run(*make_isostasy_stage(parameters), out.plain);
  parameters.fracture_m = 400.0;
  parameters.fracture_spacing_km = 400.0;
  run(*make_isostasy_stage(parameters), out.engraved);
  return out;
}

TEST(SeaFloor, IsEngravedWhereItIsYoungAndLandIsNot) {
  for (const std::uint64_t seed : {7}) {
    const Floor floor = floor_of(seed);
    const Grid& grid = floor.plain.grid();
    const auto before = floor.plain.read(field::elevation);
    const auto after = floor.engraved.read(field::elevation);
    const auto age = floor.plain.read(field::crust_age);
    const auto share = floor.plain.read(field::continental_fraction);
    double young = 0.0, young_m2 = 0.0, old = 0.0, old_m2 = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      const double change = static_cast<double>(after[c]) - before[c];
      const double area = grid.area_m2(grid.row(c));
      EXPECT_EQ(before[c] < 0.0F, after[c] < 0.0F) << "seed " << seed;
      if (before[c] > -300.0F || share[c] > 0.4F) {
        EXPECT_EQ(change, 0.0) << "seed " << seed;
      } else if (share[c] < 0.05F && before[c] < -2000.0F) {
        (age[c] < 25.0F ? young : old) += change * change * area;
        (age[c] < 25.0F ? young_m2 : old_m2) += area;
      }
    }
    young = std::sqrt(young / young_m2);
    old = std::sqrt(old / old_m2);
    EXPECT_GT(young, 150.0) << "seed " << seed;
    EXPECT_LT(young, 450.0) << "seed " << seed;
    EXPECT_LT(old, 0.7 * young) << "seed " << seed;
  }
}

}  // namespace
}  // namespace geo
