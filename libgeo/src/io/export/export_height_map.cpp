#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <type_traits>

#include "export_source.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "grid_sampler.hpp"
#include "io/drawing/png_file.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kLargestSample = 65535.0;

/// One image: what its name has behind that of the layer, its size, and where its samples lie.
struct Image {
  std::string face, tile;
  int tile_x = 0, tile_y = 0;
  int width, height;
  std::function<GridPlace(int x, int y)> place;  ///< y from the top
};

/// How many tiles of `samples` cover `steps` steps between samples, never coarser.
int tiles_over(int steps, int samples) {
  return std::max(1, (steps + samples - 2) / (samples - 1));
}

/// The samples of a whole grid or of its tiles, rows from the north.
std::vector<Image> images_of_grid(const Grid& grid, int tile_samples) {
  const int nx = grid.nx(), ny = grid.ny();
  if (tile_samples == 0) {
    const auto place = [ny](int x, int y) {
      return GridPlace{static_cast<double>(x), static_cast<double>(ny - 1 - y)};
    };
    return {{"", "", 0, 0, nx, ny, place}};
  }
  // Round a planet and a torus samples lie on the edges of cells, the last ones on the first; on a
  // plane from the first centre to the last.
  const bool round = grid.topology() != Topology::plane;
  const int steps_x = round ? nx : nx - 1, steps_y = round ? ny : ny - 1;
  const int across = tiles_over(steps_x, tile_samples), down = tiles_over(steps_y, tile_samples);
  const double last_x = across * (tile_samples - 1.0), last_y = down * (tile_samples - 1.0);
  const bool torus = grid.topology() == Topology::torus;
  std::vector<Image> images;
  for (int ty = 0; ty < down; ++ty) {
    for (int tx = 0; tx < across; ++tx) {
      const int left = tx * (tile_samples - 1), top = ty * (tile_samples - 1);
      const auto place = [=](int x, int y) {
        double column = left + x, row = last_y - (top + y);
        if (round && column == last_x) column = 0.0;
        if (torus && row == last_y) row = 0.0;
        const double offset = round ? -0.5 : 0.0;
        return GridPlace{column * steps_x / last_x + offset, row * steps_y / last_y + offset};
      };
      images.push_back(
          {"", fmt::format("_x{}_y{}", tx, ty), tx, ty, tile_samples, tile_samples, place});
    }
  }
  return images;
}

/// A place on a cube round the planet in whole steps, x to longitude 0, z to the north: faces that
/// share an edge give its places the same numbers, and so the same bits in all that follows.
struct CubePlace {
  int x, y, z;
};

struct CubeFace {
  const char* name;
  /// `right` and `up` run from -m to m over the face.
  CubePlace (*place)(int right, int up, int m);
};

// Each is seen from outside. The four round the equator stand north up, the top lies above the
// front and the bottom below it, as in an unfolded cross.
constexpr std::array<CubeFace, 6> kFaces{{{"front",
                                           [](int a, int b, int m) {
                                             return CubePlace{m, a, b};
                                           }},
                                          {"right",
                                           [](int a, int b, int m) {
                                             return CubePlace{-a, m, b};
                                           }},
                                          {"back",
                                           [](int a, int b, int m) {
                                             return CubePlace{-m, -a, b};
                                           }},
                                          {"left",
                                           [](int a, int b, int m) {
                                             return CubePlace{a, -m, b};
                                           }},
                                          {"top",
                                           [](int a, int b, int m) {
                                             return CubePlace{-b, a, m};
                                           }},
                                          {"bottom", [](int a, int b, int m) {
                                             return CubePlace{b, a, -m};
                                           }}}};

Centre position_of(const CubePlace& at) {
  const double x = at.x, y = at.y, z = at.z;
  if (at.x == 0 && at.y == 0) return {at.z > 0 ? 90.0 : -90.0, 0.0};
  return {std::atan2(z, std::sqrt(x * x + y * y)) * kDegrees, std::atan2(y, x) * kDegrees};
}

std::vector<Image> images_of_cube(const Grid& grid, int tile_samples) {
  if (grid.topology() != Topology::sphere) {
    throw ConfigurationError("--layout cube: takes a whole planet, this grid is a part of one");
  }
  // Steps as long as cells at the equator.
  const int steps = std::max(2, grid.nx() / 4);
  const int tiles = tile_samples == 0 ? 1 : tiles_over(steps, tile_samples);
  const int samples = tile_samples == 0 ? steps + 1 : tile_samples;
  const int m = tiles * (samples - 1);
  std::vector<Image> images;
  for (const CubeFace& face : kFaces) {
    for (int ty = 0; ty < tiles; ++ty) {
      for (int tx = 0; tx < tiles; ++tx) {
        const int left = tx * (samples - 1), top = ty * (samples - 1);
        const auto place = [&grid, &face, left, top, m](int x, int y) {
          const Centre at = position_of(face.place(2 * (left + x) - m, m - 2 * (top + y), m));
          return GridSampler::place_of(grid, at.latitude_deg, at.longitude_deg);
        };
        images.push_back({face.name, tile_samples == 0 ? "" : fmt::format("_x{}_y{}", tx, ty), tx,
                          ty, samples, samples, place});
      }
    }
  }
  return images;
}

