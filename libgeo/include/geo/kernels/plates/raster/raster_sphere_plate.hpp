#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "geo/kernels/numerics/quaternion.hpp"
#include "geo/kernels/plates/raster/raster_plate.hpp"
#include "geo/kernels/plates/sphere/sphere_mesh.hpp"

namespace geo {

/// A lattice in pages of samples that lie together, so that a plate stores only the pages where it
/// has crust.
class LatticePages {
 public:
  explicit LatticePages(const SphereMesh& mesh);
  LatticePages(const LatticePages&) = delete;  // its mesh knows its lattice
  LatticePages& operator=(const LatticePages&) = delete;

  [[nodiscard]] const SphereMesh& mesh() const { return *mesh_; }
  [[nodiscard]] int count() const { return coarse_.size(); }
  /// The lattice of the pages' middles; pages are what is nearest to them.
  [[nodiscard]] const FibonacciSphere& middles() const { return coarse_; }
  /// Calls `tell` with pages whose middle is so near to a unit vector that they may hold what is as
  /// far from it as any page reaches from its own; `nearest` is the nearest middle.
  template <class Tell>
  void pages_about(const Vector3& unit, std::int32_t nearest, Tell&& tell) const {
    for (std::int32_t k = about_first_[nearest]; k < about_first_[nearest + 1]; ++k) {
      if (dot(coarse_.position(about_[k]), unit) > cos_about_) tell(about_[k]);
    }
  }
  /// The middle nearest to a unit vector, from one that is not far from it.
  [[nodiscard]] std::int32_t nearest_middle(const Vector3& unit, std::int32_t from) const {
    return nearest_in(coarse_mesh_, cos_middle_, unit, from);
  }
  [[nodiscard]] int page(std::int32_t sample) const { return page_[sample]; }
  [[nodiscard]] int slot(std::int32_t sample) const { return slot_[sample]; }
  [[nodiscard]] std::span<const std::int32_t> samples(int page) const {
    return std::span(order_).subspan(first_[page], first_[page + 1] - first_[page]);
  }
  /// The sample nearest to a unit vector, from one that is not far from it.
  [[nodiscard]] std::int32_t nearest(const Vector3& unit, std::int32_t from) const {
    return nearest_in(*mesh_, cos_inner_, unit, from);
  }

 private:
  void list_pages_about(double distance);
  /// Whatever is nearer than half of the least distance between two samples is nearest.
  static std::int32_t nearest_in(const SphereMesh& mesh, double cos_inner, const Vector3& unit,
                                 std::int32_t from);
  const SphereMesh* mesh_;
  FibonacciSphere coarse_;
  SphereMesh coarse_mesh_;
  double cos_inner_, cos_middle_;  ///< of half the least distances
  double cos_about_ = 1.0;         ///< of twice the reach of a page from its middle
  std::vector<std::int32_t> about_first_, about_;
  std::vector<std::int32_t> page_, first_, order_;
  std::vector<std::int16_t> slot_;
};

/// A plate of a sphere: a height map on a lattice of its own, which turns as a rigid body. Crust
/// stays at its sample.
class RasterSpherePlate {
 public:
  explicit RasterSpherePlate(const LatticePages& pages)
      : pages_(&pages), base_(pages.count(), -1), empty_(pages.count(), 0), over_(pages.count()) {
    std::iota(over_.begin(), over_.end(), 0);
  }

  Quaternion turn;     ///< from the plate's lattice to the world's
  Vector3 rotation{};  ///< radians per step, in the world's frame
  Vector3 centre{};    ///< unit vector, in the plate's frame
  double curve = 0.0;  ///< turn of the path about the centre, radians per step
  double mass = 0.0;   ///< sum of heights, kept up to date
  bool alive = true;

  struct Cell {
    RasterCrust crust;
    std::int32_t continent = -1;  ///< as of the last look, or -1
  };

  /// Moves on by a step.
  void move();
  /// Speed of the centre, radians per step.
  [[nodiscard]] double speed() const {
    return length(cross(rotation, times(turn.matrix(), centre)));
  }

  [[nodiscard]] const RasterCrust& crust(std::int32_t sample) const;
  [[nodiscard]] std::int32_t continent(std::int32_t sample) const;
  [[nodiscard]] std::int32_t continent_area(std::int32_t continent) const {
    return continent < 0 ? 0 : area_[continent];
  }
  void set(std::int32_t sample, const RasterCrust& crust);
  /// Whether all of a page has crust.
  [[nodiscard]] bool is_full(std::int32_t page) const {
    return base_[page] >= 0 && empty_[page] == 0;
  }
  /// Pages that hold anything, in order, and the cells of one of them, by slot.
  [[nodiscard]] std::span<const std::int32_t> open_pages() const { return open_; }
  [[nodiscard]] std::span<Cell> cells(int page) {
    return std::span(cells_).subspan(base_[page], pages_->samples(page).size());
  }
  [[nodiscard]] std::span<const Cell> cells(int page) const {
    return std::span(cells_).subspan(base_[page], pages_->samples(page).size());
  }

  /// The page of the world whose middle is nearest to a place, at which one of its pages lies now.
  [[nodiscard]] std::int32_t lies_over(std::int32_t page, const Vector3& place) {
    return over_[page] = pages_->nearest_middle(place, over_[page]);
  }

  /// Levels land: a lower neighbour takes a part of the step down to it, never below sea level, so
  /// that height spreads as far as by `strength` / 4 on a square lattice. Returns what rounding has
  /// added to the crust.
  double erode(double strength);
  /// Drops empty pages and counts the mass anew; without crust the plate is no more.
  void tighten();
  /// Finds continents, connected land, anew if land has come or gone and `steps` calls have passed.
  void find_continents(int steps);
  /// Takes all crust of a continent away; returns its cells and what they held.
  [[nodiscard]] std::vector<std::pair<std::int32_t, RasterCrust>> take_continent(
      std::int32_t continent);
  void forget_continents() { continents_known_ = false; }

 private:
  [[nodiscard]] Cell* find(std::int32_t sample) {
    const std::int32_t base = base_[pages_->page(sample)];
    return base < 0 ? nullptr : &cells_[base + pages_->slot(sample)];
  }
  [[nodiscard]] const Cell* find(std::int32_t sample) const {
    const std::int32_t base = base_[pages_->page(sample)];
    return base < 0 ? nullptr : &cells_[base + pages_->slot(sample)];
  }

  const LatticePages* pages_;
  std::vector<std::int32_t> base_;   ///< of each page, or -1
  std::vector<std::int32_t> empty_;  ///< cells of each open page without crust
  std::vector<std::int32_t> over_;   ///< page of the world at which each was last
  std::vector<std::int32_t> open_;
  std::vector<Cell> cells_;
  std::vector<std::int32_t> area_;
  bool continents_known_ = false, land_changed_ = false;
  int continents_age_ = 0;
};

}  // namespace geo
