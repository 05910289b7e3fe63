#include "geo/kernels/plates/growth/plate_pieces.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"

namespace geo {
namespace {

/// A piece of a plate.
struct Piece {
  std::int16_t plate = -1;
  double area = 0.0;
  std::vector<std::int32_t> cells;
};

/// Which piece of each plate is the largest; of equal ones the first.
std::map<std::int16_t, std::size_t> largest_of(const std::vector<Piece>& pieces) {
  std::map<std::int16_t, std::size_t> largest;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const auto [best, is_first] = largest.try_emplace(pieces[k].plate, k);
    if (!is_first && pieces[k].area > pieces[best->second].area) best->second = k;
  }
  return largest;
}

/// All but the largest piece of each plate, the smallest first.
std::vector<Piece> loose_pieces(std::vector<Piece> pieces) {
  const auto largest = largest_of(pieces);
  std::vector<Piece> loose;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (largest.at(pieces[k].plate) != k) loose.push_back(std::move(pieces[k]));
  }
  std::stable_sort(loose.begin(), loose.end(),
                   [](const Piece& a, const Piece& b) { return a.area < b.area; });
  return loose;
}

/// Gives a piece to the plate that most of its neighbours belong to. `for_neighbours(cell, see)`
/// calls `see` with each cell next to one.
template <class Plates, class ForNeighbours>
void hand_over(const Piece& piece, ForNeighbours&& for_neighbours, Plates& plate) {
  std::map<std::int16_t, int> border;
  for (const std::int32_t cell : piece.cells) {
    for_neighbours(cell, [&](std::int32_t next) {
      if (plate[next] != piece.plate) ++border[plate[next]];
    });
  }
  if (border.empty()) return;  // all around has joined its own plate meanwhile
  const auto host =
      std::max_element(border.begin(), border.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  for (const std::int32_t cell : piece.cells) plate[cell] = host->first;
}

/// Whether cells hang together by their corners too.
enum class By : int { corners = 1, sides = 2 };

/// Every second neighbour of a cell of the mesh lies beyond a side.
template <class See>
void for_neighbours(const CubedSphere& mesh, std::int32_t cell, By by, See&& see) {
  const auto& around = mesh.neighbours(cell);
  for (int k = 0; k < CubedSphere::kNeighbours; k += static_cast<int>(by)) see(around[k]);
}

std::vector<Piece> pieces_of(const CubedSphere& mesh, By by,
                             const std::vector<std::int16_t>& plate) {
  std::vector<Piece> pieces;
  std::vector<std::uint8_t> seen(mesh.size(), 0);
  for (std::int32_t start = 0; start < mesh.size(); ++start) {
    if (seen[start] != 0) continue;
    seen[start] = 1;
    Piece piece{plate[start], 0.0, {start}};
    for (std::size_t at = 0; at < piece.cells.size(); ++at) {
      piece.area += mesh.area_sr(piece.cells[at]);
      for_neighbours(mesh, piece.cells[at], by, [&](std::int32_t next) {
        if (seen[next] != 0 || plate[next] != piece.plate) return;
        seen[next] = 1;
        piece.cells.push_back(next);
      });
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

/// Cells of one plate side by side in a row of a grid.
struct Run {
  int row, begin, end;
  std::int16_t plate;
};

/// Runs of all rows, and which of them hang together.
class Runs {
 public:
  Runs(const Grid& grid, std::span<const std::int16_t> plate) : grid_(grid) {
    first_.reserve(grid.ny() + 1);
    for (int j = 0; j < grid.ny(); ++j) {
      first_.push_back(runs_.size());
      const auto row = plate.subspan(grid.cell(0, j), grid.nx());
      for (int begin = 0, end = 0; begin < grid.nx(); begin = end) {
        while (end < grid.nx() && row[end] == row[begin]) ++end;
        runs_.push_back({j, begin, end, row[begin]});
      }
    }
    first_.push_back(runs_.size());
    root_.resize(runs_.size());
    std::iota(root_.begin(), root_.end(), std::size_t{0});
    for (int j = 0; j < grid.ny(); ++j) {
      join(first_[j], first_[j + 1] - 1);  // across the date line
      if (j > 0) join_rows(j - 1, j);
    }
    join_over_pole(0);
    join_over_pole(grid.ny() - 1);
  }

  /// Pieces with their areas. The largest of each plate is left without its cells.
  [[nodiscard]] std::vector<Piece> pieces() {
    std::vector<Piece> pieces;
    std::vector<std::size_t> number(runs_.size());
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      const std::size_t root = find(k);
      if (root == k) {
        number[k] = pieces.size();
        pieces.push_back({runs_[k].plate, 0.0, {}});
      }
      pieces[number[root]].area += grid_.area_m2(runs_[k].row) * (runs_[k].end - runs_[k].begin);
    }
    const auto largest = largest_of(pieces);
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      const Run& run = runs_[k];
      const std::size_t piece = number[find(k)];
      if (largest.at(run.plate) == piece) continue;
      for (int i = run.begin; i < run.end; ++i) {
        pieces[piece].cells.push_back(grid_.cell(i, run.row));
      }
    }
    return pieces;
  }

 private:
  /// The first run of a piece. Earlier runs are roots of later ones.
  std::size_t find(std::size_t run) {
    while (root_[run] != run) {
      root_[run] = root_[root_[run]];
      run = root_[run];
    }
    return run;
  }
  void join(std::size_t a, std::size_t b) {
    if (runs_[a].plate != runs_[b].plate) return;
    a = find(a);
    b = find(b);
    root_[std::max(a, b)] = std::min(a, b);
  }
  void join_rows(int south, int north) {
    std::size_t a = first_[south], b = first_[north];
    while (a < first_[south + 1] && b < first_[north + 1]) {
      // Sides or corners.
      if (runs_[a].begin <= runs_[b].end && runs_[b].begin <= runs_[a].end) join(a, b);
      // The run that ends first has no further neighbours but at its corner.
      if (runs_[a].end < runs_[b].end) {
        ++a;
      } else if (runs_[b].end < runs_[a].end) {
        ++b;
      } else {
        if (a + 1 < first_[south + 1]) join(a + 1, b);
        if (b + 1 < first_[north + 1]) join(a, b + 1);
        ++a, ++b;
      }
    }
    join(first_[south], first_[north + 1] - 1);
    join(first_[north], first_[south + 1] - 1);
  }
  void join_over_pole(int row) {
    std::vector<std::size_t> run_of(grid_.nx());
    for (std::size_t k = first_[row]; k < first_[row + 1]; ++k) {
      for (int i = runs_[k].begin; i < runs_[k].end; ++i) run_of[i] = k;
    }
    for (int i = 0; i < grid_.nx(); ++i) {
      for (const int aside : {-1, 0, 1}) {
        join(run_of[i], run_of[(i + grid_.nx() / 2 + aside + grid_.nx()) % grid_.nx()]);
      }
    }
  }

  const Grid& grid_;
  std::vector<Run> runs_;
  std::vector<std::size_t> first_, root_;  // first run of each row; an earlier run of the piece
};

/// Hands over the pieces smaller than `smallest_sr`; whether there were any.
bool merge_pieces(const CubedSphere& mesh, By by, double smallest_sr,
                  std::vector<std::int16_t>& plate) {
  bool any = false;
  for (const Piece& piece : loose_pieces(pieces_of(mesh, by, plate))) {
    if (piece.area >= smallest_sr) break;
    hand_over(
        piece, [&](std::int32_t cell, auto&& see) { for_neighbours(mesh, cell, by, see); }, plate);
    any = true;
  }
  return any;
}

}  // namespace

void merge_small_pieces(const CubedSphere& mesh, double smallest_sr,
                        std::vector<std::int16_t>& plate) {
  merge_pieces(mesh, By::corners, smallest_sr, plate);
}

void connect_plates(const CubedSphere& mesh, std::vector<std::int16_t>& plate) {
  check_sizes("connect_plates", mesh.size(), {{"plate", plate.size()}});
  // A piece may join one that is handed over itself; their number falls each time.
  while (merge_pieces(mesh, By::sides, std::numeric_limits<double>::infinity(), plate)) {
  }
}

std::vector<Index> connect_plates(const Grid& grid, std::span<std::int16_t> plate) {
  if (grid.topology() != Topology::sphere) {
    throw InputError("plates are connected on whole spheres alone");
  }
  if (plate.size() != static_cast<std::size_t>(grid.size())) {
    throw InputError("plates: the field must have one value per cell");
  }
  std::vector<Index> handed_over;
  for (bool any = true; any;) {
    any = false;
    for (const Piece& piece : loose_pieces(Runs(grid, plate).pieces())) {
      hand_over(
          piece,
          [&](Index cell, auto&& see) {
            for (int k = 0; k < kDirections; ++k) see(grid.neighbour(cell, k));
          },
          plate);
      handed_over.insert(handed_over.end(), piece.cells.begin(), piece.cells.end());
      any = true;
    }
  }
  std::sort(handed_over.begin(), handed_over.end());
  handed_over.erase(std::unique(handed_over.begin(), handed_over.end()), handed_over.end());
  return handed_over;
}

}  // namespace geo
