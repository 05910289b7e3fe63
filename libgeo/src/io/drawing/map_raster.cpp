#include "map_raster.hpp"

#include <array>

#include "geo/core/parallel_errors.hpp"

namespace geo::io {
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

}  // namespace geo::io
