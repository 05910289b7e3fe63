#include "map_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/core/place.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/remapping/cubic_weights.hpp"

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
    const double t = centre - i;
    if (filter == Filter::linear) {
      add_tap(taps, i, cells, wraps, 1.0 - t);
      add_tap(taps, i + 1, cells, wraps, t);
    } else {
      const std::array<double, 4> weights = b_spline_weights(t);
      for (int k = 0; k < 4; ++k) add_tap(taps, i - 1 + k, cells, wraps, weights[k]);
    }
  }
  taps.begin.push_back(static_cast<int>(taps.index.size()));
  return taps;
}

}  // namespace

Raster::Raster(const MapFrame& frame, float value)
    : width(frame.width()),
      height(frame.height()),
      wraps_east(frame.wraps_east()),
      values(static_cast<std::size_t>(width) * height, value) {}

MapFrame::MapFrame(const MapPage& page, int width_px, int height_px)
    : page_(&page),
      width_(width_px),
      height_(height_px),
      columns_px_(double(width_px) / page.grid().nx()),
      rows_px_(double(height_px) / page.grid().ny()),
      pixel_m_(page.grid().spacing_north_m(row_under(height_px / 2)) / rows_px_) {}

MapFrame::MapFrame(const MapPage& page)
    : MapFrame(page, page.layout().map_width, page.layout().map_height) {
  if (page.is_aligned()) return;
  aligned_ = false;
  locate_pixels();
  choose_source();
}

int MapFrame::row_under(int y) const {
  return std::clamp(static_cast<int>((height_ - y - 0.5) / pixels_per_row()), 0, grid().ny() - 1);
}

double MapFrame::pixel_east_m(int y) const {
  return grid().spacing_east_m(row_under(y)) / pixels_per_column();
}

double MapFrame::pixel_north_m(int y) const {
  return grid().spacing_north_m(row_under(y)) / pixels_per_row();
}

void MapFrame::locate_pixels() {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const std::size_t pixels = static_cast<std::size_t>(width_) * height_;
  std::vector<Centre> places(pixels, Centre{kNaN, kNaN});
  ParallelErrors errors;
#pragma omp parallel
  {
    const auto projector = errors.make<MapPage::Projector>(*page_);
#pragma omp for schedule(dynamic, 8)
    for (int y = 0; y < height_; ++y) {
      errors.guard([&] {
        for (int x = 0; x < width_; ++x) {
          if (const auto place = projector->place_of({x + 0.5, y + 0.5})) places[at(x, y)] = *place;
        }
      });
    }
  }
  errors.rethrow();
  latitude_deg_.resize(pixels);
  longitude_deg_.resize(pixels);
  const Window& window = grid().window();
  const bool round = grid().topology() == Topology::sphere;
  for (std::size_t i = 0; i < pixels; ++i) {
    double east = places[i].longitude_deg - window.west_deg;
    if (round || east < 0.0) east -= 360.0 * std::floor(east / 360.0);
    latitude_deg_[i] = static_cast<float>(places[i].latitude_deg - window.south_deg);
    longitude_deg_[i] = static_cast<float>(east);
  }
  measure_ground(places);
}

void MapFrame::measure_ground(const std::vector<Centre>& places) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  const double radius_m = grid().figure().radius_m;
  ground_.resize(places.size());
  const auto is_there = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < width_ && y < height_ && shows(x, y);
  };
  // Metres east and north from one place to the next, at a third.
  const auto step = [&](const Centre& from, const Centre& to, const Centre& here, float& east,
                        float& north, int pixels) {
    const Vector3 a = unit_vector_of(from), b = unit_vector_of(to);
    const double lon = here.longitude_deg * kRadians, lat = here.latitude_deg * kRadians;
    const double dx = b[0] - a[0], dy = b[1] - a[1], dz = b[2] - a[2];
    const double metres = radius_m / pixels;
    east = static_cast<float>(metres * (-std::sin(lon) * dx + std::cos(lon) * dy));
    north = static_cast<float>(
        metres * (std::cos(lat) * dz - std::sin(lat) * (std::cos(lon) * dx + std::sin(lon) * dy)));
  };
#pragma omp parallel for schedule(dynamic, 8)
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (!shows(x, y)) continue;
      PixelGround& ground = ground_[at(x, y)];
      const int left = is_there(x - 1, y) ? x - 1 : x, right = is_there(x + 1, y) ? x + 1 : x;
      const int above = is_there(x, y - 1) ? y - 1 : y, below = is_there(x, y + 1) ? y + 1 : y;
      const Centre& here = places[at(x, y)];
      step(places[at(left, y)], places[at(right, y)], here, ground.across_east, ground.across_north,
           std::max(right - left, 1));
      step(places[at(x, above)], places[at(x, below)], here, ground.down_east, ground.down_north,
           std::max(below - above, 1));
    }
  }
}

