// Maps in projections, windows and of any field.
#include "geo/io/drawing/map_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <proj.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "geo/core/error.hpp"
#include "io/maps/picture.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

constexpr int kWidth = 500;
constexpr double kRadians = std::numbers::pi / 180.0;

std::shared_ptr<const Grid> small_sphere() {
  return std::make_shared<Grid>(Grid::sphere(360, 180));
}

MapView view_of(std::string projection, std::optional<Centre> centre = {},
                std::optional<Window> box = {}) {
  MapView view(kWidth);
  view.projection = std::move(projection);
  view.centre = centre;
  view.box = box;
  return view;
}

/// A planet whose relief is a function of the place as a unit vector.
template <class Height>
State planet_of(const Height& height) {
  State state(small_sphere());
  const Grid& grid = state.grid();
  std::vector<float> elevation(grid.size());
  for (Index i = 0; i < grid.size(); ++i) {
    elevation[i] = static_cast<float>(height(grid.unit_vector(grid.column(i), grid.row(i))));
  }
  state.set(field::elevation, elevation);
  return state;
}

Picture drawn(const State& state, const TemporaryFolder& folder, const MapView& view) {
  const auto file = draw_field_file(state, field::elevation, folder / "map.png", view);
  return {file.path, map_layout(state.grid(), view)};
}