/// DIR/NAME-LAYER-FACE_x0_y0.EXTENSION.
fs::path path_of(const fs::path& output, std::string_view layer, const Image& image,
                 const std::string& extension) {
  std::string name = output.stem().string();
  if (!layer.empty()) name += fmt::format("-{}", layer);
  if (!image.face.empty()) name += "-" + image.face;
  return output.parent_path() / (name + image.tile + extension);
}

/// Fills an image sample by sample on all threads.
template <class T, class Sample>
std::vector<T> filled(const Image& image, const Sample& sample) {
  std::vector<T> samples(static_cast<std::size_t>(image.width) * image.height);
#pragma omp parallel for schedule(static)
  for (int y = 0; y < image.height; ++y) {
    T* const row = samples.data() + static_cast<std::size_t>(y) * image.width;
    for (int x = 0; x < image.width; ++x) row[x] = sample(image.place(x, y));
  }
  return samples;
}

/// Bare numbers, little-endian.
void write_raw(const fs::path& path, const std::vector<std::uint16_t>& samples) {
  AtomicFile file(path);
  std::FILE* const stream = std::fopen(file.temporary().c_str(), "wb");
  if (stream == nullptr) file.fail("cannot open");
  const bool written =
      std::fwrite(samples.data(), sizeof samples[0], samples.size(), stream) == samples.size();
  if (std::fclose(stream) != 0 || !written) file.fail("write failed");
  file.commit();
}

/// Numbers of samples: value = offset + scale * sample; where there are gaps, sample 0 is one.
struct Quantisation {
  double least, most, offset, scale;
  bool gaps;

  [[nodiscard]] std::uint16_t sample(float value) const {
    if (std::isnan(value)) return 0;
    const double number = std::round((static_cast<double>(value) - offset) / scale);
    return static_cast<std::uint16_t>(std::clamp(number, gaps ? 1.0 : 0.0, kLargestSample));
  }
};

Quantisation quantisation_of(const ExportRequest& request, const GridSampler& sampler,
                             const FieldSpec& spec) {
  double least = sampler.least(), most = sampler.most();
  if (request.range) std::tie(least, most) = *request.range;
  if (!std::isfinite(least) || !std::isfinite(most)) {
    throw InputError(fmt::format("{}: has no cell with a finite value to export", spec.name));
  }
  const bool gaps = sampler.has_gaps();
  const double steps = gaps ? kLargestSample - 1.0 : kLargestSample;
  const double scale = most > least ? (most - least) / steps : 1.0;
  return {least, most, gaps ? least - scale : least, scale, gaps};
}

// ---- masks

/// An 8-bit layer over the cells of the grid.
struct Mask {
  std::string name;
  std::vector<std::uint8_t> values;
  Json meaning;
};

constexpr std::array<std::string_view, 5> kMaskNames{"biomes", "rivers", "lakes", "slope",
                                                     "wetness"};

std::span<const float> floats_of(const ExportSource& source, const FieldSpec& spec) {
  return std::get<std::vector<float>>(source.of(spec));
}

template <class Value>
std::vector<std::uint8_t> byte_layer(const ExportSource& source, const Value& value) {
  std::vector<std::uint8_t> layer(source.grid().size());
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < source.grid().size(); ++cell) {
    layer[cell] = static_cast<std::uint8_t>(
        std::clamp(std::round(static_cast<double>(value(cell))), 0.0, 255.0));
  }
  return layer;
}

void require(const ExportSource& source, std::string_view mask,
             std::initializer_list<const FieldSpec*> fields) {
  for (const FieldSpec* spec : fields) {
    if (source.has(*spec)) continue;
    throw ConfigurationError(
        fmt::format("--masks {}: needs the field {}, which is not there", mask, spec->name));
  }
}

