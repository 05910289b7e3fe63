#include "geo/kernels/remapping/planet_cells.hpp"

#include <algorithm>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/kernels/remapping/catmull_rom.hpp"

namespace geo {

PlanetCells::PlanetCells(const Grid& planet, const Grid& fine) : planet_(planet), fine_(fine) {
  if (!fine.is_geographic()) throw InputError("a closer look needs a grid that knows its place");
  cell_.resize(fine.size());
  std::vector<int> lowest(fine.ny(), planet.ny()), highest(fine.ny(), 0);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < fine.ny(); ++j) {
    for (int i = 0; i < fine.nx(); ++i) {
      const Index cell = CatmullRom(planet, fine.position(i, j)).nearest();
      cell_[fine.cell(i, j)] = cell;
      lowest[j] = std::min(lowest[j], planet.row(cell));
      highest[j] = std::max(highest[j], planet.row(cell));
    }
  }
  constexpr int kMargin = 2;
  first_row_ = std::max(0, *std::min_element(lowest.begin(), lowest.end()) - kMargin);
  const int last =
      std::min(planet.ny() - 1, *std::max_element(highest.begin(), highest.end()) + kMargin);
  rows_ = last - first_row_ + 1;
}

std::vector<float> PlanetCells::means(std::span<const float> values,
                                      std::span<const std::uint8_t> wanted, float otherwise) const {
  check_sizes("PlanetCells", cell_.size(),
              {{"values", values.size()}, {"wanted", wanted.size(), ArraySize::May::be_empty}});
  // In the order of the cells, on one thread: a pass over memory, and the same bits always.
  std::vector<double> sum(size());
  std::vector<std::int32_t> count(size());
  const std::size_t first = static_cast<std::size_t>(first_row_) * planet_.nx();
  for (std::size_t c = 0; c < values.size(); ++c) {
    if (!wanted.empty() && wanted[c] == 0) continue;
    sum[cell_[c] - first] += values[c];
    ++count[cell_[c] - first];
  }
  std::vector<float> mean(size(), otherwise);
  for (std::size_t k = 0; k < mean.size(); ++k) {
    if (count[k] > 0) mean[k] = static_cast<float>(sum[k] / count[k]);
  }
  return mean;
}

double PlanetCells::interpolate(std::span<const float> covered, int column, int row) const {
  return CatmullRom(planet_, fine_.position(column, row)).of([&](int i, int j) {
    return covered[at(i, std::clamp(j, first_row_, first_row_ + rows_ - 1))];
  });
}

}  // namespace geo
