#include "map_raster.hpp"

#include <array>
#include <numbers>
#include <numeric>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/core/place.hpp"
#include "geo/core/vector3.hpp"

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

// Running means of half-width `radius` along lines of `n` values `stride` apart, of as many lines
// side by side.
template <int lines>
void box_lines(float* first, int n, std::size_t stride, int radius, bool wraps,
               std::vector<double>& sums) {
  sums.resize(static_cast<std::size_t>(n + 2 * radius + 1) * lines);
  std::fill_n(sums.begin(), lines, 0.0);
  for (int i = 0; i < n + 2 * radius; ++i) {
    const int at = i - radius;
    const int from = wraps ? (at % n + n) % n : std::clamp(at, 0, n - 1);
    const float* const value = first + from * stride;
    const double* const before = &sums[static_cast<std::size_t>(i) * lines];
    double* const after = &sums[static_cast<std::size_t>(i + 1) * lines];
    for (int k = 0; k < lines; ++k) after[k] = before[k] + value[k];
  }
  const double share = 1.0 / (2 * radius + 1);
  for (int i = 0; i < n; ++i) {
    const double* const low = &sums[static_cast<std::size_t>(i) * lines];
    const double* const high = &sums[static_cast<std::size_t>(i + 2 * radius + 1) * lines];
    float* const mean = first + i * stride;
    for (int k = 0; k < lines; ++k) mean[k] = static_cast<float>((high[k] - low[k]) * share);
  }
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

namespace {

// Means along rows near the poles, where cells are narrower than high, over as many as one is high.
void widen_rows(const MapFrame& source, Sampled& sampled) {
  const int width = sampled.mean.width;
  const auto widen = [&](int y) {
    const double cells = source.pixel_north_m(y) / std::max(source.pixel_east_m(y), 1e-3);
    const int reach = std::min(static_cast<int>(std::lround(0.5 * (cells - 1.0))), width / 2 - 1);
    if (reach < 1) return;
    std::vector<double> sums(width + 2 * reach + 1, 0.0), covers(sums.size(), 0.0);
    for (int i = 0; i < width + 2 * reach; ++i) {
      const int x =
          source.wraps_east() ? (i - reach + width) % width : std::clamp(i - reach, 0, width - 1);
      const float cover = sampled.cover.at(x, y);
      sums[i + 1] = sums[i] + (cover > 0.0F ? cover * sampled.mean.at(x, y) : 0.0F);
      covers[i + 1] = covers[i] + cover;
    }
    for (int x = 0; x < width; ++x) {
      const double cover = covers[x + 2 * reach + 1] - covers[x];
      const double sum = sums[x + 2 * reach + 1] - sums[x];
      sampled.cover.at(x, y) = static_cast<float>(cover / (2 * reach + 1));
      sampled.mean.at(x, y) =
          cover > 1e-9 ? static_cast<float>(sum / cover) : std::numeric_limits<float>::quiet_NaN();
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 8)
  for (int y = 0; y < sampled.mean.height; ++y) errors.guard([&] { widen(y); });
  errors.rethrow();
}

// Weights of four neighbours, the second and third of them around the point.
std::array<float, 4> weights(Filter filter, float t) {
  const float u = 1.0F - t;
  if (filter == Filter::linear) return {0.0F, u, t, 0.0F};
  return {u * u * u / 6.0F, 2.0F / 3.0F - t * t * (2.0F - t) / 2.0F,
          2.0F / 3.0F - u * u * (2.0F - u) / 2.0F, t * t * t / 6.0F};
}

}  // namespace

Sampled MapFrame::project(Sampled sampled, Filter filter) const {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const bool round = grid().topology() == Topology::sphere;
  widen_rows(*source_, sampled);
  const int columns = sampled.mean.width, rows = sampled.mean.height;
  Sampled out{Raster(*this, kNaN), Raster(*this, kNaN)};
#pragma omp parallel for schedule(dynamic, 8)
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (!shows(x, y)) continue;
      const PagePoint point = source_point(at(x, y));
      const int i = static_cast<int>(std::floor(point.x)),
                j = static_cast<int>(std::floor(point.y));
      const auto across = weights(filter, static_cast<float>(point.x - i));
      const auto down = weights(filter, static_cast<float>(point.y - j));
      float sum = 0.0F, there = 0.0F;
      for (int b = 0; b < 4; ++b) {
        if (down[b] == 0.0F) continue;
        int row = j - 1 + b, turned = 0;
        if (round && (row < 0 || row >= rows)) {  // over the pole
          row = row < 0 ? -1 - row : 2 * rows - 1 - row;
          turned = columns / 2;
        }
        row = std::clamp(row, 0, rows - 1);
        for (int a = 0; a < 4; ++a) {
          if (across[a] == 0.0F) continue;
          const int asked = i - 1 + a + turned;
          const int column =
              round ? (asked % columns + columns) % columns : std::clamp(asked, 0, columns - 1);
          const float cover = sampled.cover.at(column, row);
          if (!(cover > 0.0F)) continue;
          const float weight = across[a] * down[b] * cover;
          sum += weight * sampled.mean.at(column, row);
          there += weight;
        }
      }
      out.cover.at(x, y) = there;
      if (there > 0.0F) out.mean.at(x, y) = sum / there;
    }
  }
  return out;
}

