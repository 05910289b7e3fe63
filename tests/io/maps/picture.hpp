#pragma once

#include <png.h>

#include <compare>
#include <cstdint>
#include <filesystem>
#include <set>
#include <vector>

#include "geo/io/maps/maps.hpp"

namespace geo::io {

struct Colour {
  int r, g, b;
  auto operator<=>(const Colour&) const = default;
};
inline constexpr Colour kPaper{255, 255, 255};

/// A picture read back; `map` counts pixels from the map's upper left corner.
class Picture {
 public:
  Picture(const std::filesystem::path& path, const MapLayout& layout) : layout_(layout) {
    image_.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&image_, path.c_str()) == 0) return;
    image_.format = PNG_FORMAT_RGB;
    bytes_.resize(PNG_IMAGE_SIZE(image_));
    png_image_finish_read(&image_, nullptr, bytes_.data(), 0, nullptr);
  }
  [[nodiscard]] int width() const { return static_cast<int>(image_.width); }
  [[nodiscard]] int height() const { return static_cast<int>(image_.height); }
  [[nodiscard]] Colour at(int x, int y) const {
    const auto* p = &bytes_[3 * (static_cast<std::size_t>(y) * image_.width + x)];
    return {p[0], p[1], p[2]};
  }
  [[nodiscard]] Colour map(int x, int y) const {
    return at(layout_.map_left + x, layout_.map_top + y);
  }
  [[nodiscard]] std::set<Colour> map_colours() const {
    std::set<Colour> colours;
    for (int y = 0; y < layout_.map_height; ++y) {
      for (int x = 0; x < layout_.map_width; ++x) colours.insert(map(x, y));
    }
    return colours;
  }

 private:
  MapLayout layout_;
  png_image image_{};
  std::vector<std::uint8_t> bytes_;
};

}  // namespace geo::io
