#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geo/core/state.hpp"
#include "io/drawing/map_canvas.hpp"
#include "io/drawing/map_raster.hpp"

namespace geo::io {

struct RiverPoint {
  double x, y;  ///< pixels from the map's upper left corner; on aligned pages x runs on beyond it
  float flow;   ///< discharge, or drainage area where that is not known
};

/// The larger rivers of a map, from source to mouth or to the junction with a larger one.
struct RiverNetwork {
  std::vector<std::vector<RiverPoint>> lines;
  float least_flow = 0.0F, most_flow = 0.0F;
};

/// Land under ice; where a state does not know its thickness, land where frozen all year: what
/// falls there leaves as ice.
class FrozenGround {
 public:
  explicit FrozenGround(const State& state);
  [[nodiscard]] bool is_known() const { return knows_ice() || !mean_c_.empty(); }
  /// Whether it is the ice itself that is known.
  [[nodiscard]] bool knows_ice() const { return !ice_m_.empty(); }
  [[nodiscard]] bool at(Index i) const {
    constexpr float kSeen_m = 10.0F;
    if (knows_ice()) return ice_m_[i] >= kSeen_m;
    return is_known() && mean_c_[i] + 0.5F * range_k_[i] < 0.0F;
  }
  [[nodiscard]] const char* name() const { return knows_ice() ? "ice" : "frozen all year"; }

 private:
  std::span<const float> ice_m_, mean_c_, range_k_;
};

/// True where the state has what rivers are drawn from.
bool has_rivers(const State& state);

/// Traces rivers along `flow_receiver`. Only the largest by discharge and drainage area are kept,
/// about the same length of line per area of map at any scale. Lines are smoothed over a few cells.
/// On aligned pages one that crosses the date line runs on and one that crosses a pole is cut; on
/// projected ones they are cut at the edge of the map alone.
RiverNetwork trace_rivers(const MapFrame& frame, const State& state);

/// Width of a river on a map 1800 px wide.
double river_width_px(const RiverNetwork& rivers, float flow);

/// Round flows between the least and the most, with their widths and words, for a legend.
std::vector<std::pair<double, std::string>> river_key(const RiverNetwork& rivers,
                                                      const State& state);

/// Draws them, as wide as the square root of the flow, at both edges where they run across one.
void draw_rivers(MapCanvas& canvas, const RiverNetwork& rivers, Rgb colour);

}  // namespace geo::io
