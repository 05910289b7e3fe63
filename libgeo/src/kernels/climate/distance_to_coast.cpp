#include "geo/kernels/climate/distance_to_coast.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/parallel_errors.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;

/// Coast points lie on 2 ny + 1 parallels: level 2j is the southern edge of row j (mid-points of
/// faces to the south, at columns), level 2j + 1 its centre line (faces to the east, between
/// columns). Offsets along a parallel count half columns.
template <class Offset>
class CoastLevels {
 public:
  static constexpr Offset kNone = std::numeric_limits<Offset>::max();

  CoastLevels(const Grid& grid, std::span<const float> elevation)
      : grid_(grid),
        levels_(2 * grid.ny() + 1),
        offset_(static_cast<std::size_t>(levels_) * grid.nx()),
        filled_(levels_, 0) {
    ParallelErrors errors;
#pragma omp parallel
    {
      auto coast = errors.make<std::vector<std::uint8_t>>(2 * grid.nx());
#pragma omp for schedule(static)
      for (int level = 0; level < levels_; ++level) {
        if (errors.any()) continue;
        mark(level, elevation, coast);
        measure(level, coast);
      }
    }
    errors.rethrow();
  }

  [[nodiscard]] int levels() const { return levels_; }
  [[nodiscard]] bool filled(int level) const { return filled_[level] != 0; }
  [[nodiscard]] const Offset* row(int level) const {
    return offset_.data() + static_cast<std::size_t>(level) * grid_.nx();
  }

 private:
  /// coast[2i] at the centre of column i, coast[2i + 1] half-way to column i + 1.
  void mark(int level, std::span<const float> elevation, std::vector<std::uint8_t>& coast) {
    const int nx = grid_.nx(), ny = grid_.ny();
    std::fill(coast.begin(), coast.end(), std::uint8_t{0});
    const auto is_land = [&](Index cell) { return elevation[cell] >= 0.0F; };
    const auto mark_faces = [&](int row, int direction, int shift) {
      for (int i = 0; i < nx; ++i) {
        const Index to = grid_.neighbour(i, row, direction);
        if (to == kNoCell) continue;
        coast[2 * i + shift] = is_land(grid_.cell(i, row)) != is_land(to);
      }
    };
    if (level % 2 == 1) {
      mark_faces(level / 2, kEast, 1);
    } else if (level < 2 * ny) {
      mark_faces(level / 2, kSouth, 0);
    } else {
      mark_faces(ny - 1, kNorth, 0);
    }
  }

  void measure(int level, const std::vector<std::uint8_t>& coast) {
    const int nx = grid_.nx(), points = 2 * nx;
    if (std::find(coast.begin(), coast.end(), 1) == coast.end()) return;
    filled_[level] = 1;
    const bool wraps = grid_.topology() != Topology::plane;
    Offset* offset = offset_.data() + static_cast<std::size_t>(level) * nx;
    std::fill_n(offset, nx, kNone);
    const int turns = wraps ? 2 : 1;
    int last = -1;
    const auto shorten = [&](int column, int half_columns) {
      offset[column] =
          static_cast<Offset>(std::min<int>(offset[column], std::min(half_columns, points)));
    };
    for (int start = 0; start < turns * points; start += points) {
      for (int i = 0; i < nx; ++i) {
        if (coast[2 * i] != 0) last = start + 2 * i;
        if (last >= 0) shorten(i, start + 2 * i - last);
        if (coast[2 * i + 1] != 0) last = start + 2 * i + 1;
      }
    }
    last = -1;
    for (int start = (turns - 1) * points; start >= 0; start -= points) {
      for (int i = nx - 1; i >= 0; --i) {
        if (coast[2 * i + 1] != 0) last = start + 2 * i + 1;
        if (coast[2 * i] != 0) last = start + 2 * i;
        if (last >= 0) shorten(i, last - start - 2 * i);
      }
    }
  }

  const Grid& grid_;
  int levels_;
  std::vector<Offset> offset_;
  std::vector<std::uint8_t> filled_;
};

struct Point {
  double a, b;
};

/// Upper hull of points pushed with ascending a; queried with directions that turn from -a to +a.
class Hull {
 public:
  explicit Hull(std::size_t most) : points_(most) {}
  void clear() { count_ = 0, at_ = 0; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  void push(Point p) {
    while (count_ >= 2) {
      const Point& q = points_[count_ - 1];
      const Point& o = points_[count_ - 2];
      if ((q.a - o.a) * (p.b - o.b) - (q.b - o.b) * (p.a - o.a) < 0.0) break;
      --count_;
    }
    points_[count_++] = p;
  }
  /// Greatest direction_a * a + direction_b * b.
  double best(double direction_a, double direction_b) {
    double value = direction_a * points_[at_].a + direction_b * points_[at_].b;
    while (at_ + 1 < count_) {
      const double next = direction_a * points_[at_ + 1].a + direction_b * points_[at_ + 1].b;
      if (next < value) break;
      value = next;
      ++at_;
    }
    return value;
  }

 private:
  std::vector<Point> points_;
  std::size_t count_ = 0, at_ = 0;
};

/// Great circles: cos(angle) = sin(lat) sin(lat') + cos(lat) [cos(lat') cos(dlon)].
class SphereMetric {
 public:
  explicit SphereMetric(const Grid& grid) : radius_m_(grid.figure().radius_m) {
    const Window& w = grid.window();
    const int ny = grid.ny(), nx = grid.nx();
    const double middle = 0.5 * (w.north_deg + w.south_deg);
    const double step = (w.north_deg - w.south_deg) / ny;
    for (int level = 0; level <= 2 * ny; ++level) {
      const double latitude = (middle + (0.5 * level - 0.5 * ny) * step) * kRadians;
      sine_.push_back(std::sin(latitude));
      cosine_.push_back(std::max(0.0, std::cos(latitude)));
    }
    const double half_column = 0.5 * (w.east_deg - w.west_deg) / nx * kRadians;
    for (int k = 0; k <= 2 * nx; ++k) turn_.push_back(std::cos(std::min(kPi, k * half_column)));
  }
  [[nodiscard]] int copies() const { return 1; }
  [[nodiscard]] Point point(int level, int /*copy*/, int offset) const {
    return {sine_[level], cosine_[level] * turn_[offset]};
  }
  double distance_m(Hull& hull, int row) const {
    const double cosine = hull.best(sine_[2 * row + 1], cosine_[2 * row + 1]);
    return 2.0 * radius_m_ * std::asin(std::sqrt(std::clamp(0.5 * (1.0 - cosine), 0.0, 1.0)));
  }
  [[nodiscard]] double farthest_m() const { return kPi * radius_m_; }

