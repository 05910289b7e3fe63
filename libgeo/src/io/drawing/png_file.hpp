#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace geo::io {

/// Pixels as Cairo's RGB24 has them: 32 bits each, 0x00RRGGBB in the machine's byte order.
struct PixelView {
  const std::uint8_t* data;
  int width, height, stride_bytes;
};

/// Writes a whole PNG file, 8 bits per component, without a time stamp. Throws IoError.
void write_png(const std::filesystem::path& path, const PixelView& pixels);

/// The same of grey samples, 16 or 8 bits each, row by row from the top.
void write_grey_png(const std::filesystem::path& path, std::span<const std::uint16_t> samples,
                    int width, int height);
void write_grey_png(const std::filesystem::path& path, std::span<const std::uint8_t> samples,
                    int width, int height);

}  // namespace geo::io
