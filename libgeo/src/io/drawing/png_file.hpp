#pragma once

#include <cstdint>
#include <filesystem>

namespace geo::io {

/// Pixels as Cairo's RGB24 has them: 32 bits each, 0x00RRGGBB in the machine's byte order.
struct PixelView {
  const std::uint8_t* data;
  int width, height, stride_bytes;
};

/// Writes a whole PNG file, 8 bits per component, without a time stamp. Throws IoError.
void write_png(const std::filesystem::path& path, const PixelView& pixels);

}  // namespace geo::io
