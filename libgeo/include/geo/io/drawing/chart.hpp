#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace geo::io {

/// What the colour of a line stands for; each kind of file has its own shade of it.
enum class Hue { ink, grey, red, blue };
enum class Stroke { line, dashed, dots };

/// One line of a chart. Points where x or y is not finite break it.
struct Series {
  std::string name;  ///< in the legend; empty: not listed
  std::vector<double> x, y;
  Hue hue = Hue::ink;
  Stroke stroke = Stroke::line;
};

struct Axis {
  std::string title;
  double low = 0.0, high = 1.0;
  bool logarithmic = false;

  /// Where a value lies between low (0) and high (1).
  [[nodiscard]] double position(double value) const;
  /// Round values from low to high, about as many as asked for.
  [[nodiscard]] std::vector<double> ticks(int about) const;
};

/// A level that a panel marks with a line across and a word.
struct Level {
  double y = 0.0;
  std::string label;
};

struct ChartPanel {
  Axis x, y;
  std::vector<Series> series;
  std::vector<Level> levels;
  double height = 1.0;  ///< relative to the other panels
};

/// Panels one above the other. The legend lists the named series of the first panel.
struct Chart {
  std::string title;
  std::vector<std::string> notes;  ///< lines below the title
  std::vector<ChartPanel> panels;
};

/// An axis over all finite values, with a margin; `logarithmic` needs values above 0.
Axis axis_over(std::string title, const std::vector<std::vector<double>>& values,
               bool logarithmic = false);

/// "−4000", "0.25": a number beside a tick.
std::string tick_label(double value);

/// Draws a chart 1400 pixels wide into a PNG file. Throws IoError.
void write_chart(const std::filesystem::path& path, const Chart& chart);

}  // namespace geo::io
