#include "geo/kernels/smoothing.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/diffusion.hpp"

namespace geo {

void smooth(const Grid& grid, std::span<float> field, double length_m,
            std::span<const std::uint8_t> mask) {
  if (!(length_m >= 0.0 && std::isfinite(length_m))) {
    throw InputError("smoothing: length of " + std::to_string(length_m) +
                     " m must be finite and not negative");
  }
  DiffusionOptions options;
  options.substeps = !mask.empty() && grid.is_latitude_longitude() ? 8 : 4;
  std::vector<std::uint8_t> excluded(mask.size());
  for (std::size_t c = 0; c < mask.size(); ++c) excluded[c] = mask[c] == 0;
  options.excluded = excluded;
  diffuse(grid, field, 0.5 * length_m * length_m, 1.0, options);
}

}  // namespace geo
