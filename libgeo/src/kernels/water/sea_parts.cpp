#include "geo/kernels/water/sea_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "disjoint_sets.hpp"
#include "geo/core/error.hpp"

namespace geo {
namespace {

/// Cells of the sea side by side in a row, the columns from `begin` to before `end`.
struct Run {
  std::int32_t begin, end;
  float deepest_m;
};

class RunsOfSea {
 public:
  RunsOfSea(const Grid& grid, std::span<const float> elevation_m)
      : grid_(grid), first_(static_cast<std::size_t>(grid.ny()) + 1, 0) {
    find_runs(elevation_m);
    join_runs();
    make_parts();
  }

  [[nodiscard]] std::vector<SeaPart>& parts() { return parts_; }
  [[nodiscard]] std::vector<std::int32_t> part_of_cells() const {
    std::vector<std::int32_t> part_of_cell(grid_.size());
#pragma omp parallel for schedule(static)
    for (int j = 0; j < grid_.ny(); ++j) {
      const auto row = part_of_cell.begin() + grid_.cell(0, j);
      std::fill_n(row, grid_.nx(), -1);
      for (std::int32_t r = first_[j]; r < first_[j + 1]; ++r) {
        std::fill(row + runs_[r].begin, row + runs_[r].end, part_of_run_[r]);
      }
    }
    return part_of_cell;
  }

 private:
  /// Calls `run` for each run of a row.
  template <class Visit>
  void visit_row(std::span<const float> elevation_m, int j, Visit&& run) const {
    const int nx = grid_.nx();
    const float* const z = elevation_m.data() + grid_.cell(0, j);
    for (int i = 0; i < nx;) {
      if (!(z[i] < 0.0F)) {
        ++i;
        continue;
      }
      Run found{i, i, 0.0F};
      for (; i < nx && z[i] < 0.0F; ++i) found.deepest_m = std::min(found.deepest_m, z[i]);
      found.end = i;
      run(found);
    }
  }

  void find_runs(std::span<const float> elevation_m) {
#pragma omp parallel for schedule(static)
    for (int j = 0; j < grid_.ny(); ++j) {
      visit_row(elevation_m, j, [&](const Run&) { ++first_[j + 1]; });
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    runs_.resize(first_.back());
#pragma omp parallel for schedule(static)
    for (int j = 0; j < grid_.ny(); ++j) {
      std::int32_t next = first_[j];
      visit_row(elevation_m, j, [&](const Run& run) { runs_[next++] = run; });
    }
  }

  void join_runs() {
    sets_ = DisjointSets(runs_.size());
    for (int j = 0; j + 1 < grid_.ny(); ++j) join_rows(j, j + 1);
    // What lies beyond an end of a row, and beyond the first and the last one, is for the grid.
    for (int j = 0; j < grid_.ny(); ++j) {
      const bool outermost = j == 0 || j + 1 == grid_.ny();
      for (std::int32_t r = first_[j]; r < first_[j + 1]; ++r) {
        for (std::int32_t i = runs_[r].begin; i < runs_[r].end; ++i) {
          if (outermost || i == 0 || i + 1 == grid_.nx()) join_around(i, j, r);
        }
      }
    }
  }
  /// Runs of two rows, one above the other, that touch, if only at corners.
  void join_rows(int south, int north) {
    std::int32_t s = first_[south], n = first_[north];
    while (s < first_[south + 1] && n < first_[north + 1]) {
      if (runs_[s].begin <= runs_[n].end && runs_[n].begin <= runs_[s].end) sets_.join(s, n);
      ++(runs_[s].end < runs_[n].end ? s : n);
    }
  }
  void join_around(int i, int j, std::int32_t run) {
    for (int k = 0; k < kDirections; ++k) {
      const Index beside = grid_.neighbour(i, j, k);
      if (beside == kNoCell) continue;
      const std::int32_t other = run_at(grid_.column(beside), grid_.row(beside));
      if (other >= 0) sets_.join(run, other);
    }
  }
  /// -1 on land.
  [[nodiscard]] std::int32_t run_at(int i, int j) const {
    const auto begin = runs_.begin() + first_[j], end = runs_.begin() + first_[j + 1];
    const auto beyond = std::upper_bound(
        begin, end, i, [](int column, const Run& run) { return column < run.end; });
    if (beyond == end || beyond->begin > i) return -1;
    return static_cast<std::int32_t>(beyond - runs_.begin());
  }

  void make_parts() {
    part_of_run_.resize(runs_.size());
    std::int32_t r = 0;
    for (int j = 0; j < grid_.ny(); ++j) {
      for (; r < first_[j + 1]; ++r) {
        // The first run of a part is its root.
        const std::int32_t root = sets_.find(r);
        if (root == r) {
          part_of_run_[r] = static_cast<std::int32_t>(parts_.size());
          parts_.push_back({.first = grid_.cell(runs_[r].begin, j)});
        } else {
          part_of_run_[r] = part_of_run_[root];
        }
        SeaPart& part = parts_[part_of_run_[r]];
        part.area_m2 += grid_.area_m2(j) * (runs_[r].end - runs_[r].begin);
        part.deepest_m = std::min(part.deepest_m, static_cast<double>(runs_[r].deepest_m));
      }
    }
    put_largest_first();
  }
  void put_largest_first() {
    std::vector<std::int32_t> order(parts_.size()), place(parts_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
      return parts_[a].area_m2 > parts_[b].area_m2;
    });
    std::vector<SeaPart> sorted;
    sorted.reserve(parts_.size());
    for (const std::int32_t part : order) {
      place[part] = static_cast<std::int32_t>(sorted.size());
      sorted.push_back(parts_[part]);
    }
    parts_ = std::move(sorted);
    for (std::int32_t& part : part_of_run_) part = place[part];
  }

  const Grid& grid_;
  std::vector<std::int32_t> first_;  ///< run of each row, and one beyond the last
  std::vector<Run> runs_;
  DisjointSets sets_{0};
  std::vector<std::int32_t> part_of_run_;
  std::vector<SeaPart> parts_;
};

void check_shape(const Grid& grid, std::span<const float> elevation_m) {
  if (elevation_m.size() == static_cast<std::size_t>(grid.size())) return;
  throw InputError(fmt::format("parts of the sea: elevation has {} values, the grid {} cells",
                               elevation_m.size(), grid.size()));
}

}  // namespace

std::vector<SeaPart> parts_of_sea(const Grid& grid, std::span<const float> elevation_m) {
  check_shape(grid, elevation_m);
  return std::move(RunsOfSea(grid, elevation_m).parts());
}

NumberedSeas number_seas(const Grid& grid, std::span<const float> elevation_m) {
  check_shape(grid, elevation_m);
  RunsOfSea runs(grid, elevation_m);
  return {std::move(runs.parts()), runs.part_of_cells()};
}

int count_landlocked(std::span<const SeaPart> parts, double depth_m, double area_m2) {
  if (parts.empty()) return 0;
  return static_cast<int>(std::count_if(parts.begin() + 1, parts.end(), [&](const SeaPart& part) {
    return part.deepest_m < -depth_m || part.area_m2 > area_m2;
  }));
}

}  // namespace geo
