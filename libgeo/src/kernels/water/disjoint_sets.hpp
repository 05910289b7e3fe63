#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace geo {

/// Union-find with path halving (Tarjan et al. 1984). The lowest element of a set is its
/// root, whatever the order in which sets were joined.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  [[nodiscard]] std::int32_t find(std::int32_t element) {
    while (parent_[element] != element) {
      element = parent_[element] = parent_[parent_[element]];
    }
    return element;
  }
  /// False if both were in one set already.
  bool join(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    parent_[std::max(a, b)] = std::min(a, b);
    return true;
  }

 private:
  std::vector<std::int32_t> parent_;
};

}  // namespace geo
