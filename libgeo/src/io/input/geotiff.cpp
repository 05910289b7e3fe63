#include "geotiff.hpp"

#include <fmt/format.h>
#include <geo_normalize.h>
#include <geotiff.h>
#include <geovalues.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>

#include "geo/core/error.hpp"
#include "io/files/packed_size.hpp"
#include "io/files/tiff_file.hpp"
#include "questions.hpp"

namespace geo::io {
namespace {

class Image {
 public:
  explicit Image(const std::filesystem::path& path) : tiff_(path, "r") {
    if (get() == nullptr) fail();
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    bytes_ = error ? 0 : bytes;
  }
  [[nodiscard]] TIFF* get() const { return tiff_.get(); }
  [[noreturn]] void fail() const {
    throw InputError(fmt::format("is no sound TIFF file ({})", tiff_.reason().empty()
                                                                   ? "libtiff does not say why"
                                                                   : tiff_.reason()));
  }
  /// Before memory is asked for.
  void check_size(int nx, int ny) const {
    if (nx < 1 || ny < 1) throw InputError("has no cells");
    check_packed_size(static_cast<double>(nx) * ny, sizeof(float), static_cast<double>(bytes_));
  }
  template <class T>
  [[nodiscard]] T tag(std::uint32_t tag, T otherwise) const {
    T value = otherwise;
    TIFFGetFieldDefaulted(get(), tag, &value);
    return value;
  }
  [[nodiscard]] std::vector<double> numbers(std::uint32_t tag) const {
    std::uint16_t count = 0;
    double* values = nullptr;
    if (TIFFGetField(get(), tag, &count, &values) == 0) return {};
    return {values, values + count};
  }

 private:
  TiffFile tiff_;
  std::uintmax_t bytes_ = 0;
};

/// How the samples of an image are stored.
struct Samples {
  std::uint16_t format, bits;
  [[nodiscard]] double read(const std::uint8_t* at) const {
    switch (format) {
      case SAMPLEFORMAT_IEEEFP:
        return bits == 32 ? as<float>(at) : as<double>(at);
      case SAMPLEFORMAT_INT:
        return bits == 8 ? as<std::int8_t>(at)
                         : (bits == 16 ? as<std::int16_t>(at) : as<std::int32_t>(at));
      default:
        return bits == 8 ? as<std::uint8_t>(at)
                         : (bits == 16 ? as<std::uint16_t>(at) : as<std::uint32_t>(at));
    }
  }
  [[nodiscard]] bool known() const {
    if (format == SAMPLEFORMAT_IEEEFP) return bits == 32 || bits == 64;
    return (format == SAMPLEFORMAT_INT || format == SAMPLEFORMAT_UINT) &&
           (bits == 8 || bits == 16 || bits == 32);
  }

 private:
  template <class T>
  static double as(const std::uint8_t* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
  }
};

constexpr std::uint32_t kPixelScale = 33550, kTransformation = 34264, kNoData = 42113;
constexpr std::uint32_t kTiePoints = 33922;

/// What GDAL writes for cells without a value.
std::optional<double> no_data(const Image& image) {
  std::uint32_t count = 0;
  const char* text = nullptr;
  if (TIFFGetField(image.get(), kNoData, &count, &text) == 0 || text == nullptr) return {};
  return std::strtod(std::string(text, strnlen(text, count)).c_str(), nullptr);
}

/// Values with row 0 the southernmost.
std::vector<float> read_values(const Image& image, int nx, int ny) {
  TIFF* const tiff = image.get();
  const Samples samples{image.tag<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT),
                        image.tag<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1)};
  if (image.tag<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1) != 1) {
    throw InputError("has several bands: must have one, of elevations");
  }
  if (!samples.known()) {
    throw InputError(
        fmt::format("has samples of {} bits: must be 8, 16 or 32 bit integers or 32 or "
                    "64 bit real numbers",
                    samples.bits));
  }
  const std::size_t bytes = samples.bits / 8;
  const std::optional<double> missing = no_data(image);
  image.check_size(nx, ny);
  std::vector<float> values(static_cast<std::size_t>(nx) * ny);
  const auto put = [&](int column, int row, const std::uint8_t* at) {
    const double value = samples.read(at);
    const bool gap = !std::isfinite(value) || (missing && value == *missing);
    values[static_cast<std::size_t>(ny - 1 - row) * nx + column] =
        gap ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value);
  };
  const bool tiled = TIFFIsTiled(tiff) != 0;
  const auto width =
      tiled ? image.tag<std::uint32_t>(TIFFTAG_TILEWIDTH, 0) : static_cast<std::uint32_t>(nx);
  const auto height =
      std::min(static_cast<std::uint32_t>(tiled ? 1 << 30 : ny),
               image.tag<std::uint32_t>(tiled ? TIFFTAG_TILELENGTH : TIFFTAG_ROWSPERSTRIP, 0));
  if (width == 0 || height == 0) image.fail();
  std::vector<std::uint8_t> block(
      static_cast<std::size_t>(tiled ? TIFFTileSize(tiff) : TIFFStripSize(tiff)));
  if (block.size() < static_cast<std::size_t>(width) * height * bytes) image.fail();
  for (int top = 0; top < ny; top += static_cast<int>(height)) {
    for (int left = 0; left < nx; left += static_cast<int>(width)) {
      const auto size = static_cast<tmsize_t>(block.size());
      const tmsize_t got =
          tiled ? TIFFReadEncodedTile(tiff, TIFFComputeTile(tiff, left, top, 0, 0), block.data(),
                                      size)
                : TIFFReadEncodedStrip(tiff, TIFFComputeStrip(tiff, top, 0), block.data(), size);
      const int rows = std::min(static_cast<int>(height), ny - top);
      const int columns = std::min(static_cast<int>(width), nx - left);
      if (got <
          static_cast<tmsize_t>((static_cast<std::size_t>(rows - 1) * width + columns) * bytes)) {
        image.fail();
      }
      for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
          put(left + i, top + j, &block[(static_cast<std::size_t>(j) * width + i) * bytes]);
        }
      }
    }
  }
  return values;
}

