#include "geo/kernels/plates/sphere/sphere_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"

namespace geo {
namespace {

constexpr int kMostNeighbours = 12;

double determinant(const Vector3& a, const Vector3& b, const Vector3& c) {
  return dot(a, cross(b, c));
}

/// One star: candidates of a sample and what is asked of them.
class Star {
 public:
  Star(const FibonacciSphere& samples, std::int32_t centre) : samples_(samples), centre_(centre) {
    const auto steps = samples.steps(centre);
    const double reach = 2.6 * samples.spacing();
    const auto consider = [&](std::int32_t other) {
      if (other < 0 || other >= samples.size() || other == centre) return;
      if (length(add(samples.position(other), samples.position(centre), -1.0)) > reach) return;
      candidates_.push_back(other);
    };
    if (!steps.empty()) {
      for (const std::int32_t step : steps) {
        consider(centre - step);
        consider(centre + step);
      }
    } else {
      const std::int32_t n = samples.size(), ring = 3 * FibonacciSphere::kPolar;
      const bool small = n <= 2 * ring;
      const std::int32_t from = small || centre < ring ? 0 : n - ring;
      for (std::int32_t i = from; i < (small ? n : from + ring); ++i) consider(i);
    }
  }

  /// Neighbours anticlockwise; the nearest sample, always one of them, stands first.
  [[nodiscard]] std::vector<std::int32_t> wind() const {
    std::int32_t first = candidates_.front();
    const Vector3& here = samples_.position(centre_);
    double most = -2.0;
    for (const std::int32_t other : candidates_) {
      const double near = dot(samples_.position(other), here);
      if (near > most) {
        most = near;
        first = other;
      }
    }
    std::vector<std::int32_t> star{first};
    for (std::int32_t at = next(first); at != first; at = next(at)) {
      star.push_back(at);
      if (at < 0 || static_cast<int>(star.size()) > kMostNeighbours) {
        throw Bug("the star of sample " + std::to_string(centre_) + " does not close");
      }
    }
    return star;
  }

 private:
  /// The third corner of the triangle on the left of centre -> from.
  [[nodiscard]] std::int32_t next(std::int32_t from) const {
    const Vector3 left = cross(samples_.position(centre_), samples_.position(from));
    std::int32_t best = -1;
    for (const std::int32_t other : candidates_) {
      if (other == from || dot(left, samples_.position(other)) <= 0.0) continue;
      if (best < 0 || is_in_circle(from, best, other)) best = other;
    }
    return best;
  }

  /// Whether `other` lies within the circle through centre, `second` and `third`, which stand
  /// anticlockwise. The same bits decide for any order of the four.
  [[nodiscard]] bool is_in_circle(std::int32_t second, std::int32_t third,
                                  std::int32_t other) const {
    std::array<std::int32_t, 4> point{centre_, second, third, other};
    bool is_odd = false;
    for (int i = 1; i < 4; ++i) {
      for (int j = i; j > 0 && point[j - 1] > point[j]; --j) {
        std::swap(point[j - 1], point[j]);
        is_odd = !is_odd;
      }
    }
    const Vector3& origin = samples_.position(point[0]);
    const double volume = determinant(add(samples_.position(point[1]), origin, -1.0),
                                      add(samples_.position(point[2]), origin, -1.0),
                                      add(samples_.position(point[3]), origin, -1.0));
    return is_odd ? volume < 0.0 : volume > 0.0;
  }

  const FibonacciSphere& samples_;
  std::int32_t centre_;
  std::vector<std::int32_t> candidates_;
};

}  // namespace

SphereMesh::SphereMesh(const FibonacciSphere& samples) : samples_(&samples) {
  const std::int32_t n = samples.size();
  constexpr std::int32_t kBlock = 4096;
  const std::int32_t blocks = (n + kBlock - 1) / kBlock;
  std::vector<std::vector<std::int32_t>> found(blocks);
  first_.assign(static_cast<std::size_t>(n) + 1, 0);
  const auto wind = [&](std::int32_t block) {
    for (std::int32_t i = block * kBlock; i < std::min(n, (block + 1) * kBlock); ++i) {
      const auto star = Star(samples, i).wind();
      first_[i + 1] = static_cast<std::int32_t>(star.size());
      found[block].insert(found[block].end(), star.begin(), star.end());
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic)
  for (std::int32_t block = 0; block < blocks; ++block) errors.guard([&] { wind(block); });
  errors.rethrow();
  for (std::int32_t i = 0; i < n; ++i) first_[i + 1] += first_[i];
  neighbour_.reserve(first_[n]);
  for (const auto& part : found) neighbour_.insert(neighbour_.end(), part.begin(), part.end());
  check();
}

void SphereMesh::check() const {
  const std::int32_t n = size();
  // Euler: a triangulation of the sphere has 3 n - 6 edges, and each is known at both ends.
  bool fits = first_[n] == 6 * n - 12;
#pragma omp parallel for schedule(static) reduction(&& : fits)
  for (std::int32_t i = 0; i < n; ++i) {
    for (const std::int32_t other : neighbours(i)) {
      const auto back = neighbours(other);
      fits = fits && std::find(back.begin(), back.end(), i) != back.end();
    }
  }
  if (!fits) throw Bug("the stars of the Fibonacci lattice do not fit together");
}

std::int32_t SphereMesh::beside(std::int32_t sample, std::int32_t neighbour, int step) const {
  const auto star = neighbours(sample);
  const auto count = static_cast<int>(star.size());
  const auto at = static_cast<int>(std::find(star.begin(), star.end(), neighbour) - star.begin());
  return star[(at + step + count) % count];
}

SphereMesh::Place SphereMesh::locate(const Vector3& unit, std::int32_t near) const {
  const auto& at = samples_->positions();
  const auto star = neighbours(near);
  // The sector of the star: right of the way to the next neighbour, left of the way to this one.
  Vector3 here = cross(at[near], unit);
  const auto count = static_cast<int>(star.size());
  int sector = 0;
  double side = dot(here, at[star[count - 1]]);
  for (int k = 0; k < count; ++k) {
    const double next = dot(here, at[star[k]]);
    if (side < 0.0 && next >= 0.0) sector = (k + count - 1) % count;
    side = next;
  }
  Place place{{near, star[sector], star[(sector + 1) % count]}, {}};
  for (int steps = 0; steps < 64; ++steps) {
    const auto& [a, b, c] = place.corner;
    place.weight = {determinant(unit, at[b], at[c]), determinant(at[a], unit, at[c]),
                    determinant(at[a], at[b], unit)};
    const auto least = std::min_element(place.weight.begin(), place.weight.end());
    if (*least >= 0.0) break;
    // Across the edge that parts the place from the triangle.
    const auto k = least - place.weight.begin();
    const std::int32_t from = place.corner[(k + 1) % 3], to = place.corner[(k + 2) % 3];
    place.corner = {to, from, beside(from, to, -1)};
  }
  const double sum = place.weight[0] + place.weight[1] + place.weight[2];
  for (double& weight : place.weight) weight = std::max(0.0, weight) / sum;
  return place;
}

}  // namespace geo
