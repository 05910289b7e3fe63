#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace geo {

/// Crust of one cell of a raster plate, 8 bytes.
struct RasterCrust {
  float height = 0.0F;       ///< amount of crust; 0 none, from 1 on it is land
  std::int16_t born = 0;     ///< step at which it came into being, the mean of what piled up there
  std::uint16_t folded = 0;  ///< step of its last orogeny, twice, plus 1 if two continents met

  /// The later of two orogenies, and the mean age by amounts.
  void add(const RasterCrust& other) {
    const float sum = height + other.height;
    const float mean =
        (height * static_cast<float>(born) + other.height * static_cast<float>(other.born)) / sum;
    born = static_cast<std::int16_t>(std::lround(mean));
    folded = std::max(folded, other.folded);
    height = sum;
  }
};

/// Sides of the world, in cells. Opposite ones meet.
struct RasterWorld {
  int columns = 512, rows = 512;

  [[nodiscard]] std::int32_t size() const { return columns * rows; }
  [[nodiscard]] int column(int x) const { return wrapped(x, columns); }
  [[nodiscard]] int row(int y) const { return wrapped(y, rows); }

 private:
  /// Quick for places that are not many turns away.
  static int wrapped(int k, int side) {
    while (k < 0) k += side;
    while (k >= side) k -= side;
    return k;
  }
};

/// Maps that a plate's own cells are taken by, when it turns.
///
/// Three shears by whole cells (Paeth 1986),
///   x += s(y), y += t(x), x += s(y),  s(y) = round(-tan(a/2) y), t(x) = round(sin(a) x),
/// are a rotation by `a` that sends each cell of the torus to just one cell: crust is neither
/// doubled nor lost, and the rotation by -a undoes it.
class RasterTurn {
 public:
  RasterTurn(const RasterWorld& world, double angle_rad);
  /// Places relative to the centre of the turn, within half the world's sides.
  void turn(int& x, int& y) const;
  void turn_back(int& x, int& y) const;

 private:
  [[nodiscard]] int wrapped_x(int x) const;
  [[nodiscard]] int wrapped_y(int y) const;
  RasterWorld world_;
  std::vector<int> along_x_, along_y_;  // by y and by x
};

/// Continents of a plate: connected land (four neighbours), as runs along its rows.
struct RasterContinents {
  struct Run {
    std::int32_t begin, end;  ///< columns, relative to the plate's map
    std::int32_t continent;
  };
  std::vector<Run> runs;
  std::vector<std::int32_t> row_begin;  ///< first run of each row, and the end
  std::vector<std::int32_t> area;       ///< of each continent, cells
  int left = 0, top = 0;                ///< of the plate's map when they were found

  /// The continent of a place of the plate's map, or -1.
  [[nodiscard]] std::int32_t at(int column, int row) const;
};

/// A plate: a map of its own that moves over the world's by whole cells (Viitanen 2012, 7.3).
/// The map is a rectangle about the plate's crust, grows when crust comes to lie beside it and
/// shrinks to what it needs. Places of the frame are those of the world less the shift.
class RasterPlate {
 public:
  explicit RasterPlate(const RasterWorld& world) : world_(world) {}

  // Motion; places and speeds in cells, angles in radians, times in steps.
  double x = 0.0, y = 0.0;                ///< shift of the frame
  double east = 0.0, north = 0.0;         ///< velocity of the centre
  double spin = 0.0, angle = 0.0;         ///< of the turn about the centre
  double curve = 0.0;                     ///< turn of the velocity beside that
  double centre_x = 0.0, centre_y = 0.0;  ///< of that turn, in the frame
  double mass = 0.0;                      ///< sum of heights, kept up to date
  bool alive = true;

