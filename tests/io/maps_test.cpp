#include "geo/io/maps/maps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <set>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/io/report/report.hpp"
#include "io/picture.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

constexpr int kWidth = 720;

std::shared_ptr<const Grid> small_sphere() {
  return std::make_shared<Grid>(Grid::sphere(360, 180));
}

// Land between 60°W and 60°E, the sea elsewhere; both hilly.
std::vector<float> one_continent(const Grid& grid) {
  std::vector<float> elevation(grid.size());
  for (Index i = 0; i < grid.size(); ++i) {
    const double longitude = grid.longitude_deg(grid.column(i));
    const double hills = std::sin(0.2 * longitude) * std::sin(0.15 * grid.row(i));
    elevation[i] = static_cast<float>(std::abs(longitude) < 60.0 ? 900.0 + 800.0 * hills
                                                                 : -3500.0 + 1500.0 * hills);
  }
  return elevation;
}

State full_state() {
  State state(small_sphere());
  const Grid& grid = state.grid();
  const auto n = static_cast<std::size_t>(grid.size());
  state.set(field::elevation, one_continent(grid));
  std::vector<float> temperature(n), rain(n), east(n), north(n), discharge(n, 0.0F);
  std::vector<Index> receiver(n);
  std::vector<std::int8_t> biome(n), koppen(n);
  for (Index i = 0; i < grid.size(); ++i) {
    const double latitude = grid.latitude_deg(grid.row(i)) * std::numbers::pi / 180.0;
    temperature[i] = static_cast<float>(28.0 - 50.0 * std::pow(std::sin(latitude), 2));
    rain[i] = static_cast<float>(2000.0 * std::pow(std::cos(latitude), 4));
    east[i] = static_cast<float>(8.0 * std::cos(3.0 * latitude));
    north[i] = static_cast<float>(2.0 * std::sin(4.0 * latitude));
    const bool land = state.read(field::elevation)[i] >= 0.0F;
    biome[i] = static_cast<std::int8_t>(land ? 1 + grid.row(i) / 20 : 0);
    koppen[i] = static_cast<std::int8_t>(land ? 1 + grid.row(i) / 7 : 0);
    receiver[i] = land ? grid.neighbour(i, kEast) : i;
    if (land) discharge[i] = static_cast<float>(grid.column(i));
  }
  state.set(field::temperature, temperature);
  state.set(field::precipitation, rain);
  state.set(field::wind_east, east);
  state.set(field::wind_north, north);
  state.set(field::flow_receiver, receiver);
  state.set(field::discharge, discharge);
  state.set(field::lake_depth, std::vector<float>(n, 0.0F));
  state.set(field::biome, biome);
  state.set(field::koppen_class, koppen);
  state.set(field::net_primary_productivity, rain);
  state.set(field::settlement_suitability, std::vector<float>(n, 0.5F));
  std::vector<std::int16_t> plate(n);
  std::vector<std::int8_t> boundary(n, 0), rock(n);
  std::vector<float> age(n), thickness(n), continent(n);
  for (Index i = 0; i < grid.size(); ++i) {
    const double longitude = grid.longitude_deg(grid.column(i));
    plate[i] = static_cast<std::int16_t>(longitude < 90.0 ? grid.row(i) / 60 : 7);
    if (std::abs(longitude - 90.0) < 3.0) boundary[i] = 2;
    rock[i] = static_cast<std::int8_t>(grid.row(i) % 6);
    continent[i] = std::abs(longitude) < 70.0 ? 1.0F : 0.0F;
    age[i] = static_cast<float>(std::abs(longitude - 90.0));
    thickness[i] = continent[i] > 0.0F ? 38000.0F : 7000.0F;
  }
  state.set(field::plate_id, plate);
  state.set(field::boundary_type, boundary);
  state.set(field::plate_velocity_east, std::vector<float>(n, 40.0F));
  state.set(field::plate_velocity_north, std::vector<float>(n, -20.0F));
  state.set(field::continental_fraction, continent);
  state.set(field::crust_age, age);
  state.set(field::crust_thickness, thickness);
  state.set(field::rock_type, rock);
  return state;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

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

// A river along the equator that crosses the date line from 170°E to 170°W.
State date_line_river(bool flows) {
  State state(small_sphere());
  const Grid& grid = state.grid();
  std::vector<Index> receiver(grid.size());
  std::vector<float> discharge(grid.size(), 0.0F);
  for (Index i = 0; i < grid.size(); ++i) receiver[i] = i;
  for (int column = 350; column < 370 && flows; ++column) {
    const Index cell = grid.cell(column % 360, 90);
    receiver[cell] = grid.cell((column + 1) % 360, 90);
    discharge[cell] = 5000.0F;
  }
  state.set(field::elevation, std::vector<float>(grid.size(), 300.0F));
  state.set(field::flow_receiver, receiver);
  state.set(field::discharge, discharge);
  return state;
}

TEST(Maps, ARiverAcrossTheDateLineIsDrawnAtBothEdgesAndNotAcrossTheMap) {
  const TemporaryFolder folder;
  draw_maps(date_line_river(true), folder / "with", kWidth);
  draw_maps(date_line_river(false), folder / "without", kWidth);
  const MapLayout layout = map_layout(*small_sphere(), kWidth);
  const Picture with(folder / "with/rivers.png", layout);
  const Picture without(folder / "without/rivers.png", layout);
  int west = 0, middle = 0, east = 0;
  for (int y = 0; y < layout.map_height; ++y) {
    for (int x = 2; x < layout.map_width - 2; ++x) {
      if (with.map(x, y) == without.map(x, y)) continue;
      ++(x < 30 ? west : x > layout.map_width - 30 ? east : middle);
    }
  }
  EXPECT_GT(west, 15);
  EXPECT_GT(east, 15);
  EXPECT_EQ(middle, 0);
}

TEST(Maps, ARiverOverThePoleIsNotDrawnHalfRoundTheMap) {
  const TemporaryFolder folder;
  State state = date_line_river(false);
  const Grid& grid = state.grid();
  auto receiver = state.update(field::flow_receiver);
  auto discharge = state.update(field::discharge);
  for (int row = 150; row < 180; ++row) {
    const Index up = grid.cell(40, row), down = grid.cell(220, row);
    receiver[up] = grid.neighbour(up, kNorth);
    receiver[down] = grid.cell(220, row - 1);
    discharge[up] = discharge[down] = 5000.0F;
  }
  draw_maps(state, folder / "with", kWidth);
  draw_maps(date_line_river(false), folder / "without", kWidth);
  const MapLayout layout = map_layout(grid, kWidth);
  const Picture with(folder / "with/rivers.png", layout);
  const Picture without(folder / "without/rivers.png", layout);
  int rivers = 0;
  for (int y = 0; y < layout.map_height; ++y) {
    for (int x = 0; x < layout.map_width; ++x) {
      if (with.map(x, y) == without.map(x, y)) continue;
      const bool at_one = std::abs(x - 81) < 6, at_other = std::abs(x - 441) < 6;
      EXPECT_TRUE(at_one || at_other) << x << " " << y;
      ++rivers;
    }
  }
  EXPECT_GT(rivers, 100);
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

TEST(Report, EscapesTextAndReferencesPicturesRelatively) {
  const TemporaryFolder folder;
  Report report;
  report.title = "planet <b> & \"co\"";
  report.maps = {{folder / "maps/elevation.png", "Elevation", "a < b", 100, 50}};
  report.parameters = "[erosion]\nk = 1 # <script>alert(1)</script>\n";
  report.provenance = {{"seed", "1"}};
  report.fields = {{"elevation", "m", "height", -10.0, 1.5, 20.0}};
  const std::string page = text_of(write_report(folder.path(), report));
  EXPECT_THAT(page, testing::StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(page, testing::HasSubstr("planet &lt;b&gt; &amp; "));
  EXPECT_THAT(page, testing::HasSubstr("src=\"maps/elevation.png\""));
  EXPECT_THAT(page, testing::HasSubstr("[erosion]\nk = 1 # &lt;script&gt;"));
  EXPECT_THAT(page, testing::Not(testing::HasSubstr("<script")));
  EXPECT_THAT(page, testing::Not(testing::HasSubstr("http")));
  EXPECT_THAT(page, testing::HasSubstr("<td class=\"number\">1.5</td>"));
}

TEST(Report, FiguresAreThoseOfTheLastStageThatWroteTheField) {
  const auto record = [](const char* name, double mean) {
    return FieldRecord{name, "", mean - 1.0, mean, mean + 1.0, 0, ""};
  };
  const auto stage = [](const char* name, std::vector<FieldRecord> fields) {
    StageRecord written;
    written.name = name;
    written.fields = std::move(fields);
    return written;
  };
  Manifest manifest;
  manifest.stages = {stage("erosion", {record("elevation", 1.0)}),
                     stage("hydrology", {record("discharge", 5.0), record("lake_id", 7.0),
                                         record("elevation", 2.0)}),
                     stage("island", {record("elevation", 3.0)})};
  manifest.stages.back().own_grid = true;
  const auto fields = field_figures(manifest);
  ASSERT_EQ(fields.size(), 2U);  // a number of a lake is no figure
  EXPECT_EQ(fields[0].name, "elevation");
  EXPECT_EQ(fields[0].mean, 2.0);
  EXPECT_EQ(fields[0].max, 3.0);
  EXPECT_EQ(fields[0].units, "m");
  EXPECT_EQ(fields[1].name, "discharge");
}

TEST(Report, ScorecardMarksWhatLiesWithinBySignAndStyle) {
  const TemporaryFolder folder;
  Report report;
  report.scorecard.emplace();
  report.scorecard->lines = {{"relief", "land", "land <", "%", "x", 30.0, 29.0, 1.5, true},
                             {"relief", "mean", "mean", "m", "x", -3000.0, -3686.0, 150.0, false}};
  report.scorecard->left_out = {"no plate_id: plates"};
  report.events = {"impact & rift"};
  const std::string page = text_of(write_report(folder.path(), report));
  EXPECT_THAT(page, testing::HasSubstr("1 of 2 figures"));
  EXPECT_THAT(page, testing::HasSubstr("land &lt;"));
  EXPECT_THAT(page, testing::HasSubstr("<td class=\"within\">\u2713 within</td>"));
  EXPECT_THAT(page, testing::HasSubstr("<td class=\"outside\">\u2717 outside</td>"));
  EXPECT_THAT(page, testing::HasSubstr("\u00b1 1.5*"));
  EXPECT_THAT(page, testing::HasSubstr("\u22123000"));
  EXPECT_THAT(page, testing::HasSubstr("no plate_id"));
  EXPECT_THAT(page, testing::HasSubstr("impact &amp; rift"));
}

}  // namespace
}  // namespace geo::io
