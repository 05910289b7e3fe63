#include "plain_raster.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "geo/core/error.hpp"
#include "io/files/packed_size.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

constexpr float kGap = std::numeric_limits<float>::quiet_NaN();

double bytes_of(const fs::path& path) {
  std::error_code error;
  const auto bytes = fs::file_size(path, error);
  return error ? 0.0 : static_cast<double>(bytes);
}

std::string lower(std::string text) {
  for (char& letter : text)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

// ---- PNG

void keep_reason(png_structp png, png_const_charp reason) {
  *static_cast<std::string*>(png_get_error_ptr(png)) = reason;
  png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

/// What libpng reads with, which goes with it also where the constructor of its owner throws.
struct PngStructs {
  explicit PngStructs(std::string& reason)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &reason, keep_reason, ignore)) {
    if (png != nullptr) info = png_create_info_struct(png);
  }
  ~PngStructs() { png_destroy_read_struct(&png, &info, nullptr); }
  PngStructs(const PngStructs&) = delete;
  PngStructs& operator=(const PngStructs&) = delete;

  png_structp png;
  png_infop info = nullptr;
};

/// A PNG file that is being read. What libpng leaves with longjmp holds no objects.
class Png {
 public:
  explicit Png(const fs::path& path)
      : stream_(std::fopen(path.c_str(), "rb"), std::fclose), structs_(reason_) {
    if (!stream_) throw IoError(fmt::format("{}: cannot be read", path.string()));
    if (info_ == nullptr) throw std::bad_alloc();
    if (!begin()) fail();
  }

  [[nodiscard]] int width() const { return static_cast<int>(png_get_image_width(png_, info_)); }
  [[nodiscard]] int height() const { return static_cast<int>(png_get_image_height(png_, info_)); }
  /// Bits of a sample once read: 8 or 16.
  [[nodiscard]] int bits() const {
    return std::max(8, static_cast<int>(png_get_bit_depth(png_, info_)));
  }
  [[nodiscard]] bool is_grey() const {
    const auto type = png_get_color_type(png_, info_);
    return type == PNG_COLOR_TYPE_GRAY || type == PNG_COLOR_TYPE_GRAY_ALPHA;
  }
  /// All samples, row by row from the top, most significant byte first.
  [[nodiscard]] std::vector<std::uint8_t> samples() {
    const std::size_t row = static_cast<std::size_t>(width()) * bits() / 8;
    std::vector<std::uint8_t> bytes(row * height());
    std::vector<png_bytep> rows(height());
    for (int y = 0; y < height(); ++y) rows[y] = bytes.data() + row * y;
    if (!read(rows.data())) fail();
    return bytes;
  }

 private:
  [[noreturn]] void fail() const {
    throw InputError(fmt::format("is no sound PNG file ({})", reason_));
  }
  bool begin() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_init_io(png_, stream_.get());
    png_read_info(png_, info_);
    return true;
  }
  bool read(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_expand_gray_1_2_4_to_8(png_);
    png_set_strip_alpha(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  std::string reason_ = "libpng does not say why";
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
  PngStructs structs_;
  png_structp png_ = structs_.png;
  png_infop info_ = structs_.info;
};

/// value = offset + scale * sample, and where the picture lies.
struct Meaning {
  double offset = 0.0, scale = 0.0, missing = -1.0;
  std::optional<Window> window;
  std::optional<std::array<double, 2>> size_m;  ///< of a plane
};

/// What `terrane export` wrote beside an image; nothing where there is none.
std::optional<Meaning> described_beside(const fs::path& path) {
  const fs::path file = fs::path(path).replace_extension(".json");
  std::ifstream stream(file);
  if (!stream) return {};
  try {
    const auto json = nlohmann::json::parse(stream);
    if (!json.contains("offset") || !json.contains("scale")) return {};
    Meaning meaning;
    meaning.offset = json.at("offset").get<double>();
    meaning.scale = json.at("scale").get<double>();
    if (json.at("missing").is_number()) meaning.missing = json.at("missing").get<double>();
    if (json.at("samples") != "cells") return meaning;
    const auto& extent = json.at("extent");
    const auto edge = [&](const char* name) { return extent.at(name).get<double>(); };
    if (extent.at("units") == "degree") {
      meaning.window = Window{edge("south"), edge("north"), edge("west"), edge("east")};
    } else {
      meaning.size_m = {edge("east") - edge("west"), edge("north") - edge("south")};
    }
    return meaning;
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("{} beside it is not what terrane export writes: give --dem-range",
                                 file.filename().string()));
  }
}

