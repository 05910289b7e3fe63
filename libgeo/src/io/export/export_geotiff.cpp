#include <fmt/format.h>
#include <geotiff.h>
#include <geotiffio.h>
#include <geovalues.h>
#include <tiffio.h>
#include <xtiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>

#include "export_source.hpp"
#include "geo/core/error.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "io/files/tiff_file.hpp"
#include "io/maps/map_field.hpp"

namespace geo::io {
namespace {

constexpr int kTile = 512;
constexpr std::uint32_t kMetadata = 42112, kNoData = 42113;  // GDAL's own tags

/// A file of libtiff that is being written.
class Output {
 public:
  Output(const AtomicFile& file, const char* mode) : file_(file), tiff_(file.temporary(), mode) {
    check(get() != nullptr);
    know_tags();
  }
  /// Makes GDAL's tags known, for one directory.
  void know_tags() const {
    // libtiff keeps no copy of these names.
    static std::array<char, 16> metadata_name{"GDALMetadata"}, no_data_name{"GDALNoDataValue"};
    const std::array<TIFFFieldInfo, 2> tags{
        {{kMetadata, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, metadata_name.data()},
         {kNoData, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, no_data_name.data()}}};
    check(TIFFMergeFieldInfo(get(), tags.data(), tags.size()) == 0);
  }
  [[nodiscard]] TIFF* get() const { return tiff_.get(); }
  void check(bool good) const {
    if (!good) file_.fail(tiff_.reason().empty() ? "libtiff refused" : tiff_.reason());
  }
  template <class... T>
  void set(std::uint32_t tag, T... value) const {
    check(TIFFSetField(get(), tag, value...) == 1);
  }