 private:
  double radius_m_;
  std::vector<double> sine_, cosine_, turn_;
};

/// Straight lines: distance^2 = y^2 - (2 y y' - y'^2 - dx^2). A torus has three copies of itself.
class FlatMetric {
 public:
  explicit FlatMetric(const Grid& grid)
      : half_dx_m_(0.5 * grid.spacing_east_m(0)),
        half_dy_m_(0.5 * grid.face_east_m(0)),
        height_m_(2.0 * half_dy_m_ * grid.ny()),
        farthest_m_(2.0 * half_dx_m_ * grid.nx() + height_m_),
        copies_(grid.topology() == Topology::torus ? 3 : 1) {}
  [[nodiscard]] int copies() const { return copies_; }
  [[nodiscard]] Point point(int level, int copy, int offset) const {
    const double y = level * half_dy_m_ + (copies_ == 3 ? copy - 1 : 0) * height_m_;
    const double x = offset * half_dx_m_;
    return {y, -(y * y + x * x)};
  }
  double distance_m(Hull& hull, int row) const {
    const double y = (2 * row + 1) * half_dy_m_;
    return std::sqrt(std::max(0.0, y * y - hull.best(2.0 * y, 1.0)));
  }
  [[nodiscard]] double farthest_m() const { return farthest_m_; }

 private:
  double half_dx_m_, half_dy_m_, height_m_, farthest_m_;
  int copies_;
};

template <class Offset, class Metric>
void transform(const Grid& grid, const Metric& metric, std::span<const float> elevation,
               std::span<float> distance_m) {
  const CoastLevels<Offset> coast(grid, elevation);
  const int nx = grid.nx(), ny = grid.ny(), levels = coast.levels();
  constexpr int kBlock = 32;  // columns that share cache lines
  const int blocks = (nx + kBlock - 1) / kBlock;
  ParallelErrors errors;
#pragma omp parallel
  {
    auto offsets = errors.make<std::vector<Offset>>(static_cast<std::size_t>(levels) * kBlock);
    auto found = errors.make<std::vector<float>>(static_cast<std::size_t>(ny) * kBlock);
    auto made = errors.make<Hull>(static_cast<std::size_t>(levels) * metric.copies());
#pragma omp for schedule(dynamic, 1)
    for (int block = 0; block < blocks; ++block) {
      if (errors.any()) continue;
      Hull& hull = *made;
      const int first = block * kBlock, width = std::min(kBlock, nx - first);
      for (int level = 0; level < levels; ++level) {
        if (!coast.filled(level)) continue;
        for (int c = 0; c < width; ++c) {
          offsets[static_cast<std::size_t>(c) * levels + level] = coast.row(level)[first + c];
        }
      }
      for (int c = 0; c < width; ++c) {
        hull.clear();
        for (int copy = 0; copy < metric.copies(); ++copy) {
          for (int level = 0; level < levels; ++level) {
            // The seam of a torus is both its lowest and its highest level: once is enough.
            if (!coast.filled(level) || (copy > 0 && level == 0)) continue;
            hull.push(
                metric.point(level, copy, offsets[static_cast<std::size_t>(c) * levels + level]));
          }
        }
        for (int j = 0; j < ny; ++j) {
          found[static_cast<std::size_t>(j) * kBlock + c] =
              static_cast<float>(hull.empty() ? metric.farthest_m() : metric.distance_m(hull, j));
        }
      }
      for (int j = 0; j < ny; ++j) {
        for (int c = 0; c < width; ++c) {
          distance_m[grid.cell(first + c, j)] = found[static_cast<std::size_t>(j) * kBlock + c];
        }
      }
    }
  }
  errors.rethrow();
}

template <class Metric>
void transform_any(const Grid& grid, const Metric& metric, std::span<const float> elevation,
                   std::span<float> distance_m) {
  if (grid.nx() < 32000) {
    transform<std::uint16_t>(grid, metric, elevation, distance_m);
  } else {
    transform<std::int32_t>(grid, metric, elevation, distance_m);
  }
}

}  // namespace

void distance_to_coast(const Grid& grid, std::span<const float> elevation,
                       std::span<float> distance_m) {
  check_sizes("distance_to_coast", grid.size(),
              {{"elevation", elevation.size()}, {"distance_m", distance_m.size()}});
  if (grid.is_latitude_longitude()) {
    transform_any(grid, SphereMetric(grid), elevation, distance_m);
  } else {
    transform_any(grid, FlatMetric(grid), elevation, distance_m);
  }
}

}  // namespace geo
