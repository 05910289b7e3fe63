#include "sphere_mass_balance.hpp"

#include <algorithm>
#include <limits>

namespace geo {
namespace {

double change(const SphereBudget& step) {
  return step.raised_km3 - step.eroded_km3 + step.deposited_km3 + step.scraped_km3 +
         step.emerged_km3 + step.changed_km3 - step.lost_km3 + step.resampling_km3;
}

double sediment_change(const SphereBudget& step) {
  return step.sediment_laid_km3 - step.sediment_reworked_km3 - step.sediment_subducted_km3 +
         step.sediment_resampling_km3;
}

}  // namespace

void SphereMassBalance::enter(const SphereBudget& step) {
  created_ += step.created_km2;
  consumed_ += step.consumed_km2;
  buried_ += step.buried_km2;
  emerged_ += step.emerged_km2;
  raised_ += step.raised_km3;
  eroded_ += step.eroded_km3;
  deposited_ += step.deposited_km3;
  sea_floor_ += step.sea_floor_km3;
  scraped_ += step.scraped_km3;
  laid_ += step.sediment_laid_km3;
  reworked_ += step.sediment_reworked_km3;
  subducted_ += step.sediment_subducted_km3;
  sediment_resampling_ += step.sediment_resampling_km3;
  emerged_km3_ += step.emerged_km3;
  changed_ += step.changed_km3;
  lost_ += step.lost_km3;
  resampling_ += step.resampling_km3;
  collisions_ += step.collisions;
  rifts_ += step.rifts;
  subduction_initiations_ += step.subduction_initiations;
  if (first_km3_ < 0.0) {
    first_km3_ = step.continental_km3 - change(step);
    first_sediment_km3_ = step.sediment_km3 - sediment_change(step);
  }
  last_ = step;
}

void SphereMassBalance::close(Budget& budget) const {
  budget["plates"] = last_.plates;
  budget["plates_area_error"] = last_.area_error;
  budget["crust_created_km2"] = created_;
  budget["crust_consumed_km2"] = consumed_;
  budget["crust_buried_km2"] = buried_;
  budget["crust_emerged_km2"] = emerged_;
  budget["collisions"] = collisions_;
  budget["rifts"] = rifts_;
  budget["subduction_initiations"] = subduction_initiations_;
  budget["continental_start_km3"] = first_km3_;
  budget["continental_end_km3"] = last_.continental_km3;
  budget["continental_raised_km3"] = raised_;
  budget["continental_eroded_km3"] = eroded_;
  budget["continental_deposited_km3"] = deposited_;
  budget["sea_floor_deposited_km3"] = sea_floor_;
  budget["continental_scraped_km3"] = scraped_;
  budget["continental_emerged_km3"] = emerged_km3_;
  budget["continental_changed_km3"] = changed_;
  budget["continental_lost_km3"] = lost_;
  budget["continental_resampling_km3"] = resampling_;
  budget["continental_closing_error"] =
      (last_.continental_km3 - first_km3_ - raised_ + eroded_ - deposited_ - scraped_ -
       emerged_km3_ - changed_ + lost_ - resampling_) /
      std::max(1.0, last_.continental_km3);
  if (laid_ <= 0.0) return;
  budget["sediment_start_km3"] = first_sediment_km3_;
  budget["sediment_end_km3"] = last_.sediment_km3;
  budget["sediment_laid_km3"] = laid_;
  budget["sediment_reworked_km3"] = reworked_;
  budget["sediment_subducted_km3"] = subducted_;
  budget["sediment_resampling_km3"] = sediment_resampling_;
  budget["sediment_drift_closing_error"] = (last_.sediment_km3 - first_sediment_km3_ - laid_ +
                                            reworked_ + subducted_ - sediment_resampling_) /
                                           laid_;
}

std::vector<std::string> step_columns() {
  return {"time_myr",
          "plates",
          "resampled",
          "collisions",
          "rifts",
          "created_km2",
          "consumed_km2",
          "buried_km2",
          "emerged_km2",
          "stretched_km2",
          "accreted_km3",
          "continental_km3",
          "raised_km3",
          "eroded_km3",
          "emerged_km3",
          "swallowed_km3",
          "changed_km3",
          "lost_km3",
          "resampling_km3",
          "deposited_km3",
          "sea_floor_km3",
          "erupted_km3",
          "subduction_initiations",
          "scraped_km3",
          "sediment_km3",
          "sediment_laid_km3",
          "sediment_reworked_km3",
          "sediment_subducted_km3",
          "sediment_resampling_km3",
          "sea_level_m",
          "water_km3"};
}

std::vector<double> step_row(const SphereTectonics& model) {
  const SphereBudget& b = model.budget;
  std::vector<double> row{b.time_myr,
                          static_cast<double>(b.plates),
                          b.resampled ? 1.0 : 0.0,
                          static_cast<double>(b.collisions),
                          static_cast<double>(b.rifts),
                          b.created_km2,
                          b.consumed_km2,
                          b.buried_km2,
                          b.emerged_km2,
                          b.stretched_km2,
                          b.accreted_km3,
                          b.continental_km3,
                          b.raised_km3,
                          b.eroded_km3,
                          b.emerged_km3,
                          b.swallowed_km3,
                          b.changed_km3,
                          b.lost_km3,
                          b.resampling_km3,
                          b.deposited_km3,
                          b.sea_floor_km3,
                          b.erupted_km3,
                          static_cast<double>(b.subduction_initiations),
                          b.scraped_km3,
                          b.sediment_km3,
                          b.sediment_laid_km3,
                          b.sediment_reworked_km3,
                          b.sediment_subducted_km3,
                          b.sediment_resampling_km3,
                          model.state.sea_level_m,
                          model.state.water_km3};
  // By the numbers of plates, which outlast the places where the model keeps them.
  const SphereState& state = model.state;
  const std::vector<double> area_km2 = plate_areas_km2(model);
  const std::size_t before = row.size();
  row.resize(before + state.lives.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t p = 0; p < area_km2.size(); ++p) {
    if (area_km2[p] > 0.0) row[before + state.plates[p].id] = area_km2[p];
  }
  return row;
}

void name_plates(StepTable& steps) {
  std::size_t most = 0;
  for (const auto& row : steps.rows) most = std::max(most, row.size());
  for (std::size_t k = 0; steps.columns.size() < most; ++k) {
    steps.columns.push_back("plate_" + std::to_string(k) + "_km2");
  }
}

}  // namespace geo