 private:
  const AtomicFile& file_;
  TiffFile tiff_;
};

/// A raster with rows from the north.
template <class T>
struct Level {
  int nx, ny;
  std::vector<T> values;
};

/// What a file says of its cells without a value.
template <class T>
struct Missing {
  T value;
  [[nodiscard]] bool is(T other) const {
    if constexpr (std::is_floating_point_v<T>) return std::isnan(other);
    return other == value;
  }
};

template <class T>
Level<T> from_north(const Grid& grid, const std::vector<T>& values) {
  Level<T> level{grid.nx(), grid.ny(), std::vector<T>(values.size())};
  for (int row = 0; row < grid.ny(); ++row) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(row) * grid.nx();
    std::copy_n(
        from, grid.nx(),
        level.values.begin() + static_cast<std::ptrdiff_t>(grid.ny() - 1 - row) * grid.nx());
  }
  return level;
}

/// Half as fine: means of the cells that have a value, of whole numbers and categories the first.
template <class T>
Level<T> halved(const Level<T>& fine, const Missing<T>& missing) {
  Level<T> level{(fine.nx + 1) / 2, (fine.ny + 1) / 2, {}};
  level.values.resize(static_cast<std::size_t>(level.nx) * level.ny);
#pragma omp parallel for schedule(static)
  for (int y = 0; y < level.ny; ++y) {
    for (int x = 0; x < level.nx; ++x) {
      double sum = 0.0;
      int count = 0;
      T first = missing.value;
      for (const int k : {0, 1, 2, 3}) {
        const int fx = std::min(2 * x + k % 2, fine.nx - 1),
                  fy = std::min(2 * y + k / 2, fine.ny - 1);
        const T value = fine.values[static_cast<std::size_t>(fy) * fine.nx + fx];
        if (missing.is(value)) continue;
        if (count++ == 0) first = value;
        sum += static_cast<double>(value);
      }
      level.values[static_cast<std::size_t>(y) * level.nx + x] =
          std::is_floating_point_v<T> && count > 0 ? static_cast<T>(sum / count) : first;
    }
  }
  return level;
}

void put_figure(GTIF* keys, const Ellipsoid& figure) {
  GTIFKeySet(keys, GeographicTypeGeoKey, TYPE_SHORT, 1, KvUserDefined);
  GTIFKeySet(keys, GeogCitationGeoKey, TYPE_ASCII, 0, "planet of terrane");
  GTIFKeySet(keys, GeogGeodeticDatumGeoKey, TYPE_SHORT, 1, KvUserDefined);
  GTIFKeySet(keys, GeogEllipsoidGeoKey, TYPE_SHORT, 1, KvUserDefined);
  GTIFKeySet(keys, GeogSemiMajorAxisGeoKey, TYPE_DOUBLE, 1, figure.radius_m);
  if (figure.flattening > 0.0) {
    GTIFKeySet(keys, GeogInvFlatteningGeoKey, TYPE_DOUBLE, 1, 1.0 / figure.flattening);
  } else {
    GTIFKeySet(keys, GeogSemiMinorAxisGeoKey, TYPE_DOUBLE, 1, figure.radius_m);
  }
  GTIFKeySet(keys, GeogAngularUnitsGeoKey, TYPE_SHORT, 1, Angular_Degree);
}

void put_place(const Output& output, const Grid& grid) {
  const std::unique_ptr<GTIF, decltype(&GTIFFree)> keys(GTIFNew(output.get()), GTIFFree);
  output.check(keys != nullptr);
  std::array<double, 6> tie{};
  std::array<double, 3> scale{};
  GTIFKeySet(keys.get(), GTRasterTypeGeoKey, TYPE_SHORT, 1, RasterPixelIsArea);
  if (grid.is_latitude_longitude()) {
    const Window& w = grid.window();
    tie = {0.0, 0.0, 0.0, w.west_deg, w.north_deg, 0.0};
    scale = {(w.east_deg - w.west_deg) / grid.nx(), (w.north_deg - w.south_deg) / grid.ny(), 0.0};
    GTIFKeySet(keys.get(), GTModelTypeGeoKey, TYPE_SHORT, 1, ModelTypeGeographic);
    put_figure(keys.get(), grid.figure());
  } else {
    const double x = 0.5 * grid.nx() * grid.spacing_east_m(0);
    const double y = 0.5 * grid.ny() * grid.step_north_m();
    tie = {0.0, 0.0, 0.0, -x, y, 0.0};
    scale = {grid.spacing_east_m(0), grid.step_north_m(), 0.0};
    GTIFKeySet(keys.get(), GTModelTypeGeoKey, TYPE_SHORT, 1, ModelTypeProjected);
    GTIFKeySet(keys.get(), ProjLinearUnitsGeoKey, TYPE_SHORT, 1, Linear_Meter);
    if (grid.is_projected()) {
      put_figure(keys.get(), grid.figure());
      GTIFKeySet(keys.get(), ProjectedCSTypeGeoKey, TYPE_SHORT, 1, KvUserDefined);
      GTIFKeySet(keys.get(), PCSCitationGeoKey, TYPE_ASCII, 0, "island of terrane");
      GTIFKeySet(keys.get(), ProjectionGeoKey, TYPE_SHORT, 1, KvUserDefined);
      GTIFKeySet(keys.get(), ProjCoordTransGeoKey, TYPE_SHORT, 1, CT_LambertAzimEqualArea);
      GTIFKeySet(keys.get(), ProjCenterLatGeoKey, TYPE_DOUBLE, 1, grid.centre()->latitude_deg);
      GTIFKeySet(keys.get(), ProjCenterLongGeoKey, TYPE_DOUBLE, 1, grid.centre()->longitude_deg);
      GTIFKeySet(keys.get(), ProjFalseEastingGeoKey, TYPE_DOUBLE, 1, 0.0);
      GTIFKeySet(keys.get(), ProjFalseNorthingGeoKey, TYPE_DOUBLE, 1, 0.0);
    }
  }
  output.set(TIFFTAG_GEOTIEPOINTS, static_cast<int>(tie.size()), tie.data());
  output.set(TIFFTAG_GEOPIXELSCALE, static_cast<int>(scale.size()), scale.data());
  output.check(GTIFWriteKeys(keys.get()) != 0);
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    if (letter == '&')
      result += "&amp;";
    else if (letter == '<')
      result += "&lt;";
    else if (letter == '>')
      result += "&gt;";
    else
      result += letter;
  }
  return result;
}

