#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geo/core/random.hpp"
#include "geo/kernels/plates/raster/raster_rules.hpp"
#include "geo/kernels/plates/raster/raster_sphere_plate.hpp"

namespace geo {

/// Samples of a lattice whose cells are as large as those of a torus map of so many columns, of
/// which the width goes once round the equator: columns^2 / pi, 16 million at most.
[[nodiscard]] std::int32_t raster_samples(int columns);

/// The first map on a sphere (Viitanen 2012, 7.4): fractal terrain of which `sea_share` becomes a
/// flat ocean floor of `ocean_crust`; the rest is land, 1 plus the noise scaled to [0, 1]. Terrain
/// belongs to places: a finer lattice has the same with more detail. `waves_round` of the longest
/// waves go round the planet.
std::vector<RasterCrust> start_raster_sphere(const FibonacciSphere& samples, double sea_share,
                                             double ocean_crust, double waves_round,
                                             std::uint64_t seed);

/// Plates grown at random (Viitanen 2012, 7.4) from as many random places of the sphere: on a
/// lattice of a fixed size, seen by each sample through a warp that bends outlines at scales below
/// it. So plates belong to places, and a finer lattice has the same. Returns the plate of each
/// sample; `round` tells the cycles of one seed apart.
std::vector<std::int16_t> grow_raster_sphere_plates(const FibonacciSphere& samples, int plates,
                                                    std::uint64_t seed, std::uint64_t round);

/// Plates as height maps on a sphere: the rules of RasterTectonics (Viitanen 2012, chapter 7)
/// where plates turn about poles instead of sliding over a torus, so that no place and no latitude
/// is another's edge.
///
/// Each plate has a lattice of its own that turns with it. What a plate has at a sample of the
/// world is what it has at its own sample nearest to that place: plates that part never overlap,
/// and plates that meet do so where they do. `world.columns` cells go once round the equator, which
/// gives the lattice its size and lengths their scale; `world.rows` means nothing here.
///
/// Mass is conserved but for new floor, what is subducted and does not rise, and what reading all
/// crust at the world's samples adds or takes when it is divided into new plates: `budget()` has
/// all three.
///
/// Where plates meet is found on all threads, what happens there is done in the order of samples.
/// Results do not depend on the number of threads. Cost: linear in samples and steps.
class RasterSphere {
 public:
  /// `mesh` must be that of raster_samples(settings.world.columns) samples and outlive the model.
  /// Throws ConfigurationError on fewer than 16 columns, more than 32 767 plates or 32 000 steps.
  RasterSphere(const SphereMesh& mesh, const RasterSettings& settings, std::uint64_t seed);

  RasterSphere(const RasterSphere&) = delete;  // plates know its pages
  RasterSphere& operator=(const RasterSphere&) = delete;

  /// One step, or the division into new plates. False when the last cycle is over.
  bool advance();

  /// All plates' crust at the world's samples.
  [[nodiscard]] RasterMap map() const;

  [[nodiscard]] const SphereMesh& mesh() const { return pages_.mesh(); }
  [[nodiscard]] const RasterSettings& settings() const { return settings_; }
  [[nodiscard]] const std::vector<RasterSpherePlate>& plates() const { return plates_; }
  [[nodiscard]] const RasterBudget& budget() const { return budget_; }
  [[nodiscard]] std::int64_t steps() const { return budget_.steps; }
  /// Sum of all heights now, counted cell by cell.
  [[nodiscard]] double mass() const;
  /// Share of all steps that are over, if no cycle ends early.
  [[nodiscard]] double progress() const;

 private:
  /// A plate's own sample at a place of the world.
  struct Seat {
    std::int16_t plate;
    std::int32_t sample;
  };
  /// Plates that have crust at a sample of the world where not just one is alone.
  struct Crowd {
    std::int32_t at;
    std::vector<Seat> seats;
  };
  /// A page of the world.
  struct Page {
    std::vector<std::int16_t> plates;   ///< that may have crust there, in order
    std::vector<std::int16_t> watched;  ///< those of `seats`
    std::vector<std::int32_t> seats;    ///< their own samples at the page's, plate by plate
  };
  struct Arc {
    std::int32_t at;
    std::int16_t below, above;
    std::int32_t from;  ///< sample of the upper plate where the lower one subducts
    float melt;
  };
  struct Overlap {
    std::int16_t a, b;
    std::int32_t continent_a, continent_b;
    std::int64_t cells;
  };
  /// Crust at samples of a plate.
  using PlacedCrust = std::vector<std::pair<std::int32_t, RasterCrust>>;

  void divide(std::vector<RasterCrust> crust);
  [[nodiscard]] RasterCycle::Motion motion() const;
  void move();
  void watch();
  [[nodiscard]] bool is_calm(std::int32_t page) const;
  void find_seats(std::int32_t page);
  void meet();
  void meet_at(const Crowd& crowd);
  void sink(const Seat& below, const Seat& above, std::int32_t at);
  void fold(const Seat& a, const Seat& b);
  void raise_arcs();
  void slow_down();
  void merge_continents();
  [[nodiscard]] std::vector<std::int32_t> samples_under(int plate, int other,
                                                        const PlacedCrust& crust) const;
  [[nodiscard]] PlacedCrust seen_by(int plate, int other, const PlacedCrust& crust) const;
  void merge(const Overlap& overlap);
  void fill_gaps();
  [[nodiscard]] std::int32_t own_sample(int plate, const Vector3& place, std::int32_t from) const {
    return pages_.nearest(back(turn_[plate], place), from);
  }

  LatticePages pages_;
  RasterSettings settings_;
  std::uint64_t seed_;
  double cell_rad_;
  std::vector<RasterSpherePlate> plates_;
  std::vector<Matrix3> turn_;
  std::vector<std::int16_t> owner_, previous_;
  std::vector<Page> page_;
  std::vector<Arc> arcs_;
  std::vector<double> folded_;
  std::vector<Overlap> overlaps_;
  std::vector<std::int32_t> gaps_;
  bool met_ = false;
  RasterBudget budget_;
  RasterCycle cycle_;
  bool over_ = false;
  bool pays_ = true;  // to wait for other threads in each step: not on small lattices
};

}  // namespace geo