void MapFrame::choose_source() {
  std::vector<float> areas;
  for (std::size_t i = 0; i < ground_.size(); i += 13) {
    const PixelGround& g = ground_[i];
    const float area = std::abs(g.across_east * g.down_north - g.across_north * g.down_east);
    if (area > 0.0F) areas.push_back(area);
  }
  if (areas.empty()) throw Bug("a map that shows nothing");
  // Finer than most pixels: what is near the centre of a hemisphere sets the detail.
  const auto fine = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 10);
  std::nth_element(areas.begin(), fine, areas.end());
  pixel_m_ = std::sqrt(*fine);
  const Grid& grid = this->grid();
  const double cell_m = grid.spacing_north_m(grid.ny() / 2);
  rows_px_ = cell_m / pixel_m_;
  const double coarser = std::min(1.0, rows_px_);
  columns_px_ = rows_px_ * grid.ny() / grid.nx() *
                (grid.window().east_deg - grid.window().west_deg) /
                (grid.window().north_deg - grid.window().south_deg);
  const auto cells = [&](int count, double share) {
    return std::clamp(static_cast<int>(std::ceil(count * share)), 1, count);
  };
  source_.reset(new MapFrame(*page_, cells(grid.nx(), std::min(1.0, columns_px_)),
                             cells(grid.ny(), coarser)));
}

MapScale MapFrame::scale() const {
  if (is_aligned()) {
    if (!grid().is_latitude_longitude()) return {pixel_east_m(height_ / 2), 1.0};
    const double middle = pixel_east_m(height_ / 2);
    const double ends[] = {pixel_east_m(0), pixel_east_m(height_ - 1)};
    return {middle, std::max({middle, ends[0], ends[1]}) / std::min({middle, ends[0], ends[1]})};
  }
  std::vector<float> lengths;
  for (std::size_t i = 0; i < ground_.size(); i += 7) {
    const PixelGround& g = ground_[i];
    for (const float length :
         {std::hypot(g.across_east, g.across_north), std::hypot(g.down_east, g.down_north)}) {
      if (length > 0.0F) lengths.push_back(length);
    }
  }
  std::sort(lengths.begin(), lengths.end());
  const auto at = [&](double share) {
    return lengths[static_cast<std::size_t>(share * static_cast<double>(lengths.size() - 1))];
  };
  return {at(0.5), at(0.99) / at(0.01)};
}

PagePoint MapFrame::source_point(std::size_t pixel) const {
  const Window& window = grid().window();
  return {longitude_deg_[pixel] / (window.east_deg - window.west_deg) * source_->width_ - 0.5,
          (1.0 - latitude_deg_[pixel] / (window.north_deg - window.south_deg)) * source_->height_ -
              0.5};
}

Index MapFrame::cell_at(int x, int y) const {
  const Grid& g = grid();
  if (is_aligned()) {
    const int column = static_cast<int>((x + 0.5) / columns_px_);
    return g.cell(std::clamp(column, 0, g.nx() - 1), row_under(y));
  }
  if (!shows(x, y)) return kNoCell;
  const Window& window = g.window();
  const int column =
      static_cast<int>(longitude_deg_[at(x, y)] / (window.east_deg - window.west_deg) * g.nx());
  const int row =
      static_cast<int>(latitude_deg_[at(x, y)] / (window.north_deg - window.south_deg) * g.ny());
  return g.cell(std::clamp(column, 0, g.nx() - 1), std::clamp(row, 0, g.ny() - 1));
}

PagePoint MapFrame::on_page(int x, int y, double east, double north) const {
  if (is_aligned()) return {east, -north};
  const PixelGround& g = ground(x, y);
  const double area = double(g.across_east) * g.down_north - double(g.across_north) * g.down_east;
  if (area == 0.0) return {0.0, 0.0};
  const double right = (east * g.down_north - north * g.down_east) / area;
  const double down = (north * g.across_east - east * g.across_north) / area;
  const double length = std::hypot(right, down);
  if (!(length > 0.0)) return {0.0, 0.0};
  const double scale = std::hypot(east, north) / length;
  return {right * scale, down * scale};
}

Taps MapFrame::column_taps(Filter filter) const {
  return axis_taps(grid().nx(), width_, grid().topology() != Topology::plane, false, filter);
}

Taps MapFrame::row_taps(Filter filter) const {
  return axis_taps(grid().ny(), height_, grid().topology() == Topology::torus, true, filter);
}

}  // namespace geo::io
