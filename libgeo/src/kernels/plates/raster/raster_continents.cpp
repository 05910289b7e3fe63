#include <algorithm>
#include <bit>
#include <numeric>

#include "geo/kernels/plates/raster/raster_plate.hpp"

namespace geo {
namespace {

std::int32_t root_of(std::vector<std::int32_t>& parent, std::int32_t k) {
  while (parent[k] != k) k = parent[k] = parent[parent[k]];
  return k;
}

/// Runs of land along the rows of a plate, joined where they touch.
class RunsOfLand {
 public:
  explicit RunsOfLand(RasterContinents& continents) : all_(continents) {
    all_.runs.clear();
    all_.row_begin.assign(1, 0);
    all_.area.clear();
  }

  void add(int begin, int end) {
    parent_.push_back(static_cast<std::int32_t>(all_.runs.size()));
    all_.runs.push_back({begin, end, -1});
  }
  void end_row() { all_.row_begin.push_back(static_cast<std::int32_t>(all_.runs.size())); }
  /// Where a row goes round, the ends of the first run and the last.
  void join_ends(int row, int columns) {
    const std::int32_t first = all_.row_begin[row], last = all_.row_begin[row + 1] - 1;
    if (last <= first || all_.runs[first].begin != 0 || all_.runs[last].end != columns) return;
    join(first, last);
  }
  void join_rows(int above, int below) {
    const auto& runs = all_.runs;
    std::int32_t a = all_.row_begin[above], b = all_.row_begin[below];
    while (a < all_.row_begin[above + 1] && b < all_.row_begin[below + 1]) {
      if (runs[a].begin < runs[b].end && runs[b].begin < runs[a].end) join(a, b);
      runs[a].end < runs[b].end ? ++a : ++b;
    }
  }
  /// Numbers the continents, and measures them.
  void number() {
    for (std::size_t k = 0; k < all_.runs.size(); ++k) {
      auto& run = all_.runs[k];
      const std::int32_t root = root_of(parent_, static_cast<std::int32_t>(k));
      // A root comes before what hangs on it.
      if (root == static_cast<std::int32_t>(k)) {
        run.continent = static_cast<std::int32_t>(all_.area.size());
        all_.area.push_back(0);
      } else {
        run.continent = all_.runs[root].continent;
      }
      all_.area[run.continent] += run.end - run.begin;
    }
  }

 private:
  void join(std::int32_t a, std::int32_t b) {
    a = root_of(parent_, a);
    b = root_of(parent_, b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  RasterContinents& all_;
  std::vector<std::int32_t> parent_;
};

}  // namespace

std::int32_t RasterContinents::at(int column, int row) const {
  const auto begin = runs.begin() + row_begin[row], end = runs.begin() + row_begin[row + 1];
  const auto after =
      std::upper_bound(begin, end, column, [](int c, const Run& run) { return c < run.begin; });
  if (after == begin || column >= (after - 1)->end) return -1;
  return (after - 1)->continent;
}

void RasterPlate::find_continents(int steps) {
  ++continents_age_;
  if (continents_known_ && (!land_changed_ || continents_age_ < steps)) return;
  continents_known_ = true;
  land_changed_ = false;
  continents_age_ = 0;
  continents_.left = left_;
  continents_.top = top_;
  RunsOfLand runs(continents_);
  const bool round_x = columns_ == world_.columns, round_y = rows_ == world_.rows;
  for (int j = 0; j < rows_; ++j) {
    const Block* along = blocks(j);
    int begin = -1;
    for (int block = reach_[j].begin / kBlock; block * kBlock < reach_[j].end; ++block) {
      // Bits that differ from the one before them: where land begins or ends.
      const std::uint32_t land = along[block].land;
      std::uint32_t steps = (land ^ (land << 1 | (begin >= 0 ? 1U : 0U))) & 0xFFFFU;
      for (; steps != 0; steps &= steps - 1) {
        const int i = block * kBlock + std::countr_zero(steps);
        if (begin >= 0) runs.add(begin, i);
        begin = begin >= 0 ? -1 : i;
      }
    }
    if (begin >= 0) runs.add(begin, columns_);
    runs.end_row();
    if (round_x) runs.join_ends(j, columns_);
    if (j > 0) runs.join_rows(j - 1, j);
  }
  if (round_y && rows_ > 1) runs.join_rows(rows_ - 1, 0);
  runs.number();
}

}  // namespace geo
