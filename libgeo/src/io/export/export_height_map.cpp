#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "export_masks.hpp"
#include "export_source.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "grid_sampler.hpp"
#include "height_map_images.hpp"
#include "io/drawing/png_file.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kLargestSample = 65535.0;

/// DIR/NAME-LAYER-FACE_x0_y0.EXTENSION.
fs::path path_of(const fs::path& output, std::string_view layer, const SampledImage& image,
                 const std::string& extension) {
  std::string name = output.stem().string();
  if (!layer.empty()) name += fmt::format("-{}", layer);
  if (!image.face.empty()) name += "-" + image.face;
  return output.parent_path() / (name + image.tile + extension);
}

/// Fills an image sample by sample on all threads.
template <class T, class Sample>
std::vector<T> filled(const SampledImage& image, const Sample& sample) {
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

Json corner(const Grid& grid, const SampledImage& image, int x, int y) {
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
                 const Quantisation& numbers, const std::vector<SampledImage>& images) {
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

Json entry(const Grid& grid, const SampledImage& image, const fs::path& file) {
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

std::vector<fs::path> export_height_map(const ExportRequest& request, const ExportSource& source,
                                        const fs::path& output) {
  const Grid& grid = source.grid();
  const auto held = as_floats(*source.field, shared_values(source, *source.field));
  const GridSampler sampler(grid, *held);
  const Quantisation numbers = quantisation_of(request, sampler, *source.field);
  const auto images = request.cube ? images_of_cube(grid, request.tile_samples)
                                   : images_of_grid(grid, request.tile_samples);
  const std::vector<ExportMask> masks = masks_of(request, source);
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
  for (const SampledImage& image : images) {
    written.push_back(path_of(output, "", image, extension));
    const auto samples = filled<std::uint16_t>(
        image, [&](GridPlace place) { return numbers.sample(sampler.at(place)); });
    png ? write_grey_png(written.back(), samples, image.width, image.height)
        : write_raw(written.back(), samples);
    files.push_back(entry(grid, image, written.back()));
  }
  for (const ExportMask& mask : masks) {
    Json names = Json::array();
    for (const SampledImage& image : images) {
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
