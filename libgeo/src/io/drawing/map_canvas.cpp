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
  pixels_ = reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(surface_.get()));
  pixels_per_row_ = static_cast<std::size_t>(cairo_image_surface_get_stride(surface_.get())) /
                    sizeof(std::uint32_t);
}

void Canvas::set_pixels(int x, int y, const ColourRow& row) {
  const auto byte = [](float part) {
    const float within = part < 0.0F ? 0.0F : part > 1.0F ? 1.0F : part;
    return static_cast<std::int32_t>(within * 255.0F + 0.5F);
  };
  std::uint32_t* const to = pixels_ + static_cast<std::size_t>(y) * pixels_per_row_ + x;
  const float *const r = row.r.data(), *const g = row.g.data(), *const b = row.b.data();
#pragma omp simd
  for (std::size_t i = 0; i < row.r.size(); ++i) {
    to[i] = static_cast<std::uint32_t>(byte(r[i]) << 16 | byte(g[i]) << 8 | byte(b[i]));
  }
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

namespace {

// "10⁻⁵": digits as exponents.
std::string power_of_ten(int exponent) {
  constexpr std::array kDigits{"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                               "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = exponent < 0 ? "10\u207b" : "10";
  for (const char digit : fmt::format("{}", std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

}  // namespace

std::string label_of(double value) {
  const double size = std::abs(value);
  const char* const sign = value < 0.0 ? "\u2212" : "";
  if (size > 0.0 && (size < 1e-3 || size >= 1e7)) {
    const int exponent = static_cast<int>(std::floor(std::log10(size) + 1e-6));
    const std::string factor = fmt::format("{:.3g}", size / std::pow(10.0, exponent));
    const std::string power = power_of_ten(exponent);
    return sign + (factor == "1" ? power : factor + "\u00b7" + power);
  }
  std::string text = size >= 1000.0 ? fmt::format("{:.0f}", size) : fmt::format("{:.4g}", size);
  if (size >= 10000.0) {
    for (auto at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(at, "\u2009");
  }
  return sign + text;
}

MapCanvas::MapCanvas(const MapFrame& frame)
    : Canvas(frame.page().layout().width_px, frame.page().layout().height_px),
      frame_(&frame),
      page_(&frame.page()),
      layout_(frame.page().layout()),
      unit_(map_unit(layout_.map_width)) {}

void MapCanvas::clear_beyond_edge(int y, ColourRow& row) const {
  if (frame_->is_aligned()) return;
  for (int x = 0; x < layout_.map_width; ++x) {
    if (!frame_->shows(x, y)) row.set(x, {1.0F, 1.0F, 1.0F});
  }
}

void MapCanvas::stroke(const PageLines& lines) {
  for (const auto& line : lines) {
    cairo_new_sub_path(pen());
    for (const PagePoint& point : line) cairo_line_to(pen(), point.x, point.y);
  }
  cairo_stroke(pen());
}

void MapCanvas::text_on_map(double x, double y, const std::string& text, Align align, Rgb rgb,
                            double edge_alpha) {
  const double shift = align == Align::left ? 0.0 : align == Align::centre ? 0.5 : 1.0;
  cairo_move_to(pen(), x - shift * text_width(text), y);
  cairo_text_path(pen(), text.c_str());
  colour({1, 1, 1}, edge_alpha);
  cairo_set_line_width(pen(), (edge_alpha < 1.0 ? 3.5 : 6.0) * unit_);
  cairo_set_line_join(pen(), CAIRO_LINE_JOIN_ROUND);
  cairo_stroke_preserve(pen());
  colour(rgb);
  cairo_fill(pen());
}

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
