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
  auto& runs = continents_.runs;
  auto& row_begin = continents_.row_begin;
  auto& area = continents_.area;
  runs.clear();
  row_begin.assign(1, 0);
  continents_.left = left_;
  continents_.top = top_;
  std::vector<std::int32_t> parent;
  const auto join = [&](std::int32_t a, std::int32_t b) {
    a = root_of(parent, a);
    b = root_of(parent, b);
    parent[std::max(a, b)] = std::min(a, b);
  };
  const bool round_x = columns_ == world_.columns, round_y = rows_ == world_.rows;
  const auto join_rows = [&](int above, int below) {
    std::int32_t a = row_begin[above], b = row_begin[below];
    while (a < row_begin[above + 1] && b < row_begin[below + 1]) {
      if (runs[a].begin < runs[b].end && runs[b].begin < runs[a].end) join(a, b);
      runs[a].end < runs[b].end ? ++a : ++b;
    }
  };
  const auto add_run = [&](int begin, int end) {
    parent.push_back(static_cast<std::int32_t>(runs.size()));
    runs.push_back({begin, end, -1});
  };
  for (int j = 0; j < rows_; ++j) {
    const Block* along = blocks(j);
    int begin = -1;
    for (int block = reach_[j].begin / kBlock; block * kBlock < reach_[j].end; ++block) {
      // Bits that differ from the one before them: where land begins or ends.
      const std::uint32_t land = along[block].land;
      std::uint32_t steps = (land ^ (land << 1 | (begin >= 0 ? 1U : 0U))) & 0xFFFFU;
      for (; steps != 0; steps &= steps - 1) {
        const int i = block * kBlock + std::countr_zero(steps);
        if (begin >= 0) add_run(begin, i);
        begin = begin >= 0 ? -1 : i;
      }
    }
    if (begin >= 0) add_run(begin, columns_);
    row_begin.push_back(static_cast<std::int32_t>(runs.size()));
    if (round_x && row_begin[j + 1] - row_begin[j] > 1 && runs[row_begin[j]].begin == 0 &&
        runs.back().end == columns_) {
      join(row_begin[j], row_begin[j + 1] - 1);
    }
    if (j > 0) join_rows(j - 1, j);
  }
  if (round_y && rows_ > 1) join_rows(rows_ - 1, 0);
  area.clear();
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::int32_t root = root_of(parent, static_cast<std::int32_t>(k));
    // A root comes before what hangs on it.
    if (root == static_cast<std::int32_t>(k)) {
      runs[k].continent = static_cast<std::int32_t>(area.size());
      area.push_back(0);
    } else {
      runs[k].continent = runs[root].continent;
    }
    area[runs[k].continent] += runs[k].end - runs[k].begin;
  }
}

}  // namespace geo