Meaning meaning_of(const fs::path& path, const ImageMeaning& given, double greatest) {
  Meaning meaning;
  const auto take = [&](double least, double most) {
    meaning.offset = least;
    meaning.scale = (most - least) / greatest;
  };
  if (given.range) {
    take(given.range->first, given.range->second);
  } else if (const auto beside = described_beside(path)) {
    meaning = *beside;
  } else if (std::isfinite(given.least) && std::isfinite(given.most)) {
    take(given.least, given.most);
  } else {
    throw InputError(
        "does not say what its samples mean: give --dem-range MIN,MAX, the values of black and "
        "white, or the JSON that terrane export writes beside it");
  }
  if (given.window) {
    meaning.window = given.window;
    meaning.size_m.reset();
  }
  if (!std::isfinite(meaning.offset) || !std::isfinite(meaning.scale)) {
    throw InputError("has a range that is not finite");
  }
  return meaning;
}

// ---- ESRI ASCII

/// The next word of a text, empty at its end.
std::string_view next_word(std::string_view text, std::size_t& at) {
  const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (at < text.size() && is_space(text[at])) ++at;
  const std::size_t from = at;
  while (at < text.size() && !is_space(text[at])) ++at;
  return text.substr(from, at - from);
}

std::optional<double> number_in(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return {};
  return number;
}

/// A word of a file as a message quotes it: short, and of letters that every terminal has.
std::string shown_word(std::string_view word) {
  constexpr std::size_t kMost = 40;
  std::string text(word.substr(0, kMost));
  for (char& letter : text) letter = letter > ' ' && letter <= '~' ? letter : '?';
  return text;
}

struct AsciiHeader {
  double columns = 0.0, rows = 0.0, x = 0.0, y = 0.0, dx = 0.0, dy = 0.0;
  bool centre_x = false, centre_y = false;
  std::optional<double> missing;
};

/// Reads the keys and leaves `at` before the first value.
AsciiHeader read_header(std::string_view text, std::size_t& at) {
  AsciiHeader header;
  bool has_x = false, has_y = false;
  for (;;) {
    std::size_t ahead = at;
    const std::string key = lower(std::string(next_word(text, ahead)));
    if (key.empty() || number_in(key)) break;
    const auto value = number_in(next_word(text, ahead));
    if (!value) throw InputError(fmt::format("key {} of its head has no number", shown_word(key)));
    if (key == "ncols")
      header.columns = *value;
    else if (key == "nrows")
      header.rows = *value;
    else if (key == "cellsize")
      header.dx = header.dy = *value;
    else if (key == "dx")
      header.dx = *value;
    else if (key == "dy")
      header.dy = *value;
    else if (key == "nodata_value")
      header.missing = *value;
    else if (key == "xllcorner" || key == "xllcenter") {
      header.x = *value, header.centre_x = key == "xllcenter", has_x = true;
    } else if (key == "yllcorner" || key == "yllcenter") {
      header.y = *value, header.centre_y = key == "yllcenter", has_y = true;
    } else {
      throw InputError(
          fmt::format("key {} of its head is none of an ESRI ASCII grid", shown_word(key)));
    }
    at = ahead;
  }
  constexpr double kMost = 1 << 30;
  const auto is_count = [](double count) {
    return count >= 1.0 && count < kMost && count == std::floor(count);
  };
  if (!is_count(header.columns) || !is_count(header.rows)) {
    throw InputError("head must have ncols and nrows, whole numbers of at least 1");
  }
  if (!(header.dx > 0.0 && header.dy > 0.0) || !has_x || !has_y) {
    throw InputError("head must have xllcorner, yllcorner (or -center) and cellsize above 0");
  }
  if (header.centre_x) header.x -= 0.5 * header.dx;
  if (header.centre_y) header.y -= 0.5 * header.dy;
  return header;
}

}  // namespace

RasterFormat format_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::array<char, 64> head{};
  stream.read(head.data(), head.size());
  const std::string_view text(head.data(), static_cast<std::size_t>(stream.gcount()));
  if (text.starts_with("\x89PNG")) return RasterFormat::png;
  for (const auto& magic : {std::string_view("II*\0", 4), std::string_view("MM\0*", 4),
                            std::string_view("II+\0", 4), std::string_view("MM\0+", 4)}) {
    if (text.starts_with(magic)) return RasterFormat::geotiff;
  }
  std::size_t at = 0;
  const std::string word = lower(std::string(next_word(text, at)));
  return word == "ncols" || word == "nrows" ? RasterFormat::ascii : RasterFormat::netcdf;
}

