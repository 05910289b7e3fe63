#include "map_field.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>

#include "geo/io/files/embedded_data.hpp"

namespace geo::io {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A unit as a reader knows it, and what it is multiplied with.
struct ShownUnit {
  std::string_view units, shown;
  double scale;
};
constexpr std::array kShownUnits{
    ShownUnit{"1", "", 1.0},
    ShownUnit{"", "", 1.0},
    ShownUnit{"m2", "km²", 1e-6},
    ShownUnit{"m3 s-1", "m³/s", 1.0},
    ShownUnit{"m s-1", "m/s", 1.0},
    ShownUnit{"m m-1", "m/m", 1.0},
    ShownUnit{"m yr-1", "mm per year", 1e3},
    ShownUnit{"mm yr-1", "mm per year", 1.0},
    ShownUnit{"yr-1", "per year", 1.0},
    ShownUnit{"degC", "°C", 1.0},
    ShownUnit{"Myr", "million years", 1.0},
    ShownUnit{"kg m-3", "kg/m³", 1.0},
    ShownUnit{"g m-2 yr-1", "g per m² and year", 1.0},
};

ShownUnit shown_unit(const FieldSpec& spec) {
  if (spec.name == "distance_to_coast" || spec.name == "crust_thickness") return {"m", "km", 1e-3};
  for (const auto& unit : kShownUnits) {
    if (unit.units == spec.units) return unit;
  }
  return {spec.units, spec.units, 1.0};
}

/// Whether a field counts the water of the land alone: at sea it says nothing, or the size of
/// cells.
bool is_of_rivers(const FieldSpec& spec) {
  constexpr std::array<std::string_view, 4> kRivers{"drainage_area", "discharge", "river_intensity",
                                                    "stream_order"};
  return std::find(kRivers.begin(), kRivers.end(), spec.name) != kRivers.end();
}

/// Values of any type as numbers in the shown unit, NaN where there is none.
template <class Use>
void with_values(const State& state, const FieldSpec& spec, const Use& use) {
  const double scale = shown_unit(spec).scale;
  const auto held = state.values(spec);
  const bool land_alone = is_of_rivers(spec) && state.has(field::elevation);
  const auto elevation = land_alone ? state.read(field::elevation) : std::span<const float>{};
  std::visit(
      [&](const auto& values) {
        using Number = typename std::decay_t<decltype(values)>::value_type;
        use([&](Index i) {
          if (land_alone && elevation[i] < 0.0F) return kNaN;
          if constexpr (std::is_integral_v<Number>) {
            if (values[i] == spec.missing) return kNaN;
          }
          return static_cast<float>(static_cast<double>(values[i]) * scale);
        });
      },
      *held);
}

/// The value of the cell in the middle of each pixel.
Raster nearest(const MapFrame& frame, const State& state, const FieldSpec& spec) {
  Raster out(frame, kNaN);
  with_values(state, spec, [&](const auto& value) {
#pragma omp parallel for schedule(static)
    for (int y = 0; y < out.height; ++y) {
      for (int x = 0; x < out.width; ++x) {
        if (frame.shows(x, y)) out.at(x, y) = value(frame.cell_at(x, y));
      }
    }
  });
  return out;
}

/// Sorted finite values of some of the pixels.
std::vector<float> some_values(const Raster& raster) {
  std::vector<float> some;
  const std::size_t stride = std::max<std::size_t>(1, raster.values.size() / 200000);
  for (std::size_t i = 0; i < raster.values.size(); i += stride) {
    if (std::isfinite(raster.values[i])) some.push_back(raster.values[i]);
  }
  std::sort(some.begin(), some.end());
  return some;
}

float quantile(const std::vector<float>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// 1, 2, 5 times powers of ten that span two positive values.
std::vector<float> logarithmic_stops(double low, double high) {
  std::vector<float> stops;
  for (double power = std::pow(10.0, std::floor(std::log10(low))); power <= high * 10.0;
       power *= 10.0) {
    for (const double step : {1.0, 2.0, 5.0}) {
      const double value = step * power;
      if (value * 2.5 < low) continue;
      stops.push_back(static_cast<float>(value));
      if (value >= high) return stops;
    }
  }
  return stops;
}

std::vector<float> linear_stops(double low, double high, int intervals) {
  const double step = round_down_nicely(std::max((high - low) / intervals, 1e-12) * 1.3);
  std::vector<float> stops;
  for (double k = std::floor(low / step + 1e-6); (k - 1.0) * step < high - 1e-6 * step; k += 1.0) {
    stops.push_back(static_cast<float>(k * step));
  }
  return stops;
}

/// Colours that suit the values: diverging about 0 where both signs count, in steps of 1, 2, 5
/// where values span orders of magnitude, else linear.
struct Colouring {
  ColourMap colours;
  float none_below;  ///< what lies below has no colour
};

Colouring colouring_of(const Raster& raster, bool whole_numbers) {
  const float lowest = -std::numeric_limits<float>::infinity();
  const ColourMap sequential("sequential"), diverging("diverging");
  const auto sorted = some_values(raster);
  if (sorted.empty()) return {sequential.spread_over({0.0F, 1.0F}), lowest};
  double low = quantile(sorted, 0.005), high = quantile(sorted, 0.995);
  if (!(high > low)) {  // all but a few are the same
    low = sorted.front();
    high = sorted.back();
  }
  if (!(high > low)) high = low + std::max(1.0, std::abs(low) * 0.1);
  if (whole_numbers) {
    constexpr float kMostSteps = 12.0F;
    std::vector<float> stops = linear_stops(low, high, 9);
    if (sorted.back() - sorted.front() <= kMostSteps) {
      stops.clear();
      for (float step = sorted.front(); step <= sorted.back(); step += 1.0F) stops.push_back(step);
      if (stops.size() < 2) stops.push_back(stops.front() + 1.0F);
    }
    // Where most have none, none has no colour.
    const bool few = sorted.front() == 0.0F && quantile(sorted, 0.5) == 0.0F && stops.size() > 2;
    if (few) stops.erase(stops.begin());
    return {sequential.spread_over(stops), few ? 1.0F : lowest};
  }
  if (low < 0.0 && high > 0.0 && std::min(-low, high) > 0.1 * std::max(-low, high)) {
    const auto half = linear_stops(0.0, std::max(-low, high), 5);
    std::vector<float> stops;
    for (auto at = half.rbegin(); at != half.rend(); ++at) {
      if (*at > 0.0F) stops.push_back(-*at);
    }
    stops.insert(stops.end(), half.begin(), half.end());
    return {diverging.spread_over(stops), lowest};
  }
  const auto positive = std::upper_bound(sorted.begin(), sorted.end(), 0.0F);
  if (low >= 0.0 && positive != sorted.end()) {
    const std::vector<float> some(positive, sorted.end());
    const double typical = quantile(some, 0.5), top = quantile(some, 0.995);
    if (top > 30.0 * typical) {
      const double bottom = std::max<double>(quantile(some, 0.05), top * 1e-6);
      return {sequential.spread_over(logarithmic_stops(bottom, top)),
              std::numeric_limits<float>::min()};
    }
  }
  // Where much of the map has nothing (no lake, no slope of the sea), nothing has no colour.
  constexpr double kMuch = 0.2;
  if (low == 0.0 && positive != sorted.end() && sorted.front() == 0.0F &&
      quantile(sorted, kMuch) == 0.0F) {
    const double top = quantile({positive, sorted.end()}, 0.995);
    return {sequential.spread_over(linear_stops(0.0, top, 9)), std::numeric_limits<float>::min()};
  }
  return {sequential.spread_over(linear_stops(low, high, 9)), lowest};
}

Rgb paper(const MapBase& base, int x, int y) {
  return mix(kPaleSea, kPaleLand, base.land_cover.at(x, y));
}

/// Colours `tint(x, y)` under the light, which shows on land, and the coast over them.
template <class Tint>
void paint_shaded(const MapBase& base, MapCanvas& canvas, float light, const Tint& tint) {
  canvas.paint_rows([&](int y, ColourRow& row) {
    for (int x = 0; x < base.shade.width; ++x) {
      row.set(x, tint(x, y), light * base.land_cover.at(x, y));
    }
    shade(row, base, y);
    draw_coast(row, base, y, 0.6F);
  });
}

void draw_continuous(const FieldSpec& spec, const Scene& scene, MapCanvas& canvas) {
  Raster raster;
  if (kind_of(spec) == FieldKind::steps) {
    raster = nearest(scene.frame, scene.state, spec);
  } else {
    with_values(scene.state, spec, [&](const auto& value) {
      raster = sample_mean(scene.frame, Filter::linear, value);
    });
  }
  const Colouring colouring = colouring_of(raster, kind_of(spec) == FieldKind::steps);
  const MapBase& base = scene.base;
  paint_shaded(base, canvas, 0.22F, [&](int x, int y) {
    const float value = raster.at(x, y);
    const bool there = value == value && value >= colouring.none_below;
    return there ? colouring.colours.smooth(value) : paper(base, x, y);
  });
  canvas.frame();
  const std::array<const ColourMap*, 1> maps{&colouring.colours};
  canvas.colour_bar(maps, false);
}

// Okabe and Ito's colours, which the colour-blind tell apart, for categories without a map of their
// own.
constexpr std::array kDistinct{"#e6e6e6", "#0072b2", "#e69f00", "#009e73", "#cc79a7",
                               "#56b4e9", "#d55e00", "#f0e442", "#4d4d4d", "#999999"};

void draw_flags(const FieldSpec& spec, const Scene& scene, MapCanvas& canvas) {
  const auto items = category_colours(spec);
  const auto held = scene.state.values(spec);
  const auto* bytes = std::get_if<std::vector<std::int8_t>>(&*held);
  const Raster category = bytes != nullptr ? sample_majority(scene.frame, *bytes)
                                           : nearest(scene.frame, scene.state, spec);
  const MapBase& base = scene.base;
  paint_shaded(base, canvas, 0.3F, [&](int x, int y) {
    const auto at = std::find_if(items.begin(), items.end(), [&](const auto& item) {
      return static_cast<float>(item.second->value) == category.at(x, y);
    });
    return at != items.end() ? at->first : paper(base, x, y);
  });
  canvas.frame();
  std::vector<std::pair<Rgb, std::string>> legend;
  for (const auto& [rgb, flag] : items) {
    std::string name(flag->meaning);
    std::replace(name.begin(), name.end(), '_', ' ');
    legend.emplace_back(rgb, name);
  }
  canvas.category_legend(legend);
}

// A colour for each number, far from those of the numbers next to it.
Rgb colour_of_number(int number) {
  const ColourMap tints("plates");
  const auto& stops = tints.stops();
  const auto scattered = static_cast<std::uint32_t>(number) * 2654435761U;
  const Rgb tint = stops[(scattered >> 16U) % stops.size()].colour;
  const float depth = 0.75F + 0.25F * static_cast<float>((scattered >> 8U) % 8U) / 7.0F;
  return mix(kInk, tint, depth);
}

void draw_areas(const FieldSpec& spec, const Scene& scene, MapCanvas& canvas) {
  const Raster number = nearest(scene.frame, scene.state, spec);
  const MapBase& base = scene.base;
  // 0 is the sea or no lake; plates count from it.
  const int first = spec.name == "plate_id" ? 0 : 1;
  std::set<int> seen;
  int last = std::numeric_limits<int>::min();
  Rgb colour{};
  paint_shaded(base, canvas, 0.3F, [&](int x, int y) {
    const float value = number.at(x, y);
    Rgb here = paper(base, x, y);
    if (value >= static_cast<float>(first)) {
      if (static_cast<int>(value) != last)
        colour = colour_of_number(last = static_cast<int>(value));
      seen.insert(last);
      here = colour;
    }
    return here;
  });
  canvas.frame();
  canvas.remark(seen.empty() ? "none on this map"
                             : label_of(static_cast<double>(seen.size())) +
                                   " areas on this map, each in a tint; tints repeat");
}

}  // namespace

std::vector<std::pair<Rgb, const Flag*>> category_colours(const FieldSpec& spec) {
  std::vector<std::pair<Rgb, const Flag*>> items;
  const bool has_own = spec.name == "boundary_type" || spec.name == "biome" ||
                       spec.name == "koppen_class" || spec.name == "rock_type";
  const std::optional<ColourMap> own =
      has_own ? std::make_optional<ColourMap>(spec.name) : std::nullopt;
  for (const Flag& flag : spec.flags) {
    const auto* stop = own ? own->category(flag.value) : nullptr;
    items.emplace_back(
        stop != nullptr ? stop->colour : parse_colour(kDistinct[items.size() % kDistinct.size()]),
        &flag);
  }
  return items;
}

FieldKind kind_of(const FieldSpec& spec) {
  if (spec.name == "elevation" || spec.name == "crust_elevation") return FieldKind::relief;
  if (!spec.flags.empty()) return FieldKind::categories;
  if (spec.name.ends_with("_id")) return FieldKind::areas;
  return spec.type == Type::float32 || spec.type == Type::float64 ? FieldKind::continuous
                                                                  : FieldKind::steps;
}

std::string title_of(const FieldSpec& spec) {
  std::string title(spec.name);
  std::replace(title.begin(), title.end(), '_', ' ');
  if (title.ends_with(" id")) title.replace(title.size() - 3, 3, "s");
  title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
  return title;
}

std::string units_on_map(const FieldSpec& spec) {
  if (spec.name == "elevation") return "metres above and below sea level";
  return std::string(shown_unit(spec).shown);
}

void draw_any_field(const FieldSpec& spec, const Scene& scene, MapCanvas& canvas) {
  const auto same = [&](const auto& map) { return map.field->name == spec.name; };
  const auto known = std::find_if(field_maps().begin(), field_maps().end(), same);
  const auto classes = std::find_if(category_maps().begin(), category_maps().end(), same);
  if (known != field_maps().end()) {
    FieldMap map = *known;
    if (map.extent == Extent::ocean_floor) map.extent = Extent::everywhere;
    draw_field(map, scene, canvas);
  } else if (classes != category_maps().end()) {
    draw_categories(*classes, scene, canvas);
  } else {
    switch (kind_of(spec)) {
      case FieldKind::relief:
        // Islands bear their contours and rivers.
        (scene.state.grid().is_projected() ? draw_island : draw_elevation)(scene, canvas);
        break;
      case FieldKind::categories:
        draw_flags(spec, scene, canvas);
        break;
      case FieldKind::areas:
        draw_areas(spec, scene, canvas);
        break;
      case FieldKind::steps:
      case FieldKind::continuous:
        draw_continuous(spec, scene, canvas);
        break;
    }
  }
}

std::function<Rgb(float)> tints_of(const FieldSpec& spec, std::span<const float> some) {
  if (kind_of(spec) == FieldKind::relief) {
    return [land = ColourMap("land_elevation"), sea = ColourMap("sea_depth")](float value) {
      return value < 0.0F ? sea.smooth(value) : land.smooth(value);
    };
  }
  if (kind_of(spec) == FieldKind::categories) {
    return [items = category_colours(spec)](float value) {
      const auto at = std::find_if(items.begin(), items.end(), [&](const auto& item) {
        return static_cast<float>(item.second->value) == value;
      });
      return at != items.end() ? at->first : kPaleLand;
    };
  }
  const auto known =
      std::find_if(field_maps().begin(), field_maps().end(),
                   [&](const FieldMap& map) { return map.field->name == spec.name; });
  if (known != field_maps().end()) {
    return [colours = ColourMap(known->colours), scale = known->scale](float value) {
      return std::isnan(value) ? kPaleLand : colours.smooth(scale * value);
    };
  }
  Raster raster;
  raster.values.assign(some.begin(), some.end());
  return [colouring = colouring_of(raster, kind_of(spec) == FieldKind::steps)](float value) {
    const bool there = !std::isnan(value) && value >= colouring.none_below;
    return there ? colouring.colours.smooth(value) : kPaleLand;
  };
}

}  // namespace geo::io
