#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace geo::io {

/// A colour, components 0 to 1, sRGB.
struct Rgb {
  float r = 0.0F, g = 0.0F, b = 0.0F;
};

inline constexpr Rgb kInk{0.13F, 0.15F, 0.18F};
inline constexpr Rgb kFaintInk{0.40F, 0.43F, 0.47F};

constexpr Rgb mix(Rgb a, Rgb b, float t) {
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}
/// The colours of a row of pixels, component by component, and how strongly each shows the light on
/// the relief.
struct ColourRow {
  explicit ColourRow(int width) : r(width), g(width), b(width), light(width) {}
  void set(int x, Rgb colour, float strength = 0.0F) {
    r[x] = colour.r;
    g[x] = colour.g;
    b[x] = colour.b;
    light[x] = strength;
  }

  std::vector<float> r, g, b, light;
};
/// Mixes a colour into all pixels of a row, by `scale` times the share of each.
void mix_in(ColourRow& row, Rgb colour, const float* share, float scale);

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
  /// Two stops at least.
  explicit ColourMap(std::vector<Stop> stops);
  /// These colours, evenly along the given ascending values.
  [[nodiscard]] ColourMap spread_over(const std::vector<float>& values) const;

  [[nodiscard]] const std::vector<Stop>& stops() const { return stops_; }
  /// Position of a value among the stops: 0 at the first, 1 at the second …, clamped.
  [[nodiscard]] float position(float value) const {
    if (!(value > values_.front())) return 0.0F;
    if (value >= values_.back()) return static_cast<float>(values_.size() - 1);
    std::size_t i = first_[static_cast<std::size_t>((value - values_.front()) * bins_per_unit_)];
    while (values_[i] < value) ++i;
    const float below = values_[i - 1];
    return static_cast<float>(i - 1) + (value - below) / (values_[i] - below);
  }
  /// Colour between the stops.
  [[nodiscard]] Rgb smooth(float value) const { return at_position(position(value)); }
  /// Colour of the class between two stops that holds the value. The border between classes is
  /// blended over `blur`, in positions, so that it is drawn without steps.
  [[nodiscard]] Rgb classed(float position, float blur) const {
    const int last = static_cast<int>(classes_.size()) - 1;
    const int border = std::clamp(static_cast<int>(position + 0.5F), 1, std::max(last, 1));
    const float across = (position - static_cast<float>(border)) / std::max(blur, 1e-3F) + 0.5F;
    if (across <= 0.0F || across >= 1.0F)
      return classes_[std::min(static_cast<int>(position), last)];
    return mix(classes_[border - 1], classes_[std::min(border, last)], across);
  }
  /// Colour of the class between stop i and the next.
  [[nodiscard]] Rgb class_colour(int i) const { return classes_[i]; }
  /// Colour of the category, or nullptr.
  [[nodiscard]] const Stop* category(int value) const;

 private:
  static constexpr int kBins = 256;

  [[nodiscard]] Rgb at_position(float position) const {
    const auto i = std::min(static_cast<std::size_t>(position), classes_.size() - 1);
    return mix(colours_[i], colours_[i + 1], position - static_cast<float>(i));
  }

  std::vector<Stop> stops_;
  std::vector<float> values_;  // of the stops
  std::vector<Rgb> colours_, classes_;
  // In which stop the search for a value begins, by equal parts of the range.
  std::array<std::uint32_t, kBins + 1> first_{};
  float bins_per_unit_ = 0.0F;
};

}  // namespace geo::io
