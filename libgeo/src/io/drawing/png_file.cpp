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

#include "geo/io/files/atomic_file.hpp"

namespace geo::io {
namespace {

static_assert(std::endian::native == std::endian::little, "Cairo's pixels are read as B G R X");

// Compressing is a good part of drawing: higher levels take twice the time for a few per cent.
constexpr int kCompression = 1;
constexpr int kComponents = 3;

/// Bytes that nothing sets before they are written.
struct Bytes {
  explicit Bytes(std::size_t most)
      : data(std::make_unique_for_overwrite<std::uint8_t[]>(most)), size(most) {}
  std::unique_ptr<std::uint8_t[]> data;
  std::size_t size;
};

/// Rows of R G B behind their filter type: 1, each byte less that of the pixel to the west.
Bytes filtered(const PixelView& pixels) {
  const std::size_t row_bytes = 1 + static_cast<std::size_t>(pixels.width) * kComponents;
  Bytes rows(row_bytes * pixels.height);
  for (int y = 0; y < pixels.height; ++y) {
    const std::uint8_t* from = pixels.data + static_cast<std::ptrdiff_t>(y) * pixels.stride_bytes;
    std::uint8_t* to = rows.data.get() + row_bytes * y;
    *to++ = PNG_FILTER_VALUE_SUB;
    std::uint8_t west[kComponents] = {0, 0, 0};
    for (int x = 0; x < pixels.width; ++x, from += 4, to += kComponents) {
      const std::uint8_t red = from[2], green = from[1], blue = from[0];
      to[0] = static_cast<std::uint8_t>(red - west[0]);
      to[1] = static_cast<std::uint8_t>(green - west[1]);
      to[2] = static_cast<std::uint8_t>(blue - west[2]);
      west[0] = red;
      west[1] = green;
      west[2] = blue;
    }
  }
  return rows;
}

Bytes compressed(const Bytes& rows) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kCompression), &libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  Bytes packed(libdeflate_zlib_compress_bound(compressor.get(), rows.size));
  packed.size = libdeflate_zlib_compress(compressor.get(), rows.data.get(), rows.size,
                                         packed.data.get(), packed.size);
  return packed;
}

/// Rows of grey samples, most significant byte first, filtered in the same way.
template <class T>
Bytes filtered(std::span<const T> samples, int width, int height) {
  const std::size_t row_bytes = 1 + static_cast<std::size_t>(width) * sizeof(T);
  Bytes rows(row_bytes * height);
#pragma omp parallel for schedule(static)
  for (int y = 0; y < height; ++y) {
    const T* from = samples.data() + static_cast<std::size_t>(y) * width;
    std::uint8_t* to = rows.data.get() + row_bytes * y;
    *to++ = PNG_FILTER_VALUE_SUB;
    T west = 0;
    for (int x = 0; x < width; ++x) {
      const T here = from[x];
      if constexpr (sizeof(T) == 2) {
        *to++ = static_cast<std::uint8_t>((here >> 8U) - (west >> 8U));
      }
      *to++ = static_cast<std::uint8_t>(here - west);
      west = here;
    }
  }
  return rows;
}

/// Width and height, bits of a component, what they are, the one compression and filter method, no
/// interlacing.
std::array<std::uint8_t, 13> header_of(int width, int height, int bits, int colour_type) {
  std::array<std::uint8_t, 13> header{};
  png_save_uint_32(header.data(), static_cast<png_uint_32>(width));
  png_save_uint_32(header.data() + 4, static_cast<png_uint_32>(height));
  header[8] = static_cast<std::uint8_t>(bits);
  header[9] = static_cast<std::uint8_t>(colour_type);
  return header;
}

void write_chunk(png_structp png, const char* name, std::span<const std::uint8_t> data) {
  png_write_chunk(png, reinterpret_cast<png_const_bytep>(name), data.data(), data.size());
}

/// What libpng does not like ends in setjmp, without the line that it would print itself.
[[noreturn]] void give_up(png_structp png, png_const_charp /*message*/) { png_longjmp(png, 1); }
void ignore(png_structp /*png*/, png_const_charp /*message*/) {}

// Kept free of objects with destructors, for libpng leaves it with longjmp on errors.
bool write_chunks(std::FILE* stream, std::span<const std::uint8_t> header,
                  std::span<const std::uint8_t> image) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, give_up, ignore);
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

void write_whole(const std::filesystem::path& path, std::span<const std::uint8_t> header,
                 const Bytes& image) {
  AtomicFile file(path);
  std::FILE* stream = std::fopen(file.temporary().c_str(), "wb");
  if (stream == nullptr) file.fail("cannot open");
  const bool written = write_chunks(stream, header, {image.data.get(), image.size});
  if (std::fclose(stream) != 0 || !written) file.fail("the PNG library refused");
  file.commit();
}

}  // namespace

void write_png(const std::filesystem::path& path, const PixelView& pixels) {
  write_whole(path, header_of(pixels.width, pixels.height, 8, PNG_COLOR_TYPE_RGB),
              compressed(filtered(pixels)));
}

void write_grey_png(const std::filesystem::path& path, std::span<const std::uint16_t> samples,
                    int width, int height) {
  write_whole(path, header_of(width, height, 16, PNG_COLOR_TYPE_GRAY),
              compressed(filtered(samples, width, height)));
}

void write_grey_png(const std::filesystem::path& path, std::span<const std::uint8_t> samples,
                    int width, int height) {
  write_whole(path, header_of(width, height, 8, PNG_COLOR_TYPE_GRAY),
              compressed(filtered(samples, width, height)));
}

}  // namespace geo::io