int difference(const Colour& a, const Colour& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// PROJ itself, asked for the same place.
std::array<double, 2> proj_position(const std::string& definition, Centre place) {
  PJ* const projection = proj_create(PJ_DEFAULT_CTX, definition.c_str());
  const PJ_COORD at =
      proj_trans(projection, PJ_FWD,
                 proj_coord(place.longitude_deg * kRadians, place.latitude_deg * kRadians, 0, 0));
  proj_destroy(projection);
  return {at.xy.x, at.xy.y};
}

TEST(MapView, PlacesLieWherePROJPutsThem) {
  struct Case {
    const char *name, *definition;
    Centre centre;
    double half_width;  // of the map, in radii of the planet
  };
  const std::vector<Case> cases{
      {"equirectangular", "+proj=eqc +lon_0=30", {0, 30}, std::numbers::pi},
      {"mercator", "+proj=merc +lon_0=30", {0, 30}, std::numbers::pi},
      {"robinson", "+proj=robin +lon_0=-100", {0, -100}, 0.8487 * std::numbers::pi},
      {"mollweide", "+proj=moll +lon_0=170", {0, 170}, 2.0 * std::numbers::sqrt2},
      {"orthographic", "+proj=ortho +lat_0=35 +lon_0=-60", {35, -60}, 1.0},
      {"stereographic", "+proj=stere +lat_0=-20 +lon_0=75", {-20, 75}, 2.0},
      {"equal-area", "+proj=laea +lat_0=10 +lon_0=5", {10, 5}, std::numbers::sqrt2},
      {"polar-north", "+proj=stere +lat_0=90 +lon_0=20", {0, 20}, 2.0 * std::tan(22.5 * kRadians)},
      {"polar-south", "+proj=stere +lat_0=-90 +lon_0=0", {0, 0}, 2.0 * std::tan(22.5 * kRadians)},
  };
  const auto grid = small_sphere();
  for (const Case& each : cases) {
    const MapView view = view_of(each.name, each.centre);
    const MapLayout layout = map_layout(*grid, view);
    const double px = 0.5 * layout.map_width / each.half_width;
    int seen = 0;
    for (double lat = -85.0; lat <= 85.0; lat += 17.0) {
      for (double lon = -179.0; lon < 180.0; lon += 23.0) {
        const auto here = position_on_map(*grid, view, {lat, lon});
        if (!here) continue;
        ++seen;
        const auto [x, y] = proj_position(std::string(each.definition) + " +R=1", {lat, lon});
        // Half a pixel in the vertical: the height of the page is rounded.
        EXPECT_NEAR((*here)[0], 0.5 * layout.map_width + x * px, 0.01)
            << each.name << ' ' << lat << ' ' << lon;
        EXPECT_NEAR((*here)[1], 0.5 * layout.map_height - y * px, 0.51)
            << each.name << ' ' << lat << ' ' << lon;
      }
    }
    EXPECT_GT(seen, 10) << each.name;
  }
}

TEST(MapView, TheFarSideIsNotOnAHemisphere) {
  const auto grid = small_sphere();
  const MapView view = view_of("orthographic", Centre{0, 0});
  EXPECT_TRUE(position_on_map(*grid, view, {0, 89}));
  EXPECT_FALSE(position_on_map(*grid, view, {0, 91}));
  EXPECT_FALSE(position_on_map(*grid, view, {0, 180}));
}

TEST(MapView, OutsideOfThePlanetThereIsPaperAndInsideThereIsNone) {
  const TemporaryFolder folder;
  const State state = planet_of([](const auto&) { return -4000.0; });
  for (const char* name : {"mollweide", "orthographic", "stereographic", "equal-area"}) {
    const MapView view = view_of(name);
    const MapLayout layout = map_layout(state.grid(), view);
    const Picture picture = drawn(state, folder, view);
    int outside = 0, paper = 0;
    for (int y = 0; y < layout.map_height; ++y) {
      for (int x = 0; x < layout.map_width; ++x) {
        const double out =
            std::hypot((x + 0.5) / layout.map_width - 0.5, (y + 0.5) / layout.map_height - 0.5);
        if (out > 0.51) {
          // Labels stand there, in grey, and nothing of the blue sea.
          const Colour colour = picture.map(x, y);
          ASSERT_LT(colour.b - colour.r, 20) << name << ' ' << x << ' ' << y;
          if (colour == kPaper) ++paper;
          ++outside;
        } else if (out < 0.49) {
          ASSERT_LT(picture.map(x, y).r, 240) << name << ' ' << x << ' ' << y;
        }
      }
    }
    EXPECT_GT(outside, 1000) << name;
    EXPECT_GT(paper, 0.97 * outside) << name;
  }
}

TEST(MapView, NoSeamWhereLongitudesBeginAgain) {
  // A planet turned by half a turn, seen from the other side, is the same picture.
  const TemporaryFolder folder;
  const auto height = [](double turn) {
    return [turn](const auto& p) {
      return 3000.0 * std::sin(9.0 * p[1] * turn) * p[0] * turn + 2000.0 * p[2];
    };
  };
  const State planet = planet_of(height(1.0)), turned = planet_of(height(-1.0));
  for (const char* name : {"robinson", "mollweide", "equirectangular", "orthographic"}) {
    const MapView here = view_of(name, Centre{0, 1e-9}), there = view_of(name, Centre{0, 180});
    const Picture one = drawn(planet, folder, here), other = drawn(turned, folder, there);
    const MapLayout layout = map_layout(planet.grid(), here);
    int unlike = 0;
    for (int y = 0; y < layout.map_height; ++y) {
      for (int x = 0; x < layout.map_width; ++x) {
        if (difference(one.map(x, y), other.map(x, y)) > 2) ++unlike;
      }
    }
    // Labels of longitudes stand on some maps.
    EXPECT_LT(unlike, 0.03 * layout.map_width * layout.map_height) << name;
    const int middle = layout.map_width / 2;
    for (int y = 0; y < layout.map_height; y += 7) {
      if (std::abs(y - layout.map_height / 2) < 15) continue;
      for (int x = middle - 3; x <= middle + 3; ++x) {
        ASSERT_LE(difference(one.map(x, y), other.map(x, y)), 2) << name << ' ' << x << ' ' << y;
      }
    }
  }
}

TEST(MapView, APoleHasNoSpokes) {
  const TemporaryFolder folder;
  // A dome on the pole is round: it looks the same whichever meridian points down …
  const State dome =
      planet_of([](const auto& p) { return 4000.0 * std::exp(-(1.0 - p[2]) / 0.05) + 100.0; });
  const MapView view = view_of("orthographic", Centre{90, 0});
  const Picture picture = drawn(dome, folder, view);
  const Picture turned = drawn(dome, folder, view_of("orthographic", Centre{90, 90}));
  const MapLayout layout = map_layout(dome.grid(), view);
  const double middle = 0.5 * layout.map_width;
  int unlike = 0, inside = 0;
  for (int y = 0; y < layout.map_height; ++y) {
    for (int x = 0; x < layout.map_width; ++x) {
      if (std::hypot(x + 0.5 - middle, y + 0.5 - middle) > 0.8 * middle) continue;
      ++inside;
      if (difference(picture.map(x, y), turned.map(x, y)) > 2) ++unlike;
    }
  }
  EXPECT_LT(unlike, inside / 500);
  // … and the light comes from one side of the page: not from the north-west of every place, which
  // would be the same all round.
  const int off = static_cast<int>(0.13 * middle), at = static_cast<int>(middle);
  const auto brightness = [](Colour c) { return c.r + c.g + c.b; };
  EXPECT_GT(brightness(picture.map(at - off, at - off)),
            brightness(picture.map(at + off, at + off)) + 20);
}

TEST(MapView, ABoxFillsItsMapFromCornerToCorner) {
  const auto grid = small_sphere();
  for (const char* name : {"equirectangular", "mercator"}) {
    for (const Window& box : {Window{30, 60, -20, 40}, Window{-50, -10, 160, 210}}) {
      const MapView view = view_of(name, {}, box);
      const MapLayout layout = map_layout(*grid, view);
      const auto at = [&](double lat, double lon) {
        return *position_on_map(*grid, view, {lat, lon});
      };
      EXPECT_NEAR(at(box.north_deg, box.west_deg)[0], 0.0, 1e-6);
      EXPECT_NEAR(at(box.north_deg, box.west_deg)[1], 0.0, 1e-6);
      EXPECT_NEAR(at(box.south_deg, box.east_deg)[0], layout.map_width, 1e-6);
      EXPECT_NEAR(at(box.south_deg, box.east_deg)[1], layout.map_height, 0.51);
      EXPECT_FALSE(position_on_map(*grid, view, {box.north_deg + 1.0, box.west_deg + 1.0}));
      EXPECT_FALSE(position_on_map(*grid, view, {box.north_deg - 1.0, box.east_deg + 1.0}));
    }
  }
}

TEST(MapView, ABoxAcrossTheDateLineShowsBothSidesOfIt) {
  const TemporaryFolder folder;
  // Land from 170°E to 170°W alone.
  const State state = planet_of([](const auto& p) {
    return std::abs(std::atan2(p[1], p[0])) > 170.0 * kRadians ? 500.0 : -4000.0;
  });
  const MapView view = view_of("equirectangular", {}, parse_box("--bbox", "160,-20,-160,20"));
  const Picture picture = drawn(state, folder, view);
  const MapLayout layout = map_layout(state.grid(), view);
  const auto is_sea = [&](double share) {
    const Colour c = picture.map(static_cast<int>(share * layout.map_width), layout.map_height / 3);
    return c.b > c.r + 20;
  };
  EXPECT_TRUE(is_sea(0.1));
  EXPECT_FALSE(is_sea(0.35));
  EXPECT_FALSE(is_sea(0.65));
  EXPECT_TRUE(is_sea(0.9));
}

TEST(MapView, EveryProjectionDrawsEveryMapWithAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const State state = planet_of([](const auto& p) { return 4000.0 * p[0] * p[1] + 900.0 * p[2]; });
  for (const MapProjection& projection : map_projections()) {
    const MapView view = view_of(std::string(projection.name));
    const auto files = draw_map_files(state, folder / std::string(projection.name), view);
    ASSERT_EQ(files.size(), 1U) << projection.name;
    const Picture picture(files[0].path, map_layout(state.grid(), view));
    EXPECT_GT(picture.map_colours().size(), 500U) << projection.name;
  }
}

TEST(MapView, WhatCannotBeShownIsRefusedInWords) {
  const auto grid = small_sphere();
  const auto words = [&](const auto& act) -> std::string {
    try {
      act();
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "accepted";
  };
  using testing::HasSubstr;
  const auto layout = [&](const MapView& view) {
    return words([&] { static_cast<void>(map_layout(*grid, view)); });
  };
  EXPECT_THAT(layout(view_of("robinsen")), HasSubstr("perhaps robinson"));
  EXPECT_THAT(layout(view_of("robinson", Centre{40, 0})), HasSubstr("equator"));
  EXPECT_THAT(layout(view_of("robinson", Centre{0, 0}, Window{0, 10, 170, 190})),
              HasSubstr("another centre"));
  EXPECT_THAT(layout(view_of("mercator", {}, Window{82, 88, 0, 10})), HasSubstr("mercator"));
  EXPECT_THAT(layout(view_of("orthographic", Centre{0, 0}, Window{-10, 10, 170, 190})),
              HasSubstr("shows nothing"));
  for (const char* text : {"", "1,2,3", "0,10,20,5", "0,-91,20,5", "0,0,20,x", "0,0,400,10"}) {
    EXPECT_THAT(words([&] { parse_box("--bbox", text); }), HasSubstr("--bbox")) << text;
  }
  for (const char* text : {"", "1", "91,0", "1,2,3", "a,b", "0,nan"}) {
    EXPECT_THAT(words([&] { parse_centre("--center", text); }), HasSubstr("--center")) << text;
  }
  const Grid plane = Grid::plane(90, 60, 500, 500);
  EXPECT_THAT(words([&] { static_cast<void>(map_layout(plane, view_of("robinson"))); }),
              HasSubstr("as it lies"));
}

/// Values that suit the row of a field: a wave, whole numbers, flags.
Values some_values(const FieldSpec& spec, const Grid& grid) {
  const auto fill = [&]<class T>(T) {
    std::vector<T> values(grid.size());
    for (Index i = 0; i < grid.size(); ++i) {
      const auto p = grid.unit_vector(grid.column(i), grid.row(i));
      values[i] = std::is_floating_point_v<T> ? static_cast<T>(50.0 * p[0] * p[1] + 20.0 * p[2])
                                              : static_cast<T>(std::floor(2.5 + 1.5 * p[0] + p[2]));
    }
    return Values(values);
  };
  switch (spec.type) {
    case Type::float32:
      return fill(float());
    case Type::float64:
      return fill(double());
    case Type::int8:
      return fill(std::int8_t());
    case Type::int16:
      return fill(std::int16_t());
    case Type::int32:
      return fill(std::int32_t());
  }
  throw Bug("no such type");
}

TEST(FieldMaps, EveryFieldOfTheVocabularyCanBeDrawn) {
  const TemporaryFolder folder;
  MapView view(300);
  for (const FieldSpec* spec : field::all()) {
    State state = planet_of([](const auto& p) { return 4000.0 * p[0]; });
    state.set(*spec, some_values(*spec, state.grid()));
    for (const char* projection : {"equirectangular", "robinson"}) {
      view.projection = projection;
      const auto file = draw_field_file(state, *spec, folder / "field.png", view);
      const Picture picture(file.path, map_layout(state.grid(), view));
      EXPECT_GT(picture.map_colours().size(), 5U) << spec->name;
      EXPECT_FALSE(file.title.empty());
    }
  }
}

TEST(FieldMaps, AFieldOfOneValueOrOfNoneIsDrawn) {
  const TemporaryFolder folder;
  State state = planet_of([](const auto&) { return 10.0; });
  const auto cells = static_cast<std::size_t>(state.grid().size());
  for (const float value : {0.0F, 7.0F, -3.0F, std::numeric_limits<float>::quiet_NaN()}) {
    state.set(field::slope, std::vector<float>(cells, value));
    EXPECT_NO_THROW(draw_field_file(state, field::slope, folder / "field.png", {300})) << value;
  }
}

TEST(FieldMaps, LargerNumbersAreBrighterOverOrdersOfMagnitude) {
  const TemporaryFolder folder;
  State state(small_sphere());
  const Grid& grid = state.grid();
  std::vector<float> discharge(grid.size());
  for (Index i = 0; i < grid.size(); ++i) {
    discharge[i] = std::pow(10.0F, 6.0F * static_cast<float>(grid.column(i)) / 360.0F);
  }
  state.set(field::discharge, discharge);
  draw_field_file(state, field::discharge, folder / "field.png", {kWidth});
  const Picture picture(folder / "field.png", map_layout(grid, {kWidth}));
  double before = 0.0;
  for (double share = 0.05; share < 0.96; share += 0.15) {
    const Colour c = picture.map(static_cast<int>(share * kWidth), kWidth / 4 + 12);
    const double luminance = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
    EXPECT_GT(luminance, before + 3.0) << share;
    before = luminance;
  }
}

TEST(FieldMaps, NothingHasNoColourWhereMuchOfTheMapHasNothing) {
  const TemporaryFolder folder;
  State state = planet_of([](const auto&) { return 10.0; });
  const Grid& grid = state.grid();
  const auto paper_with = [&](double zeros) {
    std::vector<float> depth(grid.size());
    for (Index i = 0; i < grid.size(); ++i) {
      const double share = grid.column(i) / 360.0;
      depth[i] = share < zeros ? 0.0F : static_cast<float>(1.0 + 20.0 * share);
    }
    state.set(field::lake_depth, depth);
    draw_field_file(state, field::lake_depth, folder / "field.png", {kWidth});
    const Picture picture(folder / "field.png", map_layout(grid, {kWidth}));
    return difference(picture.map(kWidth / 36, kWidth / 4 + 12), {241, 238, 231}) < 12;
  };
  EXPECT_TRUE(paper_with(0.5));
  EXPECT_FALSE(paper_with(0.05));
}

TEST(IslandMaps, ContoursFollowTheirHeights) {
  const TemporaryFolder folder;
  State state(std::make_shared<Grid>(Grid::equal_area(120, 120, 500.0, Centre{45, 10})));
  const Grid& grid = state.grid();
  std::vector<float> cone(grid.size()), flat(grid.size(), 5.0F);
  for (Index i = 0; i < grid.size(); ++i) {
    const double out_m = std::hypot(grid.x_m(grid.column(i)), grid.y_m(grid.row(i)));
    cone[i] = static_cast<float>(1450.0 - 0.06 * out_m);
  }
  state.set(field::elevation, cone);
  const auto files = draw_island_files(state, folder.path(), "island", {1800});
  ASSERT_FALSE(files.empty());
  const Picture picture(files[0].path, map_layout(grid, {1800}));
  // From the middle to the lower left a line every 100 m of height: every 50 px, 35.4 of each axis.
  // It is darker than the ground 3 px to either side; the ground itself changes far less.
  const auto brightness = [&](int i) {
    const Colour c = picture.map(900 - i, 900 + i);
    return c.r + c.g + c.b;
  };
  std::vector<int> lines;
  for (int i = 60; i < 495; ++i) {
    const bool darkest = brightness(i) < brightness(i - 1) && brightness(i) <= brightness(i + 1);
    if (darkest && brightness(i) + 12 < std::min(brightness(i - 3), brightness(i + 3))) {
      lines.push_back(i);
    }
  }
  // From 2.8 km, at 1280 m, to 23.3 km, at 50 m.
  ASSERT_NEAR(static_cast<double>(lines.size()), 12.0, 1.0);
  for (const int line : lines) {
    const double height_m = 1450.0 - 0.06 * line * std::sqrt(2.0) * 60000.0 / 1800.0;
    EXPECT_NEAR(height_m, 100.0 * std::round(height_m / 100.0), 8.0) << line;
  }
}

}  // namespace
}  // namespace geo::io
