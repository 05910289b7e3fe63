#include "geo/stages/erosion/erosion.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <vector>

#include "climate_of_land.hpp"
#include "erosion_run.hpp"
#include "icy_climate.hpp"

namespace geo {
namespace {

class ErosionStage final : public Stage {
 public:
  [[nodiscard]] const StageInfo& info() const override {
    static const std::array<StageInfo, 4> kInfo = [] {
      std::array<StageInfo, 4> info;
      for (int kind = 0; kind < 4; ++kind) {
        info[kind] = described(/*deposits=*/kind % 2 != 0, /*freezes=*/kind / 2 != 0);
      }
      return info;
    }();
    return kInfo[(parameters_.deposits() ? 1 : 0) + (parameters_.freezes() ? 2 : 0)];
  }
  [[nodiscard]] std::vector<Parameter> parameters() override { return parameters_.declarations(); }
  [[nodiscard]] StageCost cost(std::span<const Parameter> configuration) const override {
    constexpr double kStep_ns = 190.0, kIce_ns = 2550.0;  // cold and warm times, and today
    constexpr double kAir_bytes = 50e6;
    const auto steps = static_cast<double>(parameters_.steps);
    const bool follows_rain = parameters_.discharge == "rain" && parameters_.steps > 0;
    const double climates =
        follows_rain ? std::min(static_cast<double>(parameters_.climates), steps) : 0.0;
    const double ice_ns = follows_rain && parameters_.freezes() ? kIce_ns : 0.0;
    const double ice_s = ice_ns > 0.0 ? icy_climate_seconds(configuration) : 0.0;
    return {.per_cell_ns = kStep_ns * steps + ice_ns,
            .fixed_s = climates * climate_of_land_seconds(configuration) + ice_s,
            .cell_bytes = 113.0,
            .fixed_bytes = kAir_bytes};
  }

  void check(const Grid& /*grid*/,
             const std::function<bool(const FieldSpec&)>& /*has*/) const override {
    static_cast<void>(checked(parameters_));
  }

  void run(StageIo& io, Context& context) const override {
    ErosionRun run(parameters_, io, context);
    run.wear();
    run.finish();
    run.write();
  }

 private:
  static StageInfo described(bool deposits, bool freezes) {
    StageInfo info{
        "erosion",
        "rivers and hillslopes wear the land down",
        {&field::elevation},
        {&field::erodibility, &field::thickening_rate, &field::uplift_rate, &field::boundary_type,
         &field::boundary_strength, &field::convergent_deformation, &field::divergent_deformation,
         &field::transform_deformation},
        {&field::elevation, &field::uplift_rate, &field::erosion_rate, &field::drainage_area,
         &field::flow_receiver, &field::crust_thickness_change},
        /*own_grid=*/false,
        /*feels_events=*/true};
    const auto also = [&](std::initializer_list<const FieldSpec*> fields) {
      info.writes.insert(info.writes.end(), fields);
    };
    if (deposits) {
      info.optional.push_back(&field::sediment_thickness);
      also({&field::sediment_thickness, &field::deposition_rate, &field::sediment_flux});
    }
    if (freezes) also({&field::ice_thickness, &field::glacial_erosion});
    return info;
  }
  ErosionParameters parameters_;
};

}  // namespace

std::unique_ptr<Stage> make_erosion_stage() { return std::make_unique<ErosionStage>(); }

}  // namespace geo