void put_words(const Output& output, const ExportSource& source) {
  const FieldSpec& spec = *source.field;
  std::string items = fmt::format(
      "<Item name=\"DESCRIPTION\" sample=\"0\" role=\"description\">{}</Item>", escaped(spec.name));
  if (!spec.units.empty()) {
    items += fmt::format("<Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">{}</Item>",
                         escaped(spec.units));
  }
  items += fmt::format("<Item name=\"long_name\" sample=\"0\">{}</Item>", escaped(spec.doc));
  items +=
      fmt::format("<Item name=\"terrane_stage\">{}</Item><Item name=\"terrane_seed\">{}</Item>",
                  escaped(source.snapshot.stage), source.provenance.seed);
  for (const Flag& flag : spec.flags) {
    items += fmt::format("<Item name=\"category_{}\" sample=\"0\">{}</Item>", flag.value,
                         escaped(flag.meaning));
  }
  output.set(kMetadata, ("<GDALMetadata>" + items + "</GDALMetadata>").c_str());
  output.set(TIFFTAG_SOFTWARE, ("terrane " + source.provenance.version).c_str());
}

/// Red, green and blue of 256 values, 16 bits each.
using Palette = std::array<std::array<std::uint16_t, 256>, 3>;

Palette palette_of(const FieldSpec& spec) {
  Palette palette{};
  for (const auto& [rgb, flag] : category_colours(spec)) {
    if (flag->value < 0 || flag->value > 255) continue;
    const std::array<float, 3> parts{rgb.r, rgb.g, rgb.b};
    for (std::size_t k = 0; k < parts.size(); ++k) {
      palette[k][flag->value] = static_cast<std::uint16_t>(std::lround(parts[k] * 255.0F) * 257);
    }
  }
  return palette;
}

