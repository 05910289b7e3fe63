#include "map_outlines.hpp"

#include <array>
#include <cmath>
#include <cstdint>

namespace geo::io {
namespace {

// The four ways from a corner of pixels: right, down, left, up.
constexpr std::array kStepX{1, 0, -1, 0}, kStepY{0, 1, 0, -1};

// Beyond the edge of a map, where values are NaN, nothing has an outline.
bool differ(float a, float b) { return a != b && a == a && b == b; }

/// The corners of all pixels, and along which of the sides between them values differ.
class Corners {
 public:
  explicit Corners(const Raster& areas)
      : width_(areas.width + 1),
        height_(areas.height + 1),
        ways_(static_cast<std::size_t>(width_) * height_, 0) {
    for (int y = 0; y < areas.height; ++y) {
      for (int x = 0; x < areas.width; ++x) {
        const float own = areas.at(x, y);
        if (x + 1 < areas.width && differ(areas.at(x + 1, y), own)) join(x + 1, y, 1);
        if (y + 1 < areas.height && differ(areas.at(x, y + 1), own)) join(x, y + 1, 0);
      }
    }
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (degree(x, y) != 2) at(x, y) |= kJunction;
      }
    }
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int degree(int x, int y) const {
    int ways = 0;
    for (int k = 0; k < 4; ++k) ways += is_open(x, y, k) ? 1 : 0;
    return ways;
  }
  [[nodiscard]] bool is_junction(int x, int y) const { return (at(x, y) & kJunction) != 0; }
  [[nodiscard]] bool is_open(int x, int y, int k) const { return (at(x, y) >> k & 1) != 0; }

  /// Goes from a corner along way k until the next junction or back to the start, and closes what
  /// it went along.
  Outline follow(int x, int y, int k) {
    Outline line{{double(x), double(y)}};
    const int start_x = x, start_y = y;
    for (;;) {
      at(x, y) &= ~(1 << k);
      x += kStepX[k];
      y += kStepY[k];
      at(x, y) &= ~(1 << (k + 2) % 4);
      line.push_back({double(x), double(y)});
      if (is_junction(x, y) || (x == start_x && y == start_y)) return line;
      k = 0;
      while (!is_open(x, y, k)) ++k;
    }
  }

 private:
  static constexpr std::uint8_t kJunction = 16;  // stays when its sides have been followed

  void join(int x, int y, int k) {
    at(x, y) |= 1 << k;
    at(x + kStepX[k], y + kStepY[k]) |= 1 << (k + 2) % 4;
  }
  [[nodiscard]] std::uint8_t at(int x, int y) const {
    return ways_[static_cast<std::size_t>(y) * width_ + x];
  }
  std::uint8_t& at(int x, int y) { return ways_[static_cast<std::size_t>(y) * width_ + x]; }

  int width_, height_;
  std::vector<std::uint8_t> ways_;
};

void smooth(Outline& line, double smoothing_px) {
  const bool closed =
      line.size() > 3 && line.front().x == line.back().x && line.front().y == line.back().y;
  const auto n = line.size();
  // Each pass spreads a point by half a step on either side.
  const int passes = static_cast<int>(std::ceil(2.0 * smoothing_px * smoothing_px));
  for (int pass = 0; pass < passes; ++pass) {
    const Outline before = line;
    for (std::size_t i = 0; i < n; ++i) {
      const bool end = i == 0 || i + 1 == n;
      if (end && !closed) continue;
      const auto& a = before[i == 0 ? n - 2 : i - 1];
      const auto& b = before[i + 1 == n ? 1 : i + 1];
      line[i] = {0.25 * a.x + 0.5 * before[i].x + 0.25 * b.x,
                 0.25 * a.y + 0.5 * before[i].y + 0.25 * b.y};
    }
  }
}

}  // namespace

std::vector<Outline> trace_outlines(const Raster& areas, double smoothing_px) {
  Corners corners(areas);
  std::vector<Outline> lines;
  const auto follow_all = [&](bool from_junctions) {
    std::vector<std::array<int, 2>> starts;
    for (int y = 0; y < corners.height(); ++y) {
      for (int x = 0; x < corners.width(); ++x) {
        if (corners.degree(x, y) > 0 && (corners.is_junction(x, y) || !from_junctions)) {
          starts.push_back({x, y});
        }
      }
    }
    for (const auto& [x, y] : starts) {
      for (int k = 0; k < 4; ++k) {
        if (corners.is_open(x, y, k)) lines.push_back(corners.follow(x, y, k));
      }
    }
  };
  follow_all(true);
  follow_all(false);  // what is left is closed
  for (Outline& line : lines) smooth(line, smoothing_px);
  return lines;
}

}  // namespace geo::io
