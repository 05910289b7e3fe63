#include "png_file.hpp"

#include <libdeflate.h>
#include <png.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "geo/io/atomic_file.hpp"

namespace geo::io {
namespace {

static_assert(std::endian::native == std::endian::little, "Cairo's pixels are read as B G R X");

// Compressing is a good part of drawing: higher levels take twice the time for a few per cent.
constexpr int kCompression = 1;
constexpr int kComponents = 3;

/// Rows of R G B behind their filter type: 1, each byte less that of the pixel to the west.
std::vector<std::uint8_t> filtered(const PixelView& pixels) {
  const std::size_t row_bytes = 1 + static_cast<std::size_t>(pixels.width) * kComponents;
  std::vector<std::uint8_t> rows(row_bytes * pixels.height);
  for (int y = 0; y < pixels.height; ++y) {
    const std::uint8_t* from = pixels.data + static_cast<std::ptrdiff_t>(y) * pixels.stride_bytes;
    std::uint8_t* to = rows.data() + row_bytes * y;
    *to++ = PNG_FILTER_VALUE_SUB;
    std::array<std::uint8_t, kComponents> west{};
    for (int x = 0; x < pixels.width; ++x, from += 4) {
      for (int c = 0; c < kComponents; ++c) {
        const std::uint8_t here = from[kComponents - 1 - c];
        *to++ = static_cast<std::uint8_t>(here - west[c]);
        west[c] = here;
      }
    }
  }
  return rows;
}

std::vector<std::uint8_t> compressed(const std::vector<std::uint8_t>& rows) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kCompression), &libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::vector<std::uint8_t> packed(libdeflate_zlib_compress_bound(compressor.get(), rows.size()));
  packed.resize(libdeflate_zlib_compress(compressor.get(), rows.data(), rows.size(), packed.data(),
                                         packed.size()));
  return packed;
}

/// Width and height, 8 bits, true colour, the one compression and filter method, no interlacing.
std::array<std::uint8_t, 13> header_of(const PixelView& pixels) {
  std::array<std::uint8_t, 13> header{};
  png_save_uint_32(header.data(), static_cast<png_uint_32>(pixels.width));
  png_save_uint_32(header.data() + 4, static_cast<png_uint_32>(pixels.height));
  header[8] = 8;
  header[9] = PNG_COLOR_TYPE_RGB;
  return header;
}

void write_chunk(png_structp png, const char* name, std::span<const std::uint8_t> data) {
  png_write_chunk(png, reinterpret_cast<png_const_bytep>(name), data.data(), data.size());
}

// Kept free of objects with destructors, for libpng leaves it with longjmp on errors.
bool write_chunks(std::FILE* stream, std::span<const std::uint8_t> header,
                  std::span<const std::uint8_t> image) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  if (png == nullptr) return false;
  if (setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, nullptr);
    return false;
  }
  png_init_io(png, stream);
  png_write_sig(png);
  write_chunk(png, "IHDR", header);
  write_chunk(png, "IDAT", image);
  write_chunk(png, "IEND", {});
  png_destroy_write_struct(&png, nullptr);
  return true;
}

}  // namespace

void write_png(const std::filesystem::path& path, const PixelView& pixels) {
  const auto header = header_of(pixels);
  const auto image = compressed(filtered(pixels));
  AtomicFile file(path);
  std::FILE* stream = std::fopen(file.temporary().c_str(), "wb");
  if (stream == nullptr) file.fail("cannot open");
  const bool written = write_chunks(stream, header, image);
  if (std::fclose(stream) != 0 || !written) file.fail("the PNG library refused");
  file.commit();
}

}  // namespace geo::io
