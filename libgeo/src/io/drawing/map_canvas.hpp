#pragma once

#include <cairo.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geo/io/drawing/chart_painter.hpp"
#include "geo/io/maps/maps.hpp"
#include "map_colours.hpp"
#include "map_page.hpp"
#include "map_raster.hpp"

namespace geo::io {

/// A sheet of paper with Cairo's pen: pixels, lines and type.
class Canvas {
 public:
  Canvas(int width_px, int height_px);

  [[nodiscard]] cairo_t* pen() const { return pen_.get(); }
  /// Sets pixels from (x, y) on.
  void set_pixels(int x, int y, const ColourRow& row);
  /// Pixels were set; tells Cairo before it draws on.
  void pixels_done();
  void colour(Rgb colour, double alpha = 1.0);
  void rectangle(double x, double y, double width, double height);

  void font(double size_px, bool bold = false);
  [[nodiscard]] double text_width(const std::string& text) const;
  /// Text whose baseline is at y.
  void text(double x, double y, const std::string& text, Align align = Align::left);

  void save(const std::filesystem::path& path) const;

 private:
  struct Destroy {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* pen) const { cairo_destroy(pen); }
  };
  std::unique_ptr<cairo_surface_t, Destroy> surface_;
  std::unique_ptr<cairo_t, Destroy> pen_;
  std::uint32_t* pixels_ = nullptr;  // 0x00RRGGBB, the surface's own
  std::size_t pixels_per_row_ = 0;
};

/// A canvas with a map in its frame.
class MapCanvas : public Canvas {
 public:
  explicit MapCanvas(const MapFrame& frame);

  /// Sets the pixels of the map: `fill(y, row)` gives the colours of a row.
  template <class Fill>
  void paint_rows(const Fill& fill) {
    ColourRow row(layout_.map_width);
    for (int y = 0; y < layout_.map_height; ++y) {
      fill(y, row);
      clear_beyond_edge(y, row);
      set_pixels(layout_.map_left, layout_.map_top + y, row);
    }
    pixels_done();
  }
  /// Runs `draw` with the origin at the map's upper left corner, clipped to the map.
  template <class Draw>
  void inside(const Draw& draw) {
    cairo_save(pen());
    cairo_translate(pen(), layout_.map_left, layout_.map_top);
    rectangle(0, 0, layout_.map_width, layout_.map_height);
    cairo_clip(pen());
    draw();
    cairo_restore(pen());
  }
  /// Title, units beside it, remark at the right.
  void title(const std::string& title, const std::string& units, std::string_view note);
  /// Graticule or kilometre ticks with labels, scale bar where one scale holds, border.
  void frame();
  /// Strokes lines of the map, as they stand in its pixels.
  void stroke(const PageLines& lines);
  /// Text with a pale edge, to be read on any ground; over lines the edge is solid.
  void text_on_map(double x, double y, const std::string& text, Align align, Rgb rgb,
                   double edge_alpha = 0.75);

  /// Colour bar below the map: the stops of the colour maps one after the other, equally wide.
  void colour_bar(std::span<const ColourMap* const> maps, bool classed);
  /// Swatches and names of categories below the map.
  void category_legend(const std::vector<std::pair<Rgb, std::string>>& items);
  /// A line of words below the map.
  void remark(const std::string& words);
  /// Lines of several widths (px at unit 1) and swatches of areas, with labels, below the map.
  void line_legend(Rgb colour, const std::vector<std::pair<double, std::string>>& lines,
                   const std::vector<std::pair<Rgb, std::string>>& areas);

  /// Size of type and lines relative to a map 1800 px wide.
  [[nodiscard]] double unit() const { return unit_; }
  [[nodiscard]] const MapLayout& layout() const { return layout_; }

 private:
  /// Leaves the paper white where the map shows nothing.
  void clear_beyond_edge(int y, ColourRow& row) const;
  void straight_graticule();
  void curved_graticule();
  void label_curved_graticule(double step_deg);
  void label_polar_graticule(double step_deg);
  void label_azimuthal_graticule(double step_deg);
  void label_parallels(double step_deg);
  void label_meridians(double step_deg);
  void label_line(std::optional<PagePoint> at, const std::string& label);
  void kilometre_ticks();
  void scale_bar();
  /// Whether the edge of what is shown runs through a box that ends `above` the map's lower edge.
  [[nodiscard]] bool crosses_edge(double left, double width, double height, double above) const;

  const MapFrame* frame_;
  const MapPage* page_;
  MapLayout layout_;
  double unit_;
};

/// Creates a folder and those above it; throws IoError.
void make_folder(const std::filesystem::path& folder);

/// Size of type and lines of a map of that width, relative to one of 1800 px.
double map_unit(int map_width_px);

/// The largest of 1, 2, 2.5, 5 times a power of ten that is at most `value`.
double round_down_nicely(double value);

/// "−50", "0.25", "4000", "11 000", "2·10⁻⁵": a number for a label, without trailing zeros.
std::string label_of(double value);

}  // namespace geo::io
