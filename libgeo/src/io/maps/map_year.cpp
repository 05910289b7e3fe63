#include "map_year.hpp"

#include <string>

#include "io/drawing/map_canvas.hpp"
#include "io/drawing/map_colours.hpp"

namespace geo::io {
namespace {

constexpr int kColumns = 4, kPanel_px = 340, kGap_px = 14, kMargin_px = 40, kName_px = 26;
constexpr int kTop_px = 70, kLegend_px = 60;

/// Where the panels of one quantity stand, four beside each other.
struct Block {
  int left, top, width, height;  ///< of one panel: width, height

  [[nodiscard]] int x(int month) const { return left + month % kColumns * (width + kGap_px); }
  [[nodiscard]] int y(int month) const {
    return top + month / kColumns * (height + kName_px) + kName_px;
  }
  [[nodiscard]] int right() const { return left + kColumns * (width + kGap_px) - kGap_px; }
  [[nodiscard]] int bottom() const {
    return top + Climatology::kMonths / kColumns * (height + kName_px);
  }
};

/// Whether a cell and the one to its east or south lie on two sides of a shore.
bool at_shore(std::span<const float> elevation_m, const Thinning& cells, int i, int j) {
  const auto land = [&](int column, int row) {
    return elevation_m[static_cast<std::size_t>(row) * cells.nx + column % cells.nx] >= 0.0F;
  };
  return land(i, j) != land(i + 1, j) || (j > 0 && land(i, j) != land(i, j - 1));
}

/// One month; north is up. Each pixel shows the cell at its middle.
void paint_month(Canvas& canvas, const Block& block, int month, const std::vector<float>& values,
                 float scale, const ColourMap& colours, std::span<const float> elevation_m,
                 const Thinning& cells) {
  ColourRow row(block.width);
  for (int y = 0; y < block.height; ++y) {
    const int j = (2 * (block.height - 1 - y) + 1) * cells.ny / (2 * block.height);
    for (int x = 0; x < block.width; ++x) {
      const int i = (2 * x + 1) * cells.nx / (2 * block.width);
      const float value = scale * values[static_cast<std::size_t>(j) * cells.nx + i];
      const Rgb tint = colours.classed(colours.position(value), 0.0F);
      const bool shore = at_shore(elevation_m, cells, i, j);
      row.set(x, shore ? mix(tint, kInk, 0.7F) : tint);
    }
    canvas.set_pixels(block.x(month), block.y(month) + y, row);
  }
}

/// The classes of a colour map side by side with the values between them.
void legend(Canvas& canvas, const Block& block, const ColourMap& colours, float scale) {
  const auto& stops = colours.stops();
  const int classes = static_cast<int>(stops.size()) - 1;
  const double width = static_cast<double>(block.right() - block.left) / classes;
  const double top = block.bottom() + 18;
  canvas.font(14);
  for (int k = 0; k < classes; ++k) {
    canvas.colour(colours.class_colour(k));
    canvas.rectangle(block.left + k * width, top, width, 12);
    cairo_fill(canvas.pen());
    canvas.colour(kInk);
    if (k > 0) {
      canvas.text(block.left + k * width, top + 30, label_of(stops[k].value / scale),
                  Align::centre);
    }
  }
}

}  // namespace

MapFile draw_year_file(const PlanetMonths& months, std::span<const float> elevation_m,
                       const std::filesystem::path& folder, std::string_view note) {
  make_folder(folder);
  const int height = kPanel_px / 2;
  const int block_height = Climatology::kMonths / kColumns * (height + kName_px);
  const Block warmth{kMargin_px, kTop_px + 30, kPanel_px, height};
  const Block rain{kMargin_px, warmth.top + block_height + kLegend_px + 50, kPanel_px, height};
  const int width_px = warmth.right() + kMargin_px, height_px = rain.bottom() + kLegend_px + 10;
  Canvas canvas(width_px, height_px);
  const ColourMap degrees("temperature"), millimetres("precipitation");
  for (int m = 0; m < Climatology::kMonths; ++m) {
    paint_month(canvas, warmth, m, months.temperature_c[m], 1.0F, degrees, elevation_m,
                months.cells);
    paint_month(canvas, rain, m, months.precipitation_mm[m], kRainOfAYear, millimetres, elevation_m,
                months.cells);
  }
  canvas.pixels_done();
  canvas.colour(kInk);
  canvas.font(30, true);
  canvas.text(kMargin_px, 46, "The year");
  canvas.font(18);
  canvas.text(width_px - kMargin_px, 46, std::string(note), Align::right);
  for (const auto& [block, title] : {std::pair(warmth, "Temperature near the surface, °C"),
                                     std::pair(rain, "Precipitation, mm per month")}) {
    canvas.font(20, true);
    canvas.text(block.left, block.top - 6, title);
    canvas.font(16);
    for (int m = 0; m < Climatology::kMonths; ++m) {
      canvas.text(block.x(m), block.y(m) - 7, kMonthNames[m]);
    }
  }
  legend(canvas, warmth, degrees, 1.0F);
  legend(canvas, rain, millimetres, kRainOfAYear);
  const auto path = folder / "year.png";
  canvas.save(path);
  return {path, "The year", "Temperature and precipitation of each month.", width_px, height_px};
}

}  // namespace geo::io
