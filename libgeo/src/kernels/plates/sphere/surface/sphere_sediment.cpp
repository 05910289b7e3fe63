#include <algorithm>
#include <vector>

#include "kernels/plates/sphere/sample_sums.hpp"
#include "kernels/plates/sphere/sphere_steps.hpp"

namespace geo {

void enter_sediment(SphereTectonics& model, const std::vector<float>& rock_m) {
  std::vector<float>& sediment_m = model.state.crust.sediment_m;
  const std::vector<float> before_m = sediment_m;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < rock_m.size(); ++i) {
    sediment_m[i] = std::max(0.0F, sediment_m[i] + rock_m[i]);
  }
  const auto change_m = [&](std::int32_t i) {
    return static_cast<double>(sediment_m[i]) - before_m[i];
  };
  model.budget.sediment_laid_km3 +=
      samples_km3(model, [&](std::int32_t i) { return std::max(0.0, change_m(i)); });
  model.budget.sediment_reworked_km3 +=
      samples_km3(model, [&](std::int32_t i) { return std::max(0.0, -change_m(i)); });
}

void scrape_sediment(SphereTectonics& model) {
  SphereCrust& crust = model.state.crust;
  const SphereSettings& s = model.settings;
  double scraped_m = 0.0, subducted_m = 0.0;
  for (const std::int32_t i : model.margins.contacts) {
    const std::int32_t above = model.margins.partner[i];
    if (model.margins.hidden[i] == 0 || crust.continental[i] != 0 || above < 0) continue;
    const double stays_m = put(crust.sediment_m[above], s.accreted_share * crust.sediment_m[i]);
    subducted_m += crust.sediment_m[i] - stays_m;
    crust.sediment_m[i] = 0.0F;
    if (crust.continental[above] != 0) {
      scraped_m += put(crust.thickness_m[above], stays_m);
      crust.elevation_m[above] =
          static_cast<float>(height_after(crust.elevation_m[above], stays_m, s.rebound));
    } else {
      const auto higher_m = static_cast<float>(s.rivers.load * stays_m);
      crust.elevation_m[above] += higher_m;
      crust.thickness_m[above] += higher_m;
    }
  }
  model.budget.scraped_km3 += 1e-3 * model.sample_km2() * scraped_m;
  model.budget.sediment_subducted_km3 += 1e-3 * model.sample_km2() * subducted_m;
}

}  // namespace geo
