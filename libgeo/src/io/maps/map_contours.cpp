#include "map_contours.hpp"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges2D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStripper.h>

#include <algorithm>
#include <cmath>

namespace geo::io {
namespace {

constexpr Rgb kContour{0.40F, 0.27F, 0.15F};
constexpr double kLines = 14.0;  // about so many between sea level and the highest ground
constexpr int kIndexLine = 5;    // every fifth is heavier
constexpr double kType = 18.0;   // of the heights on them, px

// Points of a line that lie nearer to the one before are left out: no eye sees them.
constexpr double kStepPx = 1.2;

void set_font(MapCanvas& canvas) { canvas.font(kType * canvas.unit(), true); }

/// The lines of one height on a raster, pixels from its upper left corner.
PageLines contour(const Raster& height_m, double level_m) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(height_m.width, height_m.height, 1);
  image->SetOrigin(0.5, 0.5, 0.0);
  vtkNew<vtkFloatArray> values;
  // VTK reads only.
  values->SetArray(const_cast<float*>(height_m.values.data()),
                   static_cast<vtkIdType>(height_m.values.size()), 1);
  image->GetPointData()->SetScalars(values);
  vtkNew<vtkFlyingEdges2D> edges;
  edges->SetInputData(image);
  edges->ComputeScalarsOff();
  edges->SetValue(0, level_m);
  vtkNew<vtkStripper> joined;
  joined->SetInputConnection(edges->GetOutputPort());
  joined->JoinContiguousSegmentsOn();
  joined->Update();
  vtkPolyData* const lines = joined->GetOutput();
  PageLines out;
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  for (auto* cells = lines->GetLines(); cells->GetNextCell(count, ids) != 0;) {
    auto& line = out.emplace_back();
    for (vtkIdType i = 0; i < count; ++i) {
      const double* const point = lines->GetPoint(ids[i]);
      const bool near = i > 0 && i + 1 < count &&
                        std::hypot(point[0] - line.back().x, point[1] - line.back().y) < kStepPx;
      if (!near) line.push_back({point[0], point[1]});
    }
  }
  return out;
}

/// Finds where heights stand along index contours: apart from each other, upright.
class Places {
 public:
  explicit Places(MapCanvas& canvas) : canvas_(canvas) { set_font(canvas); }

  void label(const std::vector<PagePoint>& line, const std::string& text) {
    const double width = canvas_.text_width(text) + 8 * canvas_.unit();
    const auto best = straightest(line, width);
    if (!best) return;
    double angle = std::atan2(best->down, best->right);
    if (std::cos(angle) < 0.0) angle += M_PI;
    labels_.push_back({best->middle, angle, text});
  }
  [[nodiscard]] std::vector<ContourLabel> take() { return std::move(labels_); }

 private:
  struct Stretch {
    PagePoint middle;
    double right, down;
  };

  [[nodiscard]] bool is_free(const PagePoint& at, double width) const {
    const double edge = 1.2 * width;
    if (at.x < edge || at.y < edge || at.x > canvas_.layout().map_width - edge ||
        at.y > canvas_.layout().map_height - edge) {
      return false;
    }
    return std::none_of(labels_.begin(), labels_.end(), [&](const ContourLabel& other) {
      return std::hypot(at.x - other.middle.x, at.y - other.middle.y) < 170 * canvas_.unit();
    });
  }

  // The piece as long as the text whose ends lie farthest apart; of long lines only.
  [[nodiscard]] std::optional<Stretch> straightest(const std::vector<PagePoint>& line,
                                                   double width) const {
    std::vector<double> along(line.size(), 0.0);
    for (std::size_t i = 1; i < line.size(); ++i) {
      along[i] = along[i - 1] + std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y);
    }
    if (line.empty() || along.back() < 5.0 * width) return {};
    std::optional<Stretch> best;
    double most = 0.85;
    for (std::size_t i = 0, j = 0; i < line.size(); i += 4) {
      while (j < line.size() && along[j] - along[i] < width) ++j;
      if (j == line.size()) break;
      const PagePoint& middle = line[(i + j) / 2];
      const double right = line[j].x - line[i].x, down = line[j].y - line[i].y;
      const double straight = std::hypot(right, down) / (along[j] - along[i]);
      if (straight <= most || !is_free(middle, width)) continue;
      most = straight;
      best = Stretch{middle, right, down};
    }
    return best;
  }

  MapCanvas& canvas_;
  std::vector<ContourLabel> labels_;
};

}  // namespace

std::vector<ContourLabel> draw_contours(MapCanvas& canvas, const MapFrame& frame,
                                        std::span<const float> elevation_m) {
  const Raster height = sample_mean(frame, Filter::smooth, [&](Index i) { return elevation_m[i]; });
  float highest = 0.0F;
  for (const float value : height.values) highest = std::max(highest, value);
  if (highest < 1.0F) return {};
  const double step = round_down_nicely(highest / kLines);
  Places places(canvas);
  canvas.inside([&] {
    cairo_set_line_join(canvas.pen(), CAIRO_LINE_JOIN_ROUND);
    for (int k = 1; k * step < highest; ++k) {
      const bool index = k % kIndexLine == 0;
      const PageLines lines = contour(height, k * step);
      canvas.colour(kContour, index ? 0.75 : 0.45);
      cairo_set_line_width(canvas.pen(), (index ? 1.2 : 0.7) * canvas.unit());
      canvas.stroke(lines);
      if (!index) continue;
      for (const auto& line : lines) places.label(line, label_of(k * step));
    }
  });
  return places.take();
}

void draw_contour_labels(MapCanvas& canvas, std::span<const ContourLabel> labels) {
  set_font(canvas);
  canvas.inside([&] {
    cairo_t* pen = canvas.pen();
    for (const ContourLabel& label : labels) {
      cairo_save(pen);
      cairo_translate(pen, label.middle.x, label.middle.y);
      cairo_rotate(pen, label.angle);
      canvas.text_on_map(0.0, 0.36 * kType * canvas.unit(), label.text, Align::centre, kContour,
                         1.0);
      cairo_restore(pen);
    }
  });
}

}  // namespace geo::io
