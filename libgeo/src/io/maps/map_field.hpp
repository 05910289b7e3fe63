#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

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

/// Colours of the categories of a field with flags, in their order.
std::vector<std::pair<Rgb, const Flag*>> category_colours(const FieldSpec& spec);

/// The colour of each value of a field as its map has it, without light and coast; what has no
/// colour is that of pale land. `some` are values of the field, from which a colour map without
/// fixed ends takes its range.
std::function<Rgb(float)> tints_of(const FieldSpec& spec, std::span<const float> some);

}  // namespace geo::io
