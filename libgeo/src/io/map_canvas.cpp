#include "map_canvas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "geo/core/error.hpp"
#include "png_file.hpp"

namespace geo::io {

Canvas::Canvas(int width_px, int height_px)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px)),
      pen_(cairo_create(surface_.get())) {
  if (cairo_status(pen_.get()) != CAIRO_STATUS_SUCCESS) {
    throw Bug(fmt::format("cannot make a picture of {} x {} pixels: {}", width_px, height_px,
                          cairo_status_to_string(cairo_status(pen_.get()))));
  }
  colour({1, 1, 1});
  cairo_paint(pen());
  cairo_surface_flush(surface_.get());
}

void Canvas::set_pixel(int x, int y, Rgb colour) {
  const auto byte = [](float part) {
    return static_cast<std::uint32_t>(std::clamp(part, 0.0F, 1.0F) * 255.0F + 0.5F);
  };
  auto* row = cairo_image_surface_get_data(surface_.get()) +
              static_cast<std::ptrdiff_t>(y) * cairo_image_surface_get_stride(surface_.get());
  reinterpret_cast<std::uint32_t*>(row)[x] =
      byte(colour.r) << 16U | byte(colour.g) << 8U | byte(colour.b);
}

void Canvas::pixels_done() { cairo_surface_mark_dirty(surface_.get()); }

void Canvas::colour(Rgb colour, double alpha) {
  cairo_set_source_rgba(pen(), colour.r, colour.g, colour.b, alpha);
}

void Canvas::rectangle(double x, double y, double width, double height) {
  cairo_rectangle(pen(), x, y, width, height);
}

void Canvas::font(double size_px, bool bold) {
  cairo_select_font_face(pen(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(pen(), size_px);
}

double Canvas::text_width(const std::string& text) const {
  cairo_text_extents_t extents;
  cairo_text_extents(pen(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(double x, double y, const std::string& text, Align align) {
  const double shift = align == Align::left ? 0.0 : align == Align::centre ? 0.5 : 1.0;
  cairo_move_to(pen(), x - shift * text_width(text), y);
  cairo_show_text(pen(), text.c_str());
}

void Canvas::save(const std::filesystem::path& path) const {
  cairo_surface_flush(surface_.get());
  write_png(path, {cairo_image_surface_get_data(surface_.get()),
                   cairo_image_surface_get_width(surface_.get()),
                   cairo_image_surface_get_height(surface_.get()),
                   cairo_image_surface_get_stride(surface_.get())});
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError("cannot create folder " + folder.string() + ": " + error.message());
}

double map_unit(int map_width_px) { return std::max(map_width_px / 1800.0, 0.55); }

double round_down_nicely(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  double best = 1.0;
  for (const double step : {2.0, 2.5, 5.0}) {
    if (step * power <= value * (1.0 + 1e-9)) best = step;
  }
  return best * power;
}

std::string label_of(double value) {
  std::string text = fmt::format("{:.4g}", std::abs(value));
  if (std::abs(value) >= 1000.0) text = fmt::format("{:.0f}", std::abs(value));
  if (std::abs(value) >= 10000.0) {
    for (auto at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(at, "\u2009");
  }
  return value < 0.0 ? fmt::format("\u2212{}", text) : text;
}

MapCanvas::MapCanvas(const Grid& grid, const MapLayout& layout)
    : Canvas(layout.width_px, layout.height_px),
      grid_(&grid),
      layout_(layout),
      unit_(map_unit(layout.map_width)) {}

void MapCanvas::title(const std::string& title, const std::string& units, std::string_view note) {
  const double baseline = layout_.map_top - 26 * unit_;
  colour(kInk);
  font(32 * unit_, true);
  text(layout_.map_left, baseline, title);
  const double end = layout_.map_left + text_width(title) + 18 * unit_;
  colour(kFaintInk);
  font(20 * unit_);
  text(end, baseline, units);
  const double units_end = end + text_width(units) + 24 * unit_;
  font(17 * unit_);
  const double right = layout_.map_left + layout_.map_width;
  const std::string remark(note);
  if (units_end + text_width(remark) <= right) text(right, baseline, remark, Align::right);
}

}  // namespace geo::io