struct Placement {
  double west, north, step_x, step_y;  ///< outer corner, sizes of cells, in degrees or m
  bool geographic;
};

Placement placement_of(const Image& image) {
  const std::unique_ptr<GTIF, decltype(&GTIFFree)> keys(GTIFNew(image.get()), GTIFFree);
  GTIFDefn definition{};
  if (!keys || GTIFGetDefn(keys.get(), &definition) == 0) {
    throw InputError("says no coordinate system: must be a GeoTIFF");
  }
  Placement place{};
  if (definition.Model == ModelTypeGeographic) {
    place.geographic = true;
  } else if (definition.Model != ModelTypeProjected) {
    throw InputError("has a coordinate system that is neither geographic nor projected");
  }
  const double unit = place.geographic || !(definition.UOMLengthInMeters > 0.0)
                          ? 1.0
                          : definition.UOMLengthInMeters;
  const auto scale = image.numbers(kPixelScale), tie = image.numbers(kTiePoints);
  const auto matrix = image.numbers(kTransformation);
  if (scale.size() >= 2 && tie.size() >= 6) {
    place = {tie[3] - tie[0] * scale[0], tie[4] + tie[1] * scale[1], scale[0], scale[1],
             place.geographic};
  } else if (matrix.size() == 16 && matrix[1] == 0.0 && matrix[4] == 0.0) {
    place = {matrix[3], matrix[7], matrix[0], -matrix[5], place.geographic};
  } else {
    throw InputError("does not say where its cells lie, or is turned: must be north up");
  }
  std::uint16_t registration = RasterPixelIsArea;
  GTIFKeyGetSHORT(keys.get(), GTRasterTypeGeoKey, &registration, 0, 1);
  if (registration == RasterPixelIsPoint) {
    place.west -= 0.5 * place.step_x;
    place.north += 0.5 * place.step_y;
  }
  for (double* value : {&place.west, &place.north, &place.step_x, &place.step_y}) *value *= unit;
  if (!(place.step_x > 0.0) || !(place.step_y > 0.0)) {
    throw InputError("has cells of no size, or is not north up");
  }
  return place;
}

}  // namespace

Dem read_geotiff(const std::filesystem::path& path, const Planet& planet) {
  return answer_to(GeotiffQuestion{path.string(), planet.radius_km, planet.flattening});
}

PlainRaster read_geotiff_raster(const std::filesystem::path& path) {
  const Image image(path);
  const auto nx = static_cast<int>(image.tag<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0));
  const auto ny = static_cast<int>(image.tag<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0));
  const Placement at = placement_of(image);
  return {nx,
          ny,
          read_values(image, nx, ny),
          at.geographic,
          at.west,
          at.north - ny * at.step_y,
          at.step_x,
          at.step_y};
}

Dem GeotiffQuestion::here() const {
  const Planet planet{.radius_km = radius_km, .flattening = flattening};
  if (!std::ifstream(file)) {
    throw IoError(fmt::format("{}: cannot be read: {}", file, std::strerror(errno)));
  }
  try {
    const Image image(file);
    const auto nx = static_cast<int>(image.tag<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0));
    const auto ny = static_cast<int>(image.tag<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0));
    const Placement at = placement_of(image);
    std::vector<float> values = read_values(image, nx, ny);
    Grid grid =
        at.geographic
            ? Grid::window(nx, ny,
                           {at.north - ny * at.step_y, at.north, at.west, at.west + nx * at.step_x},
                           planet.figure())
            : Grid::plane(nx, ny, at.step_x, at.step_y, Edges::open, {}, planet.figure());
    return {std::move(values), std::move(grid), file, {}, {}, {}};
  } catch (const ConfigurationError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
}

}  // namespace geo::io