/// The number of each cell's biome, and for each biome that occurs a layer of its cells.
void add_biomes(const ExportSource& source, std::vector<Mask>& masks) {
  require(source, "biomes", {&field::biome});
  const auto& biome = std::get<std::vector<std::int8_t>>(source.of(field::biome));
  Json meanings = Json::object();
  for (const Flag& flag : field::biome.flags) {
    meanings[std::to_string(flag.value)] = std::string(flag.meaning);
  }
  constexpr double kNone = 255.0;
  masks.push_back({"biomes",
                   byte_layer(source, [&](Index i) { return biome[i] < 0 ? kNone : biome[i]; }),
                   {{"quantity", "biome"}, {"values", meanings}, {"missing", 255}}});
  for (const Flag& flag : field::biome.flags) {
    if (std::find(biome.begin(), biome.end(), flag.value) == biome.end()) continue;
    masks.push_back(
        {fmt::format("biome-{}", flag.meaning),
         byte_layer(source, [&](Index i) { return biome[i] == flag.value ? 255.0 : 0.0; }),
         {{"quantity", fmt::format("255 where the biome is {}", flag.meaning)}}});
  }
}

/// Topographic wetness index ln(a / tan b) (Beven & Kirkby 1979): a is the drainage area over the
/// width of the cell, b the slope.
Mask wetness(const ExportSource& source) {
  require(source, "wetness",
          {&field::drainage_area, &field::slope, &field::elevation, &field::lake_depth});
  // Slopes below this are less than relief resolves.
  constexpr double kLeastSlope = 1e-4, kDriest = 0.0, kWettest = 30.0;
  const auto& area = std::get<std::vector<double>>(source.of(field::drainage_area));
  const auto slope = floats_of(source, field::slope),
             elevation = floats_of(source, field::elevation);
  const auto lake = floats_of(source, field::lake_depth);
  const Grid& grid = source.grid();
  const auto value = [&](Index i) {
    if (elevation[i] < 0.0F || lake[i] > 0.0F) return 255.0;
    const double width = std::sqrt(grid.area_m2(grid.row(i)));
    const double index = std::log(std::max(area[i], width * width) / width /
                                  std::max<double>(slope[i], kLeastSlope));
    return 255.0 * (index - kDriest) / (kWettest - kDriest);
  };
  return {"wetness",
          byte_layer(source, value),
          {{"quantity", "topographic wetness index ln(a / tan b), a in m; seas and lakes 255"},
           {"offset", kDriest},
           {"scale", (kWettest - kDriest) / 255.0}}};
}

std::vector<Mask> masks_of(const ExportRequest& request, const ExportSource& source) {
  std::vector<Mask> masks;
  std::vector<std::string> names = request.masks;
  if (names == std::vector<std::string>{"all"}) names.assign(kMaskNames.begin(), kMaskNames.end());
  for (const std::string& name : names) {
    if (name == "biomes") {
      add_biomes(source, masks);
    } else if (name == "rivers") {
      require(source, name, {&field::river_intensity});
      const auto river = floats_of(source, field::river_intensity);
      masks.push_back({name,
                       byte_layer(source, [&](Index i) { return 255.0F * river[i]; }),
                       {{"quantity", "river_intensity"}, {"offset", 0.0}, {"scale", 1.0 / 255.0}}});
    } else if (name == "lakes") {
      require(source, name, {&field::lake_depth});
      const auto depth = floats_of(source, field::lake_depth);
      masks.push_back({name,
                       byte_layer(source, [&](Index i) { return depth[i] > 0.0F ? 255.0 : 0.0; }),
                       {{"quantity", "255 where a lake stands"}}});
    } else if (name == "slope") {
      require(source, name, {&field::slope});
      const auto slope = floats_of(source, field::slope);
      masks.push_back({name,
                       byte_layer(source,
                                  [&](Index i) {
                                    return std::atan(static_cast<double>(slope[i])) * kDegrees *
                                           255.0 / 90.0;
                                  }),
                       {{"quantity", "angle of the steepest descent"},
                        {"units", "degree"},
                        {"offset", 0.0},
                        {"scale", 90.0 / 255.0}}});
    } else if (name == "wetness") {
      masks.push_back(wetness(source));
    } else {
      throw ConfigurationError(fmt::format("--masks {}: must be all or some of {}{}", name,
                                           fmt::join(kMaskNames, ", "),
                                           suggestion(name, kMaskNames)));
    }
  }
  return masks;
}

// ---- the JSON beside them

Json corner(const Grid& grid, const Image& image, int x, int y) {
  const GridPlace at = image.place(x, y);
  if (grid.is_latitude_longitude()) {
    const Window& w = grid.window();
    return {{"latitude", w.south_deg + (at.row + 0.5) / grid.ny() * (w.north_deg - w.south_deg)},
            {"longitude", w.west_deg + (at.column + 0.5) / grid.nx() * (w.east_deg - w.west_deg)}};
  }
  return {{"x", grid.x_m(0) + at.column * grid.spacing_east_m(0)},
          {"y", grid.y_m(0) + at.row * grid.step_north_m()}};
}

