#include "geo/kernels/climate/mountain_barrier.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"

namespace geo {

/// The faces east and north of every cell, and the factors of -div(a grad).
class MountainBarrier::Faces {
 public:
  Faces(const Grid& grid, std::span<const float> open)
      : grid_(grid), open_(open.begin(), open.end()) {
    factors_.compute(matrix());
    if (factors_.info() != Eigen::Success) throw Bug("mountain_barrier: no Cholesky factors");
  }

  [[nodiscard]] std::size_t size() const { return open_.size(); }

  /// The potential chi of what turns aside, m2 s-1.
  [[nodiscard]] Eigen::VectorXd potential(double turned_share, std::span<const float> wind_east,
                                          std::span<const float> wind_north) const {
    Eigen::VectorXd gathering = Eigen::VectorXd::Zero(grid_.size());
    for_faces([&](const Face& face) {
      const std::span<const float> wind = face.is_east ? wind_east : wind_north;
      const double held_back = turned_share * (1.0 - open_between(face.here, face.there)) * 0.5 *
                               (wind[face.here] + wind[face.there]) * face.length_m;
      gathering[face.here] -= held_back;
      gathering[face.there] += held_back;
    });
    return factors_.solve(gathering);
  }

  /// What passes the faces on either side of each cell, on the mean: the share of its wind that
  /// they let pass, and a grad chi.
  void pass(const Eigen::VectorXd& potential, std::span<float> wind_east,
            std::span<float> wind_north) const {
    std::vector<Passing> east(open_.size()), north(open_.size());
    for_faces([&](const Face& face) {
      std::vector<Passing>& passing = face.is_east ? east : north;
      const double open = open_between(face.here, face.there);
      const double turned = open * (potential[face.there] - potential[face.here]) / face.spacing_m;
      for (const Index cell : {face.here, face.there}) {
        passing[cell].open += 0.5 * open;
        passing[cell].turned_m_s += 0.5 * turned;
      }
    });
    if (grid_.topology() == Topology::sphere) {  // nothing passes a pole: it has no width
      for (int i = 0; i < grid_.nx(); ++i) {
        for (const Index cell : {grid_.cell(i, 0), grid_.cell(i, grid_.ny() - 1)}) {
          north[cell].open += 0.5 * open_[cell];
        }
      }
    }
    for (std::size_t cell = 0; cell < open_.size(); ++cell) {
      east[cell].apply_to(wind_east[cell]);
      north[cell].apply_to(wind_north[cell]);
    }
  }

 private:
  struct Passing {
    double open = 0.0, turned_m_s = 0.0;
    void apply_to(float& wind) const { wind = static_cast<float>(open * wind + turned_m_s); }
  };
  struct Face {
    Index here, there;
    bool is_east;
    double length_m, spacing_m;
  };

  template <class Do>
  void for_faces(const Do& act) const {
    for (int j = 0; j < grid_.ny(); ++j) {
      const bool pole = grid_.topology() == Topology::sphere && j == grid_.ny() - 1;
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index here = grid_.cell(i, j);
        act(Face{here, grid_.neighbour(i, j, kEast), true, grid_.face_east_m(j),
                 grid_.spacing_east_m(j)});
        if (pole) continue;
        act(Face{here, grid_.neighbour(i, j, kNorth), false, grid_.face_north_m(j),
                 grid_.spacing_north_m(j)});
      }
    }
  }

  [[nodiscard]] double open_between(Index here, Index there) const {
    const double sum = open_[here] + open_[there];
    return sum > 0.0 ? 2.0 * open_[here] * open_[there] / sum : 0.0;
  }

  [[nodiscard]] Eigen::SparseMatrix<double> matrix() const {
    constexpr double kLeastOpen = 1e-3;  // walled-in cells keep an equation
    constexpr double kLevel = 1e-9;      // chi has no level of its own
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(static_cast<std::size_t>(grid_.size()) * 9);
    for_faces([&](const Face& face) {
      const double through = std::max(kLeastOpen, open_between(face.here, face.there)) *
                             face.length_m / face.spacing_m;
      entries.emplace_back(face.here, face.here, through * (1.0 + kLevel));
      entries.emplace_back(face.there, face.there, through * (1.0 + kLevel));
      entries.emplace_back(face.here, face.there, -through);
      entries.emplace_back(face.there, face.here, -through);
    });
    Eigen::SparseMatrix<double> result(grid_.size(), grid_.size());
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

  const Grid& grid_;
  std::vector<float> open_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

MountainBarrier::MountainBarrier(const Grid& grid, std::span<const float> open) {
  if (grid.topology() == Topology::plane) throw Bug("mountain_barrier: the grid has edges");
  check_sizes("mountain_barrier", grid.size(), {{"open", open.size()}});
  faces_ = std::make_unique<const Faces>(grid, open);
}
MountainBarrier::~MountainBarrier() = default;
MountainBarrier::MountainBarrier(MountainBarrier&&) noexcept = default;
MountainBarrier& MountainBarrier::operator=(MountainBarrier&&) noexcept = default;

void MountainBarrier::turn_aside(double turned_share, std::span<float> wind_east,
                                 std::span<float> wind_north) const {
  check_sizes("turn_aside", faces_->size(),
              {{"wind_east", wind_east.size()}, {"wind_north", wind_north.size()}});
  const Eigen::VectorXd potential = faces_->potential(turned_share, wind_east, wind_north);
  faces_->pass(potential, wind_east, wind_north);
}

}  // namespace geo