template <class T>
void put_shape(const Output& output, const Level<T>& level, const FieldSpec& spec,
               const Missing<T>& missing) {
  constexpr bool kReal = std::is_floating_point_v<T>;
  output.set(TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(level.nx));
  output.set(TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(level.ny));
  output.set(TIFFTAG_TILEWIDTH, static_cast<std::uint32_t>(kTile));
  output.set(TIFFTAG_TILELENGTH, static_cast<std::uint32_t>(kTile));
  output.set(TIFFTAG_SAMPLESPERPIXEL, 1);
  output.set(TIFFTAG_BITSPERSAMPLE, static_cast<int>(8 * sizeof(T)));
  output.set(TIFFTAG_SAMPLEFORMAT, kReal                 ? SAMPLEFORMAT_IEEEFP
                                   : std::is_signed_v<T> ? SAMPLEFORMAT_INT
                                                         : SAMPLEFORMAT_UINT);
  output.set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  output.set(TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  output.set(TIFFTAG_PREDICTOR, kReal            ? PREDICTOR_FLOATINGPOINT
                                : sizeof(T) == 1 ? PREDICTOR_NONE
                                                 : PREDICTOR_HORIZONTAL);
  const bool categories = sizeof(T) == 1 && !spec.flags.empty();
  output.set(TIFFTAG_PHOTOMETRIC, categories ? PHOTOMETRIC_PALETTE : PHOTOMETRIC_MINISBLACK);
  if (categories) {
    Palette palette = palette_of(spec);
    output.set(TIFFTAG_COLORMAP, palette[0].data(), palette[1].data(), palette[2].data());
  }
  output.set(kNoData, kReal ? "nan" : fmt::format("{}", static_cast<int>(missing.value)).c_str());
}

template <class T>
void write_tiles(const Output& output, const Level<T>& level, const Missing<T>& missing) {
  std::vector<T> tile(static_cast<std::size_t>(kTile) * kTile);
  for (int top = 0; top < level.ny; top += kTile) {
    for (int left = 0; left < level.nx; left += kTile) {
      std::fill(tile.begin(), tile.end(), missing.value);
      const int rows = std::min(kTile, level.ny - top), columns = std::min(kTile, level.nx - left);
      for (int j = 0; j < rows; ++j) {
        std::copy_n(level.values.begin() + static_cast<std::ptrdiff_t>(top + j) * level.nx + left,
                    columns, tile.begin() + static_cast<std::ptrdiff_t>(j) * kTile);
      }
      const auto bytes = static_cast<tmsize_t>(tile.size() * sizeof(T));
      const auto number = TIFFComputeTile(output.get(), left, top, 0, 0);
      output.check(TIFFWriteEncodedTile(output.get(), number, tile.data(), bytes) == bytes);
    }
  }
}

/// As readers over a network want it: all directories and tables of tiles first, then the tiles of
/// the coarsest level to those of the finest.
template <class T>
void write_levels(const std::filesystem::path& path, const ExportSource& source,
                  const std::vector<Level<T>>& levels, const Missing<T>& missing) {
  AtomicFile file(path);
  const double bytes = static_cast<double>(levels.front().values.size()) * sizeof(T) * 1.5;
  constexpr double kMostOfClassicTiff = 4e9;
  {
    const Output output(file, bytes > kMostOfClassicTiff ? "w8" : "w");
    for (std::size_t k = 0; k < levels.size(); ++k) {
      if (k > 0) {
        output.know_tags();
        output.set(TIFFTAG_SUBFILETYPE, static_cast<std::uint32_t>(FILETYPE_REDUCEDIMAGE));
      }
      put_shape(output, levels[k], *source.field, missing);
      if (k == 0) {
        put_words(output, source);
        put_place(output, source.grid());
      }
      TIFFDeferStrileArrayWriting(output.get());
      output.check(TIFFWriteCheck(output.get(), 1, "terrane") == 1);
      output.check(TIFFWriteDirectory(output.get()) == 1);
    }
  }
  const Output output(file, "r+");
  for (std::size_t k = 0; k < levels.size(); ++k) {
    output.check(TIFFSetDirectory(output.get(), static_cast<tdir_t>(k)) == 1);
    output.check(TIFFForceStrileArrayWriting(output.get()) == 1);
  }
  for (std::size_t k = levels.size(); k-- > 0;) {
    output.check(TIFFSetDirectory(output.get(), static_cast<tdir_t>(k)) == 1);
    write_tiles(output, levels[k], missing);
    output.check(TIFFFlush(output.get()) == 1);
  }
  file.commit();
}

template <class T>
void write_values(const std::filesystem::path& path, const ExportSource& source,
                  const std::vector<T>& values, const Missing<T>& missing) {
  std::vector<Level<T>> levels;
  levels.push_back(from_north(source.grid(), values));
  while (std::max(levels.back().nx, levels.back().ny) > kTile) {
    levels.push_back(halved(levels.back(), missing));
  }
  write_levels(path, source, levels, missing);
}

}  // namespace

void write_geotiff(const std::filesystem::path& output, const ExportSource& source) {
  const auto write = [&]<class T>(const std::vector<T>& values) {
    if constexpr (std::is_same_v<T, std::int8_t>) {
      // Clients read bytes without a sign; what is missing becomes 255.
      std::vector<std::uint8_t> bytes(values.begin(), values.end());
      constexpr std::uint8_t kNone = 255;
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] == source.field->missing) bytes[i] = kNone;
      }
      write_values<std::uint8_t>(output, source, bytes, {kNone});
    } else if constexpr (std::is_floating_point_v<T>) {
      write_values<T>(output, source, values, {std::numeric_limits<T>::quiet_NaN()});
    } else {
      write_values<T>(output, source, values, {static_cast<T>(source.field->missing)});
    }
  };
  std::visit(write, source.values());
}

}  // namespace geo::io
