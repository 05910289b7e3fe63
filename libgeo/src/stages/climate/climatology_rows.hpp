#pragma once

#include <span>
#include <vector>

#include "geo/core/climatology.hpp"
#include "geo/kernels/remapping/conservative_remapping.hpp"

namespace geo {

/// The months of a coarse year along the rows of a finer grid.
class ClimatologyRows {
 public:
  ClimatologyRows(const ConservativeRemapping& on_coarse, const Climatology& year) {
    for (int m = 0; m < Climatology::kMonths; ++m) {
      departure_.emplace_back(on_coarse, year.temperature_departure_k[m]);
      share_.emplace_back(on_coarse, year.precipitation_share[m]);
    }
  }
  [[nodiscard]] std::size_t scratch_size() const { return departure_.front().scratch_size(); }
  void temperature_departure(int month, int row, std::span<float> out,
                             std::span<float> scratch) const {
    departure_[month].row(row, out, scratch);
  }
  void precipitation_share(int month, int row, std::span<float> out,
                           std::span<float> scratch) const {
    share_[month].row(row, out, scratch);
  }

 private:
  std::vector<Interpolator> departure_, share_;
};

}  // namespace geo
