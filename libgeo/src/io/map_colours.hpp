#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace geo::io {

/// A colour, components 0 to 1, sRGB.
struct Rgb {
  float r = 0.0F, g = 0.0F, b = 0.0F;
};

constexpr Rgb mix(Rgb a, Rgb b, float t) {
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}
/// "#rrggbb"; throws Bug when it is not one.
Rgb parse_colour(std::string_view hex);

/// A colour map of `data/colour_maps/`: colours at ascending values.
class ColourMap {
 public:
  struct Stop {
    float value;
    Rgb colour;
    std::string name;  ///< of categories
  };

  explicit ColourMap(std::string_view name);
  /// These colours, evenly along the given ascending values.
  [[nodiscard]] ColourMap spread_over(const std::vector<float>& values) const;

  [[nodiscard]] const std::vector<Stop>& stops() const { return stops_; }
  /// Position of a value among the stops: 0 at the first, 1 at the second …, clamped.
  [[nodiscard]] float position(float value) const;
  /// Colour between the stops.
  [[nodiscard]] Rgb smooth(float value) const { return at_position(position(value)); }
  /// Colour of the class between two stops that holds the value. The border between classes is
  /// blended over `blur`, in positions, so that it is drawn without steps.
  [[nodiscard]] Rgb classed(float position, float blur) const;
  /// Colour of the class between stop i and the next.
  [[nodiscard]] Rgb class_colour(int i) const { return at_position(static_cast<float>(i) + 0.5F); }
  /// Colour of the category, or nullptr.
  [[nodiscard]] const Stop* category(int value) const;

 private:
  ColourMap() = default;
  [[nodiscard]] Rgb at_position(float position) const;
  std::vector<Stop> stops_;
};

}  // namespace geo::io