PlainRaster read_png_raster(const fs::path& path, const ImageMeaning& given) {
  Png png(path);
  if (!png.is_grey()) throw InputError("is coloured: must be grey, of 8 or 16 bits");
  const int nx = png.width(), ny = png.height(), bits = png.bits();
  check_packed_size(static_cast<double>(nx) * ny, sizeof(float) + bits / 8.0, bytes_of(path));
  const Meaning meaning = meaning_of(path, given, bits == 16 ? 65535.0 : 255.0);
  PlainRaster raster{nx, ny, std::vector<float>(static_cast<std::size_t>(nx) * ny)};
  const auto bytes = png.samples();
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * nx + x;
      const int sample = bits == 16 ? bytes[2 * i] * 256 + bytes[2 * i + 1] : bytes[i];
      raster.values[static_cast<std::size_t>(ny - 1 - y) * nx + x] =
          sample == meaning.missing ? kGap
                                    : static_cast<float>(meaning.offset + meaning.scale * sample);
    }
  }
  if (meaning.size_m) {
    raster.geographic = false;
    raster.step_x = (*meaning.size_m)[0] / nx;
    raster.step_y = (*meaning.size_m)[1] / ny;
    return raster;
  }
  const Window w = meaning.window.value_or(Window{-90.0, 90.0, -180.0, 180.0});
  raster.west = w.west_deg;
  raster.south = w.south_deg;
  raster.step_x = (w.east_deg - w.west_deg) / nx;
  raster.step_y = (w.north_deg - w.south_deg) / ny;
  return raster;
}

PlainRaster read_ascii_raster(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream whole;
  whole << stream.rdbuf();
  if (!stream) throw IoError(fmt::format("{}: cannot be read", path.string()));
  const std::string text = std::move(whole).str();
  std::size_t at = 0;
  const AsciiHeader header = read_header(text, at);
  // Each value takes a letter and a blank at least.
  if (header.columns * header.rows > static_cast<double>(text.size())) {
    throw InputError(
        fmt::format("is too short for {:.0f} x {:.0f} values", header.columns, header.rows));
  }
  PlainRaster raster{static_cast<int>(header.columns), static_cast<int>(header.rows), {}};
  raster.values.resize(static_cast<std::size_t>(raster.nx) * raster.ny);
  for (int y = raster.ny - 1; y >= 0; --y) {
    for (int x = 0; x < raster.nx; ++x) {
      const std::string_view word = next_word(text, at);
      const auto value = number_in(word);
      if (!value) {
        throw InputError(fmt::format(
            "row {} from the top, column {}: {}", raster.ny - y, x + 1,
            word.empty() ? "is missing" : fmt::format("\"{}\" is no number", shown_word(word))));
      }
      const bool gap = !std::isfinite(*value) || value == header.missing;
      raster.values[static_cast<std::size_t>(y) * raster.nx + x] =
          gap ? kGap : static_cast<float>(*value);
    }
  }
  if (!next_word(text, at).empty()) throw InputError("has more values than its head says");
  raster.west = header.x;
  raster.south = header.y;
  raster.step_x = header.dx;
  raster.step_y = header.dy;
  const double east = header.x + raster.nx * header.dx, north = header.y + raster.ny * header.dy;
  constexpr double kSlack = 1e-6;
  raster.geographic = header.x >= -360.0 - kSlack && east <= 360.0 + kSlack &&
                      header.y >= -90.0 - kSlack && north <= 90.0 + kSlack &&
                      east - header.x <= 360.0 + kSlack;
  return raster;
}

std::pair<double, double> parse_range(std::string_view what, std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma != std::string_view::npos) {
    const auto least = number_in(text.substr(0, comma)), most = number_in(text.substr(comma + 1));
    if (least && most && std::isfinite(*least) && std::isfinite(*most) && *least != *most) {
      return {*least, *most};
    }
  }
  throw ConfigurationError(fmt::format(
      "{} {}: must be two different numbers, such as --dem-range=-11000,9000", what, text));
}

}  // namespace geo::io
