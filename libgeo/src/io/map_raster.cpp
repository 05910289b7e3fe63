#include "map_raster.hpp"

#include <array>
#include <numeric>

namespace geo::io {
namespace {

void add_tap(Taps& taps, int index, int cells, bool wraps, double weight) {
  if (weight <= 0.0) return;
  taps.index.push_back(wraps ? (index % cells + cells) % cells : std::clamp(index, 0, cells - 1));
  taps.weight.push_back(static_cast<float>(weight));
}

Taps axis_taps(int cells, int pixels, bool wraps, bool reversed, Filter filter) {
  Taps taps;
  const double ratio = double(cells) / pixels;
  for (int p = 0; p < pixels; ++p) {
    taps.begin.push_back(static_cast<int>(taps.index.size()));
    const int pixel = reversed ? pixels - 1 - p : p;
    if (ratio >= 1.0) {
      const double low = pixel * ratio, high = low + ratio;
      for (int i = static_cast<int>(low); i < high && i < cells; ++i) {
        add_tap(taps, i, cells, wraps,
                (std::min(high, i + 1.0) - std::max(low, double(i))) / ratio);
      }
      continue;
    }
    const double centre = (pixel + 0.5) * ratio - 0.5;
    const int i = static_cast<int>(std::floor(centre));
    const double t = centre - i, u = 1.0 - t;
    if (filter == Filter::linear) {
      add_tap(taps, i, cells, wraps, u);
      add_tap(taps, i + 1, cells, wraps, t);
    } else {
      add_tap(taps, i - 1, cells, wraps, u * u * u / 6.0);
      add_tap(taps, i, cells, wraps, 2.0 / 3.0 - t * t * (2.0 - t) / 2.0);
      add_tap(taps, i + 1, cells, wraps, 2.0 / 3.0 - u * u * (2.0 - u) / 2.0);
      add_tap(taps, i + 2, cells, wraps, t * t * t / 6.0);
    }
  }
  taps.begin.push_back(static_cast<int>(taps.index.size()));
  return taps;
}

// Running mean of half-width `radius` along a line of `n` values `stride` apart.
void box_line(float* line, int n, std::size_t stride, int radius, bool wraps,
              std::vector<double>& sums) {
  sums.assign(n + 2 * radius + 1, 0.0);
  for (int i = 0; i < n + 2 * radius; ++i) {
    const int at = i - radius;
    const int from = wraps ? (at % n + n) % n : std::clamp(at, 0, n - 1);
    sums[i + 1] = sums[i] + line[from * stride];
  }
  for (int i = 0; i < n; ++i) {
    line[i * stride] = static_cast<float>((sums[i + 2 * radius + 1] - sums[i]) / (2 * radius + 1));
  }
}

}  // namespace

Raster::Raster(const MapFrame& frame, float value)
    : width(frame.width()),
      height(frame.height()),
      wraps_east(frame.wraps_east()),
      values(static_cast<std::size_t>(width) * height, value) {}

MapFrame::MapFrame(const Grid& grid, int width_px, int height_px)
    : grid_(&grid), width_(width_px), height_(height_px) {}

int MapFrame::row_under(int y) const {
  return std::clamp(static_cast<int>((height_ - y - 0.5) / pixels_per_row()), 0, grid_->ny() - 1);
}

double MapFrame::pixel_east_m(int y) const {
  return grid_->spacing_east_m(row_under(y)) / pixels_per_column();
}

double MapFrame::pixel_north_m(int y) const {
  return grid_->spacing_north_m(row_under(y)) / pixels_per_row();
}

Taps MapFrame::column_taps(Filter filter) const {
  return axis_taps(grid_->nx(), width_, wraps_east(), false, filter);
}

Taps MapFrame::row_taps(Filter filter) const {
  return axis_taps(grid_->ny(), height_, grid_->topology() == Topology::torus, true, filter);
}

Raster sample_majority(const MapFrame& frame, std::span<const std::int8_t> categories) {
  const auto columns = frame.column_taps(Filter::linear), rows = frame.row_taps(Filter::linear);
  Raster out(frame);
#pragma omp parallel for schedule(static)
  for (int y = 0; y < frame.height(); ++y) {
    std::array<float, 256> share{};
    for (int x = 0; x < frame.width(); ++x) {
      int low = 255, high = 0;
      for (int j = rows.begin[y]; j < rows.begin[y + 1]; ++j) {
        const Index base = rows.index[j] * frame.grid().nx();
        for (int i = columns.begin[x]; i < columns.begin[x + 1]; ++i) {
          const int category = categories[base + columns.index[i]] + 128;
          share[category] += rows.weight[j] * columns.weight[i];
          low = std::min(low, category);
          high = std::max(high, category);
        }
      }
      const auto first = share.begin() + low, last = share.begin() + high + 1;
      out.at(x, y) = static_cast<float>(std::max_element(first, last) - share.begin() - 128);
      std::fill(first, last, 0.0F);
    }
  }
  return out;
}

Raster blur(const MapFrame& frame, const Raster& raster, double radius_px) {
  Raster out = raster;
  const double ground_m = radius_px * frame.pixel_north_m(raster.height / 2);
  for (int pass = 0; pass < 3; ++pass) {
#pragma omp parallel
    {
      std::vector<double> sums;
#pragma omp for schedule(static)
      for (int y = 0; y < out.height; ++y) {
        const int radius =
            static_cast<int>(std::min(std::lround(ground_m / std::max(frame.pixel_east_m(y), 1e-3)),
                                      static_cast<long>(out.width / 8)));
        box_line(&out.at(0, y), out.width, 1, radius, frame.wraps_east(), sums);
      }
#pragma omp for schedule(static)
      for (int x = 0; x < out.width; ++x) {
        box_line(&out.at(x, 0), out.height, out.width, static_cast<int>(std::lround(radius_px)),
                 frame.grid().topology() == Topology::torus, sums);
      }
    }
  }
  return out;
}

float change_per_pixel(const Raster& raster, int x, int y) {
  const int west = raster.west_of(x), east = raster.east_of(x);
  const int above = std::max(y - 1, 0), below = std::min(y + 1, raster.height - 1);
  const float columns = west == x || east == x ? 1.0F : 2.0F;
  const float across = std::abs(raster.at(east, y) - raster.at(west, y)) / columns;
  const float down = std::abs(raster.at(x, below) - raster.at(x, above)) /
                     static_cast<float>(std::max(below - above, 1));
  const float change = std::max(across, down);
  return change == change ? change : 0.0F;
}

}  // namespace geo::io