  [[nodiscard]] int shift_x() const { return shift_x_; }
  [[nodiscard]] int shift_y() const { return shift_y_; }
  /// Takes the shift to `x`, `y`, to whole cells, and the map to `angle` when its rim has moved by
  /// a cell.
  void settle();

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int left() const { return left_; }
  [[nodiscard]] int top() const { return top_; }
  /// Row of the map that lies at a row of the world, or -1.
  [[nodiscard]] int local_row(int world_row) const {
    const int row = world_.row(world_row - shift_y_ - top_);
    return row < rows_ ? row : -1;
  }
  /// Column of the map that lies at a column of the world; beyond columns() there is none.
  [[nodiscard]] int local_column(int world_column) const {
    return world_.column(world_column - shift_x_ - left_);
  }
  /// Column of the world at the first one of the map.
  [[nodiscard]] int first_column() const { return world_.column(left_ + shift_x_); }
  [[nodiscard]] int first_row() const { return world_.row(top_ + shift_y_); }
  [[nodiscard]] std::span<const RasterCrust> row(int local) const {
    return std::span(crust_).subspan(static_cast<std::size_t>(local) * columns_, columns_);
  }
  /// Place of a cell of the map in its array.
  [[nodiscard]] std::int32_t place(int column, int local) const {
    return local * columns_ + column;
  }
  [[nodiscard]] const RasterCrust& crust(std::int32_t place) const { return crust_[place]; }
  /// Says that a cell will be asked for soon, so that memory can begin to bring it.
  void expect(std::int32_t place) const {
    if (place >= 0) __builtin_prefetch(&crust_[place], 1);
  }
  /// Changes a cell.
  void set(std::int32_t place, const RasterCrust& crust) {
    const float before = crust_[place].height, after = crust.height;
    crust_[place] = crust;
    const bool comes = (before > 0.0F) != (after > 0.0F);
    const bool lands = (before >= 1.0F) != (after >= 1.0F);
    if (!comes && !lands) return;
    const std::int32_t row = place / columns_, column = place - row * columns_;
    Block& block = blocks_[static_cast<std::size_t>(row) * blocks() + column / kBlock];
    const auto bit = static_cast<std::uint16_t>(1U << (column % kBlock));
    if (comes) block.crust ^= bit;
    if (lands) block.land ^= bit;
  }
  /// Which of 16 cells of a row have crust and are land, one bit each, so that crust itself is only
  /// looked at where plates meet.
  struct Block {
    std::uint16_t crust = 0, land = 0;
  };
  static constexpr int kBlock = 16;
  [[nodiscard]] const Block* blocks(int local) const {
    return &blocks_[static_cast<std::size_t>(local) * blocks()];
  }
  /// Columns of a row of the map outside which there is no crust.
  struct Reach {
    int begin, end;
  };
  [[nodiscard]] Reach reach(int local) const { return reach_[local]; }

  /// The cell at a place of the world, or -1 beyond the map.
  [[nodiscard]] std::int32_t find(int world_column, int world_row) const {
    const int row = local_row(world_row), column = local_column(world_column);
    return row < 0 || column >= columns_ ? -1 : place(column, row);
  }
  /// The same; the map grows to hold the place.
  [[nodiscard]] std::int32_t claim(int world_column, int world_row);
  /// An empty map for a rectangle of the world, whose sides are at most the world's.
  void open(int world_column, int world_row, int columns, int rows);
  /// Shrinks the map to its crust and counts mass and reach anew.
  void tighten();
  /// Levels land: see RasterSettings::erosion. Returns what rounding has added to the crust.
  double erode(double strength);
  /// Finds the continents anew if the map has changed its place, or land has come or gone and
  /// `steps` calls have passed since.
  void find_continents(int steps);
  [[nodiscard]] RasterContinents& continents() { return continents_; }
  [[nodiscard]] const RasterContinents& continents() const { return continents_; }
  void forget_continents() { continents_known_ = false; }
  /// Enters a change into the budget that has been made to a cell.
  void note(float before, float after) {
    mass += static_cast<double>(after) - before;
    if ((before >= 1.0F) != (after >= 1.0F)) land_changed_ = true;
  }

 private:
  [[nodiscard]] int blocks() const { return (columns_ + kBlock - 1) / kBlock; }
  void mark_blocks();
  /// A map that holds the crust of the present one at other places of the frame.
  template <class Place>
  void rearrange(int left, int top, int columns, int rows, Place&& place_of);
  void resize(int left, int top, int columns, int rows);
  void turn_map();

  RasterWorld world_;
  int left_ = 0, top_ = 0, columns_ = 0, rows_ = 0;  // in the frame
  int shift_x_ = 0, shift_y_ = 0;
  double map_angle_ = 0.0, base_angle_ = 0.0;  // of the map, and that at which it was as made
  std::vector<RasterCrust> crust_;
  std::vector<Block> blocks_;
  std::vector<Reach> reach_;
  RasterContinents continents_;
  bool continents_known_ = false, land_changed_ = false;
  int continents_age_ = 0;
};

}  // namespace geo
