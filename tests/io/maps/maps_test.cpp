// Pictures of maps: which there are, of which size, and where north and the date line lie.
#include "geo/io/maps/maps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "geo/core/error.hpp"
#include "io/maps/picture.hpp"
#include "io/maps/sample_planet.hpp"
#include "io/temporary_folder.hpp"
#include "support/text_of.hpp"

namespace geo::io {
namespace {

using test::text_of;

TEST(Maps, EveryFieldHasItsPictureOfTheRightSizeAndNoneIsBlank) {
  const TemporaryFolder folder;
  const State state = full_state();
  const auto files = draw_map_files(state, folder / "maps", kWidth, "a note");
  const MapLayout layout = map_layout(state.grid(), kWidth);
  EXPECT_EQ(layout.map_width, kWidth);
  EXPECT_EQ(layout.map_height, kWidth / 2);
  std::vector<std::string> names;
  for (const auto& file : files) {
    SCOPED_TRACE(file.path);
    names.push_back(file.path.stem());
    const Picture picture(file.path, layout);
    ASSERT_EQ(picture.width(), layout.width_px);
    ASSERT_EQ(picture.height(), layout.height_px);
    EXPECT_EQ(file.width_px, layout.width_px);
    EXPECT_EQ(file.height_px, layout.height_px);
    EXPECT_GT(picture.map_colours().size(), 5U);
    EXPECT_FALSE(file.title.empty());
    EXPECT_FALSE(file.caption.empty());
  }
  EXPECT_THAT(names, testing::UnorderedElementsAre("elevation", "plates", "crust_age",
                                                   "crust_thickness", "rock_type", "temperature",
                                                   "precipitation", "wind", "rivers", "biomes",
                                                   "koppen", "productivity", "settlement"));
}

TEST(Maps, AStateWithoutFieldsHasNoPictures) {
  const TemporaryFolder folder;
  EXPECT_TRUE(draw_maps(State(small_sphere()), folder / "maps", kWidth).empty());
}

TEST(Maps, SeaIsBlueAndLandIsNot) {
  const TemporaryFolder folder;
  State state(small_sphere());
  state.set(field::elevation, one_continent(state.grid()));
  draw_maps(state, folder.path(), kWidth);
  const Picture picture(folder / "elevation.png", map_layout(state.grid(), kWidth));
  for (int y = 15; y < kWidth / 2; y += 30) {
    for (int x = 15; x < kWidth; x += 30) {
      const double longitude = 360.0 * (x + 0.5) / kWidth - 180.0;
      const Colour colour = picture.map(x, y);
      if (std::abs(longitude) < 58.0) {
        EXPECT_LT(colour.b, colour.r + 5) << "land at " << longitude << "°E, row " << y;
      } else if (std::abs(longitude) > 62.0) {
        EXPECT_GT(colour.b, colour.r + 20) << "sea at " << longitude << "°E, row " << y;
      }
    }
  }
}

TEST(Maps, NorthIsUp) {
  const TemporaryFolder folder;
  State state(small_sphere());
  const Grid& grid = state.grid();
  std::vector<float> elevation(grid.size());
  for (Index i = 0; i < grid.size(); ++i) {
    elevation[i] = grid.latitude_deg(grid.row(i)) > 0.0 ? 500.0F : -4000.0F;
  }
  state.set(field::elevation, elevation);
  draw_maps(state, folder.path(), kWidth);
  const Picture picture(folder / "elevation.png", map_layout(grid, kWidth));
  const Colour north = picture.map(100, 100), south = picture.map(100, 260);
  EXPECT_LT(north.b, north.r);
  EXPECT_GT(south.b, south.r);
}

TEST(Maps, TheDateLineHasNoSeam) {
  // A planet turned by half a turn gives the same picture, moved by half its width.
  const TemporaryFolder folder;
  const auto draw = [&](int turn, const char* name) {
    State state(small_sphere());
    const Grid& grid = state.grid();
    std::vector<float> elevation(grid.size());
    for (Index i = 0; i < grid.size(); ++i) {
      const auto p = grid.unit_vector((grid.column(i) + turn) % grid.nx(), grid.row(i));
      elevation[i] = static_cast<float>(3000.0 * std::sin(9.0 * p[1]) * p[0] + 2000.0 * p[2]);
    }
    state.set(field::elevation, elevation);
    draw_maps(state, folder / name, kWidth);
    return Picture(folder / (std::string(name) + "/elevation.png"), map_layout(grid, kWidth));
  };
  const Picture picture = draw(0, "picture"), turned = draw(180, "turned");
  for (int y = 2; y < kWidth / 2 - 2; ++y) {
    for (int x = 1; x < kWidth - 1; ++x) {
      if (x == kWidth / 2 - 1 || x == kWidth / 2) continue;  // the frame, in the other picture
      const Colour one = picture.map(x, y), other = turned.map((x + kWidth / 2) % kWidth, y);
      ASSERT_NEAR(one.r, other.r, 1) << x << " " << y;
      ASSERT_NEAR(one.g, other.g, 1) << x << " " << y;
      ASSERT_NEAR(one.b, other.b, 1) << x << " " << y;
    }
  }
}

TEST(Maps, PicturesDoNotDependOnTheNumberOfThreads) {
  const TemporaryFolder folder;
  const State state = full_state();
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = draw_maps(state, folder / "one", kWidth);
  omp_set_num_threads(4);
  const auto four = draw_maps(state, folder / "four", kWidth);
  omp_set_num_threads(threads);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_TRUE(text_of(one[i]) == text_of(four[i])) << one[i];
  }
}

TEST(Maps, WindowsAndPlanesKeepTheirShape) {
  const MapLayout plane = map_layout(Grid::plane(200, 100, 1000, 1000), 1000);
  EXPECT_EQ(plane.map_width, 1000);
  EXPECT_EQ(plane.map_height, 500);
  // 20 by 10 degrees about 60°N: a degree east is half a degree north.
  const MapLayout window = map_layout(Grid::window(200, 100, {55, 65, 0, 20}), 1000);
  EXPECT_NEAR(double(window.map_width) / window.map_height, 1.0, 0.02);
  const MapLayout tall = map_layout(Grid::plane(100, 400, 1000, 1000), 1000);
  EXPECT_EQ(tall.map_height, 1000);
  EXPECT_EQ(tall.map_width, 250);
  EXPECT_THROW(static_cast<void>(map_layout(Grid::plane(200, 100, 1000, 1000), 10)),
               ConfigurationError);
}

TEST(Maps, EveryFieldThatIsDrawnIsAskedFor) {
  const auto fields = map_fields();
  for (const FieldSpec* spec : full_state().present()) {
    EXPECT_NE(std::find(fields.begin(), fields.end(), spec), fields.end()) << spec->name;
  }
}

TEST(Maps, AnyKindOfGridIsDrawn) {
  const TemporaryFolder folder;
  const std::vector<Grid> grids{Grid::window(90, 60, {30, 50, -10, 20}),
                                Grid::plane(90, 60, 500, 500), Grid::torus(90, 60, 500, 500),
                                Grid::sphere(2000, 1000)};
  for (const Grid& each : grids) {
    State state(std::make_shared<Grid>(each));
    std::vector<float> elevation(each.size());
    for (Index i = 0; i < each.size(); ++i) {
      elevation[i] = static_cast<float>(800.0 * std::sin(0.1 * each.column(i)) + each.row(i));
    }
    state.set(field::elevation, elevation);
    const auto files = draw_map_files(state, folder.path(), 400);
    ASSERT_EQ(files.size(), 1U);
    const Picture picture(files[0].path, map_layout(each, 400));
    EXPECT_GT(picture.map_colours().size(), 100U);
  }
}

TEST(Maps, AFolderThatCannotBeMadeIsAnIoError) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  EXPECT_THROW(draw_maps(State(small_sphere()), folder / "file/maps", kWidth), IoError);
}

TEST(Hypsometry, TheFigureIsDrawn) {
  const TemporaryFolder folder;
  State state(small_sphere());
  state.set(field::elevation, one_continent(state.grid()));
  const auto file = draw_hypsometry_file(state, folder.path());
  const Picture picture(file.path,
                        {file.width_px, file.height_px, 0, 0, file.width_px, file.height_px});
  EXPECT_EQ(picture.width(), file.width_px);
  EXPECT_GT(picture.map_colours().size(), 200U);
}

}  // namespace
}  // namespace geo::io
