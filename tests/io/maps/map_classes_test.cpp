// Colours of classes and plates, and the legends that name them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "geo/io/maps/maps.hpp"
#include "io/maps/picture.hpp"
#include "io/maps/sample_planet.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

TEST(Maps, FlatCategoriesShowTheColoursOfTheLegendAndNoOthers) {
  const TemporaryFolder folder;
  State state(small_sphere());
  const Grid& grid = state.grid();
  std::vector<std::int8_t> biome(grid.size());
  for (Index i = 0; i < grid.size(); ++i) {
    biome[i] = static_cast<std::int8_t>(grid.column(i) / 30);
  }
  state.set(field::biome, biome);
  draw_maps(state, folder.path(), kWidth);
  const MapLayout layout = map_layout(grid, kWidth);
  const Picture picture(folder / "biomes.png", layout);
  std::set<Colour> legend, interior;
  for (int y = layout.map_top + layout.map_height + 1; y < layout.height_px; ++y) {
    for (int x = 0; x < layout.width_px; ++x) legend.insert(picture.at(x, y));
  }
  // Between meridians and parallels of the graticule.
  for (int y = 10; y < layout.map_height; y += 20) {
    for (int x = 10; x < layout.map_width; x += 20) {
      if (x % 60 > 5 && x % 60 < 55 && y % 60 > 5 && y % 60 < 55)
        interior.insert(picture.map(x, y));
    }
  }
  EXPECT_EQ(interior.size(), static_cast<std::size_t>(kBiomes));
  for (const Colour& colour : interior) {
    EXPECT_TRUE(legend.contains(colour)) << colour.r << " " << colour.g << " " << colour.b;
  }
}

TEST(Maps, LandThatIsFrozenAllYearIsWhiteAmongBiomesAndNamed) {
  const TemporaryFolder folder;
  State state(small_sphere());
  const Grid& grid = state.grid();
  constexpr std::int8_t kTundra = 1;
  std::vector<float> temperature(grid.size());
  for (Index i = 0; i < grid.size(); ++i) {
    temperature[i] = grid.latitude_deg(grid.row(i)) < -60.0 ? -30.0F : 4.0F;
  }
  state.set(field::elevation, one_continent(grid));
  state.set(field::biome, std::vector<std::int8_t>(grid.size(), kTundra));
  state.set(field::temperature, temperature);
  state.set(field::temperature_range, std::vector<float>(grid.size(), 20.0F));
  draw_maps(state, folder.path(), kWidth);
  const MapLayout layout = map_layout(grid, kWidth);
  const Picture picture(folder / "biomes.png", layout);
  // Along 5 degrees east: the cold south, the rest, and the sea beside it.
  const Colour south = picture.map(370, 340), north = picture.map(370, 100);
  const Colour sea = picture.map(10, 340);
  EXPECT_GT(south.r + south.g + south.b, north.r + north.g + north.b + 100);
  EXPECT_EQ(sea, picture.map(10, 110)) << "no ice on the sea";
  // The legend has one more patch, where there is such land.
  const auto legend_has_ice = [&](const Picture& map) {
    constexpr Colour kIce{244, 247, 251};
    for (int y = layout.map_top + layout.map_height + 1; y < layout.height_px; ++y) {
      for (int x = 0; x < layout.width_px; ++x) {
        const Colour here = map.at(x, y);  // rounded by Cairo
        if (std::abs(here.r - kIce.r) <= 1 && std::abs(here.g - kIce.g) <= 1 &&
            std::abs(here.b - kIce.b) <= 1) {
          return true;
        }
      }
    }
    return false;
  };
  EXPECT_TRUE(legend_has_ice(picture));
  state.set(field::temperature, std::vector<float>(grid.size(), 4.0F));
  draw_maps(state, folder / "warm", kWidth);
  EXPECT_FALSE(legend_has_ice(Picture(folder / "warm/biomes.png", layout)));
}

TEST(Maps, PlateBoundariesHaveTheColourOfTheirTypeAndNeighboursDiffer) {
  const TemporaryFolder folder;
  const State state = full_state();
  const auto files = draw_map_files(state, folder.path(), kWidth);
  const Picture picture(folder / "plates.png", map_layout(state.grid(), kWidth));
  const auto is_red = [](Colour c) { return c.r > c.g + 80 && c.r > c.b + 80; };
  // Types reach 3 degrees, 6 pixels, to either side.
  int red_on_ridge = 0, red_elsewhere = 0;
  for (int y = 20; y < kWidth / 2 - 20; ++y) {
    for (int x = 2; x < kWidth - 2; ++x) {
      if (!is_red(picture.map(x, y))) continue;
      (std::abs(x - 3 * kWidth / 4) <= 8 ? red_on_ridge : red_elsewhere) += 1;
    }
  }
  EXPECT_GT(red_on_ridge, kWidth / 4);
  EXPECT_EQ(red_elsewhere, 0);
  const int sea = kWidth / 9;  // 140 degrees west
  EXPECT_NE(picture.map(sea + 7, 40), picture.map(sea + 7, kWidth / 4));
}

TEST(Maps, LegendOfPlatesNamesGreyLinesWhereThereAreSome) {
  const TemporaryFolder folder;
  constexpr Colour kGrey{0x6b, 0x6f, 0x76}, kRed{0xc8, 0x28, 0x1c};
  const MapLayout layout = map_layout(*small_sphere(), kWidth);
  const auto has_below_map = [&](State& state, const Colour& colour) {
    draw_map_files(state, folder.path(), kWidth);
    const Picture picture(folder / "plates.png", layout);
    for (int y = layout.map_top + layout.map_height + 2; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        if (picture.at(x, y) == colour) return true;
      }
    }
    return false;
  };
  const auto plates_alone = [] {
    const State full = full_state();
    State state(full.shared_grid());
    for (const FieldSpec* spec : {static_cast<const FieldSpec*>(&field::plate_id),
                                  static_cast<const FieldSpec*>(&field::boundary_type)}) {
      state.share(*spec, full.values(*spec));
    }
    return state;
  };
  State state = plates_alone();  // two boundaries, of which one alone has a type
  EXPECT_TRUE(has_below_map(state, kGrey));
  EXPECT_TRUE(has_below_map(state, kRed));
  State untyped = plates_alone();
  untyped.erase(field::boundary_type);
  EXPECT_TRUE(has_below_map(untyped, kGrey));
  EXPECT_FALSE(has_below_map(untyped, kRed));
  std::ranges::fill(state.update(field::boundary_type), std::int8_t{2});
  EXPECT_FALSE(has_below_map(state, kGrey));
  EXPECT_TRUE(has_below_map(state, kRed));
}

}  // namespace
}  // namespace geo::io