Raster MapFrame::project_nearest(const Raster& source) const {
  Raster out(*this, std::numeric_limits<float>::quiet_NaN());
#pragma omp parallel for schedule(dynamic, 8)
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (!shows(x, y)) continue;
      const PagePoint point = source_point(at(x, y));
      out.at(x, y) =
          source.at(std::clamp(static_cast<int>(std::lround(point.x)), 0, source.width - 1),
                    std::clamp(static_cast<int>(std::lround(point.y)), 0, source.height - 1));
    }
  }
  return out;
}

Taps MapFrame::column_taps(Filter filter) const {
  return axis_taps(grid().nx(), width_, grid().topology() != Topology::plane, false, filter);
}

Taps MapFrame::row_taps(Filter filter) const {
  return axis_taps(grid().ny(), height_, grid().topology() == Topology::torus, true, filter);
}

namespace {

constexpr std::int16_t kSeveral = 1000;  // no category

/// The category under pixels that see no other.
class CategoryRows {
 public:
  CategoryRows(const Taps& columns, std::span<const std::int8_t> categories, int nx, int width)
      : columns_(columns), categories_(categories), nx_(nx), width_(width) {}

  /// Of the pixels of row y: their category, kSeveral where they see more than one.
  void over(const Taps& rows, int y, std::vector<std::int16_t>& only) {
    for (int j = rows.begin[y]; j < rows.begin[y + 1]; ++j) {
      const std::int16_t* const here = along(rows.index[j]).data();
      if (j == rows.begin[y]) {
        std::copy_n(here, width_, only.begin());
        continue;
      }
      for (int x = 0; x < width_; ++x) only[x] = only[x] == here[x] ? here[x] : kSeveral;
    }
  }

 private:
  // Along a row of the grid; neighbouring rows of pixels may share one.
  const std::vector<std::int16_t>& along(int row) {
    if (row == last_row_) return last_;
    last_row_ = row;
    last_.resize(width_);
    const std::int8_t* const cells = &categories_[static_cast<Index>(row) * nx_];
    for (int x = 0; x < width_; ++x) {
      std::int16_t category = cells[columns_.index[columns_.begin[x]]];
      for (int i = columns_.begin[x] + 1; i < columns_.begin[x + 1]; ++i) {
        if (cells[columns_.index[i]] != category) category = kSeveral;
      }
      last_[x] = category;
    }
    return last_;
  }

  const Taps& columns_;
  std::span<const std::int8_t> categories_;
  int nx_, width_;
  int last_row_ = -1;
  std::vector<std::int16_t> last_;
};

}  // namespace

Raster sample_majority(const MapFrame& frame, std::span<const std::int8_t> categories) {
  if (!frame.is_aligned()) {
    return frame.project_nearest(sample_majority(frame.source(), categories));
  }
  const auto columns = frame.column_taps(Filter::linear), rows = frame.row_taps(Filter::linear);
  const int nx = frame.grid().nx(), width = frame.width();
  Raster out(frame);
  ParallelErrors errors;
#pragma omp parallel
  {
    CategoryRows alone(columns, categories, nx, width);
    auto only = errors.make<std::vector<std::int16_t>>(width);
    std::array<float, 256> share{};
#pragma omp for schedule(static)
    for (int y = 0; y < frame.height(); ++y) {
      if (errors.any()) continue;
      errors.guard([&] { alone.over(rows, y, only); });
      for (int x = 0; x < width; ++x) {
        if (only[x] != kSeveral) {
          out.at(x, y) = only[x];
          continue;
        }
        int low = 255, high = 0;
        for (int j = rows.begin[y]; j < rows.begin[y + 1]; ++j) {
          const std::int8_t* const row = &categories[static_cast<Index>(rows.index[j]) * nx];
          for (int i = columns.begin[x]; i < columns.begin[x + 1]; ++i) {
            const int category = row[columns.index[i]] + 128;
            low = std::min(low, category);
            high = std::max(high, category);
            share[category] += rows.weight[j] * columns.weight[i];
          }
        }
        const auto first = share.begin() + low, last = share.begin() + high + 1;
        out.at(x, y) = static_cast<float>(std::max_element(first, last) - share.begin() - 128);
        std::fill(first, last, 0.0F);
      }
    }
  }
  errors.rethrow();
  return out;
}