Json extent(const Grid& grid) {
  if (grid.is_latitude_longitude()) {
    const Window& w = grid.window();
    return {{"west", w.west_deg},
            {"south", w.south_deg},
            {"east", w.east_deg},
            {"north", w.north_deg},
            {"units", "degree"}};
  }
  const double x = 0.5 * grid.nx() * grid.spacing_east_m(0),
               y = 0.5 * grid.ny() * grid.step_north_m();
  return {{"west", -x}, {"south", -y}, {"east", x}, {"north", y}, {"units", "m"}};
}

Json description(const ExportRequest& request, const ExportSource& source,
                 const Quantisation& numbers, const std::vector<Image>& images) {
  const Grid& grid = source.grid();
  Json json{{"field", std::string(source.field->name)},
            {"units", std::string(source.field->units)},
            {"long_name", std::string(source.field->doc)},
            {"stage", source.snapshot.stage},
            {"format", request.format == ExportFormat::png16 ? "png16" : "r16"},
            {"bits", 16},
            {"byte_order", request.format == ExportFormat::png16 ? "big" : "little"},
            {"width", images.front().width},
            {"height", images.front().height},
            {"min", numbers.least},
            {"max", numbers.most},
            {"offset", numbers.offset},
            {"scale", numbers.scale},
            {"missing", numbers.gaps ? Json(0) : Json()},
            {"layout", request.cube ? "cube" : "whole"},
            {"samples", request.cube || request.tile_samples != 0 ? "edges" : "cells"},
            {"cells", {{"width", grid.nx()}, {"height", grid.ny()}}},
            {"extent", extent(grid)}};
  const std::string crs = proj_words(grid);
  if (!crs.empty()) json["crs"] = crs;
  json["source"] = {{"program", "terrane " + source.provenance.version},
                    {"seed", source.provenance.seed}};
  return json;
}

Json entry(const Grid& grid, const Image& image, const fs::path& file) {
  Json json{{"file", file.filename().string()}};
  if (!image.face.empty()) json["face"] = image.face;
  if (!image.tile.empty()) json["tile"] = {{"x", image.tile_x}, {"y", image.tile_y}};
  const int right = image.width - 1, bottom = image.height - 1;
  json["top_left"] = corner(grid, image, 0, 0);
  json["top_right"] = corner(grid, image, right, 0);
  json["bottom_left"] = corner(grid, image, 0, bottom);
  json["bottom_right"] = corner(grid, image, right, bottom);
  return json;
}

}  // namespace

std::vector<std::string_view> export_mask_names() { return {kMaskNames.begin(), kMaskNames.end()}; }

std::vector<fs::path> export_height_map(const ExportRequest& request, const ExportSource& source,
                                        const fs::path& output) {
  const Grid& grid = source.grid();
  const auto held = as_floats(*source.field, shared_values(source, *source.field));
  const GridSampler sampler(grid, *held);
  const Quantisation numbers = quantisation_of(request, sampler, *source.field);
  const auto images = request.cube ? images_of_cube(grid, request.tile_samples)
                                   : images_of_grid(grid, request.tile_samples);
  const std::vector<Mask> masks = masks_of(request, source);
  const bool png = request.format == ExportFormat::png16;
  const std::string extension = output.has_extension() ? output.extension().string()
                                : png                  ? ".png"
                                                       : ".r16";
  if (extension == ".json") {
    throw ConfigurationError(
        fmt::format("-o {}: the description takes that name: give one that ends in {}",
                    output.string(), png ? ".png" : ".r16"));
  }
  std::vector<fs::path> written;
  Json files = Json::array(), layers = Json::array();
  for (const Image& image : images) {
    written.push_back(path_of(output, "", image, extension));
    const auto samples = filled<std::uint16_t>(
        image, [&](GridPlace place) { return numbers.sample(sampler.at(place)); });
    png ? write_grey_png(written.back(), samples, image.width, image.height)
        : write_raw(written.back(), samples);
    files.push_back(entry(grid, image, written.back()));
  }
  for (const Mask& mask : masks) {
    Json names = Json::array();
    for (const Image& image : images) {
      written.push_back(path_of(output, mask.name, image, ".png"));
      const auto samples = filled<std::uint8_t>(
          image, [&](GridPlace place) { return mask.values[sampler.nearest(place)]; });
      write_grey_png(written.back(), samples, image.width, image.height);
      names.push_back(written.back().filename().string());
    }
    Json layer{{"name", mask.name}};
    layer.update(mask.meaning);
    layer["files"] = names;
    layers.push_back(layer);
  }
  Json json = description(request, source, numbers, images);
  json["files"] = files;
  json["masks"] = layers;
  written.push_back(output.parent_path() / (output.stem().string() + ".json"));
  write_text_file(written.back(), json.dump(2) + "\n");
  return written;
}

}  // namespace geo::io
