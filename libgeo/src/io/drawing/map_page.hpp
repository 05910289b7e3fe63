#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/projection.hpp"
#include "geo/io/drawing/map_view.hpp"
#include "geo/io/maps/maps.hpp"

namespace geo::io {

/// A point of a map, pixels from its upper left corner.
struct PagePoint {
  double x, y;
};
/// Pieces of a line on a map.
using PageLines = std::vector<std::vector<PagePoint>>;

/// Where places of a planet lie on a map: the page's size, its projection, its edge.
class MapPage {
 public:
  /// Throws ConfigurationError for a view that the grid does not allow.
  MapPage(const Grid& grid, const MapView& view);

  [[nodiscard]] const Grid& grid() const { return *grid_; }
  [[nodiscard]] const MapLayout& layout() const { return layout_; }
  /// Whether columns and rows of pixels run along those of the grid: then no projection is needed.
  [[nodiscard]] bool is_aligned() const { return definition_.empty(); }
  /// Whether meridians and parallels are straight lines along the edges of the page.
  [[nodiscard]] bool is_cylindrical() const { return form_ == Form::cylindrical; }
  [[nodiscard]] bool is_azimuthal() const { return form_ == Form::azimuthal; }
  [[nodiscard]] bool is_polar() const;
  /// Degrees from the middle of an azimuthal map to its edge, as far as a box does not cut it.
  [[nodiscard]] double reach_deg() const { return reach_deg_; }
  /// Middle of the projection.
  [[nodiscard]] Centre centre() const { return centre_; }
  /// What is shown, longitudes on from those of the centre (±180 at most where the map is cut
  /// there).
  [[nodiscard]] const Window& region() const { return region_; }

  /// Computes places and points; one for each thread. Needs geographic cells.
  class Projector {
   public:
    explicit Projector(const MapPage& page);
    ~Projector();
    Projector(Projector&&) noexcept;

    /// Nothing where the map does not show the place.
    [[nodiscard]] std::optional<PagePoint> point_of(Centre place) const;
    /// The same `east_deg` from the middle of the map; -180 and 180 are its two edges.
    [[nodiscard]] std::optional<PagePoint> point_east_of_centre(double east_deg,
                                                                double latitude_deg) const;
    /// Nothing beyond the edge of the map.
    [[nodiscard]] std::optional<Centre> place_of(PagePoint point) const;
    /// The line through places in order, lifted where it is not shown and where the map is cut.
    [[nodiscard]] PageLines line_through(const std::vector<Centre>& places) const;

   private:
    friend class MapPage;
    struct Engine;
    [[nodiscard]] std::optional<PagePoint> forward(double east_deg, double latitude_deg) const;
    const MapPage* page_;
    std::unique_ptr<Engine> engine_;
    std::unique_ptr<EqualAreaProjection> plane_;
  };

  /// The edge of what is shown.
  [[nodiscard]] const PageLines& edge() const { return edge_; }

 private:
  enum class Form { cylindrical, pseudocylindrical, azimuthal, plane };

  void set_region(const MapView& view);
  void crop(const Window& box);
  void set_centre(const MapView& view, bool whole);
  void turn_to_centre();
  void trace_edge();
  void set_layout(int width_px, double height_over_width);
  [[nodiscard]] bool holds(double east_deg, double latitude_deg) const;

  const Grid* grid_;
  MapLayout layout_{};
  Form form_ = Form::plane;
  std::string definition_;  // for PROJ; empty where the page is aligned
  Centre centre_;
  Window region_{};
  double reach_deg_ = 180.0;  // from the centre of an azimuthal map to its edge
  double left_ = 0.0, top_ = 0.0, px_per_unit_ = 1.0;
  PageLines edge_;
};

}  // namespace geo::io