namespace {

// Half-widths of the running mean of each row of pixels, and of the columns.
struct BlurReach {
  std::vector<int> rows;
  int columns;
};

void blur_thrice(const MapFrame& frame, Raster& raster, const BlurReach& reach) {
  const bool wraps_north = frame.is_aligned() && frame.grid().topology() == Topology::torus;
  ParallelErrors errors;
  for (int pass = 0; pass < 3; ++pass) {
#pragma omp parallel
    {
      std::vector<double> sums;
#pragma omp for schedule(static)
      for (int y = 0; y < raster.height; ++y) {
        errors.guard([&] {
          box_lines<1>(&raster.at(0, y), raster.width, 1, reach.rows[y], frame.wraps_east(), sums);
        });
      }
      constexpr int kBundle = 16;
      const int bundles = raster.width / kBundle;
#pragma omp for schedule(static)
      for (int i = 0; i < bundles; ++i) {
        errors.guard([&] {
          box_lines<kBundle>(&raster.at(kBundle * i, 0), raster.height, raster.width, reach.columns,
                             wraps_north, sums);
        });
      }
#pragma omp for schedule(static)
      for (int x = kBundle * bundles; x < raster.width; ++x) {
        errors.guard([&] {
          box_lines<1>(&raster.at(x, 0), raster.height, raster.width, reach.columns, wraps_north,
                       sums);
        });
      }
    }
  }
  errors.rethrow();
}

}  // namespace

Raster blur(const MapFrame& frame, const Raster& raster, double radius_px) {
  Raster out = raster;
  BlurReach reach{std::vector<int>(raster.height), static_cast<int>(std::lround(radius_px))};
  if (frame.is_aligned()) {
    const double ground_m = radius_px * frame.pixel_north_m(raster.height / 2);
    for (int y = 0; y < raster.height; ++y) {
      reach.rows[y] =
          static_cast<int>(std::min(std::lround(ground_m / std::max(frame.pixel_east_m(y), 1e-3)),
                                    static_cast<long>(out.width / 8)));
    }
    blur_thrice(frame, out, reach);
    return out;
  }
  std::fill(reach.rows.begin(), reach.rows.end(), reach.columns);
  Raster there(frame, 1.0F);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    if (out.values[i] == out.values[i]) continue;
    out.values[i] = there.values[i] = 0.0F;
  }
  blur_thrice(frame, out, reach);
  blur_thrice(frame, there, reach);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    out.values[i] = raster.values[i] == raster.values[i] ? out.values[i] / there.values[i]
                                                         : std::numeric_limits<float>::quiet_NaN();
  }
  return out;
}

void change_per_pixel(const Raster& raster, int y, std::vector<float>& change) {
  const int width = raster.width, above = std::max(y - 1, 0),
            below = std::min(y + 1, raster.height - 1);
  const float* const here = &raster.values[static_cast<std::size_t>(y) * width];
  const float* const up = &raster.values[static_cast<std::size_t>(above) * width];
  const float* const down = &raster.values[static_cast<std::size_t>(below) * width];
  const float per_row = below - above == 2 ? 0.5F : 1.0F;
  change.resize(width);
  float* const out = change.data();
  const auto larger = [&](int x, int west, int east, float per_column) {
    const float across = std::abs(here[east] - here[west]) * per_column;
    const float along = std::abs(down[x] - up[x]) * per_row;
    const float most = across < along ? along : across;
    out[x] = most == most ? most : 0.0F;
  };
#pragma omp simd
  for (int x = 1; x < width - 1; ++x) larger(x, x - 1, x + 1, 0.5F);
  for (const int x : {0, width - 1}) {
    const int west = raster.west_of(x), east = raster.east_of(x);
    larger(x, west, east, west == x || east == x ? 1.0F : 0.5F);
  }
}

}  // namespace geo::io
