#include "png_file.hpp"

#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstdio>

#include "geo/io/atomic_file.hpp"

namespace geo::io {
namespace {

static_assert(std::endian::native == std::endian::little, "Cairo's pixels are read as B G R X");

// Level 4 with one filter: a third of the default's time for a few per cent more bytes.
constexpr int kCompression = 4;

// Kept free of objects with destructors, for libpng leaves it with longjmp on errors.
bool encode(std::FILE* stream, const PixelView& pixels) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_init_io(png, stream);
  png_set_compression_level(png, kCompression);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, info, pixels.width, pixels.height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_set_bgr(png);
  png_set_filler(png, 0, PNG_FILLER_AFTER);
  for (int y = 0; y < pixels.height; ++y) {
    png_write_row(png, pixels.data + static_cast<std::ptrdiff_t>(y) * pixels.stride_bytes);
  }
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

void write_png(const std::filesystem::path& path, const PixelView& pixels) {
  AtomicFile file(path);
  std::FILE* stream = std::fopen(file.temporary().c_str(), "wb");
  if (stream == nullptr) file.fail("cannot open");
  const bool encoded = encode(stream, pixels);
  if (std::fclose(stream) != 0 || !encoded) file.fail("the PNG library refused");
  file.commit();
}

}  // namespace geo::io
