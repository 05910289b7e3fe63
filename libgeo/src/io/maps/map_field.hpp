#pragma once

#include "geo/core/state.hpp"
#include "io/drawing/map_canvas.hpp"
#include "map_themes.hpp"

namespace geo::io {

/// How any field is drawn when nothing more is known of it than its row in the vocabulary.
enum class FieldKind {
  relief,      ///< hypsometric colours over shading
  categories,  ///< colours with names
  areas,       ///< numbers of areas: colours that tell neighbours apart
  steps,       ///< whole numbers, never mixed
  continuous,  ///< a perceptual colour map
};
FieldKind kind_of(const FieldSpec& spec);

/// "Drainage area", of `basin_id` "Basins".
std::string title_of(const FieldSpec& spec);

/// Draws a field of the scene's state with its legend and frame, and says in which unit the legend
/// counts ("km²", empty for numbers without one).
std::string units_on_map(const FieldSpec& spec);
void draw_any_field(const FieldSpec& spec, const Scene& scene, MapCanvas& canvas);

}  // namespace geo::io
